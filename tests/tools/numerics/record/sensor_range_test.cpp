// Sensors that reach the end of their range, found by how their values are distributed.
#include "record/sensor_range.h"
#include "tests/support/changing_roller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

using namespace post;

std::vector<double> with_noise(std::vector<double> values, double level) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, level);
  for (double &value : values)
    value += normal(random);
  return values;
}

/// In the steps of a sensor.
std::vector<double> in_steps(std::vector<double> values, double step) {
  for (double &value : values)
    value = step * std::round(value / step);
  return values;
}

SeenMotion motion(double k, double rate) {
  ChangingRoller roller;
  roller.k = [k](double) { return k; };
  roller.frequency = [](double) { return 30.7; };
  return seen_motion(roller, rate, 5.0, 0.0, 1);
}

// A share of the samples beyond the limit, at both ends or at one, with noise before or behind it.
TEST(SensorRange, IsReached) {
  for (const double rate : {500.0, 1000.0, 5000.0})
    for (const double k : {20e6, 45e6, 130e6}) {
      const std::vector<double> a = motion(k, rate).a_drum;
      std::vector<double> sorted = a, sizes;
      std::sort(sorted.begin(), sorted.end());
      for (const double value : a)
        sizes.push_back(std::fabs(value));
      std::sort(sizes.begin(), sizes.end());
      for (const double share : {0.1, 0.3, 0.5}) {
        SCOPED_TRACE("rate " + std::to_string(rate) + ", k " + std::to_string(k) + ", share " +
                     std::to_string(share));
        const auto place = static_cast<std::size_t>((1.0 - share) * static_cast<double>(a.size()));
        const auto cut = [](std::vector<double> values, double low, double high) {
          for (double &value : values)
            value = std::clamp(value, low, high);
          return values;
        };
        const double both = sizes[place], one = sorted[place];
        for (const auto &values :
             {cut(with_noise(a, 0.1), -both, both), in_steps(with_noise(cut(a, -both, both), 0.05), 0.02)}) {
          const AtLimit at = share_at_limit(values);
          EXPECT_NEAR(at.high + at.low, share, 0.35 * share);
        }
        const AtLimit at = share_at_limit(with_noise(cut(a, -1e9, one), 0.05));
        EXPECT_NEAR(at.high, share, 0.35 * share);
        EXPECT_EQ(at.low, 0.0);
      }
    }
}

// Samples that repeat with each cycle, without noise: few different values, far apart.
TEST(SensorRange, IsReachedWhereSamplesRepeat) {
  for (const double share : {0.6, 0.8}) {
    std::vector<double> wave;
    for (int i = 0; i < 3400; ++i)
      wave.push_back(std::clamp(std::sin(2.0 * M_PI * (i % 34) / 34.0 + 0.1), -share, share));
    const AtLimit at = share_at_limit(wave);
    EXPECT_GT(at.high, 0.1);
    EXPECT_GT(at.low, 0.1);
  }
}

// Waves, drums that lose contact, the frame, in fine and coarse steps, with and without noise.
TEST(SensorRange, IsNotReachedBySmoothSignals) {
  for (const double rate : {500.0, 1000.0, 30.7 * 34.0, 30.7 * 36.0, 30.7 * 40.0, 5000.0})
    for (const double k : {14e6, 30e6, 60e6, 110e6, 180e6}) {
      SeenMotion seen = motion(k, rate);
      std::vector<double> wave;
      for (const double t : seen.time)
        wave.push_back(80.0 * std::sin(2.0 * M_PI * 30.7 * t + 1e-7 * k));
      for (const std::vector<double> *signal : {&seen.a_drum, &seen.a_frame, &wave})
        for (const double noise : {0.0, 0.1, 1.0})
          for (const double step : {1e-4, 0.05, 0.6, 5.0}) {
            const AtLimit at = share_at_limit(in_steps(with_noise(*signal, noise), step));
            EXPECT_EQ(at.high + at.low, 0.0) << rate << " " << k << " " << noise << " " << step;
          }
    }
}

} // namespace
} // namespace drumlin::test
