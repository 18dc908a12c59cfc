// The effects that the fidelity study computes, against numbers worked out by hand.
#include "studies/fidelity/results.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace drumlin::test {
namespace {

using post::FidelityRun;

// Four cycles after the start; what counts are the last two, and settlement from the end of the second on.
TEST(BedValues, AreOfTheSecondHalfAndPerMetreOfWidth) {
  const post::Table cycles("cycles.csv",
                           {"cycle", "a_drum_max", "F_contact_max", "contact_share", "settlement"},
                           {{"0", "900", "9000", "1", "0"},
                            {"1", "90", "900", "0.25", "0.5"},
                            {"2", "70", "700", "0.25", "0.6"},
                            {"3", "20", "200", "0.5", "0.65"},
                            {"4", "30", "600", "1", "0.8"}},
                           {2, 3, 4, 5, 6});
  const post::BedValues plane = post::bed_values(cycles, 1.0);
  EXPECT_DOUBLE_EQ(plane[0], 25.0);
  EXPECT_DOUBLE_EQ(plane[1], 400.0);
  EXPECT_NEAR(plane[2], 0.1, 1e-15);
  EXPECT_DOUBLE_EQ(plane[3], 0.75);
  const post::BedValues space = post::bed_values(cycles, 0.2);
  EXPECT_DOUBLE_EQ(space[1], 2000.0); // N/m
  EXPECT_EQ(space[0], plane[0]);
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
  EXPECT_TRUE(effect.change[0].significant());
  EXPECT_DOUBLE_EQ(effect.change[1].mean, 0.0);
  // of +10 and -10, over the mean of 100 and 300; t for 1 degree of freedom
  EXPECT_NEAR(effect.change[1].half_width, 12.7062 * 10.0 / 200.0, 1e-3);
  EXPECT_FALSE(effect.change[2].significant());
  EXPECT_DOUBLE_EQ(effect.cost, 2.5); // of 3 and 2
  EXPECT_FALSE(post::effect_of(runs, {"", "A", "B"}).has_value());
}

} // namespace
} // namespace drumlin::test
