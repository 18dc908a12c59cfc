// What all contact laws share: their values in an instant, mixing, suction, and values that are not allowed.
#include "tests/core/vectors.h"
#include "tests/core/velocity_verlet.h"

#include "physics/bodies/absorbing_boundary.h"
#include "physics/bodies/bond_law.h"
#include "physics/bodies/excitation.h"
#include "physics/laws/contact_mixing.h"
#include "physics/laws/hertz_contact.h"
#include "physics/laws/laws.h"
#include "physics/laws/linear_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <string>

namespace {

using namespace drumlin::physics;

// The contact laws instant by instant: what all have in common; of the linear law closed forms, definitions
// and identities. Whole impacts are in law_impact_test.
namespace law {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Calls run(law under A, the same under B) for every law, with forces of some 1e5 N at overlaps of 1e-3 m.
template <class Run>
void with_each_law(const Run &run) {
  const auto both = [&run](const auto &law) { run(law(Transition::A), law(Transition::B)); };
  both([](Transition transition) { return LinearLaw(1e8, 2e5, transition); });
  both([](Transition transition) { return HertzLaw(3e9, 1e6, transition); });
  for (const double largest : {0.0, 5e-4, 2e-3})
    both([largest](Transition transition) { return YieldLaw(1e8, 3e8, 2e5, transition, largest); });
}

TEST(EveryLaw, IsZeroWithoutOverlap) {
  with_each_law([](const auto &...laws) {
    for (const double overlap : {0.0, -1e-9, -1.0})
      for (const double rate : {-2.0, 0.0, 2.0}) {
        EXPECT_EQ((std::fabs(laws.force(overlap, rate)) + ...), 0.0);
        EXPECT_FALSE((laws.acts(overlap, rate) || ...));
        EXPECT_EQ((laws.energy(overlap) + ...), 0.0);
        EXPECT_EQ((laws.power(overlap, rate).dissipated + ...), 0.0);
        EXPECT_EQ((std::fabs(laws.power(overlap, rate).stored) + ...), 0.0);
      }
  });
}

TEST(EveryLaw, NeverPullsUnderBAndElseEqualsA) {
  std::mt19937 random(7919);
  std::uniform_real_distribution<double> overlap(-1e-3, 1e-3), rate(-1.0, 1.0);
  with_each_law([&](const auto &a, const auto &b) {
    int clamped = 0, equal = 0;
    for (int i = 0; i < 20000; ++i) {
      const double d = overlap(random), r = rate(random), force = a.force(d, r);
      ASSERT_EQ(b.force(d, r), std::fmax(0.0, force));
      ASSERT_EQ(b.acts(d, r), force > 0.0);
      ASSERT_EQ(a.acts(d, r), d > 0.0);
      clamped += force < 0.0 ? 1 : 0;
      equal += force > 0.0 ? 1 : 0;
    }
    EXPECT_GT(clamped, 1000);
    EXPECT_GT(equal, 1000);
  });
}

TEST(EveryLaw, PropagatesNaN) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  with_each_law([nan](const auto &...laws) {
    EXPECT_TRUE((std::isnan(laws.force(nan, 0.0)) && ...));
    EXPECT_TRUE((std::isnan(laws.force(1e-3, nan)) && ...));
    EXPECT_TRUE((std::isnan(laws.energy(nan)) && ...));
  });
}

// LIGGGHTS asks each contact model for the power of the overlap in its force.
TEST(EveryLaw, HasTheExponentsOfItsForces) {
  with_each_law([](const auto &law, const auto &) {
    if (law.memory() > 0.0) return; // it is unloaded along another line
    constexpr double d = 1e-4;
    EXPECT_NEAR(law.exponent, std::log2(law.spring(2.0 * d) / law.spring(d)), 1e-12);
    EXPECT_NEAR(law.dashpot_exponent, std::log2(law.dashpot(2.0 * d) / law.dashpot(d)), 1e-12);
  });
}

// All work on a contact is stored or heat, and the dashpot alone makes at most C d'^2 of it.
TEST(EveryLaw, HasThePowerOfItsForceAndIsPassive) {
  std::mt19937 random(104729);
  std::uniform_real_distribution<double> overlap(0.0, 1e-3), rate(-1.0, 1.0);
  const auto judge = [&](const auto &law) {
    double missing = 0.0, least = infinity, too_much = 0.0;
    for (int i = 0; i < 20000; ++i) {
      const double d = overlap(random), r = rate(random), yielding = (law.spring(d) - law.elastic(d)) * r;
      const ContactPower power = law.power(d, r);
      missing = std::fmax(missing, std::fabs(power.dissipated + power.stored - law.force(d, r) * r));
      if (yielding < 0.0) continue; // an overlap that is the largest so far does not shrink
      least = std::fmin(least, power.dissipated);
      too_much = std::fmax(too_much, power.dissipated - law.dashpot(d) * r * r - yielding);
    }
    EXPECT_LT(missing, 1e-6);
    EXPECT_GE(least, 0.0);
    EXPECT_LT(too_much, 1e-6);
  };
  with_each_law([&](const auto &...laws) { (judge(laws), ...); });
}

TEST(EveryLaw, StoresTheWorkOfItsElasticForceAndHasItsSlope) {
  with_each_law([](const auto &law, const auto &) {
    for (const double d : {1e-4, 4.5e-4, 6e-4, 1.9e-3})
      for (const double r : {-0.9, 0.3}) {
        const double h = 1e-7, there = d + r * h, back = d - r * h;
        const double stored = (law.energy(there) - law.energy(back)) / (2.0 * h);
        EXPECT_NEAR(law.power(d, r).stored, stored, 1e-6 * std::fabs(stored) + 1e-9) << d;
        const double slope = (law.spring(there) - law.spring(back)) / (2.0 * h * r);
        EXPECT_NEAR(law.slope(d), slope, 1e-6 * slope) << d;
        EXPECT_NEAR(law.spring_change(there, r, 2.0 * h), law.spring(there) - law.spring(back), 1e-9) << d;
      }
  });
}

TEST(ContactLaw, JumpsToTheDashpotForceAtMake) { // Eq. (4)
  for (const Transition transition : {Transition::A, Transition::B})
    EXPECT_NEAR(LinearLaw(1e8, 4e5, transition).force(1e-15, 0.5), 2e5, 1e-6);
}

TEST(ContactLaw, PullsAtBreakUnderAOnly) { // Eq. (5)
  EXPECT_NEAR(LinearLaw(1e8, 4e5, Transition::A).force(1e-15, -0.5), -2e5, 1e-6);
  EXPECT_TRUE(LinearLaw(1e8, 4e5, Transition::A).acts(1e-15, -0.5));
  EXPECT_EQ(LinearLaw(1e8, 4e5, Transition::B).force(1e-15, -0.5), 0.0);
  EXPECT_FALSE(LinearLaw(1e8, 4e5, Transition::B).acts(1e-15, -0.5));
}

TEST(ContactLaw, BreaksContinuouslyUnderB) { // Eqs. (6)-(7): Fc = 0 at d = -c d'/k
  const double k = 1e8, c = 4e5, d = 1e-3;
  const double rate_at_break = -0.25;
  for (const double off : {1e-3, 1e-6, 1e-9}) {
    const double before = LinearLaw(k, c, Transition::B).force(d, rate_at_break * (1.0 - off));
    EXPECT_NEAR(before, 1e5 * off, 1e-9 * 1e5);
    EXPECT_GT(before, 0.0);
    EXPECT_TRUE(LinearLaw(k, c, Transition::B).acts(d, rate_at_break * (1.0 - off)));
    EXPECT_EQ(LinearLaw(k, c, Transition::B).force(d, rate_at_break * (1.0 + off)), 0.0);
    EXPECT_FALSE(LinearLaw(k, c, Transition::B).acts(d, rate_at_break * (1.0 + off)));
    EXPECT_TRUE(LinearLaw(k, c, Transition::A).acts(d, rate_at_break * (1.0 + off)));
  }
}

TEST(ContactLaw, HasTheHeatOfTheDashpotOnlyWhereTheLawIsNotClamped) {
  EXPECT_DOUBLE_EQ(LinearLaw(1e8, 2e5, Transition::A).power(1e-4, -0.5).dissipated, 5e4);
  EXPECT_DOUBLE_EQ(LinearLaw(1e8, 2e5, Transition::B).power(1e-3, -0.4).dissipated, 3.2e4);
  EXPECT_DOUBLE_EQ(LinearLaw(1e8, 2e5, Transition::B).power(1e-4, -0.5).dissipated,
                   5e3); // = k d |d'|, clamped
}

TEST(Damping, RatioAndCoefficientGiveTheSameForce) {
  for (const double ratio : {0.0, 0.5, 2.0}) {
    const double m = 2000.0, k = 1e8;
    const LinearContact by_ratio{k, ratio, Damping::ratio, Transition::B};
    const double c = by_ratio.damping_coefficient(m);
    const LinearContact by_coefficient{k, c, Damping::coefficient, Transition::B};
    EXPECT_EQ(by_coefficient.damping_coefficient(m), c);
    EXPECT_EQ(by_coefficient.damping_coefficient(7.0 * m), c); // a coefficient does not ask for the mass
  }
}

TEST(Damping, GivesTheCoefficientsOfTheTable) { // Table 1, to its digits
  const auto c = [](double k, double ratio) {
    return LinearContact{k, ratio, Damping::ratio, Transition::B}.damping_coefficient(
        effective_mass(infinity, 2000.0));
  };
  EXPECT_NEAR(c(5e6, 0.5), 0.1e6, 0.0005e6);
  EXPECT_NEAR(c(1e8, 0.5), 0.447e6, 0.0005e6);
  EXPECT_NEAR(c(1e8, 2.0), 1.79e6, 0.005e6);
}

TEST(EffectiveMass, IsTheHarmonicSum) {
  EXPECT_DOUBLE_EQ(effective_mass(2000.0, 2000.0), 1000.0);
  for (const double other : {1e-6, 3.0, 2000.0, 1e9}) {
    EXPECT_NEAR(1.0 / effective_mass(7.0, other), 1.0 / 7.0 + 1.0 / other, 1e-14 * (1.0 / 7.0 + 1.0 / other));
    EXPECT_EQ(effective_mass(7.0, other), effective_mass(other, 7.0));
  }
}

TEST(EffectiveMass, OfAFixedPartnerIsTheOtherBallsMass) {
  EXPECT_EQ(effective_mass(2000.0, infinity), 2000.0);
  EXPECT_EQ(effective_mass(infinity, 2000.0), 2000.0);
}

} // namespace law

