/// The contact law instant by instant: closed forms, definitions and identities. Whole impacts are in
/// restitution_test.

#include "physics/laws/linear_contact.h"

#include "tests/plugin/physics/velocity_verlet.h"
#include "tests/support/ode.h"
#include "tests/support/oscillator.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace {

using namespace drumlin::physics;

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(ContactLaw, DeceleratesAMassAsTheClosedFormOfAnImpactDoes) {
  const double m = 2000.0, k = 1e8, v = 0.4;
  for (const double ratio : {0.0, 0.2, 0.5, 0.8, 2.0}) {
    const double c = LinearContact{k, ratio, Damping::ratio, Transition::A}.damping_coefficient(m);
    const oracle::Oscillator impact{m, k, 2.0 * ratio * std::sqrt(m * k)};
    const double w0 = std::sqrt(k / m);
    for (int i = 1; i < 400; ++i) {
      const oracle::Motion now = impact.at(0.01 * i / w0, 0.0, v);
      const double closed = now.x > 0.0 ? -m * now.a : 0.0;
      const double scale = 1e-12 * (1.0 + 2.0 * ratio) * v * std::sqrt(k * m);
      EXPECT_NEAR(LinearLaw(k, c, Transition::A).force(now.x, now.v), closed, scale)
          << "D " << ratio << " i " << i;
      EXPECT_NEAR(LinearLaw(k, c, Transition::B).force(now.x, now.v), closed > 0.0 ? closed : 0.0, scale);
    }
  }
}

TEST(ContactLaw, IsZeroWithoutOverlap) {
  for (const Transition transition : {Transition::A, Transition::B})
    for (const double overlap : {0.0, -1e-9, -1.0})
      for (const double rate : {-2.0, 0.0, 2.0}) {
        EXPECT_EQ(LinearLaw(1e8, 1e6, transition).force(overlap, rate), 0.0);
        EXPECT_FALSE(LinearLaw(1e8, 1e6, transition).acts(overlap, rate));
        EXPECT_EQ(LinearLaw(1e8, 0.0, Transition::B).energy(overlap), 0.0);
        EXPECT_EQ(LinearLaw(1e8, 1e6, transition).power(overlap, rate).dissipated, 0.0);
        EXPECT_EQ(LinearLaw(1e8, 1e6, transition).power(overlap, rate).stored, 0.0);
      }
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

TEST(ContactLaw, BNeverPullsAndElseEqualsA) {
  std::mt19937 random(7919);
  std::uniform_real_distribution<double> overlap(-1e-3, 1e-3), rate(-1.0, 1.0);
  int clamped = 0, equal = 0;
  for (int i = 0; i < 20000; ++i) {
    const double d = overlap(random), r = rate(random);
    const double a = LinearLaw(1e8, 2e5, Transition::A).force(d, r);
    const double b = LinearLaw(1e8, 2e5, Transition::B).force(d, r);
    ASSERT_GE(b, 0.0);
    if (a < 0.0) {
      ASSERT_EQ(b, 0.0);
      ++clamped;
    } else {
      ASSERT_EQ(b, a);
      if (a > 0.0) ++equal;
    }
    ASSERT_EQ(LinearLaw(1e8, 2e5, Transition::B).acts(d, r), b > 0.0);
  }
  EXPECT_GT(clamped, 1000);
  EXPECT_GT(equal, 1000);
}

// The drum of Eq. (1) where it turns round before the gap opens (D = 0.5, 20 Hz, k = 10 MN/m): overlap stays,
// the contact breaks and is made again at Fc = 0. The reference is CVODE with a mode for contact and one for
// none. Longer than other tests: the reference solution, with its change of modes, is part of it.
TEST(ContactLaw, IsMadeAgainAtZeroForceWhileStillOverlapping) {
  const double m2 = 2000.0, m3 = 1000.0, k = 1e7, k23 = 1e6, c23 = 1e4, g = 9.81, Fw = 58.8e3,
               w = 125.66370614359172;
  const double c = std::sqrt(m2 * k); // D = 0.5
  const double end = 8.0 * 2.0 * 3.14159265358979323846 / w;
  const double d0 = (m2 + m3) * g / k;

  bool touching = true;
  int makes_at_overlap = 0, makes_at_gap = 0;
  // y = overlap of drum and soil, its rate, then the frame's height and velocity; the soil is at rest: d =
  // -x2.
  oracle::Ode exact(
      [&](double t, const oracle::State &y, oracle::State &f) {
        const double bond = c23 * (y[3] + y[1]) + k23 * (y[2] + y[0]);
        const double contact = touching ? k * y[0] + c * y[1] : 0.0;
        f[0] = y[1];
        f[1] = -(-m2 * g + contact + bond - Fw * std::sin(w * t)) / m2;
        f[2] = y[3];
        f[3] = (-m3 * g - bond) / m3;
      },
      0.0, {d0, 0.0, -d0 - m3 * g / k23, 0.0}, {1e-3, 0.1, 1e-3, 0.1});
  const std::vector<oracle::Event> events{[&](double, const oracle::State &y) { return k * y[0] + c * y[1]; },
                                          [](double, const oracle::State &y) { return y[0]; }};
  while (exact.time() < end) {
    if (exact.advance(end, events) < 0) break;
    const double d = exact.state()[0];
    const double force = k * d + c * exact.state()[1];
    const bool zero_force = std::fabs(force) < 1e-3;
    if (touching && zero_force) {
      touching = false;
    } else if (!touching && zero_force && d > 0.0) {
      touching = true;
      ++makes_at_overlap;
    } else if (!zero_force && std::fabs(d) < 1e-9) {
      touching = force > 0.0;
      if (touching) ++makes_at_gap;
    }
    exact.restart(exact.state());
  }
  ASSERT_GE(makes_at_overlap, 3);

  const int steps = 400000;
  const double dt = end / steps;
  const auto forces = [&](double t, const std::array<double, 2> &x, const std::array<double, 2> &v) {
    const double bond = c23 * (v[1] - v[0]) + k23 * (x[1] - x[0]);
    const double contact = LinearLaw(k, c, Transition::B).force(-x[0], -v[0]);
    return std::array<double, 2>{-m2 * g + contact + bond - Fw * std::sin(w * t), -m3 * g - bond};
  };
  verlet::Balls<2> balls{{m2, m3}, {-d0, -d0 - m3 * g / k23}, {0.0, 0.0}};
  int makes = 0;
  bool was = true;
  for (int n = 1; n <= steps; ++n) {
    verlet::stock_step(balls, n * dt, dt, forces);
    const bool is = LinearLaw(k, c, Transition::B).acts(-balls.x[0], -balls.v[0]);
    if (is && !was) ++makes;
    was = is;
  }
  EXPECT_EQ(makes, makes_at_overlap + makes_at_gap);
  EXPECT_NEAR(-balls.x[0], exact.state()[0], 2e-7);
  EXPECT_NEAR(balls.x[1], exact.state()[2], 2e-7);
  EXPECT_NEAR(-balls.v[0], exact.state()[1], 2e-5);
}

TEST(ContactLaw, PropagatesNaN) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Transition transition : {Transition::A, Transition::B}) {
    EXPECT_TRUE(std::isnan(LinearLaw(1e8, 1e5, transition).force(nan, 0.0)));
    EXPECT_TRUE(std::isnan(LinearLaw(1e8, 1e5, transition).force(1e-3, nan)));
  }
  EXPECT_TRUE(std::isnan(LinearLaw(1e8, 0.0, Transition::B).energy(nan)));
}

