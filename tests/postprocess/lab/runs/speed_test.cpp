// `drumlin study speed --quick`: every law runs on one rank and on two, ends with the balls at the same
// positions, and nothing is measured twice. Times are not judged.
#include "engine/engine_run.h"
#include "lab/speed/results.h"
#include "tests/support/page.h"
#include "tests/support/scratch_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

TEST(SpeedStudy, ContinuesWhereItWasInterrupted) {
  const ScratchStudy study("speed");
  const post::Outcome whole = study.run();
  ASSERT_TRUE(whole.ok()) << whole.output;
  const fs::path rows = study.out() / "runs.csv";
  const std::vector<post::SpeedRun> runs = post::read_speed_runs(rows);
  ASSERT_EQ(runs.size(),
            post::has_lammps() ? 36u : 18u); // three scenes, three laws of each engine, one rank and two
  for (const post::SpeedRun &run : runs)
    EXPECT_GT(run.peak_bytes, 1e6) << run.scene << ", " << run.law; // no process of the engine is smaller
  const fs::path bed = made_file(study.out(), "bed_288_", ".data");
  const auto copies = fs::last_write_time(bed);

  interrupt(rows);
  fs::remove(study.out() / "index.html");
  const post::Outcome rest = study.run();
  ASSERT_TRUE(rest.ok()) << rest.output;
  EXPECT_EQ(fs::last_write_time(bed), copies) << "the copies are made once";
  const std::vector<post::SpeedRun> again = post::read_speed_runs(rows);
  ASSERT_EQ(again.size(), runs.size());
  for (const post::SpeedRun &run : runs) {
    const auto same = [&run](const post::SpeedRun &other) {
      return other.scene == run.scene && other.law == run.law && other.ranks == run.ranks;
    };
    EXPECT_EQ(std::count_if(again.begin(), again.end(), same), 1) << run.scene << ", " << run.law;
  }
  expect_sound_page(study.out(), 1);
}

} // namespace
} // namespace drumlin::test
