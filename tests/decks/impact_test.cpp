// Impacts of spheres, pairs of balls, and the benchmarks.
#include "tests/support/engine_runs.h"
#include "bed/dump_readers.h"
#include "chain/analysis.h"
#include "engine/deck_run.h"
#include "experiment/plan.h"
#include "experiment/results.h"
#include "experiment/scene.h"
#include "runs/parameter_file.h"

namespace drumlin::test {
namespace {

// Impacts: on a ball or a wall, and of a ball that strikes a small bed.

// A single impact without gravity, on the fixed ball of in.impact and on plane and mesh walls, against the
// closed forms.
namespace impacts {

using post::Transition;

struct Impact {
  Transition transition;
  double D;
  double restitution; // REFERENCE.md; 0: no rebound
};

void PrintTo(const Impact &value, std::ostream *out) {
  *out << post::transition_name(value.transition) << ", D = " << value.D;
}

std::string impact_name(const ::testing::TestParamInfo<Impact> &info) {
  return post::transition_name(info.param.transition) + std::to_string(std::lround(10 * info.param.D));
}

post::ImpactParameters parameters_of(const Impact &impact) {
  post::ImpactParameters p;
  p.transition = impact.transition;
  p.damping_ratio = impact.D;
  p.speed = 0.5;
  return p; // the deck's mass and stiffness
}

struct Measured {
  double error;          // of the overlap while in contact, relative to the largest
  double velocity_error; // the same of the velocity, before the break
  double restitution;
  std::vector<post::ContactEvent> events;
};

/// in.impact at a number of steps per undamped contact, with the ball starting so many steps away.
Measured run_impact(const Impact &impact, int steps, double onset, const std::string &stepping = "stock") {
  const post::ImpactParameters p = parameters_of(impact);
  const Scratch scratch;
  well(run_deck(
      chain_deck("in.impact"),
      given("transition {}, D {}, stepping {}, steps_per_contact {}, onset {}, contacts 4, samples 100",
            post::transition_name(impact.transition), impact.D, stepping, steps, onset),
      scratch.path()));
  const ChainRun run = read_run(scratch.path());
  const double dt = pi / (std::sqrt(p.stiffness / p.mass) * steps);
  const double end = post::impact_duration(p);
  std::vector<double> x, v, exact_x, exact_v;
  for (std::size_t n = 0; n < run.history.size(); ++n) {
    const double since = run.history.time[n] - onset * dt;
    if (since < 0 || since > end - 2 * dt) continue;
    const post::ImpactState exact = post::impact_state(p, since);
    x.push_back(run.history.x_drum[n]);
    v.push_back(run.history.v_drum[n]);
    exact_x.push_back(-exact.overlap);
    exact_v.push_back(-exact.rate);
  }
  return {relative_difference(x, exact_x), relative_difference(v, exact_v),
          run.history.v_drum.back() / p.speed, run.events};
}

class SingleImpact : public ::testing::TestWithParam<Impact> {};

TEST_P(SingleImpact, FollowsTheClosedFormInFirstOrder) {
  const post::ImpactParameters p = parameters_of(GetParam());
  const double end = post::impact_duration(p);
  std::vector<double> steps, errors, velocity_errors, restitution_errors;
  for (const int n : {200, 400, 800, 1600, 3200}) {
    const Measured measured = run_impact(GetParam(), n, 0);
    steps.push_back(n);
    errors.push_back(measured.error);
    velocity_errors.push_back(measured.velocity_error);
    restitution_errors.push_back(std::fabs(measured.restitution - GetParam().restitution));
  }
  EXPECT_NEAR(fitted_order(steps, errors), -1, 0.1);
  EXPECT_NEAR(fitted_order(steps, velocity_errors), -1, 0.1);
  EXPECT_LT(errors.back(), 2e-3);
  RecordProperty("order", number(fitted_order(steps, errors)));
  RecordProperty("restitution_errors",
                 number(restitution_errors.front()) + ", " + number(restitution_errors.back()));
  if (std::isinf(end)) return;
  EXPECT_LT(restitution_errors.back(), 2e-3);
  EXPECT_LT(restitution_errors.back(), 0.25 * restitution_errors.front());
}

TEST_P(SingleImpact, MakeAndBreakAreLocatedWithinTheStep) {
  const post::ImpactParameters p = parameters_of(GetParam());
  const double end = post::impact_duration(p);
  constexpr int steps = 2000;
  constexpr double onset = 10.37; // the drum arrives within a step, in free flight: known to rounding
  const double dt = pi / (std::sqrt(p.stiffness / p.mass) * steps);
  const std::vector<post::ContactEvent> events = run_impact(GetParam(), steps, onset).events;
  ASSERT_EQ(events.size(), std::isinf(end) ? 1u : 2u);
  EXPECT_TRUE(events[0].make);
  EXPECT_NEAR(events[0].time, onset * dt, 0.01 * dt);
  const double c = 2 * p.damping_ratio * std::sqrt(p.mass * p.stiffness);
  EXPECT_NEAR(events[0].force, c * p.speed, 0.01 * c * p.speed);
  if (std::isinf(end)) return;
  const post::ImpactState last = post::impact_state(p, end);
  EXPECT_FALSE(events[1].make);
  EXPECT_NEAR(events[1].time, end + onset * dt, 3 * dt);
  EXPECT_NEAR(events[1].overlap_rate, last.rate, 3e-3 * p.speed);
  const double deepest = p.speed / std::sqrt(p.stiffness / p.mass);
  EXPECT_NEAR(events[1].overlap, last.overlap, 3e-3 * deepest);
  EXPECT_NEAR(events[1].force, GetParam().transition == Transition::A ? c * last.rate : 0,
              3e-3 * c * p.speed);
}

const Impact impacts[] = {{Transition::A, 0.2, 0.526621}, {Transition::A, 0.5, 0.163034},
                          {Transition::A, 0.8, 0.015165}, {Transition::A, 2.0, 0},
                          {Transition::B, 0.2, 0.571740}, {Transition::B, 0.5, 0.298436},
                          {Transition::B, 0.8, 0.179783}, {Transition::B, 2.0, 0.047769}};
INSTANTIATE_TEST_SUITE_P(Reference, SingleImpact, ::testing::ValuesIn(impacts), impact_name);

// In a central impact a fixed ball, a primitive plane and a mesh give the same force at the same overlap and
// rate.
class Obstacles : public ::testing::TestWithParam<Impact> {};

TEST_P(Obstacles, BallPlaneAndMeshAreOne) {
  for (const char *stepping : {"second", "stock"}) {
    // The part of a step in contact is a ratio of small numbers: it takes rounding to the force of that step.
    const double tolerance = std::string(stepping) == "second" ? 1e-9 : 1e-12;
    const auto run = [stepping](const char *obstacle) {
      const Impact &impact = GetParam();
      return run_balls(given("obstacle {}, stepping {}, transition {}, dashpot {}, velocity2 0 0 -0.5, gap "
                             "0.0001, dt 1e-5, steps 3000",
                             obstacle, stepping, post::transition_name(impact.transition), impact.D));
    };
    const BallsRun ball = run("ball");
    const BallsRun plane = run("plane");
    const BallsRun mesh = run("mesh");
    ASSERT_EQ(ball.frames.size(), 3001u);
    const auto overlap = [](const BallsRun &r, long id) {
      std::vector<double> values = r.series(id, &Ball::x, 2);
      for (double &value : values)
        value = 0.75 - value;
      return values;
    };
    const std::vector<double> force = ball.series(2, &Ball::f, 2);
    EXPECT_GT(*std::max_element(force.begin(), force.end()), 1e5);
    for (const BallsRun *wall : {&plane, &mesh}) {
      EXPECT_LT(relative_difference(wall->series(1, &Ball::v, 2), ball.series(2, &Ball::v, 2)), 1e-12);
      EXPECT_LT(relative_difference(wall->series(1, &Ball::f, 2), force), tolerance);
      EXPECT_LT(relative_difference(overlap(*wall, 1), overlap(ball, 2)), 1e-12);
    }
  }
}

// Into a corner along its bisector: two contacts are made in one step, each as if it were the only one.
TEST_P(Obstacles, CornerIsAPlaneInEachDirection) {
  const auto run = [](const char *obstacle, const char *velocity) {
    return run_balls(given("obstacle {}, stepping second, transition {}, dashpot {}, velocity2 {}, gap "
                           "0.0001, dt 1e-5, steps 3000",
                           obstacle, post::transition_name(GetParam().transition), GetParam().D, velocity));
  };
  const BallsRun plane = run("plane", "0 0 -0.5");
  const BallsRun corner = run("corner", "-0.5 0 -0.5");
  for (const std::size_t axis : {std::size_t{0}, std::size_t{2}})
    EXPECT_LT(relative_difference(corner.series(1, &Ball::v, axis), plane.series(1, &Ball::v, 2)), 1e-11);
}

// Second-order stepping: over the phase of the onset, the rebound errs little and with the square of the
// step.
struct Bound {
  Impact impact;
  double at_100, at_400;
};

void PrintTo(const Bound &value, std::ostream *out) { PrintTo(value.impact, out); }

class SecondOrderImpact : public ::testing::TestWithParam<Bound> {};

TEST_P(SecondOrderImpact, ReboundsAsTheClosedForm) {
  const Bound &bound = GetParam();
  const double exact =
      -post::impact_state(parameters_of(bound.impact), post::impact_duration(parameters_of(bound.impact)))
           .rate /
      parameters_of(bound.impact).speed;
  const auto worst = [&](int steps) {
    double largest = 0;
    for (int n = 0; n < 10; ++n)
      largest = std::max(
          largest, std::fabs(run_impact(bound.impact, steps, (n + 0.5) / 10, "second").restitution - exact));
    return largest;
  };
  const double at_100 = worst(100), at_400 = worst(400);
  RecordProperty("errors", number(at_100) + ", " + number(at_400));
  EXPECT_LT(at_100, bound.at_100);
  EXPECT_LT(at_400, bound.at_400);
  EXPECT_GT(std::log(at_100 / at_400) / std::log(4), 1.8);
}

const Bound bounds[] = {{{Transition::A, 0.2, 0}, 3e-4, 2e-5},
                        {{Transition::B, 0.2, 0}, 3e-4, 2e-5},
                        {{Transition::B, 0.5, 0}, 1.5e-4, 1e-5},
                        {{Transition::B, 2.0, 0}, 3e-5, 2e-6}};
INSTANTIATE_TEST_SUITE_P(Restitution, SecondOrderImpact, ::testing::ValuesIn(bounds), [](const auto &row) {
  return post::transition_name(row.param.impact.transition) +
         std::to_string(std::lround(10 * row.param.impact.D));
});

INSTANTIATE_TEST_SUITE_P(Reference, Obstacles, ::testing::ValuesIn(impacts), impact_name);

// A ball sinks into eight contacts one after another. Alone none of their dashpots is heavy (dt c/m = 0.4);
// together they are, and solved for one by one they would throw the ball back. All are pressed to the end, so
// that no condition of a transition acts: m a = m g - sum of k d + c d', which is integrated with a far
// smaller step as reference solution.
TEST(ManyContacts, MadeOneByOneBecomeHeavilyDampedTogether) {
  constexpr double m = 2000, k = 1e6, c = 8e5, dt = 1e-3, g = 9.81, r = 0.75, gap = 1e-6, below = 5e-4;
  constexpr int contacts = 8, steps = 4000, parts = 100;
  const auto acceleration = [&](double z, double v) {
    double force = 0;
    for (int n = 0; n < contacts; ++n)
      if (const double overlap = r - below * n - z; overlap > 0) force += k * overlap - c * v;
    return force / m - g;
  };
  std::vector<double> exact;
  double z = r + gap, v = 0;
  for (int step = 0; step <= steps; ++step) {
    exact.push_back(z);
    for (int part = 0; part < parts; ++part) { // the midpoint's rule
      const double h = dt / parts, v_half = v + 0.5 * h * acceleration(z, v);
      const double a = acceleration(z + 0.5 * h * v, v_half);
      z += h * v_half;
      v += h * a;
    }
  }
  EXPECT_NEAR(z, r - below * (contacts - 1) / 2 - m * g / (contacts * k), 1e-4);

  for (const auto &[obstacle, id] : {std::pair{"stack", contacts + 1L}, {"planes", 1L}}) {
    const BallsRun run = run_balls(given("obstacle {}, stepping second, damping coefficient, property "
                                         "gamman_abs, dashpot {}, k {}, m2 {}, g {}, gap {}, dt {}, steps {}",
                                         obstacle, c, k, m, g, gap, dt, steps));
    const std::vector<double> found = run.series(id, &Ball::x, 2);
    ASSERT_EQ(found.size(), exact.size());
    for (std::size_t step = 1; step < exact.size(); ++step) {
      ASSERT_NEAR(found[step], exact[step], 0.01 * below) << obstacle << ", step " << step;
      const double sinks = found[step - 1] - found[step], should = exact[step - 1] - exact[step];
      ASSERT_NEAR(sinks, should, 0.5 * should) << obstacle << ", step " << step;
    }
  }
}

} // namespace impacts

// inputs/benchmarks/in.penetration: a ball that strikes a small bed and stops in it, under both laws in both
// engines; what its result.csv says follows from the motion that it records.
namespace penetration {

class Penetration : public ::testing::TestWithParam<std::tuple<const char *, const char *>> {};

TEST_P(Penetration, EndsWithWhatItsMotionGives) {
  const auto &[engine, law] = GetParam();
  const bool lammps = std::string(engine) == "lammps";
  SKIP_WITHOUT_LAMMPS(lammps);
  const Scratch scratch;
  const std::string deck = std::string("inputs/benchmarks/in.penetration") + (lammps ? ".lammps" : "");
  well(run_deck(std::filesystem::path(DRUMLIN_SOURCE_DIR) / deck,
                given("law {}, sample 1e-4, rows 2000, columns 5, layers 8, speed 1, out out", law),
                scratch.path()));
  const post::Table motion = post::read_table(scratch / "out/penetration.csv");
  const std::vector<double> t = motion.numbers("time_s"), y = motion.numbers("y_m"),
                            v = motion.numbers("vy_m_per_s"), depth = motion.numbers("depth_m");
  std::map<std::string, double> p;
  for (const auto &[name, text] : post::read_parameters(scratch / "out/parameters.csv"))
    if (const auto value = post::any_number_from_text(text)) p[name] = *value;

  // Its first sample is one of free flight, and at its last it is at rest.
  EXPECT_EQ(v[0], -p["speed"]);
  EXPECT_NEAR(y[1], y[0] - p["speed"] * t[1] - p["g"] / 2 * t[1] * t[1], 1e-12);
  EXPECT_LT(std::fabs(v.back()), 0.01 * p["speed"]);
  EXPECT_DOUBLE_EQ(depth.back(), p["surface"] + p["ball_radius"] - y.back());
  EXPECT_GT(p["solid_fraction"], 0.5);
  EXPECT_LT(p["solid_fraction"], 0.66);

  const double gap = y[0] - p["ball_radius"] - p["surface"];
  const double way = p["speed"] * p["speed"] / (2 * p["g"]) + gap + depth.back();
  const double ratio = p["ball_density"] / (p["solid_fraction"] * p["density"]);
  const double diameter = 2 * p["ball_radius"];
  const double C = depth.back() / (std::sqrt(ratio) * std::cbrt(diameter * diameter * way));
  const double time = t.back() - gap / p["speed"];
  const post::Table result = post::read_table(scratch / "out/result.csv");
  EXPECT_NEAR(result.numbers("C")[0], C, 1e-9 * C);
  EXPECT_NEAR(result.numbers("stopping_time_over_depth_and_speed")[0], time * p["speed"] / depth.back(),
              1e-9 * time * p["speed"] / depth.back());
  EXPECT_DOUBLE_EQ(result.numbers("depth_m")[0], depth.back());
  // Of this small bed; that of the study, far from its floor, has 0.2 to 0.3.
  EXPECT_GT(C, 0.1);
  EXPECT_LT(C, 0.3);
}

INSTANTIATE_TEST_SUITE_P(Laws, Penetration,
                         ::testing::Combine(::testing::Values("liggghts", "lammps"),
                                            ::testing::Values("transition", "own")),
                         [](const auto &test) {
                           return std::string(std::get<0>(test.param)) + "_" + std::get<1>(test.param);
                         });

} // namespace penetration

// Two balls: momentum, the effective mass, mirror images, the two ways to give damping, and the bond.

/// Under A and under B.
class EitherTransition : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Law, EitherTransition, ::testing::Values("A", "B"),
                         [](const auto &test) { return test.param; });

/// Largest departure of the total momentum from its start, over the sum of the balls' largest momenta.
double momentum_drift(const BallsRun &run, double m1, double m2) {
  const std::vector<double> v1 = run.series(1, &Ball::v, 2);
  const std::vector<double> v2 = run.series(2, &Ball::v, 2);
  double drift = 0, scale = 0;
  for (std::size_t n = 0; n < v1.size(); ++n) {
    drift = std::max(drift, std::fabs(m1 * (v1[n] - v1[0]) + m2 * (v2[n] - v2[0])));
    scale = std::max(scale, m1 * std::fabs(v1[n]) + m2 * std::fabs(v2[n]));
  }
  return drift / scale;
}

TEST_P(EitherTransition, FreePairKeepsItsMomentumAndReboundsWithItsEffectiveMass) {
  constexpr double m1 = 500, m2 = 3000, k = 1e8;
  post::ImpactParameters p;
  p.transition = post::transition_from_name(GetParam());
  p.mass = m1 * m2 / (m1 + m2);
  p.speed = 0.9;
  const auto restitution_error = [&](double D, int steps) {
    p.damping_ratio = D;
    const BallsRun run =
        run_balls(given("fixed 3, transition {}, dashpot {}, m1 {}, m2 {}, velocity1 0 0 0.6, velocity2 0 0 "
                        "-0.3, dt {}, steps {}",
                        GetParam(), D, m1, m2, pi / std::sqrt(k / p.mass) / steps, 3 * steps));
    EXPECT_LT(momentum_drift(run, m1, m2), 1e-14);
    const auto &end = run.frames.back().balls;
    const double e = (end.at(2).v[2] - end.at(1).v[2]) / p.speed;
    return std::fabs(e + post::impact_state(p, post::impact_duration(p)).rate / p.speed);
  };
  for (const double D : {0.2, 0.5}) {
    const double coarse = restitution_error(D, 250), fine = restitution_error(D, 2000);
    RecordProperty("restitution_error_" + number(D), number(coarse) + ", " + number(fine));
    EXPECT_LT(fine, 1e-3);
    EXPECT_LT(fine, 0.25 * coarse);
  }
}

// A drum driven onto a fixed ball, and seen in a mirror: a ball driven onto a fixed drum. Each sign of the
// law, of the effective mass with a fixed partner on either side, and of the exciter has its mirror image.
TEST_P(EitherTransition, DrumOnFixedBallMirrorsBallOnFixedDrum) {
  const auto run = [&](int fixed) {
    const double up = fixed == 1 ? 1 : -1;
    return run_balls({{"fixed", std::to_string(fixed)},
                      {"driven", std::to_string(3 - fixed)},
                      {"transition", GetParam()},
                      {"r1", "0.5"},
                      {"r2", "0.5"},
                      {fixed == 1 ? "m2" : "m1", "1500"},
                      {fixed == 1 ? "m1" : "m2", "700"},
                      {fixed == 1 ? "velocity2" : "velocity1", vector_text(0, 0, -0.4 * up)},
                      {"excitation", "amplitude 1e4 omega 5 phase 1.4 direction 0 0 " + number(-up)},
                      {"dt", "1e-5"},
                      {"steps", "6000"}});
  };
  const BallsRun drum = run(1);
  const BallsRun ball = run(2);
  EXPECT_GT(drum.events.size(), 2u);
  ASSERT_EQ(drum.events.size(), ball.events.size());
  for (std::size_t i = 0; i < drum.events.size(); ++i) {
    EXPECT_EQ(drum.events[i].make, ball.events[i].make);
    EXPECT_NEAR(drum.events[i].time, ball.events[i].time, 1e-12);
  }
  for (const auto part : {&Ball::x, &Ball::v, &Ball::f}) {
    std::vector<double> image = ball.series(1, part, 2);
    for (double &value : image)
      value = -value;
    EXPECT_LT(relative_difference(image, drum.series(2, part, 2)), 1e-12);
  }
}

TEST_P(EitherTransition, RatioAndCoefficientAreOneDamping) {
  constexpr double m1 = 500, m2 = 3000, k = 1e8, D = 0.35;
  struct Scene {
    const char *obstacle, *fixed;
    double mass; // effective mass of the contact
  };
  for (const Scene &scene : {Scene{"ball", "3", m1 * m2 / (m1 + m2)}, Scene{"ball", "1", m2},
                             Scene{"ball", "2", m1}, Scene{"plane", "3", m2}, Scene{"mesh", "3", m2}}) {
    const auto run = [&](const char *damping, const char *property, double value) {
      return run_balls(given("obstacle {}, fixed {}, transition {}, damping {}, property {}, dashpot {}, m1 "
                             "{}, m2 {}, velocity1 0 0 0.6, velocity2 0 0 -0.3, dt 1e-5, steps 1500",
                             scene.obstacle, scene.fixed, GetParam(), damping, property, value, m1, m2));
    };
    const BallsRun ratio = run("ratio", "dampingRatio", D);
    const BallsRun coefficient = run("coefficient", "gamman_abs", 2 * D * std::sqrt(scene.mass * k));
    for (const auto &[id, ball] : ratio.frames.front().balls) {
      EXPECT_LT(relative_difference(coefficient.series(id, &Ball::v, 2), ratio.series(id, &Ball::v, 2)),
                1e-14)
          << scene.obstacle << ", fixed " << scene.fixed << ", ball " << id;
    }
    double change = 0;
    for (const auto &[id, ball] : ratio.frames.front().balls)
      change += std::fabs(ratio.frames.back().balls.at(id).v[2] - ball.v[2]);
    EXPECT_GT(change, 0.1) << "no contact";
  }
}

// The bond: a damped oscillator.

constexpr double bond_k = 1e6, bond_c = 8e3, stretch = 0.01;

BallsRun run_bond(const std::string &fixed, double m1, double m2, const std::string &more, double dt,
                  int steps) {
  return run_balls(given("fixed {}, gap 0.5, m1 {}, m2 {}, k23 {}, bond {}, dt {}, steps {}", fixed, m1, m2,
                         bond_k, number(bond_c) + " length " + number(0.5 + 0.75 + 0.5 - stretch) + more, dt,
                         steps));
}

/// Stretch at time t of a mass released at rest.
double released(double mass, double t) {
  const std::complex<double> half = bond_c / (2 * mass);
  const std::complex<double> root = std::sqrt(half * half - bond_k / mass);
  const std::complex<double> s1 = -half + root, s2 = -half - root;
  return (stretch * (s1 * std::exp(s2 * t) - s2 * std::exp(s1 * t)) / (s1 - s2)).real();
}

TEST(Bond, FollowsTheDampedOscillatorInFirstOrder) {
  constexpr double m1 = 600, m2 = 1000, time = 0.5;
  for (const std::string fixed : {"1", "2", "3"}) {
    const double mass = fixed == "1" ? m2 : fixed == "2" ? m1 : m1 * m2 / (m1 + m2);
    std::vector<double> all_steps, errors;
    for (const int steps : {500, 1000, 2000, 4000}) {
      const BallsRun run = run_bond(fixed, m1, m2, "", time / steps, steps);
      const std::vector<double> x1 = run.series(1, &Ball::x, 2), x2 = run.series(2, &Ball::x, 2);
      std::vector<double> found, exact;
      for (std::size_t n = 0; n < x1.size(); ++n) {
        found.push_back((x2[n] - x1[n]) - (x2[0] - x1[0]) + stretch);
        exact.push_back(released(mass, time / steps * static_cast<double>(n)));
      }
      all_steps.push_back(steps);
      errors.push_back(relative_difference(found, exact));
      if (fixed == "3") {
        EXPECT_LT(momentum_drift(run, m1, m2), 1e-14);
      }
    }
    RecordProperty("order_fixed_" + fixed, number(fitted_order(all_steps, errors)));
    EXPECT_NEAR(fitted_order(all_steps, errors), -1, 0.1) << "fixed: " << fixed;
    EXPECT_LT(errors.back(), 2e-3);
  }
}

class EnergyOfABond : public BothEngines {
protected:
  static constexpr double k = 1e4, m_eff = 1, e0 = 0.01, length = 0.19, volume = 0.4 * 0.3 * 0.6;

