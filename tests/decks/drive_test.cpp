// in.drive on a small bed: the roller comes to where its way says, its work balances, and the run is the same
// on any number of ranks, in pieces and in both engines.
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"

#include "bed/dump_readers.h"
#include "engine/engine_command.h"
#include "support/csv.h"
#include "support/process.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

fs::path bed_folder() { return fs::path(DRUMLIN_SOURCE_DIR) / "inputs/bed"; }

/// 250 balls in a box of 1 m, a roller of 150 kg and 0.1 m at its left, settled once for all tests.
class BedDriven : public ::testing::Test {
protected:
  const WaitForRanks at_once{0};

  static void SetUpTestSuite() {
    well(run_program({DRUMLIN_TOOLS, "bed", "--balls", "250", "--width", "1", "--out", "balls.data"}, {},
                     scratch().path()));
    well(run_deck(bed_folder() / "in.settle",
                  {{"case", "loose"}, {"balls", "balls.data"}, {"bed", "soil.restart"}}, scratch().path()));
    well(run_deck(bed_folder() / "in.place",
                  {{"bed", "soil.restart"},
                   {"start", "roller.restart"},
                   {"place", "-0.2"},
                   {"m2", "100"},
                   {"m3", "50"},
                   {"r2", "0.1"},
                   {"r3", "0.05"},
                   {"k23", "5e4"},
                   {"c23", "500"}},
                  scratch().path()));
  }
  static void TearDownTestSuite() { scratch(nullptr); }

  /// Two passes of 0.2 m at 2 m/s, 50 Hz in steps as long as those of the decks.
  static Outcome drive(const Scratch &folder, const Variables &more, int ranks = 1,
                       const char *deck = "in.drive") {
    return run_deck(bed_folder() / deck, scene(folder, more), folder.path(), ranks);
  }
  static Variables scene(const Scratch &folder, const Variables &more) {
    return with(more, {{"speed", "2"},
                       {"ramp", "0.05"},
                       {"length", "0.2"},
                       {"margin", "0.05"},
                       {"omega", "314.1592653589793"},
                       {"Fw", "2940"},
                       {"steps_per_cycle", "1000"},
                       {"samples_per_cycle", "100"},
                       {"out", folder.path().string()},
                       {"start", (scratch().path() / "roller.restart").string()}});
  }

  static Scratch &scratch() {
    if (!*held()) *held() = std::make_unique<Scratch>();
    return **held();
  }
  static void scratch(std::nullptr_t) { held()->reset(); }

private:
  static std::unique_ptr<Scratch> *held() {
    static std::unique_ptr<Scratch> one;
    return &one;
  }
};

double place_of_drum(const fs::path &dump) {
  for (const post::Ball &ball : post::read_ball_dump(dump))
    if (ball.type == post::drum_type) return ball.position[0];
  return NAN;
}

// The dumps behind the passes have the drum at the ends of its way; the works of exciter, traction and torque
// are what the bed stores and loses.
TEST_F(BedDriven, ComesToTheEndsOfItsWayAndItsWorkBalances) {
  const std::array<std::pair<const char *, const char *>, 4> scenes = {
      {{"driven", "rigid"}, {"towed", "rigid"}, {"none", "rigid"}, {"driven", "absorb"}}};
  for (const auto &[rotation, boundary] : scenes) {
    const Scratch folder;
    std::ofstream(folder / "passes.csv") << "of an earlier run\n";
    well(drive(folder, {{"drum_rotation", rotation}, {"boundary", boundary}, {"steps_per_cycle", "2000"}}));
    EXPECT_FALSE(fs::exists(folder / "passes.csv"));
    const std::map<long, post::StepDump> dumps = post::dumped_steps(folder / "dump");
    ASSERT_EQ(dumps.size(), 3U);
    std::vector<double> places;
    places.reserve(dumps.size());
    for (const auto &[step, files] : dumps)
      places.push_back(place_of_drum(files.balls));
    EXPECT_NEAR(places[0], -0.2, 1e-8);
    EXPECT_NEAR(places[1], 0.0, 1e-8);
    EXPECT_NEAR(places[2], -0.2, 1e-8);
    const post::Table rows = post::read_table(folder / "bed.csv");
    const auto change = [&rows](const char *column) {
      const std::vector<double> values = rows.numbers(column);
      return values.back() - values.front();
    };
    double given = 0.0;
    for (const char *work : {"work_excitation", "work_traction", "work_torque"})
      given += change(work);
    double kept = 0.0;
    for (const char *energy : {"kinetic", "potential", "elastic", "dissipated"})
      kept += change(energy);
    EXPECT_NEAR(kept, given, 1e-3 * given) << rotation << " " << boundary;
    EXPECT_GT(std::fabs(change("work_traction")), 0.01 * given) << rotation << " " << boundary;
    const std::vector<double> s = rows.numbers("s"), pass = rows.numbers("pass");
    EXPECT_EQ(pass.front(), 1.0);
    EXPECT_EQ(pass.back(), 2.0);
    EXPECT_NEAR(*std::max_element(s.begin(), s.end()), 0.0, 1e-12);
    // The exciter is off while the roller stands.
    EXPECT_EQ(rows.numbers("F_excitation").back(), 0.0);
  }
}

