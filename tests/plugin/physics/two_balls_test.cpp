/// Two balls: momentum, the effective mass, and the same motion seen from frames that move.

#include "physics/laws/linear_contact.h"
#include "tests/plugin/physics/velocity_verlet.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace {

using namespace drumlin::physics;
using Pair = std::array<double, 2>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double k = 1e8, dt = 2e-6;

class TwoBalls : public testing::TestWithParam<Transition> {};

/// Ball 0 below, ball 1 above, radii left out: d = x0 - x1.
Pair contact_forces(Transition transition, double c, const Pair &x, const Pair &v) {
  const double force = LinearLaw(k, c, transition).force(x[0] - x[1], v[0] - v[1]);
  return {-force, force};
}

TEST_P(TwoBalls, KeepTheirMomentum) {
  verlet::Balls<2> pair{{1500.0, 700.0}, {0.0, 1e-4}, {0.7, -0.9}};
  const double c = LinearContact{k, 0.3, Damping::ratio, GetParam()}.damping_coefficient(
      effective_mass(pair.mass[0], pair.mass[1]));
  const double before = pair.mass[0] * pair.v[0] + pair.mass[1] * pair.v[1];
  double strongest = 0.0;
  for (int n = 0; n < 20000; ++n) {
    verlet::stock_step(pair, 0.0, dt, [&](double, const Pair &x, const Pair &v) {
      return contact_forces(GetParam(), c, x, v);
    });
    strongest = std::fmax(strongest, pair.force[1]);
    ASSERT_NEAR(pair.mass[0] * pair.v[0] + pair.mass[1] * pair.v[1], before, 1e-11 * 1000.0);
  }
  EXPECT_GT(strongest, 1e5);            // they did meet
  EXPECT_GT(pair.v[1], pair.v[0] + .1); // and parted
}

TEST_P(TwoBalls, MoveRelativeToEachOtherAsTheEffectiveMassOnAFixedBall) {
  verlet::Balls<2> pair{{1500.0, 700.0}, {0.0, 0.0}, {0.7, -0.9}};
  const double m_eff = effective_mass(1500.0, 700.0);
  verlet::Balls<2> fixed{{infinity, m_eff}, {0.0, 0.0}, {0.0, -1.6}};
  const LinearContact contact{k, 0.3, Damping::ratio, GetParam()};
  const double c = contact.damping_coefficient(m_eff);
  ASSERT_EQ(contact.damping_coefficient(effective_mass(infinity, m_eff)), c);
  const auto forces = [&](double, const Pair &x, const Pair &v) {
    return contact_forces(GetParam(), c, x, v);
  };
  for (int n = 0; n < 20000; ++n) {
    verlet::stock_step(pair, 0.0, dt, forces);
    verlet::stock_step(fixed, 0.0, dt, forces);
    ASSERT_NEAR(pair.v[1] - pair.v[0], fixed.v[1] - fixed.v[0], 1e-10);
    ASSERT_NEAR(pair.x[1] - pair.x[0], fixed.x[1] - fixed.x[0], 1e-12);
  }
  EXPECT_GT(fixed.v[1], 0.1);
}

/// A drum pressed down and shaken on the ball below for several bounces. Returns overlap and its rate at
/// every 100th step.
struct Shaken {
  std::array<double, 2> mass, drive; ///< kg; share of the drive that each ball takes, as acceleration
  std::array<double, 2> start_velocity{};
};

std::vector<Pair> overlaps(Transition transition, const Shaken &run) {
  const double m = 2000.0, w = 251.32741228718345;
  const double c = LinearContact{k, 0.5, Damping::ratio, transition}.damping_coefficient(m);
  verlet::Balls<2> balls{run.mass, {0.0, 0.0}, run.start_velocity};
  std::vector<Pair> record;
  for (int n = 1; n <= 100000; ++n) {
    const double push = 15.0 + 30.0 * std::sin(w * n * dt); // m/s2, how the two are driven towards each other
    verlet::stock_step(balls, n * dt, dt, [&](double, const Pair &x, const Pair &v) {
      Pair force = contact_forces(transition, c, x, v);
      for (std::size_t i = 0; i < 2; ++i) {
        if (std::isinf(run.mass[i])) continue;
        force[i] += run.drive[i] * run.mass[i] * push;
      }
      return force;
    });
    if (n % 100 == 0) record.push_back({balls.x[0] - balls.x[1], balls.v[0] - balls.v[1]});
  }
  return record;
}

void expect_same(const std::vector<Pair> &one, const std::vector<Pair> &other) {
  ASSERT_EQ(one.size(), other.size());
  bool apart = false, together = false;
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_NEAR(one[i][0], other[i][0], 1e-10) << i;
    ASSERT_NEAR(one[i][1], other[i][1], 1e-7) << i;
    apart = apart || one[i][0] < 0.0;
    together = together || one[i][0] > 0.0;
  }
  EXPECT_TRUE(apart && together);
}

TEST_P(TwoBalls, AreTheSameWhicheverOfThemIsFixed) {
  const Shaken drum{{infinity, 2000.0}, {0.0, -1.0}};
  const Shaken soil{{2000.0, infinity}, {1.0, 0.0}};
  expect_same(overlaps(GetParam(), drum), overlaps(GetParam(), soil));
}

TEST_P(TwoBalls, AreTheSameInAFrameThatMoves) {
  const Shaken rest{{infinity, 2000.0}, {0.0, -1.0}};
  const Shaken moving{{infinity, 2000.0}, {0.0, -1.0}, {0.3, 0.3}};
  expect_same(overlaps(GetParam(), rest), overlaps(GetParam(), moving));
}

TEST_P(TwoBalls, AreTheSameInAFrameThatAccelerates) {
  // A soil so heavy that the contact does not move it, shaken from below, against a shaken drum.
  const Shaken drum{{infinity, 2000.0}, {0.0, -1.0}};
  const Shaken table{{2000.0e15, 2000.0}, {1.0, 0.0}};
  expect_same(overlaps(GetParam(), drum), overlaps(GetParam(), table));
}

INSTANTIATE_TEST_SUITE_P(, TwoBalls, testing::Values(Transition::A, Transition::B),
                         [](const auto &row) { return row.param == Transition::A ? "A" : "B"; });

} // namespace
