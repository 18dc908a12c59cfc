// Rolling resistance: closed forms of the spring and of a ball that rolls to rest, CVODE with a mode for the
// spring and one for its limit, the plane of the torque, limit and energy in every step.

#include "physics/laws/rolling_law.h"

#include "physics/laws/linear_contact.h"
#include "tests/core/vectors.h"
#include "tests/support/ode.h"
#include "tests/support/oscillator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace drumlin::physics;
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

} // namespace
