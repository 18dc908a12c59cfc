// Packings of balls, and their sieve curves.
#include "tests/support/checks.h"
#include "bed/packing.h"
#include "bed/relative_density.h"
#include "bed/sieve_curve.h"
#include "engine/deck_run.h"
#include "support/files.h"

#include <unistd.h>
#include <boost/math/quadrature/gauss_kronrod.hpp>

namespace drumlin::test {
namespace {

// Packings, and the relative density for which a layer is poured.
namespace of_packing {

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
  const MeasuredPackings packings(rows, 0.22);
  EXPECT_NEAR(packings.most(), 1.25, 1e-12);
  for (const auto &[relative, friction, void_ratio] :
       {std::array{0.0, 0.8, 0.30}, std::array{1.25, 0.0, 0.20}, std::array{0.5, 0.2, 0.26},
        std::array{0.875, 0.1, 0.23}, std::array{0.125, 0.6, 0.29}}) {
    const Pouring poured = packings.pouring(relative);
    EXPECT_NEAR(poured.friction, friction, 1e-12) << relative;
    EXPECT_NEAR(poured.rolling, 0.5 * friction, 1e-12) << relative;
    EXPECT_NEAR(poured.void_ratio, void_ratio, 1e-12) << relative;
    EXPECT_NEAR(poured.solid_fraction(), 1.0 / (1.0 + void_ratio), 1e-12) << relative;
    EXPECT_DOUBLE_EQ(poured.loosest, 0.30);
    EXPECT_DOUBLE_EQ(poured.shaken, 0.22);
  }
}

// Single packings scatter: one that is denser than that of a smaller share counts as equal to it.
TEST(MeasuredPackings, DoNotFollowTheScatterOfSinglePackings) {
  std::vector<MeasuredPackings::Row> scattered = rows;
  scattered[3].void_ratio = 0.25;
  EXPECT_NEAR(MeasuredPackings(scattered, 0.22).pouring(0.25).friction, 0.6, 1e-12);
  scattered[3].void_ratio = 0.31;
  EXPECT_NEAR(MeasuredPackings(scattered, 0.22).pouring(0.0).friction, 0.4, 1e-12);
}

TEST(MeasuredPackings, NeedTheLoosestTheFrictionlessAndTheShaken) {
  EXPECT_THROW(MeasuredPackings({}, 0.22), std::invalid_argument);
  EXPECT_THROW(MeasuredPackings({rows[0], rows[2]}, 0.22), std::invalid_argument);
  EXPECT_THROW(MeasuredPackings({rows[1], rows[2]}, 0.22), std::invalid_argument);
  EXPECT_THROW(MeasuredPackings({{1.0, 0.8, 0.4, 0.2}, {0.0, 0.0, 0.0, 0.2}}, 0.1), std::invalid_argument);
  for (const double shaken : {0.3, 0.0, -0.1})
    EXPECT_THROW(MeasuredPackings(rows, shaken), std::invalid_argument) << shaken;
}

// A table of packings as text and read again; of the frictionless scale, which no laboratory has, none is
// read.
TEST(MeasuredPackings, AreReadAsTheyAreWritten) {
  const post::TemporaryFolder folder(std::filesystem::temp_directory_path(), "drumlin-packings-");
  const std::filesystem::path file = folder.path() / "packings.csv";
  MeasuredPackings packings(rows, 0.22);
  packings.estimated = true;
  post::write_files({{file, post::packings_csv(packings)}});
  const MeasuredPackings read = post::read_packings(file);
  EXPECT_DOUBLE_EQ(read.shaken(), 0.22);
  EXPECT_TRUE(read.estimated);
  EXPECT_EQ(read.poured().size(), 4U);
  EXPECT_DOUBLE_EQ(read.most(), 1.25);
  const std::string columns = "share,friction,rolling,void_ratio,dimension,spread",
                    poured = "1,0.8,0.4,0.3,2,0.2,poured\n0,0,0,0.2,2,0.2,frictionless\n",
                    shaken = "1,0.8,0.4,0.22,2,0.2,shaken\n";
  for (const std::string &text :
       {columns + "\n1,0.8,0.4,0.3,2,0.2\n0,0,0,0.2,2,0.2\n", columns + ",made\n" + poured,
        columns + ",made\n" + poured + shaken + shaken,
        columns + ",made\n" + poured + "1,0.8,0.4,0.22,2,0.2,x\n"}) {
    post::write_files({{file, text}});
    EXPECT_THROW(post::read_packings(file), std::runtime_error) << text;
  }
}

// The stored packings: the relative density of each share falls with it, to 0. Shaken soil is poured with a
// tenth of its friction or so.
TEST(MeasuredPackings, OfGravelAreStored) {
  for (const int name : {2, 3}) {
    const MeasuredPackings stored = post::packings_of_gravel(name);
    EXPECT_FALSE(stored.estimated) << name;
    EXPECT_GT(stored.shaken(), stored.frictionless().void_ratio) << name;
    EXPECT_NEAR(stored.pouring(stored.most()).friction, 0.0, 1e-9) << name;
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
  EXPECT_TRUE(post::noted_packings({{"layer_tops", "0.3"}, {"e_loosest", "unknown"}, {"e_shaken", "unknown"}})
                  .empty());
  const auto layers =
      post::noted_packings({{"layer_tops", "0.3,0.6"}, {"e_loosest", "0.3,0.4"}, {"e_shaken", "0.2,0.25"}});
  ASSERT_EQ(layers.size(), 2u);
  EXPECT_DOUBLE_EQ(post::layer_at(layers, 0.1).loosest, 0.3);
  EXPECT_DOUBLE_EQ(post::layer_at(layers, 0.5).loosest, 0.4);
  EXPECT_DOUBLE_EQ(post::layer_at(layers, 0.7).shaken, 0.25);
  EXPECT_THROW(post::noted_packings({{"layer_tops", "0.3"}, {"e_loosest", "much"}, {"e_shaken", "0.2"}}),
               std::runtime_error);
}

} // namespace density

} // namespace of_packing

// Grain size curves and the balls that are made from them, against closed forms and numerical integrals.
namespace sieve_curve {

using post::BallNumbers;
using post::curve_between;
using post::GrainSizes;
using post::PackedBall;
using post::Packing;
using post::PackingOptions;
using post::Sieve;
using post::SieveCurve;
using post::Sieving;

/// A tenth of the mass finer than 1 mm, a gap between 4 and 8 mm, the largest grain 32 mm.
SieveCurve gap_graded() {
  return SieveCurve({{0.5e-3, 0.0}, {1e-3, 0.1}, {4e-3, 0.4}, {8e-3, 0.4}, {32e-3, 1.0}, {63e-3, 1.0}});
}

/// One curve as laboratories write it: what passes or stays, finest or coarsest sieve first, per cent or
/// mass.
TEST(SieveCurve, IsReadAsLaboratoriesWriteIt) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("drumlin-sieves-" + std::to_string(::getpid()) + ".csv");
  const char *const all_columns =
      "size (mm),retained (g),retained (%),cumulative retained (%),passing (%)\n16,0,0,0,100\n"
      "8,1000,50,50,50\n4,750,37.5,87.5,12.5\n0,250,12.5,100,0\n";
  for (const char *text :
       {"size (mm),passing (%)\n4,12.5\n8,50\n16,100\n", "Probe 3\n\nsize;passing\n16;100\n8;50\n4;12,5\n",
        "size [m]\tretained [%]\n0.016\t0\n0.008\t50\n0.004\t37.5\n",
        "size (mm);retained (g)\n16;0\n8;1000\n4;750\n0;250\n",
        "size (mm);retained (g)\n16;0\n8;1000\n4;750\nPan;250\n",
        "size (mm);retained (g)\n0;250,0\n4;750,0\n8;1000,0\n16;0,0\n",
        "Size;Retained\n16;0\n8;1000\n4;750\n0;250\n", "size,retained\n16,0\n8,50\n4,37.5\n0,12.5\n",
        "Sieve size (mm),% passing\n16,100\n8,50\n4,12.5\n",
        "size (mm);cumulative retained (%)\n16;0\n8;50\n4;87,5\n",
        "size (mm);Cumulative Retained (%)\n0;100\n4;87,5\n8;50\n16;0\n",
        "size (mm);cumulative retained\n16;0\n8;1.000\n4;1.750,0\n0;2.000\n",
        "size (mm);individual retained (g)\n16;0\n8;1'000\n4;750\n0;250\n", all_columns}) {
    post::write_files({{file, text}});
    const SieveCurve curve = post::read_sieve_file(file);
    ASSERT_EQ(curve.sieves().size(), 3u) << text;
    for (const auto &[size, passing] :
         {std::pair{4e-3, 0.125}, std::pair{8e-3, 0.5}, std::pair{16e-3, 1.0}}) {
      const Sieve &sieve = curve.sieves()[size < 5e-3 ? 0 : size < 10e-3 ? 1 : 2];
      EXPECT_NEAR(sieve.size, size, 1e-15) << text;
      EXPECT_NEAR(sieve.passing, passing, 1e-14) << text;
    }
  }
  std::filesystem::remove(file);
}

TEST(SieveCurve, RefusesAPanThatLooksLikeAHeader) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("drumlin-sieves-" + std::to_string(::getpid()) + ".csv");
  post::write_files({{file, "size,retained\npan,250\n4,750\n8,1000\n16,0\n"}});
  try {
    post::read_sieve_file(file);
    ADD_FAILURE();
  } catch (const std::runtime_error &error) {
    EXPECT_NE(std::string(error.what()).find("the first row is 'pan'; allowed: in the last row"),
              std::string::npos)
        << error.what();
  }
  std::filesystem::remove(file);
}

