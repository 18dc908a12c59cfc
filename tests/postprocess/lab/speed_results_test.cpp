// Throughput, efficiency and memory of the speed study, from invented rows.
#include "lab/speed/results.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace drumlin::test {
namespace {

using post::SpeedRun;
using post::Throughput;

SpeedRun run(const char *scene, const char *law, int ranks, int round, double loop_s, int balls = 1000,
             double bytes = 0.0) {
  return {scene, law, ranks, round, balls, 2000, loop_s, bytes, 0.0};
}

TEST(SpeedResults, RatiosAreTakenWithinARound) {
  // The second round is three times as slow as the first.
  const std::vector<Throughput> all = post::throughputs(
      {run("bed", "engine", 1, 1, 1.0), run("bed", "ours", 1, 1, 1.1), run("bed", "ours", 2, 1, 0.6),
       run("bed", "engine", 1, 2, 3.0), run("bed", "ours", 1, 2, 3.9), run("bed", "ours", 2, 2, 2.0)},
      "engine");
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[1].law, "ours");
  EXPECT_EQ(all[1].rounds, 2);
  EXPECT_DOUBLE_EQ(all[0].million_per_second.median,
                   0.5 * (2.0 + 2.0 / 3.0)); // of 1000 x 2000 in 1 and in 3 s
  EXPECT_DOUBLE_EQ(all[1].over_engine.median, 1.2);
  EXPECT_DOUBLE_EQ(all[2].efficiency.median, 0.5 * (1.1 / 1.2 + 3.9 / 4.0));
  EXPECT_EQ(all[2].over_engine.median, 0.0) << "the engine's law did not run on two ranks";
}

TEST(SpeedResults, MemoryOfABallIsTheDifferenceBetweenTwoScenes) {
  const std::vector<Throughput> all = post::throughputs({run("small", "ours", 1, 1, 1.0, 1000, 6e6),
                                                         run("large", "ours", 1, 1, 1.0, 11000, 26e6),
                                                         run("large", "ours", 2, 1, 1.0, 11000, 9e9)},
                                                        "engine");
  EXPECT_DOUBLE_EQ(post::bytes_per_ball(all, "ours", "small", "large"), 2000.0);
  EXPECT_THROW(post::bytes_per_ball(all, "ours", "small", "small"), std::invalid_argument);
  EXPECT_THROW(post::bytes_per_ball(all, "theirs", "small", "large"), std::invalid_argument);
}

} // namespace
} // namespace drumlin::test
