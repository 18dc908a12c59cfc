// LAMMPS against LIGGGHTS: the same fixes and laws in both, with another pair style, other walls and another
// contact history. The allowed difference is rounding, and its growth in scenes whose motion is sensitive to
// it.
#include "tests/support/chain_by_cvode.h"
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"
#include "tests/support/frame_distance.h"

#include "bed/dump_readers.h"
#include "chain/analysis.h"
#include "chain/exact_solution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <ostream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace drumlin::test {
namespace {

/// Everything here needs an lmp with the plugin.
class InLammps : public ::testing::Test {
protected:
  void SetUp() override {
    if (!post::has_lammps()) GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  }
};

struct Chain {
  const char *name;
  post::Transition transition;
  const char *stepping;
};

void PrintTo(const Chain &chain, std::ostream *out) {
  *out << chain.name << post::transition_name(chain.transition) << chain.stepping;
}

class InLammpsChain : public InLammps, public ::testing::WithParamInterface<Chain> {};

std::string chain_name(const ::testing::TestParamInfo<Chain> &info) {
  return info.param.name + post::transition_name(info.param.transition) + "_" + info.param.stepping;
}

TEST_P(InLammpsChain, IsThatOfLiggghtsAndFollowsTheDirectSolver) {
  const Variables variables = {{"case", GetParam().name},
                               {"transition", post::transition_name(GetParam().transition)},
                               {"stepping", GetParam().stepping},
                               {"cycles", "30"}};
  const Scratch lammps, liggghts;
  well(run_deck(chain_deck("in.chain.lammps"), variables, lammps.path()));
  well(run_deck(chain_deck("in.chain"), variables, liggghts.path()));
  const ChainRun a = read_run(lammps.path()), b = read_run(liggghts.path());
  for (const auto column :
       {&post::ChainHistory::x_drum, &post::ChainHistory::v_drum, &post::ChainHistory::a_drum,
        &post::ChainHistory::x_frame, &post::ChainHistory::v_frame, &post::ChainHistory::a_frame,
        &post::ChainHistory::F_contact, &post::ChainHistory::F_bond})
    EXPECT_LT(relative_difference(a.history.*column, b.history.*column), 1e-9);
  EXPECT_EQ(a.history.F_excitation, b.history.F_excitation);
  ASSERT_EQ(a.events.size(), b.events.size());
  for (std::size_t n = 0; n < a.events.size(); ++n) {
    EXPECT_EQ(a.events[n].make, b.events[n].make) << "event " << n;
    EXPECT_NEAR(a.events[n].time, b.events[n].time, 1e-9 * b.events[n].time) << "event " << n;
  }

  const post::ChainParameters p = post::table1_case(GetParam().name, GetParam().transition);
  post::ExactOptions options;
  options.cycles = 30;
  options.samples_per_cycle = 200;
  const post::ChainHistory reference = drumlin::test::solve_by_cvode(p, options).history;
  ASSERT_EQ(a.history.size(), reference.size());
  const double error = post::relative_rms(a.history.v_drum, reference.v_drum, 25 * 200, reference.size());
  EXPECT_LT(error, std::string(GetParam().stepping) == "second" ? 1e-4 : 5e-3);
}

INSTANTIATE_TEST_SUITE_P(
    Table1, InLammpsChain,
    ::testing::Values(Chain{"I", post::Transition::A, "second"}, Chain{"I", post::Transition::B, "second"},
                      Chain{"II", post::Transition::A, "second"}, Chain{"II", post::Transition::B, "second"},
                      Chain{"III", post::Transition::A, "second"},
                      Chain{"III", post::Transition::B, "second"}, Chain{"IV", post::Transition::A, "second"},
                      Chain{"IV", post::Transition::B, "second"}, Chain{"II", post::Transition::A, "stock"},
                      Chain{"II", post::Transition::B, "stock"}),
    chain_name);

TEST_F(InLammps, RunsRollersAsInLiggghts) {
  const std::filesystem::path rollers = std::filesystem::path(DRUMLIN_SOURCE_DIR) / "inputs/rollers";
  for (const auto &[machine, setting] :
       {std::pair("Axas2020", "29Hz"), {"BW120", "63Hz"}, {"CA3500", "low"}, {"CA6500", "high"}}) {
    SCOPED_TRACE(machine);
    const Variables variables = {
        {"roller", (rollers / machine).string()}, {"setting", setting}, {"cycles", "2"}};
    const Scratch lammps, liggghts;
    well(run_deck(chain_deck("in.chain.lammps"), variables, lammps.path()));
    well(run_deck(chain_deck("in.chain"), variables, liggghts.path()));
    const ChainRun a = read_run(lammps.path()), b = read_run(liggghts.path());
    EXPECT_LT(relative_difference(a.history.v_drum, b.history.v_drum), 1e-9);
    EXPECT_LT(relative_difference(a.history.F_contact, b.history.F_contact), 1e-9);
    EXPECT_EQ(a.history.F_excitation, b.history.F_excitation);
  }
}

struct Bounce {
  const char *name;
  Variables variables;
  Variables in_lammps = {}; ///< there instead, where the law has another name
  double distance = 1e-8;   ///< of the results of the engines. Rounding grows from impact to impact.
};

void PrintTo(const Bounce &bounce, std::ostream *out) { *out << bounce.name; }

std::string bounce_name(const ::testing::TestParamInfo<Bounce> &info) { return info.param.name; }

/// The last line that begins so; empty if there is none.
std::string last_line_with(const std::string &output, const std::string &begin) {
  const std::size_t found = output.rfind(begin);
  return found == std::string::npos ? "" : output.substr(found, output.find('\n', found) - found);
}

class InLammpsBounce : public InLammps, public ::testing::WithParamInterface<Bounce> {};

TEST_P(InLammpsBounce, GoesAsInLiggghtsOnSeveralRanksWithNewtonOffAndOn) {
  const Scratch liggghts;
  const Outcome here = well(run_deck(test_deck("bounce.in"), GetParam().variables, liggghts.path()));
  const std::vector<Frame> expected = read_dump(liggghts / "balls.txt");
  const std::string guard = last_line_with(here.output, "fix guard guard: "); // of the second run
  EXPECT_TRUE(contains(guard, "critical step")) << here.output;
  // There is something to compare: balls that have hit walls and each other, and rotate.
  ASSERT_EQ(expected.size(), 13u);
  double fastest_turn = 0.0;
  for (const auto &[id, ball] : expected.back().balls)
    fastest_turn = std::max(fastest_turn, std::fabs(ball.omega[1]));
  const Variables &given = GetParam().variables;
  const bool rubs =
      std::find(given.begin(), given.end(), Variables::value_type("tangential", "off")) == given.end();
  EXPECT_EQ(fastest_turn > 1.0, rubs);
  for (const char *newton : {"off", "on"})
    for (int ranks = 1; ranks <= most_ranks(); ranks *= 2) {
      const Scratch lammps;
      const Variables variables = with(
          GetParam().in_lammps.empty() ? GetParam().variables : GetParam().in_lammps, {{"newton", newton}});
      const Outcome there = well(run_deck(test_deck("bounce.lammps"), variables, lammps.path(), ranks));
      EXPECT_LT(distance(read_dump(lammps / "balls.txt"), expected), GetParam().distance)
          << "ranks " << ranks << ", newton " << newton;
      EXPECT_EQ(last_line_with(there.output, "fix guard guard: "), guard) << "ranks " << ranks;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Balls, InLammpsBounce,
    ::testing::Values(
        // Divided where no contact slides: in the set-up of a run, rounding decides whether the engines'
        // friction takes a contact at its limit for a sliding one.
        Bounce{"B", {}}, Bounce{"A", {{"transition", "A"}, {"first", "5000"}, {"rest", "7000"}}},
        Bounce{"stock", {{"stepping", "stock"}}},
        Bounce{"without_friction", {{"tangential", "off"}, {"mu", "-1"}}},
        // The dashpot alone is what coulomb gives with a spring of no stiffness, but for the normals with
        // which the slip is computed, those of the middle or of the end of the step.
        Bounce{
            "without_spring", {{"tangential", "coulomb"}, {"kt", "0"}}, {{"tangential", "no_history"}}, 3e-5},
        Bounce{"coulomb", {{"tangential", "coulomb"}}},
        Bounce{"coulomb_A_stock", {{"tangential", "coulomb"}, {"transition", "A"}, {"stepping", "stock"}}},
        Bounce{"region", {{"walls", "block"}}},
        Bounce{"region_A", {{"walls", "block"}, {"transition", "A"}, {"first", "5000"}, {"rest", "7000"}}},
        Bounce{"rolling", {{"rolling", "epsd2"}, {"first", "5000"}, {"rest", "7000"}}},
        Bounce{"rolling_coulomb_A_stock",
               {{"rolling", "epsd2"}, {"tangential", "coulomb"}, {"transition", "A"}, {"stepping", "stock"}}},
        Bounce{"rolling_region", {{"rolling", "epsd2"}, {"walls", "block"}, {"mu_r", "0.05"}}},
        Bounce{"heavy_dashpots", // c dt/m near 1: they are solved for together. 1e-15 after the first impacts
               {{"D", "40"}, {"tangential", "off"}, {"mu", "-1"}},
               {},
               1e-6}),
    bounce_name);

// The Hertz law's dashpot has no value at a negative overlap: a contact that has ended has no force.
TEST(InLammpsWalls, WithoutHistoryEndsAContactWithoutAForce) {
  if (!post::has_lammps()) GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  const Scratch folder;
  well(run_deck(test_deck("bounce.lammps"),
                {{"normal", "hertz"}, {"tangential", "no_history"}, {"stepping", "stock"}}, folder.path()));
  const std::vector<Frame> frames = read_dump(folder / "balls.txt");
  ASSERT_FALSE(frames.empty());
  for (const auto &[id, ball] : frames.back().balls)
    for (const double value : {ball.x[0], ball.v[0], ball.v[2], ball.omega[1]})
      EXPECT_TRUE(std::isfinite(value)) << "ball " << id;
}

// The order of balls in memory decides which of two is the first of a pair: when it changes, the contact
// history changes its sign.
TEST_F(InLammps, HistoryIsKeptWhenTheOrderOfBallsChanges) {
  const Scratch kept;
  well(run_deck(test_deck("bounce.lammps"), {{"rolling", "epsd2"}}, kept.path()));
  for (const char *newton : {"off", "on"}) {
    const Scratch shuffled;
    EXPECT_TRUE(printed(
        well(run_deck(test_deck("bounce.lammps"),
                      {{"rolling", "epsd2"}, {"shuffle", "50"}, {"newton", newton}}, shuffled.path())),
        "Neighbor list builds = 120"));
    EXPECT_LT(distance(read_dump(kept / "balls.txt"), read_dump(shuffled / "balls.txt")), 1e-9);
  }
}

TEST_F(InLammps, RefusesAnotherVersionOnRanksOneAndTwo) {
  const WaitForRanks at_once(0);
  const Scratch folder;
  for (const int ranks : {1, 2}) {
    EXPECT_TRUE(fails_with(
        run_deck(chain_deck("in.chain.lammps"), {{"plugin", DRUMLIN_OTHER_LAMMPS}}, folder.path(), ranks),
        "ERROR: drumlin " DRUMLIN_VERSION ": built for LAMMPS 1 Feb 2003 (20030201), but this is 20"));
  }
}

TEST_F(InLammps, ContinuesFromARestartFileBitwiseOnSeveralRanksWithNewtonOffAndOn) {
  for (const auto &[ranks, newton, tangential, rolling] : {std::tuple{1, "off", "coulomb", "off"},
                                                           {2, "off", "history", "epsd2"},
                                                           {1, "on", "history", "off"},
                                                           {2, "on", "coulomb", "epsd2"},
                                                           {2, "on", "no_history", "epsd2"},
                                                           {4, "off", "coulomb", "epsd2"},
                                                           {4, "on", "coulomb", "epsd2"}}) {
    if (ranks > most_ranks()) continue;
    const Scratch stayed, left;
    const Variables law = {{"newton", newton}, {"tangential", tangential}, {"rolling", rolling}};
    well(run_deck(test_deck("bounce.lammps"), law, stayed.path(), ranks));
    for (const char *file : {"first.restart", "during.6000"}) { // written after a run, and during one
      const Variables again = with(law, {{"start", (stayed / file).string()},
                                         {"law", std::string(tangential) == "coulomb" ? "restart" : "deck"}});
      well(run_deck(test_deck("bounce.resume.lammps"), again, left.path(), ranks));
      const std::string all = read_text(stayed / "balls.txt"), second = read_text(left / "balls.txt");
      const std::size_t begin = all.find("ITEM: TIMESTEP\n7000\n");
      ASSERT_NE(begin, std::string::npos);
      EXPECT_EQ(all.substr(begin), second.substr(second.find("ITEM: TIMESTEP\n7000\n")))
          << file << ", ranks " << ranks << ", newton " << newton;
    }
  }
}

/// With -partition each partition is a run of its own. With a folder of its own, its files are byte by byte
/// those of a single run.
TEST_F(InLammps, PartitionsAreRunsOfTheirOwnOnRanksOneAndTwo) {
  const Scratch scratch;
  const std::string drumlin = std::string(DRUMLIN_SOURCE_DIR) + "/drumlin";
  std::ofstream(scratch / "both.lammps") << "variable out world both/A both/B\n"
                                            "variable transition world A B\n"
                                            "variable here index "
                                         << chain_deck("").string() << "\ninclude ${here}/in.chain.lammps\n";
  const Outcome both = well(
      run_program({drumlin, "run", "-np", "2", "both.lammps", "-partition", "2x1", "-var", "cycles", "3"}, {},
                  scratch.path()));
  for (const char *transition : {"A", "B"}) {
    const Scratch alone;
    well(
        run_deck(chain_deck("in.chain.lammps"), {{"transition", transition}, {"cycles", "3"}}, alone.path()));
    for (const char *table : {"chain.csv", "events.csv", "cycles.csv"})
      EXPECT_EQ(read_text(alone / table), read_text(scratch / "both" / transition / table)) << table;
  }
}

/// With a suffix LAMMPS takes its own accelerated variants where it has them, and refuses a suffix whose
/// package is not in the lmp.
TEST_F(InLammps, SuffixesChangeNoResult) {
  const Scratch plain;
  well(run_deck(chain_deck("in.chain.lammps"), {{"cycles", "1"}}, plain.path()));
  for (const std::string suffix : {"opt", "omp"}) {
    const Scratch folder;
    const Outcome outcome = run_program({std::string(DRUMLIN_SOURCE_DIR) + "/drumlin", "run",
                                         chain_deck("in.chain.lammps").string(), "-sf", suffix, "-var",
                                         "cycles", "1", "-var", "out", "."},
                                        {}, folder.path());
    if (outcome.status == 1) {
      EXPECT_TRUE(printed(outcome, "ERROR: Using suffix " + suffix + " without "));
      continue;
    }
    ASSERT_TRUE(outcome.ok()) << outcome.output;
    EXPECT_EQ(read_text(plain / "chain.csv"), read_text(folder / "chain.csv")) << suffix;
  }
}

TEST_F(InLammps, RefusesTheHistoryOfAnotherWallOnRanksOneAndTwo) {
  const WaitForRanks at_once(0);
  const Scratch block;
  well(run_deck(test_deck("bounce.lammps"), {{"walls", "block"}}, block.path()));
  for (const int ranks : {1, 2}) {
    const Scratch folder;
    EXPECT_TRUE(fails_with(
        run_deck(test_deck("bounce.resume.lammps"),
                 {{"start", (block / "first.restart").string()}, {"walls", "cylinder"}}, folder.path(),
                 ranks),
        "fix wall/gran/transition: the restart file holds another wall under the ID 'walls'; allowed: "));
  }
}

/// No dashpots and no friction: contacts without history, whose forces are those of a potential energy.
const Variables springs = {{"D", "0"}, {"tangential", "off"}, {"mu", "-1"}};

TEST_F(InLammps, ContinuesFromADataFileWithoutContactHistory) {
  const Scratch stayed, left;
  well(run_deck(test_deck("bounce.lammps"), springs, stayed.path()));
  const Variables variables = with(springs, {{"start", (stayed / "first.data").string()}});
  well(run_deck(test_deck("bounce.data.lammps"), variables, left.path()));
  std::vector<Frame> whole = read_dump(stayed / "balls.txt");
  const std::vector<Frame> rest = read_dump(left / "balls.txt");
  whole.erase(whole.begin(), whole.end() - static_cast<std::ptrdiff_t>(rest.size()));
  ASSERT_EQ(rest.size(), 7u);
  EXPECT_LT(distance(whole, rest), 1e-9);
}

// However far the ball moves in one step, the shear spring of a broken contact with a face is deleted.
TEST_F(InLammps, HistoryOfABallPutBackOnAFaceOfARegionStartsAtZero) {
  const auto force = [](const char *lifted) {
    const Scratch folder;
    well(run_deck(test_deck("lift.lammps"), {{"lifted", lifted}}, folder.path()));
    std::array<double, 2> along_and_up{};
    std::ifstream in(folder / "force.txt");
    EXPECT_TRUE(in >> along_and_up[0] >> along_and_up[1]);
    return along_and_up;
  };
  constexpr double kn = 1e5, kt = 2.0 / 7.0 * kn, overlap = 1e-4, slid = 0.1 * 50e-6;
  const std::array<double, 2> stayed = force("0"), put_back = force("0.01"), hopped = force("0.002");
  EXPECT_NEAR(std::fabs(stayed[0]), kt * slid, 0.05 * kt * slid);
  for (const std::array<double, 2> &again : {put_back, hopped}) {
    EXPECT_NEAR(again[0], 0, 1e-12);
    EXPECT_NEAR(std::fabs(again[1]), kn * overlap, 0.05 * kn * overlap);
  }
}

// A set-up computes forces from velocities of the full step, which second-order stepping would have had, too.
TEST_F(InLammps, RunSplitOrWholeIsOneUnderSecondOrderStepping) {
  for (const char *D : {"0", "0.2"}) {
    std::vector<std::vector<Frame>> frames;
    for (const auto &[first, rest] : {std::pair{"2500", "9500"}, std::pair{"10500", "1500"}}) {
      const Variables variables = with({{"D", D}, {"first", first}, {"rest", rest}}, springs);
      const Scratch folder;
      well(run_deck(test_deck("bounce.lammps"), variables, folder.path()));
      frames.push_back(read_dump(folder / "balls.txt"));
    }
    EXPECT_LT(distance(frames[0], frames[1]), std::string(D) == "0" ? 1e-9 : 1e-6) << D;
  }
}

/// Energy of the springs and of the weight in bounce.scene, J. \param pipe whether the walls are those of a
/// cylinder, not planes
double energy(const std::map<long, Ball> &balls, bool pipe) {
  constexpr double k = 1e5, density = 2500.0, gravity = 9.81;
  const auto radius = [](long id) { return 0.5 * (0.06 + 0.02 * std::sin(7.0 * static_cast<double>(id))); };
  const auto spring = [](double overlap) { return overlap > 0.0 ? 0.5 * k * overlap * overlap : 0.0; };
  double sum = 0.0;
  for (const auto &[i, one] : balls) {
    const double r = radius(i);
    const auto &[x, y, z] = one.x;
    sum += 4.0 / 3.0 * pi * r * r * r * density * gravity * z + spring(r - z);
    sum += pipe ? spring(r + std::hypot(x - 0.225, y - 0.15) - 0.15)
                : spring(r - x) + spring(x + r - 0.4) + spring(r - y) + spring(y + r - 0.3);
    for (const auto &[j, other] : balls)
      if (j < i) sum += spring(r + radius(j) - std::hypot(x - other.x[0], y - other.x[1], z - other.x[2]));
  }
  return sum;
}

TEST_F(InLammps, ForcesAreTheCentralDifferencesOfTheEnergy) {
  constexpr double h = 1e-7; // m
  for (const char *stepping : {"second", "stock"})
    for (const char *walls : {"planes", "block", "cylinder"}) {
      const bool pipe = std::string(walls) == "cylinder";
      const Scratch folder;
      const Variables variables = with(springs, {{"stepping", stepping}, {"walls", walls}});
      well(run_deck(test_deck("bounce.lammps"), variables, folder.path()));
      double largest = 0.0;
      for (const Frame &frame : read_dump(folder / "balls.txt"))
        for (const auto &[id, ball] : frame.balls)
          for (std::size_t axis = 0; axis < 3; ++axis) {
            std::map<long, Ball> moved = frame.balls;
            moved.at(id).x[axis] = ball.x[axis] + h;
            const double above = energy(moved, pipe);
            moved.at(id).x[axis] = ball.x[axis] - h;
            const double force = -(above - energy(moved, pipe)) / (2.0 * h);
            EXPECT_NEAR(ball.f[axis], force, 1e-3) // N
                << stepping << ", " << walls << ", step " << frame.step << ", ball " << id;
            largest = std::max(largest, std::fabs(force));
          }
      EXPECT_GT(largest, 50.0);
    }
}

// Without dashpots no force jumps, so that second-order steps add no impulse to it. compute pair/local has no
// contacts with walls.
TEST_F(InLammps, ContactsOfADumpExplainTheForcesOnBallsOnRanksOneAndTwo) {
  for (const auto &[ranks, newton] : {std::pair{1, "off"}, {2, "off"}, {1, "on"}, {2, "on"}}) {
    const Scratch folder;
    well(run_deck(test_deck("bounce.lammps"), {{"D", "0"}, {"dump_every", "500"}, {"newton", newton}},
                  folder.path(), ranks));
    std::array<std::size_t, 2> judged{};
    const std::map<long, post::StepDump> steps = post::dumped_steps(folder / "dump");
    EXPECT_EQ(steps.size(), 25u);
    for (const auto &[step, files] : steps) {
      const std::vector<post::Ball> balls = post::read_ball_dump(files.balls); // IDs from 1 on
      const post::BedContacts contacts = post::read_contact_dump(files.contacts, balls);
      std::vector<post::Vector> weightless;
      weightless.reserve(balls.size());
      for (const post::Ball &ball : balls)
        weightless.push_back({ball.force[0], ball.force[1], ball.force[2] + 9.81 * ball.mass});
      std::array<std::vector<post::Vector>, 2> rest{
          weightless, weightless}; // by fix contact/local, by compute pair/local
      const auto pair = [](std::vector<post::Vector> &forces, std::size_t i, std::size_t j,
                           const post::Vector &force) {
        for (std::size_t a = 0; a < 3; ++a) {
          forces[i][a] -= force[a];
          forces[j][a] += force[a];
        }
      };
      std::vector<bool> touches(balls.size(), false), at_wall(balls.size(), false);
      for (const post::BallContact &contact : contacts.balls) {
        pair(rest[0], contact.i, contact.j, contact.force);
        touches[contact.i] = touches[contact.j] = true;
      }
      for (const post::WallContact &contact : contacts.walls) {
        for (std::size_t a = 0; a < 3; ++a)
          rest[0][contact.i][a] -= contact.force[a];
        at_wall[contact.i] = true;
      }
      const post::TextDump own =
          post::read_text_dump(folder.path() / "dump" / ("own_" + std::to_string(step) + ".dump"));
      EXPECT_EQ(own.rows.size(), contacts.balls.size());
      for (const std::vector<double> &row : own.rows)
        pair(rest[1], static_cast<std::size_t>(row[0]) - 1, static_cast<std::size_t>(row[1]) - 1,
             {row[2] + row[5], row[3] + row[6], row[4] + row[7]});
      for (std::size_t n = 0; n < balls.size(); ++n)
        for (std::size_t source = 0; source < 2; ++source) {
          if (source == 0 ? !touches[n] && !at_wall[n] : !touches[n] || at_wall[n]) continue;
          ++judged.at(source);
          EXPECT_LT(std::hypot(rest.at(source)[n][0], rest.at(source)[n][1], rest.at(source)[n][2]),
                    1e-6) // N
              << "ball " << balls[n].id << ", step " << step << ", ranks " << ranks << ", newton " << newton
              << (source == 0 ? ", fix contact/local" : ", compute pair/local");
        }
    }
    EXPECT_GT(judged[0], 50u);
    EXPECT_GT(judged[1], 20u);
  }
}

TEST_F(InLammps, AnImpactConvergesToTheClosedForm) {
  for (const post::Transition transition : {post::Transition::A, post::Transition::B}) {
    post::ImpactParameters p;
    p.transition = transition;
    p.speed = 0.5;
    const double exact = -post::impact_state(p, post::impact_duration(p)).rate;
    for (const char *count : {"100", "400", "1600"}) {
      const Scratch folder;
      well(run_deck(chain_deck("in.impact.lammps"),
                    {{"transition", post::transition_name(transition)},
                     {"D", number(p.damping_ratio)},
                     {"steps_per_contact", count},
                     {"samples", "100"}},
                    folder.path()));
      const double error = std::fabs(read_run(folder.path()).history.v_drum.back() - exact);
      EXPECT_LT(error, p.speed / (std::stod(count) * std::stod(count))) // of second order
          << post::transition_name(transition) << ", " << count << " steps";
    }
  }
}

// Contacts use the mass of the body. Oracles: restitution by the closed form, momentum, and LAMMPS's own law,
// which steps as `stock` does.
TEST_F(InLammps, RigidBodyBouncesWithItsMassOnRanksOneAndTwo) {
  constexpr double M = 2.0 + 3.0, m = 4.0, v = -0.5, D = 0.3, k = 1e5;
  post::ImpactParameters impact;
  impact.damping_ratio = D;
  const double restitution = -post::impact_state(impact, post::impact_duration(impact)).rate / impact.speed;
  for (const std::string target : {"ball", "floor"}) {
    const double m_eff = target == "ball" ? M * m / (M + m) : M;
    // Contacts end with a relative velocity of -restitution of that before; a floor has any momentum.
    const double body = target == "ball" ? (M - restitution * m) / (M + m) * v : -restitution * v;
    const double ball = target == "ball" ? M / (M + m) * (1.0 + restitution) * v : 0.0;
    for (const auto &[rigid, ranks] : {std::pair{"rigid", 1},
                                       {"rigid", 2},
                                       {"rigid/nve", 1},
                                       {"small", 1},
                                       {"small", 2},
                                       {"nve/small", 1}}) {
      const auto velocities = [&, rigid = rigid, ranks = ranks](const Variables &law) {
        const Scratch folder;
        const Variables variables = with(law, {{"target", target}, {"rigid", rigid}, {"D", number(D)}});
        well(run_deck(test_deck("dumbbell.lammps"), variables, folder.path(), ranks));
        std::vector<double> values(3);
        std::ifstream in(folder / "velocities.txt");
        for (double &value : values)
          in >> value;
        return values;
      };
      const std::vector<double> found = velocities({});
      const std::string where = target + ", " + rigid + ", ranks " + std::to_string(ranks);
      EXPECT_NEAR(found[0], body, 1e-3 * std::fabs(v)) << where;
      EXPECT_NEAR(found[1], body, 1e-3 * std::fabs(v)) << where;
      EXPECT_NEAR(found[2], ball, 1e-3 * std::fabs(v)) << where;
      const std::vector<double> own = velocities({{"gamma", number(2.0 * D * std::sqrt(k / m_eff))}});
      for (std::size_t n = 0; n < 3; ++n)
        EXPECT_NEAR(found[n], own[n], 1e-9) << where << ", ball " << n + 1; // m/s
    }
  }
}

} // namespace
} // namespace drumlin::test