/// What stays on a sieve and what stays on it and all coarser ones are not mixed up.
TEST(SieveCurve, SaysWhatToWriteWhereRetainedMayBeCumulative) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("drumlin-retained-" + std::to_string(::getpid()) + ".csv");
  const auto message = [&file](const std::string &text) {
    post::write_files({{file, text}});
    try {
      post::read_sieve_file(file);
    } catch (const std::exception &error) {
      return std::string(error.what());
    }
    return std::string("not refused");
  };
  for (const char *text :
       {"size (mm);retained\n16;0\n8;50\n4;87.5\n", "size (mm);retained (%)\n4;40\n8;10\n16;0\n",
        "size (mm);retained (%)\n4;87.5\n8;50\n16;0\n",
        "size (mm);retained\n16;0\n8;50\n4;37.5\n", // shares, or masses without a pan
        "size (mm);retained (g)\n16;0\n8;1000\n4;1750\n0;2000\n"}) {
    EXPECT_NE(message(text).find("'cumulative retained' for what stays on it and on all coarser ones"),
              std::string::npos)
        << text << message(text);
    std::string clear = text;
    clear.insert(clear.find("retained"), "individual ");
    const bool unit = clear.find("(g)") != std::string::npos, share = clear.find("(%)") != std::string::npos;
    if (!unit && !share) clear.insert(clear.find('\n'), " (g)");
    if (!share || clear.find("87.5") == std::string::npos) {
      EXPECT_EQ(message(clear), "not refused") << clear;
    }
  }
  for (const auto &[text, says] : {std::pair{"size;cumulative retained (g)\n16;0\n8;1000\n4;1750\n",
                                             "its unit is 'g'; allowed: %, or a row of "},
                                   std::pair{"size;cumulative retained (%)\n16;0\n8;50\n4;37.5\n",
                                             "line 4, column 'cumulative retained (%)' is "
                                             "'37.5'; allowed: at least 50"},
                                   std::pair{"size;cumulative retained (%)\n16;0\n8;50\n4;120\n",
                                             "is '120'; allowed: more than 0, and of shares"},
                                   std::pair{"size;cumulative retained (%)\n16;0\n8;50\n0;90\n",
                                             "is '90'; allowed: more than 0, and of shares"}})
    EXPECT_NE(message(text).find(says), std::string::npos) << message(text);
  std::filesystem::remove(file);
}

