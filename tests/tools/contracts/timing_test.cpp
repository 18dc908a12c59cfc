// `drumlin study timing --quick`: every variant runs, each law on one rank and on two, those that compute the
// same end with the balls at the same positions, and an interrupted call measures what is missing and nothing
// twice. Times are not judged.
#include "engine/engine_run.h"
#include "lab/timing/results.h"
#include "tests/support/checks.h"
#include "tests/support/page.h"
#include "tests/support/scratch_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

TEST(TimingStudy, ContinuesWhereItWasInterrupted) {
  const ScratchStudy study("timing");
  const post::Outcome whole = study.run();
  ASSERT_TRUE(whole.ok()) << whole.output;
  const fs::path rows = study.out() / "runs.csv";
  const std::vector<post::TimedRun> runs = post::read_timed_runs(rows);
  // Nine variants of the chain, eleven of the parts of a bed, three laws of each engine on three beds and two
  // numbers of ranks.
  const std::size_t count = 9 + 11 + 18 + (post::has_lammps() ? 18 : 0);
  ASSERT_EQ(runs.size(), count);
  for (const post::TimedRun &run : runs)
    EXPECT_GT(run.peak_bytes, 1e6) << run.scene << ", " << run.variant; // no process of the engine is smaller
  const fs::path bed = made_file(study.out(), "bed_100_", ".data");
  const fs::path copies = made_file(study.out(), "bed_288_", ".data");
  const auto made = fs::last_write_time(bed), copied = fs::last_write_time(copies);

  interrupt(rows);
  fs::remove(study.out() / "index.html");
  const post::Outcome rest = study.run();
  ASSERT_TRUE(rest.ok()) << rest.output;
  EXPECT_EQ(fs::last_write_time(bed), made) << "the bed is settled once";
  EXPECT_EQ(fs::last_write_time(copies), copied) << "the copies are made once";
  const std::vector<post::TimedRun> again = post::read_timed_runs(rows);
  ASSERT_EQ(again.size(), count);
  std::size_t kept = 0;
  for (const post::TimedRun &run : runs) {
    const auto same = [&run](const post::TimedRun &other) {
      return other.scene == run.scene && other.variant == run.variant && other.ranks == run.ranks;
    };
    ASSERT_EQ(std::count_if(again.begin(), again.end(), same), 1) << run.scene << ", " << run.variant;
    const post::TimedRun &other = *std::find_if(again.begin(), again.end(), same);
    EXPECT_NEAR(other.place, run.place, 1e-6) << "the same work: " << run.variant;
    if (other.loop_s == run.loop_s) ++kept;
  }
  EXPECT_EQ(kept, count / 2 - 1) << "every second row but the last, cut one is kept";
  expect_sound_page(study.out(), 2);
}

TEST(TimingStudy, RefusesAPathThatTheEngineWouldSplitAndTellsOfItsOldNames) {
  const ScratchStudy study("timing");
  const fs::path spaced = study.out().parent_path() / "two words";
  const post::Outcome outcome = post::run_program(
      {DRUMLIN_TOOLS, "study", "timing", "--quick", "--out", spaced.string()}, {}, fs::temp_directory_path());
  EXPECT_EQ(outcome.status, 2) << outcome.output;
  EXPECT_TRUE(outcome.says("two words") && outcome.says("allowed: a path without spaces")) << outcome.output;
  for (const char *name : {"cost", "speed"}) {
    const post::Outcome old =
        post::run_program({DRUMLIN_TOOLS, "study", name}, {}, fs::temp_directory_path());
    EXPECT_EQ(old.status, 2) << old.output;
    EXPECT_TRUE(printed(old, "allowed: timing"));
  }
}

} // namespace
} // namespace drumlin::test