// Contacts of balls of two materials act as two springs in series. Oracle: a library's minimiser finds how
// both springs share the overlap so that their energy is least. Besides, the limits of the mixing rule.
namespace mixing {

using namespace drumlin;
using namespace drumlin::test;

using physics::ContactValues;
using physics::mixed;

/// Force, N, of two springs in series that are compressed by 1 m together: the compression of the first one
/// is that of least energy.
double force_of_series(double first, double second) {
  const auto energy = [&](double x) { return 0.5 * first * x * x + 0.5 * second * (1.0 - x) * (1.0 - x); };
  const double x = boost::math::tools::brent_find_minima(energy, 0.0, 1.0, 60).first;
  return first * x;
}

TEST(ContactMixing, StiffnessIsThatOfTheSpringsOfBothBallsInSeries) {
  for (const double a : {1e6, 3e7, 1e9})
    for (const double b : {1e6, 2e8}) {
      // A contact with itself is two springs in series, too: each is twice as stiff.
      const double k = mixed({a, 0.0, 0.0, 0.0}, {b, 0.0, 0.0, 0.0}).stiffness;
      EXPECT_NEAR(k, force_of_series(2.0 * a, 2.0 * b), 1e-6 * k) << a << ", " << b;
    }
  EXPECT_NEAR(mixed({1e8, 0.0, 0.0, 0.0}, {1e300, 0.0, 0.0, 0.0}).stiffness, 2e8, 1e-4); // on a rigid ball
}

TEST(ContactMixing, TakesTheLesserFrictionAndTheMeanDampingInEitherOrder) {
  const ContactValues rough = {1e9, 0.3, 0.8, 0.1}, smooth = {1e8, 0.1, 0.5, 0.45};
  for (const ContactValues &values : {mixed(rough, smooth), mixed(smooth, rough)}) {
    EXPECT_EQ(values.friction, 0.5);
    EXPECT_EQ(values.rolling, 0.1);
    EXPECT_NEAR(values.damping_ratio, 0.2, 1e-15);
  }
}

TEST(ContactMixing, OfOneMaterialIsTheMaterial) {
  const ContactValues values = mixed({3e8, 0.3, 0.7, 0.2}, {3e8, 0.3, 0.7, 0.2});
  EXPECT_NEAR(values.stiffness, 3e8, 1e-7);
  EXPECT_NEAR(values.damping_ratio, 0.3, 1e-16);
  EXPECT_EQ(values.friction, 0.7);
  EXPECT_EQ(values.rolling, 0.2);
}

} // namespace mixing

