// Second-order stepping: order and error of a single impact against the closed form, and stability at the extremes.

#include "tests/plugin/physics/second_stepping.h"

#include "tests/support/oscillator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace {

using drumlin::physics::Transition;
using stepping::SecondOrderBall;

constexpr double k = 1e8;
constexpr double m = 2000.0;
const double w0 = std::sqrt(k / m);
double coefficient(double D) { return 2.0 * D * std::sqrt(m * k); }

/// Restitution by the closed form: the rate at the first root of d (A) or of k d + c d' (B) after the make.
double exact_restitution(Transition transition, double D) {
  const oracle::Oscillator oscillator{m, k, coefficient(D)};
  const auto held = [&](double t) {
    const oracle::Motion s = oscillator.at(t, 0.0, 1.0);
    return transition == Transition::A ? s.x : k * s.x + coefficient(D) * s.v;
  };
  double low = 0.01 / w0;
  double high = low;
  while (held(high) > 0.0)
    high += 0.01 / w0;
  for (int n = 0; n < 100; ++n)
    (held(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
  return -oscillator.at(low, 0.0, 1.0).v;
}

/// Largest error over 50 onset phases of the impact of a ball at 1 m/s.
double worst_error(Transition transition, double D, int steps_per_contact) {
  const double dt = M_PI / (w0 * steps_per_contact);
  double worst = 0.0;
  for (int n = 0; n < 50; ++n) {
    const double gap = (n + 0.5) / 50.0 * dt;
    SecondOrderBall ball(m, gap, -1.0, dt, transition, {{0.0, 1.0, k, coefficient(D)}});
    for (int step = 0; step < 3 * steps_per_contact; ++step)
      ball.step();
    worst = std::max(worst, std::fabs(ball.v - exact_restitution(transition, D)));
  }
  return worst;
}

struct Bound {
  Transition transition;
  double D, at_100, at_400;
};

class SingleImpact : public ::testing::TestWithParam<Bound> {};

TEST_P(SingleImpact, ErrsLittleAndWithTheSquareOfTheStep) {
  const Bound bound = GetParam();
  const double at_100 = worst_error(bound.transition, bound.D, 100);
  const double at_400 = worst_error(bound.transition, bound.D, 400);
  EXPECT_LT(at_100, bound.at_100);
  EXPECT_LT(at_400, bound.at_400);
  EXPECT_GT(std::log(at_100 / at_400) / std::log(4.0), 1.9);
}

INSTANTIATE_TEST_SUITE_P(Restitution, SingleImpact,
                         ::testing::Values(Bound{Transition::B, 0.2, 3e-4, 2e-5},
                                           Bound{Transition::B, 0.5, 1.5e-4, 1e-5},
                                           Bound{Transition::B, 2.0, 3e-5, 2e-6},
                                           Bound{Transition::A, 0.2, 3e-4, 2e-5},
                                           Bound{Transition::A, 0.5, 3e-4, 2e-5}));

TEST(SecondOrderStep, DashpotThatStopsTheBallWithinAStepDoesNotThrowItBack) {
  const double dt = M_PI / (w0 * 400.0);
  for (const Transition transition : {Transition::A, Transition::B})
    for (const double D : {100.0, 1e3, 1e4})
      for (const double onset : {0.01, 0.5, 0.99}) {
        SecondOrderBall ball(m, onset * dt, -1.0, dt, transition, {{0.0, 1.0, k, coefficient(D)}});
        for (int step = 0; step < 2000; ++step) {
          ball.step();
          ASSERT_LT(ball.v, 0.01) << "D = " << D << ", onset " << onset;
        }
        EXPECT_LT(std::fabs(ball.v), 1e-3) << "D = " << D << ", onset " << onset;
        EXPECT_LT(std::fabs(ball.x), dt) << "D = " << D << ", onset " << onset;
      }
}

TEST(SecondOrderStep, SlowImpactOfAnUndampedBallKeepsItsEnergy) {
  const double dt = M_PI / (w0 * 50.0);
  SecondOrderBall ball(m, 0.3 * dt, -1.0, dt, Transition::B, {{0.0, 1.0, k, 0.0}});
  for (int step = 0; step < 100; ++step)
    ball.step();
  EXPECT_NEAR(ball.v, 1.0, 2e-3);
}

/// Whether an oscillation about rest between n walls stays bounded. A pre-load keeps all contacts closed, so that the motion is
/// linear as in the theory.
bool stays_bounded(int walls, double D, double w0_dt) {
  const double dt = w0_dt / w0;
  const double depth = 1.0;
  std::vector<SecondOrderBall::Partner> partners;
  for (int n = 0; n < walls; ++n) {
    const double sign = n % 2 == 0 ? 1.0 : -1.0;
    partners.push_back({sign * depth, sign, k, coefficient(D)});
  }
  // A single wall below carries a weight that presses the ball in to x = 0.
  SecondOrderBall ball(m, 1e-9, 0.0, dt, Transition::A, partners, walls == 1 ? -k * depth : 0.0);
  for (int step = 0; step < 20000; ++step)
    ball.step();
  return std::fabs(ball.x) < 1e-6;
}

TEST(SecondOrderStep, IsStableAtTheLimitOfTheSpringsForAnyDamping) {
  for (const double D : {0.0, 0.01, 0.1, 0.5, 1.0, 2.0, 10.0, 1e3, 1e4}) {
    EXPECT_TRUE(stays_bounded(1, D, 1.95)) << "one contact, D = " << D;
    EXPECT_TRUE(stays_bounded(2, D, 1.36)) << "two walls, D = " << D;  // springs alone: sqrt(2)
    EXPECT_TRUE(stays_bounded(4, D, 0.92)) << "four walls, D = " << D; // springs alone: 1
  }
  EXPECT_TRUE(stays_bounded(2, 2.0, 1.4));
  EXPECT_FALSE(stays_bounded(2, 0.0, 1.45));
  EXPECT_FALSE(stays_bounded(4, 2.0, 1.05));
}

TEST(SecondOrderStep, ForceNeverPullsUnderB) {
  for (const double D : {0.0, 0.5, 2.0, 50.0})
    for (const double rate : {-5.0, -0.1, 0.0, 0.1, 5.0}) {
      const double dt = 1e-4;
      const auto f = drumlin::physics::second_order_force(Transition::B, k, coefficient(D),
                                                          {1e-3, rate, rate, dt}, 1e4, coefficient(D) / m);
      EXPECT_GE(f.force, 0.0);
      EXPECT_GE(f.kick, 0.0);
    }
}

TEST(SecondOrderStep, MakeCarriesTheImpulseOfThePartInContact) {
  // Light damping and a short step: the force is c v all along, for the share theta of the step.
  const double dt = 1e-7;
  const double c = coefficient(0.2);
  for (const double theta : {0.01, 0.3, 0.5, 0.99}) {
    const double v = 1.0;
    const auto f =
        drumlin::physics::second_order_force(Transition::B, k, c, {theta * dt * v, v, v, dt}, 0.0, c / m);
    EXPECT_NEAR(f.force, c * v, 1e-4 * c);
    EXPECT_NEAR(0.5 * dt * f.kick, theta * dt * c * v, 1e-4 * dt * c);
  }
}

TEST(SecondOrderStep, TellsAContactWithoutForceFromNone) {
  using drumlin::physics::was_contact;
  const double dt = 1e-4, c = coefficient(0.5);
  EXPECT_FALSE(was_contact(0.0));
  EXPECT_TRUE(was_contact(1e-300));
  const double parting =
      drumlin::physics::second_order_held(Transition::B, k, c, {1e-4, -5.0, -5.0, dt}, 0.0, c / m);
  EXPECT_EQ(parting, 0.0);
  EXPECT_TRUE(was_contact(parting));
  EXPECT_TRUE(was_contact(drumlin::physics::coupled_force(
      drumlin::physics::coupled_dashpot(Transition::B, k, c, {1e-4, -5.0, -5.0, dt}, 0.0, c / m), -5.0)));
}

// Moved beside its velocity, a ball may seem to have come from apart: k d + c d', not the impulse of a make.
TEST(SecondOrderStep, ContactThatHadAForceIsNotMadeAgain) {
  const double dt = 1e-4, rate = 0.1, c = coefficient(0.5);
  const double overlap = 0.9 * dt * rate; // by the motion there was a gap of 0.1 dt rate
  for (const Transition transition : {Transition::A, Transition::B}) {
    const auto f =
        drumlin::physics::second_order_force(transition, k, c, {overlap, rate, rate, dt}, c * rate, c / m);
    EXPECT_NEAR(f.force, k * overlap + c * rate, 1e-2 * c * rate); // the implicit step slows it a little
    EXPECT_EQ(f.kick, f.force);
    EXPECT_EQ(f.shift, 0.0);
    EXPECT_NE(
        drumlin::physics::second_order_force(transition, k, c, {overlap, rate, rate, dt}, 0.0, c / m).shift,
        0.0);
  }
}

TEST(SecondOrderStep, BallAtRestThatJustTouchesFeelsNothing) {
  for (const Transition transition : {Transition::A, Transition::B}) {
    const drumlin::physics::StepForce step = drumlin::physics::second_order_force(
        transition, k, coefficient(1.0), {0.0, 0.0, 0.0, 1e-3}, 0.0, coefficient(1.0) / m);
    EXPECT_EQ(step.force, 0.0);
    EXPECT_EQ(step.kick, 0.0);
    EXPECT_EQ(step.shift, 0.0);
  }
}

// What a bound on sum and k/c denies is denied for every contact below it: FixStepping leaves the counting on that.
TEST(SecondOrderStep, NeedOfCouplingGrowsWithTheSumOfDampingsAndWithTheSpring) {
  std::mt19937 random(20251121);
  std::uniform_real_distribution<double> exponent(-3.0, 1.0);
  int needed = 0;
  for (int n = 0; n < 10000; ++n) {
    const double dt = 1e-4;
    const double all = std::pow(10.0, exponent(random)) / dt;    // sum of c/m
    const double spring = std::pow(10.0, exponent(random)) / dt; // k/c
    if (!drumlin::physics::needs_coupling(dt, 7.0 * spring, 7.0, all)) continue;
    ++needed;
    EXPECT_TRUE(drumlin::physics::needs_coupling(dt, 1.5 * spring, 1.0, all));
    EXPECT_TRUE(drumlin::physics::needs_coupling(dt, spring, 1.0, 1.5 * all));
  }
  EXPECT_GT(needed, 1000);
}

TEST(SecondOrderStep, BreakOfAEndsTheTensileForceWithinTheStep) {
  const double dt = 1e-7;
  const double c = coefficient(0.2);
  for (const double share : {0.01, 0.5, 0.9}) {
    const double v = -1.0; // the overlap shrinks
    const auto f =
        drumlin::physics::second_order_break(Transition::A, k, c, {(1.0 - share) * dt * v, v, v, dt});
    EXPECT_EQ(f.force, 0.0);
    EXPECT_NEAR(0.5 * dt * (c * v + f.kick), share * dt * c * v, 1e-4 * dt * c); // with the opening half kick
    EXPECT_EQ(
        drumlin::physics::second_order_break(Transition::B, k, c, {(1.0 - share) * dt * v, v, v, dt}).kick,
        0.0);
  }
}

// Without a dashpot the force falls to zero at d = 0, continuously: where A ends a contact B does. The ball bounces between two
// undamped walls; in the second scene a damped contact, heavy enough to be solved for apart, holds it too.
TEST(SecondOrderStep, WithoutDashpotAAndBAreOneLaw) {
  const double dt = M_PI / (w0 * 40.0);
  for (const bool damped : {false, true}) {
    std::vector<SecondOrderBall::Partner> walls = {{0.0, 1.0, k, 0.0}, {0.03, -1.0, 2.0 * k, 0.0}};
    if (damped) walls.push_back({1.0, 1.0, 0.01 * k, coefficient(2.0)});
    SecondOrderBall a(m, 0.01, -1.0, dt, Transition::A, walls, damped ? -0.01 * k : 0.0);
    SecondOrderBall b(m, 0.01, -1.0, dt, Transition::B, walls, damped ? -0.01 * k : 0.0);
    int touched = 0;
    bool before = false;
    for (int step = 0; step < 2000; ++step) {
      const bool touches = a.step() > 0.0;
      b.step();
      touched += touches && !before ? 1 : 0;
      before = touches;
      ASSERT_EQ(a.x, b.x) << "step " << step << (damped ? ", damped" : "");
      ASSERT_EQ(a.v, b.v) << "step " << step << (damped ? ", damped" : "");
    }
    EXPECT_GT(touched, damped ? 0 : 10);
  }
}

TEST(SecondOrderStep, ContactWithoutDashpotIsNeverSolvedForWithOthers) {
  for (const double all_c_over_m : {0.0, 1.0, 1e12})
    EXPECT_FALSE(drumlin::physics::needs_coupling(1e-4, k, 0.0, all_c_over_m));
}

// A contact whose force is exactly zero is one under A, too: else its next step would be taken for that of a make.
TEST(SecondOrderStep, ZeroForceOfAContactIsOneUnderEitherTransition) {
  using drumlin::physics::limited;
  for (const Transition transition : {Transition::A, Transition::B})
    EXPECT_TRUE(drumlin::physics::was_contact(limited(transition, 0.0)));
  EXPECT_EQ(limited(Transition::A, -1.0), -1.0);
  EXPECT_EQ(limited(Transition::B, -1.0), 0.0);
}

} // namespace
