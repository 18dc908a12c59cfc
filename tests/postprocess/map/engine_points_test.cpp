// Points of a map at which an engine runs the chain: how they are spread, how a regime is taken from a
// run, and the command as a user runs it, against the closed-form solution.
#include "map/engine_points.h"
#include "support/csv.h"
#include "support/files.h"
#include "support/process.h"
#include "tests/support/page.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace {

using namespace drumlin::post;
namespace fs = std::filesystem;

MapGrid grid_of(int columns, int rows) {
  MapGrid grid;
  grid.chain.base = table1_case("II", Transition::B);
  grid.x = axis_from_text("--x", "k:5e6:40e6:" + std::to_string(columns), 100);
  grid.y = axis_from_text("--y", "D:0.1:0.5:" + std::to_string(rows), 100);
  return grid;
}

TEST(EnginePoints, EachQuarterOfAMapHasItsShare) {
  const MapGrid grid = grid_of(40, 30);
  std::array<int, 4> quarters{};
  for (const std::size_t point : spread_points(grid, 40))
    ++quarters[(point % 40 < 20 ? 0U : 1U) + (point / 40 < 15 ? 0U : 2U)];
  for (const int count : quarters)
    EXPECT_NEAR(count, 10, 2);
}

TEST(EnginePoints, MoreBeginWithTheSameAndNoneIsThereTwice) {
  const MapGrid grid = grid_of(7, 5);
  const std::vector<std::size_t> few = spread_points(grid, 6);
  const std::vector<std::size_t> all = spread_points(grid, 1000);
  EXPECT_EQ(all.size(), grid.size());
  EXPECT_EQ(std::set<std::size_t>(all.begin(), all.end()).size(), grid.size());
  EXPECT_TRUE(std::equal(few.begin(), few.end(), all.begin()));
}

TEST(EnginePoints, ARegimeIsTakenFromTheStatesOfARun) {
  const ChainState scale(1.0, 1.0, 1.0, 1.0);
  const auto run = [&](const auto &value) {
    std::vector<ChainState> states;
    for (int i = 0; i <= 100; ++i)
      states.emplace_back(value(i), 0.0, 0.0, 0.0);
    return regime_of_run(states, false, scale);
  };
  EXPECT_EQ(regime_of_run({}, true, scale), Regime::continuous_contact);
  EXPECT_EQ(regime_of_run({}, false, scale), Regime::undecided);
  EXPECT_EQ(run([](int) { return 0.3; }), Regime::partial_uplift);
  EXPECT_EQ(run([](int i) { return i % 2; }), Regime::period_2);
  EXPECT_EQ(run([](int i) { return i % 5; }), Regime::higher_period);
  EXPECT_EQ(run([](int i) { return std::fmod(0.618034 * i, 1.0); }), Regime::aperiodic);
  EXPECT_EQ(run([](int i) { return std::pow(-0.97, i); }), Regime::undecided);
}

TEST(EnginePoints, StepsResolveTheContact) {
  ChainParameters p = table1_case("II", Transition::B);
  EXPECT_EQ(engine_steps(p), 2000);
  p.omega = 1.0;
  EXPECT_EQ(engine_steps(p), static_cast<int>(std::ceil(p.period() * std::sqrt(p.k / p.m2) / 0.02)));
}

class EngineMap : public testing::Test {
protected:
  fs::path folder() const { return holder_.path(); }
  Outcome map(std::vector<std::string> more) const {
    std::vector<std::string> words = {DRUMLIN_TOOLS, "map",      "--x", "k:5e6:40e6:5", "--y",
                                      "D:0.4:0.6:3", "--cycles", "100", "--out",        "m"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words, {}, folder(), 120.0);
  }
  fs::path file() const { return folder() / "m/engine_points_liggghts.csv"; }

private:
  TemporaryFolder holder_{fs::temp_directory_path(), "drumlin-engine-map-test-"};
};

TEST_F(EngineMap, RunsAgreeWithTheMapAndAreContinued) {
  const Outcome outcome = map({"--engine", "liggghts", "--engine-points", "3"});
  ASSERT_TRUE(outcome.ok()) << outcome.output;
  EXPECT_TRUE(outcome.says("3 of 3 runs of the engine have the regime of the map")) << outcome.output;
  const std::string first = read_text(file());
  const Table table = read_table(file());
  ASSERT_EQ(table.rows(), 3U);
  for (const double difference : table.numbers("difference_of_peak_force [-]"))
    EXPECT_LT(std::fabs(difference), 1e-4);
  EXPECT_TRUE(fs::is_regular_file(folder() / "m/plot_engine.csv"));
  EXPECT_NE(read_text(folder() / "m/regimes.gp").find("plot_engine.csv"), std::string::npos);
  drumlin::test::expect_sound_page(folder() / "m", 5);
  // Cut off in the third row: two runs stay, the third is done again, and one more follows.
  write_files({{file(), first.substr(0, first.size() - 20)}});
  const Outcome again = map({"--engine", "liggghts", "--engine-points", "4"});
  ASSERT_TRUE(again.ok()) << again.output;
  EXPECT_EQ(read_text(file()).substr(0, first.size()), first);
  EXPECT_EQ(read_table(file()).rows(), 4U);
}

TEST_F(EngineMap, BadInputEndsInOneLine) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> bad = {
      {{"--engine", "yade"}, "--engine is 'yade'; allowed: liggghts, lammps"},
      {{"--engine-points", "3"}, "--engine-points is '3'; allowed: only with --engine"},
      {{"--engine", "liggghts", "--engine-points", "0"},
       "--engine-points is '0'; allowed: a whole number from 1 to"},
      {{"--engine", "liggghts", "--omega", "0.1"},
       "--engine is 'liggghts'; allowed: a map whose runs have at most"}};
  for (const auto &[words, message] : bad) {
    const Outcome outcome = map(words);
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_TRUE(outcome.says("ERROR: drumlin map: " + message)) << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
  }
  EXPECT_FALSE(fs::exists(folder() / "m"));
}

} // namespace
