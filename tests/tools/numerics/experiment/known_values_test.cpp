#include "tests/support/engine_runs.h"
#include "tests/support/ode.h"
#include "tests/support/sphere_impact.h"
#include "chain/analysis.h"
#include "chain/exact_solution.h"
#include "engine/deck_run.h"
#include "experiment/plan.h"
#include "experiment/quantity.h"
#include "experiment/exact_quantities.h"
#include "runs/parameter_file.h"

namespace drumlin::test {
namespace {

// The known values of the study of benchmarks, inputs/benchmarks/expected.csv, are those of closed forms and
// of the reference solution, and these agree with CVODE, which shares no code with them. DRUMLIN_REWRITE=1
// writes the file anew.
namespace benchmarks {

using oracle::Ode;
using oracle::State;
using post::Expected;

constexpr const char *closed = "closed form";
constexpr const char *reference = "reference solution";
constexpr double degrees = 180.0 / M_PI;

/// The parameters of a run: those given, then those of its case and the case's material, then the deck's.
class Parameters {
public:
  explicit Parameters(const post::Variables &given) {
    for (const auto &[name, value] : given)
      texts_.emplace(name, value);
    read("case." + texts_.at("case"));
  }
  double of(const std::string &name, double otherwise) const {
    const auto found = texts_.find(name);
    return found == texts_.end() ? otherwise : post::number_from_text(found->second);
  }
  bool is_linear() const { return texts_.count("normal") > 0; }

private:
  void read(const std::string &file) {
    std::istringstream lines(post::read_text(post::input_file("benchmarks/" + file)));
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::string keyword, name, style, value;
      words >> keyword >> name >> style >> value;
      if (keyword == "variable") texts_.emplace(name, value);
      if (keyword == "drumlin/variable") texts_.emplace(name, style); // the default
      if (keyword == "include") read("material." + texts_.at("material"));
    }
  }
  std::map<std::string, std::string> texts_;
};

SphereSetup setup_of(const post::Scene &scene) {
  const Parameters p(post::variables_of(scene, post::SceneDeck::run));
  SphereSetup s;
  s.e = p.of("e", 1.0), s.mu = p.of("mu", 0.0), s.mu_r = p.of("mu_r", 0.0), s.spheres = p.of("spheres", 1.0);
  s.r1 = p.of("r1", 0.01), s.r2 = p.of("r2", s.r1);
  const double density = p.of("density", 2800.0);
  const auto mass = [](double r, double of) { return 4.0 / 3.0 * M_PI * r * r * r * of; };
  s.m1 = mass(s.r1, density), s.m2 = mass(s.r2, density * p.of("density2_over_density", 1.0));
  const double speed = p.of("speed", 0.0), angle = p.of("angle", 0.0) / degrees;
  s.vn = p.of("vn", speed * std::cos(angle)), s.vt = p.of("vt", speed * std::sin(angle));
  s.spin = p.of("spin", 0.0), s.velocity_ratio = p.of("velocity_ratio", 0.0);
  s.spin_ratio = p.of("spin_ratio", 0.0);
  s.g = p.of("g", 0.0), s.slope = p.of("slope", 0.0);
  if (p.is_linear()) {
    s.k = p.of("k", 0.0), s.kt = p.of("kt", 2.0 / 7.0 * s.k);
  } else {
    const double E = p.of("E", 0.0), nu = p.of("nu", 0.0), ratio = p.of("E2_over_E", 0.0);
    const double softer = ratio > 0.0 ? 1.0 + 1.0 / ratio : 1.0 + E / 1e30;
    s.E_eff = E / ((1.0 - nu * nu) * softer);
    s.G_eff = E / (2.0 * (2.0 - nu) * (1.0 + nu) * softer);
  }
  const double every = p.of("every", 1.0), step = s.contact_time() / p.of("steps_per_contact", 1000.0);
  s.time = std::ceil(p.of("duration", 3.0 * s.contact_time()) / step / every) * every * step;
  return s;
}

/// Quantities of the motion after an impact.
struct Quantities {
  Quantities(const SphereSetup &s, const AfterImpact &a)
      : vx(a.vx), spin(a.spin), rebound(a.vz - a.vz2),
        slip(a.vx - s.r1 * a.spin - a.vx2 - (s.pair() ? s.r2 * a.spin2 : 0.0)),
        energy(of(s.m1, s.r1, a.vx, a.vz, a.spin) +
               (s.pair() ? of(s.m2, s.r2, a.vx2, a.vz2, a.spin2) : 0.0)) {}
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

using Values = std::vector<Expected>;

/// Force and overlap of Hertz's elastic impact at the peak.
Values peak(const SphereSetup &s) {
  const double d = s.overlap(), force = s.stiffness() * std::pow(d, 1.5);
  return {{"peak_force", force, force, 1e-5, closed}, {"peak_overlap", d, d, 1e-5, closed}};
}

/// Where the surfaces slide all the time: the changes of velocity and spin by friction, over those of spheres
/// whose overlap is negligible.
Values sliding(const SphereSetup &s) {
  if (!slides_throughout(s)) return {};
  const AfterImpact exact = sliding_impact(s);
  const double change = std::fabs(exact.vx - s.vt);
  return {{"vx", exact.vx, change, s.pair() ? 5e-4 : 1e-5, closed},
          {"spin", exact.spin, 2.5 * change / s.r1, 5e-4, closed}};
}

/// An oblique impact, or that of a spinning sphere, by the reference solution.
Values oblique(const SphereSetup &s, const std::string &test) {
  const Quantities was(s, before(s)), should(s, integrated_impact(s));
  const double slip = 3.5 * s.mu * (1.0 + s.e) * s.vn; // what sliding takes away
  const double recoil = (was.slip < 0.0 ? -1.0 : 1.0) * should.slip / should.rebound;
  Values values;
  const auto add = [&](const char *name, double value, double scale) {
    values.push_back({name, value, scale, s.pair() ? 1e-3 : 2e-4, reference});
  };
  if (test == "chung_ooi_4") {
    add("tangential_restitution", should.vx / s.vt, 1.0);
    add("spin", should.spin, 2.5 * s.mu * (1.0 + s.e) * s.vn / s.r1);
    add("rebound_angle", degrees * std::atan(should.slip / should.rebound), degrees);
  } else if (test == "chung_ooi_5") {
    add("recoil_mu", recoil / s.mu, slip / (s.mu * s.e * s.vn));
    add("spin_mu", s.r1 * should.spin / (s.mu * s.vn), 2.5 * (1.0 + s.e));
  } else {
    add("recoil", recoil, slip / (s.e * s.vn));
    add("vx", should.vx, s.mu * (1.0 + s.e) * s.vn);
  }
  add("energy_ratio", should.energy / was.energy, 1.0);
  return values;
}

/// A sphere that slides at first: friction mu m g until it rolls.
Values slip_cessation(const SphereSetup &s) {
  const double until = std::min(s.time, 2.0 * s.vt / (7.0 * s.mu * s.g)), lost = s.mu * s.g * until;
  return {{"vx", s.vt - lost, s.vt, 1e-5, closed}, {"spin", 2.5 * lost / s.r1, s.vt / s.r1, 1e-5, closed}};
}

Values rolling_decay(const SphereSetup &s) {
  return {{"spin", s.spin - 2.5 * s.mu_r * s.g / s.r1 * s.time, s.spin, 1e-5, closed}};
}

/// From rest down a slope: rolls at 5/7 g (sin a - mu_r cos a), or stays.
Values incline(const SphereSetup &s) {
  const double a = s.slope / degrees, free = 5.0 / 7.0 * s.g * std::sin(a);
  const double rate = std::max(0.0, 5.0 / 7.0 * s.g * (std::sin(a) - s.mu_r * std::cos(a)));
  if (rate == 0.0) return {{"way", 0.0, 0.5 * free * s.time * s.time, 1e-5, closed}};
  return {{"vx", rate * s.time, free * s.time, 5e-4, closed},
          {"spin", rate * s.time / s.r1, free * s.time / s.r1, 5e-4, closed}};
}

Values pure_rolling(const SphereSetup &s) {
  return {{"vx", s.vt, s.vt, 1e-5, closed}, {"spin", s.spin, s.vt / s.r1, 1e-5, closed}};
}

/// Two elastic spheres that bounce between a floor and a ceiling: their energy over that at the start is 1.
Values stack(const SphereSetup & /*s*/) { return {{"stack_energy", 1.0, 1.0, 1e-5, closed}}; }

/// Two spheres at rest, one on the other on a floor: overlaps from their weights.
Values rest(const SphereSetup &s) {
  const double below = (s.m1 + s.m2) * s.g / s.k, between = s.m2 * s.g / s.k;
  return {{"floor_overlap", below, below, 1e-8, closed}, {"sphere_overlap", between, between, 1e-8, closed}};
}

/// The known values of a case.
Values known_values(const std::string &test, const SphereSetup &s) {
  const std::map<std::string, Values (*)(const SphereSetup &)> without_impact = {
      {"slip", slip_cessation}, {"rolling_decay", rolling_decay},
      {"incline", incline},     {"pure_rolling", pure_rolling},
      {"stack", stack},         {"rest", rest}};
  if (const auto found = without_impact.find(test); found != without_impact.end()) return found->second(s);
  Values values;
  const auto add = [&values](const Values &more) { values.insert(values.end(), more.begin(), more.end()); };
  const bool head_on = test == "chung_ooi_3" || test == "restitution";
  if (test == "chung_ooi_1" || test == "chung_ooi_2") {
    add(peak(s));
  } else if (test == "chung_ooi_7") { // the surfaces roll on each other
    add({{"spin", s.spin, s.spin, 1e-9, closed}, {"vx", 0.0, s.vn, 1e-9, closed}});
  } else if (!head_on) {
    if (test != "oblique_pair") add(oblique(s, test));
    add(sliding(s));
  }
  const bool turns = s.pair() && s.mu > 0.0 && test != "chung_ooi_7"; // the normal, meanwhile
  add({{"restitution", s.e, 1.0, turns ? 1e-3 : 1e-5, closed}, {"energy_gain", 0.0, 1.0, 1e-6, closed}});
  if (s.pair())
    add({{"momentum_normal", 0.0, 1.0, 1e-11, closed},
         {"momentum_tangential", 0.0, 1.0, 1e-11, closed},
         {"angular_momentum", 0.0, 1.0, 1e-9, closed}});
  return values;
}

TEST(BenchmarkValues, AreThoseOfClosedFormsAndTheReferenceSolution) {
  const post::Plan plan = post::read_plan(post::input_file("study/benchmarks/plan"));
  std::string text = "scene,quantity,value,scale,tolerance,source\n";
  for (const post::Scene &scene : plan.scenes) {
    if (!scene.twin.empty()) continue;
    const Values values = known_values(post::value_of(scene, "case"), setup_of(scene));
    ASSERT_FALSE(values.empty()) << scene.name;
    EXPECT_EQ(values.size(), scene.expected.size()) << scene.name;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Expected &one = values[i];
      text += fmt::format("{},{},{:.12g},{:.6g},{:g},{}\n", scene.name, one.quantity, one.value, one.scale,
                          one.tolerance, one.source);
      if (i >= scene.expected.size()) continue;
      const Expected &file = scene.expected[i];
      EXPECT_EQ(file.quantity + file.source, one.quantity + one.source) << scene.name;
      EXPECT_NEAR(file.value, one.value, 1e-9 * one.scale) << scene.name << ": " << one.quantity;
      EXPECT_NEAR(file.scale, one.scale, 1e-5 * one.scale) << scene.name << ": " << one.quantity;
      EXPECT_DOUBLE_EQ(file.tolerance, one.tolerance) << scene.name << ": " << one.quantity;
    }
  }
  if (std::getenv("DRUMLIN_REWRITE") != nullptr)
    post::write_files({{post::input_file("benchmarks/expected.csv"), text}});
}

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

/// Sphere 1 after an elastic impact on a plane: overlap, rate, velocity, spin, force of the tangential
/// spring; friction slides along +x all the time, or never.
AfterImpact by_cvode(const SphereSetup &s, bool slides) {
  const double k = s.stiffness(), inertia = 0.4 * s.m1 * s.r1 * s.r1;
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

void expect_near(const AfterImpact &a, const AfterImpact &b, const SphereSetup &s, double tolerance) {
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
    ASSERT_TRUE(slides_throughout(s));
    expect_near(sliding_impact(s), by_cvode(s, true), s, 1e-7);
  }
}

TEST(BenchmarkImpact, ReferenceSolutionIsThatOfTheEquations) {
  for (SphereSetup s : {hertz(), linear()}) {
    s.vt = 8.0;
    expect_near(integrated_impact(s), by_cvode(s, true), s, 2e-5);
    s.vt = 0.3, s.mu = 1e9;
    expect_near(integrated_impact(s), by_cvode(s, false), s, 2e-5);
  }
}

TEST(BenchmarkImpact, ReferenceSolutionSlidesAsTheClosedForm) {
  for (const double spheres : {1.0, 2.0})
    for (SphereSetup s : {hertz(spheres), linear(spheres)})
      for (const double e : {1.0, 0.9, 0.5}) {
        s.e = e, s.vt = -9.0 / spheres, s.spin = 30.0, s.spin_ratio = 0.5;
        ASSERT_TRUE(slides_throughout(s));
        expect_near(integrated_impact(s), sliding_impact(s), s,
                    e == 1.0 ? 2e-5 : 2e-3); // the lever arm is that of e = 1
      }
}

double value(const Values &values, const std::string &quantity) {
  for (const Expected &one : values)
    if (one.quantity == quantity) return one.value;
  ADD_FAILURE() << "no " << quantity;
  return NAN;
}

/// Velocity and spin at the end of the rolling of a rigid sphere.
struct Rolled {
  double vx, spin;
};
Rolled rolling(const SphereSetup &s, const std::function<double(const State &)> &force,
               const std::function<double(const State &)> &torque) {
  const double slope = s.slope / degrees;
  Ode ode(
      [&](double /*t*/, const State &y, State &dydt) {
        dydt = {y[1], s.g * std::sin(slope) + force(y) / s.m1,
                (torque(y) - s.r1 * force(y)) / (0.4 * s.m1 * s.r1 * s.r1)};
      },
      0.0, {0.0, s.vt, s.spin}, {1.0, 1.0, 1.0 / s.r1});
  const bool stops = s.vt > 0.0 && s.spin == 0.0; // from the end of sliding on the sphere rolls freely
  const int event =
      ode.advance(s.time, {[&](double /*t*/, const State &y) { return stops ? y[1] - s.r1 * y[2] : 1.0; }});
  EXPECT_TRUE(event == -1 || stops);
  return {ode.state()[1], ode.state()[2]};
}

TEST(BenchmarkRolling, ClosedFormsAreThoseOfTheEquations) {
  SphereSetup s = linear();
  s.mu = 0.4, s.g = 9.81;
  const auto none = [](const State & /*y*/) { return 0.0; };
  const double weight = s.m1 * s.g;

  SphereSetup slip = s;
  slip.vt = 1.0;
  for (const double until : {0.03, 0.2}) {
    slip.time = until;
    const Rolled end = rolling(
        slip, [&](const State & /*y*/) { return -slip.mu * weight; }, none);
    EXPECT_NEAR(value(slip_cessation(slip), "vx"), end.vx, 1e-8) << until;
    EXPECT_NEAR(slip.r1 * value(slip_cessation(slip), "spin"), slip.r1 * end.spin, 1e-8) << until;
  }

  SphereSetup spins = s;
  spins.mu_r = 0.05, spins.spin = 500.0, spins.time = 0.1;
  EXPECT_NEAR(value(rolling_decay(spins), "spin"),
              rolling(spins, none, [&](const State & /*y*/) { return -spins.mu_r * spins.r1 * weight; }).spin,
              1e-5);

  SphereSetup slope = s;
  slope.mu_r = 0.05, slope.slope = 10.0, slope.time = 0.1;
  const double normal = weight * std::cos(slope.slope / degrees),
               along = weight * std::sin(slope.slope / degrees);
  const double resists = slope.mu_r * slope.r1 * normal; // rolling: the force that makes r w' = v'
  const double holds = (-0.4 * along - resists / slope.r1) / 1.4;
  const Rolled end = rolling(
      slope, [&](const State & /*y*/) { return holds; }, [&](const State & /*y*/) { return -resists; });
  EXPECT_NEAR(end.vx, slope.r1 * end.spin, 1e-9);
  EXPECT_NEAR(value(incline(slope), "vx"), end.vx, 1e-9);
  EXPECT_NEAR(slope.r1 * value(incline(slope), "spin"), end.vx, 1e-9);
}

TEST(BenchmarkPeak, IsThatOfTheEquations) {
  const SphereSetup s = hertz();
  const double k = s.stiffness();
  Ode ode(
      [&](double /*t*/, const State &y, State &dydt) {
        dydt = {y[1], -k * std::pow(std::max(y[0], 0.0), 1.5) / s.m1};
      },
      0.0, {0.0, s.vn}, {1e-4, s.vn});
  ASSERT_EQ(ode.advance(1.0, {[](double /*t*/, const State &y) { return y[1]; }}), 0);
  const double d = ode.state()[0], force = k * std::pow(d, 1.5);
  EXPECT_NEAR(value(peak(s), "peak_overlap"), d, 1e-8 * d);
  EXPECT_NEAR(value(peak(s), "peak_force"), force, 1e-8 * force);
}

// Two spheres that fall on each other against a drag, which does not change where they rest.
TEST(BenchmarkRest, IsWhereTheEquationsEnd) {
  SphereSetup s = linear(2);
  s.k = 1e3, s.g = 9.81;
  const auto force = [&](double d) { return s.k * std::max(0.0, d); };
  Ode ode(
      [&](double /*t*/, const State &y, State &dydt) {
        const double below = force(s.r1 - y[0]), between = force(s.r1 + s.r2 - (y[1] - y[0]));
        dydt = {y[2], y[3], (below - between - y[2]) / s.m1 - s.g, (between - y[3]) / s.m2 - s.g};
      },
      0.0, {0.0095, 0.0285, 0.0, 0.0}, {0.01, 0.01, 0.1, 0.1});
  ode.advance(3.0);
  const double below = s.r1 - ode.state()[0], between = s.r1 + s.r2 - (ode.state()[1] - ode.state()[0]);
  EXPECT_NEAR(value(rest(s), "floor_overlap"), below, 1e-6 * below);
  EXPECT_NEAR(value(rest(s), "sphere_overlap"), between, 1e-6 * between);
}

// Where the surfaces slide the published points, read from printed figures, are met as well as they can be.
TEST(BenchmarkPublished, PointsOfSlidingAreThoseOfTheReferenceSolution) {
  const post::Plan plan = post::read_plan(post::input_file("study/benchmarks/plan"));
  std::map<std::string, std::pair<double, int>> largest; // by quantity: difference over the scale, and points
  for (const post::PublishedPoint &point : plan.published) {
    const auto scene = std::find_if(plan.scenes.begin(), plan.scenes.end(), [&](const post::Scene &one) {
      return one.at.count(point.axis) > 0 && one.series == point.series;
    });
    ASSERT_NE(scene, plan.scenes.end()) << point.axis;
    SphereSetup s = setup_of(*scene);
    if (point.axis == "angle") {
      const double speed = std::hypot(s.vn, s.vt);
      s.vn = speed * std::cos(point.at / degrees), s.vt = speed * std::sin(point.at / degrees);
    } else if (point.axis == "slip") {
      s.vt = point.at * s.mu * s.vn;
    } else {
      s.spin = point.at * s.vn / s.r1;
    }
    if (!slides_throughout(s)) continue;
    for (const Expected &one : oblique(s, post::value_of(*scene, "case")))
      if (one.quantity == point.quantity) {
        auto &[difference, points] = largest[point.axis + " " + point.quantity];
        difference = std::max(difference, std::fabs(one.value - point.value) / one.scale);
        ++points;
      }
  }
  EXPECT_EQ(largest.size(), 7U);
  for (const auto &[name, found] : largest) {
    EXPECT_GT(found.second, 2) << name;
    EXPECT_LT(found.first, 0.04) << name;
  }
}

} // namespace benchmarks

// The study of stability: its known values for stock stepping are where a root of the scheme's polynomial
// passes -1 (DRUMLIN_REWRITE=1 writes inputs/study/stability/expected.csv anew); and which step of a run
// counts as the longest stable one.
namespace stability {

/// The largest magnitude of the roots of (z-1)^2 + 2 n D s (z-1) + n s^2 z, the steps of velocity Verlet with
/// the damping force of the half step before, for w0 dt = s and n contacts of damping ratio D.
double growth(double n, double D, double s) {
  const std::complex<double> half = 0.5 * (2.0 - 2.0 * n * D * s - n * s * s);
  const std::complex<double> root = std::sqrt(half * half - (1.0 - 2.0 * n * D * s));
  return std::max(std::abs(half + root), std::abs(half - root));
}

double longest_stable(double n, double D) {
  double low = 1e-9, high = 4.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (growth(n, D, middle) <= 1.0 + 1e-13 ? low : high) = middle;
  }
  return low;
}

TEST(StabilityValues, AreWhereTheSchemeBeginsToGrow) {
  const post::Plan plan = post::read_plan(post::input_file("study/stability/plan"));
  std::string text = "scene,quantity,value,scale,tolerance,source\n";
  int points = 0;
  for (const post::Scene &scene : plan.scenes) {
    const std::string walls = post::value_of(scene, "scene");
    const double n = walls == "one" ? 1.0 : walls == "four" ? 4.0 : 2.0;
    ASSERT_TRUE(scene.expected.size() == 1 || post::value_of(scene, "stepping") == "stock") << scene.name;
    if (post::value_of(scene, "stepping") != "stock") {
      EXPECT_NEAR(scene.expected[0].value, 2.0 / std::sqrt(n), 1e-5) << scene.name;
      continue;
    }
    ++points;
    const double limit = longest_stable(n, post::number_from_text(post::value_of(scene, "D")));
    text += fmt::format("{},stable_step,{:.9g},{:.9g},0.01,limit of springs and dashpots\n", scene.name,
                        limit, limit);
    if (scene.expected.empty()) {
      ADD_FAILURE() << scene.name << ": no known value";
      continue;
    }
    EXPECT_NEAR(scene.expected[0].value, limit, 1e-6 * limit) << scene.name;
    EXPECT_NEAR(scene.expected[0].scale, limit, 1e-6 * limit) << scene.name;
    for (const auto &[bound, part] : {std::pair{"lowest", 0.8}, {"highest", 1.1}})
      EXPECT_NEAR(post::number_from_text(post::value_of(scene, bound)), part * limit, 0.01 * limit)
          << scene.name;
  }
  EXPECT_EQ(points, 6 * 15);
  if (std::getenv("DRUMLIN_REWRITE") != nullptr)
    post::write_files({{post::input_file("study/stability/expected.csv"), text}});
}

/// The longest stable step of three balls with steps 1, 2 and 4, of which the second moves as given: by the
/// step, in two windows of 20.
double found(const std::function<double(int)> &second, double D, int lost_from = 9999) {
  const Scratch scratch;
  std::string looks;
  for (int n = 0; n < 40; ++n) {
    const int step = n < 20 ? n : 1000 + n;
    const bool lost = step >= lost_from;
    looks +=
        fmt::format("ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 "
                    "1\nITEM: ATOMS id x z\n1 1e-7 0\n",
                    step, lost ? 2 : 3);
    if (!lost) looks += fmt::format("2 {:.17g} 0\n", second(step));
    looks += "3 0 1e-3\n"; // too far
  }
  post::write_files({{scratch / "looks.dump", looks},
                     {scratch / "steps.csv", "w0_dt\n1\n2\n4\n"},
                     {scratch / "parameters.csv", fmt::format("name,value\nD,{}\n", D)}});
  return post::stable_step(scratch.path());
}

TEST(StableStep, IsThatOfTheLastBallBeforeTheFirstThatGrows) {
  const auto alternates = [](double growth) {
    return [growth](int step) { return (step % 2 == 0 ? 1e-9 : -1e-9) * std::pow(growth, step); };
  };
  EXPECT_DOUBLE_EQ(found([](int /*step*/) { return 1e-7; }, 0.5), std::sqrt(2.0 * 4.0));
  EXPECT_DOUBLE_EQ(found([](int /*step*/) { return 2e-3; }, 0.5), std::sqrt(1.0 * 2.0));
  EXPECT_DOUBLE_EQ(found([](int /*step*/) { return NAN; }, 0.5), std::sqrt(1.0 * 2.0));
  EXPECT_DOUBLE_EQ(found([](int /*step*/) { return 1e-7; }, 0.5, 1030), std::sqrt(1.0 * 2.0));
  // What changes its sign every step and grows slowly is seen only with damping: without, it would keep its
  // size.
  EXPECT_DOUBLE_EQ(found(alternates(1.0 + 1e-6), 0.5), std::sqrt(1.0 * 2.0));
  EXPECT_DOUBLE_EQ(found(alternates(1.0 + 1e-6), 0.0), std::sqrt(2.0 * 4.0));
  EXPECT_DOUBLE_EQ(found(alternates(1.0), 0.5), std::sqrt(2.0 * 4.0));
  EXPECT_DOUBLE_EQ(found([](int step) { return step < 1025 ? 1e-7 : 1.1e-7; }, 0.5), std::sqrt(2.0 * 4.0));
}

} // namespace stability

