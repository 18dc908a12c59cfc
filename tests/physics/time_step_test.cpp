/// Stability limits against the eigenvalues of the matrix that one stock step is.

#include "physics/time_step.h"
#include "stock_stepping.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace {

using namespace drumlin::physics;

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Spring {
  int one, other; ///< -1: a fixed partner
  double k, c;
};

struct Chain {
  std::vector<double> mass;
  std::vector<Spring> springs;
};

/// Largest magnitude of the eigenvalues of the step (x, v at half step) -> (x, v at half step), entry by
/// entry as the stepping does it: a = -(K x + C v)/m, v += dt a, x += dt v. Rigid motion has the
/// eigenvalue 1.
double growth(const Chain &chain, double dt) {
  const auto n = static_cast<Eigen::Index>(chain.mass.size());
  Eigen::MatrixXd step = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  for (Eigen::Index column = 0; column < 2 * n; ++column) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n), v = Eigen::VectorXd::Zero(n);
    if (column < n)
      x(column) = 1.0;
    else
      v(column - n) = 1.0 / dt; // velocities in metres per step, which balances the matrix
    Eigen::VectorXd force = Eigen::VectorXd::Zero(n);
    for (const Spring &s : chain.springs) {
      const auto at = [&](const Eigen::VectorXd &u, int ball) { return ball < 0 ? 0.0 : u(ball); };
      const double pull = s.k * (at(x, s.other) - at(x, s.one)) + s.c * (at(v, s.other) - at(v, s.one));
      if (s.one >= 0) force(s.one) += pull;
      if (s.other >= 0) force(s.other) -= pull;
    }
    for (Eigen::Index i = 0; i < n; ++i)
      v(i) += dt * force(i) / chain.mass[static_cast<std::size_t>(i)];
    x += dt * v;
    step.col(column) << x, dt * v;
  }
  return step.eigenvalues().cwiseAbs().maxCoeff();
}

/// The true limit, by bisection on the eigenvalues.
double true_limit(const Chain &chain, double guess) {
  // The margin keeps rounding of the double eigenvalue 1 (rigid motion) and of undamped modes (on the circle)
  // out.
  const auto unstable = [&](double dt) { return growth(chain, dt) > 1.0 + 1e-5; };
  double low = guess, high = guess;
  while (unstable(low))
    low *= 0.5;
  while (!unstable(high))
    high *= 2.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (unstable(middle) ? high : low) = middle;
  }
  return low;
}

double bound(const Chain &chain) {
  double least = infinity;
  for (std::size_t i = 0; i < chain.mass.size(); ++i) {
    std::vector<Link> links;
    const int ball = static_cast<int>(i);
    for (const Spring &s : chain.springs) {
      if (s.one != ball && s.other != ball) continue;
      const int partner = s.one == ball ? s.other : s.one;
      links.push_back({s.k, s.c, partner < 0 ? infinity : chain.mass[static_cast<std::size_t>(partner)]});
    }
    least = std::min(least, critical_step_stock(chain.mass[i], links));
  }
  return least;
}

TEST(CriticalStep, OfOneContactIsWhereItsEigenvalueLeavesTheUnitCircle) {
  for (const double ratio : {0.0, 0.1, 0.5, 1.0, 2.0, 10.0}) {
    const double m = 2000.0, k = 1e8, c = 2.0 * ratio * std::sqrt(k * m);
    const double limit = critical_step_stock(k, c, m);
    const Chain chain{{m}, {{0, -1, k, c}}};
    EXPECT_LE(growth(chain, 0.999 * limit), 1.0 + 1e-9) << ratio;
    EXPECT_GT(growth(chain, 1.001 * limit), 1.0 + 1e-4) << ratio;
  }
}

TEST(CriticalStep, IsTheFormulaOfTheStockLimit) {
  const double m = 2000.0, k = 1e8, w0 = std::sqrt(k / m);
  for (const double ratio : {0.0, 0.2, 0.5, 1.0, 3.0}) {
    const double formula = 2.0 / w0 * (std::sqrt(1.0 + ratio * ratio) - ratio);
    EXPECT_NEAR(critical_step_stock(k, 2.0 * ratio * std::sqrt(k * m), m), formula,
                1e-14 * formula * (1.0 + ratio));
  }
}

TEST(CriticalStep, KeepsItsDigitsForAnyDamping) {
  const double m = 2000.0, k = 1e8, w0 = std::sqrt(k / m);
  for (const double ratio : {1e3, 1e8, 1e12}) { // 2 (sqrt(1 + D^2) - D) = 1/D - 1/(4 D^3) + ...
    const double c = 2.0 * ratio * std::sqrt(k * m);
    const double series = (1.0 / ratio - 0.25 / (ratio * ratio * ratio)) / w0;
    EXPECT_NEAR(critical_step_stock(k, c, m), series, 1e-12 * series);
  }
  EXPECT_NEAR(critical_step_stock(1e-300, 1e6, 2000.0), 4e-3, 1e-15); // 2 m / c
  EXPECT_NEAR(critical_step_stock(0.0, 1e6, 2000.0), 4e-3, 1e-15);
  EXPECT_EQ(critical_step_stock(0.0, 0.0, 2000.0), infinity);
  EXPECT_NEAR(critical_step_stock(1e308, 0.0, 1e300), 2e-4, 1e-15); // no overflow on the way
}