  struct Row {
    double t, e, energy, force, potential, kinetic, pressure;
  };
  static std::vector<Row> rows_of(const Variables &variables) {
    const Scratch folder;
    well(run("bond", folder, variables));
    std::ifstream in(folder / "energies.txt");
    std::vector<Row> rows;
    for (Row r{}; in >> r.t >> r.e >> r.energy >> r.force >> r.potential >> r.kinetic >> r.pressure;)
      rows.push_back(r);
    return rows;
  }
  /// The contribution of the tension to the pressure across x: the sum of x f over both balls, over the
  /// volume, Pa.
  static double pressure(double force, double e) { return -force * (length + e) / volume; }
};

// e(t) = e0 cos(w t), w^2 = k / m_eff; the rest of the energy is kinetic.
TEST_P(EnergyOfABond, IsItsScalarAndWithFixModifyPartOfThePotentialEnergy) {
  constexpr double most = 0.5 * k * e0 * e0;
  const std::vector<Row> rows = rows_of({});
  EXPECT_GE(rows.size(), 40u);
  for (const Row &row : rows) {
    const double e = e0 * std::cos(std::sqrt(k / m_eff) * row.t);
    EXPECT_NEAR(row.e, e, 1e-4 * e0) << row.t;
    EXPECT_NEAR(row.force, k * e, 1e-4 * k * e0) << row.t;
    EXPECT_NEAR(row.energy, 0.5 * k * e * e, 1e-4 * most) << row.t;
    EXPECT_NEAR(row.potential, row.energy, 1e-5 * most) << row.t;
    EXPECT_NEAR(row.potential + row.kinetic, most, 1e-4 * most) << row.t;
  }
}

// With a dashpot so heavy that under second-order stepping its force is known last, too: then it stops the
// balls within some steps.
TEST_P(EnergyOfABond, ItsTensionCountsInThePressure) {
  for (const auto &[c, least] : {std::pair{"0", 40u}, {"1e5", 4u}}) {
    const bool stiff = std::string(c) != "0";
    if (stiff && std::get<1>(GetParam()) == "stock") continue; // unstable: dt c / m_eff = 1
    std::size_t pulled = 0;
    for (const Row &row : rows_of(given("c {}, every {}", c, stiff ? "1" : "100"))) {
      const double expected = pressure(row.force, row.e);
      EXPECT_NEAR(row.pressure, expected, 1e-5 * k * e0 * length / volume) << row.t << ", c " << c;
      pulled += std::fabs(row.force) > 0.01 * k * e0 ? 1 : 0;
    }
    EXPECT_GE(pulled, least) << "c " << c;
  }
}

INSTANTIATE_TEST_SUITE_P(Decks, EnergyOfABond, engines_and_steppings(), engine_and_stepping);

TEST(Bond, BreaksOnceAtItsStrengthAndNeverPullsAgain) {
  constexpr double m1 = 600, m2 = 1000, time = 0.5,
                   strength = 8000; // released, it swings back to about -7 kN
  const BallsRun whole =
      run_bond("1", m1, m2, " strength " + number(1.01 * bond_k * stretch), time / 1000, 1000);
  EXPECT_FALSE(contains(whole.output, "broke"));
  EXPECT_NE(whole.frames.back().balls.at(2).f[2], 0);

  // Started at rest below its strength and driven beyond it.
  const BallsRun run =
      run_balls(given("gap 0.5, m2 {}, k23 {}, bond {}, excitation amplitude 3000 omega 31.6 direction 0 0 "
                      "1, dt 5e-4, steps 2000",
                      m2, bond_k, number(bond_c) + " length current strength " + number(strength)));
  const std::string words = "WARNING: fix bond/spring bond: the bond of balls 1 and 2 broke at step ";
  const std::size_t found = run.output.find(words);
  ASSERT_NE(found, std::string::npos) << run.output;
  EXPECT_EQ(run.output.find(words, found + 1), std::string::npos) << "it broke twice";
  const long step = std::stol(run.output.substr(found + words.size()));
  double largest = 0;
  for (const Frame &frame : run.frames) {
    const double push = 3000 * std::sin(31.6 * 5e-4 * static_cast<double>(frame.step));
    const double bond = frame.balls.at(2).f[2] - push;
    if (frame.step >= step)
      ASSERT_NEAR(bond, 0, 1e-9 * strength) << "step " << frame.step;
    else
      largest = std::max(largest, std::fabs(bond));
  }
  EXPECT_LE(largest, strength);
  EXPECT_GT(largest, 0.95 * strength);
}

/// With light damping, solved for contact by contact, and with heavy damping, solved for in a second pass.
TEST(Reaction, OfAFixedBallIsTheForceOnTheOtherBall) {
  constexpr double m2 = 500, g = 9.81;
  for (const char *fix : {"freeze", "setforce 0 0 0"})
    for (const char *dashpot : {"0.2", "5"}) {
      const BallsRun run =
          run_balls(given("stepping second, held {}, dashpot {}, m2 {}, gap 1e-4, g {}, dt 1e-4, steps 2000",
                          fix, dashpot, m2, g));
      ASSERT_EQ(run.reaction.size() + 1, run.frames.size());
      ASSERT_FALSE(run.events.empty());
      const auto made = static_cast<std::size_t>(std::ceil(run.events.front().time / 1e-4));
      double most = 0, miss = 0;
      for (std::size_t n = made + 1; n < run.frames.size(); ++n) {
        const double contact = run.frames[n].balls.at(2).f[2] + m2 * g;
        most = std::max(most, contact);
        miss = std::max(miss, std::fabs(run.reaction[n - 1] + contact));
      }
      EXPECT_GT(most, m2 * g) << fix << ", D = " << dashpot;
      EXPECT_LT(miss, 1e-10 * most) << fix << ", D = " << dashpot;
      EXPECT_NEAR(run.reaction.back(), -m2 * g, 0.01 * m2 * g) << fix << ", D = " << dashpot;
    }
}

// Velocity or law changed between two runs: the force of the set-up is that of the present ones, not that of
// the step before.
TEST(ASetUp, TakesWhatTheDeckHasChangedBetweenTwoRuns) {
  const std::string softer = property("kn", "5e6");
  const struct {
    std::string lines;
    double k, c_of_rate;
  } changes[] = {{"velocity all set 0 0 0 units box", 1e7, 0.0},
                 {"unfix kn\n" + softer, 5e6, std::sqrt(2000 * 5e6)}, // c = 2 D sqrt(m k), D = 0.5
                 {"", 1e7, std::sqrt(2000 * 1e7)}};
  for (const auto &change : changes) {
    const Scratch folder;
    const std::string lines = "run 1500\n" + change.lines +
                              "\ncompute f drum reduce sum fz\nthermo_style custom step c_f\nrun 0\n"
                              "print \"force $(c_f) overlap $(0.75-xcm(drum,z)) rate $(-vcm(drum,z))\"";
    const Outcome run = run_host(host_pair_style() + host_properties(), lines, folder.path(), 1);
    std::smatch found;
    ASSERT_TRUE(std::regex_search(run.output, found,
                                  std::regex("\nforce ([0-9.e+-]+) overlap ([0-9.e+-]+) rate ([0-9.e+-]+)")))
        << run.output;
    const double force = std::stod(found[1]), d = std::stod(found[2]), rate = std::stod(found[3]);
    const double expected = change.k * d + change.c_of_rate * rate - 2000 * 9.81;
    EXPECT_NEAR(force, expected, 1e-6 * 2000 * 9.81) << change.lines;
  }
}

// Published tests of one or two spheres (inputs/benchmarks): the first scene of each family of the study's
// plan in both engines meets its known values; result.csv is what the dump of the spheres gives.

class Benchmarks : public ::testing::TestWithParam<const char *> {};

TEST_P(Benchmarks, MeetTheirKnownValuesInBothEngines) {
  post::Plan plan = post::read_plan(post::input_file("study/benchmarks/plan"));
  std::vector<post::Result> rows;
  std::set<std::string> engines;
  for (const post::Scene &scene : plan.scenes) {
    if (post::value_of(scene, "case") != GetParam() || !engines.insert(scene.twin).second) continue;
    const std::unique_ptr<post::DeckRun> run = post::run_scene(scene, 1, {}, post::Soil::kept);
    const std::vector<double> values = post::measured(plan.quantities, run->file(""), 1.0);
    for (std::size_t i = 0; i < values.size(); ++i)
      rows.push_back({scene.name, 1, plan.quantities[i].name, plan.quantities[i].unit, values[i], 0.0});
    if (engines.size() > 1) break;
  }
  const std::vector<post::Judged> judged = post::judged(plan, post::Results(rows));
  ASSERT_FALSE(judged.empty());
  for (const post::Judged &one : judged)
    EXPECT_TRUE(one.holds) << one.scene->name << ": " << one.expected->quantity << " is " << one.found
                           << ", not " << one.expected->value << "; other engine: " << one.difference;
  SKIP_WITHOUT_LAMMPS(true);
}

INSTANTIATE_TEST_SUITE_P(Cases, Benchmarks,
                         ::testing::Values("chung_ooi_1", "chung_ooi_2", "chung_ooi_3", "chung_ooi_4",
                                           "chung_ooi_5", "chung_ooi_6", "chung_ooi_7", "chung_ooi_8",
                                           "restitution", "oblique_pair", "slip", "rolling_decay", "incline",
                                           "pure_rolling", "stack", "rest"),
                         [](const auto &test) { return test.param; });

/// What a run's dump says of the two spheres at its end.
struct Ends {
  double x, z, vx, vz, w;
};

// Two spheres on a floor that strike each other: momenta and energy change, so that no formula is zero.
TEST(BenchmarksDeck, SaysInItsTableWhatItsDumpGives) {
  const Scratch scratch;
  well(run_deck(post::input_file("benchmarks/in.spheres"),
                given("case oblique_pair, k 1e8, r2 0.007, density2 4000, floor 1, z1 0.0189, z2 0.00695, "
                      "spin 30, spin_ratio -0.4, velocity_ratio -0.3, g 3, contacts 1.7, out out"),
                scratch.path()));
  std::map<std::string, double> p;
  for (const auto &[name, text] : post::read_parameters(scratch / "out/parameters.csv"))
    if (const auto value = post::any_number_from_text(text)) p[name] = *value;
  const std::vector<post::TextDump> dumps = post::read_text_dumps(scratch / "out/balls.txt");
  const auto end_of = [&](std::size_t ball) {
    const post::TextDump &last = dumps.back();
    const auto of = [&](const char *name) { return last.rows[ball][last.column(name)]; };
    return Ends{of("x"), of("z"), of("vx"), of("vz"), of("omegay")};
  };
  const Ends a = end_of(0), b = end_of(1);
  double force = -1e300, overlap = -1e300;
  for (const post::TextDump &dump : dumps) {
    if (&dump == &dumps.front()) continue;
    force = std::max(force, dump.rows[0][dump.column("fz")]);
    overlap = std::max(overlap,
                       p["r1"] + p["r2"] - (dump.rows[0][dump.column("z")] - dump.rows[1][dump.column("z")]));
  }
  const post::Table result = post::read_table(scratch / "out/result.csv"),
                    contact = post::read_table(scratch / "out/contact.csv");
  const auto says = [&](const char *column, double value) {
    EXPECT_NEAR(result.numbers(column)[0], value, 1e-10 * std::fabs(value)) << column;
    EXPECT_GT(std::fabs(value), 1e-9) << column;
  };
  const double vx2 = p["velocity_ratio"] * p["vt"], vz2 = -p["velocity_ratio"] * p["vn"],
               w2 = p["spin_ratio"] * p["spin"], m1 = p["m1"], m2 = p["m2"], r1 = p["r1"], r2 = p["r2"];
  const auto energy = [](double m, double r, const Ends &of) {
    return 0.5 * m * (of.vx * of.vx + of.vz * of.vz) + 0.2 * m * r * r * of.w * of.w;
  };
  const auto turning = [](double m, double r, const Ends &of) {
    return m * (of.z * of.vx - of.x * of.vz) + 0.4 * m * r * r * of.w;
  };
  const Ends a0{0.0, p["z1"], p["vt"], -p["vn"], p["spin"]}, b0{0.0, p["z2"], vx2, vz2, w2};
  const double unit = m1 * std::hypot(p["vn"], p["vt"]), slip = a.vx - r1 * a.w - b.vx - r2 * b.w;
  const double before = energy(m1, r1, a0) + energy(m2, r2, b0),
               after = energy(m1, r1, a) + energy(m2, r2, b);
  says("x_m", a.x);
  says("vx [m/s]", a.vx);
  says("spin [rad/s]", a.w);
  says("restitution", (a.vz - b.vz) / (p["vn"] * (1.0 - p["velocity_ratio"])));
  says("energy_ratio", after / before);
  EXPECT_NEAR(result.numbers("energy_gain")[0], std::max(0.0, after / before - 1.0), 1e-12);
  says("momentum_normal", (m1 * (a.vz - a0.vz) + m2 * (b.vz - b0.vz)) / unit);
  says("momentum_tangential", (m1 * (a.vx - a0.vx) + m2 * (b.vx - b0.vx)) / unit);
  says("angular_momentum",
       (turning(m1, r1, a) + turning(m2, r2, b) - turning(m1, r1, a0) - turning(m2, r2, b0)) / (r1 * unit));
  says("tangential_restitution", a.vx / a0.vx);
  says("rebound_angle [degrees]", std::atan(slip / (a.vz - b.vz)) * 180.0 / M_PI);
  says("recoil", slip / (a.vz - b.vz));
  says("recoil_mu", slip / (p["mu"] * (a.vz - b.vz)));
  says("spin_mu", r1 * a.w / (p["mu"] * p["vn"]));
  says("floor_overlap_m", r1 - a.z);
  says("sphere_overlap_m", r1 + r2 - (b.z - a.z));
  const auto largest = [&contact](const char *column) {
    const std::vector<double> values = contact.numbers(column);
    return *std::max_element(values.begin(), values.end());
  };
  EXPECT_NEAR(largest("force_N"), force, 1e-12 * force);
  EXPECT_NEAR(largest("overlap_m"), overlap, 1e-12);
}

} // namespace
} // namespace drumlin::test
