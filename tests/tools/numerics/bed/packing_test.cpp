// Packings, and the relative density for which a layer is poured.
#include "tests/support/checks.h"

#include "bed/known_gradings.h"
#include "bed/packing.h"
#include "bed/relative_density.h"
#include "engine/deck_run.h"
#include "support/files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <stdexcept>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

// The random bed before it settles: its geometry and grading against closed forms.
namespace packing {

using post::Grading;
using post::PackedBall;
using post::Packing;
using post::PackingOptions;

PackingOptions cube() {
  PackingOptions options;
  options.balls = 800;
  options.width = 0.3;
  options.depth = 0.4;
  return options;
}

void expect_apart_and_inside(const PackingOptions &options) {
  const Packing packing = post::pack_balls(options);
  ASSERT_EQ(packing.balls.size(), static_cast<std::size_t>(options.balls));
  const std::array<double, 3> size = {options.width, options.depth, packing.height};
  for (std::size_t i = 0; i < packing.balls.size(); ++i) {
    const PackedBall &a = packing.balls[i];
    EXPECT_GE(a.radius, options.radius_min);
    EXPECT_LE(a.radius, options.radius_max);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axis == 1 && options.depth == 0.0) {
        EXPECT_EQ(a.centre[axis], 0.0);
        continue;
      }
      EXPECT_GE(a.centre[axis], a.radius);
      EXPECT_LE(a.centre[axis], size[axis] - a.radius);
    }
    for (std::size_t j = 0; j < i; ++j) {
      const PackedBall &b = packing.balls[j];
      const double distance =
          std::hypot(a.centre[0] - b.centre[0], a.centre[1] - b.centre[1], a.centre[2] - b.centre[2]);
      ASSERT_GT(distance, a.radius + b.radius) << i << " and " << j;
    }
  }
}

TEST(BedPacking, BallsAreApartAndInsideTheBox) {
  expect_apart_and_inside({});
  expect_apart_and_inside(cube());
}

TEST(BedPacking, IsTheSameEveryTimeAndAnotherForAnotherSeed) {
  const auto centres = [](std::uint64_t seed) {
    PackingOptions options;
    options.seed = seed;
    std::vector<double> out;
    for (const PackedBall &ball : post::pack_balls(options).balls)
      out.insert(out.end(), {ball.centre[0], ball.centre[2], ball.radius});
    return out;
  };
  EXPECT_EQ(centres(7), centres(7));
  EXPECT_NE(centres(7), centres(8));
}

/// Largest distance between the shares of radii below r, found and by the closed form (Kolmogorov and
/// Smirnov).
template <class Share>
double farthest(const PackingOptions &options, const Share &share) {
  std::vector<double> radii;
  for (const PackedBall &ball : post::pack_balls(options).balls)
    radii.push_back(ball.radius);
  std::sort(radii.begin(), radii.end());
  double most = 0.0;
  for (std::size_t i = 0; i < radii.size(); ++i)
    most = std::max(most, std::fabs((static_cast<double>(i) + 0.5) / static_cast<double>(radii.size()) -
                                    share(radii[i])));
  return most;
}

TEST(BedPacking, RadiiFollowTheGrading) {
  for (PackingOptions options : {PackingOptions{}, cube()}) {
    options.radius_min = 0.006;
    options.radius_max = 0.012;
    const double low = options.radius_min, high = options.radius_max;
    // 1.95 / sqrt(N) is passed once in a thousand times
    const double bound = 1.95 / std::sqrt(options.balls);
    EXPECT_LT(farthest(options, [&](double r) { return (r - low) / (high - low); }), bound);
    options.grading = Grading::mass;
    // numbers ~ r^-n, so that mass ~ r^n of them is even: the integral of r^-n
    const double n = options.dimensions();
    const auto sum = [&](double r) { return (std::pow(low, 1.0 - n) - std::pow(r, 1.0 - n)) / (n - 1.0); };
    EXPECT_LT(farthest(options, [&](double r) { return sum(r) / sum(high); }), bound);
  }
}

std::string refusal(const PackingOptions &options, int attempts = 1000) {
  return error_of<std::invalid_argument>([&] { post::pack_balls(options, {}, attempts); });
}

TEST(BedPacking, RefusesWhatCannotBePackedAndSaysWhatCan) {
  const auto with = [](double PackingOptions::*value, double given) {
    PackingOptions options;
    options.*value = given;
    return refusal(options);
  };
  EXPECT_EQ(with(&PackingOptions::width, 0.04),
            "width is '0.04'; allowed: a number from 0.048 to 100000 [m]: room for the largest ball");
  EXPECT_EQ(with(&PackingOptions::radius_min, 0.0),
            "radius-min is '0'; allowed: a number from 1e-06 to 1000 [m]");
  EXPECT_EQ(with(&PackingOptions::radius_max, 0.01),
            "radius-max is '0.01'; allowed: a number from radius-min, which is 0.016, to 1000 times it [m]");
  EXPECT_TRUE(
      contains(with(&PackingOptions::depth, 0.01), "depth is '0.01'; allowed: 0, or a number from 0.048"));
  EXPECT_TRUE(contains(with(&PackingOptions::height, std::nan("")), "height is 'nan'"));
  PackingOptions none;
  none.balls = 0;
  EXPECT_EQ(refusal(none), "balls is '0'; allowed: a whole number from 1 to 10000000");
}

// Cells for the search of neighbours are counted before any is made.
TEST(BedPacking, BoundsItsCellsBeforeItBegins) {
  PackingOptions wide;
  wide.width = 1e5;
  wide.depth = 1e4;
  wide.height = 1e3;
  EXPECT_EQ(refusal(wide).rfind("width is '100000'; allowed: a box of at most ", 0), 0u) << refusal(wide);
}

// The search for free positions looks at neighbours only, however many small balls lie beside large ones: the
// work goes with the number of balls.
TEST(BedPacking, PlacesAWideGradingInATimeThatGoesWithItsBalls) {
  PackingOptions options;
  options.width = 1.0;
  options.sieve = post::find_grading("WMM")->curve().coarser_than(0.3e-3);
  const auto seconds = [&options](int balls) {
    options.balls = balls;
    const std::clock_t begin = std::clock();
    EXPECT_EQ(static_cast<int>(post::pack_balls(options).balls.size()), balls);
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  };
  const double few = seconds(20'000), many = seconds(160'000);
  EXPECT_LT(many, 25.0 * few + 0.2) << few; // with the square of their number it would be 64 times as long
}

// Too many balls for the box are refused before the first is placed; the message names the least height, with
// which they fit.
TEST(BedPacking, SaysAtOnceHowHighTheBoxMustBe) {
  PackingOptions options;
  options.height = 1.0;
  const std::string fault = refusal(options);
  const std::string before = "allowed: 0 (as needed) or at least ";
  ASSERT_NE(fault.find(before), std::string::npos) << fault;
  const double least = std::stod(fault.substr(fault.find(before) + before.size()));
  EXPECT_NEAR(least, 2500 * 3.141592653589793 * 4.053e-4 / (2.0 * 0.5),
              0.02 * least); // mean of r^2: 4.053e-4 m2
  options.height = 1.05 * least;
  EXPECT_EQ(refusal(options, 100'000), "no error");
}

} // namespace packing

// Relative density, and how a layer is poured for it, against its definition.
namespace density {

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

} // namespace density

} // namespace
} // namespace drumlin::test
