// The report of simple shear tests: what it reads, measures, refuses and shows.
#include "report/soil/shear.h"

#include "tests/support/checks.h"
#include "tests/support/element_report.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace drumlin::post;
using namespace drumlin::test;
namespace test = drumlin::test;

const std::string header = "shear_strain,shear_stress_kPa,normal_stress_kPa,volumetric_strain,void_ratio,"
                           "coordination,inertial_number,work_J,stored_J,contact_heat_J,energy_error\n";

constexpr double degree = 3.14159265358979323846 / 180.0;

/// A sample with a friction of `peak` degrees from 5 to 10 % of strain and `critical` from 20 % on, which
/// dilates at an angle to 10 %.
std::vector<ShearRow> made_rows(double normal, double peak, double critical, double dilatancy) {
  std::vector<ShearRow> rows;
  for (int n = 0; n <= 200; ++n) {
    const double strain = 0.002 * n;
    const double angle = strain < 0.05   ? peak * strain / 0.05
                         : strain < 0.10 ? peak
                         : strain < 0.20 ? peak + (critical - peak) * (strain - 0.10) / 0.10
                                         : critical;
    rows.push_back({strain, normal * std::tan(angle * degree), normal,
                    -std::tan(dilatancy * degree) * std::min(strain, 0.10), 0.2, 5e-4, 1e-5});
  }
  return rows;
}

TEST(ShearStrength, IsThatOfTheCurve) {
  const ShearStrength strength = shear_strength_of(made_rows(100, 36, 22, 12));
  EXPECT_NEAR(strength.peak.angle(), 36, 1e-9);
  EXPECT_NEAR(strength.peak.dilatancy, 12, 1e-9);
  EXPECT_GE(strength.strain, 0.05);
  EXPECT_LE(strength.strain, 0.10);
  EXPECT_NEAR(strength.critical.angle(), 22, 1e-9);
  EXPECT_NEAR(strength.critical.dilatancy, 0, 1e-9);
  EXPECT_TRUE(strength.is_critical);
}

TEST(ShearStrength, HasNoCriticalValueIfTheTestIsShort) {
  std::vector<ShearRow> rows = made_rows(100, 36, 22, 12);
  rows.resize(100); // to a strain of 0.198
  EXPECT_FALSE(shear_strength_of(rows).is_critical);
}

// A stress state at its limit with friction angle 40 degrees, mean 1: on the plane that a material with
// dilatancy angle 15 degrees shears along, whose normal is inclined by 45 + 15/2 degrees to the larger
// stress, the stresses follow from Mohr's circle.
TEST(ShearStrength, FollowsDavis) {
  const double radius = std::sin(40 * degree), psi = 15;
  const double normal = 1 - radius * std::sin(psi * degree), shear = radius * std::cos(psi * degree);
  EXPECT_NEAR((ShearFailure{shear / normal, psi}.davis_angle()), 40, 1e-9);
  EXPECT_NEAR((ShearFailure{std::sin(40 * degree), 0}.davis_angle()), 40, 1e-9);
}

class ShearReport : public test::ElementReport {
protected:
  static std::string line(const ShearRow &row) {
    return fmt::format("{},{},{},{},{},3,{},0,0,0,{}\n", row.strain, row.shear_stress, row.normal_stress,
                       row.volumetric_strain, row.void_ratio, row.inertial_number, row.energy_error);
  }

  void write_test(const std::string &folder, double normal, int seed, double peak) const {
    std::string rows = header;
    for (const ShearRow &row : made_rows(normal, peak, 22, 0))
      rows += line(row);
    write_run(
        folder, "shear.csv", rows,
        fmt::format("sample,random\nballs,{}\nnormal,{}\nseed,{}\nengine,E\n", 100 + seed, normal, seed));
  }
};

TEST_F(ShearReport, ShowsTheRunsOnAPageOfTheirOwn) {
  write_test("tests/a", 50, 1, 36);
  write_test("tests/b", 100, 1, 35);
  write_test("tests/c", 100, 2, 37);
  const std::string page = sound_page("tests", "shear", 1);
  EXPECT_TRUE(contains(page, "2 acceptance criteria hold"));
  const std::string angles = data("shear", "shear_angles");
  EXPECT_TRUE(contains(angles, {"soil 1: E,100,2,36.0 ± 12.7,0.0 ± 0.0,", "soil 1: E,all,3,"}));
}

TEST_F(ShearReport, RefusesWhatItCannotRead) {
  const std::string row = line({0.0, 0, 100, 0, 0.2, 0, 0});
  const std::string good = header + row;
  expect_refused("shear.csv", good, "allowed are 2 or more");
  expect_refused("shear.csv", good + "0.1,x,100,0,0.2,3,0,0,0,0,0\n", "column 'shear_stress_kPa' is 'x'");
  expect_refused("shear.csv", good + row, "allowed are strains that grow");
  expect_refused("shear.csv", good + line({0.1, 10, 0, 0, 0.2, 0, 0}), "at normal stresses above 0");
  expect_refused("shear.csv", "shear_strain\n0\n1\n", "shear_stress_kPa");
}

} // namespace
