// Where the exciter changes while a roller is recorded, and where it does not: records of an integrator that
// shares no code with the tools.
#include "record/stretches.h"
#include "tests/support/changing_roller.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace drumlin::test {
namespace {

using namespace post;

/// From one value to another between two times.
double ramp(double t, double begin, double end, double from, double to) {
  return t <= begin ? from : t >= end ? to : from + (to - from) * (t - begin) / (end - begin);
}

struct Found {
  std::vector<Stretch> stretches;
  double interval;
  std::size_t samples;
};
Found found(const ChangingRoller &roller, double rate = 1054.0, double length = 12.0) {
  const SeenMotion seen = seen_motion(roller, rate, length, 0.3, 1);
  return {stretches_of(seen.a_drum, seen.interval, 2.0 * M_PI * 30.5), seen.interval, seen.a_drum.size()};
}

// Every change of the exciter lies between two stretches, of which little is lost.
TEST(Stretches, EndWhereTheExciterChanges) {
  struct Case {
    const char *name;
    ChangingRoller::OfTime ChangingRoller::*of;
    ChangingRoller::OfTime value;
    double begin, end;            // of the change
    std::vector<double> settings; // frequency of each stretch [Hz]
  };
  const std::vector<Case> cases = {
      {"280 kN, then 150",
       &ChangingRoller::me_re,
       [](double t) { return t < 6.0 ? 7.38 : 3.95; },
       6,
       6,
       {31, 31}},
      {"150 kN, then 220",
       &ChangingRoller::me_re,
       [](double t) { return t < 6.0 ? 3.95 : 5.8; },
       6,
       6,
       {31, 31}},
      {"slower", &ChangingRoller::me_re, [](double t) { return ramp(t, 5, 7, 7.38, 3.95); }, 5, 7, {31, 31}},
      {"far slower",
       &ChangingRoller::me_re,
       [](double t) { return ramp(t, 4, 8, 7.38, 3.95); },
       4,
       8,
       {31, 31}},
      {"31, then 34 Hz",
       &ChangingRoller::frequency,
       [](double t) { return t < 6.0 ? 31.0 : 34.0; },
       6,
       6,
       {31, 34}},
      {"31, then 31.4 Hz",
       &ChangingRoller::frequency,
       [](double t) { return t < 6.0 ? 31.0 : 31.4; },
       6,
       6,
       {31, 31.4}},
      {"slowly", &ChangingRoller::frequency, [](double t) { return ramp(t, 5, 7, 31, 30); }, 5, 7, {31, 30}},
      {"another phase", &ChangingRoller::jump, [](double t) { return t < 6.0 ? 0.0 : 2.0; }, 6, 6, {31, 31}},
      {"begun again",
       &ChangingRoller::me_re,
       [](double t) { return t < 5 || t > 6 ? 7.38 : 0.0; },
       5,
       6,
       {31, 31}},
      {"off before", &ChangingRoller::me_re, [](double t) { return t < 3.0 ? 0.0 : 7.38; }, 0, 3, {31}},
      {"running up",
       &ChangingRoller::frequency,
       [](double t) { return ramp(t, 1, 4, 0.01, 31); },
       0,
       4,
       {31}},
      {"fading", &ChangingRoller::frequency, [](double t) { return ramp(t, 8, 12, 31, 0.01); }, 8, 12, {31}}};
  for (const Case &one : cases) {
    SCOPED_TRACE(one.name);
    ChangingRoller roller;
    roller.*one.of = one.value;
    const auto [stretches, interval, samples] = found(roller);
    ASSERT_EQ(stretches.size(), one.settings.size());
    constexpr double in_the_change = 0.2, lost = 1.0; // s
    double kept = 0.0;
    for (std::size_t n = 0; n < stretches.size(); ++n) {
      const double begin = interval * static_cast<double>(stretches[n].first),
                   end = interval * static_cast<double>(stretches[n].end);
      kept += end - begin;
      EXPECT_NEAR(stretches[n].omega / (2.0 * M_PI), one.settings[n], 0.05);
      if (begin < one.begin)
        EXPECT_LT(end, one.begin + in_the_change);
      else
        EXPECT_GT(begin, one.end - in_the_change);
    }
    EXPECT_GT(kept, interval * static_cast<double>(samples) - (one.end - one.begin) - lost);
  }
  ChangingRoller standing;
  standing.me_re = [](double) { return 0.0; };
  EXPECT_TRUE(found(standing).stretches.empty());
}

// Steady motion, soil that changes along the way, and a short record. Of aperiodic motion, on hard soil, one
// in some twenty is cut.
TEST(Stretches, DoNotCutASteadyExciter) {
  const auto is_whole = [](const ChangingRoller &roller, double rate, double length) {
    const auto [stretches, interval, samples] = found(roller, rate, length);
    return stretches.size() == 1 && stretches[0].first == 0 && stretches[0].end == samples &&
           std::fabs(stretches[0].omega / (2.0 * M_PI) - 31.0) < (length > 1.0 ? 0.05 : 0.3);
  };
  ChangingRoller roller;
  for (const double k : {12e6, 25e6, 40e6, 60e6}) {
    roller.k = [k](double) { return k; };
    EXPECT_TRUE(is_whole(roller, 1054.0, 12.0)) << k;
    EXPECT_TRUE(is_whole(roller, 500.0, 6.0)) << k;
    EXPECT_TRUE(is_whole(roller, 1000.0, 0.3)) << k;
  }
  for (const double seconds : {4.0, 11.0}) {
    roller.k = [seconds](double t) { return ramp(t, 0.5, 0.5 + seconds, 20e6, 80e6); };
    EXPECT_TRUE(is_whole(roller, 1000.0, 12.0)) << seconds;
  }
  int whole = 0, made = 0;
  for (const double k : {70e6, 80e6, 100e6, 120e6, 140e6, 170e6, 200e6})
    for (const double length : {8.0, 16.0}) {
      roller.k = [k](double) { return k; };
      whole += is_whole(roller, 1000.0, length) ? 1 : 0;
      ++made;
    }
  EXPECT_GE(whole, made - 3);
}

} // namespace
} // namespace drumlin::test
