#include "lab/benchmarks/checks.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace drumlin::post {

namespace {

constexpr const char *closed = "closed form";
constexpr const char *reference = "reference solution";
constexpr double degrees = 180.0 / M_PI;

using Checks = std::vector<BenchmarkCheck>;

/// Quantities of the motion after an impact.
struct Quantities {
  Quantities(const SphereSetup &s, const AfterImpact &a)
      : vx(a.vx), spin(a.spin), rebound(a.vz - a.vz2),
        slip(a.vx - s.r1 * a.spin - a.vx2 - (s.spheres > 1.0 ? s.r2 * a.spin2 : 0.0)),
        energy(of(s.m1, s.r1, a.vx, a.vz, a.spin) +
               (s.spheres > 1.0 ? of(s.m2, s.r2, a.vx2, a.vz2, a.spin2) : 0.0)) {}
  static double of(double m, double r, double vx, double vz, double spin) {
    return 0.5 * m * (vx * vx + vz * vz + 0.4 * r * r * spin * spin);
  }
  double vx, spin;
  double rebound; ///< of the surfaces along the normal
  double slip;    ///< and across it
  double energy;
};

AfterImpact before(const SphereSetup &s) {
  return {s.vt, -s.vn, s.spin, s.velocity_ratio * s.vt, -s.velocity_ratio * s.vn, s.spin_ratio * s.spin};
}

AfterImpact measured(const BenchmarkRun &run) {
  const SphereEnd &e = run.end;
  return {e.vx, e.vz, e.spin, e.vx2, e.vz2, e.spin2};
}

double approach(const SphereSetup &s) { return s.vn * (1.0 - s.velocity_ratio); }

void restitution(Checks &checks, const BenchmarkRun &run, double tolerance) {
  const double e = Quantities(run.setup, measured(run)).rebound / approach(run.setup);
  checks.push_back({"restitution (-)", closed, e, run.setup.e, 1.0, tolerance});
}

/// No impact may gain kinetic energy.
void dissipation(Checks &checks, const BenchmarkRun &run) {
  const double energy = Quantities(run.setup, measured(run)).energy,
               was = Quantities(run.setup, before(run.setup)).energy;
  checks.push_back({"gain of kinetic energy over that before (-)", closed, std::max(0.0, energy / was - 1.0),
                    0.0, 1.0, 1e-6});
}

/// Two spheres keep their momentum, and their angular momentum about the origin.
void momentum(Checks &checks, const BenchmarkRun &run) {
  const SphereSetup &s = run.setup;
  const SphereEnd &e = run.end;
  const AfterImpact was = before(s), now = measured(run);
  const auto along = [&](double v, double v2) { return s.m1 * v + s.m2 * v2; };
  const auto turning = [&](double x, double z, double x2, double z2, const AfterImpact &a) {
    return s.m1 * (z * a.vx - x * a.vz + 0.4 * s.r1 * s.r1 * a.spin) +
           s.m2 * (z2 * a.vx2 - x2 * a.vz2 + 0.4 * s.r2 * s.r2 * a.spin2);
  };
  const double scale = s.m1 * std::hypot(s.vn, s.vt);
  checks.push_back({"change of momentum along the normal (-)", closed,
                    (along(now.vz, now.vz2) - along(was.vz, was.vz2)) / scale, 0.0, 1.0, 1e-11});
  checks.push_back({"change of momentum across the normal (-)", closed,
                    (along(now.vx, now.vx2) - along(was.vx, was.vx2)) / scale, 0.0, 1.0, 1e-11});
  checks.push_back(
      {"change of angular momentum (-)", closed,
       (turning(e.x, e.z, e.x2, e.z2, now) - turning(0.0, e.z_start, 0.0, e.z2_start, was)) / (s.r1 * scale),
       0.0, 1.0, 1e-9});
}

/// Force and overlap of Hertz's elastic impact at the peak.
void peak(Checks &checks, const BenchmarkRun &run) {
  const SphereSetup &s = run.setup;
  const bool pair = s.spheres > 1.0;
  const double m = pair ? s.m1 * s.m2 / (s.m1 + s.m2) : s.m1, r = pair ? s.r1 * s.r2 / (s.r1 + s.r2) : s.r1;
  const double k = 4.0 / 3.0 * s.E_eff * std::sqrt(r), v = approach(s);
  const double d = std::pow(1.25 * m * v * v / k, 0.4), force = k * std::pow(d, 1.5);
  checks.push_back({"peak force (kN)", closed, 1e-3 * run.end.peak_force, 1e-3 * force, 1e-3 * force, 1e-5});
  checks.push_back({"peak overlap (um)", closed, 1e6 * run.end.peak_overlap, 1e6 * d, 1e6 * d, 1e-5});
}

/// Where the surfaces slide all the time: the changes of velocity and spin by friction, over those of spheres
/// whose overlap is negligible.
void sliding(Checks &checks, const BenchmarkRun &run) {
  const SphereSetup &s = run.setup;
  if (!slides_throughout(s)) return;
  const AfterImpact exact = sliding_impact(s), now = measured(run);
  const double change = std::fabs(exact.vx - s.vt);
  checks.push_back({"tangential velocity after, sliding (m/s)", closed, now.vx, exact.vx, change,
                    s.spheres > 1.0 ? 5e-4 : 1e-5});
  checks.push_back({"spin after, sliding (rad/s)", closed, now.spin, exact.spin, 2.5 * change / s.r1, 5e-4});
}

/// An oblique impact, or that of a spinning sphere, against the reference solution.
void oblique(Checks &checks, const BenchmarkRun &run) {
  const SphereSetup &s = run.setup;
  const AfterImpact exact = integrated_impact(s);
  const Quantities was(s, before(s)), now(s, measured(run)), should(s, exact);
  const double slip = 3.5 * s.mu * (1.0 + s.e) * s.vn; // what sliding takes away
  const double sign = was.slip < 0.0 ? -1.0 : 1.0;
  const auto add = [&](const char *name, double computed, double expected, double scale) {
    checks.push_back({name, reference, computed, expected, scale, s.spheres > 1.0 ? 1e-3 : 2e-4});
  };
  if (run.test == "chung_ooi_4") {
    add("tangential restitution vx'/vx (-)", now.vx / s.vt, should.vx / s.vt, 1.0);
    add("spin after (rad/s)", now.spin, should.spin, 2.5 * s.mu * (1.0 + s.e) * s.vn / s.r1);
    add("rebound angle of the surface (degrees)", degrees * std::atan(now.slip / now.rebound),
        degrees * std::atan(should.slip / should.rebound), degrees);
  } else if (run.test == "chung_ooi_5") {
    add("recoil slip'/(mu vn') (-)", now.slip / (s.mu * now.rebound), should.slip / (s.mu * should.rebound),
        slip / (s.mu * s.e * s.vn));
    add("spin r w'/(mu vn) (-)", s.r1 * now.spin / (s.mu * s.vn), s.r1 * should.spin / (s.mu * s.vn),
        2.5 * (1.0 + s.e));
  } else {
    add("recoil slip'/vn' (-)", sign * now.slip / now.rebound, sign * should.slip / should.rebound,
        slip / (s.e * s.vn));
    add("tangential velocity after (m/s)", now.vx, should.vx, s.mu * (1.0 + s.e) * s.vn);
  }
  add("kinetic energy after over before (-)", now.energy / was.energy, should.energy / was.energy, 1.0);
}

void unslipped(Checks &checks, const BenchmarkRun &run) {
  const double spin = run.setup.spin;
  checks.push_back({"spin after over before (-)", closed, run.end.spin / spin, 1.0, 1.0, 1e-9});
  checks.push_back({"tangential velocity after (m/s)", closed, run.end.vx, 0.0, run.setup.vn, 1e-9});
}

/// A sphere that slides at first: friction mu m g until it rolls.
void slip_cessation(Checks &checks, const BenchmarkRun &run) {
  const SphereSetup &s = run.setup;
  const double until = std::min(run.setup.time(), 2.0 * s.vt / (7.0 * s.mu * s.g));
  const double lost = s.mu * s.g * until;
  checks.push_back({"velocity (m/s)", closed, run.end.vx, s.vt - lost, s.vt, 1e-5});
  checks.push_back({"spin times radius (m/s)", closed, run.end.spin * s.r1, 2.5 * lost, s.vt, 1e-5});
}

void rolling_decay(Checks &checks, const BenchmarkRun &run) {
  const SphereSetup &s = run.setup;
  checks.push_back(
      {"spin (rad/s)", closed, run.end.spin, s.spin - 2.5 * s.mu_r * s.g / s.r1 * s.time(), s.spin, 1e-5});
}

/// From rest down a slope: rolls at 5/7 g (sin a - mu_r cos a), or stays.
void incline(Checks &checks, const BenchmarkRun &run) {
  const SphereSetup &s = run.setup;
  const double a = s.slope / degrees, t = s.time(), free = 5.0 / 7.0 * s.g * std::sin(a);
  const double rate = std::max(0.0, 5.0 / 7.0 * s.g * (std::sin(a) - s.mu_r * std::cos(a)));
  if (rate == 0.0) {
    checks.push_back({"way, at rest (m)", closed, run.end.x, 0.0, 0.5 * free * t * t, 1e-5});
    return;
  }
  checks.push_back({"velocity (m/s)", closed, run.end.vx, rate * t, free * t, 5e-4});
  checks.push_back({"spin times radius (m/s)", closed, run.end.spin * s.r1, rate * t, free * t, 5e-4});
}

void pure_rolling(Checks &checks, const BenchmarkRun &run) {
  const SphereSetup &s = run.setup;
  checks.push_back({"velocity (m/s)", closed, run.end.vx, s.vt, s.vt, 1e-5});
  checks.push_back({"spin times radius (m/s)", closed, run.end.spin * s.r1, s.spin * s.r1, s.vt, 1e-5});
}

/// Energy of two spheres between floor and ceiling: springs, weight and motion.
void stack(Checks &checks, const BenchmarkRun &run) {
  const SphereSetup &s = run.setup;
  const SphereEnd &e = run.end;
  const auto springs = [&](double z, double z2) {
    double sum = 0.0;
    for (const double d : {s.r1 - z, s.r1 + s.r2 - (z2 - z), z2 + s.r2 - s.ceiling})
      sum += d > 0.0 ? 0.5 * s.k * d * d : 0.0;
    return sum;
  };
  const double start = springs(e.z_start, e.z2_start);
  const double change = springs(e.z, e.z2) - start +
                        s.g * (s.m1 * (e.z - e.z_start) + s.m2 * (e.z2 - e.z2_start)) +
                        0.5 * s.m1 * e.vz * e.vz + 0.5 * s.m2 * e.vz2 * e.vz2;
  checks.push_back({"energy over that of the start (-)", closed, 1.0 + change / start, 1.0, 1.0, 1e-5});
}

/// Two spheres at rest on each other.
void rest(Checks &checks, const BenchmarkRun &run) {
  const SphereSetup &s = run.setup;
  const double below = (s.m1 + s.m2) * s.g / s.k, between = s.m2 * s.g / s.k;
  checks.push_back(
      {"overlap with the floor (um)", closed, 1e6 * (s.r1 - run.end.z), 1e6 * below, 1e6 * below, 1e-8});
  checks.push_back({"overlap of the spheres (um)", closed, 1e6 * (s.r1 + s.r2 - (run.end.z2 - run.end.z)),
                    1e6 * between, 1e6 * between, 1e-8});
}

} // namespace

