// Contact laws: the linear one, that of Hertz, and the one that yields.
#include "tests/core/vectors.h"
#include "tests/core/velocity_verlet.h"
#include "tests/support/ode.h"
#include "physics/bodies/absorbing_boundary.h"
#include "physics/bodies/bond_law.h"
#include "physics/bodies/excitation.h"
#include "physics/laws/contact_mixing.h"
#include "physics/laws/friction_law.h"
#include "physics/laws/hertz_contact.h"
#include "physics/laws/laws.h"
#include "physics/laws/linear_contact.h"
#include "physics/laws/rolling_law.h"
#include "physics/laws/yield_contact.h"

#include <boost/math/tools/minima.hpp>
#include <boost/math/special_functions/zeta.hpp>

namespace drumlin::test {
namespace {

using namespace drumlin::physics;

// What all contact laws share: their values in an instant, mixing, suction, and values that are not allowed.
namespace contact_law {

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
  EXPECT_EQ(physics::detail::text_of(share), "a finite number > -1 and <= 0.5");
  EXPECT_EQ(physics::detail::text_of(Range::any), "a finite number");
}

} // namespace checks

} // namespace contact_law

/// The Hertz law: its definitions; its tangential and its rolling spring, whose stiffness follows the
/// overlap. Whole impacts are in law_impact_test and oblique_impact_test.
namespace hertz_contact {

constexpr double k = 1e8, m = 2000.0, radius = 0.04;
constexpr double E_eff = 0.75 * k / 0.2; // of 4/3 E* sqrt(R) = k

TEST(HertzLaw, IsItsFormula) {
  for (const double d : {1e-8, 1e-4, 1e-2})
    for (const double rate : {-1.0, 0.0, 0.3}) {
      const double force = k * std::pow(d, 1.5) + 3e5 * std::pow(d, 0.25) * rate;
      EXPECT_NEAR(HertzLaw(k, 3e5, Transition::A).force(d, rate), force, 1e-12 * std::fabs(force));
    }
}

// Johnson, Contact Mechanics (1985), Eqs. (4.22) to (4.24) and (7.43): a steel ball of 10 mm radius on one of
// 20 mm.
TEST(HertzLaw, HasTheStiffnessOfTwoSpheres) {
  HertzContact contact;
  contact.set_moduli(210e9, 0.3, 70e9, 0.33);
  const double E = 1.0 / ((1.0 - 0.09) / 210e9 + (1.0 - 0.33 * 0.33) / 70e9), R = 0.02 / 3.0, d = 5e-6;
  const double a = std::sqrt(R * d); // radius of the area of contact
  const HertzLaw law = contact.law(1.0, R);
  EXPECT_NEAR(law.spring(d), 4.0 * E * a * a * a / (3.0 * R), 1e-12 * law.spring(d));
  EXPECT_NEAR(law.slope(d), 2.0 * E * a, 1e-12 * law.slope(d));
  const double G1 = 210e9 / 2.6, G2 = 70e9 / 2.66;
  const double tangential = 8.0 * a / ((2.0 - 0.3) / G1 + (2.0 - 0.33) / G2);
  EXPECT_NEAR(contact.tangential(d, R), tangential, 1e-12 * tangential);
  EXPECT_GT(contact.tangential(0.0, R), 0.0);
}

/// A spring of a contact whose stiffness follows the overlap, in the steps of the scheme: that of friction
/// without a limit or, if `rolls`, that of rolling resistance.
class VaryingSpring {
public:
  VaryingSpring(const HertzContact &contact, bool rolls, double dt)
      : contact_(contact), rolls_(rolls), dt_(dt) {}

  /// One step that ends at an overlap, m, which has changed at a rate, m/s.
  /// \param moved slip velocity, m/s, or relative angular velocity, rad/s
  /// \returns force, N, or torque, N m, that opposes it
  Vec3 step(double overlap, double rate, const Vec3 &moved, double ct = 0.0, double limit = 1e12) {
    const Vec3 normal{0.0, 0.0, 1.0};
    const double kt = contact_.tangential(overlap_of_spring(overlap, rate, dt_), radius);
    const double kept = rolls_ ? kept_torque(stiffness_, kt) : kept_spring(stiffness_, kt);
    for (double &part : spring_)
      part *= kept;
    stiffness_ = kt;
    const Rolling rolling = rolling_of(kt, limit, radius);
    stored_after_change = 0.5 * dot(spring_, spring_) * (rolls_ ? 1.0 / rolling.stiffness : kt);
    if (rolls_) {
      const RollingStep now = rolling_step(rolling, 1.0, normal, moved, spring_, dt_);
      spring_ = now.spring;
      stored = now.stored;
      return now.torque;
    }
    const FrictionStep now = friction_step({kt, ct, limit, Cap::coulomb}, 1.0, normal, moved, spring_, dt_);
    spring_ = now.spring;
    stored = now.stored;
    return now.force;
  }

