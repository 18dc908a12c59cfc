/// The absorbing boundary against closed forms and CVODE.

#include "physics/bodies/absorbing_boundary.h"
#include "tests/support/ode.h"
#include "tests/support/oscillator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace {

using namespace drumlin::physics;

constexpr double pi = 3.141592653589793;
constexpr double rho = 1800.0, cp = 300.0, cs = 170.0, H = 2.5, area = 0.4;
constexpr double Z = rho * cp * area, K = rho * cp * cp * area / H;   // along the normal, written out
constexpr double Zs = rho * cs * area, Ks = rho * cs * cs * area / H; // in the plane
const Vec3 oblique{0.6, 0.0, 0.8}, in_plane{-0.8, 0.0, 0.6};

GroundedBall boundary(const Vec3 &normal, double balls = 1.0, double depth = H) {
  const Ground ground{rho, cp, cs, depth, area};
  EXPECT_EQ(ground.invalid(), "");
  return {normal, ground.along_normal(balls), ground.in_plane(balls)};
}

TEST(AbsorbingBoundary, ActsAlongTheNormalAndInThePlaneAsStated) {
  const GroundedBall ball = boundary(oblique, 5.0);
  const double un = 2e-4, ut = -3e-4, uy = 1e-4, vn = 0.02, vt = 0.05, vy = -0.01;
  const auto at = [](double n, double t, double y) {
    return Vec3{n * oblique[0] + t * in_plane[0], y, n * oblique[2] + t * in_plane[2]};
  };
  const Vec3 found = ball.force(at(un, ut, uy), at(vn, vt, vy));
  const Vec3 expected = at(-(K * un + Z * vn) / 5.0, -(Ks * ut + Zs * vt) / 5.0, -(Ks * uy + Zs * vy) / 5.0);
  for (std::size_t a = 0; a < 3; ++a)
    EXPECT_NEAR(found[a], expected[a], 1e-10 * K * 1e-4);
  EXPECT_EQ(boundary(oblique, 5.0, std::numeric_limits<double>::infinity()).along.stiffness, 0.0);
  const double q = 1e5; // the layer settles by q H/M under a pressure q
  EXPECT_NEAR(dot(oblique, ball.force(at(-q * H / (rho * cp * cp), 0.0, 0.0), {})), q * area / 5.0, 1e-9 * q);
}

TEST(AbsorbingBoundary, PowerIsStoredOrTurnsIntoHeat) {
  const GroundedBall ball = boundary(oblique);
  std::mt19937 random(611953);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 u{any(random), any(random), any(random)}, v{any(random), any(random), any(random)};
    const double h = 1e-4;
    const double stored_rate = (ball.stored(sum(u, h, v)) - ball.stored(sum(u, -h, v))) / (2.0 * h);
    ASSERT_GE(ball.heat(v), 0.0);
    ASSERT_NEAR(-dot(ball.force(u, v), v), stored_rate + ball.heat(v), 1e-7 * K);
  }
}

// A semi-infinite elastic rod of the ground's impedance ends at the boundary. A wave of velocity v_i arrives,
// the end moves with v, and the rod exerts Z (2 v_i - v) on the boundary: d'Alembert's solution. The velocity
// of the reflected wave is v - v_i. CVODE solves the same end with formulas of its own.
TEST(AbsorbingBoundary, ReflectsTheShareOfTheEnergyThatTheLayerDoes) {
  const GroundedBall ball = boundary({0.0, 0.0, 1.0});
  for (const double ratio : {0.05, 0.5, 2.0}) { // w H / c_p
    const double w = ratio * cp / H, period = 2.0 * pi / w;
    const auto incident = [w](double t) { return std::sin(w * t); };
    // The velocity with which the forces on the end balance: one step of Newton's method on a linear force.
    const auto end_velocity = [&](double t, double u) {
      const auto unbalanced = [&](double v) {
        return Z * (2.0 * incident(t) - v) + ball.force({0.0, 0.0, u}, {0.0, 0.0, v})[2];
      };
      return unbalanced(0.0) / (unbalanced(0.0) - unbalanced(1.0));
    };
    const int steps = 4000;
    double u = 0.0, arrived = 0.0, reflected = 0.0;
    oracle::Ode exact(
        [&](double t, const oracle::State &y, oracle::State &f) { f[0] = incident(t) - 0.5 * K / Z * y[0]; },
        0.0, {0.0}, {1.0 / w});
    const int cycles = 10 + static_cast<int>(20.0 / (K / Z / 2.0 * period)); // until the start has died away
    const double dt = period / steps;
    for (int n = 0; n < cycles * steps; ++n) {
      const double t = n * dt;
      const double v1 = end_velocity(t, u), v2 = end_velocity(t + 0.5 * dt, u + 0.5 * dt * v1);
      u += dt * v2;
      if (n < (cycles - 1) * steps) continue;
      const double v = end_velocity(t + dt, u), back = v - incident(t + dt);
      arrived += incident(t + dt) * incident(t + dt);
      reflected += back * back;
    }
    exact.advance(cycles * period);
    EXPECT_NEAR(u, exact.state()[0], 2e-6 / w) << ratio;
    EXPECT_NEAR(reflected / arrived, 1.0 / (1.0 + 4.0 * ratio * ratio), 2e-6) << ratio;
  }
}

