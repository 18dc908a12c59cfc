// Drums and chains that drive.
#include "tests/support/chain_by_cvode.h"
#include "tests/support/engine_runs.h"
#include "tests/support/ode.h"
#include "chain/analysis.h"
#include "chain/exact_solution.h"

namespace drumlin::test {
namespace {

// A drum, a ball or a clump, that fix drum/travel moves over a floor or a row of balls, in both engines: its
// place against the formulas of the page of the fix, friction that makes it roll, a clump
// against its equations of motion, and the energy balance.
namespace travel {

constexpr double radius = 0.2, mass = 10, g = 9.81, k = 1e6, overlap = mass * g / k;

/// A row of travel.csv.
struct Row {
  double time, pass, place, velocity, traction, torque, work, torque_work, spin, kinetic, springs, heat,
      height, Fe;
  double energy() const { return kinetic + springs + mass * g * height; }
};

std::vector<Row> read_rows(const Scratch &folder) {
  const post::Table table = post::read_table(folder / "travel.csv");
  std::vector<Row> rows(table.rows());
  for (std::size_t n = 0; n < rows.size(); ++n)
    for (std::size_t column = 0; column < table.header().size(); ++column)
      (&rows[n].time)[column] = post::number_from_text(table.row(n)[column]);
  return rows;
}

/// Place and velocity of a pass as the page has them.
struct Programme {
  double length, speed, ramp, pause;
  double pass_time() const { return length / speed + ramp; }
  double velocity(double since) const {
    const double u = ramp == 0 ? 1 : std::min({since / ramp, (pass_time() - since) / ramp, 1.0});
    return since < 0 || since >= pass_time() ? 0 : speed * u * u * (3 - 2 * u);
  }
  double way(double since) const {
    if (since <= 0) return 0;
    if (since >= pass_time()) return length;
    const auto ramped = [&](double t) {
      const double u = t / ramp;
      return speed * ramp * (u * u * u - u * u * u * u / 2);
    };
    if (since < ramp) return ramped(since);
    if (pass_time() - since < ramp) return length - ramped(pass_time() - since);
    return speed * (since - ramp / 2);
  }
};

class TravellingDrum : public BothEngines {
protected:
  static bool second() { return std::get<1>(GetParam()) == "second"; }
};

TEST_P(TravellingDrum, IsWhereTheProgrammeSaysToRoundingAlsoFarFromZero) {
  const Programme programme{0.5, 1, 0.1, 0.05};
  const double period = programme.pass_time() + programme.pause;
  for (const double x0 : {0.0, 1e4, -1e4 - 1.0 / 3.0}) {
    const Scratch folder;
    well(run(
        "travel", folder,
        given("words from 3 to 3.5 speed 1 ramp 0.1 pause 0.05 passes 3, x0 {}, steps 20000, every 7", x0)));
    const std::vector<Frame> frames = read_dump(folder / "balls.txt");
    ASSERT_GT(frames.size(), 2000u);
    const double spacing = std::nextafter(std::fabs(x0) + 1, 1e9) - std::fabs(x0) - 1;
    double worst_x = 0, worst_v = 0;
    for (const Frame &frame : frames) {
      const double t = static_cast<double>(frame.step) * 1e-4;
      const int pass = std::min(2, static_cast<int>(t / period));
      const double since = t - pass * period, way = programme.way(since);
      const double x = x0 + (pass % 2 == 0 ? way : programme.length - way);
      const double v = (pass % 2 == 0 ? 1 : -1) * programme.velocity(since);
      const Ball &ball = frame.balls.begin()->second;
      worst_x = std::max(worst_x, std::fabs(ball.x[0] - x));
      worst_v = std::max(worst_v, std::fabs(ball.v[0] - v));
      for (const double spin : ball.omega)
        ASSERT_EQ(spin, 0.0);
    }
    EXPECT_LT(worst_x, 2 * spacing + 1e-14) << x0;
    EXPECT_LT(worst_v, 1e-12) << x0;
    const std::vector<Row> rows = read_rows(folder);
    EXPECT_EQ(rows.back().place, 3.5);
    EXPECT_EQ(rows.back().pass, 3);
  }
}

/// Variables of a drum that is a ring of 24 balls.
Variables ring(const std::string &words, Variables more = {}) {
  more.emplace_back("clump", "24");
  more.emplace_back("words", words);
  return more;
}

// A ring that rolls while it falls: the axle goes along the way and falls freely, the balls go around it.
TEST_P(TravellingDrum, LetsTheBallsOfAClumpRunOnCycloidsAlsoFarFromZero) {
  struct Kind {
    const char *axis;
    double x0;
    Variables more;
  };
  const double third = -1e4 - 1.0 / 3.0;
  for (const Kind &kind : {Kind{"x", 0, {}}, Kind{"x", 1e4, {}}, Kind{"x", third, {}}, Kind{"y", 0, {}},
                           Kind{"x", 0, given("first 350, then 0.25")}}) {
    const Scratch folder;
    well(run("travel", folder,
             ring(std::string("from 0 to 0.3 speed 3 ramp 0.01 rotation driven radius 0.2 axis ") + kind.axis,
                  with(kind.more, given("x0 {}, lift 0.6, steps 900, every 5", kind.x0)))));
    const Programme programme{0.3, 3, 0.01, 0};
    const double spacing = std::nextafter(std::fabs(kind.x0) + 1, 1e9) - std::fabs(kind.x0) - 1;
    const bool along_x = kind.axis[0] == 'x';
    double worst_x = 0, worst_v = 0;
    for (const Frame &frame : read_dump(folder / "balls.txt")) {
      const auto steps = static_cast<double>(frame.step);
      const double t = kind.more.empty()
                           ? steps * 1e-4
                           : std::min(steps, 350.0) * 1e-4 + std::max(0.0, steps - 350) * 0.25e-4;
      const double way = programme.way(t), speed = programme.velocity(t), turned = way / radius;
      ASSERT_EQ(frame.balls.size(), 24u);
      for (const auto &[id, ball] : frame.balls) {
        const double begin = 2 * pi * static_cast<double>(id) / 24; // from the lowest ball backwards
        const double a0 = along_x ? 0.15 * std::sin(begin) : 0.0, b0 = -0.15 * std::cos(begin);
        const double a = a0 * std::cos(turned) + b0 * std::sin(turned);
        const double b = b0 * std::cos(turned) - a0 * std::sin(turned);
        const std::size_t axis = along_x ? 0 : 1;
        worst_x = std::max({worst_x, std::fabs(ball.x[axis] - (along_x ? kind.x0 : 0.0) - way - a),
                            std::fabs(ball.x[2] - (radius - overlap + 0.6 - g * t * t / 2) - b)});
        worst_v = std::max({worst_v, std::fabs(ball.v[axis] - speed * (1 + b / radius)),
                            std::fabs(ball.v[2] + g * t + speed / radius * a),
                            std::fabs(ball.omega[1 - axis] - (along_x ? 1 : -1) * speed / radius)});
      }
    }
    EXPECT_LT(worst_x, 4 * spacing + 1e-13) << kind.axis << kind.x0;
    EXPECT_LT(worst_v, 2 * spacing * 3 / radius + 1e-11) << kind.axis << kind.x0; // places turn with v/R
  }
}

// Three balls that roll as one body over a row of fixed balls, without friction: the equations of motion of
// the axle's height and of the angle, solved by CVODE. With a damping ratio of 10 the contacts of a ball are
// solved for together.
TEST_P(TravellingDrum, MovesAClumpAsItsEquationsOfMotion) {
  constexpr double small = 0.05, of_clump = 0.05, lever = radius - of_clump, begin = 0.03;
  struct Kind {
    std::string rotation;
    double inertia, speed, damping; // inertia 0: driven
  };
  const double whole = mass * (lever * lever + 0.4 * of_clump * of_clump);
  for (const Kind &kind : {Kind{"driven radius 0.2", 0, 0.7, 0}, Kind{"towed", whole, 0.7, 0},
                           Kind{"towed inertia 0.5", 0.5, 0.7, 0}, Kind{"driven radius 0.2", 0, 2, 10},
                           Kind{"towed", whole, 2, 10}}) {
    if (kind.damping > 0 && !second()) continue;
    const double c = 2 * kind.damping * std::sqrt(mass * k);
    const auto turned = [&](double t, const oracle::State &y) { // angle and its rate
      return kind.inertia == 0 ? std::pair{kind.speed * t / radius, kind.speed / radius}
                               : std::pair{y[2], y[3]};
    };
    /// Force upwards, N, and torque about the axle, N m.
    const auto forces = [&](double t, const oracle::State &y) {
      std::array<double, 2> sum{};
      const auto [angle, spin] = turned(t, y);
      for (int ball = 1; ball <= 3; ++ball) {
        const double turn = 2 * pi * ball / 3 - angle;
        const double a = lever * std::sin(turn), b = -lever * std::cos(turn);
        for (int fixed = -4; fixed <= 14; ++fixed) {
          const double dx = begin + kind.speed * t + a - 0.1 * fixed, dz = y[0] + b;
          const double apart = std::hypot(dx, dz), deep = of_clump + small - apart;
          const double rate = -((kind.speed + spin * b) * dx + (y[1] - spin * a) * dz) / apart;
          const double push = deep > 0 ? std::max(0.0, k * deep + c * rate) : 0;
          sum[0] += push * dz / apart;
          sum[1] += push * (b * dx - a * dz) / apart;
        }
      }
      return sum;
    };
    const std::string what = kind.rotation + ", damping " + number(kind.damping);
    std::vector<double> steps, errors;
    for (const double dt : {2e-4, 1e-4, 0.5e-4}) {
      const Scratch folder;
      well(run("travel", folder,
               given("words {}, clump 3, row 1, D {}, mu 0, x0 {}, dt {}, steps {}, every {}",
                     "from 0 to 0.5 speed " + number(kind.speed) + " rotation " + kind.rotation, kind.damping,
                     begin, dt, std::lround(0.2 / dt), std::lround(0.01 / dt))));
      oracle::Ode exact(
          [&](double t, const oracle::State &y, oracle::State &dydt) {
            const auto [lift, torque] = forces(t, y);
            dydt = {y[1], lift / mass - g, y[3], kind.inertia == 0 ? 0.0 : torque / kind.inertia};
          },
          0, {radius + small - overlap, 0, 0, 0}, {0.1, 0.1, 0.1, 1});
      double worst = 0;
      const std::vector<Row> rows = read_rows(folder);
      ASSERT_GE(rows.size(), 20u);
      for (const Row &row : rows) {
        if (row.time > 0) exact.advance(row.time);
        const oracle::State &y = exact.state();
        worst = std::max(worst, std::fabs(row.height - y[0]) / radius);
        if (kind.inertia != 0) worst = std::max(worst, std::fabs(row.spin - y[3]) * radius / kind.speed);
      }
      steps.push_back(1 / dt);
      errors.push_back(worst);
    }
    EXPECT_LT(errors[2], 2e-3) << what;
    EXPECT_LT(fitted_order(steps, errors), -1.8)
        << what << ' ' << errors[0] << ' ' << errors[1] << ' ' << errors[2];
  }
}

TEST_P(TravellingDrum, GoesRoundAPeriodicBoxInOneDirection) {
  for (const char *balls : {"0", "24"}) {
    const Scratch folder;
    well(run("travel", folder,
             given("words from 0 to 2 speed 4 ramp 0.1 passes 3 direction one rotation driven radius 0.2, "
                   "clump {}, sides p, steps 18500, every 100",
                   balls)));
    const Programme programme{2, 4, 0.1, 0};
    for (const Frame &frame : read_dump(folder / "balls.txt")) {
      const double t = static_cast<double>(frame.step) * 1e-4;
      const int pass = std::min(2, static_cast<int>(t / programme.pass_time()));
      const double way = 2 * pass + programme.way(t - pass * programme.pass_time());
      const double lever =
          balls[0] == '0' ? 0.0 : 0.15; // the last ball of the ring is below the axle at first
      const double place = way - lever * std::sin(way / radius);
      EXPECT_NEAR(std::remainder(frame.balls.rbegin()->second.x[0] - place, 2.0), 0, 1e-12) << frame.step;
    }
    EXPECT_NEAR(read_rows(folder).back().place, 2, 1e-12);
  }
}

TEST_P(TravellingDrum, OfARestartFileIsNotDrivenAnotherWay) {
  const Scratch folder;
  const Variables scene = given("first 20, steps 20");
  well(run("travel", folder, with({{"words", "from 0 to 0.5 speed 1 ramp 0.1"}}, scene)));
  const Variables other =
      given("words from 0 to 0.8 speed 1, again 1, start {}", (folder / "first.restart").string());
  EXPECT_TRUE(fails_with(run("travel", folder, with(other, scene)),
                         {"fix drum/travel: way driven is '", "allowed: those of the run before"}));
}

TEST_P(TravellingDrum, KeepsItsProgrammeWithAnotherTimeStep) {
  const Scratch folder;
  well(run("travel", folder,
           given("words from 0 to 0.5 speed 1 ramp 0.1 rotation driven, first 350, then 0.25, steps 20000")));
  const Programme programme{0.5, 1, 0.1, 0};
  for (const Frame &frame : read_dump(folder / "balls.txt")) {
    const double steps = static_cast<double>(frame.step);
    const double t = std::min(steps, 350.0) * 1e-4 + std::max(0.0, steps - 350) * 0.25e-4;
    const Ball &ball = frame.balls.begin()->second;
    EXPECT_NEAR(ball.x[0], programme.way(t), 1e-12) << frame.step;
    EXPECT_NEAR(ball.v[0], programme.velocity(t), 1e-10) << frame.step;
    EXPECT_NEAR(ball.omega[1], programme.velocity(t) / radius, 1e-9) << frame.step;
  }
}

TEST_P(TravellingDrum, SlidesUntilItRollsAsTheClosedFormOfASlidingBall) {
  struct Kind {
    std::string words;
    double inertia;
    Variables more;
  };
  // Two balls at one place, or one ball, are the clumps that a ball can be compared with.
  const Variables twins = given("clump 2, of_clump {}, k {}, lift {}", radius, k / 2, overlap);
  const double of_ball = 0.4 * mass * radius * radius;
  for (const Kind &kind : {Kind{"", of_ball, {}}, Kind{" inertia 0.35", 0.35, {}}, Kind{"", of_ball, twins},
                           Kind{"", of_ball, given("clump 1, of_clump {}", radius)}}) {
    const Scratch folder;
    well(run("travel", folder,
             with(kind.more, given("words {}, steps 9000, every 1",
                                   "from 0 to 1 speed 1 rotation towed" + kind.words))));
    constexpr double mu = 0.3, lever = radius - overlap / 2; // of the contact force
    const double gain = mu * mass * g * lever / kind.inertia, rolls = 1 / lever / gain;
    double mean = 0;
    int count = 0;
    for (const Row &row : read_rows(folder)) {
      // The spring of friction is stretched at first, and gives a little spin less: mu N over its stiffness.
      if (row.time > 0.1 * rolls && row.time < 0.98 * rolls) {
        EXPECT_NEAR(row.spin / (gain * row.time), 1, second() ? 1e-4 : 5e-3) << row.time;
        EXPECT_NEAR(row.traction / (mu * mass * g), 1, 1e-6) << row.time;
      }
      if (row.time > 0.5) { // it rolls, and no longer swings on the spring of friction
        mean += row.spin;
        ++count;
      }
      EXPECT_NEAR(row.energy() + row.heat - row.work,
                  0.5 * mass + 0.5 * k * overlap * overlap + mass * g * (radius - overlap), 1e-2);
    }
    EXPECT_NEAR(mean / count * lever, 1, 1e-4);
  }
}

TEST_P(TravellingDrum, IsSlowedByRollingResistanceWithTheHeatOfItsTraction) {
  const Scratch folder;
  well(run("travel", folder,
           given("words from 0 to 1 speed 1 ramp 0.1 rotation towed, rolling epsd2, mu_r 0.05, mu 0.5, steps "
                 "11000")));
  const std::vector<Row> rows = read_rows(folder);
  const auto at = [&](double time) {
    return *std::find_if(rows.begin(), rows.end(), [&](const Row &row) { return row.time > time - 1e-6; });
  };
  const Row begin = at(0.4), end = at(0.9);
  const double traction = (end.work - begin.work) / (end.place - begin.place);
  const double heat = end.heat - begin.heat + end.energy() - begin.energy();
  EXPECT_NEAR(heat / (end.work - begin.work), 1, 1e-3);
  // epsd2 resists with a torque of at most mu_r N r, r the radius of a ball on a flat wall; the traction
  // gives it with the lever of the contact.
  EXPECT_NEAR(traction, 0.05 * mass * g * radius / (radius - overlap / 2), 1e-2 * 0.05 * mass * g);
}

TEST_P(TravellingDrum, BalancesItsEnergyOverARowOfBalls) {
  struct Kind {
    const char *rotation, *balls, *damping;
  };
  for (const auto &[rotation, balls, damping] :
       {Kind{"none", "0", "0.1"}, Kind{"driven", "0", "0.1"}, Kind{"towed", "0", "0.1"},
        Kind{"towed inertia 0.35", "0", "0.1"}, Kind{"none", "24", "0.1"},
        Kind{"driven radius 0.2", "24", "0.1"}, Kind{"towed", "24", "0.1"},
        Kind{"towed inertia 0.35", "24", "0.1"}, Kind{"driven radius 0.2", "24", "10"}}) {
    std::vector<double> steps, errors;
    for (const double dt : second() ? std::vector{1e-4, 2e-4} : std::vector{1e-4}) {
      const Scratch folder;
      well(run("travel", folder,
               given("words {}, row 1, clump {}, D {}, dt {}, steps {}, every {}",
                     std::string("from 0 to 0.5 speed 1 ramp 0.1 passes 2 rotation ") + rotation, balls,
                     damping, dt, std::lround(1.2 / dt), std::lround(2e-3 / dt))));
      double worst = 0, most = 0;
      const std::vector<Row> rows = read_rows(folder);
      for (const Row &row : rows) {
        const double balance = row.energy() + row.heat - row.work - row.torque_work;
        worst = std::max(
            worst, std::fabs(balance - mass * g * (radius + 0.05 - overlap) - 0.5 * k * overlap * overlap));
        most = std::max(most, std::fabs(row.work) + std::fabs(row.torque_work));
      }
      steps.push_back(1 / dt);
      errors.push_back(worst / most);
    }
    EXPECT_LT(errors[0], 1e-3) << rotation << ' ' << balls;
    if (second()) {
      EXPECT_LT(fitted_order(steps, errors), -1.7)
          << rotation << ' ' << balls << ' ' << errors[0] << ' ' << errors[1];
    }
  }
}

TEST_P(TravellingDrum, VibratesWithTheShareOfItsSpeed) {
  const Scratch folder;
  well(run("travel", folder,
           given("words from 0 to 0.5 speed 1 ramp 0.1 pause 0.05 passes 2, excitation amplitude 50 "
                 "frequency 20 phase 0.3 travel travel, steps 13000")));
  double most = 0;
  for (const Row &row : read_rows(folder)) {
    EXPECT_NEAR(row.Fe, 50 * std::fabs(row.velocity) * std::sin(2 * pi * 20 * row.time + 0.3), 1e-8)
        << row.time;
    most = std::max(most, std::fabs(row.Fe));
  }
  EXPECT_GT(most, 49.9);
}

INSTANTIATE_TEST_SUITE_P(Engines, TravellingDrum, engines_and_steppings(), engine_and_stepping);

} // namespace travel

// The chain that drives over soil that changes, in both engines, against the exact solution: steps, ramps and
// a random field of k and D; over uniform soil against the chain that stands.
namespace way {

namespace fs = std::filesystem;

constexpr int samples = 50;

/// A way, and how the roller of Table 1 drives over it.
struct Drive {
  const char *name;
  Way way;
  double speed;
  int passes;

