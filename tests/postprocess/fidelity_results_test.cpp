// What the fidelity study claims: against numbers worked out by hand.
#include "fidelity_results.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

namespace drumlin::test {
namespace {

using post::FidelityRun;
using post::MeanError;

TEST(MeanError, IsTheMeanAndItsInterval) {
  const MeanError some = post::mean_error({1.0, 2.0, 3.0, 6.0}); // squares about 3: 4 + 1 + 0 + 9
  EXPECT_DOUBLE_EQ(some.mean, 3.0);
  // t for 3 degrees of freedom leaves 2.5 % to either side
  EXPECT_NEAR(some.half_width, 3.18245 * std::sqrt(14.0 / (4.0 * 3.0)), 1e-3);
  EXPECT_FALSE(some.beyond_scatter());
  EXPECT_FALSE(post::mean_error({-1.0, 1.5}).beyond_scatter());
  EXPECT_TRUE(post::mean_error({-2.0, -2.1, -1.9}).beyond_scatter());
  EXPECT_TRUE((MeanError{-0.04, 0.05}.within(0.1)));
  EXPECT_FALSE((MeanError{-0.06, 0.05}.within(0.1)));
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
  const std::optional<post::Effect> found = post::effect_of(runs, {"A instead of B", "A", "base"});
  ASSERT_TRUE(found.has_value());
  const post::Effect &effect = *found;
  EXPECT_EQ(effect.seeds, 2);
  EXPECT_DOUBLE_EQ(effect.change[0].mean, 1.0 / 15.0);
  EXPECT_DOUBLE_EQ(effect.change[0].half_width, 0.0);
  EXPECT_TRUE(effect.change[0].beyond_scatter());
  EXPECT_DOUBLE_EQ(effect.change[1].mean, 0.0);
  // of +10 and -10, over the mean of 100 and 300; t for 1 degree of freedom
  EXPECT_NEAR(effect.change[1].half_width, 12.7062 * 10.0 / 200.0, 1e-3);
  EXPECT_FALSE(effect.change[2].beyond_scatter());
  EXPECT_DOUBLE_EQ(effect.cost, 2.5); // of 3 and 2
  EXPECT_FALSE(post::effect_of(runs, {"", "A", "B"}).has_value());
}

} // namespace
} // namespace drumlin::test