// Suction, a constant attraction of balls that touch: long runs and rest, under both schemes. Impacts with
// suction, of every law, are in law_impact_test.
namespace suction {

using verlet::Scheme;

constexpr double k = 1e8, m = 2000.0;
const double w0 = std::sqrt(k / m);
double coefficient(double D) { return 2.0 * D * std::sqrt(m * k); }

/// A ball that has been at rest at an overlap, and some steps later.
template <class Law>
verlet::Ball<Law> after(const Law &law, double suction, double force, double overlap, Scheme scheme,
                        int steps) {
  verlet::Ball<Law> ball(m, -overlap, 0.0, 0.1 / w0, {{0.0, 1.0, law, suction}}, force, scheme);
  for (int n = 0; n < steps; ++n)
    ball.step();
  return ball;
}

// 300 bounces of a ball under its weight: the energy of the flight is that of the beginning.
TEST(Suction, KeepsTheEnergyOfABouncingBall) {
  const double dt = M_PI / (w0 * 100.0), weight = 9.81 * m, suction = 0.1 * std::sqrt(k * m);
  verlet::Ball<LinearLaw> ball(m, 0.001, 0.0, dt, {{0.0, 1.0, {k, 0.0, Transition::B}, suction}}, -weight);
  const double begin = weight * 0.001;
  double worst = 0.0, work = 0.0;
  int bounces = 0;
  bool apart = true;
  for (int n = 0; n < 10000000 && bounces < 300; ++n) {
    ball.step();
    const double d = std::max(0.0, -ball.x);
    worst = std::max(worst, std::fabs(0.5 * m * ball.v * ball.v + weight * ball.x + 0.5 * k * d * d -
                                      suction * d - begin));
    if (apart && d > 0.0) {
      ++bounces;
      work += begin;
    }
    apart = d == 0.0;
  }
  EXPECT_EQ(bounces, 300);
  EXPECT_LT(worst, 1e-3 * work);
}

/// A pair that sticks, after 10^6 steps: with a dashpot it has come to rest, without one it still swings
/// about the place of rest. \param place of rest, m
template <class Law>
void expect_sticking(const Law &damped, const Law &undamped, double suction, double place) {
  for (const Scheme scheme : {Scheme::second, Scheme::stock}) {
    const auto rest = after(damped, suction, 0.0, 1.5 * place, scheme, 1000000);
    EXPECT_NEAR(-rest.x, place, 1e-12 * place);
    EXPECT_NEAR(rest.v, 0.0, 1e-12 * w0 * place);
    const auto swings = after(undamped, suction, 0.0, 1.2 * place, scheme, 1000000);
    const double begin = after(undamped, suction, 0.0, 1.2 * place, scheme, 0).energy();
    EXPECT_NEAR(swings.energy(), begin, 1e-2 * (begin - rest.energy()));
  }
}

TEST(Suction, NeitherMovesNorHeatsAStickingPair) {
  const double suction = 1e5;
  for (const Transition transition : {Transition::A, Transition::B}) {
    expect_sticking<LinearLaw>({k, coefficient(0.3), transition}, {k, 0.0, transition}, suction, suction / k);
    const double hertz = 1e10; // a slope of 1.5e8 N/m at 1e-4 m
    expect_sticking<HertzLaw>({hertz, coefficient(0.3), transition}, {hertz, 0.0, transition}, suction,
                              std::pow(suction / hertz, 2.0 / 3.0));
  }
}

TEST(Suction, IsTheForceThatPullsABallOff) {
  const double suction = 1e4;
  for (const double share : {0.99, 1.01}) {
    const double place = (1.0 - share) * suction / k;
    const auto end = after(LinearLaw(k, coefficient(0.3), Transition::B), suction, share * suction,
                           std::fabs(place), Scheme::second, 20000);
    if (share < 1.0) {
      EXPECT_NEAR(-end.x, place, 1e-9 * suction / k);
    } else {
      EXPECT_GT(end.x, 100.0 * suction / k);
    }
  }
}

} // namespace suction

