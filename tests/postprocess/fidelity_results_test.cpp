// What the fidelity study claims: against numbers worked out by hand.
#include "fidelity_results.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace drumlin::test {
namespace {

using post::FidelityRun;
using post::MeanError;

TEST(MeanError, IsTheMeanAndTwiceItsStandardError) {
  const MeanError some = post::mean_error({1.0, 2.0, 3.0, 6.0}); // squares about 3: 4 + 1 + 0 + 9
  EXPECT_DOUBLE_EQ(some.mean, 3.0);
  EXPECT_DOUBLE_EQ(some.two_errors, 2.0 * std::sqrt(14.0 / (4.0 * 3.0)));
  EXPECT_TRUE(some.beyond_scatter());
  EXPECT_FALSE(post::mean_error({-1.0, 1.5}).beyond_scatter());
  EXPECT_TRUE(post::mean_error({-2.0, -2.1, -1.9}).beyond_scatter());
}

TEST(MeanError, OfOneSeedClaimsNothing) {
  const MeanError one = post::mean_error({5.0});
  EXPECT_EQ(one.mean, 5.0);
  EXPECT_FALSE(one.beyond_scatter());
  EXPECT_THROW(post::mean_error({}), std::invalid_argument);
}

// The seeds differ by far more than the variant changes them: only differences seed by seed show it.
TEST(Effect, ComparesSeedBySeed) {
  const std::vector<FidelityRun> runs = {
      {"base", 1, {10.0, 100.0, 1e-3, 1.0}, 2.0}, {"base", 2, {20.0, 300.0, 3e-3, 0.5}, 4.0},
      {"base", 3, {90.0, 500.0, 5e-3, 0.6}, 3.0}, {"A", 2, {21.0, 290.0, 3e-3, 0.5}, 8.0},
      {"A", 1, {11.0, 110.0, 1e-3, 1.0}, 6.0},    {"A", 4, {7.0, 7.0, 7.0, 7.0}, 7.0}};
  const post::Effect effect = post::effect_of(runs, "A", "base");
  EXPECT_EQ(effect.seeds, 2);
  EXPECT_DOUBLE_EQ(effect.change[0].mean, 1.0 / 15.0);
  EXPECT_DOUBLE_EQ(effect.change[0].two_errors, 0.0);
  EXPECT_TRUE(effect.change[0].beyond_scatter());
  EXPECT_DOUBLE_EQ(effect.change[1].mean, 0.0);
  EXPECT_DOUBLE_EQ(effect.change[1].two_errors,
                   2.0 * 10.0 / 200.0); // of +10 and -10, over the mean of 100 and 300
  EXPECT_FALSE(effect.change[2].beyond_scatter());
  EXPECT_DOUBLE_EQ(effect.wall_ratio, 2.5); // of 3 and 2
  EXPECT_THROW(post::effect_of(runs, "A", "B"), std::invalid_argument);
}

} // namespace
} // namespace drumlin::test