// ---- In time steps

enum class Pass { alone, coupled };

/// A ball of mass m, released at rest beside its reference, by velocity Verlet with the second-order scheme.
Vec3 released(const GroundedBall &ball, double m, const Vec3 &start, double time, int steps, Pass pass) {
  const double dt = time / steps;
  Vec3 u = start, v{}, force = ball.force(u, v);
  for (int n = 0; n < steps; ++n) {
    const Vec3 half = sum(v, 0.5 * dt / m, force);
    u = sum(u, dt, half);
    const GroundedStep step{u, half, v, force, dt};
    if (pass == Pass::alone) {
      force = implicit_force(ball, step, m);
    } else {
      const CoupledGround coupled = coupled_ground(ball, step, std::sqrt(ball.along.damping) / m);
      force = coupled.second(ball.normal, sum(half, 0.5 * dt / m, coupled.first(ball.normal)));
    }
    v = sum(half, 0.5 * dt / m, force);
  }
  return u;
}

TEST(AbsorbingBoundary, StepsAreOfSecondOrderAlongTheNormalAndInThePlane) {
  const GroundedBall ball = boundary(oblique);
  for (const double m : {20.0, 500.0, 20000.0}) // damping ratios from above 1 to far below
    for (const Pass pass : {Pass::alone, Pass::coupled}) {
      const double time = 4.0 / std::sqrt(K / m);
      for (const bool along : {true, false}) {
        const Vec3 &axis = along ? oblique : in_plane;
        const double exact = oracle::Oscillator{m, along ? K : Ks, along ? Z : Zs}.at(time, 1e-3, 0.0).x;
        const auto error = [&](int steps) {
          return std::fabs(dot(axis, released(ball, m, scaled(1e-3, axis), time, steps, pass)) - exact);
        };
        const double order = std::log2(error(1600) / error(3200));
        EXPECT_NEAR(order, 2.0, 0.15) << m << (along ? " normal" : " plane");
        EXPECT_LT(error(3200), 1e-7) << m << (along ? " normal" : " plane");
      }
    }
}

TEST(AbsorbingBoundary, StaysStableUpToItsCriticalStepAndNotBeyond) {
  const double m = 500.0;
  for (const bool implicit : {true, false}) {
    const GroundedBall ball = boundary(oblique);
    LoadedBall loads;
    loads.add(ball.modes(m, implicit));
    const double critical = loads.critical_step();
    EXPECT_NEAR(critical, critical_step_stock(K, implicit ? 0.0 : Z, m), 1e-9 * critical);
    for (const double part : {0.99, 1.01}) {
      double u = 1.0, v = 0.0, force = ball.force(oblique, {})[2] / oblique[2];
      const double dt = part * critical;
      for (int n = 0; n < 2000; ++n) {
        const double half = v + 0.5 * dt / m * force;
        u += dt * half;
        const Vec3 at = scaled(u, oblique), rate = scaled(half, oblique);
        const GroundedStep step{at, rate, scaled(v, oblique), scaled(force, oblique), dt};
        force = dot(oblique, implicit ? implicit_force(ball, step, m) : ball.force(at, rate));
        v = half + 0.5 * dt / m * force;
      }
      EXPECT_EQ(std::fabs(u) < 1.0, part < 1.0) << implicit << " " << part << ": " << u;
    }
  }
}

} // namespace
