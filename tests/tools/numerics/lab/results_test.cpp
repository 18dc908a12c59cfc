#include "lab/accuracy/results.h"
#include "lab/timing/results.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

// Errors of the chain against known ones, with invented rows.
namespace accuracy {

using Words = std::vector<std::string>;

post::ChainPoint point(int steps, double velocity) {
  post::ChainPoint point{"II", post::Transition::B, "second", steps, {}};
  point.errors = {velocity, 1e-3, 1e-3, 3, 3, 1e-6, 1e-4, 0.1, 0.2};
  return point;
}

TEST(AccuracyResults, AreNotLargerIfTheyAreEqualOrFivePerCentMore) {
  const std::vector<post::ChainPoint> known = {point(200, 1e-4), point(400, 2e-5)};
  EXPECT_EQ(post::larger_errors(known, known, true), Words{});
  EXPECT_EQ(post::larger_errors({point(200, 1.049e-4), point(400, 1e-9)}, known, true), Words{});
}

TEST(AccuracyResults, NameEachErrorThatHasBecomeLarger) {
  const std::vector<post::ChainPoint> known = {point(200, 1e-4), point(400, 2e-5)};
  EXPECT_EQ(post::larger_errors({point(200, 1e-4), point(400, 2.2e-5)}, known, true),
            Words{"II B, second, 400 steps per cycle: velocity_error 2.2e-05, known 2e-05"});
  std::vector<post::ChainPoint> measured = known;
  measured[0].errors.event_time_s = std::nan(""); // its events no longer match
  measured[1].errors.force = 2e-3;
  measured[1].errors.acceleration = 3e-3;
  measured[1].errors.energy = 2e-4;
  EXPECT_EQ(post::larger_errors(measured, known, true),
            (Words{"II B, second, 200 steps per cycle: event_time_error_s nan, known 1e-06",
                   "II B, second, 400 steps per cycle: force_error 0.002, known 0.001",
                   "II B, second, 400 steps per cycle: acceleration_error 0.003, known 0.001",
                   "II B, second, 400 steps per cycle: energy_residual 0.0002, known 0.0001"}));
}

TEST(AccuracyResults, NameRowsThatCannotBeCompared) {
  const std::vector<post::ChainPoint> known = {point(200, 1e-4), point(400, 2e-5)};
  EXPECT_EQ(post::larger_errors({known[0]}, known, true),
            Words{"II B, second, 400 steps per cycle: not measured"});
  EXPECT_EQ(post::larger_errors({known[0]}, known, false), Words{}); // a quick study has few points
  EXPECT_EQ(post::larger_errors(known, {known[0]}, false),
            Words{"II B, second, 400 steps per cycle: not known"});
}

// The law of the engine is measured by its velocity error alone.
TEST(AccuracyResults, LeaveOutErrorsThatWereNotKnown) {
  post::ChainPoint known = point(200, 1e-4), measured = known;
  known.errors.force = std::nan("");
  measured.errors.force = 1.0;
  EXPECT_EQ(post::larger_errors({measured}, {known}, true), Words{});
}

} // namespace accuracy

// Medians, ratios, efficiency and memory of the timing study, from invented rows.
namespace timing {

using post::TimedRun;

TimedRun run(const char *scene, const char *variant, int round, double loop_s, int steps = 1000) {
  return {scene, variant, 1, round, 50, steps, loop_s, 0.5 * loop_s, 0.0, 0.0};
}

TimedRun on_ranks(const char *variant, int ranks, int round, double loop_s) {
  return {"bed", variant, ranks, round, 1000, 2000, loop_s, 0.0, 0.0, 0.0};
}

TimedRun large(const char *scene, int ranks, int balls, double bytes) {
  return {scene, "ours", ranks, 1, balls, 2000, 1.0, 0.0, bytes, 0.0};
}

TEST(TimingResults, RatioIsTheMedianWithinRounds) {
  // Each round twice as slow as the one before: between rounds the ratio could be anything.
  const std::vector<TimedRun> runs = {run("bed", "without", 1, 1.0), run("bed", "with", 1, 1.1),
                                      run("bed", "without", 2, 2.0), run("bed", "with", 2, 2.8),
                                      run("bed", "without", 3, 4.0), run("bed", "with", 3, 4.8)};
  const auto pieces = post::piece_costs(runs, {{"piece", "with", "without", 0.0}});
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_NEAR(pieces[0].ratio.median, 1.2, 1e-12);
  EXPECT_NEAR(pieces[0].ratio.lower, 1.15, 1e-12);
  EXPECT_NEAR(pieces[0].ratio.upper, 1.3, 1e-12);
  EXPECT_NEAR(pieces[0].extra_us_per_step, 800.0, 1e-9) << "of 100, 800 and 800";
}

TEST(TimingResults, RoundWithoutItsBaseDoesNotCount) {
  const std::vector<TimedRun> runs = {run("bed", "without", 1, 1.0), run("bed", "with", 1, 1.1),
                                      run("bed", "with", 2, 9.0)};
  const auto pieces = post::piece_costs(runs, {{"piece", "with", "without", 0.0}});
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_NEAR(pieces[0].ratio.upper, 1.1, 1e-12);
}

TEST(TimingResults, ScenesDoNotMixAndNeedNotHaveEveryVariant) {
  const std::vector<TimedRun> runs = {run("chain", "without", 1, 1.0), run("bed", "without", 1, 4.0),
                                      run("bed", "with", 1, 6.0)};
  const auto pieces = post::piece_costs(runs, {{"piece", "with", "without", 0.0}});
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0].scene, "bed");
  EXPECT_NEAR(pieces[0].ratio.median, 1.5, 1e-12);
}

