// The report of biaxial and triaxial tests: what it reads, measures, refuses and shows.
#include "report/soil/compression.h"

#include "tests/support/checks.h"
#include "tests/support/element_report.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace drumlin::post;
using namespace drumlin::test;
namespace test = drumlin::test;

const std::string header =
    "strain,axial_stress_kPa,side_stress_kPa,volumetric_strain,side_strain,void_ratio,coordination,inertial_"
    "number,base_stress_kPa,left_stress_kPa,work_J,stored_J,contact_heat_J,energy_error\n";

constexpr double degree = 3.14159265358979323846 / 180.0;

/// Axial stress at which a friction angle is mobilised.
double axial_at(double side, double angle) {
  return side * (1.0 + std::sin(angle * degree)) / (1.0 - std::sin(angle * degree));
}

/// A sample whose friction angle is `peak` from 2 to 4 % of strain and `critical` from 6 % on, and which
/// dilates at an angle.
std::vector<CompressionRow> made_rows(double side, double peak, double critical, double dilatancy) {
  std::vector<CompressionRow> rows;
  for (int n = 0; n <= 150; ++n) {
    const double strain = 0.001 * n;
    const double angle = strain < 0.02 ? peak * strain / 0.02
                         : strain < 0.04
                             ? peak
                             : std::max(critical, peak + (critical - peak) * (strain - 0.04) / 0.02);
    const double sine = std::sin(dilatancy * degree);
    rows.push_back(
        {strain, axial_at(side, angle), side, -2.0 * sine / (1.0 - sine) * strain, 0.2, 3.0, 5e-4, 1e-5});
  }
  return rows;
}

TEST(CompressionStrength, IsThatOfTheCurve) {
  const Strength strength = strength_of(made_rows(100, 42, 27, 15));
  EXPECT_NEAR(strength.peak.angle(), 42, 1e-9);
  EXPECT_NEAR(strength.critical.angle(), 27, 1e-9);
  EXPECT_NEAR(strength.dilatancy, 15, 1e-9);
  EXPECT_TRUE(strength.is_critical);
  EXPECT_GE(strength.strain, 0.02);
  EXPECT_LE(strength.strain, 0.04);
}

// Axial minus side stress is E times the strain halfway to the row before, up to a constant: E50 is E.
TEST(CompressionStrength, HasTheModulusOfALinearSample) {
  std::vector<CompressionRow> rows = made_rows(100, 42, 42, 15);
  for (std::size_t n = 1; n < rows.size(); ++n)
    rows[n].axial_stress = 100 + std::min(50e3 * 0.5 * (rows[n - 1].strain + rows[n].strain), 400.0);
  EXPECT_NEAR(strength_of(rows).secant_modulus, 50, 1e-9);
}

// A short force chain late in the test is no peak, and a test that ends at 8 % has no critical state.
TEST(CompressionStrength, IsNotThatOfALateForceChain) {
  std::vector<CompressionRow> rows = made_rows(100, 42, 27, 15);
  for (std::size_t n = 90; n < 95; ++n)
    rows[n].axial_stress = axial_at(100, 60);
  EXPECT_NEAR(strength_of(rows).peak.angle(), 42, 1e-9);
  rows.resize(81);
  EXPECT_FALSE(strength_of(rows).is_critical);
}

TEST(MohrCoulombLine, HasAngleAndCohesionOfItsFailures) {
  // Failures of a soil with 40 degrees and 10 kPa: axial = side Kp + 2 c sqrt(Kp).
  const double kp = axial_at(1, 40);
  std::vector<Failure> failures;
  for (const double side : {50.0, 100.0, 200.0})
    failures.push_back({side * kp + 2 * 10 * std::sqrt(kp), side});
  MohrCoulomb line = fit_mohr_coulomb(failures);
  EXPECT_NEAR(line.angle, 40, 1e-6);
  EXPECT_NEAR(line.cohesion, 10, 1e-6);
  EXPECT_NEAR(line.highest_angle - line.lowest_angle, 0, 1e-5);
  failures[1].axial *= 1.1;
  line = fit_mohr_coulomb(failures);
  EXPECT_LT(line.lowest_angle, 40);
  EXPECT_GT(line.highest_angle, 40);
  EXPECT_GT(line.half_width, 10);
  EXPECT_THROW(fit_mohr_coulomb({failures[0], failures[2]}), std::invalid_argument);
  EXPECT_THROW(fit_mohr_coulomb({failures[0], failures[0], failures[0]}), std::invalid_argument);
}

