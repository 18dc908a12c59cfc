// The report of tests of soil under its own weight: Rankine's, Janssen's and the slope's formulas, what it
// reads, refuses and shows.
#include "report/soil/own_weight.h"

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

constexpr double degree = 3.14159265358979323846 / 180.0;
const RestingSoil soil{12000.0, 0.8, 0.6}; // N, m, m

/// The force on both walls falls to that of a friction angle between rows 10 and 20 of 60, and grows again.
std::vector<OwnWeightRow> failing(double angle) {
  const double active = std::pow(std::tan((45 - angle / 2) * degree), 2) * 0.5 * 12000.0 / 0.8 * 0.6;
  std::vector<OwnWeightRow> rows;
  for (int n = 0; n <= 60; ++n) {
    const double force = n < 10 ? active * (2.0 - 0.1 * n) : n <= 20 ? active : 1.2 * active;
    rows.push_back({0.1 * n, force, 0, force, 0, 12000, 5e-4, 1e-5});
  }
  return rows;
}

TEST(ActiveState, HasTheFrictionAngleOfRankine) {
  const ActiveState state = active_state(failing(36), soil);
  EXPECT_NEAR(state.coefficient, std::pow(std::tan(27 * degree), 2), 1e-9);
  EXPECT_NEAR(state.angle(), 36, 1e-9);
  EXPECT_GE(state.displacement, 1.0);
  EXPECT_LE(state.displacement, 2.0);
}

/// Rows with the forces of a silo whose stresses follow from the differential equation of a slice of soil, d
/// sigma/dz = gamma - 2 mu K sigma/B, integrated in small steps.
std::vector<OwnWeightRow> silo(double coefficient, double friction) {
  double sigma = 0.0, normal = 0.0;
  constexpr int slices = 200000;
  for (int n = 0; n < slices; ++n) {
    const double dz = soil.height / slices, gamma = soil.weight / soil.width / soil.height;
    const double middle = sigma + 0.5 * dz * (gamma - 2 * friction * coefficient * sigma / soil.width);
    normal += coefficient * middle * dz; // of one wall
    sigma += dz * (gamma - 2 * friction * coefficient * middle / soil.width);
  }
  const OwnWeightRow row{0.0,  normal, friction * normal, normal, friction * normal, sigma * soil.width,
                         2e-5, 0};
  OwnWeightRow next = row;
  next.displacement = 1.0;
  return {row, next};
}

TEST(SiloState, HasTheCoefficientOfTheSliceOfSoil) {
  for (const double friction : {0.1, 0.5}) {
    const SiloState state = silo_state(silo(0.8, friction), soil, friction);
    EXPECT_NEAR(state.coefficient, 0.8, 1e-6);
    EXPECT_NEAR(state.floor_share, janssen(2 * friction * 0.8 * soil.height / soil.width), 1e-6);
    EXPECT_NEAR(state.friction_ratio, friction, 1e-12);
  }
  EXPECT_NEAR(silo_state(silo(0.8, 0.0), soil, 0.0).coefficient, 0.8, 1e-6);
  EXPECT_NEAR(silo_state(silo(0.8, 0.0), soil, 0.0).floor_share, 1, 1e-9);
  EXPECT_EQ(janssen(0), 1);
}

TEST(Slope, IsThatOfTheSurface) {
  std::vector<SurfacePoint> surface; // a summit, a slope of 30 degrees with bumps, the floor
  for (int n = 0; n < 120; ++n) {
    const double x = 0.01 * n, bump = n % 2 == 0 ? 2e-3 : -2e-3;
    surface.push_back({x, std::min(0.5, std::max(0.0, 0.55 - x * std::tan(30 * degree))) + bump});
  }
  const Slope slope = slope_of(surface, 0.04, false);
  EXPECT_NEAR(slope.angle, 30, 0.2);
  EXPECT_GT(slope.half_width, 0.0);
  EXPECT_LT(slope.half_width, 1.0);
  EXPECT_NEAR(slope.intercept, 0.55, 2e-3);
  const Slope level = slope_of({{0, 0.2}, {0.1, 0.21}, {0.2, 0.19}, {0.3, 0.2}, {0.4, 0.0}}, 0.04, true);
  EXPECT_NEAR(level.angle, 180 / 3.14159265358979 * std::atan(0.02),
              1e-6); // by hand; the line of the gap is left out
  EXPECT_TRUE(std::isnan(slope_of({{0, 0.2}, {0.1, 0.0}}, 0.04, false).angle));
}

