// `drumlin study meter --quick`: the rows against closed forms and orbits, which do not use records, and an
// interrupted call that continues to the same result.
#include "map/meter_study/results.h"
#include "map/meter_study/study.h"
#include "map/regime.h"
#include "support/files.h"
#include "support/resumed.h"
#include "tests/support/checks.h"
#include "tests/support/page.h"
#include "tests/support/scratch_study.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;
using namespace post;

TEST(MeterStudy, TurningPointsAreThoseOfASequence) {
  using Turns = std::vector<std::size_t>;
  EXPECT_EQ(turning_points({0, 1, 2, 3}, 0.5), Turns{});
  EXPECT_EQ(turning_points({0, 1, 5, 3, 2, 4, 9}, 0.5), (Turns{2, 4}));
  EXPECT_EQ(turning_points({5, 3, 1, 2, 0, 4}, 2.5), Turns{4}) << "an up of 1 does not count";
  EXPECT_EQ(turning_points({0, 0.1, 0, 0.1}, 0.5), Turns{});
  EXPECT_EQ(turning_points({}, 0.5), Turns{});
}

// Regimes by their names as a meter has them.
std::string mode_of(Regime regime) {
  return regime == Regime::period_2 ? "double jump"
         : regime == Regime::higher_period || regime == Regime::aperiodic
             ? "irregular"
             : regime_names[static_cast<std::size_t>(regime)];
}

void expect_right(const SoilPoint &point) {
  SCOPED_TRACE(point.k);
  ChainParameters p = soil_machine(point.roller).chain;
  p.k = point.k;
  const RegimePoint orbit = judge_regime(p, 300);
  EXPECT_EQ(point.mode, mode_of(orbit.regime));
  EXPECT_EQ(point.mode == "continuous contact", contact_margin(p) > 0.0);
  EXPECT_NEAR(point.cmv, orbit.meter.cmv, 0.1);
  EXPECT_NEAR(point.rmv, orbit.meter.rmv, 0.1);
  EXPECT_NEAR(point.peak_force, orbit.meter.peak_force, 0.02 * orbit.meter.peak_force);
  EXPECT_NEAR(point.contact_share, orbit.meter.contact_share, 0.01);
  if (point.mode == "continuous contact") {
    EXPECT_NEAR(point.k_1, p.k, 1e-3 * p.k);
    EXPECT_NEAR(point.c_1, p.damping(), 1e-3 * p.damping());
  }
  EXPECT_NEAR(point.exact.k, p.k, 1e-6 * p.k);
  EXPECT_NEAR(point.measured.k, p.k, (point.mode == "continuous contact" ? 0.3 : 0.02) * p.k);
}

TEST(MeterStudy, RowsAgreeWithOrbitsAndAnInterruptedCallContinues) {
  const ScratchStudy study("meter");
  well(study.run());
  const fs::path rows = study.out() / "records.csv";
  const std::vector<SoilPoint> points = read_points(rows, soil_points());
  ASSERT_EQ(points.size(), 8U);
  for (const SoilPoint &point : points)
    expect_right(point);
  EXPECT_EQ(points.front().mode, "continuous contact");
  EXPECT_EQ(points[4].mode, "partial uplift");
  EXPECT_EQ(points.back().mode, "double jump");
  const std::string courses = read_text(study.out() / "data/courses.csv");

  interrupt(rows);
  fs::remove(study.out() / "index.html");
  well(study.run());
  EXPECT_EQ(read_points(rows, soil_points()).size(), 8U);
  EXPECT_EQ(read_text(study.out() / "data/courses.csv"), courses);
  expect_sound_page(study.out(), 10);
}

} // namespace
} // namespace drumlin::test
