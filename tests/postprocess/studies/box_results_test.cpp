// Changes that another box makes, relative to the mean of the base, against values computed by hand.
#include "studies/box/results.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

namespace drumlin::test {
namespace {

constexpr std::size_t force = 0, settlement = 2, stiffness = 5;

post::BoxRun run_of(const char *name, int seed, double value) {
  post::BoxRun run;
  run.run = name;
  run.seed = seed;
  run.boundary = "rigid";
  run.values.fill(value);
  return run;
}

TEST(BoxResults, PairsSeedsAndRelatesChangesToTheMeanOfTheBase) {
  std::vector<post::BoxRun> runs = {run_of("base", 1, 100.0), run_of("base", 2, 300.0),
                                    run_of("wide", 1, 110.0), run_of("wide", 2, 330.0),
                                    run_of("wide", 3, 1e9)};
  const post::BedComparison compared{"wider", "wide", "base"};
  const auto change = post::box_change(runs, compared, force);
  ASSERT_TRUE(change);
  EXPECT_NEAR(change->mean, 20.0 / 200.0, 1e-15);
  const double t = 12.7062047364; // Student's t, one degree of freedom, 97.5 %
  EXPECT_NEAR(change->half_width, t * std::sqrt(200.0 / 2.0) / 200.0, 1e-8); // the differences are 10 and 30
  EXPECT_FALSE(change->significant());
  EXPECT_NEAR(post::box_change(runs, compared, settlement)->mean, 20.0, 1e-12); // m, not relative

  runs[3].values[stiffness] = std::numeric_limits<double>::quiet_NaN(); // a record that gave no k
  EXPECT_FALSE(post::box_change(runs, compared, stiffness));
  EXPECT_FALSE(post::box_change(runs, {"nothing", "narrow", "base"}, force));
}

TEST(BoxResults, TakesBedsOfDifferentBoxesAsIndependent) {
  std::vector<post::BoxRun> runs = {run_of("base", 1, 100.0), run_of("base", 2, 300.0),
                                    run_of("wide", 1, 220.0), run_of("wide", 2, 420.0)};
  runs[2].width = runs[3].width = 2;
  const post::BedComparison compared{"wider", "wide", "base"};
  const auto change = post::box_change(runs, compared, force);
  ASSERT_TRUE(change);
  EXPECT_NEAR(change->mean, 120.0 / 200.0, 1e-12);
  const double t = 4.30265272975; // two degrees of freedom
  EXPECT_NEAR(change->half_width, t * std::sqrt(2.0e4) / 200.0, 1e-8);
  runs.pop_back();
  EXPECT_FALSE(post::box_change(runs, compared, force));
}

TEST(BoxResults, ComparesBoundariesOnOneBedInBoxesOfAllSizes) {
  std::vector<post::BoxRun> runs;
  for (const int width : {1, 2})
    for (const auto &[boundary, ground, value] :
         {std::tuple{"rigid", 0.0, 100.0 * width}, {"absorb", 1.0, 101.0 * width}, {"absorb", 4.0, 1e9}}) {
      runs.push_back(run_of("", 1, value));
      runs.back().width = width;
      runs.back().boundary = boundary;
      runs.back().ground_depth = ground;
    }
  const auto change = post::boundary_change(runs, force); // differences 1 and 2 of 100 and 200
  ASSERT_TRUE(change);
  EXPECT_NEAR(change->mean, 1.5 / 150.0, 1e-15);
  EXPECT_NEAR(change->half_width, 12.7062047364 * 0.5 / 150.0, 1e-8);
}

} // namespace
} // namespace drumlin::test
