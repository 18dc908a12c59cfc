// `drumlin calibrate` as a user meets it: bad input is refused before any run, and leaves no file.
#include "calibration/task.h"
#include "support/files.h"
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

TEST(CalibrateCommand, RefusesBadInputInOneLine) {
  struct Bad {
    std::vector<std::string> words; ///< instead of those that would be allowed
    std::string message;
  };
  const std::vector<std::string> targets = {"--target", "k=20e6", "--target", "D=0.2"},
                                 vary = {"--vary", "k=1e8:1e10"};
  const auto with = [&](std::vector<std::string> words) {
    words.insert(words.begin(), vary.begin(), vary.end());
    words.insert(words.begin(), targets.begin(), targets.end());
    return words;
  };
  const std::vector<Bad> rows = {
      {vary, "--target is ''; allowed: one or more targets"},
      {targets, "--vary is ''; allowed: one or more parameters"},
      {with({"--target", "modulus=1e6"}), "--target is 'modulus=1e6'; allowed: NAME=VALUE"},
      {with({"--target", "E_v1"}), "--target is 'E_v1'; allowed: NAME=VALUE"},
      {with({"--target", "E_v1=none"}), "--target is 'E_v1=none'; allowed: for 'none': a number"},
      {with({"--target", "E_v1=-1e6"}), "--target is 'E_v1=-1e6'; allowed: for '-1e6': a number"},
      {with({"--target", "E_v1=1e7:0"}), "--target is 'E_v1=1e7:0'; allowed: for '0': a number"},
      {with({"--target", "k=30e6"}), "--target is 'k'; allowed: each name once"},
      {with({"--target", "E_v1=40e6", "--target", "E_v2=20e6"}),
       "--target E_v2 is '20000000'; allowed: no less than E_v1"},
      {with({"--target", "force=2e4"}),
       "--target force is '20000'; allowed: at least 29430 N/m, the weight of the roller"},
      {with({"--target", "force=5e4", "--target", "contact=0.5"}),
       "--target force is '50000'; allowed: at least 58860 N/m, the weight of the roller divided by the "
       "share"},
      {with({"--target", "force=1e4", "--set", "m2=1500"}),
       "--target force is '10000'; allowed: at least 24525 N/m, the weight of the roller"},
      {with({"--vary", "mass=1:2"}), "--vary is 'mass=1:2'; allowed: NAME=LOW:HIGH"},
      {with({"--vary", "D=0.2"}), "--vary is 'D=0.2'; allowed: NAME=LOW:HIGH"},
      {with({"--vary", "D=0.2:0.2"}), "--vary is 'D=0.2:0.2'; allowed: HIGH at least 1.05 times LOW"},
      {with({"--vary", "D=0.4:0.2"}), "--vary is 'D=0.4:0.2'; allowed: HIGH at least 1.05 times LOW"},
      {with({"--vary", "D=0:0.2"}), "--vary is 'D=0:0.2'; allowed: for '0': a number"},
      {with({"--vary", "k=1e8:1e9"}), "--vary is 'k'; allowed: each name once"},
      {with({"--vary", "D=0.1:0.4", "--vary", "friction=0.2:1"}),
       "--vary is 'k, D, friction'; allowed: at most as many parameters as targets, 2: more cannot be "
       "identified"},
      {with({"--set", "g=9.81"}), "--set is 'g=9.81'; allowed: NAME=VALUE"},
      {with({"--set", "k=1e9"}), "--set is 'k'; allowed: a variable that --vary does not name"},
      {with({"--set", "frequency=fast"}), "--set is 'frequency=fast'; allowed: for 'fast': a number"},
      {with({"--set", "frequency=20", "--set", "omega=120"}), "--set is 'omega'; allowed: each name once"},
      {with({"--set", "r2=0.7"}), "--balls is '1000'; allowed: at least 1226: the drum has a diameter of 1.4 "
                                  "m, the box a width of 1.26 m"},
      {with({"--roller", "nowhere"}), "--roller is 'nowhere'; allowed: a file that can be read"},
      {with({"--roller", "mine", "--setting", "high"}), "--setting is 'high'; allowed: none, of 'mine'"},
      {with({"--setting", "high"}), "--setting is 'high'; allowed: only with --roller"},
      {with({"--roller", "narrow"}), "--roller is 'narrow'; allowed: a file with the width of the drum, "
                                     "since a bed has the roller per metre"},
      {with({"--roller", "flat"}),
       "--roller is 'flat'; allowed: a file with the diameter of the drum, or its radius by --set r2="},
      {with({"--roller", "mine"}),
       "--balls is '1000'; allowed: at least 1408: the drum has a diameter of 1.5 m"},
      // The load of 7000 kg on 2 m is 34335 N/m; with half of the drum's mass by --set 24525 N/m.
      {with({"--roller", "mine", "--balls", "1500", "--target", "force=3e4"}),
       "--target force is '30000'; allowed: at least 34335 N/m, the weight of the roller"},
      {with({"--roller", "flat", "--set", "r2=0.4", "--set", "m2=1000", "--target", "force=2e4"}),
       "--target force is '20000'; allowed: at least 24525 N/m, the weight of the roller"},
      {with({"--set", "m2=heavy"}), "--set is 'm2=heavy'; allowed: for 'heavy': a number"},
      {with({"--seeds", "1"}), "--seeds is '1'; allowed: a whole number from 2"},
      {with({"--balls", "5"}), "--balls is '5'; allowed: a whole number from 50"},
      {with({"--cycles", "1"}), "--cycles is '1'; allowed: a whole number from 4"},
      {with({"--evaluations", "0"}), "--evaluations is '0'; allowed: a whole number from 1"},
      {with({"--jobs", "0"}), "--jobs is '0'; allowed: a whole number from 1"},
      {with({"--target-beds", "-1"}), "--target-beds is '-1'; allowed: a whole number from 0"},
      {with({"--name", "a/b"}), "--name is 'a/b'; allowed: letters"},
      {with({"--name", "gravel"}), "--name is 'gravel'; allowed: letters"},
      {with({"--out", "a b"}), "--out is 'a b'; allowed: a path without spaces"}};
  const Scratch scratch;
  const std::string machine = "drum_mass 4 t\nframe_mass 3 t\nfrequency 30 Hz\nforce 250 kN\n";
  post::write_files({{scratch / "mine", "width 2 m\ndiameter 1.5 m\n" + machine},
                     {scratch / "flat", "width 2 m\n" + machine},
                     {scratch / "narrow", machine}});
  for (const Bad &row : rows) {
    std::vector<std::string> words = {DRUMLIN_TOOLS, "calibrate"};
    words.insert(words.end(), row.words.begin(), row.words.end());
    const Outcome outcome = run_program(words, {}, scratch.path(), 20.0);
    EXPECT_EQ(outcome.status, 2) << row.message;
    EXPECT_TRUE(printed(outcome, "ERROR: drumlin calibrate: " + row.message));
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    EXPECT_FALSE(fs::exists(scratch / "results"));
  }
}

