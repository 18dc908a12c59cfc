// `drumlin study cost --quick`: every variant runs, an interrupted call measures what is missing and nothing
// twice. Times are not judged.
#include "lab/cost/results.h"
#include "support/files.h"
#include "support/process.h"
#include "tests/support/page.h"
#include "tests/support/scratch_study.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

class CostStudy : public ::testing::Test {
protected:
  CostStudy() { fs::create_directories(folder_); }
  ~CostStudy() override { fs::remove_all(folder_); }
  post::Outcome study(const std::string &out) const {
    return post::run_program({DRUMLIN_TOOLS, "study", "cost", "--quick", "--out", out}, {}, folder_, 200);
  }
  fs::path folder_ = fs::temp_directory_path() / fmt::format("drumlin-cost-{}", ::getpid());
};

TEST_F(CostStudy, ContinuesWhereItWasInterrupted) {
  const post::Outcome whole = study("out");
  ASSERT_TRUE(whole.ok()) << whole.output;
  const fs::path out = folder_ / "out";
  const fs::path rows = out / "runs.csv";
  const std::string text = post::read_text(rows);
  const std::vector<post::CostRun> runs = post::read_cost_runs(rows);
  EXPECT_EQ(runs.size(), 21u);
  const fs::path bed = made_file(out, "bed_100_", ".data");
  const auto beds = fs::last_write_time(bed);

  // A kill in the midst of the last row but one.
  const std::size_t cut = text.rfind('\n', text.rfind('\n', text.size() - 2) - 1) + 10;
  std::ofstream(rows) << text.substr(0, cut);
  fs::remove(out / "index.html");
  const post::Outcome rest = study("out");
  ASSERT_TRUE(rest.ok()) << rest.output;
  EXPECT_TRUE(rest.says("[20/21]") && rest.says("[21/21]") && !rest.says("[19/21]")) << rest.output;
  EXPECT_EQ(fs::last_write_time(bed), beds) << "the bed is settled once";
  const std::vector<post::CostRun> again = post::read_cost_runs(rows);
  ASSERT_EQ(again.size(), runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    EXPECT_EQ(again[i].variant, runs[i].variant);
    EXPECT_EQ(again[i].place, runs[i].place) << "the same work: " << runs[i].variant;
    if (i + 2 < runs.size()) {
      EXPECT_EQ(again[i].loop_s, runs[i].loop_s) << "kept";
    }
  }

  expect_sound_page(out, 1);
}

TEST_F(CostStudy, RefusesAPathThatTheEngineWouldSplit) {
  const post::Outcome outcome = study("two words");
  EXPECT_EQ(outcome.status, 2) << outcome.output;
  EXPECT_TRUE(outcome.says("two words") && outcome.says("allowed: a path without spaces")) << outcome.output;
}

} // namespace
} // namespace drumlin::test