TEST(SieveCurve, IsAStraightLineOverTheLogarithmOfTheSize) {
  const SieveCurve curve = gap_graded();
  EXPECT_DOUBLE_EQ(curve.largest(), 32e-3);      // the sieve of 63 mm says nothing
  EXPECT_NEAR(curve.passing(2e-3), 0.25, 1e-15); // the geometric mean of 1 and 4 mm
  EXPECT_NEAR(curve.passing(16e-3), 0.7, 1e-15);
  EXPECT_EQ(curve.passing(1.0), 1.0);
  EXPECT_EQ(curve.passing(1e-6), 0.0);
  const GrainSizes sizes = post::grain_sizes(curve);
  EXPECT_NEAR(sizes.d10, 1e-3, 1e-15);
  EXPECT_NEAR(sizes.d30, std::pow(4.0, 2.0 / 3.0) * 1e-3, 1e-15);
  EXPECT_NEAR(sizes.d60, std::pow(4.0, 1.0 / 3.0) * 8e-3, 1e-15);
  EXPECT_NEAR(sizes.uniformity(), 8.0 * std::pow(4.0, 1.0 / 3.0), 1e-12);
  EXPECT_NEAR(sizes.curvature(), std::pow(4.0, 4.0 / 3.0) / sizes.uniformity(), 1e-12);
  EXPECT_NEAR(curve.size(0.4), 4e-3, 1e-15); // the smallest of all sizes in the gap
}

