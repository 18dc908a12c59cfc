// The report of biaxial tests: what it reads, measures, refuses and shows.
#include "report/biaxial_page.h"

#include "report/report.h"
#include "support/files.h"
#include "support/usage_error.h"
#include "tests/support/page.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace drumlin::post;
namespace test = drumlin::test;
namespace fs = std::filesystem;

const std::string header =
    "strain,axial_stress_kPa,side_stress_kPa,volumetric_strain,side_strain,void_ratio,coordination,"
    "inertial_number,base_stress_kPa,left_stress_kPa,work_J,stored_J,contact_heat_J,energy_error\n";

constexpr double degree = 3.14159265358979323846 / 180.0;

/// Axial stress at which a friction angle is mobilised.
double axial_at(double side, double angle) {
  return side * (1.0 + std::sin(angle * degree)) / (1.0 - std::sin(angle * degree));
}

/// A sample whose friction angle is `peak` from 2 to 4 % of strain and `critical` from 6 % on, and which dilates at an angle.
std::vector<BiaxialRow> made_rows(double side, double peak, double critical, double dilatancy) {
  std::vector<BiaxialRow> rows;
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

TEST(BiaxialStrength, IsThatOfTheCurve) {
  const BiaxialStrength strength = strength_of(made_rows(100, 42, 27, 15));
  EXPECT_NEAR(strength.peak.angle(), 42, 1e-9);
  EXPECT_NEAR(strength.critical.angle(), 27, 1e-9);
  EXPECT_NEAR(strength.dilatancy, 15, 1e-9);
  EXPECT_TRUE(strength.is_critical);
  EXPECT_GE(strength.strain, 0.02);
  EXPECT_LE(strength.strain, 0.04);
}

// A short force chain late in the test is no peak, and a test that ends at 8 % has no critical state.
TEST(BiaxialStrength, IsNotThatOfALateForceChain) {
  std::vector<BiaxialRow> rows = made_rows(100, 42, 27, 15);
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

class BiaxialReport : public ::testing::Test {
protected:
  BiaxialReport() : root(fs::temp_directory_path() / fmt::format("drumlin-biaxial-{}", ::getpid())) {
    fs::remove_all(root);
  }
  ~BiaxialReport() override {
    std::error_code ignored;
    fs::remove_all(root, ignored);
  }

  static std::string line(const BiaxialRow &row) {
    return fmt::format("{},{},{},{},0,{},{},{},0,0,0,0,0,{}\n", row.strain, row.axial_stress, row.side_stress,
                       row.volumetric_strain, row.void_ratio, row.coordination, row.inertial_number,
                       row.energy_error);
  }

  void write_run(const std::string &name, double side, int seed, double peak) const {
    fs::create_directories(root / name);
    std::string rows = header;
    for (const BiaxialRow &row : made_rows(side, peak, 27, 15))
      rows += line(row);
    write_files(
        {{root / name / "biaxial.csv", rows},
         {root / name / "parameters.csv",
          fmt::format("name,value\ndeck,biaxial\nsample,random\nballs,{}\nside,{}\nseed,{}\nengine,E\n",
                      100 + seed, side, seed)}});
  }

  fs::path report(const std::string &name) const {
    ReportOptions options;
    options.folders = {root / name};
    options.out = root / "report";
    return write_report(options).page;
  }

  fs::path root;
};

// Three side stresses, one of them with two seeds: one soil, one line for the peak and one for the critical state.
TEST_F(BiaxialReport, ShowsTheRunsOnAPageOfTheirOwn) {
  write_run("tests/a", 50, 1, 42);
  write_run("tests/b", 100, 1, 41);
  write_run("tests/c, of \"c\"", 100, 2, 43);
  write_run("tests/d", 200, 1, 42);
  const std::string first = read_text(report("tests"));
  EXPECT_NE(first.find("biaxial/index.html"), std::string::npos);
  const fs::path page = root / "report" / "biaxial";
  const std::string text = read_text(page / "index.html");
  const test::Parsed shown = test::parse(text);
  EXPECT_TRUE(shown.well_formed) << shown.error;
  EXPECT_NE(text.find("2 acceptance criteria hold"), std::string::npos);
  for (const std::string &link : shown.links)
    EXPECT_TRUE(link.front() == '#' || fs::is_regular_file(page / test::file_of(link))) << link;
  const std::string angles = read_text(page / "data" / "biaxial_angles.csv");
  EXPECT_NE(angles.find("soil 1: E,100,2,42.0 ± 12.7,41.0 to 43.0,15.0 ± 0.0,27.0 ± 0.0,27.0 to 27.0"),
            std::string::npos)
      << angles;
  EXPECT_NE(angles.find("soil 1: E,all,4,42.3 ± 8.5,41.0 to 43.0"), std::string::npos) << angles;
  const std::string lines = read_text(page / "data" / "biaxial_lines.csv");
  EXPECT_NE(lines.find("soil 1: E,critical,4,3,27.0,27.0 to 27.0"), std::string::npos) << lines;
}

TEST_F(BiaxialReport, HasNoLineForOneSideStress) {
  write_run("one", 100, 1, 42);
  report("one");
  EXPECT_TRUE(fs::is_regular_file(root / "report" / "biaxial" / "index.html"));
  EXPECT_FALSE(fs::exists(root / "report" / "biaxial" / "data" / "biaxial_lines.csv"));
}

TEST_F(BiaxialReport, RefusesWhatItCannotRead) {
  write_run("cut", 100, 1, 42);
  const std::string row = line({0.0, 100, 100, 0, 0.2, 3, 0, 0});
  const std::string good = header + row;
  for (const auto &[text, says] :
       {std::pair<std::string, std::string>{good, "allowed are 2 or more"},
        {good + "0.1,x,100,0,0,0.2,3,0,0,0,0,0,0,0\n", "column 'axial_stress_kPa' is 'x'"},
        {good + row, "allowed are strains that grow"},
        {good + line({0.1, 200, 0, 0, 0.2, 3, 0, 0}), "at stresses above 0"},
        {"strain\n0\n1\n", "axial_stress_kPa"}}) {
    write_files({{root / "cut" / "biaxial.csv", text}});
    try {
      report("cut");
      ADD_FAILURE() << text;
    } catch (const UsageError &error) {
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("biaxial.csv"), std::string::npos) << error.what();
    }
  }
  EXPECT_FALSE(fs::exists(root / "report"));
}

} // namespace