// Values that are not allowed, each with its message: the name, the value, what is allowed.
namespace checks {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// The message for a good set of parameters in which one is changed.
template <class Parameters>
std::string fault(Parameters set, double Parameters::*member, double value) {
  EXPECT_EQ(set.invalid(), "");
  set.*member = value;
  return set.invalid();
}

TEST(ParameterChecks, OfABond) {
  const Bond bond{1e6, 1e4, 0.5};
  EXPECT_EQ(fault(bond, &Bond::stiffness, 0.0), "stiffness is '0 N/m'; allowed: finite and > 0");
  EXPECT_EQ(fault(bond, &Bond::stiffness, infinity), "stiffness is 'inf N/m'; allowed: finite and > 0");
  EXPECT_EQ(fault(bond, &Bond::damping, -0.1), "damping is '-0.1 N s/m'; allowed: finite and >= 0");
  EXPECT_EQ(fault(bond, &Bond::length, -nan_value), "length is 'nan m'; allowed: finite and >= 0");
  EXPECT_EQ(fault(bond, &Bond::strength, 0.0), "strength is '0 N'; allowed: > 0, may be infinite");
  EXPECT_EQ(fault(bond, &Bond::damping, 0.0), "");
  EXPECT_EQ(fault(bond, &Bond::strength, 1e-300), "");
}

TEST(ParameterChecks, OfAnExcitationLeaveOutWhatIsNotUsed) {
  Excitation e;
  EXPECT_EQ(fault(e, &Excitation::amplitude, -1.0), "amplitude is '-1 N'; allowed: finite and >= 0");
  EXPECT_EQ(fault(e, &Excitation::angular_frequency, infinity),
            "angular frequency is 'inf rad/s'; allowed: finite and >= 0");
  EXPECT_EQ(fault(e, &Excitation::phase, -infinity), "phase is '-inf rad'; allowed: finite");
  EXPECT_EQ(fault(e, &Excitation::start, nan_value), "start is 'nan s'; allowed: finite");
  EXPECT_EQ(fault(e, &Excitation::start, -5.0), "");
  EXPECT_EQ(fault(e, &Excitation::ramp, -1.0), "ramp is '-1 s'; allowed: finite and >= 0");
  EXPECT_EQ(fault(e, &Excitation::sweep_duration, -1.0),
            "sweep duration is '-1 s'; allowed: finite and >= 0");
  EXPECT_EQ(fault(e, &Excitation::sweep_frequency, -1.0), "");
  EXPECT_EQ(fault(e, &Excitation::eccentric_mass, -1.0), "");
  e.sweep_duration = 2.0;
  EXPECT_EQ(fault(e, &Excitation::sweep_frequency, -1.0),
            "sweep frequency is '-1 rad/s'; allowed: finite and >= 0");
  e.eccentric = true;
  e.eccentric_mass = e.eccentric_radius = 1.0;
  EXPECT_EQ(fault(e, &Excitation::amplitude, nan_value), "");
  EXPECT_EQ(fault(e, &Excitation::eccentric_mass, 0.0), "eccentric mass is '0 kg'; allowed: finite and > 0");
  EXPECT_EQ(fault(e, &Excitation::eccentric_radius, 0.0),
            "eccentric radius is '0 m'; allowed: finite and > 0");
}

TEST(ParameterChecks, OfAnAbsorbingBoundary) {
  const Ground ground{1800.0, 300.0, 170.0, 2.5, 0.4};
  EXPECT_EQ(fault(ground, &Ground::density, 0.0), "density is '0 kg/m3'; allowed: finite and > 0");
  EXPECT_EQ(fault(ground, &Ground::p_speed, -1.0),
            "speed of compression waves is '-1 m/s'; allowed: finite and > 0");
  EXPECT_EQ(fault(ground, &Ground::s_speed, -1.0),
            "speed of shear waves is '-1 m/s'; allowed: finite and >= 0");
  EXPECT_EQ(fault(ground, &Ground::s_speed, 301.0),
            "speed of shear waves is '301 m/s'; allowed: at most that of compression waves, 300 m/s");
  EXPECT_EQ(fault(ground, &Ground::depth, 0.0), "depth is '0 m'; allowed: > 0, may be infinite");
  EXPECT_EQ(fault(ground, &Ground::area, nan_value), "area is 'nan m2'; allowed: finite and > 0");
}

TEST(ParameterChecks, OfARange) {
  for (const double value : {nan_value, infinity, -infinity})
    EXPECT_FALSE(Range::any.contains(value));
  EXPECT_TRUE(Range::any.contains(-1e300));
  EXPECT_FALSE(Range::positive.contains(0.0));
  EXPECT_TRUE(Range::non_negative.contains(0.0));
  EXPECT_FALSE(Range::non_negative.contains(-1e-300));
  const Range share{-1.0, true, 0.5};
  EXPECT_TRUE(share.contains(0.5));
  EXPECT_FALSE(share.contains(-1.0));
  EXPECT_EQ(detail::text_of(share), "a finite number > -1 and <= 0.5");
  EXPECT_EQ(detail::text_of(Range::any), "a finite number");
}

} // namespace checks

} // namespace
