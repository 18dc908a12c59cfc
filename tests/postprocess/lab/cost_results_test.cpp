// Medians and ratios of the cost study, from invented rows.
#include "lab/cost/results.h"

#include <gtest/gtest.h>

namespace drumlin::test {
namespace {

using post::CostRun;

CostRun run(const char *scene, const char *variant, int round, double loop_s, int steps = 1000) {
  return {scene, variant, round, 50, steps, loop_s, 0.5 * loop_s, 0.0};
}

TEST(CostResults, RatioIsTheMedianWithinRounds) {
  // Each round twice as slow as the one before: between rounds the ratio could be anything.
  const std::vector<CostRun> runs = {run("bed", "without", 1, 1.0), run("bed", "with", 1, 1.1),
                                     run("bed", "without", 2, 2.0), run("bed", "with", 2, 2.8),
                                     run("bed", "without", 3, 4.0), run("bed", "with", 3, 4.8)};
  const auto pieces = post::piece_costs(runs, {{"piece", "with", "without", 0.0}});
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_NEAR(pieces[0].ratio.median, 1.2, 1e-12);
  EXPECT_NEAR(pieces[0].ratio.lower, 1.15, 1e-12);
  EXPECT_NEAR(pieces[0].ratio.upper, 1.3, 1e-12);
  EXPECT_NEAR(pieces[0].extra_us_per_step, 800.0, 1e-9) << "of 100, 800 and 800";
}

TEST(CostResults, RoundWithoutItsBaseDoesNotCount) {
  const std::vector<CostRun> runs = {run("bed", "without", 1, 1.0), run("bed", "with", 1, 1.1),
                                     run("bed", "with", 2, 9.0)};
  const auto pieces = post::piece_costs(runs, {{"piece", "with", "without", 0.0}});
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_NEAR(pieces[0].ratio.upper, 1.1, 1e-12);
}

TEST(CostResults, ScenesDoNotMixAndNeedNotHaveEveryVariant) {
  const std::vector<CostRun> runs = {run("chain", "without", 1, 1.0), run("bed", "without", 1, 4.0),
                                     run("bed", "with", 1, 6.0)};
  const auto pieces = post::piece_costs(runs, {{"piece", "with", "without", 0.0}});
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0].scene, "bed");
  EXPECT_NEAR(pieces[0].ratio.median, 1.5, 1e-12);
}

TEST(CostResults, CriterionIsMetUpToItsLimit) {
  const std::vector<CostRun> runs = {run("bed", "without", 1, 1.0), run("bed", "with", 1, 1.1)};
  EXPECT_TRUE(post::piece_costs(runs, {{"piece", "with", "without", 0.0}})[0].holds()) << "no criterion";
  EXPECT_TRUE(post::piece_costs(runs, {{"piece", "with", "without", 1.11}})[0].holds());
  EXPECT_FALSE(post::piece_costs(runs, {{"piece", "with", "without", 1.09, "bed"}})[0].holds());
  EXPECT_TRUE(post::piece_costs(runs, {{"piece", "with", "without", 1.09, "chain"}})[0].holds())
      << "criterion of another scene";
  EXPECT_FALSE(post::piece_costs(runs, {{"piece", "with", "without", 1.09}})[0].holds());
}

TEST(CostResults, UnitsOfAStep) {
  const std::vector<CostRun> runs = {run("bed", "stock", 1, 0.2, 2000), run("bed", "stock", 2, 0.4, 2000),
                                     run("bed", "stock", 3, 0.1, 2000)};
  const auto costs = post::variant_costs(runs);
  ASSERT_EQ(costs.size(), 1u);
  EXPECT_EQ(costs[0].rounds, 3);
  EXPECT_NEAR(costs[0].us_per_step.median, 100.0, 1e-9) << "0.2 s over 2000 steps";
  EXPECT_NEAR(costs[0].us_per_step.lower, 75.0, 1e-9);
  EXPECT_NEAR(costs[0].us_per_step.upper, 150.0, 1e-9);
  EXPECT_NEAR(costs[0].pair_us_per_step, 50.0, 1e-9);
  EXPECT_NEAR(costs[0].ns_per_ball, 2000.0, 1e-9) << "of 50 balls";
}

} // namespace
} // namespace drumlin::test