TEST(TimingResults, CriterionIsMetUpToItsLimit) {
  const std::vector<TimedRun> runs = {run("bed", "without", 1, 1.0), run("bed", "with", 1, 1.1)};
  EXPECT_TRUE(post::piece_costs(runs, {{"piece", "with", "without", 0.0}})[0].holds()) << "no criterion";
  EXPECT_TRUE(post::piece_costs(runs, {{"piece", "with", "without", 1.11}})[0].holds());
  EXPECT_FALSE(post::piece_costs(runs, {{"piece", "with", "without", 1.09, "bed"}})[0].holds());
  EXPECT_TRUE(post::piece_costs(runs, {{"piece", "with", "without", 1.09, "chain"}})[0].holds())
      << "criterion of another scene";
  EXPECT_FALSE(post::piece_costs(runs, {{"piece", "with", "without", 1.09}})[0].holds());
}

TEST(TimingResults, UnitsOfAStep) {
  const std::vector<TimedRun> runs = {run("bed", "stock", 1, 0.2, 2000), run("bed", "stock", 2, 0.4, 2000),
                                      run("bed", "stock", 3, 0.1, 2000)};
  const auto times = post::variant_times(runs);
  ASSERT_EQ(times.size(), 1u);
  EXPECT_EQ(times[0].rounds, 3);
  EXPECT_NEAR(times[0].us_per_step.median, 100.0, 1e-9) << "0.2 s over 2000 steps";
  EXPECT_NEAR(times[0].us_per_step.lower, 75.0, 1e-9);
  EXPECT_NEAR(times[0].us_per_step.upper, 150.0, 1e-9);
  EXPECT_NEAR(times[0].pair_us_per_step, 50.0, 1e-9);
  EXPECT_NEAR(times[0].ns_per_ball(), 2000.0, 1e-9) << "of 50 balls";
  EXPECT_NEAR(times[0].million_per_second.median, 0.5, 1e-12) << "50 balls, 2000 steps, 0.2 s";
}

TEST(TimingResults, RatiosAndEfficiencyAreTakenWithinARound) {
  // The second round is three times as slow as the first.
  const std::vector<TimedRun> runs = {on_ranks("engine", 1, 1, 1.0), on_ranks("ours", 1, 1, 1.1),
                                      on_ranks("ours", 2, 1, 0.6),   on_ranks("engine", 1, 2, 3.0),
                                      on_ranks("ours", 1, 2, 3.9),   on_ranks("ours", 2, 2, 2.0)};
  const std::vector<double> over = post::time_ratios(runs, "bed", {"ours"}, {"engine"});
  ASSERT_EQ(over.size(), 2u);
  EXPECT_DOUBLE_EQ(over[0], 1.1);
  EXPECT_DOUBLE_EQ(over[1], 1.3);
  const std::vector<double> efficiency = post::efficiencies(runs, "bed", {"ours", 2});
  ASSERT_EQ(efficiency.size(), 2u);
  EXPECT_DOUBLE_EQ(efficiency[0], 1.1 / 1.2);
  EXPECT_DOUBLE_EQ(efficiency[1], 3.9 / 4.0);
  EXPECT_TRUE(post::time_ratios(runs, "bed", {"ours", 2}, {"engine", 2}).empty())
      << "the engine's law did not run on two ranks";
  const auto times = post::variant_times(runs);
  ASSERT_EQ(times.size(), 3u);
  EXPECT_DOUBLE_EQ(times[0].million_per_second.median, 0.5 * (2.0 + 2.0 / 3.0));
  EXPECT_EQ(post::find_time(times, "bed", "ours", 2).rounds, 2);
  EXPECT_THROW(post::find_time(times, "bed", "engine", 2), std::invalid_argument);
}

TEST(TimingResults, MemoryOfABallIsTheDifferenceBetweenTwoScenes) {
  const auto all = post::variant_times(
      {large("small", 1, 1000, 6e6), large("large", 1, 11000, 26e6), large("large", 2, 11000, 9e9)});
  EXPECT_DOUBLE_EQ(post::bytes_per_ball(all, "ours", "small", "large"), 2000.0);
  EXPECT_THROW(post::bytes_per_ball(all, "ours", "small", "small"), std::invalid_argument);
  EXPECT_THROW(post::bytes_per_ball(all, "theirs", "small", "large"), std::invalid_argument);
}

} // namespace timing

} // namespace
} // namespace drumlin::test