TEST(ContactPower, IsTheBallsPowerAndIsPassive) {
  std::mt19937 random(104729);
  std::uniform_real_distribution<double> overlap(0.0, 1e-3), rate(-1.0, 1.0);
  for (const Transition transition : {Transition::A, Transition::B})
    for (int i = 0; i < 20000; ++i) {
      const double k = 1e8, c = 2e5, d = overlap(random), r = rate(random);
      const ContactPower power = LinearLaw(k, c, transition).power(d, r);
      const double given = LinearLaw(k, c, transition).force(d, r) * r;
      ASSERT_NEAR(power.dissipated + power.stored, given, 1e-12 * (c + k * d));
      ASSERT_GE(power.dissipated, 0.0);
      ASSERT_LE(power.dissipated,
                c * r * r * (1.0 + 1e-14)); // the clamp only reduces the dissipation
    }
}

TEST(ContactPower, StoredIsTheRateOfTheContactEnergy) {
  const double k = 1e8, h = 1e-7;
  for (const double d : {1e-4, 5e-4, 1e-3})
    for (const double r : {-0.9, 0.3}) {
      const double slope = (LinearLaw(k, 0.0, Transition::B).energy(d + r * h) -
                            LinearLaw(k, 0.0, Transition::B).energy(d - r * h)) /
                           (2.0 * h);
      EXPECT_NEAR(LinearLaw(k, 1e5, Transition::A).power(d, r).stored, slope, 1e-6 * std::fabs(slope));
    }
  EXPECT_DOUBLE_EQ(LinearLaw(1e8, 0.0, Transition::B).energy(1e-3), 50.0);
}

TEST(ContactPower, IsTheDashpotsOnlyWhereTheLawIsNotClamped) {
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
