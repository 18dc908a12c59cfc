// `drumlin study benchmarks --quick`: all criteria are met, and an interrupted call continues to the same
// result.
#include "support/files.h"
#include "tests/support/checks.h"
#include "tests/support/page.h"
#include "tests/support/scratch_study.h"

#include "experiment/study.h"
#include "lab/benchmarks/runs.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

TEST(BenchmarksStudy, MeetsItsCriteriaAndContinuesWhereItWasInterrupted) {
  const ScratchStudy study("benchmarks");
  const fs::path out = study.out();
  const post::Outcome whole = study.run();
  ASSERT_TRUE(whole.ok()) << whole.output;
  expect_sound_page(out, 2);
  EXPECT_TRUE(contains(post::read_text(out / "index.html"), "3 of 3 acceptance criteria hold."));
  const std::string values = post::read_text(out / "data" / "values.csv");

  interrupt(out / "runs.csv");
  fs::remove(out / "index.html");
  const post::Outcome rest = study.run();
  ASSERT_TRUE(rest.ok()) << rest.output;
  EXPECT_FALSE(rest.says("[1/"));
  EXPECT_EQ(post::read_text(out / "data" / "values.csv"), values);
}

} // namespace
} // namespace drumlin::test
