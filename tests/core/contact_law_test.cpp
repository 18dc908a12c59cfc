/// The contact laws instant by instant: what all have in common; of the linear law closed forms, definitions
/// and identities. Whole impacts are in law_impact_test.

#include "physics/laws/laws.h"
#include "tests/core/vectors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace {

using namespace drumlin::physics;

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

} // namespace
