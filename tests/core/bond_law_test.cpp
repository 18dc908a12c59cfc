/// The bond against the damped oscillator, in closed form and by CVODE.

#include "physics/bodies/bond_law.h"
#include "tests/support/ode.h"
#include "tests/support/oscillator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

namespace {

using namespace drumlin::physics;

constexpr double m = 1000.0, k = 1e6;

TEST(BondLaw, AcceleratesAMassAsTheClosedFormDoes) {
  for (const double ratio : {0.0, 0.16, 0.7, 1.5, 20.0}) {
    const Bond bond{k, 2.0 * ratio * std::sqrt(m * k), 0.75};
    const oracle::Oscillator closed{m, k, bond.damping};
    for (int i = 0; i <= 300; ++i) {
      const oracle::Motion now = closed.at(1e-3 * i, 0.02, -0.5);
      const double scale = 1e-11 * (k * 0.02 + bond.damping * 0.5);
      ASSERT_NEAR(bond_force(bond, 0.75 + now.x, now.v).force, -m * now.a, scale) << "D " << ratio;
    }
  }
}

/// A mass on the bond's other end, fourth order steps on the core's law.
std::pair<double, double> hung(const Bond &bond, double e, double v, double t) {
  const int steps = 20000;
  const double dt = t / steps;
  const auto a = [&](double x, double u) { return -bond_force(bond, bond.length + x, u).force / m; };
  for (int n = 0; n < steps; ++n) {
    const double v1 = v, a1 = a(e, v1);
    const double v2 = v + 0.5 * dt * a1, a2 = a(e + 0.5 * dt * v1, v2);
    const double v3 = v + 0.5 * dt * a2, a3 = a(e + 0.5 * dt * v2, v3);
    const double v4 = v + dt * a3, a4 = a(e + dt * v3, v4);
    e += dt / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
    v += dt / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  }
  return {e, v};
}

TEST(BondLaw, SwingsAsTheClosedFormAndCvode) {
  const double w0 = std::sqrt(k / m);
  for (const double ratio : {0.16, 1.0, 4.0})
    for (const double t : {0.02, 0.2}) {
      const Bond bond{k, 2.0 * ratio * std::sqrt(m * k), 0.75};
      const auto [e, v] = hung(bond, 0.02, -0.5, t);
      if (ratio == 1.0) { // the double root: e = (e0 + (v0 + w0 e0) t) exp(-w0 t)
        const double slope = -0.5 + w0 * 0.02;
        EXPECT_NEAR(e, (0.02 + slope * t) * std::exp(-w0 * t), 1e-12);
        EXPECT_NEAR(v, (slope - w0 * (0.02 + slope * t)) * std::exp(-w0 * t), 1e-10);
      } else {
        const oracle::Motion closed = oracle::Oscillator{m, k, bond.damping}.at(t, 0.02, -0.5);
        EXPECT_NEAR(e, closed.x, 1e-12);
        EXPECT_NEAR(v, closed.v, 1e-10);
      }
      oracle::Ode exact(
          [&](double, const oracle::State &y, oracle::State &f) {
            f[0] = y[1];
            f[1] = -(k * y[0] + bond.damping * y[1]) / m;
          },
          0.0, {0.02, -0.5}, {0.02, 0.5});
      exact.advance(t);
      EXPECT_NEAR(e, exact.state()[0], 1e-10);
      EXPECT_NEAR(v, exact.state()[1], 1e-8);
    }
}

TEST(BondLaw, PullsWhenLongAndPushesWhenShort) {
  const Bond bond{k, 1e4, 0.75};
  EXPECT_NEAR(bond_force(bond, 0.76, 0.0).force, 1e4, 1e-6);
  EXPECT_NEAR(bond_force(bond, 0.74, 0.0).force, -1e4, 1e-6);
  EXPECT_EQ(bond_force(bond, 0.75, 0.2).force, 2e3);
  EXPECT_EQ(bond_force(bond, 0.75, 0.0).force, 0.0);
}

TEST(BondLaw, SplitsThePowerIntoSpringAndDashpot) {
  const Bond bond{k, 1e4, 0.75};
  std::mt19937 random(611953);
  std::uniform_real_distribution<double> stretch(-0.05, 0.05), rate(-1.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const double e = stretch(random), r = rate(random), h = 1e-6;
    const BondForce now = bond_force(bond, 0.75 + e, r);
    const double stored_rate =
        (bond_force(bond, 0.75 + e + r * h, r).stored - bond_force(bond, 0.75 + e - r * h, r).stored) /
        (2.0 * h);
    ASSERT_GE(now.dissipated, 0.0);
    ASSERT_GE(now.stored, 0.0);
    ASSERT_NEAR(now.force * r, stored_rate + now.dissipated, 1e-3);
  }
}

TEST(BondLaw, BreaksBeyondItsStrengthInTensionAndInCompression) {
  const Bond bond{k, 0.0, 0.75, 1e4};
  EXPECT_FALSE(bond_force(bond, 0.75 + 0.00999, 0.0).breaks);
  EXPECT_TRUE(bond_force(bond, 0.75 + 0.01001, 0.0).breaks);
  EXPECT_FALSE(bond_force(bond, 0.75 - 0.00999, 0.0).breaks);
  EXPECT_TRUE(bond_force(bond, 0.75 - 0.01001, 0.0).breaks);
  const Bond damped{k, 1e4, 0.75, 1e4};
  EXPECT_TRUE(bond_force(damped, 0.75, 1.01).breaks); // the dashpot's force counts
  EXPECT_FALSE(bond_force(Bond{k, 0.0, 0.75}, 1e9, 0.0).breaks);
}

} // namespace
