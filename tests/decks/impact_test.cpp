// Impacts: on a ball or a wall, and of a ball that strikes a small bed.
#include "tests/support/balls_run.h"
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"

#include "chain/analysis.h"
#include "runs/parameter_file.h"
#include "support/csv.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ostream>
#include <string>
#include <tuple>
#include <vector>

namespace drumlin::test {
namespace {

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
  well(run_deck(chain_deck("in.impact"),
                {{"transition", post::transition_name(impact.transition)},
                 {"D", number(impact.D)},
                 {"stepping", stepping},
                 {"steps_per_contact", std::to_string(steps)},
                 {"onset", number(onset)},
                 {"contacts", "4"},
                 {"samples", "100"}},
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
      return run_balls({{"obstacle", obstacle},
                        {"stepping", stepping},
                        {"transition", post::transition_name(impact.transition)},
                        {"dashpot", number(impact.D)},
                        {"velocity2", "0 0 -0.5"},
                        {"gap", "0.0001"},
                        {"dt", "1e-5"},
                        {"steps", "3000"}});
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
    return run_balls({{"obstacle", obstacle},
                      {"stepping", "second"},
                      {"transition", post::transition_name(GetParam().transition)},
                      {"dashpot", number(GetParam().D)},
                      {"velocity2", velocity},
                      {"gap", "0.0001"},
                      {"dt", "1e-5"},
                      {"steps", "3000"}});
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
    const BallsRun run = run_balls({{"obstacle", obstacle},
                                    {"stepping", "second"},
                                    {"damping", "coefficient"},
                                    {"property", "gamman_abs"},
                                    {"dashpot", number(c)},
                                    {"k", number(k)},
                                    {"m2", number(m)},
                                    {"g", number(g)},
                                    {"gap", number(gap)},
                                    {"dt", number(dt)},
                                    {"steps", std::to_string(steps)}});
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
  if (lammps && !post::has_lammps()) GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  const Scratch scratch;
  const std::string deck = std::string("inputs/benchmarks/in.penetration") + (lammps ? ".lammps" : "");
  well(run_deck(std::filesystem::path(DRUMLIN_SOURCE_DIR) / deck,
                {{"law", law},
                 {"sample", "1e-4"},
                 {"rows", "2000"},
                 {"columns", "5"},
                 {"layers", "8"},
                 {"speed", "1"},
                 {"out", "out"}},
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

} // namespace
} // namespace drumlin::test
