/// Stability limits against the eigenvalues of the matrix of one step with `stepping stock`.

#include "physics/scheme/advance.h"
#include "physics/laws/linear_contact.h"
#include "physics/scheme/stability_limit.h"
#include "tests/core/velocity_verlet.h"
#include "tests/support/eigenvalues.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace {

using namespace drumlin::physics;

constexpr double pi = 3.141592653589793;
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
/// entry as the stepping does it: a = -(K x + C v)/m, v += dt a, x += dt v. Rigid motion has the eigenvalue
/// 1.
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
  return oracle::eigenvalues_of(step).cwiseAbs().maxCoeff();
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
  std::vector<LoadedBall> balls(chain.mass.size());
  for (const Spring &s : chain.springs) {
    const auto inverse = [&](int ball) {
      return ball < 0 ? 0.0 : 1.0 / chain.mass[static_cast<std::size_t>(ball)];
    };
    const double inverse_mass = inverse(s.one) + inverse(s.other);
    for (const auto &[ball, partner] : {std::pair(s.one, s.other), std::pair(s.other, s.one)}) {
      if (ball < 0) continue;
      LinkModes link{{0.6, 0.0, 0.8}, s.k * inverse_mass, s.c * inverse_mass};
      link.burden = link_burden(inverse(ball), inverse(partner));
      balls[static_cast<std::size_t>(ball)].add(link);
    }
  }
  double least = infinity;
  for (const LoadedBall &ball : balls)
    least = std::min(least, ball.critical_step());
  return least;
}

