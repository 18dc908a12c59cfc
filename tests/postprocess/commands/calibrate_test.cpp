// `drumlin calibrate` as a user meets it: bad input is refused before any run, and leaves no file.
#include "calibration/task.h"
#include "support/files.h"
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
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

TEST(CalibrateCommand, KnowsTheMassesOfTheGravelsRoller) {
  const std::string deck = post::read_text(fs::path(DRUMLIN_SOURCE_DIR) / "inputs/bed/case.gravel");
  for (const auto &[name, mass] : {std::pair{"m2", post::gravel_drum}, std::pair{"m3", post::gravel_frame}}) {
    std::smatch match;
    ASSERT_TRUE(
        std::regex_search(deck, match, std::regex(fmt::format("variable {} +index ([0-9.e]+)", name))));
    EXPECT_EQ(std::stod(match[1]), mass) << name;
  }
}

} // namespace
} // namespace drumlin::test
