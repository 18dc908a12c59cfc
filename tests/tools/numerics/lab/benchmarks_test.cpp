// Closed forms and the reference solution of the benchmarks study against CVODE, which shares no code with
// them: the state that CVODE ends with is given to the checks as if an engine had computed it.
#include "lab/benchmarks/checks.h"
#include "tests/support/ode.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace drumlin::test {
namespace {

using oracle::Ode;
using oracle::State;
using post::BenchmarkRun;
using post::SphereSetup;

/// An aluminium sphere on a rigid plane, or on one of its kind.
SphereSetup hertz(double spheres = 1) {
  SphereSetup s;
  s.spheres = spheres;
  s.E_eff = 8e10 / spheres, s.G_eff = 1.6e10 / spheres;
  s.r1 = s.r2 = 0.01;
  s.m1 = s.m2 = 0.0113;
  s.vn = 2.0;
  s.velocity_ratio = spheres > 1 ? -1.0 : 0.0;
  s.mu = 0.3;
  return s;
}

SphereSetup linear(double spheres = 1) {
  SphereSetup s = hertz(spheres);
  s.k = 1e7, s.kt = 2.0 / 7.0 * s.k;
  return s;
}

double stiffness(const SphereSetup &s) {
  return s.k > 0.0 ? s.k : 4.0 / 3.0 * s.E_eff * std::sqrt(s.spheres > 1 ? 0.5 * s.r1 : s.r1);
}

/// Sphere 1 after an elastic impact on a plane: overlap, rate, velocity, spin, force of the tangential
/// spring; friction slides along +x all the time, or never.
post::AfterImpact by_cvode(const SphereSetup &s, bool slides) {
  const double k = stiffness(s), inertia = 0.4 * s.m1 * s.r1 * s.r1;
  const auto spring = [&](double d) { return s.k > 0.0 ? k * d : k * std::pow(std::max(d, 0.0), 1.5); };
  const auto kt = [&](double d) {
    return s.k > 0.0 ? s.kt : 8.0 * s.G_eff * std::sqrt(s.r1 * std::max(d, 0.0));
  };
  const auto rates = [&](double /*t*/, const State &y, State &dydt) {
    const double d = y[0], F = spring(d), arm = s.r1 - 0.5 * d;
    const double pull = slides ? s.mu * F : y[4];
    const double shrinks = s.k > 0.0 || y[1] > 0.0 || d <= 0.0 ? 0.0 : 0.5 * y[4] * y[1] / d;
    dydt = {y[1], -F / s.m1, -pull / s.m1, pull * arm / inertia, kt(d) * (y[2] - arm * y[3]) + shrinks};
  };
  const double T = 1e-4, F = std::pow(1.25 * s.m1 * s.vn * s.vn, 0.6) * std::pow(k, 0.4);
  Ode ode(rates, 0.0, {0.0, s.vn, s.vt, s.spin, 0.0}, {1e-4, s.vn, s.vn, s.vn / s.r1, F});
  EXPECT_EQ(ode.advance(100 * T, {[](double /*t*/, const State &y) { return y[1]; }}),
            0); // the largest overlap
  const double most = ode.state()[0];
  ode.restart(ode.state());
  EXPECT_EQ(ode.advance(100 * T, {[most](double /*t*/, const State &y) { return y[0] - 1e-9 * most; }}), 0);
  const State &y = ode.state();
  return {y[2], -y[1], y[3], 0.0, 0.0, 0.0};
}

void expect_near(const post::AfterImpact &a, const post::AfterImpact &b, const SphereSetup &s,
                 double tolerance) {
  EXPECT_NEAR(a.vx, b.vx, tolerance * s.vn);
  EXPECT_NEAR(a.vz, b.vz, tolerance * s.vn);
  EXPECT_NEAR(a.spin, b.spin, tolerance * s.vn / s.r1);
  EXPECT_NEAR(a.vx2, b.vx2, tolerance * s.vn);
  EXPECT_NEAR(a.vz2, b.vz2, tolerance * s.vn);
  EXPECT_NEAR(a.spin2, b.spin2, tolerance * s.vn / s.r1);
}

TEST(BenchmarkImpact, ClosedFormOfSlidingIsThatOfTheEquations) {
  for (SphereSetup s : {hertz(), linear()}) {
    s.vt = 8.0, s.spin = 20.0;
    ASSERT_TRUE(post::slides_throughout(s));
    expect_near(post::sliding_impact(s), by_cvode(s, true), s, 1e-7);
  }
}

TEST(BenchmarkImpact, ReferenceSolutionIsThatOfTheEquations) {
  for (SphereSetup s : {hertz(), linear()}) {
    s.vt = 8.0;
    expect_near(post::integrated_impact(s), by_cvode(s, true), s, 2e-5);
    s.vt = 0.3, s.mu = 1e9;
    expect_near(post::integrated_impact(s), by_cvode(s, false), s, 2e-5);
  }
}

TEST(BenchmarkImpact, ReferenceSolutionSlidesAsTheClosedForm) {
  for (const double spheres : {1.0, 2.0})
    for (SphereSetup s : {hertz(spheres), linear(spheres)})
      for (const double e : {1.0, 0.9, 0.5}) {
        s.e = e, s.vt = -9.0 / spheres, s.spin = 30.0, s.spin_ratio = 0.5;
        ASSERT_TRUE(post::slides_throughout(s));
        expect_near(post::integrated_impact(s), post::sliding_impact(s), s,
                    e == 1.0 ? 2e-5 : 2e-3); // the lever arm is that of e = 1
      }
}

/// The checks of a run of a test that ended so.
double worst(const std::string &test, const SphereSetup &setup, const post::SphereEnd &end) {
  const BenchmarkRun run{test, "", 0.0, "liggghts", setup, end};
  double most = 0.0;
  for (const post::BenchmarkCheck &check : post::benchmark_checks(run))
    most = std::max(most, check.error() / check.tolerance);
  return most;
}

/// Rolling of a rigid sphere: the velocity and the spin times the radius at the end.
post::SphereEnd rolling(const SphereSetup &s, const std::function<double(const State &)> &force,
                        const std::function<double(const State &)> &torque) {
  const double slope = s.slope * M_PI / 180.0;
  Ode ode(
      [&](double /*t*/, const State &y, State &dydt) {
        dydt = {y[1], s.g * std::sin(slope) + force(y) / s.m1,
                (torque(y) - s.r1 * force(y)) / (0.4 * s.m1 * s.r1 * s.r1)};
      },
      0.0, {0.0, s.vt, s.spin}, {1.0, 1.0, 1.0 / s.r1});
  const bool stops = s.vt > 0.0 && s.spin == 0.0;
  const int event =
      ode.advance(s.time(), {[&](double /*t*/, const State &y) { return stops ? y[1] - s.r1 * y[2] : 1.0; }});
  EXPECT_TRUE(event == -1 || stops);
  post::SphereEnd end; // from the end of sliding on the sphere rolls freely
  end.x = ode.state()[0], end.vx = ode.state()[1], end.spin = ode.state()[2];
  return end;
}

TEST(BenchmarkRolling, ClosedFormsAreThoseOfTheEquations) {
  SphereSetup s = linear();
  s.mu = 0.4, s.g = 9.81, s.steps = 1000;
  const auto none = [](const State & /*y*/) { return 0.0; };
  const double weight = s.m1 * s.g;

  SphereSetup slip = s;
  slip.vt = 1.0;
  for (const double until : {0.03, 0.2}) {
    slip.timestep = until / slip.steps;
    post::SphereEnd end = rolling(
        slip, [&](const State & /*y*/) { return -slip.mu * weight; }, none);
    EXPECT_LT(worst("slip", slip, end), 1e-3) << until;
    end.vx *= 1.0001;
    EXPECT_GT(worst("slip", slip, end), 1.0) << until;
  }

  SphereSetup spins = s;
  spins.mu_r = 0.05, spins.spin = 500.0, spins.timestep = 1e-4;
  post::SphereEnd end =
      rolling(spins, none, [&](const State & /*y*/) { return -spins.mu_r * spins.r1 * weight; });
  EXPECT_LT(worst("rolling_decay", spins, end), 1e-3);
  end.spin *= 1.001;
  EXPECT_GT(worst("rolling_decay", spins, end), 1.0);

  SphereSetup slope = s;
  slope.mu_r = 0.05, slope.slope = 10.0, slope.timestep = 1e-4;
  const double normal = weight * std::cos(10.0 * M_PI / 180.0),
               along = weight * std::sin(10.0 * M_PI / 180.0);
  const double resists = slope.mu_r * slope.r1 * normal; // rolling: the force that makes r w' = v'
  const double holds = (-0.4 * along - resists / slope.r1) / 1.4;
  end = rolling(
      slope, [&](const State & /*y*/) { return holds; }, [&](const State & /*y*/) { return -resists; });
  EXPECT_NEAR(end.vx, slope.r1 * end.spin, 1e-9);
  EXPECT_LT(worst("incline", slope, end), 1e-3);
  slope.mu_r = 0.06;
  EXPECT_GT(worst("incline", slope, end), 1.0);
}

TEST(BenchmarkPeak, IsThatOfTheEquations) {
  SphereSetup s = hertz();
  const double k = stiffness(s);
  Ode ode(
      [&](double /*t*/, const State &y, State &dydt) {
        dydt = {y[1], -k * std::pow(std::max(y[0], 0.0), 1.5) / s.m1};
      },
      0.0, {0.0, s.vn}, {1e-4, s.vn});
  ASSERT_EQ(ode.advance(1.0, {[](double /*t*/, const State &y) { return y[1]; }}), 0);
  post::SphereEnd end;
  end.peak_overlap = ode.state()[0], end.peak_force = k * std::pow(end.peak_overlap, 1.5), end.vz = s.vn;
  EXPECT_LT(worst("chung_ooi_2", s, end), 1e-3);
  end.peak_force *= 1.0001;
  EXPECT_GT(worst("chung_ooi_2", s, end), 1.0);
}

// Spheres that touch at the origin exchange forces there: the closed form of sliding keeps momentum and
// angular momentum.
TEST(BenchmarkMomentum, IsKeptAndChangesAreSeen) {
  SphereSetup s = linear(2);
  s.k = 1e30, s.e = 0.5, s.vt = 4.5, s.spin = 30.0, s.spin_ratio = 0.5; // hardly any overlap
  ASSERT_TRUE(post::slides_throughout(s));
  const post::AfterImpact after = post::sliding_impact(s);
  post::SphereEnd end;
  end.z = end.z_start = s.r1, end.z2 = end.z2_start = -s.r2;
  end.vx = after.vx, end.vz = after.vz, end.spin = after.spin;
  end.vx2 = after.vx2, end.vz2 = after.vz2, end.spin2 = after.spin2;
  EXPECT_LT(worst("oblique_pair", s, end), 0.1);
  for (double post::SphereEnd::*part :
       {&post::SphereEnd::vx2, &post::SphereEnd::vz2, &post::SphereEnd::spin2}) {
    post::SphereEnd other = end;
    other.*part *= 1.0 + 1e-6;
    EXPECT_GT(worst("oblique_pair", s, other), 1.0);
  }
}

// Of a pair of spheres that rebounds faster than it approached.
TEST(BenchmarkEnergy, ThatAnImpactGainsIsSeen) {
  SphereSetup s = linear(2);
  s.e = 1.00001;
  post::SphereEnd end;
  end.z = end.z_start = s.r1, end.z2 = end.z2_start = -s.r2;
  end.vz = s.e * s.vn, end.vz2 = -s.e * s.vn;
  EXPECT_GT(worst("restitution", s, end), 1.0);
}

TEST(BenchmarkStack, KeepsItsEnergyAndComesToRest) {
  SphereSetup s = linear(2);
  s.k = 1e3, s.g = 9.81, s.ceiling = 0.038;
  const auto force = [&](double d) { return s.k * std::max(0.0, d); };
  for (const double drag : {0.0, 1.0}) {
    if (drag > 0.0) s.ceiling = 1.0;
    post::SphereEnd end;
    end.z_start = 0.0095, end.z2_start = 0.0285;
    Ode ode(
        [&](double /*t*/, const State &y, State &dydt) {
          const double below = force(s.r1 - y[0]), between = force(s.r1 + s.r2 - (y[1] - y[0]));
          dydt = {y[2], y[3], (below - between - drag * y[2]) / s.m1 - s.g,
                  (between - force(y[1] + s.r2 - s.ceiling) - drag * y[3]) / s.m2 - s.g};
        },
        0.0, {end.z_start, end.z2_start, 0.0, 0.0}, {0.01, 0.01, 0.1, 0.1});
    ode.advance(drag > 0.0 ? 3.0 : 0.03);
    end.z = ode.state()[0], end.z2 = ode.state()[1], end.vz = ode.state()[2], end.vz2 = ode.state()[3];
    EXPECT_LT(worst(drag > 0.0 ? "rest" : "stack", s, end), 0.1);
    end.z *= 1.0001;
    EXPECT_GT(worst(drag > 0.0 ? "rest" : "stack", s, end), 1.0);
  }
}

} // namespace
} // namespace drumlin::test
