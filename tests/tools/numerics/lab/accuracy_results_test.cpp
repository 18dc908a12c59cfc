// Errors of the chain against known ones, with invented rows.
#include "lab/accuracy/results.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

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
  measured[1].errors.energy = 2e-4;
  EXPECT_EQ(post::larger_errors(measured, known, true),
            (Words{"II B, second, 200 steps per cycle: event_time_error_s nan, known 1e-06",
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

} // namespace
} // namespace drumlin::test
