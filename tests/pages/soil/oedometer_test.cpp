// The reports of the oedometer, of the loosest and the densest packing, and of plate load tests.
#include "tests/support/checks.h"
#include "tests/support/element_report.h"

#include "report/soil/oedometer.h"
#include "report/soil/plate.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace drumlin;
using namespace drumlin::post;
using namespace drumlin::test;

// The report of runs of the oedometer: what it reads, refuses and shows.
namespace oedometer {

const std::string header = "stress_kPa,settlement_mm,strain,void_ratio,porosity,modulus_MPa,inertial_number,"
                           "coordination,work_J,stored_J,contact_heat_J,drag_heat_J,energy_error\n";

class OedometerReport : public test::ElementReport {
protected:
  /// A run of three loads whose last energy error is given.
  void write_loads(const std::string &folder, const std::string &error = "2e-6") const {
    write_run(folder, "oedometer.csv",
              header +
                  "5,0,0,0.2,0.167,,0,2.5,0,0,0,0,0\n"
                  "25,0.5,0.0005,0.199,0.166,40,1e-4,3,1,0.5,0.3,0.2,1e-6\n"
                  "100,1.5,0.0015,0.198,0.165,75,2e-4,3.5,9,6,2,1,2e-6\n"
                  "25,0.75,0.00075,0.199,0.166,100,2e-4,3,5,1,3,1," +
                  error + "\n",
              "deck,oedometer\nsample,random\nballs,100\nfriction,0.5\nk,1e8\n");
  }
};

TEST_F(OedometerReport, ReadsTheRows) {
  write_loads("one");
  const std::vector<OedometerRow> rows = read_oedometer(root / "one" / "oedometer.csv");
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_TRUE(std::isnan(rows[0].modulus));
  EXPECT_EQ(rows[3].stress, 25);
  EXPECT_EQ(rows[3].settlement, 0.75);
  EXPECT_EQ(rows[3].strain, 0.00075);
  EXPECT_EQ(rows[3].void_ratio, 0.199);
  EXPECT_EQ(rows[3].modulus, 100);
  EXPECT_EQ(rows[3].inertial_number, 2e-4);
  EXPECT_EQ(rows[3].energy_error, 2e-6);
}

TEST_F(OedometerReport, ShowsTheRunsOnAPageOfTheirOwn) {
  write_loads("tests/one");
  write_loads("tests/two, of \"two\"", "2e-2"); // an energy error above the criterion
  const std::string page = sound_page("tests", "oedometer", 1);
  EXPECT_TRUE(contains(page, {"1 of 2 acceptance criteria hold", "largest energy error at most 0.001"}));
  const std::string runs = data("oedometer", "oedometer_runs");
  EXPECT_TRUE(contains(runs, "one,random,100,0.5,1e8,0.2,1.5,0.75,75,100,0.0002,2e-06"));
}

TEST_F(OedometerReport, RefusesWhatItCannotRead) {
  const std::string first = header + "5,0,0,0.2,0.167,,0,2.5,0,0,0,0,0\n";
  expect_refused("oedometer.csv", first, "allowed are 2 or more");
  expect_refused("oedometer.csv", first + "9,1,x,1,1,1,1,1,1,1,1,1,1\n", "column 'strain' is 'x'");
  expect_refused("oedometer.csv", first + "9,1,1,1,1,nan,1,1,1,1,1,1,1\n", "column 'modulus_MPa' is 'nan'");
  expect_refused("oedometer.csv", "stress_kPa\n5\n6\n", "settlement_mm");
}

} // namespace oedometer

// The report of the loosest and the densest packing: what it reads, refuses and shows.
namespace density {

const std::string header =
    "share,friction,rolling,void_ratio,solid_fraction,relative_density,compaction,coordination\n";
const std::string dense_row = "0,0,0,0.25,0.8,1,1,3.9\n";

class DensityReport : public ElementReport {};

// Two seeds of one soil: means of 0.50 and 0.25, and every packing in a table.
TEST_F(DensityReport, ShowsTheLoosestAndTheDensest) {
  for (const char *seed : {"1", "2"})
    write_run("runs/" + std::string(seed), "density.csv",
              fmt::format("{}{}{}0.5,0.4,0.225,0.4,0.7143,0.4,0.893,3.3\n", header,
                          seed[0] == '1' ? "1,0.8,0.45,0.48,0.6757,0,0.845,3.1\n"
                                         : "1,0.8,0.45,0.52,0.6579,0,0.822,3\n",
                          dense_row),
              "deck,density\nsample,random\nseed," + std::string(seed) + "\n");
  EXPECT_TRUE(contains(report("runs"), "density/index.html"));
  expect_sound_page(root / "report/density", 1, "index.html", 0);
  // Student's t of two values is 12.71, the standard deviation of the mean 0.02.
  EXPECT_TRUE(contains(data("density", "density_soils"), "0.500 ± 0.254"));
  EXPECT_TRUE(contains(data("density", "density_soils"), "0.250 ± 0.000"));
  EXPECT_TRUE(contains(data("density", "density_packings"), "0.225"));
}

TEST_F(DensityReport, RefusesDamagedFiles) {
  expect_refused("density.csv", header + dense_row, "1 rows");
  expect_refused("density.csv", header + dense_row + "1,0.8,0.45,much,0.7,0,0.9,3\n", "much");
}

} // namespace density

// The report of plate load tests: its moduli against a parabola that is known, what it reads, refuses and
// shows.
namespace plate {

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

} // namespace plate

} // namespace
