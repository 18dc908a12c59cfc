// `drumlin study friction`: --quick runs both models on the bed of a seed; changes are taken seed by seed.
#include "studies/friction/results.h"
#include "support/files.h"
#include "tests/support/page.h"
#include "tests/support/scratch_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

using post::FrictionRun;

TEST(FrictionStudy, RunsBothModelsAndContinues) {
  const ScratchStudy study("friction");
  const post::Outcome whole = study.run();
  ASSERT_TRUE(whole.ok()) << whole.output;
  const std::filesystem::path rows = study.out() / "runs.csv";
  const auto runs = [&rows] { return post::read_points(rows, post::friction_runs()); };
  const std::vector<FrictionRun> first = runs();
  ASSERT_EQ(first.size(), 2u);
  for (const FrictionRun &run : first) { // of a drum of 0.2 m diameter and 1.5 kN/m weight
    const std::string where = run.tangential + ", seed " + std::to_string(run.seed);
    EXPECT_LT(std::fabs(run.depth), 0.5) << where;
    EXPECT_LT(std::fabs(run.settlement), 0.2) << where;
    EXPECT_GT(run.peak_force, 1500.0) << where;
    EXPECT_GT(run.contact_share, 0.0) << where;
    EXPECT_LE(run.contact_share, 1.0) << where;
    const auto other = std::find_if(first.begin(), first.end(), [&](const FrictionRun &one) {
      return one.seed == run.seed && one.tangential != run.tangential;
    });
    ASSERT_NE(other, first.end()) << where;
    EXPECT_NE(run.peak_force, other->peak_force) << where;
  }
  interrupt(rows);
  const post::Outcome rest = study.run();
  ASSERT_TRUE(rest.ok()) << rest.output;
  EXPECT_EQ(runs().size(), 2u);
  expect_sound_page(study.out(), 0);
}

TEST(FrictionStudy, TakesChangesSeedBySeed) {
  const auto run = [](const char *model, int seed, double force) {
    FrictionRun made;
    made.tangential = model;
    made.seed = seed;
    made.peak_force = force;
    return made;
  };
  // The beds differ by far more than the models. Seed 4 has no partner.
  const std::vector<FrictionRun> runs = {
      run("coulomb", 1, 100.0), run("history", 3, 912.0), run("history", 1, 110.0), run("coulomb", 2, 500.0),
      run("history", 2, 511.0), run("coulomb", 3, 900.0), run("history", 4, 5000.0)};
  const auto force =
      std::find_if(post::friction_quantities.begin(), post::friction_quantities.end(),
                   [](const auto &quantity) { return quantity.value == &FrictionRun::peak_force; });
  const std::optional<post::MeanInterval> change = post::friction_change(runs, *force);
  ASSERT_TRUE(change.has_value());
  EXPECT_DOUBLE_EQ(change->mean, 11.0); // of 10, 11, 12
  EXPECT_NEAR(change->half_width, 4.302652729911275 / std::sqrt(3.0),
              1e-9); // Student's t of two degrees of freedom
  EXPECT_EQ(post::values_of(runs, "history", *force).size(), 4u);
  EXPECT_FALSE(post::friction_change({runs[0], runs[2]}, *force).has_value());

  const post::TemporaryFolder temporary(testing::TempDir(), "friction_page");
  const std::filesystem::path &folder = temporary.path();
  post::write_friction_page(folder, "made up", runs, {"seed 4, coulomb: failed"});
  const std::string page = post::read_text(folder / "index.html");
  EXPECT_NE(page.find("peak contact force [kN/m] +0.011 ± 0.0025"), std::string::npos);
  EXPECT_NE(page.find("Missing: seed 4, coulomb: failed"), std::string::npos);
  expect_sound_page(folder, 0);
}

} // namespace
} // namespace drumlin::test