  double duration() const { return passes * (way.back().s - way.front().s) / speed; }
};

// Places of steps are such that none coincides with the end of a time step.
const Drive steps{
    "steps", {{0, 1e7, 0.1}, {0.2123, 1e7, 0.1}, {0.2123, 1.6e7, 0.2}, {0.3, 1.6e7, 0.2}}, 1, 2};
const Drive onto_stiff_soil{
    "onto_stiff_soil", {{3, 2e7, 0.25}, {3.2071, 2e7, 0.25}, {3.2071, 8e7, 0.25}, {3.45, 8e7, 0.25}}, 1, 2};
const Drive ramps{"ramps", {{-1, 3e7, 0.3}, {-0.8, 6e7, 0.2}, {-0.5, 2e7, 0.4}}, 1.5, 2};

Drive random_field() {
  post::RandomSoil soil;
  soil.mean = 4.5e7;
  soil.variation = 0.3;
  soil.correlation = 0.1;
  soil.D = 0.3;
  soil.to = 0.4;
  soil.step = 0.02;
  return {"random", post::random_way(soil), 1, 1};
}

class DrivenChain : public BothEngines {
protected:
  static Outcome run_chain_over(const Drive &drive, int steps_per_cycle, const Scratch &folder,
                                const Variables &more = {}) {
    write(folder / "way.csv", post::way_text(drive.way));
    const auto &[engine, stepping] = GetParam();
    return run_deck(
        chain_deck(engine == "lammps" ? "in.way.lammps" : "in.way"),
        with(more, given("way {}, speed {}, passes {}, steps_per_cycle {}, samples_per_cycle {}, stepping {}",
                         (folder / "way.csv").string(), drive.speed, drive.passes, steps_per_cycle, samples,
                         stepping)),
        folder.path());
  }
  static void write(const fs::path &file, const std::string &text) { std::ofstream(file) << text; }

