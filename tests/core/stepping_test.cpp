// Second-order stepping, and the events that it locates within a step.
#include "tests/core/velocity_verlet.h"

#include "physics/laws/linear_contact.h"
#include "physics/scheme/event_location.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace {

using namespace drumlin::physics;

// Second-order stepping: single steps, heavy dashpots, and stability at the extremes. Whole impacts are in
// law_impact_test.
namespace steps {

using drumlin::physics::advance;
using drumlin::physics::ContactState;
using drumlin::physics::LinearLaw;
using drumlin::physics::StepMotion;
using drumlin::physics::StepResult;
using drumlin::physics::Transition;
using SecondOrderBall = verlet::Ball<LinearLaw>;

constexpr double k = 1e8;
constexpr double m = 2000.0;
const double w0 = std::sqrt(k / m);
double coefficient(double D) { return 2.0 * D * std::sqrt(m * k); }

TEST(SecondOrderStep, DashpotThatStopsTheBallWithinAStepDoesNotThrowItBack) {
  const double dt = M_PI / (w0 * 400.0);
  for (const Transition transition : {Transition::A, Transition::B})
    for (const double D : {100.0, 1e3, 1e4})
      for (const double onset : {0.01, 0.5, 0.99}) {
        SecondOrderBall ball(m, onset * dt, -1.0, dt, {{0.0, 1.0, {k, coefficient(D), transition}}});
        for (int step = 0; step < 2000; ++step) {
          ball.step();
          ASSERT_LT(ball.v, 0.01) << "D = " << D << ", onset " << onset;
        }
        EXPECT_LT(std::fabs(ball.v), 1e-3) << "D = " << D << ", onset " << onset;
        EXPECT_LT(std::fabs(ball.x), dt) << "D = " << D << ", onset " << onset;
      }
}

/// Whether an oscillation about rest between n walls stays bounded. A pre-load keeps all contacts closed, so
/// that the motion is linear as in the theory.
bool stays_bounded(int walls, double D, double w0_dt) {
  const double dt = w0_dt / w0;
  const double depth = 1.0;
  std::vector<SecondOrderBall::Partner> partners;
  for (int n = 0; n < walls; ++n) {
    const double sign = n % 2 == 0 ? 1.0 : -1.0;
    partners.push_back({sign * depth, sign, {k, coefficient(D), Transition::A}});
  }
  // A single wall below carries a weight that presses the ball in to x = 0.
  SecondOrderBall ball(m, 1e-9, 0.0, dt, partners, walls == 1 ? -k * depth : 0.0);
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

/// One step of a contact, with a state from the step before.
StepResult step_of(const LinearLaw &law, const StepMotion &motion, ContactState &state, double all = 0.0) {
  return advance(law, motion, state, {m, all, false});
}

/// One step of a pair that was apart.
StepResult first_step(const LinearLaw &law, const StepMotion &motion) {
  ContactState state;
  return step_of(law, motion, state);
}

TEST(SecondOrderStep, ForceNeverPullsUnderB) {
  for (const double D : {0.0, 0.5, 2.0, 50.0})
    for (const double rate : {-5.0, -0.1, 0.0, 0.1, 5.0}) {
      const double dt = 1e-4;
      ContactState state{1e4, true};
      const StepResult f = step_of({k, coefficient(D), Transition::B}, {1e-3, rate, rate, dt}, state);
      EXPECT_GE(f.force, 0.0);
      EXPECT_GE(f.kick, 0.0);
      EXPECT_EQ(state.force, f.force);
    }
}

TEST(SecondOrderStep, MakeCarriesTheImpulseOfThePartInContact) {
  // Light damping and a short step: the force is c v all along, for the share theta of the step.
  const double dt = 1e-7;
  const double c = coefficient(0.2);
  for (const double theta : {0.01, 0.3, 0.5, 0.99}) {
    const double v = 1.0;
    const StepResult f = first_step({k, c, Transition::B}, {theta * dt * v, v, v, dt});
    EXPECT_NEAR(f.force, c * v, 1e-4 * c);
    EXPECT_NEAR(0.5 * dt * f.kick, theta * dt * c * v, 1e-4 * dt * c);
  }
}

TEST(SecondOrderStep, SetUpTakesTheVelocitiesAsTheyAre) {
  const double c = coefficient(0.5);
  ContactState state;
  const StepResult f =
      advance(LinearLaw(k, c, Transition::A), {1e-4, 0.3, 7.0, 1e-4}, state, {m, 1e12, true});
  EXPECT_DOUBLE_EQ(f.force, k * 1e-4 + c * 0.3);
  EXPECT_EQ(f.kick, f.force);
  EXPECT_FALSE(f.coupled);
  EXPECT_TRUE(state.in_contact);
  state.force = 7.0; // a run that continues keeps the force of the step before it
  const LinearLaw law(k, c, Transition::A);
  EXPECT_EQ(advance(law, {1e-4, 0.3, 7.0, 1e-4}, state, {m, 1e12, true, true}).force, 7.0);
}

// Under B a contact may exist without a force: in its next step it continues and is not made again.
TEST(SecondOrderStep, ContactWithoutForceContinues) {
  const double dt = 1e-4, c = coefficient(0.5);
  ContactState state{0.0, true};
  EXPECT_EQ(step_of({k, c, Transition::B}, {1e-4, -5.0, -5.0, dt}, state).force, 0.0);
  EXPECT_TRUE(state.in_contact);
  const double rate = 1.0, overlap = 0.5 * dt * rate; // by the motion alone it came from apart
  EXPECT_EQ(step_of({k, c, Transition::B}, {overlap, rate, rate, dt}, state).shift, 0.0);
  EXPECT_NE(first_step({k, c, Transition::B}, {overlap, rate, rate, dt}).shift, 0.0);
}

// After a position correction a ball may seem to have come from apart: k d + c d', not the impulse of a make.
TEST(SecondOrderStep, ContactThatHadAForceIsNotMadeAgain) {
  const double dt = 1e-4, rate = 0.1, c = coefficient(0.5);
  const double overlap = 0.9 * dt * rate; // by the motion there was a gap of 0.1 dt rate
  for (const Transition transition : {Transition::A, Transition::B}) {
    ContactState state{c * rate, true};
    const StepResult f = step_of({k, c, transition}, {overlap, rate, rate, dt}, state);
    EXPECT_NEAR(f.force, k * overlap + c * rate, 1e-2 * c * rate); // the implicit step slows it a little
    EXPECT_EQ(f.kick, f.force);
    EXPECT_EQ(f.shift, 0.0);
    EXPECT_NE(first_step({k, c, transition}, {overlap, rate, rate, dt}).shift, 0.0);
  }
}

// A ball that goes over to the next triangle of a mesh has overlapped with it for longer than a step, without
// a state.
TEST(SecondOrderStep, ContactThatIsOlderThanItsStateContinues) {
  const double dt = 1e-5, rate = 0.1, overlap = 1e-3, c = coefficient(0.5);
  const LinearLaw law(k, c, Transition::B);
  ContactState known{law.force(overlap - dt * rate, rate), true};
  const StepResult f = first_step(law, {overlap, rate, rate, dt});
  EXPECT_DOUBLE_EQ(f.force, step_of(law, {overlap, rate, rate, dt}, known).force);
  EXPECT_EQ(f.shift, 0.0);
}

TEST(SecondOrderStep, HeavyDashpotsAreLeftForTheSecondPass) {
  const double dt = 1e-4, c = coefficient(2.0), rate = 0.1, overlap = 1e-3;
  const LinearLaw law(k, c, Transition::B);
  ContactState state{2e5, true};
  const StepResult f = step_of(law, {overlap, rate, rate, dt}, state, 1.0 / (dt * std::sqrt(c)));
  ASSERT_TRUE(f.coupled);
  EXPECT_DOUBLE_EQ(f.kick, 2e5 + k * dt * rate); // the force that changes with the positions
  EXPECT_EQ(drumlin::physics::coupled_force(f.dashpot, -1e3), 0.0);
  EXPECT_FALSE(step_of(law, {overlap, rate, rate, dt}, state, 0.2 / (dt * std::sqrt(c))).coupled);
}

TEST(SecondOrderStep, BallAtRestThatJustTouchesFeelsNothing) {
  for (const Transition transition : {Transition::A, Transition::B}) {
    const StepResult step = first_step({k, coefficient(1.0), transition}, {0.0, 0.0, 0.0, 1e-3});
    EXPECT_EQ(step.force, 0.0);
    EXPECT_EQ(step.kick, 0.0);
    EXPECT_EQ(step.shift, 0.0);
  }
}

// If no coupling is needed for upper bounds of the sum of c/m and of k/c, none is needed for any contact
// below them: FixStepping relies on this when it leaves out the count.
TEST(SecondOrderStep, NeedOfCouplingGrowsWithTheSumOfDampingsAndWithTheSpring) {
  std::mt19937 random(20251121);
  std::uniform_real_distribution<double> exponent(-3.0, 1.0);
  int needed = 0;
  for (int n = 0; n < 10000; ++n) {
    const double dt = 1e-4;
    const double all = std::pow(10.0, exponent(random)) / dt;    // sum of sqrt(c)/m
    const double spring = std::pow(10.0, exponent(random)) / dt; // k/c
    if (!drumlin::physics::needs_coupling(dt, 7.0 * spring, 7.0, all)) continue;
    ++needed;
    EXPECT_TRUE(drumlin::physics::needs_coupling(dt, 1.5 * 7.0 * spring, 7.0, all));
    EXPECT_TRUE(drumlin::physics::needs_coupling(dt, 1.5 * 7.0 * spring, 1.5 * 7.0, all));
    EXPECT_TRUE(drumlin::physics::needs_coupling(dt, 7.0 * spring, 7.0, 1.5 * all));
  }
  EXPECT_GT(needed, 1000);
}

TEST(SecondOrderStep, BreakOfAEndsTheTensileForceWithinTheStep) {
  const double dt = 1e-7;
  const double c = coefficient(0.2);
  for (const double share : {0.01, 0.5, 0.9}) {
    const double v = -1.0; // the overlap shrinks
    const StepMotion motion{(1.0 - share) * dt * v, v, v, dt};
    ContactState a{c * v, true}, b{0.0, true}, none;
    const StepResult f = step_of({k, c, Transition::A}, motion, a);
    EXPECT_EQ(f.force, 0.0);
    EXPECT_NEAR(0.5 * dt * (c * v + f.kick), share * dt * c * v, 1e-4 * dt * c); // with the opening half kick
    EXPECT_FALSE(a.in_contact);
    EXPECT_EQ(a.force, 0.0);
    EXPECT_EQ(step_of({k, c, Transition::B}, motion, b).kick, 0.0);
    EXPECT_FALSE(b.in_contact);
    EXPECT_EQ(step_of({k, c, Transition::A}, motion, none).kick, 0.0); // there was no contact
  }
}

// Without a dashpot the force falls to zero at d = 0, continuously: where A ends a contact B does. The ball
// bounces between two undamped walls; in the second scene a damped contact, heavy enough to be solved for in
// the second pass, keeps it confined, too.
TEST(SecondOrderStep, WithoutDashpotAAndBAreOneLaw) {
  const double dt = M_PI / (w0 * 40.0);
  for (const bool damped : {false, true}) {
    const auto walls_of = [damped](Transition transition) {
      std::vector<SecondOrderBall::Partner> walls = {{0.0, 1.0, {k, 0.0, transition}},
                                                     {0.03, -1.0, {2.0 * k, 0.0, transition}}};
      if (damped) walls.push_back({1.0, 1.0, {0.01 * k, coefficient(2.0), transition}});
      return walls;
    };
    SecondOrderBall a(m, 0.01, -1.0, dt, walls_of(Transition::A), damped ? -0.01 * k : 0.0);
    SecondOrderBall b(m, 0.01, -1.0, dt, walls_of(Transition::B), damped ? -0.01 * k : 0.0);
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
  for (const double all : {0.0, 1.0, 1e12})
    EXPECT_FALSE(drumlin::physics::needs_coupling(1e-4, k, 0.0, all));
}

} // namespace steps

// Makes and breaks located within a step, against exact free flight. Those of impacts, of every law, are in
// law_impact_test.
namespace events {

constexpr double k = 1e8;
constexpr double m = 2000.0;
double damping(double D) { return 2.0 * D * std::sqrt(m * k); }

TEST(EventLocation, MakeOutOfFreeFlightIsExact) {
  // d(t) = d0 + v t + g t^2 / 2 through zero, upwards, at any place of the step and also with an approach
  // that slows down.
  for (const double g : {9.81, -9.81, 0.0})
    for (const double share : {0.0, 1e-9, 0.1, 0.5, 0.999}) {
      const double dt = 1e-3;
      const double s = share * dt;
      const double rate = 0.7; // at the event
      const auto at = [&](double t) { return OverlapState{rate * t + 0.5 * g * t * t, rate + g * t}; };
      const OverlapState before = at(-s);
      const auto event = locate_transition(LinearLaw(k, damping(0.5), Transition::B), dt, before, at(dt - s));
      ASSERT_TRUE(event.has_value());
      EXPECT_TRUE(event->make);
      EXPECT_NEAR(event->since, s, 1e-12 * dt + 1e-16);
      EXPECT_NEAR(event->rate, rate, 1e-9);
      EXPECT_EQ(event->overlap, 0.0);
      EXPECT_NEAR(event->force, damping(0.5) * rate, 1e-3);
    }
}

TEST(EventLocation, ABallThatTurnsRoundIntoContactIsFound) {
  // It moves away from the other, is pulled back and meets it within the same step.
  const double dt = 1.0;
  const auto at = [](double t) { return OverlapState{-1.0 - t + 4.0 * t * t, -1.0 + 8.0 * t}; };
  const auto event = locate_transition(LinearLaw(k, 0.0, Transition::A), dt, at(0.0), at(dt));
  ASSERT_TRUE(event.has_value());
  EXPECT_NEAR(event->since, (1.0 + std::sqrt(17.0)) / 8.0, 1e-12);
}

TEST(EventLocation, RemakeUnderBHappensWithOverlap) {
  // k d + c d' crosses zero upwards while d > 0: the clamp lets go without a gap.
  const double c = damping(0.5);
  const double dt = 1e-5;
  const OverlapState before{1e-3, -k * 1e-3 / c - 0.01};
  const OverlapState after{1e-3 - 1e-5 * 0.2, -k * 1e-3 / c + 0.02};
  const auto event = locate_transition(LinearLaw(k, c, Transition::B), dt, before, after);
  ASSERT_TRUE(event.has_value());
  EXPECT_TRUE(event->make);
  EXPECT_GT(event->overlap, 0.0);
  EXPECT_EQ(event->force, 0.0);
  EXPECT_FALSE(locate_transition(LinearLaw(k, c, Transition::A), dt, before, after).has_value());
}

TEST(EventLocation, NothingHappensWithinAContactOrAFlight) {
  const double c = damping(0.5);
  EXPECT_FALSE(
      locate_transition(LinearLaw(k, c, Transition::B), 1e-5, {1e-3, 0.1}, {1.001e-3, 0.1}).has_value());
  EXPECT_FALSE(
      locate_transition(LinearLaw(k, c, Transition::B), 1e-5, {-1e-3, 0.1}, {-0.999e-3, 0.1}).has_value());
}

} // namespace events

} // namespace
