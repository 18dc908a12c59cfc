// Orders and steps needed, from made-up errors whose answer is known.
#include "support/convergence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace drumlin::post {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// 3 (100/steps)^order at 100, 200, ..., with the errors of even places times `factor` and of odd ones
/// through it.
std::vector<ErrorPoint> power_law(double order, std::size_t count, double factor = 1.0) {
  std::vector<ErrorPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double steps = 100.0 * std::pow(2.0, static_cast<double>(i));
    points.push_back({steps, 3.0 * std::pow(100.0 / steps, order) * (i % 2 == 0 ? factor : 1.0 / factor)});
  }
  return points;
}

TEST(FittedOrder, IsThatOfAPowerLaw) {
  const auto fit = fitted_order(power_law(2.0, 8), 500.0);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->order, 2.0, 1e-12);
  EXPECT_NEAR(fit->scatter, 0.0, 1e-12);
  EXPECT_EQ(fit->from, 800.0);
  EXPECT_EQ(fit->to, 12800.0);
}

TEST(FittedOrder, GivesTheScatterInDecades) {
  const auto fit = fitted_order(power_law(1.0, 40, 10.0), 0.0);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->order, 1.0, 0.05);
  EXPECT_NEAR(fit->scatter, 1.0, 0.05);
}

TEST(FittedOrder, LeavesOutWhatIsCoarser) {
  std::vector<ErrorPoint> points = power_law(2.0, 8);
  for (std::size_t i = 0; i < 4; ++i)
    points[i].error = 0.5;
  EXPECT_NEAR(finer_half(points), 1131.4, 0.1); // the middle of 100 and 12800 on a logarithmic scale
  EXPECT_NEAR(fitted_order(points, finer_half(points))->order, 2.0, 1e-12);
  EXPECT_LT(fitted_order(points, 0.0)->order, 1.9);
}

TEST(FittedOrder, NeedsThreeUsablePoints) {
  std::vector<ErrorPoint> points = power_law(2.0, 6);
  EXPECT_TRUE(fitted_order(points, 800.0));
  points.back().error = not_a_number;
  EXPECT_FALSE(fitted_order(points, 800.0));
  EXPECT_FALSE(fitted_order({}, 0.0));
}

TEST(StepsNeeded, CountsFromTheLastPointAbove) {
  // An error that is small by chance does not count: it is below 1e-2 at 200 steps, but not at 400.
  const std::vector<ErrorPoint> points = {{100, 1.0}, {200, 5e-3}, {400, 2e-2}, {800, 9e-3}, {1600, 1e-3}};
  EXPECT_EQ(steps_needed(points, 1e-2), 800.0);
  EXPECT_EQ(steps_needed(points, 2e-2), 200.0);
  EXPECT_EQ(steps_needed(points, 1.0), 100.0);
  EXPECT_EQ(steps_needed(points, 1e-3), 1600.0);
  EXPECT_FALSE(steps_needed(points, 9e-4));
  EXPECT_FALSE(steps_needed({}, 1.0));
}

TEST(StepsNeeded, AFailedRunKeepsToNoError) {
  EXPECT_EQ(steps_needed({{100, 1e-9}, {200, not_a_number}, {400, 1e-3}}, 1.0), 400.0);
  EXPECT_FALSE(steps_needed({{100, 1e-9}, {200, infinity}}, 1.0));
}

TEST(StepsFor, FollowsThePowerLawBetweenAndBeyond) {
  const std::vector<ErrorPoint> points = power_law(2.0, 5);
  for (const double steps : {20.0, 100.0, 333.0, 1600.0, 1e5})
    EXPECT_NEAR(*steps_for(points, 3.0 * std::pow(100.0 / steps, 2), 2.0), steps, 1e-9 * steps);
  EXPECT_FALSE(steps_for({}, 1e-3, 2.0));
}

TEST(StepsFor, NeverFallsWhenTheErrorFalls) {
  const std::vector<ErrorPoint> points = {{100, not_a_number}, {200, 5e-3},  {400, 2e-2},
                                          {800, 9e-3},         {1600, 9e-3}, {3200, 1e-5}};
  double last = 0.0;
  for (int i = 0; i < 160; ++i) {
    const double error = std::pow(0.9, i);
    const double steps = *steps_for(points, error, 1.0);
    EXPECT_GE(steps, last) << error;
    last = steps;
  }
}

} // namespace
} // namespace drumlin::post
