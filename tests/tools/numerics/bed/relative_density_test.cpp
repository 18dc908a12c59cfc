// Relative density, and how a layer is poured for it, against its definition.
#include "bed/relative_density.h"

#include "engine/deck_run.h"
#include "support/files.h"
#include "tests/support/checks.h"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

using post::LayerPackings;
using post::MeasuredPackings;
using post::Pouring;

const std::vector<MeasuredPackings::Row> rows = {
    {1.0, 0.8, 0.4, 0.30}, {0.0, 0.0, 0.0, 0.20}, {0.25, 0.2, 0.1, 0.26}, {0.5, 0.4, 0.2, 0.28}};

TEST(RelativeDensity, IsThatOfTheVoidRatio) {
  EXPECT_DOUBLE_EQ(post::relative_density(0.3, 0.3, 0.2), 0.0);
  EXPECT_DOUBLE_EQ(post::relative_density(0.2, 0.3, 0.2), 1.0);
  EXPECT_NEAR(post::relative_density(0.27, 0.3, 0.2), 0.3, 1e-12);
  // Void ratios 1/4 and 1/9 are solid fractions of 0.8 and 0.9.
  const LayerPackings layer = {1.0, 0.25, 1.0 / 9.0};
  EXPECT_NEAR(layer.relative_density(0.8), 0.0, 1e-12);
  EXPECT_NEAR(layer.relative_density(0.9), 1.0, 1e-12);
  EXPECT_NEAR(layer.compaction(0.81), 0.9, 1e-12);
}

TEST(MeasuredPackings, PourALayerWithTheFrictionBetweenTwoPackings) {
  const MeasuredPackings packings(rows);
  for (const auto &[relative, friction, void_ratio] :
       {std::array{0.0, 0.8, 0.30}, std::array{1.0, 0.0, 0.20}, std::array{0.4, 0.2, 0.26},
        std::array{0.7, 0.1, 0.23}, std::array{0.1, 0.6, 0.29}}) {
    const Pouring poured = packings.pouring(relative);
    EXPECT_NEAR(poured.friction, friction, 1e-12) << relative;
    EXPECT_NEAR(poured.rolling, 0.5 * friction, 1e-12) << relative;
    EXPECT_NEAR(poured.void_ratio, void_ratio, 1e-12) << relative;
    EXPECT_NEAR(poured.solid_fraction(), 1.0 / (1.0 + void_ratio), 1e-12) << relative;
    EXPECT_DOUBLE_EQ(poured.loosest, 0.30);
    EXPECT_DOUBLE_EQ(poured.densest, 0.20);
  }
}

// Single packings scatter: one that is denser than that of a smaller share counts as equal to it.
TEST(MeasuredPackings, DoNotFollowTheScatterOfSinglePackings) {
  std::vector<MeasuredPackings::Row> scattered = rows;
  scattered[3].void_ratio = 0.25;
  EXPECT_NEAR(MeasuredPackings(scattered).pouring(0.2).friction, 0.6, 1e-12);
  scattered[3].void_ratio = 0.31;
  EXPECT_NEAR(MeasuredPackings(scattered).pouring(0.0).friction, 0.4, 1e-12);
}

TEST(MeasuredPackings, NeedTheLoosestAndTheDensest) {
  EXPECT_THROW(MeasuredPackings({}), std::invalid_argument);
  EXPECT_THROW(MeasuredPackings({rows[0], rows[2]}), std::invalid_argument);
  EXPECT_THROW(MeasuredPackings({rows[1], rows[2]}), std::invalid_argument);
  EXPECT_THROW(MeasuredPackings({{1.0, 0.8, 0.4, 0.2}, {0.0, 0.0, 0.0, 0.2}}), std::invalid_argument);
}

// The stored packings: the relative density of each share falls with it, from 1 to 0.
TEST(MeasuredPackings, OfGravelAreStored) {
  for (const char *name : {"bed/packings.gravel.csv", "bed/packings.gravel3d.csv"}) {
    const MeasuredPackings stored = post::read_packings(post::input_file(name));
    EXPECT_DOUBLE_EQ(stored.of_loosest().friction, 0.8) << name;
    double before = 2.0;
    for (const double relative : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
      const double friction = stored.pouring(relative).friction;
      EXPECT_LT(friction, before) << name << " " << relative;
      before = friction;
    }
  }
}

TEST(NotedPackings, AreThoseOfTheLayers) {
  EXPECT_TRUE(post::noted_packings({{"layer_tops", "0.3,0.6"}}).empty());
  EXPECT_TRUE(
      post::noted_packings({{"layer_tops", "0.3"}, {"e_loosest", "unknown"}, {"e_densest", "unknown"}})
          .empty());
  const auto layers =
      post::noted_packings({{"layer_tops", "0.3,0.6"}, {"e_loosest", "0.3,0.4"}, {"e_densest", "0.2,0.25"}});
  ASSERT_EQ(layers.size(), 2u);
  EXPECT_DOUBLE_EQ(post::layer_at(layers, 0.1).loosest, 0.3);
  EXPECT_DOUBLE_EQ(post::layer_at(layers, 0.5).loosest, 0.4);
  EXPECT_DOUBLE_EQ(post::layer_at(layers, 0.7).densest, 0.25);
  EXPECT_THROW(post::noted_packings({{"layer_tops", "0.3"}, {"e_loosest", "much"}, {"e_densest", "0.2"}}),
               std::runtime_error);
}

} // namespace
} // namespace drumlin::test
