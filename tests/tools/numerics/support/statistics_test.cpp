// Statistics and orders of convergence, from numbers whose answer is known.
#include "tests/support/prelude.h"
#include "support/statistics.h"

namespace {

using namespace drumlin::post;

// Medians, quantiles and confidence intervals against numbers worked out by hand and against tables.
namespace statistics {

TEST(Quantiles, AreLinearBetweenNeighbours) {
  EXPECT_DOUBLE_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_DOUBLE_EQ(median({4.0, 1.0, 2.0, 3.0}), 2.5);
  EXPECT_DOUBLE_EQ(quantile({10.0, 20.0, 30.0, 40.0, 50.0}, 0.25), 20.0);
  EXPECT_DOUBLE_EQ(quantile({10.0, 20.0}, 0.75), 17.5);
  EXPECT_DOUBLE_EQ(quantile({7.0}, 0.9), 7.0);
  const Spread some = spread({1.0, 2.0, 3.0, 4.0, 9.0});
  EXPECT_DOUBLE_EQ(some.median, 3.0);
  EXPECT_DOUBLE_EQ(some.lower, 2.0);
  EXPECT_DOUBLE_EQ(some.upper, 4.0);
}

TEST(MeanInterval, IsTheMeanAndItsInterval) {
  const MeanInterval some = mean_interval({1.0, 2.0, 3.0, 6.0}); // squares about 3: 4 + 1 + 0 + 9
  EXPECT_DOUBLE_EQ(some.mean, 3.0);
  EXPECT_NEAR(some.half_width, 3.18245 * std::sqrt(14.0 / (4.0 * 3.0)), 1e-5);
  EXPECT_FALSE(some.significant());
  EXPECT_FALSE(mean_interval({-1.0, 1.5}).significant());
  EXPECT_TRUE(mean_interval({-2.0, -2.1, -1.9}).significant());
  EXPECT_TRUE((MeanInterval{-0.04, 0.05}.within(0.1)));
  EXPECT_FALSE((MeanInterval{-0.06, 0.05}.within(0.1)));
}

// The values 1 and -1 in turn, n of them: the squares about the mean are n if n is even.
TEST(MeanInterval, HasTheFactorsOfPrintedTables) {
  const std::vector<std::pair<int, double>> table = {
      {2, 12.706}, {4, 3.182}, {6, 2.571}, {12, 2.201}, {30, 2.045}};
  for (const auto &[n, t] : table) {
    std::vector<double> values(static_cast<std::size_t>(n), 1.0);
    for (std::size_t i = 1; i < values.size(); i += 2)
      values[i] = -1.0;
    EXPECT_NEAR(mean_interval(values).half_width, t / std::sqrt(n - 1.0), 5e-4) << n;
  }
}

TEST(MeanInterval, OfOneValueIsInfinite) {
  const MeanInterval one = mean_interval({5.0});
  EXPECT_EQ(one.mean, 5.0);
  EXPECT_FALSE(one.significant());
  EXPECT_THROW(mean_interval({}), std::invalid_argument);
}

// 1 and -1 in turn have a variance of n/(n - 1); printed tables of chi squared for n - 1 degrees of freedom
// have 2.5 % and 97.5 % at these values.
TEST(ScatterInterval, HasTheFactorsOfPrintedTables) {
  struct Row {
    int n;
    double lower, upper;
  };
  for (const auto &[n, lower, upper] : {Row{2, 0.000982, 5.024}, {6, 0.831, 12.833}, {12, 3.816, 21.920}}) {
    std::vector<double> values(static_cast<std::size_t>(n), 1.0);
    for (std::size_t i = 1; i < values.size(); i += 2)
      values[i] = -1.0;
    const ScatterInterval scatter = scatter_interval(values);
    EXPECT_NEAR(scatter.estimate, std::sqrt(n / (n - 1.0)), 1e-12) << n;
    EXPECT_NEAR(scatter.least, std::sqrt(n / upper), 1e-4) << n;
    EXPECT_NEAR(scatter.most / std::sqrt(n / lower), 1.0, 1e-3) << n;
  }
  EXPECT_TRUE(std::isinf(scatter_interval({5.0}).most));
  EXPECT_THROW(scatter_interval({}), std::invalid_argument);
}

// Samples with a whole number of degrees of freedom in Welch's formula, (a + b)^2 / (a^2/m + b^2/n), where a
// and b are the squared standard errors of the means and m and n their degrees of freedom: 2 if a = b and m =
// n = 1; m if b = 0; and 9 / (1 + 4/2) = 3 if a = 1, m = 1, b = 2, n = 2.
TEST(MeanDifference, HasTheFreedomOfWelchAndSatterthwaite) {
  const MeanInterval equal = mean_difference({11.0, 13.0}, {1.0, 3.0});
  EXPECT_NEAR(equal.mean, 10.0, 1e-12);
  EXPECT_NEAR(equal.half_width, 4.30265 * std::sqrt(2.0), 1e-4);
  EXPECT_NEAR(mean_difference({1.0, 3.0}, {5.0, 5.0, 5.0}).half_width, 12.7062, 1e-4);
  const double root = std::sqrt(6.0);
  EXPECT_NEAR(mean_difference({1.0, 3.0}, {-root, 0.0, root}).half_width, 3.18245 * std::sqrt(3.0), 1e-4);
  EXPECT_FALSE(mean_difference({1.0}, {2.0, 2.1}).significant());
}

// Worked out by hand: the line is 0.785 + 0.425 x, the squares of the distances from it add up to 2.79075; t
// = 3.18245 with 3 degrees of freedom.
TEST(LineFit, IsTheLineOfLeastSquares) {
  const std::vector<double> x = {1, 2, 3, 4, 5}, y = {1, 2, 1.3, 3.75, 2.25};
  const LineFit line = fit_line(x, y);
  EXPECT_NEAR(line.slope.mean, 0.425, 1e-12);
  EXPECT_NEAR(line.intercept.mean, 0.785, 1e-12);
  EXPECT_NEAR(line.slope.half_width, 3.18245 * std::sqrt(2.79075 / 3 / 10), 1e-5);
  EXPECT_NEAR(line.intercept.half_width, 3.18245 * std::sqrt(2.79075 / 3 * (1.0 / 5 + 9.0 / 10)), 1e-5);
  EXPECT_THROW(fit_line({1, 2}, {1, 2}), std::invalid_argument);
  EXPECT_THROW(fit_line({1, 1, 1}, {1, 2, 3}), std::invalid_argument);
  EXPECT_THROW(fit_line({1, 2, 3}, {1, 2}), std::invalid_argument);
}

} // namespace statistics

// Orders and steps needed, from made-up errors whose answer is known.
namespace convergence {

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
  EXPECT_NEAR(finer_half(points), 1131.4, 0.1); // steps, between 100 and 12800: their geometric mean
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

} // namespace convergence

} // namespace