TEST(SieveCurve, OfTwoSizesIsAStraightLineBetweenThem) {
  const std::optional<SieveCurve> curve = curve_between("32-48");
  ASSERT_TRUE(curve);
  EXPECT_DOUBLE_EQ(curve->smallest(), 0.032);
  EXPECT_DOUBLE_EQ(curve->largest(), 0.048);
  EXPECT_NEAR(curve->passing(std::sqrt(0.032 * 0.048)), 0.5, 1e-12);
  for (const char *text : {"", "32", "48-32", "32-32", "0-48", "-1-48", "a-48", "32-b", "32-", "1-1e9"})
    EXPECT_FALSE(curve_between(text)) << text;
}

TEST(SieveCurve, WithoutItsFinesKeepsTheProportionsOfTheRest) {
  const SieveCurve curve = gap_graded();
  for (const double cut : {2e-3, 4e-3, 6e-3, 16e-3}) {
    const SieveCurve rest = curve.coarser_than(cut);
    for (const double size : {5e-3, 8e-3, 20e-3, 32e-3}) {
      if (size <= cut) continue;
      EXPECT_NEAR(rest.passing(size), (curve.passing(size) - curve.passing(cut)) / (1.0 - curve.passing(cut)),
                  1e-14);
    }
  }
  EXPECT_NEAR(curve.coarser_than(6e-3).smallest(), 8e-3, 1e-15); // nothing is between 6 and 8 mm
  EXPECT_THROW(curve.coarser_than(32e-3), std::invalid_argument);
  EXPECT_THROW(curve.coarser_than(0.4e-3), std::invalid_argument);
}

TEST(SieveCurve, BuiltInGradingsAreMeansOfTheirLimits) {
  for (const post::KnownGrading &known : post::known_gradings()) {
    const SieveCurve curve = known.curve();
    for (const post::SieveLimits &at : known.limits) {
      EXPECT_LE(at.lower, at.upper) << known.name;
      EXPECT_NEAR(curve.passing(at.size * 1e-3), 0.005 * (at.lower + at.upper), 1e-12)
          << known.name << at.size;
    }
    EXPECT_EQ(post::find_grading(known.name), &known);
  }
  EXPECT_EQ(post::find_grading("sand"), nullptr);
}

/// The share of all balls between two sizes, from the density of numbers m(d) / d^n, by quadrature.
double counted(const SieveCurve &curve, double from, double to, int dimensions) {
  double sum = 0.0;
  for (std::size_t i = 1; i < curve.sieves().size(); ++i) {
    const Sieve &a = curve.sieves()[i - 1], &b = curve.sieves()[i];
    const double low = std::max(from, a.size), high = std::min(to, b.size);
    if (!(low < high)) continue;
    const double per_log = (b.passing - a.passing) / std::log(b.size / a.size);
    sum += boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
        [&](double d) { return per_log / d / std::pow(d, dimensions); }, low, high, 10, 1e-12);
  }
  return sum;
}

TEST(BallNumbers, AreTheIntegralOfMassOverTheMassOfABall) {
  const SieveCurve curve = gap_graded();
  for (const int dimensions : {2, 3}) {
    const BallNumbers numbers(curve, dimensions);
    const double all = counted(curve, curve.smallest(), curve.largest(), dimensions);
    for (const double size : {0.6e-3, 1e-3, 3e-3, 6e-3, 10e-3, 31e-3}) {
      const double share = counted(curve, curve.smallest(), size, dimensions) / all;
      EXPECT_NEAR(numbers.share_finer(size), share, 1e-10) << size;
      if (size >= 4e-3) continue; // in and near the gap ill-conditioned
      EXPECT_NEAR(numbers.size(share), size, 1e-9 * size);
    }
    EXPECT_NEAR(numbers.mean_power(), 1.0 / all, 1e-10 / all); // the mass of all is 1
  }
  EXPECT_THROW(BallNumbers(SieveCurve({{1e-3, 0.1}, {2e-3, 1.0}}), 2), std::invalid_argument);
}

/// WMM, cut at `cut`.
PackingOptions graded(int balls, double cut, bool spheres, std::uint64_t seed = 1) {
  PackingOptions options;
  options.balls = balls;
  options.width = spheres ? 0.3 : 1.0;
  options.depth = spheres ? 0.2 : 0.0;
  options.seed = seed;
  options.sieve = post::find_grading("WMM")->curve().coarser_than(cut);
  return options;
}

double power(double size, int n) { return n == 2 ? size * size : size * size * size; }