// The settings of a calibration whose engine cannot be started: masses, bond and force are divided by the
// width of the drum, 2 m. Computed by hand: a force of 250 kN at 30 Hz is one of 302.5 kN at 33 Hz; k23 =
// 1500 kg (2 pi 4.82 Hz)^2.
TEST(CalibrateCommand, GivesABedTheRollerPerMetre) {
  const Scratch scratch;
  post::write_files(
      {{scratch / "mine", "width 2 m\ndiameter 1.5 m\ndrum_mass 4 t\nframe_mass 3 t\n"
                          "frequency 30 Hz\nforce 250 kN\n"},
       {scratch / "places", "inputs=" DRUMLIN_SOURCE_DIR "/inputs\nliggghts_plugin=" DRUMLIN_TOOLS
                            "\nliggghts=/no/engine\n"}}); // the plugin: any file
  const Outcome outcome =
      run_program({DRUMLIN_TOOLS, "calibrate", "--target", "k=20e6", "--vary", "k=1e8:1e10", "--roller",
                   "mine", "--balls", "1500", "--set", "frequency=33", "--set", "c23=7", "--out", "out"},
                  {"DRUMLIN_PLACES=" + (scratch / "places").string()}, scratch.path(), 20.0);
  EXPECT_TRUE(
      printed(outcome, {"exciter force per metre 125 kN/m\n", "the engine '/no/engine' cannot be run"}));
  const std::string settings = post::read_text(scratch / "out/study.txt");
  const auto set = [&settings](const std::string &name) {
    std::smatch match;
    const bool found = std::regex_search(settings, match, std::regex("\nset " + name + ",([^\n]+)\n"));
    return found ? std::stod(match[1]) : std::nan("");
  };
  EXPECT_EQ(set("m2"), 2000.0);
  EXPECT_EQ(set("m3"), 1500.0);
  EXPECT_EQ(set("r2"), 0.75);
  EXPECT_EQ(set("c23"), 7.0);
  EXPECT_NEAR(set("k23"), 1375767.6, 0.1);
  EXPECT_NEAR(set("omega"), 207.3451151, 1e-6);
  EXPECT_NEAR(set("Fw"), 151250.0, 1e-6);
}

TEST(CalibrateCommand, KnowsTheMassesOfTheGravelsRoller) {
  const std::string deck = post::read_text(fs::path(DRUMLIN_SOURCE_DIR) / "inputs/bed/variables");
  for (const auto &[name, mass] : {std::pair{"m2", post::gravel_drum}, std::pair{"m3", post::gravel_frame}}) {
    std::smatch match;
    ASSERT_TRUE(std::regex_search(deck, match, std::regex(fmt::format("\n{} +([0-9.e]+)", name))));
    EXPECT_EQ(std::stod(match[1]), mass) << name;
  }
}

} // namespace
} // namespace drumlin::test
