// Friction and rolling resistance of a contact.
#include "tests/core/vectors.h"
#include "tests/support/ode.h"
#include "tests/support/oscillator.h"
#include "physics/laws/friction_law.h"
#include "physics/laws/linear_contact.h"
#include "physics/laws/rolling_law.h"

namespace drumlin::test {
namespace {

using namespace drumlin::physics;

/// Friction: closed forms, CVODE with a mode for sticking and one for sliding, the readings of the limit,
/// energy; of Cap::coulomb limit and energy in every step. Whole impacts: oblique_impact_test.cpp.
namespace friction_law {

using drumlin::test::decades;
using drumlin::test::length;

constexpr double kt = 1e4, ct = 40.0, mu = 0.5;
const Vec3 up{0.0, 0.0, 1.0};
const Vec3 none{};

const char *name_of(Cap cap) {
  return cap == Cap::spring ? "spring" : cap == Cap::total ? "total" : "coulomb";
}

class EitherCap : public testing::TestWithParam<Cap> {
protected:
  Friction friction{kt, ct, mu, GetParam()};
};
INSTANTIATE_TEST_SUITE_P(, EitherCap, testing::Values(Cap::spring, Cap::total, Cap::coulomb),
                         [](const auto &row) { return name_of(row.param); });

TEST_P(EitherCap, SticksAsADampedOscillator) { // the spring follows the closed form, the force is its m x''
  const oracle::Oscillator closed{1.0, kt, ct};
  const Vec3 along{1.0 / 3.0, 2.0 / 3.0, -2.0 / 3.0}, normal{2.0 / 3.0, 1.0 / 3.0, 2.0 / 3.0};
  const double dt = 1e-5;
  Vec3 spring{};
  for (int n = 0; n < 10000; ++n) {
    const oracle::Motion middle = closed.at((n + 0.5) * dt, 0.0, 1.0);
    const FrictionStep step = friction_step(friction, 1e6, normal, scaled(middle.v, along), spring, dt);
    ASSERT_FALSE(step.sliding);
    spring = step.spring;
    const oracle::Motion now = closed.at((n + 1) * dt, 0.0, 1.0);
    const FrictionStep still = friction_step(friction, 1e6, normal, scaled(now.v, along), spring, 0.0);
    ASSERT_NEAR(dot(still.force, along), now.a, 1e-4);
    ASSERT_NEAR(length(still.force), std::fabs(now.a), 1e-4);
    ASSERT_NEAR(still.stored, 0.5 * kt * now.x * now.x, 1e-5);
  }
}

TEST_P(EitherCap, SlidesWithTheCoulombForce) {
  const Vec3 v{0.3, -0.4, 0.0};
  for (const double normal_force : {100.0, -100.0}) { // in tension too
    if (GetParam() == Cap::coulomb && normal_force < 0.0) continue;
    Vec3 spring{};
    for (int n = 0; n < 5000; ++n)
      spring = friction_step(friction, normal_force, up, v, spring, 1e-4).spring;
    const FrictionStep step = friction_step(friction, normal_force, up, v, spring, 1e-4);
    EXPECT_TRUE(step.sliding);
    EXPECT_NEAR(length(step.force), 50.0, 1e-10);
    EXPECT_NEAR(dot(step.force, v), -50.0 * 0.5, 1e-10); // straight against the motion
    EXPECT_NEAR(step.dissipated, 50.0 * 0.5 * 1e-4, 1e-14);
    // Force of the spring: the whole limit, or the limit less the force of the dashpot.
    const double spring_force = GetParam() == Cap::total ? 50.0 - ct * 0.5 : 50.0;
    EXPECT_NEAR(kt * length(step.spring), spring_force, 1e-9);
    EXPECT_NEAR(step.stored, 0.5 * spring_force * spring_force / kt, 1e-10);
  }
}

TEST_P(EitherCap, HasNoForceWithoutNormalForce) {
  const FrictionStep step = friction_step(friction, 0.0, up, {1.0, 0.0, 0.0}, {1e-3, 2e-3, 0.0}, 1e-5);
  EXPECT_EQ(length(step.force), 0.0);
  EXPECT_TRUE(step.sliding);
  const FrictionStep rest = friction_step(friction, 0.0, up, none, none, 1e-5);
  EXPECT_EQ(length(rest.force), 0.0);
  EXPECT_EQ(length(rest.spring), 0.0);
}

TEST_P(EitherCap, KeepsTheSpringInTheTangentPlane) {
  const double tilt = 0.1;
  const Vec3 normal{std::sin(tilt), 0.0, std::cos(tilt)};
  const FrictionStep step = friction_step(friction, 1e6, normal, none, {1e-3, 2e-3, 0.0}, 1e-5);
  EXPECT_NEAR(dot(step.spring, normal), 0.0, 1e-18);
  EXPECT_NEAR(dot(step.force, normal), 0.0, 1e-12);
  EXPECT_NEAR(step.spring[1], 2e-3, 1e-18);
  EXPECT_NEAR(length(step.spring), std::hypot(1e-3 * std::cos(tilt), 2e-3), 1e-16);
  const FrictionStep flipped =
      friction_step(friction, 1e6, scaled(-1.0, normal), none, {1e-3, 2e-3, 0.0}, 1e-5);
  EXPECT_EQ(step.force, flipped.force);
  const double before = 0.5 * kt * 5e-6;
  EXPECT_NEAR(step.stored + step.dissipated, before, 1e-15);
}

// The set-up of a run computes the force of the step before it again, from the spring that this has left.
TEST_P(EitherCap, IsTheSameAfterTheStep) {
  std::mt19937 random(86028121);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  int slid = 0;
  for (int n = 0; n < 1000; ++n) {
    const Vec3 v{any(random), any(random), 0.0}, before{0.0035 * any(random), 0.0035 * any(random), 0.0};
    const FrictionStep step = friction_step(friction, 100.0, up, v, before, 3e-3);
    const FrictionStep again = friction_step(friction, 100.0, up, v, step.spring, 0.0);
    for (std::size_t a = 0; a < 3; ++a)
      ASSERT_NEAR(again.force[a], step.force[a], 1e-9);
    slid += step.sliding ? 1 : 0;
  }
  EXPECT_GT(slid, 100);
  EXPECT_LT(slid, 900);
}

TEST_P(EitherCap, DoesNotMoveTheSpringInNoTime) {
  const Vec3 spring{1e-3, 0.0, 0.0};
  const FrictionStep step = friction_step(friction, 1e6, up, {0.5, 0.0, 0.0}, spring, 0.0);
  EXPECT_EQ(step.spring, spring);
  EXPECT_NEAR(step.force[0], -10.0 - 20.0, 1e-12);
  EXPECT_EQ(step.dissipated, 0.0);
}

TEST(Caps, DifferWhereOnlyTheDashpotIsBeyondTheLimit) {
  // Spring 40 N, dashpot 20 N, limit 50 N.
  const Vec3 spring{4e-3, 0.0, 0.0}, v{0.5, 0.0, 0.0};
  const FrictionStep lig = friction_step({kt, ct, mu, Cap::spring}, 100.0, up, v, spring, 0.0);
  EXPECT_FALSE(lig.sliding);
  EXPECT_NEAR(lig.force[0], -60.0, 1e-12); // beyond mu Fn
  EXPECT_EQ(lig.spring, spring);
  const FrictionStep lmp = friction_step({kt, ct, mu, Cap::total}, 100.0, up, v, spring, 0.0);
  EXPECT_TRUE(lmp.sliding);
  EXPECT_NEAR(lmp.force[0], -50.0, 1e-12);
  EXPECT_NEAR(lmp.spring[0], 3e-3, 1e-15); // 30 N, and the dashpot's 20
}

TEST(Caps, DifferWhereTheSpringSlidesAgainstTheDashpot) {
  // Spring 60 N one way, dashpot 20 N the other way, limit 50 N: only the spring alone is beyond it.
  const Vec3 spring{6e-3, 0.0, 0.0}, v{-0.5, 0.0, 0.0};
  const FrictionStep lig = friction_step({kt, ct, mu, Cap::spring}, 100.0, up, v, spring, 0.0);
  EXPECT_TRUE(lig.sliding);
  EXPECT_NEAR(lig.force[0], -50.0, 1e-12); // the dashpot is dropped
  EXPECT_NEAR(lig.spring[0], 5e-3, 1e-15);
  const FrictionStep lmp = friction_step({kt, ct, mu, Cap::total}, 100.0, up, v, spring, 0.0);
  EXPECT_FALSE(lmp.sliding);
  EXPECT_NEAR(lmp.force[0], -40.0, 1e-12);
}

TEST(Caps, CoincideWithoutDashpotAndFarFromTheLimit) {
  std::mt19937 random(15485863);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int sliding = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 v{unit(random), unit(random), 0.0}, spring{1e-2 * unit(random), 1e-2 * unit(random), 0.0};
    const FrictionStep a = friction_step({kt, 0.0, mu, Cap::spring}, 100.0, up, v, spring, 1e-5);
    const FrictionStep b = friction_step({kt, 0.0, mu, Cap::total}, 100.0, up, v, spring, 1e-5);
    ASSERT_EQ(a.sliding, b.sliding);
    for (std::size_t j = 0; j < 3; ++j) {
      ASSERT_NEAR(a.force[j], b.force[j], 1e-10);
      ASSERT_NEAR(a.spring[j], b.spring[j], 1e-14);
    }
    ASSERT_NEAR(a.dissipated, b.dissipated, 1e-14);
    if (a.sliding) ++sliding;
    const FrictionStep c = friction_step({kt, ct, mu, Cap::spring}, 1e6, up, v, spring, 1e-5);
    const FrictionStep d = friction_step({kt, ct, mu, Cap::total}, 1e6, up, v, spring, 1e-5);
    ASSERT_EQ(c.force, d.force);
    ASSERT_EQ(c.spring, d.spring);
  }
  EXPECT_GT(sliding, 200);
  EXPECT_LT(sliding, 1800);
}

/// A block of 1 kg thrown at 1 m/s on the spring and dashpot of friction (limit 50 N): sticks, slides, sticks
/// and swings out.
struct Thrown {
  double x, v;
};

Thrown thrown_core(const Friction &friction, double t) {
  const int steps = 400000;
  const double dt = t / steps;
  Thrown block{0.0, 1.0};
  Vec3 spring{};
  for (int n = 0; n < steps; ++n) {
    const FrictionStep step = friction_step(friction, 100.0, up, {block.v, 0.0, 0.0}, spring, dt);
    spring = step.spring;
    block.x += dt * block.v;
    block.v += dt * step.force[0];
  }
  return block;
}

/// An event that is zero where its mode begins happens this far below zero.
constexpr double just = 1e-9;

Thrown thrown_cvode(Cap cap, double damping, double t) {
  const double limit = 50.0;
  bool sliding = false;
  oracle::Ode block( // y = place, velocity, spring
      [&](double, const oracle::State &y, oracle::State &f) {
        f[0] = y[1];
        f[1] = sliding ? -limit : -(kt * y[2] + damping * y[1]);
        if (!sliding)
          f[2] = y[1];
        else if (cap == Cap::coulomb)
          f[2] = damping > 0.0 ? (limit - kt * y[2]) / damping : 0.0; // keeps kt xi + ct xi' at the limit
        else
          f[2] = cap == Cap::spring ? 0.0
                                    : damping * limit / kt; // keeps kt xi + ct v at the limit, v' = -limit/m
      },
      0.0, {0.0, 1.0, 0.0}, {1e-2, 1.0, 1e-2});
  const auto pull = [&](const oracle::State &y) {
    return cap == Cap::spring ? kt * y[2] : kt * y[2] + damping * y[1];
  };
  int slides = 0;
  while (block.time() < t) {
    const oracle::Event next =
        sliding ? oracle::Event([&](double, const oracle::State &y) { // the trial pull stops growing
          if (cap == Cap::coulomb && damping > 0.0) return y[1] - (limit - kt * y[2]) / damping + just;
          return cap == Cap::total ? y[1] - damping * limit / kt : y[1];
        })
                : oracle::Event([&](double, const oracle::State &y) { return pull(y) - limit; });
    // After the one slide of this throw the block swings within the limit.
    const int event = slides == 1 && !sliding ? block.advance(t) : block.advance(t, {next});
    if (event < 0) break;
    sliding = !sliding;
    if (sliding) ++slides;
    block.restart(block.state());
  }
  EXPECT_EQ(slides, 1);
  return {block.state()[0], block.state()[1]};
}

TEST_P(EitherCap, ThrowsABlockAsCvodeDoes) {
  for (const double t : {0.01, 0.02, 0.05}) {
    const Thrown core = thrown_core(friction, t), exact = thrown_cvode(GetParam(), ct, t);
    EXPECT_NEAR(core.x, exact.x, 2e-7) << t;
    EXPECT_NEAR(core.v, exact.v, 2e-5) << t;
  }
}

TEST_P(EitherCap, ThrowsABlockAsTheClosedFormDoes) {
  // Without dashpot: w = 100/s, sticks until sin wt = 1/2, slides from v = sqrt(3)/2 with 50 m/s2, then
  // swings about the place where the spring is unstretched, 5 mm short of where it stopped.
  friction.damping = 0.0;
  const double v1 = std::sqrt(0.75), t1 = std::asin(0.5) / 100.0, t2 = t1 + v1 / 50.0;
  const double stop = 5e-3 + v1 * v1 / 100.0;
  const double t = t2 + 0.013;
  const Thrown core = thrown_core(friction, t);
  EXPECT_NEAR(core.x, stop - 5e-3 * (1.0 - std::cos(1.3)), 2e-7);
  EXPECT_NEAR(core.v, -0.5 * std::sin(1.3), 2e-5);
  const Thrown exact = thrown_cvode(GetParam(), 0.0, t);
  EXPECT_NEAR(exact.x, stop - 5e-3 * (1.0 - std::cos(1.3)), 1e-10);
}

/// A smooth path on a surface that turns, from stick to slide and back. Returns work - heat - stored, and the
/// least heat of a step.
struct Balance {
  double missing, heat, least;
  int sticking, sliding;
};

Balance balance(const Friction &friction, int steps) {
  const double dt = 0.2 / steps;
  Vec3 spring{};
  Balance sum{0.0, 0.0, 1.0, 0, 0};
  double stored = 0.0;
  for (int n = 0; n < steps; ++n) {
    const double t = (n + 0.5) * dt;
    const Vec3 normal{std::sin(2.0 * t), 0.0, std::cos(2.0 * t)};
    const Vec3 east = cross({0.0, 1.0, 0.0}, normal);
    const double v1 = 0.8 * std::cos(60.0 * t), v2 = 0.5 * std::sin(37.0 * t);
    const Vec3 v{v1 * east[0], v2, v1 * east[2]};
    const FrictionStep step =
        friction_step(friction, 100.0 + 30.0 * std::sin(90.0 * t), normal, v, spring, dt);
    spring = step.spring;
    stored = step.stored;
    sum.missing -= dot(step.force, v) * dt;
    sum.heat += step.dissipated;
    sum.least = std::min(sum.least, step.dissipated);
    ++(step.sliding ? sum.sliding : sum.sticking);
  }
  sum.missing -= sum.heat + stored;
  return sum;
}

TEST_P(EitherCap, WorkIsDissipatedOrStoredInTheSpring) {
  const Balance coarse = balance(friction, 20000), fine = balance(friction, 40000);
  EXPECT_GT(fine.sliding, 4000);
  EXPECT_GT(fine.sticking, 4000);
  EXPECT_GE(fine.least, 0.0); // ct |vt| <= mu |Fn| here
  EXPECT_GT(fine.heat, 1.0);
  EXPECT_LT(std::fabs(fine.missing), 1e-3 * fine.heat);
  EXPECT_NEAR(coarse.missing / fine.missing, 2.0,
              0.2); // the force of a step is the one at its end: first order
}

TEST(FrictionEnergy, IsNeverCreatedByCapSpring) {
  std::mt19937 random(49979687);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 v{unit(random), unit(random), 0.0},
        spring{1e-2 * unit(random), 1e-2 * unit(random), 1e-3 * unit(random)};
    const double fn = 100.0 * unit(random);
    ASSERT_GE(friction_step({kt, 10.0 * ct, mu, Cap::spring}, fn, up, v, spring, 1e-3).dissipated, 0.0);
    const bool within = ct * length(v) <= mu * std::fabs(fn);
    if (within) {
      ASSERT_GE(friction_step({kt, ct, mu, Cap::total}, fn, up, v, spring, 1e-3).dissipated, 0.0);
    }
  }
}

TEST(FrictionEnergy, IsCreatedByCapTotalWhereTheDashpotAloneIsBeyondTheLimit) {
  // No normal force: no force, no work; yet the spring is stretched against the motion and returns energy
  // later. `dissipated` is therefore negative.
  const FrictionStep step = friction_step({kt, ct, mu, Cap::total}, 0.0, up, {0.5, 0.0, 0.0}, none, 1e-6);
  EXPECT_EQ(length(step.force), 0.0);
  EXPECT_NEAR(step.stored, 0.5 * 20.0 * 20.0 / kt, 1e-12);
  EXPECT_LT(step.dissipated, 0.0);
}

/// A small ball that rolls without slip around the line through the centres of two large balls, one of which
/// is at the origin: in the middle of the step it is above the line, so that its velocity is along y and its
/// spin about x.
TEST(SlipOfAStep, IsZeroWhereABallRollsWithoutSlip) {
  const double height = 1.6, across = 5.0, large = 5.0, speed = 3.0;
  const double small = std::hypot(height, across) - large;
  for (const double dt : {1e-2, 1e-4, 0.0}) {
    const Vec3 v{0.0, speed, 0.0}, apart{across, 0.5 * dt * speed, height};
    const Vec3 normal = scaled(1.0 / length(apart), apart);
    const double arm = small * height / (large + small); // of the contact point from the axis of the spin
    const Vec3 turning{-small * speed / arm, 0.0, 0.0};
    const Vec3 slip = slip_velocity_of_step(v, normal_in_middle(apart, v, dt), normal, turning);
    EXPECT_LT(length(slip), 1e-14 * length(turning)) << dt;
    // The normal of the end of the step gives a slip in the first order of dt.
    EXPECT_NEAR(length(slip_velocity(v, normal, turning)),
                dt * 0.5 * speed * length(turning) * across / dot(apart, apart),
                1e-2 * dt * length(turning) + 1e-13)
        << dt;
  }
}

TEST(SlipOfAStep, IsAcrossTheNormalAndWithoutATurnTheSlipVelocity) {
  const Vec3 v{0.3, -0.4, 0.2}, apart{0.0, 0.0, 2.0}, turning{0.1, 0.2, 0.3};
  const Vec3 still = slip_velocity_of_step(v, normal_in_middle(apart, v, 0.0), up, turning),
             plain = slip_velocity(v, up, turning);
  for (std::size_t a = 0; a < 3; ++a)
    EXPECT_NEAR(still[a], plain[a], 1e-16);
  EXPECT_NEAR(dot(slip_velocity_of_step(v, normal_in_middle(apart, v, 0.1), up, turning), up), 0.0, 1e-16);
}

TEST(Coulomb, KeepsTheLimitAndIsPassiveInEveryStep) {
  std::mt19937 random(32452843);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto vector = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
  int sliding = 0, sticking = 0;
  for (int contact = 0; contact < 20000; ++contact) {
    const Friction friction{decades(random, 0, 8), contact % 5 == 0 ? 0.0 : decades(random, -4, 6),
                            contact % 7 == 0 ? 0.0 : decades(random, -2, 1), Cap::coulomb};
    const double dt = decades(random, -7, -2), size = decades(random, -3, 6), speed = decades(random, -4, 1);
    Vec3 normal = vector(), turn = vector(), spring{};
    double stored = 0.0;
    for (int n = 0; n < 50; ++n) {
      normal = drumlin::physics::sum(normal, 0.1, turn); // rolls
      normal = scaled(1.0 / length(normal), normal);
      const Vec3 any = scaled(speed, vector());
      const Vec3 v = drumlin::physics::sum(any, -dot(any, normal), normal);
      const double normal_force = size * (unit(random) + 0.5);
      const FrictionStep step = friction_step(friction, normal_force, normal, v, spring, dt);
      const double limit = friction.coefficient * std::max(0.0, normal_force);
      ASSERT_LE(length(step.force), limit * (1.0 + 1e-14));
      ASSERT_GE(step.dissipated, 0.0);
      // The work is not less than what is stored and what the step says is heat.
      const double work = -dot(step.force, v) * dt, change = step.stored - stored;
      const double noise = 1e-13 * (std::fabs(work) + step.stored + stored + step.dissipated);
      ASSERT_GE(work - change - step.dissipated, -noise);
      ASSERT_EQ(step.stored, 0.5 * friction.stiffness * dot(step.spring, step.spring));
      spring = step.spring;
      stored = step.stored;
      ++(step.sliding ? sliding : sticking);
    }
  }
  EXPECT_GT(sliding, 100000);
  EXPECT_GT(sticking, 100000);
}

// A step that is computed with one normal force and then limited to a smaller one is the step with the
// smaller one.
TEST(Coulomb, IsLimitedAfterwardsAsWithTheSmallerNormalForce) {
  std::mt19937 random(86028121);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int shortened = 0, kept = 0;
  for (int n = 0; n < 100000; ++n) {
    const double dt = n % 11 == 0 ? 0.0 : decades(random, -7, -2);
    const Friction friction{decades(random, 0, 8), n % 5 == 0 ? 0.0 : decades(random, -4, 6),
                            n % 7 == 0 ? 0.0 : decades(random, -2, 1), Cap::coulomb};
    const double first = decades(random, -3, 6), final = n % 3 == 0 ? -first : first * decades(random, -3, 0);
    const double speed = decades(random, -4, 1), stretch = decades(random, -8, -2);
    const Vec3 v{speed * unit(random), speed * unit(random), 0.0};
    const Vec3 spring{stretch * unit(random), stretch * unit(random), 0.0};
    const FrictionStep before = friction_step(friction, first, up, v, spring, dt),
                       expected = friction_step(friction, final, up, v, spring, dt);
    const PulledSpring now = limited_to(friction, final, {before.force, before.spring}, dt);
    const double pull = length(before.force), reach = length(before.spring) + length(spring);
    for (std::size_t a = 0; a < 3; ++a) {
      ASSERT_NEAR(now.force[a], expected.force[a], 1e-14 * pull);
      ASSERT_NEAR(now.spring[a], expected.spring[a], 1e-13 * reach);
    }
    ++(now.force == before.force ? kept : shortened);
  }
  EXPECT_GT(shortened, 10000);
  EXPECT_GT(kept, 10000);
}

TEST(Coulomb,
     LetsTheSpringFollowTheLimit) { // at rest, the limit falls: kt xi + ct xi' = L, xi from 10 to 5 mm
  const double dt = 1e-5, t = 4e-3;
  Vec3 spring{1e-2, 0.0, 0.0};
  for (int n = 0; n < 400; ++n) {
    const FrictionStep step = friction_step({kt, ct, mu, Cap::coulomb}, 100.0, up, none, spring, dt);
    ASSERT_NEAR(step.force[0], -50.0, 1e-12);
    spring = step.spring;
  }
  EXPECT_NEAR(spring[0], 5e-3 + 5e-3 * std::exp(-kt / ct * t), 5e-6);
}

TEST(Coulomb, HasNumbersAtTheEndsOfItsRange) {
  const Vec3 tiny{1e-300, 0.0, 0.0}, v{0.5, -0.2, 0.0};
  for (const double stiffness : {0.0, 1e-12, 1e30})
    for (const double damping : {0.0, 1e-12, 1e30})
      for (const double coefficient : {0.0, 0.5, 1e10})
        for (const double normal_force : {0.0, -100.0, 1e-100, 1e10})
          for (const Vec3 &velocity : {none, tiny, v})
            for (const Vec3 &spring : {none, tiny, Vec3{1e-3, 0.0, 0.0}})
              for (const double dt : {0.0, 1e-12, 1e-3}) {
                const FrictionStep step = friction_step({stiffness, damping, coefficient, Cap::coulomb},
                                                        normal_force, up, velocity, spring, dt);
                for (const double value :
                     {length(step.force), length(step.spring), step.dissipated, step.stored})
                  ASSERT_TRUE(std::isfinite(value));
                ASSERT_LE(length(step.force), coefficient * std::max(0.0, normal_force) * (1.0 + 1e-14));
                if (dt == 0.0) {
                  ASSERT_EQ(step.spring, spring);
                }
              }
}

TEST(FrictionWithoutHistory, IsADashpotUpToTheLimit) {
  const Friction friction{0.0, ct, mu, Cap::spring};
  const FrictionStep slow = friction_step_without_history(friction, 100.0, {0.6, 0.8, 0.0}, 1e-3);
  EXPECT_FALSE(slow.sliding);
  EXPECT_NEAR(slow.force[0], -24.0, 1e-12);
  EXPECT_NEAR(slow.force[1], -32.0, 1e-12);
  EXPECT_NEAR(slow.dissipated, 40.0 * 1e-3, 1e-15);
  const FrictionStep fast = friction_step_without_history(friction, -100.0, {6.0, 8.0, 0.0}, 1e-3);
  EXPECT_TRUE(fast.sliding);
  EXPECT_NEAR(fast.force[0], -30.0, 1e-12);
  EXPECT_NEAR(fast.force[1], -40.0, 1e-12);
  EXPECT_NEAR(fast.dissipated, 500.0 * 1e-3, 1e-12);
  for (const FrictionStep &step : {slow, fast}) {
    EXPECT_EQ(step.stored, 0.0);
    EXPECT_EQ(step.spring, none);
  }
  EXPECT_EQ(length(friction_step_without_history(friction, 100.0, none, 1e-3).force), 0.0);
  EXPECT_EQ(length(friction_step_without_history(friction, 0.0, none, 1e-3).force), 0.0);
}

TEST(FrictionWithoutHistory, StopsABlockAsTheClosedFormDoes) {
  // Slides with 50 m/s2 from 2 m/s down to mu Fn / ct = 1.25 m/s, then creeps to rest with the time 1/40 s.
  const Friction friction{0.0, ct, mu, Cap::spring};
  const int steps = 400000;
  const double end = 0.1, dt = end / steps, slide = (2.0 - 1.25) / 50.0;
  double v = 2.0;
  for (int n = 0; n < steps; ++n)
    v += dt * friction_step_without_history(friction, 100.0, {v, 0.0, 0.0}, dt).force[0];
  EXPECT_NEAR(v, 1.25 * std::exp(-40.0 * (end - slide)), 1e-5);
}

// A deck may give kt = 0: what slides then has no spring to reset.
TEST(Friction, OfADashpotAloneStoresNothing) {
  for (const Cap cap : {Cap::spring, Cap::total, Cap::coulomb}) {
    const FrictionStep step =
        friction_step({0.0, 10.0, 0.5, cap}, 4.0, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {}, 1e-3);
    EXPECT_DOUBLE_EQ(step.force[0], cap == Cap::spring ? -10.0 : -2.0);
    EXPECT_EQ(step.stored, 0.0);
    for (const double length : step.spring)
      EXPECT_TRUE(std::isfinite(length));
  }
}

} // namespace friction_law

