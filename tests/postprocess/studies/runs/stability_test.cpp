// `drumlin study stability --quick`: what must hold holds, and an interrupted call goes on to the same result.
#include "tests/support/page.h"
#include "tests/support/scratch_study.h"

#include "studies/study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

post::StudyResults map_of(const fs::path &out) {
  return {out / "map.csv",
          {"scene", "stepping", "D", "w0dt_stable", "w0dt_unstable", "w0dt_theory", "single"},
          3};
}

post::StudyResults extremes_of(const fs::path &out) {
  return {out / "extremes.csv",
          {"table", "row", "command", "expected", "error", "allowed", "verdict", "found"},
          3};
}

TEST(StabilityStudy, GoesOnWhereItWasInterrupted) {
  const ScratchStudy study("stability");
  const fs::path out = study.out();
  study.run();
  EXPECT_EQ(map_of(out).rows().size(), 12u);
  const auto sorted = [](std::vector<post::StudyResults::Row> rows) {
    std::sort(rows.begin(), rows.end());
    return rows;
  };
  const auto map = sorted(map_of(out).rows());
  const auto extremes = sorted(extremes_of(out).rows());
  ASSERT_GT(extremes.size(), 20u);
  for (const char *file : {"map.csv", "extremes.csv"})
    interrupt(out / file);
  fs::remove(out / "index.html");
  const post::Outcome rest = study.run();
  EXPECT_LT(std::count(rest.output.begin(), rest.output.end(), '\n'), 30) << "nothing is measured twice";
  EXPECT_EQ(sorted(map_of(out).rows()), map);
  EXPECT_EQ(sorted(extremes_of(out).rows()), extremes);
  expect_sound_page(out, 1);

  // The boundaries by theory: 2 and 1.414 for the springs; stock 2 (sqrt(1 + D^2) - D) for one contact.
  const post::StudyResults found = map_of(out);
  for (const auto &row : found.rows()) {
    const double D = found.number(row, "D");
    const double n = found.text(row, "scene") == "one" ? 1.0 : 2.0;
    const double damped = found.text(row, "stepping") == "stock" ? D : 0.0;
    const double limit = 2.0 / (n * damped + std::sqrt(n * n * damped * damped + n));
    EXPECT_NEAR(found.number(row, "w0dt_stable"), limit, 0.01 * limit)
        << found.text(row, "scene") << ' ' << found.text(row, "stepping") << ' ' << D;
  }
  const post::StudyResults rows = extremes_of(out);
  for (const auto &row : rows.rows())
    EXPECT_EQ(rows.text(row, "verdict"), "holds")
        << rows.text(row, "row") << ": " << rows.text(row, "error") << ' ' << rows.text(row, "found");
}

} // namespace
} // namespace drumlin::test
