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

// The settings that a calibration writes before it starts an engine, which this test does not have: masses,
// bond and force are divided by the width of the drum, 2 m. Computed by hand: a force of 250 kN at 30 Hz is
// one of 302.5 kN at 33 Hz; k23 = 1500 kg (2 pi 4.82 Hz)^2.
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