// At each size the mass of all finer balls differs from the one asked for by less than two balls of that
// size, and the mass of all by less than one of the largest: see pack_balls(). Independent sizes would
// scatter as the root of the number of balls times their mass.
TEST(GradedBed, HasTheMassesAskedForWithinTwoBalls) {
  for (const bool spheres : {false, true})
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
      const int n = spheres ? 3 : 2;
      const PackingOptions options = graded(1500, 8e-3, spheres, seed);
      const SieveCurve &asked = *options.sieve;
      const Sieving bed = post::sieved(post::pack_balls(options), n);
      const double mass = 1500 * BallNumbers(asked, n).mean_power();
      double found = 0.0;
      for (const double size : bed.sizes())
        found += power(size, n);
      EXPECT_LT(std::abs(found - mass), power(asked.largest(), n)) << seed;
      for (double size = asked.smallest(); size < asked.largest(); size *= 1.02)
        EXPECT_LT(std::abs(bed.passing(size) * found - asked.passing(size) * mass), 2.0 * power(size, n))
            << size << " m, seed " << seed;
    }
}

// The numbers of balls in ten classes of equal number: with one ball in each of N classes, chi-square is far
// below its mean of nine for independent sizes, and the distance of Kolmogorov and Smirnov below 1/N.
TEST(GradedBed, HasTheNumbersAskedFor) {
  for (const bool spheres : {false, true}) {
    const PackingOptions options = graded(1000, 10e-3, spheres);
    const int n = spheres ? 3 : 2;
    const BallNumbers numbers(*options.sieve, n);
    const std::vector<double> sizes = post::sieved(post::pack_balls(options), n).sizes();
    std::vector<int> classes(10);
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const double share = numbers.share_finer(sizes[i]);
      ++classes[std::min<std::size_t>(9, static_cast<std::size_t>(10.0 * share))];
      EXPECT_NEAR(share, (static_cast<double>(i) + 0.5) / 1000.0, 0.51 / 1000.0); // sizes are rounded
    }
    const double chi2 = std::accumulate(classes.begin(), classes.end(), 0.0, [](double sum, int found) {
      return sum + (found - 100.0) * (found - 100.0) / 100.0;
    });
    EXPECT_LT(chi2, 0.2);
  }
}

TEST(GradedBed, BallsAreApartAndInsideTheBoxTheLargestFirst) {
  for (const bool spheres : {false, true}) {
    const PackingOptions options = graded(500, 8e-3, spheres);
    const Packing packing = post::pack_balls(options);
    for (std::size_t i = 0; i < packing.balls.size(); ++i) {
      const PackedBall &a = packing.balls[i];
      EXPECT_GE(a.centre[0], a.radius);
      EXPECT_LE(a.centre[0], options.width - a.radius);
      EXPECT_LE(a.centre[2], packing.height - a.radius);
      for (std::size_t j = 0; j < i; ++j) {
        const PackedBall &b = packing.balls[j];
        ASSERT_GE(b.radius, a.radius);
        ASSERT_GT(std::hypot(a.centre[0] - b.centre[0], a.centre[1] - b.centre[1], a.centre[2] - b.centre[2]),
                  a.radius + b.radius);
      }
    }
  }
}

TEST(GradedBed, IsTheSameEveryTimeAndAnotherForAnotherSeed) {
  const auto text = [](std::uint64_t seed) {
    const PackingOptions options = graded(300, 8e-3, false, seed);
    return post::bed_data(options, 2650.0, post::pack_balls(options));
  };
  EXPECT_EQ(text(7), text(7));
  EXPECT_NE(text(7), text(8));
}

// The cut by default lets the balls fill half of the width, and more balls reach finer grains.
TEST(GradedBed, DefaultCutFillsTheBox) {
  const SieveCurve curve = post::find_grading("WMM")->curve();
  double before = 1.0;
  for (const int balls : {1000, 4000, 16000}) {
    PackingOptions options;
    options.balls = balls;
    const double cut = post::default_cut(curve, options);
    EXPECT_LT(cut, before);
    before = cut;
    if (balls > 4000) continue;
    options.sieve = curve.coarser_than(cut);
    const Packing packing = post::pack_balls(options);
    EXPECT_NEAR(packing.height, 0.5 * options.width, 0.01);
    options.height = 0.7;
    options.sieve = curve.coarser_than(post::default_cut(curve, options));
    EXPECT_NO_THROW(post::pack_balls(options));
  }
  PackingOptions few;
  few.balls = 100;
  EXPECT_THROW(post::default_cut(curve, few), std::invalid_argument);
  few.balls = PackingOptions::most_balls; // enough for all grains
  few.width = 0.1;
  EXPECT_DOUBLE_EQ(post::default_cut(curve, few), curve.smallest());
}

} // namespace sieve_curve

} // namespace
} // namespace drumlin::test
