/// The law that yields: its definitions, loop and heat. Whole impacts, also one after another, are in
/// law_impact_test.

#include "physics/laws/linear_contact.h"
#include "physics/laws/yield_contact.h"
#include "tests/core/velocity_verlet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace drumlin::physics;

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

} // namespace