// Errors of chains and impacts beside their exact solutions: of runs that are the exact solution with a known
// error.
namespace exact {

using post::Transition;

class ExactQuantities : public ::testing::Test {
protected:
  double value(const std::string &name) const {
    return post::measured({*post::named_quantity(name)}, scratch_.path(), 1.0).front();
  }
  void write(const std::string &file, const std::string &text) const {
    post::write_files({{scratch_ / file, text}});
  }
  Scratch scratch_;
};

TEST_F(ExactQuantities, OfAChainAreTheErrorsThatItWasGiven) {
  post::ChainParameters chain = post::table1_case("II", Transition::B);
  post::ExactOptions options;
  options.cycles = 6;
  options.samples_per_cycle = 40;
  const post::ExactSolution exact = post::solve_chain(chain, options);
  Variables parameters = post::parameter_values(chain);
  parameters = with(parameters, given("cycles 6, samples_per_cycle 40"));
  write("parameters.csv", post::parameters_text(parameters));
  post::ChainHistory run = exact.history;
  std::vector<post::ContactEvent> events = exact.events;
  ASSERT_GT(events.size(), 4U);
  const double rest = (chain.m2 + chain.m3) * chain.g / chain.k;
  for (double &v : run.v_drum)
    v *= 1.01;
  for (double &x : run.x_drum)
    x = 0.98 * (x + rest) - rest;
  events[3].time += 0.002 * chain.period();
  write("chain.csv", post::chain_text(run));
  write("events.csv", post::events_text(events));
  EXPECT_NEAR(value("velocity_error"), 0.01, 1e-9);
  EXPECT_NEAR(value("way_error"), 0.02, 1e-9);
  EXPECT_NEAR(value("event_time_error"), 0.002, 1e-9);
  events.pop_back();
  write("events.csv", post::events_text(events));
  EXPECT_TRUE(std::isnan(value("event_time_error")));
  write("parameters.csv", "name,value\ncycles,6\n");
  EXPECT_THROW(value("velocity_error"), std::runtime_error);
}

// Under A with D = 0 the speed comes back; at D = 2 the drum creeps back and does not leave the soil.
TEST_F(ExactQuantities, OfAnImpactAreTheErrorOfTheReboundOverItsSpeed) {
  const double w0 = std::sqrt(1e8 / 2000), dt = 1e-6, last = 4 * pi / w0;
  const auto run = [&](double D, double v_end) {
    write("parameters.csv",
          fmt::format("name,value\ntransition,A\nm2,2000\nk,1e8\nD,{}\nspeed,0.5\ntimestep,{}\n", D, dt));
    write(
        "chain.csv",
        fmt::format("time,x_drum,v_drum,a_drum,F_contact,F_excitation\n0,0,-0.5,0,0,0\n{},0,{:.17g},0,0,0\n",
                    last, v_end));
    return value("rebound_error");
  };
  EXPECT_NEAR(run(0.0, 0.5), 0.0, 1e-12);
  EXPECT_NEAR(run(0.0, 0.49), 0.02, 1e-12);
  // x'' + 4 w0 x' + w0^2 x = 0 from x = 0, x' = -0.5: the sum of two decays.
  const double a = (2 - std::sqrt(3.0)) * w0, b = (2 + std::sqrt(3.0)) * w0, t = last - 0.5 * dt;
  const double creeps = -0.5 * (b * std::exp(-b * t) - a * std::exp(-a * t)) / (b - a);
  EXPECT_NEAR(run(2.0, creeps), 0.0, 1e-9);
  EXPECT_NEAR(run(2.0, creeps + 0.005), 0.01, 1e-9);
}

TEST_F(ExactQuantities, OfManyImpactsAreTheLargestError) {
  const auto run = [&](int phases) {
    write("parameters.csv", fmt::format("name,value\ntransition,B\nD,0\nspeed,0.5\nphases,{}\n", phases));
    write("rebound.txt",
          "ITEM: TIMESTEP\n9\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 "
          "1\nITEM: ATOMS id vz\n1 0.495\n2 0.5025\n");
    return value("largest_rebound_error");
  };
  EXPECT_NEAR(run(2), 0.01, 1e-12);
  EXPECT_TRUE(std::isnan(run(3))); // one is lost
}

} // namespace exact

} // namespace
} // namespace drumlin::test
