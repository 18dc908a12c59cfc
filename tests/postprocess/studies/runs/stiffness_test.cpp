// `drumlin study stiffness --quick`: every run on every seed, and an interrupted call makes no bed and no run
// twice.
#include "studies/stiffness/results.h"
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

std::vector<post::BedLaw> laws_of(const fs::path &rows) { return post::read_points(rows, post::bed_laws()); }

TEST(StiffnessStudy, ContinuesWhereItWasInterrupted) {
  const ScratchStudy study("stiffness");
  const post::Outcome whole = study.run();
  ASSERT_TRUE(whole.ok()) << whole.output;
  const fs::path rows = study.out() / "runs.csv";
  const std::vector<post::BedLaw> laws = laws_of(rows);
  ASSERT_EQ(laws.size(), 8u);
  for (const post::BedLaw &law : laws) {
    EXPECT_NEAR(law.load, (law.run == "m3 100" ? 200.0 : 150.0) * 9.81, 1e-9) << law.run;
    EXPECT_EQ(law.Fw, law.run == "Fw 1470" ? 1470.0 : 2940.0) << law.run;
    EXPECT_NEAR(law.frequency, law.run == "30 Hz" ? 30.0 : 20.0, 1e-9) << law.run;
  }
  EXPECT_GE(std::count_if(laws.begin(), laws.end(),
                          [](const post::BedLaw &law) { return std::isfinite(law.k) && law.r2 > 0.0; }),
            4);
  for (const post::LawVariable &variable : post::law_variables)
    EXPECT_EQ(post::levels_of(laws, variable).size(), 2u) << variable.name;
  const fs::path soil = made_file(study.out() / "beds", "loose_2_", ".soil"),
                 heavy = made_file(study.out() / "beds", "m3_100_2_", ".restart");
  const auto settled = fs::last_write_time(soil), placed = fs::last_write_time(heavy);

  interrupt(rows);
  fs::remove(study.out() / "index.html");
  const post::Outcome rest = study.run();
  ASSERT_TRUE(rest.ok()) << rest.output;
  EXPECT_EQ(fs::last_write_time(soil), settled);
  EXPECT_EQ(fs::last_write_time(heavy), placed);
  const std::vector<post::BedLaw> again = laws_of(rows);
  ASSERT_EQ(again.size(), laws.size());
  for (const post::BedLaw &law : laws) {
    const auto same = [&law](const post::BedLaw &other) {
      return other.run == law.run && other.seed == law.seed && other.peak_force == law.peak_force &&
             (other.k == law.k || (std::isnan(other.k) && std::isnan(law.k)));
    };
    EXPECT_EQ(std::count_if(again.begin(), again.end(), same), 1) << law.run << ", seed " << law.seed;
  }
  expect_sound_page(study.out(), 3);
}

} // namespace
} // namespace drumlin::test
