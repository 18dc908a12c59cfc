// `drumlin study box --quick`: every run on every seed, and an interrupted call makes no bed and no run twice.
#include "studies/box/results.h"
#include "support/files.h"
#include "tests/support/page.h"
#include "tests/support/scratch_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

TEST(BoxStudy, ContinuesWhereItWasInterrupted) {
  const ScratchStudy study("box");
  const post::Outcome whole = study.run();
  ASSERT_TRUE(whole.ok()) << whole.output;
  EXPECT_TRUE(whole.says("settling bed box_1_1, seed 1\n")) << whole.output;
  EXPECT_TRUE(whole.says("placing the roller on bed box_2_1, seed 2\n")) << whole.output;
  const fs::path rows = study.out() / "runs.csv";
  const std::vector<post::BoxRun> runs = post::read_points(rows, post::box_runs());
  ASSERT_EQ(runs.size(), 6u);
  for (const post::BoxRun &run : runs) {
    EXPECT_EQ(run.boundary, run.run == "default absorb" ? "absorb" : "rigid");
    EXPECT_EQ(run.width, run.run == "width 2 rigid" ? 2 : 1);
    EXPECT_EQ(run.depth, 1);
    EXPECT_GT(run.values[0], 150.0 * 9.81) << run.run; // the peak force exceeds the weight
  }
  const auto of = [&runs](const char *name) {
    return std::find_if(runs.begin(), runs.end(), [name](const auto &run) { return run.run == name; });
  };
  EXPECT_NE(of("default absorb")->values[0], of("default rigid")->values[0]);
  const fs::path wide = made_file(study.out() / "beds", "box_2_1_2_", ".restart");
  const auto placed = fs::last_write_time(wide);

  interrupt(rows);
  fs::remove(study.out() / "index.html");
  const post::Outcome rest = study.run();
  ASSERT_TRUE(rest.ok()) << rest.output;
  EXPECT_EQ(fs::last_write_time(wide), placed);
  const std::vector<post::BoxRun> again = post::read_points(rows, post::box_runs());
  ASSERT_EQ(again.size(), runs.size());
  for (const post::BoxRun &run : runs)
    EXPECT_EQ(std::count_if(again.begin(), again.end(),
                            [&run](const post::BoxRun &other) {
                              return other.run == run.run && other.seed == run.seed &&
                                     other.values[0] == run.values[0];
                            }),
              1)
        << run.run << ", seed " << run.seed;
  expect_sound_page(study.out(), 2);
}

} // namespace
} // namespace drumlin::test