class CompressionReport : public test::ElementReport {
protected:
  static std::string line(const CompressionRow &row) {
    return fmt::format("{},{},{},{},0,{},{},{},0,0,0,0,0,{}\n", row.strain, row.axial_stress, row.side_stress,
                       row.volumetric_strain, row.void_ratio, row.coordination, row.inertial_number,
                       row.energy_error);
  }

  void write_test(const std::string &folder, double side, int seed, double peak) const {
    std::string rows = header;
    for (const CompressionRow &row : made_rows(side, peak, 27, 15))
      rows += line(row);
    write_run(folder, "biaxial.csv", rows,
              fmt::format("deck,biaxial\nsample,random\nballs,{}\nside,{}\nseed,{}\nengine,E\n", 100 + seed,
                          side, seed));
  }
};

// Three side stresses, one of them with two seeds: one soil, one line for the peak and one for the critical
// state.
TEST_F(CompressionReport, ShowsTheRunsOnAPageOfTheirOwn) {
  write_test("tests/a", 50, 1, 42);
  write_test("tests/b", 100, 1, 41);
  write_test("tests/c, of \"c\"", 100, 2, 43);
  write_test("tests/d", 200, 1, 42);
  const std::string page = sound_page("tests", "biaxial", 2);
  EXPECT_TRUE(contains(page, "2 acceptance criteria hold"));
  const std::string angles = data("biaxial", "biaxial_angles");
  EXPECT_TRUE(contains(angles, {"soil 1: E,100,2,42.0 ± 12.7,41.0 to 43.0,15.0 ± 0.0,27.0 ± 0.0,27.0 to 27.0",
                                "soil 1: E,all,4,42.3 ± 8.5,41.0 to 43.0"}));
  const std::string lines = data("biaxial", "biaxial_lines");
  EXPECT_TRUE(contains(lines, "soil 1: E,critical,4,3,27.0,27.0 to 27.0"));
}

// The two side stresses of a triaxial test count as their mean; the page is a page of its own.
TEST_F(CompressionReport, ShowsTriaxialTests) {
  std::string rows = header.substr(0, header.size() - 1) + ",front_stress_kPa,back_stress_kPa\n";
  for (CompressionRow row : made_rows(100, 42, 27, 15)) {
    row.side_stress = 90;
    std::string text = line(row);
    text.pop_back();
    rows += text + ",110,110\n";
  }
  write_run("one", "triaxial.csv", rows, "sample,random\nballs,365\nside,100\nseed,1\nengine,E\n");
  sound_page("one", "triaxial", 1);
  const std::string angles = data("triaxial", "triaxial_angles");
  EXPECT_TRUE(contains(angles, "soil 1: E,100,1,42.0,42.0 to 42.0,15.0,27.0,27.0 to 27.0"));
}

// A run that was interrupted at half of its strain is not a good one.
TEST_F(CompressionReport, TellsThatARunWasInterrupted) {
  std::string rows = header;
  for (const CompressionRow &row : made_rows(100, 42, 27, 15))
    rows += line(row);
  write_run("half", "biaxial.csv", rows, "sample,random\nside,100\nseed,1\nstrain,0.3\n");
  const std::string page = sound_page("half", "biaxial", 1);
  EXPECT_TRUE(contains(
      page, {"every run reached at least 99 % of its strain", "2 of 3 acceptance criteria hold", "50 %"}));
}

TEST_F(CompressionReport, HasNoLineForOneSideStress) {
  write_test("one", 100, 1, 42);
  report("one");
  EXPECT_TRUE(std::filesystem::is_regular_file(root / "report" / "biaxial" / "index.html"));
  EXPECT_FALSE(std::filesystem::exists(root / "report" / "biaxial" / "data" / "biaxial_lines.csv"));
}

TEST_F(CompressionReport, RefusesWhatItCannotRead) {
  const std::string row = line({0.0, 100, 100, 0, 0.2, 3, 0, 0});
  const std::string good = header + row;
  expect_refused("biaxial.csv", good, "allowed are 2 or more");
  expect_refused("biaxial.csv", good + "0.1,x,100,0,0,0.2,3,0,0,0,0,0,0,0\n",
                 "column 'axial_stress_kPa' is 'x'");
  expect_refused("biaxial.csv", good + row, "allowed are strains that grow");
  expect_refused("biaxial.csv", good + line({0.1, 200, 0, 0, 0.2, 3, 0, 0}), "at stresses above 0");
  expect_refused("biaxial.csv", "strain\n0\n1\n", "axial_stress_kPa");
}

} // namespace