  static post::ChainHistory exact(const Drive &drive, post::Transition transition) {
    post::ChainParameters p = post::table1_case("II", transition);
    p.k = drive.way.front().k;
    p.D = drive.way.front().D;
    post::ExactOptions options;
    options.way = post::drive(drive.way, drive.speed, drive.passes);
    options.cycles = drive.duration() / p.period();
    options.samples_per_cycle = samples;
    return drumlin::test::solve_by_cvode(p, options).history;
  }

  /// RMS error of a column over its RMS value, where both have rows.
  static double error(const std::vector<double> &run, const std::vector<double> &expected) {
    EXPECT_LE(expected.size(), run.size() + 1);
    return post::relative_rms(run, expected, 0, std::min(run.size(), expected.size()));
  }
  static bool second() { return std::get<1>(GetParam()) == "second"; }
};

TEST_P(DrivenChain, FollowsTheExactSolutionOverStepsRampsAndARandomField) {
  std::vector<double> counts, errors; // of each number of steps, over all scenes
  for (const int steps_per_cycle : {500, 1000, 2000, 4000}) {
    if (!second() && steps_per_cycle != 2000) continue;
    double squares = 0;
    for (const Drive &drive : {steps, onto_stiff_soil, ramps, random_field()})
      for (const post::Transition transition : {post::Transition::A, post::Transition::B}) {
        SCOPED_TRACE(drive.name + post::transition_name(transition));
        const post::ChainHistory expected = exact(drive, transition);
        const Scratch folder;
        well(run_chain_over(drive, steps_per_cycle, folder,
                            {{"transition", post::transition_name(transition)}}));
        const post::ChainHistory run = post::read_chain(folder / "chain.csv");
        ASSERT_TRUE(run.has(post::ColumnGroup::way));
        EXPECT_LT(error(run.s, expected.s), 1e-12);
        EXPECT_EQ(std::vector<double>(run.pass.begin(), run.pass.begin() + 20),
                  std::vector<double>(expected.pass.begin(), expected.pass.begin() + 20));
        const double one = error(run.v_drum, expected.v_drum);
        if (steps_per_cycle == 2000) {
          EXPECT_LT(one, second() ? 1e-5 : 1e-2);
        }
        squares += one * one;
      }
    counts.push_back(steps_per_cycle);
    errors.push_back(std::sqrt(squares));
  }
  // Those of single scenes scatter with the phases of makes and breaks in the time steps.
  if (second()) {
    EXPECT_LT(fitted_order(counts, errors), -1.9);
  }
}

TEST_P(DrivenChain, IsOverUniformSoilTheChainThatStands) {
  const Drive uniform{"uniform", {{-2, 4e7, 0.3}, {5, 4e7, 0.3}, {7, 4e7, 0.3}}, 20, 2};
  const Scratch driven, standing;
  well(run_chain_over(uniform, 500, driven));
  well(run_deck(chain_deck(std::get<0>(GetParam()) == "lammps" ? "in.chain.lammps" : "in.chain"),
                given("k 4e7, D 0.3, cycles 18, steps_per_cycle 500, samples_per_cycle {}, stepping {}",
                      samples, std::get<1>(GetParam())),
                standing.path()));
  const post::ChainHistory one = post::read_chain(driven / "chain.csv"),
                           two = post::read_chain(standing / "chain.csv");
  EXPECT_EQ(one.size(), two.size());
  EXPECT_LT(relative_difference(one.v_drum, two.v_drum), 1e-9);
  EXPECT_LT(relative_difference(one.F_contact, two.F_contact), 1e-9);
  EXPECT_FALSE(two.has(post::ColumnGroup::way));
  // The report does not compare a chain that drives with the solution of one that stands.
  well(run_program(tool_words("report {} --out {}", driven.path().string(), (driven / "report").string()), {},
                   driven.path()));
  std::string pages;
  for (const auto &entry : fs::recursive_directory_iterator(driven / "report"))
    if (entry.path().extension() == ".html") pages += read_text(entry.path());
  EXPECT_TRUE(contains(pages, "the roller drives"));
}

TEST_P(DrivenChain, BalancesItsEnergyWithTheWorkOfTheDrive) {
  for (const Drive &drive : {steps, onto_stiff_soil, ramps}) {
    const Scratch folder;
    well(run_chain_over(drive, 4000, folder));
    const post::Table cycles = post::read_table(folder / "cycles.csv");
    const auto column = [&](const char *name) { return cycles.numbers(name); };
    std::vector<double> change(cycles.rows());
    for (const char *name :
         {"kinetic", "potential", "stored_contact", "stored_bond", "dissipated_contact", "dissipated_bond"}) {
      const std::vector<double> values = column(name);
      for (std::size_t n = 0; n < change.size(); ++n)
        change[n] += values[n] - values[0];
    }
    double worst = 0, most = 0, drives = 0;
    for (std::size_t n = 0; n < change.size(); ++n) {
      worst = std::max(worst, std::fabs(change[n] - column("work_excitation")[n] - column("work_travel")[n]));
      most = std::max(most, std::fabs(column("work_excitation")[n]));
      drives = std::max(drives, std::fabs(column("work_travel")[n]));
    }
    EXPECT_LT(worst, 1e-3 * most) << drive.name;
    if (second()) {
      EXPECT_LT(worst, 2e-2 * drives) << drive.name;
    }
  }
}

// Nothing else acts on the chain along the way: the work of the drive is what the changes of the soil take,
// the integral of d^2 / 2 over k, here by the overlaps of chain.csv and the way as it is written below.
TEST(DrivenChainInLiggghts, CountsTheWorkOfTheSoilsChanges) {
  const Scratch folder;
  std::ofstream(folder / "way.csv") << post::way_text(
      {{0, 40e6, 0.2}, {0.3, 40e6, 0.2}, {0.3, 80e6, 0.2}, {0.7, 120e6, 0.2}});
  const auto stiffness = [](double s) { return s < 0.3 ? 40e6 : 80e6 + (s - 0.3) / 0.4 * 40e6; };
  well(run_deck(
      test_deck("way_work.in"),
      given("here {}, way {}, speed 1, stepping second, steps_per_cycle 2000, samples_per_cycle 2000, out {}",
            (fs::path(DRUMLIN_SOURCE_DIR) / "inputs/chain").string(), (folder / "way.csv").string(),
            folder.path().string()),
      folder.path()));
  const post::ChainHistory run = post::read_chain(folder / "chain.csv");
  double expected = 0;
  for (std::size_t i = 1; i < run.s.size(); ++i) {
    const double overlap = std::max(0.0, -0.5 * (run.x_drum[i - 1] + run.x_drum[i]));
    expected += 0.5 * overlap * overlap * (stiffness(run.s[i]) - stiffness(run.s[i - 1]));
  }
  const double work = post::read_table(folder / "work.csv").numbers("work").front();
  EXPECT_GT(expected, 1.0);
  EXPECT_NEAR(work, expected, 1e-2 * expected);
  const double drive = post::read_table(folder / "cycles.csv").numbers("work_travel").back();
  EXPECT_NEAR(work, drive, 1e-9 * drive);
}

/// A drum that rolls over a row of balls (travel.scene) whose contacts with it change along the way.
class DrumOnChangingSoil : public BothEngines {
protected:
  static Variables variables() {
    return given("words from 0 to 0.5 speed 1 ramp 0.1 passes 2 rotation towed, row 1, with_way 1, way {}",
                 test_deck("travel.way.csv").string());
  }
};

TEST_P(DrumOnChangingSoil, BalancesItsEnergyWithTheWorkOfTheDrive) {
  std::vector<double> counts, errors;
  const bool second = std::get<1>(GetParam()) == "second";
  for (const double dt : second ? std::vector{1e-4, 2e-4, 0.5e-4} : std::vector{1e-4}) {
    const Scratch folder;
    well(run("travel", folder,
             with(variables(),
                  given("dt {}, steps {}, every {}", dt, std::lround(1.2 / dt), std::lround(2e-3 / dt)))));
    const post::Table rows = post::read_table(folder / "travel.csv");
    const auto of = [&rows](const char *column) { return rows.numbers(column); };
    const std::vector<double> work = of("work"), torque_work = of("torque_work"), kinetic = of("kinetic"),
                              springs = of("springs"), heat = of("heat"), height = of("height");
    double worst = 0, most = 0;
    const auto balance = [&](std::size_t n) {
      return kinetic[n] + springs[n] + heat[n] + 10 * 9.81 * height[n] - work[n] - torque_work[n];
    };
    for (std::size_t n = 0; n < rows.rows(); ++n) {
      worst = std::max(worst, std::fabs(balance(n) - balance(0)));
      most = std::max(most, std::fabs(work[n]));
    }
    counts.push_back(1 / dt);
    errors.push_back(worst / most);
  }
  EXPECT_LT(errors[0], 1e-3);
  if (second) {
    EXPECT_LT(fitted_order(counts, errors), -1.7) << errors[0] << ' ' << errors[1] << ' ' << errors[2];
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, DrumOnChangingSoil, engines_and_steppings(), engine_and_stepping);
INSTANTIATE_TEST_SUITE_P(Engines, DrivenChain, engines_and_steppings(), engine_and_stepping);

} // namespace way

} // namespace
} // namespace drumlin::test