  double stored = 0.0;              ///< energy in the spring after the step, J
  double stored_after_change = 0.0; ///< the same after the change of the stiffness, before the motion

private:
  const HertzContact contact_;
  const bool rolls_;
  const double dt_;
  double stiffness_ = 0.0;
  Vec3 spring_{};
};

/// A slip that oscillates on the tangential spring of a contact whose overlap oscillates, too, by the steps
/// of the scheme, or by CVODE if dt is 0; if `rolls`, a rotation on the rolling spring, times the radius. The
/// inertia is the mass of the slip times the radius squared, so that the equations of both are the same.
/// \param ct dashpot of the slip, N s/m
double slip_of_lasting_contact(double ct, double dt, bool rolls = false) {
  const HertzContact contact{E_eff, 0.4 * E_eff, 0.0, Damping::ratio, Transition::B};
  constexpr double depth = 1e-3, swing = 0.3, m_t = 2.0 / 7.0 * m;
  const double kt0 = contact.tangential(depth, radius), w = 1.3 * std::sqrt(kt0 / m_t), end = 10.0 / w;
  const auto overlap = [&](double t) { return depth * (1.0 + swing * std::sin(w * t)); };
  if (dt == 0.0) {
    const auto rate = [&](double t) { return depth * swing * w * std::cos(w * t); };
    oracle::Ode motion(
        [&](double t, const oracle::State &y, oracle::State &f) {
          const double d = overlap(t);
          f[0] = -(y[1] + ct * y[0]) / m_t;
          f[1] = contact.tangential(d, radius) * y[0] + (rate(t) < 0.0 ? 0.5 * y[1] * rate(t) / d : 0.0);
        },
        0.0, {1e-3, 0.0}, {1e-3, 1e-3 * kt0 / w});
    for (int turn = 0; (turn + 0.5) * M_PI < 10.0; ++turn) // where the overlap begins to shrink or to grow
      motion.advance((turn + 0.5) * M_PI / w);
    motion.advance(end);
    return motion.state()[0];
  }
  const long steps = std::lround(end / dt);
  const double lever = rolls ? radius : 1.0;
  VaryingSpring spring(contact, rolls, dt);
  double slip = 1e-3, force = 0.0;
  for (long n = 1; n <= steps; ++n) {
    const double half_slip = slip + 0.5 * dt * force / m_t, now = static_cast<double>(n) * dt;
    const double rate = (overlap(now) - overlap(now - dt)) / dt;
    force = spring.step(overlap(now), rate, {half_slip / lever, 0.0, 0.0}, ct)[0] / lever;
    slip = half_slip + 0.5 * dt * force / m_t;
  }
  return slip;
}

// Only the tangential dashpot, which acts with the slip of the middle of the step, is of first order there.
TEST(HertzTangentialSpring, IsOfSecondOrderInALastingContact) {
  const double w = 1.3 * std::sqrt(8.0 * 0.4 * E_eff * std::sqrt(radius * 1e-3) / (2.0 / 7.0 * m));
  for (const double share : {0.0, 0.1}) {
    const double ct = share * m * w, exact = slip_of_lasting_contact(ct, 0.0);
    const auto error = [&](int steps) {
      return std::fabs(slip_of_lasting_contact(ct, 10.0 / w / steps) - exact);
    };
    const double coarse = error(400), fine = error(3200);
    EXPECT_LT(fine, 1e-3 * 5e-3) << share;
    EXPECT_NEAR(std::log(coarse / fine) / std::log(8.0), share > 0.0 ? 1.0 : 2.0, 0.1)
        << share << ": " << coarse << " " << fine;
  }
}

TEST(HertzRollingSpring, IsOfSecondOrderInALastingContact) {
  const double w = 1.3 * std::sqrt(8.0 * 0.4 * E_eff * std::sqrt(radius * 1e-3) / (2.0 / 7.0 * m));
  const double exact = slip_of_lasting_contact(0.0, 0.0);
  const auto error = [&](int steps) {
    return std::fabs(slip_of_lasting_contact(0.0, 10.0 / w / steps, true) - exact);
  };
  const double coarse = error(400), fine = error(3200);
  EXPECT_LT(fine, 1e-3 * 5e-3);
  EXPECT_NEAR(std::log(coarse / fine) / std::log(8.0), 2.0, 0.1) << coarse << " " << fine;
}

// Loaded from 1 to 4 mm while it turns at w, T = w kr(d)/d' integrated over d; then unloaded to 1 mm without
// turning, which halves kr and, at the same angle, T.
TEST(HertzRollingSpring, KeepsItsTorqueWhileItIsLoadedAndItsAngleWhileItIsUnloaded) {
  const HertzContact contact{E_eff, 0.4 * E_eff, 0.0, Damping::ratio, Transition::B};
  constexpr double w = 0.2, speed = 1.0, thin = 1e-3, deep = 4e-3;
  const double exact = w / speed * 8.0 * 0.4 * E_eff * std::sqrt(radius) * radius * radius * 2.0 / 3.0 *
                       (std::pow(deep, 1.5) - std::pow(thin, 1.5));
  const auto torque = [&](int steps) {
    const double dt = (deep - thin) / speed / steps;
    VaryingSpring spring(contact, true, dt);
    double loaded = 0.0, unloaded = 0.0;
    for (int n = 1; n <= steps; ++n)
      loaded = -spring.step(thin + n * dt * speed, speed, {w, 0.0, 0.0})[0];
    for (int n = 1; n <= steps; ++n)
      unloaded = -spring.step(deep - n * dt * speed, -speed, {0.0, 0.0, 0.0})[0];
    // The last step of loading had the stiffness of its middle.
    EXPECT_NEAR(unloaded, std::sqrt(thin / (deep - 0.5 * dt * speed)) * loaded, 1e-12 * loaded);
    return loaded;
  };
  const double coarse = torque(100) - exact, fine = torque(400) - exact;
  EXPECT_LT(std::fabs(fine), 1e-6 * exact);
  EXPECT_NEAR(coarse / fine, 16.0, 0.5);
}

/// Whatever path overlap and rotation or slip take, the work done on the spring and its slider is at least
/// the energy in it. \param most of rotation about x and y or of slip \param limit of the force or torque at
/// an overlap, in the runs with an even number; the others have none that is reached
template <class Limit>
void expect_no_energy_from(bool rolls, unsigned seed, const Vec3 &most, const Limit &limit) {
  const HertzContact contact{E_eff, 0.4 * E_eff, 0.0, Damping::coefficient, Transition::B};
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double dt = 1e-4;
  for (int run = 0; run < 200; ++run) {
    VaryingSpring spring(contact, rolls, dt);
    double stored = 0.0, overlap = 1e-3;
    for (int n = 0; n < 500; ++n) {
      const double rate = 4.0 * unit(random);
      overlap = std::fmax(1e-6, overlap + dt * rate);
      const Vec3 motion{most[0] * unit(random), most[1] * unit(random), most[2] * unit(random)};
      const Vec3 load =
          spring.step(overlap, rate, motion, 0.0, run % 2 == 0 ? limit(contact, overlap) : 1e12);
      ASSERT_LE(spring.stored_after_change, stored * (1.0 + 1e-12));
      const double work = -dt * dot(load, motion);
      ASSERT_LE(spring.stored - stored, work + 1e-12 * (std::fabs(work) + stored));
      stored = spring.stored;
    }
  }
}

TEST(HertzRollingSpring, CannotCreateEnergy) {
  expect_no_energy_from(true, 11, {20.0, 20.0, 1.0}, [](const HertzContact &, double) { return 3e4; });
}

TEST(HertzTangentialSpring, CannotCreateEnergy) {
  expect_no_energy_from(false, 7, {1.0, 1.0, 0.0}, [](const HertzContact &contact, double overlap) {
    return 0.3 * contact.law(m, radius).spring(overlap);
  });
}

TEST(HertzLaw, FirstWeightIsThatOfTheZetaFunction) {
  // zeta(s, 2) = zeta(s) - 1; the weights make up for a sum over t^(1/4), here of 10^5 steps.
  EXPECT_NEAR(HertzLaw::first_weight(1.0), -2.0 * (boost::math::zeta(-0.25) - 1.0) - 1.0, 1e-9);
  for (const double share : {0.01, 0.2, 0.5, 0.9}) {
    const int steps = 100000;
    double sum = 0.5 * (1.0 + HertzLaw::first_weight(share)) * std::pow(share, 0.25);
    for (int n = 1; n < steps; ++n)
      sum += std::pow(n + share, 0.25);
    const double end = steps + share;
    const double integral =
        0.8 * std::pow(end, 1.25) - 0.5 * std::pow(end, 0.25) + 0.25 / 12.0 * std::pow(end, -0.75);
    EXPECT_NEAR(sum, integral, 1e-7) << share;
  }
}

} // namespace hertz_contact