TEST(CriticalStep, HoldsForTheSteppingItself) {
  const double m = 2000.0, k = 1e8, c = 2.0 * 0.5 * std::sqrt(k * m);
  const double limit = critical_step_stock(k, c, m);
  const auto forces = [&](double, const std::array<double, 1> &x, const std::array<double, 1> &v) {
    return std::array<double, 1>{-k * x[0] - c * v[0]};
  };
  for (const double share : {0.99, 1.01}) {
    stepping::Balls<1> ball{{m}, {1e-3}, {0.0}, {-k * 1e-3}};
    for (int n = 0; n < 20000; ++n)
      stepping::stock_step(ball, 0.0, share * limit, forces);
    if (share < 1.0)
      EXPECT_LT(std::fabs(ball.x[0]), 1e-9);
    else
      EXPECT_FALSE(std::fabs(ball.x[0]) < 1e3);
  }
}

TEST(CriticalStep, OfABallBetweenFixedPartnersIsExact) {
  const double m = 2000.0;
  const Chain chain{{m}, {{0, -1, 1e8, 2e5}, {0, -1, 3e7, 9e5}, {0, -1, 1e6, 0.0}}};
  EXPECT_NEAR(bound(chain), true_limit(chain, bound(chain)), 1e-4 * bound(chain));
  EXPECT_NEAR(bound(chain), critical_step_stock(1.31e8, 1.1e6, m), 1e-14 * bound(chain));
}

TEST(CriticalStep, OfAFreePairIsExact) {
  const Chain chain{{300.0, 2000.0}, {{0, 1, 1e8, 2e5}}};
  EXPECT_NEAR(bound(chain), true_limit(chain, bound(chain)), 1e-4 * bound(chain));
}

TEST(CriticalStep, OfALongRowOfLikeBallsIsClose) {
  Chain chain{std::vector<double>(40, 1.0), {}};
  for (int i = 0; i + 1 < 40; ++i)
    chain.springs.push_back({i, i + 1, 1.0, 0.1});
  const double limit = true_limit(chain, bound(chain));
  EXPECT_LE(bound(chain), limit * (1.0 + 1e-9));
  EXPECT_GT(bound(chain), 0.98 * limit);
}

TEST(CriticalStep, NeverExceedsTheTrueLimitOfRandomChains) {
  std::mt19937 random(32452843);
  std::uniform_real_distribution<double> decade(-2.0, 2.0), unit(0.0, 1.0);
  const auto spread = [&](double middle) { return middle * std::pow(10.0, decade(random)); };
  double tightest = 0.0;
  for (int trial = 0; trial < 400; ++trial) {
    Chain chain;
    const int balls = 1 + static_cast<int>(8.0 * unit(random));
    for (int i = 0; i < balls; ++i)
      chain.mass.push_back(spread(100.0));
    const auto link = [&](int one, int other) {
      const double k = spread(1e7);
      chain.springs.push_back(
          {one, other, k, 2.0 * spread(0.3) * std::sqrt(k * chain.mass[static_cast<std::size_t>(one)])});
    };
    for (int i = 0; i < balls; ++i) {
      if (i == 0 || unit(random) < 0.2) link(i, -1);
      if (i + 1 < balls) link(i, i + 1);
      if (i + 2 < balls && unit(random) < 0.3) link(i, i + 2); // more than a chain
    }
    const double safe = bound(chain);
    ASSERT_GT(safe, 0.0);
    const double limit = true_limit(chain, safe);
    ASSERT_LE(safe, limit * (1.0 + 1e-9)) << "trial " << trial;
    ASSERT_LE(growth(chain, safe * (1.0 - 1e-9)), 1.0 + 1e-6) << "trial " << trial;
    tightest = std::max(tightest, safe / limit);
  }
  EXPECT_GT(tightest, 0.99); // a bound of zero would be safe too
}

TEST(CriticalStep, WithoutLinksIsUnlimited) {
  EXPECT_EQ(critical_step_stock(1.0, std::vector<Link>{}), infinity);
  EXPECT_EQ(critical_step_stock(1.0, std::array<Link, 1>{{{0.0, 0.0}}}), infinity);
}

TEST(Figures, OfAContact) {
  EXPECT_DOUBLE_EQ(angular_frequency(1e8, 1e4), 100.0);
  EXPECT_DOUBLE_EQ(damping_ratio(1e8, 4e5, 4.0 * 1e2), 1.0);
  // An undamped impact of the stock stepping ends after half a period.
  const double m = 2000.0, k = 1e8, dt = 1e-6;
  stepping::Balls<1> ball{{m}, {0.0}, {0.4}};
  int steps = 0;
  do {
    stepping::stock_step(ball, 0.0, dt,
                         [&](double, const std::array<double, 1> &x, const std::array<double, 1> &) {
                           return std::array<double, 1>{-k * x[0]};
                         });
    ++steps;
  } while (ball.x[0] > 0.0);
  EXPECT_NEAR(steps_per_contact(k, m, dt), steps, 1.0);
}

} // namespace