// Rolling resistance: closed forms of the spring and of a ball that rolls to rest, CVODE with a mode for the
// spring and one for its limit, the plane of the torque, limit and energy in every step.
namespace rolling_law {

using drumlin::test::decades;
using drumlin::test::length;

constexpr double kt = 1e6, radius = 0.1, mu_r = 0.2, weight = 100.0;
constexpr double kr = kt * radius * radius;      // N m
constexpr double limit = mu_r * radius * weight; // N m
const Vec3 up{0.0, 0.0, 1.0};
const Vec3 none{};

Rolling resistance() { return rolling_of(kt, mu_r, radius); }

TEST(Rolling, TakesStiffnessAndLimitFromTheEffectiveRadius) {
  EXPECT_DOUBLE_EQ(effective_radius(0.1, 0.3), 0.075);
  EXPECT_DOUBLE_EQ(resistance().stiffness, 1e4);
  const RollingStep step = rolling_step(resistance(), weight, up, {1e3, 0.0, 0.0}, none, 1.0);
  EXPECT_TRUE(step.limited);
  EXPECT_DOUBLE_EQ(step.torque[0], -2.0); // 0.2 x 0.1 m x 100 N, against the rotation
  EXPECT_DOUBLE_EQ(rolling_step(resistance(), -weight, up, {1e3, 0.0, 0.0}, none, 1.0).torque[0], -2.0);
}

TEST(Rolling, SwingsAsTheClosedFormOfTheSpring) { // the spring follows the angle, the torque is its I w'
  const double inertia = 0.4;
  const oracle::Oscillator closed{inertia, kr, 0.0};
  const Vec3 normal{2.0 / 3.0, 1.0 / 3.0, 2.0 / 3.0}, axis{1.0 / 3.0, 2.0 / 3.0, -2.0 / 3.0};
  const double dt = 1e-6;
  Vec3 spring{};
  for (int n = 0; n < 100000; ++n) {
    const double w = closed.at((n + 0.5) * dt, 0.0, 1.0).v;
    // The rotation about the normal is not resisted.
    const RollingStep step =
        rolling_step(resistance(), 1e6, normal, sum(scaled(w, axis), 3.0, normal), spring, dt);
    ASSERT_FALSE(step.limited);
    spring = step.spring;
    const oracle::Motion now = closed.at((n + 1) * dt, 0.0, 1.0);
    ASSERT_NEAR(dot(step.torque, axis), inertia * now.a, 1e-6 * inertia * 158.0);
    ASSERT_NEAR(length(step.torque), std::fabs(inertia * now.a), 1e-6 * inertia * 158.0);
    ASSERT_NEAR(step.stored, 0.5 * kr * now.x * now.x, 1e-6);
  }
}

/// A ball with the inertia I that spins at w0 and rolls to rest: angle and angular velocity.
struct Spun {
  double angle, w;
};
constexpr double inertia = 0.01, w0 = 2.0;

Spun spun_core(double t) { // velocity Verlet
  const int steps = 400000;
  const double dt = t / steps;
  Spun ball{0.0, w0};
  Vec3 spring{};
  double torque = 0.0;
  for (int n = 0; n < steps; ++n) {
    const double half = ball.w + 0.5 * dt * torque / inertia;
    ball.angle += dt * half;
    const RollingStep step = rolling_step(resistance(), weight, up, {0.0, half, 0.0}, spring, dt);
    spring = step.spring;
    torque = step.torque[1];
    ball.w = half + 0.5 * dt * torque / inertia;
  }
  return ball;
}

Spun spun_cvode(double t) {
  bool limited = false;
  oracle::Ode ball( // y = angle, angular velocity, spring torque
      [&](double, const oracle::State &y, oracle::State &f) {
        f[0] = y[1];
        f[1] = -y[2] / inertia;
        f[2] = limited ? 0.0 : kr * y[1];
      },
      0.0, {0.0, w0, 0.0}, {1e-2, 1.0, 1.0});
  int changes = 0;
  while (ball.time() < t) {
    const oracle::Event next =
        limited ? oracle::Event([](double, const oracle::State &y) { return y[1]; })
                : oracle::Event([](double, const oracle::State &y) { return y[2] - limit; });
    // After the one slide the ball swings below the limit.
    if ((changes == 2 ? ball.advance(t) : ball.advance(t, {next})) < 0) break;
    ++changes;
    limited = !limited;
    ball.restart(ball.state());
  }
  return {ball.state()[0], ball.state()[1]};
}

/// w = w0 cos(q t), q^2 = kr/I, until kr angle is the limit; then w falls by limit/I per second to 0; then
/// the ball swings about the angle at which the spring, which is stretched by limit/kr, is at rest.
Spun spun_closed(double t) {
  const double q = std::sqrt(kr / inertia), yield = limit / kr;
  const double t1 = std::asin(yield * q / w0) / q, w1 = w0 * std::cos(q * t1);
  if (t <= t1) return {w0 / q * std::sin(q * t), w0 * std::cos(q * t)};
  const double rate = limit / inertia, t2 = t1 + w1 / rate;
  if (t <= t2) return {yield + (w1 - 0.5 * rate * (t - t1)) * (t - t1), w1 - rate * (t - t1)};
  const double stop = yield + 0.5 * w1 * w1 / rate, late = q * (t - t2);
  return {stop - yield * (1.0 - std::cos(late)), -yield * q * std::sin(late)};
}

TEST(Rolling, ComesToRestAsTheClosedFormAndCvodeSay) {
  for (const double t : {5e-5, 5e-3, 9e-3, 9.9e-3, 1.2e-2, 2e-2}) {
    const Spun core = spun_core(t), exact = spun_closed(t), cvode = spun_cvode(t);
    EXPECT_NEAR(cvode.angle, exact.angle, 1e-9) << t;
    EXPECT_NEAR(cvode.w, exact.w, 1e-6) << t;
    EXPECT_NEAR(core.angle, exact.angle, 1e-8) << t;
    EXPECT_NEAR(core.w, exact.w, 1e-5) << t;
  }
}

TEST(Rolling, HasATorqueAcrossTheNormal) {
  const Vec3 normal{std::sin(0.1), 0.0, std::cos(0.1)};
  const RollingStep step = rolling_step(resistance(), 1e6, normal, none, {1.0, 2.0, 0.0}, 1e-5);
  EXPECT_NEAR(dot(step.torque, normal), 0.0, 1e-15);
  EXPECT_NEAR(length(step.spring), std::hypot(std::cos(0.1), 2.0), 1e-14);
  EXPECT_NEAR(step.stored + step.dissipated, 0.5 * 5.0 / kr, 1e-17);
  const RollingStep flipped =
      rolling_step(resistance(), 1e6, scaled(-1.0, normal), none, {1.0, 2.0, 0.0}, 1e-5);
  EXPECT_EQ(step.torque, flipped.torque);
  const Rolling all = rolling_of(kt, mu_r, radius, Resisted::all);
  const RollingStep torsion = rolling_step(all, 1e6, up, {0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}, 1e-4);
  EXPECT_DOUBLE_EQ(torsion.torque[2], -2.0);
  EXPECT_EQ(torsion.dissipated, 0.0);
}

TEST(Rolling, DoesNotMoveTheSpringInNoTime) {
  const Vec3 spring{1.0, -0.5, 0.0};
  const RollingStep step = rolling_step(resistance(), weight, up, {5.0, 0.0, 0.0}, spring, 0.0);
  EXPECT_EQ(step.spring, spring);
  EXPECT_EQ(step.torque, scaled(-1.0, spring));
  EXPECT_EQ(step.dissipated, 0.0);
}

TEST(Rolling, HasNoTorqueWithoutNormalForce) {
  EXPECT_EQ(length(rolling_step(resistance(), 0.0, up, {1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 1e-5).torque), 0.0);
  EXPECT_EQ(length(rolling_step(resistance(), 0.0, up, none, none, 1e-5).torque), 0.0);
}

TEST(Rolling, IsLimitedAfterwardsAsWithTheSmallerNormalForce) {
  const Vec3 spin{0.3, -0.7, 0.2}, spring{0.1, 0.4, 0.0};
  for (const double dt : {0.0, 1e-5, 1e-3}) {
    const RollingStep before = rolling_step(resistance(), weight, up, spin, spring, dt);
    for (const double force : {0.0, 1.0, -5.0, 30.0, weight}) {
      const RollingStep expected = rolling_step(resistance(), force, up, spin, spring, dt);
      const Vec3 torque = limited_to(resistance(), force, before.torque);
      for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_NEAR(torque[a], expected.torque[a], 1e-15) << dt << ' ' << force;
        EXPECT_NEAR(-torque[a], expected.spring[a], 1e-15) << dt << ' ' << force;
      }
    }
  }
}

TEST(Rolling, KeepsTheLimitAndCannotCreateEnergyInAnyStep) {
  std::mt19937 random(32452843);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto vector = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
  int limited = 0, free = 0;
  for (int contact = 0; contact < 20000; ++contact) {
    const Rolling rolling =
        rolling_of(decades(random, 0, 8), contact % 7 == 0 ? 0.0 : decades(random, -2, 1),
                   decades(random, -3, 0), contact % 3 == 0 ? Resisted::all : Resisted::rolling);
    const double dt = decades(random, -7, -2), size = decades(random, -3, 6), fast = decades(random, -4, 2);
    Vec3 normal = vector(), turn = vector(), spring{};
    double stored = 0.0;
    for (int n = 0; n < 50; ++n) {
      normal = sum(normal, 0.1, turn);
      normal = scaled(1.0 / length(normal), normal);
      const Vec3 spin = scaled(fast, vector()); // about the normal, too
      const double normal_force = size * unit(random);
      const RollingStep step = rolling_step(rolling, normal_force, normal, spin, spring, dt);
      spring = step.spring;
      ASSERT_LE(length(step.torque), rolling.arm * std::fabs(normal_force) * (1.0 + 1e-15));
      const double work = -dot(step.torque, spin) * dt;
      const double rounding = 1e-13 * (std::fabs(work) + step.stored + stored);
      ASSERT_GE(work, step.stored - stored - rounding);
      ASSERT_GE(step.dissipated, -rounding);
      stored = step.stored;
      ++(step.limited ? limited : free);
    }
  }
  EXPECT_GT(limited, 100000);
  EXPECT_GT(free, 100000);
}

/// A spring path on a normal that turns, from spring to limit and back: work is heat or stored, to first
/// order in the step.
double missing_work(int steps) {
  const double dt = 0.2 / steps;
  Vec3 spring{};
  double work = 0.0, heat = 0.0, stored = 0.0;
  for (int n = 0; n < steps; ++n) {
    const double t = (n + 0.5) * dt;
    const Vec3 normal{std::sin(2.0 * t), 0.0, std::cos(2.0 * t)};
    const Vec3 spin{0.04 * std::cos(60.0 * t), 0.03 * std::sin(37.0 * t), 0.05 * std::cos(23.0 * t)};
    const RollingStep step =
        rolling_step(resistance(), weight + 30.0 * std::sin(90.0 * t), normal, spin, spring, dt);
    spring = step.spring;
    stored = step.stored;
    work -= dot(step.torque, spin) * dt;
    heat += step.dissipated;
  }
  EXPECT_GT(heat, 1e-4);
  EXPECT_LT(std::fabs(work - heat - stored), 1e-2 * heat);
  return work - heat - stored;
}

TEST(Rolling, WorkIsDissipatedOrStoredInTheSpring) {
  EXPECT_NEAR(missing_work(20000) / missing_work(40000), 2.0, 0.2);
}

} // namespace rolling_law

} // namespace
} // namespace drumlin::test
