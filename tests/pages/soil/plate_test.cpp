// The report of plate load tests: its moduli against a parabola that is known, what it reads, refuses and
// shows.
#include "report/soil/plate.h"

#include "tests/support/checks.h"
#include "tests/support/element_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace drumlin::post;
using namespace drumlin::test;
namespace test = drumlin::test;

/// Rows of a test with the settlement s = a1 p + a2 p^2 (mm, kPa) in the first loading, and 1 mm + b1 p in
/// the second.
std::vector<PlateRow> parabola(double a1, double a2, double b1) {
  std::vector<PlateRow> rows;
  for (const double stress : {10.0, 50.0, 100.0, 150.0, 200.0})
    rows.push_back({stress == 10.0 ? 0.0 : 1.0, stress, a1 * stress + a2 * stress * stress, 0.0, 0.0});
  for (const double stress : {100.0, 50.0, 10.0})
    rows.push_back({2.0, stress, 1.0 + b1 * stress, 0.0, 0.0});
  for (const double stress : {50.0, 100.0, 150.0})
    rows.push_back({3.0, stress, 1.0 + b1 * stress, 0.0, 0.0});
  return rows;
}

// DIN 18134: E_v = 1.5 r/(a1 + a2 p_max), which is 0.75 d over the slope of the chord from 0.3 to 0.7 p_max.
TEST(PlateResult, HasTheStrainModulusOfAParabola) {
  const double a1 = 4e-3, a2 = 3e-5, b1 = 2e-3, width = 0.3;
  const PlateResult result = plate_result(parabola(a1, a2, b1), width);
  const auto settlement = [&](double stress) { return a1 * stress + a2 * stress * stress; };
  const double chord = (0.7 - 0.3) * 200 / (settlement(140) - settlement(60)); // kPa/mm = MN/m3
  EXPECT_NEAR(result.first_reaction, chord, 1e-9 * chord);
  EXPECT_NEAR(result.first_modulus, 1.5 * (width / 2) / (a1 + a2 * 200), 1e-9);
  EXPECT_NEAR(result.second_reaction, 1 / b1, 1e-6);
  EXPECT_NEAR(result.second_modulus, 0.75 * width / b1, 1e-6);
  EXPECT_NEAR(result.ratio(), (a1 + a2 * 200) / b1, 1e-9);
  EXPECT_TRUE(std::isnan(result.bearing_capacity)); // 2 mm of 30
}

TEST(PlateResult, HasABearingCapacityOnlyIfItIsReached) {
  const std::vector<PlateRow> rows = {{0, 10, 0, 0, 0}, {1, 100, 10, 0, 0}, {1, 200, 50, 0, 0}};
  EXPECT_NEAR(plate_result(rows, 0.3).bearing_capacity, 150, 1e-9); // 30 mm
  EXPECT_TRUE(std::isnan(plate_result(rows, 0.6).bearing_capacity));
  EXPECT_TRUE(std::isnan(plate_result(rows, 0.3).second_modulus));
}

const std::string header = "phase,stress_kPa,settlement_mm,plate_force_N,inertial_number,coordination,work_J,"
                           "stored_J,contact_heat_J,drag_heat_J,energy_error\n";
const std::string seating = "0,10,0,3000,0,3,0,0,0,0,0\n";

class PlateReport : public test::ElementReport {
protected:
  /// A test whose first loading ends at 100 kPa with a settlement, mm.
  void write_test(const std::string &folder, double settlement, const std::string &error = "2e-6") const {
    std::string text = header + seating;
    const auto row = [&](int phase, double stress, double s) {
      text += std::to_string(phase) + "," + std::to_string(stress) + "," + std::to_string(s) +
              ",0,1e-4,3,1,0,1,0," + error + "\n";
    };
    for (const double stress : {40.0, 70.0, 100.0})
      row(1, stress, settlement * (stress - 10) / 90);
    row(2, 10, settlement / 2);
    for (const double stress : {40.0, 70.0})
      row(3, stress, settlement / 2 + settlement / 2 * (stress - 10) / 90);
    write_run(folder, "plate.csv", text,
              "deck,plate\nsample,gravel\nbed," + folder + "\nballs,100\nplate_width,0.3\nengine,LAMMPS\n");
  }
};

// k_s is 90 kPa over 1 mm and 3 mm in the first, twice as much in the second loading.
TEST_F(PlateReport, ShowsTheRunsOnAPageOfTheirOwn) {
  write_test("tests/one", 1);
  write_test("tests/two", 3, "2e-2"); // an energy error above the criterion
  const std::string page = sound_page("tests", "plate", 1);
  EXPECT_TRUE(contains(page, "1 of 2 acceptance criteria hold"));
  const std::string runs = data("plate", "plate_runs");
  EXPECT_TRUE(contains(runs, "one,gravel,100,0.3,100,1,90,180,20.25,40.5,2,,0.0001,2e-06"));
  const std::string soils = data("plate", "plate_soils");
  EXPECT_TRUE(contains(soils, "soil 1: LAMMPS,2,60.0 ± "));
  EXPECT_TRUE(contains(data("plate", "plate_rows"), "two,second loading,70,2.5\n"));
}

TEST_F(PlateReport, RefusesWhatItCannotRead) {
  expect_refused("plate.csv", header + seating, "allowed are 2 or more");
  expect_refused("plate.csv", header + seating + "1,x,1,1,1,1,1,1,1,1,1\n", "column 'stress_kPa' is 'x'");
  expect_refused("plate.csv", header + seating + "4,20,1,1,1,1,1,1,1,1,1\n", "column 'phase' is '4'");
  expect_refused("plate.csv", "phase\n0\n1\n", "stress_kPa");
}

TEST_F(PlateReport, NeedsTheWidthOfThePlate) {
  write_run("tests", "plate.csv", header + seating + "1,20,1,1,1,1,1,1,1,1,1\n", "deck,plate\n");
  EXPECT_TRUE(contains(error_of<UsageError>([this] { report("tests"); }),
                       "plate_width is ''; allowed: a number above 0"));
}

} // namespace