double BenchmarkCheck::error() const { return std::fabs(computed - expected) / scale; }

std::vector<BenchmarkCheck> benchmark_checks(const BenchmarkRun &run) {
  Checks checks;
  const auto impact = [&](Checks &all, const BenchmarkRun &of) {
    oblique(all, of);
    sliding(all, of);
    restitution(all, of, of.setup.spheres > 1.0 ? 1e-3 : 1e-5);
  };
  const std::map<std::string, void (*)(Checks &, const BenchmarkRun &)> simple = {
      {"slip", slip_cessation}, {"rolling_decay", rolling_decay},
      {"incline", incline},     {"pure_rolling", pure_rolling},
      {"stack", stack},         {"rest", rest}};
  if (const auto found = simple.find(run.test); found != simple.end()) {
    found->second(checks, run);
  } else if (run.test == "chung_ooi_1" || run.test == "chung_ooi_2") {
    peak(checks, run);
    restitution(checks, run, 1e-5);
  } else if (run.test == "chung_ooi_3" || run.test == "restitution") {
    restitution(checks, run, 1e-5);
  } else if (run.test == "chung_ooi_7") {
    unslipped(checks, run);
    restitution(checks, run, 1e-5);
  } else if (run.test == "oblique_pair") {
    sliding(checks, run);
    restitution(checks, run, 1e-3);
  } else {
    impact(checks, run);
  }
  if (simple.count(run.test) > 0) return checks;
  dissipation(checks, run);
  if (run.setup.spheres > 1.0) momentum(checks, run);
  return checks;
}

} // namespace drumlin::post
