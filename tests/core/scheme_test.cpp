// The integration scheme and its stability limit.
#include "tests/core/velocity_verlet.h"
#include "tests/support/eigenvalues.h"
#include "physics/laws/linear_contact.h"
#include "physics/scheme/advance.h"
#include "physics/scheme/event_location.h"
#include "physics/scheme/stability_limit.h"

namespace drumlin::test {
namespace {

using namespace drumlin::physics;

// Second-order stepping, and the events that it locates within a step.
namespace stepping {

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

} // namespace stepping

/// Stability limits against the eigenvalues of the matrix of one step with `stepping stock`.
namespace time_step {

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

} // namespace time_step

} // namespace
} // namespace drumlin::test