/// The law that yields: its definitions, loop and heat. Whole impacts, also one after another, are in
/// law_impact_test.
namespace yield_contact {

constexpr double k1 = 1e7, m = 2.0;

YieldContact contact_of(Transition transition, double D, double ratio) {
  return {k1, ratio, D, Damping::ratio, transition, 0.0};
}

TEST(YieldLaw, IsItsFormula) {
  const double k2 = 3e7, c = 1e3, largest = 1e-3, plastic = largest * 2.0 / 3.0;
  const YieldLaw a(k1, k2, c, Transition::A, largest);
  for (const double rate : {-1.0, 0.0, 0.3})
    for (const double d : {1e-5, 0.5 * plastic, 0.99 * plastic, 8e-4, 1e-3, 1.2e-3}) {
      const double spring = d >= largest ? k1 * d : d > plastic ? k2 * (d - plastic) : 0.0;
      EXPECT_NEAR(a.force(d, rate), spring + c * rate, 1e-12 * k1 * d) << d; // also below the plastic overlap
      EXPECT_NEAR(a.energy(d), 0.5 * spring * spring / k2, 1e-12 * k1 * d * d);
      EXPECT_EQ(a.stiffest(d), k2);
      EXPECT_EQ(a.slope(d), d >= largest ? k1 : d > plastic ? k2 : 0.0);
    }
}

TEST(YieldLaw, IsTheLinearLawWhereUnloadingIsNotStiffer) {
  const YieldContact yields{k1, 1.0, 0.3, Damping::ratio, Transition::B, 0.0};
  const LinearContact linear{k1, 0.3, Damping::ratio, Transition::B};
  for (const double largest : {0.0, 1e-3})
    for (const double d : {1e-5, 5e-4, 1e-3, 2e-3})
      for (const double rate : {-0.4, 0.7}) {
        const YieldLaw law = yields.law(m, 0.0, largest);
        EXPECT_NEAR(law.force(d, rate), linear.law(m).force(d, rate), 1e-12 * k1 * d);
        EXPECT_NEAR(law.power(d, rate).dissipated, linear.law(m).power(d, rate).dissipated, 1e-10 * k1 * d);
      }
}

// At the overlap at the end of a step, remember() changes no bit of the force.
TEST(YieldLaw, HasTheSameBitsWithWhatItRemembersAtTheEndOfItsStep) {
  for (const double largest : {0.0, 3e-4, 1e-3, 2e-3})
    for (const double d : {1e-5, 7.1e-4, 1e-3, 1.3e-3}) {
      const YieldLaw before(1e7, 3e7, 1e3, Transition::A, largest);
      YieldLaw after = before;
      for (int n = 0; n < 2; ++n) { // a set-up computes a step again
        after.remember(d);
        EXPECT_EQ(after.memory(), std::max(largest, d));
        EXPECT_EQ(after.force(d, 0.3), before.force(d, 0.3));
        EXPECT_EQ(after.energy(d), before.energy(d));
        EXPECT_EQ(after.power(d, 0.3).stored, before.power(d, 0.3).stored);
        EXPECT_EQ(after.yielded(d), before.yielded(d));
      }
    }
}

// Along any path the work is the stored energy and the heat; without a dashpot all heat is that of yielding.
TEST(YieldLaw, StoresThePartOfItsWorkThatItGivesBack) {
  YieldLaw law(1e7, 3e7, 0.0, Transition::B, 0.0);
  double work = 0.0, heat = 0.0, before = 0.0;
  constexpr int steps = 400000;
  constexpr double dt = 1.0 / steps;
  for (int n = 1; n <= steps; ++n) {
    const double t = n * dt, d = 1e-3 * (std::sin(11.0 * t) + 1.2 * t), rate = (d - before) / dt;
    const double middle = 0.5 * (d + before);
    if (middle > 0.0) {
      const ContactPower power = law.power(middle, rate);
      EXPECT_GE(power.dissipated, 0.0);
      work += dt * law.force(middle, rate) * rate;
      heat += dt * power.dissipated;
    }
    law.remember(d);
    before = d;
  }
  EXPECT_GT(heat, 1.0);
  EXPECT_NEAR(work, law.energy(before) + heat, 1e-5 * work); // of first order in dt in steps across a kink
  EXPECT_NEAR(heat, law.yielded(before), 1e-5 * work);
}

/// Moves the overlap and returns the work on the spring, J, by the midpoint rule.
double work_of(YieldLaw &law, double from, double to) {
  constexpr int steps = 30000;
  const double change = (to - from) / steps;
  double work = 0.0;
  for (int n = 0; n < steps; ++n) {
    work += law.spring(from + (n + 0.5) * change) * change;
    law.remember(from + (n + 1) * change);
  }
  return work;
}

// A cycle from 0 to the overlap d_max and back turns (1 - k1/k2) k1 d_max^2 / 2 into heat. The same cycle
// again turns none, and a cycle to a larger overlap the difference. The plastic overlap is (1 - k1/k2) d_max.
TEST(YieldLaw, LoopHasTheHeatAndThePlasticOverlapOfTheClosedForms) {
  for (const double ratio : {1.5, 4.0, 20.0}) {
    YieldLaw law = contact_of(Transition::B, 0.0, ratio).law(m, 0.0, 0.0);
    const double q = 1.0 / ratio, d_max = 1e-3, loop = 0.5 * (1.0 - q) * k1 * d_max * d_max,
                 size = 0.5 * k1 * d_max * d_max;
    const double there = work_of(law, 0.0, d_max);
    EXPECT_NEAR(there, size, 1e-7 * size);
    EXPECT_NEAR(law.energy(d_max), q * size, 1e-12 * size);
    EXPECT_NEAR(-work_of(law, d_max, 0.0), law.energy(d_max), 1e-7 * size) << "what unloading gives back";
    EXPECT_NEAR(law.yielded(0.5 * d_max), loop, 1e-12 * size);
    EXPECT_NEAR(work_of(law, 0.0, d_max) + work_of(law, d_max, 0.0), 0.0, 1e-7 * size);
    EXPECT_NEAR(work_of(law, 0.0, 2.0 * d_max) + work_of(law, 2.0 * d_max, 0.0), 3.0 * loop, 1e-6 * size);
    const double plastic = (1.0 - q) * 2.0 * d_max;
    EXPECT_EQ(law.spring(0.999999 * plastic), 0.0);
    EXPECT_GT(law.spring(1.000001 * plastic), 0.0);
  }
}

// A ball that stands on a contact that has yielded, under a force that changes, neither sinks nor gains.
TEST(YieldRest, NeitherCreepsNorGainsEnergyInAMillionSteps) {
  const YieldLaw law = contact_of(Transition::B, 0.0, 3.0).law(m, 0.0, 0.0);
  const double w = std::sqrt(3.0 * k1 / m), dt = 0.1 / w, weight = 20.0, deep = weight / k1;
  verlet::Ball<YieldLaw> ball(m, 0.0, 0.0, dt, {{0.0, 1.0, law}}, -weight);
  for (int n = 0; n < 1000; ++n) // it falls to twice that and then vibrates along k2
    ball.step();
  double lowest = 0.0, highest = -1.0, early_lowest = 0.0, early_highest = -1.0;
  for (int n = 0; n < 1000000; ++n) {
    ball.step();
    lowest = std::fmin(lowest, ball.x);
    highest = std::fmax(highest, ball.x);
    if (n > 1000) continue;
    early_lowest = std::fmin(early_lowest, ball.x);
    early_highest = std::fmax(early_highest, ball.x);
  }
  EXPECT_NEAR(lowest, early_lowest, 5e-3 * deep);
  EXPECT_NEAR(highest, early_highest, 5e-3 * deep);
}

} // namespace yield_contact

} // namespace
} // namespace drumlin::test