TEST_F(BedDriven, ContinuesWhereALimitOfTimeStoppedItOnRanksOneAndTwo) {
  for (const int ranks : {1, 2}) {
    const Scratch stayed, left;
    well(drive(stayed, {}, ranks));
    well(drive(left, {{"time_limit", "1e-3"}}, ranks));
    EXPECT_EQ(post::read_table(left / "bed.csv").rows(), 101U); // a cycle
    well(drive(left, {{"start", (left / "stopped.restart").string()}}, ranks));
    for (const char *file : {"bed.csv", "cycles.csv", "events.csv"})
      EXPECT_EQ(read_text(left / file), read_text(stayed / file)) << file << ", ranks " << ranks;
  }
}

// Ctrl-C in the third pass or later: ./drumlin passes shows those before.
TEST_F(BedDriven, KeepsTheFinishedPassesWhenCtrlCStopsItInOne) {
  const Scratch folder;
  std::vector<std::string> words = {"-log", "none"};
  for (const auto &[name, value] : scene(folder, {{"length", "0.4"}, {"passes", "40"}}))
    words.insert(words.end(), {"-var", name, value});
  const post::EngineCommand command = post::engine_command(bed_folder() / "in.drive", words, 1);
  post::Program program;
  program.words = command.words;
  program.environment = command.environment;
  program.folder = folder.path();
  program.output = folder / post::program_output_file;
  program.limit = 200.0;
  program.stop_signal = SIGINT;
  program.stop_when = [&](pid_t) { return post::dumped_steps(folder / "dump").size() >= 3U; };
  const Outcome stopped = post::run_program(program);
  EXPECT_TRUE(fails_with(stopped, "ERROR: drumlin/run: stopped by a signal at step "));
  const Outcome outcome =
      run_program({DRUMLIN_TOOLS, "passes", folder.path().string(), "--cell", "0.16"}, {}, folder.path());
  well(outcome);
  const std::size_t kept = post::read_table(folder / "passes.csv").rows() - 1U;
  EXPECT_GE(kept, 2U);
  EXPECT_LT(kept, 40U);
  EXPECT_TRUE(printed(outcome, "Pass " + std::to_string(kept + 1) +
                                   " is not finished and is left out: the run was stopped in it."));
}

TEST_F(BedDriven, GoesTheSameWayOnRanksOneTwoAndFour) {
  const Scratch one;
  well(drive(one, {{"time_limit", "1e-3"}})); // a cycle, 1000 steps
  const post::Table alone = post::read_table(one / "bed.csv");
  for (const int ranks : {2, 4}) {
    const Scratch folder;
    well(drive(folder, {{"time_limit", "1e-3"}}, ranks));
    const post::Table together = post::read_table(folder / "bed.csv");
    for (const char *column : {"x_drum", "s"}) {
      const std::vector<double> a = alone.numbers(column), b = together.numbers(column);
      ASSERT_EQ(a.size(), 101U);
      ASSERT_EQ(b.size(), 101U);
      for (std::size_t n = 0; n <= 100; ++n)
        EXPECT_NEAR(a[n], b[n], 1e-10) << column << ", row " << n << ", ranks " << ranks;
    }
  }
}

// From the data file bed and roller first come to rest again, so that only the way is the same.
TEST_F(BedDriven, DrivesInLammps) {
  if (!post::has_lammps()) GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  const Scratch here, there;
  well(drive(here, {{"passes", "1"}}));
  well(drive(there, {{"passes", "1"}}, 1, "in.drive.lammps"));
  const post::Table a = post::read_table(here / "bed.csv"), b = post::read_table(there / "bed.csv");
  EXPECT_EQ(a.header(), b.header());
  EXPECT_EQ(a.numbers("s"), b.numbers("s"));
  EXPECT_NEAR(place_of_drum(post::dumped_steps(there / "dump").rbegin()->second.balls), 0.0, 1e-8);
}

TEST_F(BedDriven, RefusesAWayThatItCannotDrive) {
  const Scratch folder;
  const auto refused = [&](const Variables &more, const char *line) {
    EXPECT_TRUE(fails_with(drive(folder, more), line));
    EXPECT_FALSE(fs::exists(folder / "bed.csv")) << line;
  };
  refused({{"passes", "0"}}, "ERROR: drumlin/variable: variable passes is '0'; allowed: ");
  refused({{"length", "0.09"}}, "ERROR: drumlin/variable: variable length is '0.09'; allowed: a finite "
                                "number above 0.1, so that it is longer "
                                "than both ramps");
  refused({{"length", "0.7"}},
          "ERROR: drumlin/check: variable length is '0.7'; allowed: a finite number below 0.6, ");
  refused({{"margin", "0.1"}}, "ERROR: drumlin/variable: variable margin is '0.1'; allowed: ");
  refused({{"drum_rotation", "free"}}, "variable drum_rotation is 'free'; allowed: ");
  refused({{"speed", "-1"}}, "variable speed is '-1'; allowed: ");
  refused({{"dumps_per_pass", "7"}}, "variable steps_per_cycle is '1000'; allowed: ");
  refused({{"dumps_per_cycle", "10"}},
          "variable dumps_per_cycle is '10'; allowed: a finite number at most 0, ");
  refused({{"cycles", "3"}},
          "ERROR: drumlin/variables: -var cycles is '3', a variable that this deck does not have; allowed: ");
  EXPECT_TRUE(
      fails_with(run_deck(bed_folder() / "in.place",
                          {{"bed", (scratch() / "soil.restart").string()},
                           {"start", "x.restart"},
                           {"place", "0.41"},
                           {"r2", "0.1"}},
                          folder.path()),
                 "ERROR: drumlin/check: variable place is '0.41'; allowed: a finite number below 0.4, "));
}

} // namespace
} // namespace drumlin::test
