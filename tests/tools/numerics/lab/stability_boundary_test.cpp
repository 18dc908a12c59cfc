// The search for a stability limit, with invented predicates, and the theoretical limits as roots of their
// polynomial.
#include "lab/stability/boundary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

namespace drumlin::post {
namespace {

/// Trials of a predicate, which counts the values that it was asked for.
struct Trials {
  std::function<bool(double)> stable;
  int asked = 0;
  StabilityTrials operator()() {
    return [this](double low, double high, int count) {
      std::vector<bool> answers;
      for (int n = 0; n < count; ++n, ++asked)
        answers.push_back(stable(low * std::pow(high / low, n / (count - 1.0))));
      return answers;
    };
  }
};

TEST(StabilityBoundary, EnclosesTheTurn) {
  for (const double turn : {1.1e-4, 0.2426, 1.0, 1.999})
    for (const int count : {3, 16, 160}) {
      Trials trials{[turn](double value) { return value < turn; }};
      const StabilityBoundary found = find_stability_boundary(trials(), 1e-4, 4.0, count, 1e-3);
      EXPECT_LE(found.stable, turn);
      EXPECT_GE(found.unstable, turn);
      EXPECT_LE(found.relative_width(), 1e-3);
      EXPECT_NEAR(found.middle(), turn, 1e-3 * turn);
      EXPECT_TRUE(found.single);
    }
}

TEST(StabilityBoundary, NeedsTwoRoundsOfManyTrials) {
  Trials trials{[](double value) { return value < 0.3; }};
  find_stability_boundary(trials(), 1e-4, 4.0, 160, 1e-3);
  EXPECT_EQ(trials.asked, 2 * 160);
}

TEST(StabilityBoundary, IsTheLowestOfSeveralAndSaysSo) {
  Trials trials{[](double value) { return value < 0.1 || (value > 0.5 && value < 1.0); }};
  const StabilityBoundary found = find_stability_boundary(trials(), 1e-3, 4.0, 100, 1e-4);
  EXPECT_NEAR(found.middle(), 0.1, 1e-5);
  EXPECT_FALSE(found.single);
}

TEST(StabilityBoundary, EndsWhereAllIsOfOneKind) {
  Trials stable{[](double) { return true; }};
  const StabilityBoundary found = find_stability_boundary(stable(), 1e-3, 4.0, 10, 1e-4);
  EXPECT_EQ(found.stable, 4.0);
  EXPECT_TRUE(std::isinf(found.unstable));
  Trials unstable{[](double) { return false; }};
  EXPECT_THROW(find_stability_boundary(unstable(), 1e-3, 4.0, 10, 1e-4), std::runtime_error);
}

TEST(StabilityLimit, IsWhereThePolynomialOfStockSteppingHasTheRootMinusOne) {
  for (const int n : {1, 2, 4})
    for (const double D : {0.0, 0.01, 0.5, 2.0, 1e4}) {
      // (z-1)^2 + 2 n D s (z-1) + n s^2 z
      const double s = stock_stability_limit(n, D);
      EXPECT_NEAR(4.0 - 4.0 * n * D * s - n * s * s, 0.0, 1e-10) << n << " contacts, D = " << D;
    }
  EXPECT_DOUBLE_EQ(spring_stability_limit(1), 2.0);
  EXPECT_DOUBLE_EQ(spring_stability_limit(4), 1.0);
  EXPECT_NEAR(stock_stability_limit(2, 2.0), 0.2426, 5e-5);
}

} // namespace
} // namespace drumlin::post
