// `drumlin study meter --quick`: the rows against closed forms, and an
// interrupted call that continues to the same result.
#include "map/course.h"
#include "map/meter_study.h"
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

const MapAxis axis = {"k", 1e6, 200e6, 8, true};

void expect_right(const CoursePoint &point) {
  SCOPED_TRACE(point.value);
  EXPECT_EQ(point.roller, "Axas2020-29Hz");
  const double k = point.value;
  const bool held = point.motion.regime == Regime::continuous_contact;
  ChainParameters p = soil_machine(point.roller).chain;
  p.k = k;
  EXPECT_EQ(held, contact_margin(p) > 0.0);
  if (held) {
    EXPECT_NEAR(point.motion.meter.k_1, k, 1e-9 * k);
    EXPECT_NEAR(point.motion.meter.c_1, p.damping(), 1e-9 * p.damping());
  }
  EXPECT_NEAR(point.exact.k, k, 1e-6 * k);
  EXPECT_NEAR(point.exact.D, p.D, 1e-6);
  EXPECT_NEAR(point.measured.k, k, (held ? 0.3 : 0.02) * k);
  EXPECT_GT(point.E_vib, 0.0);
}

TEST(MeterStudy, RowsAgreeWithOrbitsAndAnInterruptedCallContinues) {
  const ScratchStudy study("meter");
  well(study.run());
  const fs::path rows = study.out() / "records.csv";
  const CsvSchema<CoursePoint> columns = course_columns(axis, true);
  const std::vector<CoursePoint> points = read_points(rows, columns);
  ASSERT_EQ(points.size(), 8U);
  for (const CoursePoint &point : points)
    expect_right(point);
  EXPECT_EQ(points.front().motion.regime, Regime::continuous_contact);
  EXPECT_EQ(points[4].motion.regime, Regime::partial_uplift);
  EXPECT_EQ(points.back().motion.regime, Regime::period_2);
  const std::string courses = read_text(study.out() / "data/courses.csv");

  interrupt(rows);
  fs::remove(study.out() / "index.html");
  well(study.run());
  EXPECT_EQ(read_points(rows, columns).size(), 8U);
  EXPECT_EQ(read_text(study.out() / "data/courses.csv"), courses);
  expect_sound_page(study.out(), 11);
}

} // namespace
} // namespace drumlin::test