class OwnWeightReport : public test::ElementReport {
protected:
  static std::string line(const OwnWeightRow &row) {
    return fmt::format("{},{},{},{},{},{},3,{},0,0,0,{}\n", row.displacement, row.left_force,
                       row.left_friction, row.side_force, row.side_friction, row.floor_force,
                       row.inertial_number, row.energy_error);
  }
  static std::string text(const std::vector<OwnWeightRow> &rows) {
    std::string all = "displacement_mm,left_force_N,left_friction_N,side_force_N,side_friction_N,floor_force_"
                      "N,coordination,inertial_number,work_J,stored_J,contact_heat_J,energy_error\n";
    for (const OwnWeightRow &row : rows)
      all += line(row);
    return all;
  }
  static std::string parameters(int seed, const std::string &more = "") {
    return fmt::format(
        "sample,random\nballs,100\nseed,{}\nradius,0.02\nfriction,0.8\nrolling,0.3\nplate_friction,0.3\n"
        "weight,12000\nwidth,0.8\nheight,0.6\nengine,E\n{}",
        seed, more);
  }
};

TEST_F(OwnWeightReport, ShowsWallsOnAPageOfTheirOwn) {
  write_run("tests/a", "wall.csv", text(failing(35)), parameters(1));
  write_run("tests/b", "wall.csv", text(failing(39)), parameters(2));
  const std::string page = sound_page("tests", "wall", 1);
  EXPECT_TRUE(contains(page, "2 acceptance criteria hold"));
  EXPECT_TRUE(contains(data("wall", "wall_soils"), {"soil 1: E,2,", ",37.0 ± 25.4"}));
}

TEST_F(OwnWeightReport, ShowsSilosOfSeveralHeightsWithOneLineOfJanssen) {
  write_run("tests/a", "silo.csv", text(silo(0.8, 0.3)), parameters(1, "layers,20\n"));
  write_run("tests/b", "silo.csv", text(silo(1.0, 0.3)), parameters(2, "layers,40\n"));
  sound_page("tests", "silo", 1);
  EXPECT_TRUE(contains(data("silo", "silo_runs"), ",0.3,0.8,0.9,"));
}

TEST_F(OwnWeightReport, ShowsHeapsOnAPageOfTheirOwn) {
  std::vector<OwnWeightRow> rows = {{0, 50, 0, 50, 0, 12000, 0, 0}, {1, 50, 0, 0, 0, 12000, 5e-4, 1e-5}};
  write_run("tests/a", "repose.csv", text(rows), parameters(1));
  std::string surface = "x_m,height_m\n";
  for (int n = 0; n < 40; ++n)
    surface += fmt::format("{},{}\n", 0.02 * n, std::max(0.0, 0.5 - 0.02 * n * std::tan(33 * degree)));
  write_files({{root / "tests/a/surface.csv", surface}});
  sound_page("tests", "repose", 1);
  EXPECT_TRUE(contains(data("repose", "repose_soils"), "0.8,0.3,1,33.0,33.0 to 33.0"));
}

// Three rows, as of a test that was killed. It is named, with the reason, and not judged; the others are as
// without it.
TEST_F(OwnWeightReport, NamesTestsThatWereCut) {
  const std::vector<OwnWeightRow> rows = failing(36);
  const std::string cut = text({rows[0], rows[1], rows[2]});
  for (const char *kind : {"wall", "silo", "repose"})
    write_run(std::string("cut/") + kind, std::string(kind) + ".csv", cut, parameters(1), "ended,no\n");
  write_run("cut/of 0.2", "wall.csv", cut, parameters(1), "");
  const std::string page = report("cut");
  EXPECT_TRUE(contains(page, {"4 folders are left out, and not judged",
                              "cut/silo</code>: it was killed, or is still running",
                              "cut/of 0.2</code>: its parameters.csv does not say whether it has ended"}));
  EXPECT_FALSE(contains(page, "acceptance criteria hold"));
  for (const char *kind : {"wall", "silo", "repose"})
    EXPECT_FALSE(std::filesystem::exists(root / "report" / kind));
  write_run("cut/whole", "wall.csv", text(failing(35)), parameters(1));
  EXPECT_TRUE(contains(report("cut"), "wall/index.html"));
  EXPECT_TRUE(contains(read_text(root / "report/wall/index.html"), "2 acceptance criteria hold"));
  EXPECT_FALSE(contains(read_text(root / "report/wall/data/wall_runs.csv"), "of 0.2"));
}

TEST_F(OwnWeightReport, RefusesWhatItCannotRead) {
  const std::vector<OwnWeightRow> rows = failing(36);
  const std::string good = text({rows[0], rows[1]});
  expect_refused("wall.csv", text({rows[0]}), "allowed are 2 or more");
  expect_refused("wall.csv", "displacement_mm\n0\n1\n", "left_force_N");
  expect_refused("silo.csv", good + line(rows[1]), "allowed: more than in the row before");
  expect_refused("repose.csv", good + "x,1,0,1,0,1,3,0,0,0,0,0\n", "column 'displacement_mm' is 'x'");
}

} // namespace