/// Expects that the bound is safe, and at least this share of the true limit.
void expect_close(const Chain &chain, double share) {
  const double limit = true_limit(chain, bound(chain));
  EXPECT_LE(bound(chain), limit * (1.0 + 1e-9));
  EXPECT_GT(bound(chain), share * limit);
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

TEST(CriticalStep, OfABallBetweenFixedPartnersIsExact) {
  const double m = 2000.0;
  const Chain chain{{m}, {{0, -1, 1e8, 2e5}, {0, -1, 3e7, 9e5}, {0, -1, 1e6, 0.0}}};
  EXPECT_NEAR(bound(chain), true_limit(chain, bound(chain)), 1e-4 * bound(chain));
  EXPECT_NEAR(bound(chain), critical_step_stock(1.31e8, 1.1e6, m), 1e-14 * bound(chain));
}

TEST(CriticalStep, OfAFreePairIsExactForLikeBallsAndCloseForOthers) {
  const Chain like{{300.0, 300.0}, {{0, 1, 1e8, 2e5}}};
  EXPECT_NEAR(bound(like), true_limit(like, bound(like)), 1e-4 * bound(like));
  expect_close({{300.0, 2000.0}, {{0, 1, 1e8, 2e5}}}, 0.85);
}

// The drum on many soil balls: each of them sets the step, not all together.
TEST(CriticalStep, OfAHeavyBallOnManyLightOnesIsClose) {
  Chain chain{std::vector<double>(21, 3.3), {}};
  chain.mass[0] = 2000.0;
  for (int i = 1; i <= 20; ++i) {
    chain.springs.push_back({0, i, 1e8, 1e3});
    chain.springs.push_back({i, -1, 1e8, 1e3});
  }
  expect_close(chain, 0.97);
}

TEST(CriticalStep, OfALongRowOfLikeBallsIsClose) {
  Chain chain{std::vector<double>(40, 1.0), {}};
  for (int i = 0; i + 1 < 40; ++i)
    chain.springs.push_back({i, i + 1, 1.0, 0.1});
  expect_close(chain, 0.98);
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

TEST(CriticalStep, WithoutLinksIsUnlimited) { EXPECT_EQ(LoadedBall().critical_step(), infinity); }

/// Balls in a plane that touch and rub: normal springs and dashpots by second-order stepping, shear springs
/// and dashpots by the half-step velocity, as in the engine.
struct Packing {
  struct Contact {
    int one, other; ///< other -1: a fixed partner
    double angle;   ///< of the normal, from `other` to `one`
    double k, c, kt, ct;
  };
  std::vector<double> mass;
  double mass_over_inertia; ///< m r^2 / I, of balls of radius 1
  bool second;              ///< else stock
  std::vector<Contact> contacts;

  double inverse_mass(int ball) const { return ball < 0 ? 0.0 : 1.0 / mass[static_cast<std::size_t>(ball)]; }

  double bound() const {
    std::vector<LoadedBall> balls(mass.size());
    for (const Contact &p : contacts) {
      const double inverse = inverse_mass(p.one) + inverse_mass(p.other);
      const double m_t = tangential_mass(inverse_mass(p.one), inverse_mass(p.other), mass_over_inertia);
      for (const auto &[ball, partner] : {std::pair(p.one, p.other), std::pair(p.other, p.one)}) {
        if (ball < 0) continue;
        LinkModes link{{std::cos(p.angle), std::sin(p.angle), 0.0},
                       p.k * inverse,
                       second ? 0.0 : p.c * inverse,
                       p.kt / m_t,
                       p.ct / m_t};
        link.burden = link_burden(inverse_mass(ball), inverse_mass(partner));
        balls[static_cast<std::size_t>(ball)].add(link);
      }
    }
    double least = infinity;
    for (const LoadedBall &ball : balls)
      least = std::min(least, ball.critical_step());
    return least;
  }

  /// Largest magnitude of the eigenvalues of a step. Longer than other functions: the parts of a step all
  /// change the same vector of positions, velocities and forces.
  double growth(double dt, bool all_coupled = false) const {
    const auto n =
        static_cast<Eigen::Index>(6 * mass.size()); // of each ball x, y, turn, and dt times their rates
    const Eigen::Index size = n + 3 * static_cast<Eigen::Index>(contacts.size());
    std::vector<double> damping(mass.size(), 0.0);
    for (const Contact &p : contacts)
      for (const int ball : {p.one, p.other})
        if (ball >= 0) damping[static_cast<std::size_t>(ball)] += std::sqrt(p.c) * inverse_mass(ball);

    Eigen::MatrixXd step(size, size);
    for (Eigen::Index column = 0; column < size; ++column) {
      Eigen::VectorXd u = Eigen::VectorXd::Unit(size, column);
      const Eigen::VectorXd before = u;
      const auto kick = [&] {
        for (std::size_t l = 0; l < contacts.size(); ++l) {
          const Contact &p = contacts[l];
          const double normal = u(of(l, force)), shearing = u(of(l, drag));
          for (const int ball : {p.one, p.other}) {
            if (ball < 0) continue;
            const double half = 0.5 * inverse_mass(ball), sign = ball == p.one ? 1.0 : -1.0;
            u(6 * ball + 3) += half * sign * (normal * std::cos(p.angle) - shearing * std::sin(p.angle));
            u(6 * ball + 4) += half * sign * (normal * std::sin(p.angle) + shearing * std::cos(p.angle));
            u(6 * ball + 5) -= half * mass_over_inertia * shearing;
          }
        }
      };
      kick();
      for (Eigen::Index ball = 0; ball < n; ball += 6)
        u.segment(ball, 3) += u.segment(ball + 3, 3);
      std::vector<std::pair<std::size_t, CoupledDashpot>> coupled;
      for (std::size_t l = 0; l < contacts.size(); ++l) {
        const Contact &p = contacts[l];
        const auto relative = [&](const Eigen::VectorXd &w, int what) {
          return w(6 * p.one + what) - (p.other < 0 ? 0.0 : w(6 * p.other + what));
        };
        const auto overlap = [&](const Eigen::VectorXd &w, int what) {
          return -std::cos(p.angle) * relative(w, what) - std::sin(p.angle) * relative(w, what + 1);
        };
        const double slide = -std::sin(p.angle) * relative(u, 3) + std::cos(p.angle) * relative(u, 4) -
                             u(6 * p.one + 5) - (p.other < 0 ? 0.0 : u(6 * p.other + 5));
        const double own_inverse = inverse_mass(p.one) + inverse_mass(p.other);
        const double all = damping[static_cast<std::size_t>(p.one)] +
                           (p.other < 0 ? 0.0 : damping[static_cast<std::size_t>(p.other)]);
        // The motion is about a state of rest in which all contacts overlap, so that none ends.
        const double depth = 1e3;
        const LinearLaw law(p.k, p.c, Transition::A);
        const StepMotion motion{depth + overlap(u, 0), overlap(u, 3) / dt, overlap(before, 3) / dt, dt};
        double &normal = u(of(l, force)); // forces as dt^2 times the force, less that at rest
        ContactState state{p.k * depth + normal / (dt * dt), true};
        StepResult result = second ? advance(law, motion, state, {1.0 / own_inverse, all, false})
                                   : advance_stock(law, motion, state);
        if (second && all_coupled) { // whatever needs_coupling() says
          result.coupled = true;
          result.dashpot = coupled_dashpot(law, motion, p.k * depth + normal / (dt * dt), all);
          result.kick = result.dashpot.first;
        }
        if (result.coupled) coupled.emplace_back(l, result.dashpot);
        normal = dt * dt * (result.kick - p.k * depth);
        u(of(l, shear)) += slide;
        u(of(l, drag)) = -dt * dt * (p.kt * u(of(l, shear)) + p.ct * slide / dt);
      }
      const Eigen::VectorXd drifted = u;
      kick();
      const Eigen::VectorXd predicted = u;
      for (const auto &[l, dashpot] : coupled) {
        const Contact &p = contacts[l];
        const auto along = [&](int ball) {
          return ball < 0 ? 0.0
                          : std::cos(p.angle) * predicted(6 * ball + 3) +
                                std::sin(p.angle) * predicted(6 * ball + 4);
        };
        u(of(l, force)) =
            dt * dt * (coupled_force(dashpot, -(along(p.one) - along(p.other)) / dt) - p.k * 1e3);
      }
      u.head(n) = drifted.head(n);
      kick();
      step.col(column) = u;
    }
    const Eigen::VectorXd balance = scale(size);
    return oracle::eigenvalues_of(balance.cwiseInverse().asDiagonal() * step * balance.asDiagonal())
        .cwiseAbs()
        .maxCoeff();
  }

private:
  enum What { shear, force, drag };
  Eigen::Index of(std::size_t contact, What what) const {
    return static_cast<Eigen::Index>(6 * mass.size() + 3 * contact) + what;
  }
  /// Forces in the size of a mass: what is left are numbers near 1.
  Eigen::VectorXd scale(Eigen::Index size) const {
    Eigen::VectorXd result = Eigen::VectorXd::Ones(size);
    for (std::size_t l = 0; l < contacts.size(); ++l)
      result(of(l, force)) = result(of(l, drag)) = 1.0 / inverse_mass(contacts[l].one);
    return result;
  }
};

/// Balls linked at random to one another and to fixed partners, damping ratios from 0 to 1e4, under the
/// second-order scheme to 1e10 beside such ones.
Packing random_packing(std::mt19937 &random, bool second, bool rubbing) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Packing packing{{}, unit(random) < 0.5 ? 2.5 : 2.0, second, {}};
  const int balls = 1 + static_cast<int>(6.0 * unit(random));
  for (int i = 0; i < balls; ++i)
    packing.mass.push_back(std::pow(10.0, 3.0 * unit(random)));
  const double level = std::pow(10.0, -2.0 + 6.0 * unit(random)); // of the damping in this packing
  const auto link = [&](int one, int other) {
    const double k = 1e6 * std::pow(10.0, 2.0 * unit(random));
    const double inverse = packing.inverse_mass(one) + packing.inverse_mass(other);
    const double heavier = second && unit(random) < 0.2 ? std::pow(10.0, 6.0 * unit(random)) : 1.0;
    const double c = unit(random) < 0.2 ? 0.0 : 2.0 * heavier * level * std::sqrt(k / inverse) * unit(random);
    const double kt = rubbing ? k * unit(random) : 0.0;
    packing.contacts.push_back({one, other, 2.0 * pi * unit(random), k, c, kt,
                                rubbing ? 0.5 * unit(random) * std::sqrt(kt / inverse) : 0.0});
  };
  for (int i = 0; i < balls; ++i) {
    const int links = 1 + static_cast<int>(4.0 * unit(random));
    for (int l = 0; l < links; ++l) {
      const int other = static_cast<int>((balls + 1) * unit(random)) - 1;
      link(i, other == i ? -1 : other);
    }
  }
  return packing;
}

struct Search {
  const char *name;
  bool second, rubbing;
  bool all_coupled; ///< whatever needs_coupling() says
  double share;     ///< of the bound, that must be safe
};

class PackingTest : public ::testing::TestWithParam<Search> {};

TEST_P(PackingTest, IsStableUpToTheBound) {
  const Search search = GetParam();
  std::mt19937 random(49979687);
  double tightest = 0.0;
  for (int trial = 0; trial < 200; ++trial) {
    const Packing packing = random_packing(random, search.second, search.rubbing);
    const double bound = packing.bound();
    for (const double share : {0.2, 0.5, 0.7, 1.0})
      ASSERT_LE(packing.growth(share * search.share * bound, search.all_coupled), 1.0 + 1e-5)
          << "trial " << trial << ", " << share;
    if (packing.growth(1.03 * bound, search.all_coupled) > 1.0 + 1e-4) tightest = 1.0;
  }
  EXPECT_EQ(tightest, 1.0); // a bound of zero would be safe too
}

INSTANTIATE_TEST_SUITE_P(CriticalStep, PackingTest,
                         ::testing::Values(Search{"stock", false, false, false, 0.999},
                                           Search{"stock_rubbing", false, true, false, 0.999},
                                           Search{"all_coupled", true, false, true, 0.999},
                                           Search{"second", true, false, false, 0.7},
                                           Search{"second_rubbing", true, true, false, 0.7}),
                         [](const auto &search) { return search.param.name; });

TEST(Figures, OfAContact) {
  EXPECT_DOUBLE_EQ(angular_frequency(1e8, 1e4), 100.0);
  EXPECT_DOUBLE_EQ(damping_ratio(1e8, 4e5, 4.0 * 1e2), 1.0);
  // An undamped impact of the stock stepping ends after half a period.
  const double m = 2000.0, k = 1e8, dt = 1e-6;
  verlet::Ball<LinearLaw> ball(m, 0.0, -0.4, dt, {{0.0, 1.0, {k, 0.0, Transition::B}}}, 0.0,
                               verlet::Scheme::stock);
  int steps = 0;
  do {
    ball.step();
    ++steps;
  } while (ball.x < 0.0);
  EXPECT_NEAR(steps_per_contact(k, m, dt), steps, 1.0);
}

} // namespace
