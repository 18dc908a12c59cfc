// `drumlin study fidelity --quick`: every variant runs on every seed, and an interrupted call makes no bed
// and no run twice.
#include "studies/fidelity/results.h"
#include "support/files.h"
#include "tests/support/page.h"
#include "tests/support/scratch_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

TEST(FidelityStudy, ContinuesWhereItWasInterruptedAndABedThatFailsStopsNoOther) {
  const ScratchStudy study("fidelity");
  const post::Outcome whole = study.run();
  ASSERT_TRUE(whole.ok()) << whole.output;
  const fs::path rows = study.out() / "runs.csv";
  const std::vector<post::FidelityRun> runs = post::read_fidelity_runs(rows);
  ASSERT_EQ(runs.size(), 6u);
  for (const post::FidelityRun &run : runs) { // four cycles of 150 balls, whatever the machine does besides
    EXPECT_GT(run.cpu_s, 0.05) << run.variant;
    EXPECT_LT(run.cpu_s, 10.0) << run.variant;
  }
  const fs::path base = made_file(study.out() / "beds", "base_2_", ".restart");
  const auto made = fs::last_write_time(base);

  interrupt(rows);
  fs::remove(study.out() / "index.html");
  const post::Outcome rest = study.run();
  ASSERT_TRUE(rest.ok()) << rest.output;
  EXPECT_EQ(fs::last_write_time(base), made);
  const std::vector<post::FidelityRun> again = post::read_fidelity_runs(rows);
  ASSERT_EQ(again.size(), runs.size());
  for (const post::FidelityRun &run : runs) {
    const auto same = [&run](const post::FidelityRun &other) {
      return other.variant == run.variant && other.seed == run.seed && other.values == run.values;
    };
    EXPECT_EQ(std::count_if(again.begin(), again.end(), same), 1) << run.variant << ", seed " << run.seed;
  }
  expect_sound_page(study.out(), 1);

  const fs::path bed = made_file(study.out() / "beds", "rolling_2_", ".restart");
  fs::remove(rows);
  fs::remove(bed);
  fs::create_directory(bed); // no deck takes that for a bed
  const post::Outcome outcome = study.run();
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(outcome.says("seed 2, rolling: bed/in.bed: ERROR: drumlin/check: variable start is "))
      << outcome.output;
  EXPECT_EQ(post::read_fidelity_runs(rows).size(), 5u) << outcome.output;
  EXPECT_NE(post::read_text(study.out() / "index.html").find("Missing: seed 2, rolling"), std::string::npos);
}

} // namespace
} // namespace drumlin::test
