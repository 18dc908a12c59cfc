#include "tests/support/page.h"
#include "tests/support/tool.h"
#include "report/report.h"
#include "bed/element_results.h"
#include "report/soil/pages.h"
#include "runs/element_rows.h"
#include "support/usage_error.h"

namespace drumlin::test {
namespace {

/// A folder for the runs, and the report of them.
class ElementReport : public WithSketches {
protected:
  /// Writes a run. \param parameters lines "name,value" \param ended their last row
  void write_run(const std::string &folder, const std::string &csv, const std::string &text,
                 const std::string &parameters, const std::string &ended = "ended,yes\n") const {
    std::filesystem::create_directories(root / folder);
    post::write_files({{root / folder / csv, text},
                       {root / folder / "parameters.csv", "name,value\n" + parameters + ended}});
  }

  /// Writes the report of a folder in `root` and returns the text of its first page.
  std::string report(const std::string &folder) const {
    post::ReportOptions options;
    options.folders = {root / folder};
    options.out = root / "report";
    return post::read_text(post::write_report(options).page);
  }

  /// The text of the page of a kind of test, after a report that must link to it.
  std::string sound_page(const std::string &folder, const std::string &kind, std::size_t images) const {
    EXPECT_TRUE(contains(report(folder), kind + "/index.html"));
    expect_sound_page(root / "report" / kind, images);
    return post::read_text(root / "report" / kind / "index.html");
  }

  /// The data behind a table of the page of a kind of test.
  std::string data(const std::string &kind, const std::string &table) const {
    return post::read_text(root / "report" / kind / "data" / (table + ".csv"));
  }

  /// Expects that a run whose file has this text is refused, with `says` and the name of the file in the
  /// message.
  void expect_refused(const std::string &csv, const std::string &text, const std::string &says) const {
    write_run("refused", csv, text, "");
    EXPECT_TRUE(contains(error_of<post::UsageError>([&] { report("refused"); }), {says, csv}));
    EXPECT_FALSE(std::filesystem::exists(root / "report"));
  }

private:
  Scratch scratch;

protected:
  const std::filesystem::path root = scratch.path();
};

// The report of biaxial and triaxial tests: what it reads, measures, refuses and shows.
namespace compression {

using namespace drumlin::post;

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

class CompressionReport : public ElementReport {
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
  draw();
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

} // namespace compression

// The report of simple shear tests: what it reads, measures, refuses and shows.
namespace shear {

using namespace drumlin::post;

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

class ShearReport : public ElementReport {
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
  draw();
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

} // namespace shear

// The report of cyclic simple shear tests: what it reads, measures, refuses and shows.
namespace cyclic_shear {

using namespace drumlin::post;

const std::string header = "cycle,amplitude,secant_modulus_MPa,damping_ratio,damping_ratio_of_heat,"
                           "volumetric_strain,void_ratio\n";

class CyclicShearReport : public ElementReport {
protected:
  /// A run of `cycles` cycles whose sample contracts by `contraction` in each. Energy errors before the first
  /// cycle are large.
  void write_test(const std::string &folder, double amplitude, int seed, double modulus, double damping,
                  double contraction, int cycles = 3, double energy_error = 1e-4) const {
    std::string loops = header;
    for (int cycle = 1; cycle <= cycles; ++cycle)
      loops += fmt::format("{},{},{},{},{},{},0.2\n", cycle, amplitude, modulus, damping, damping,
                           contraction * cycle);
    write_run(folder, "loops.csv", loops,
              fmt::format("sample,random\nballs,{}\nnormal,100\nseed,{}\nengine,E\namplitude,{}\ncycles,{}\n",
                          100 + seed, seed, amplitude, cycles));
    write_files({{root / folder / "shear.csv",
                  fmt::format("cycle,inertial_number,energy_error\n0,2e-4,0.5\n1,5e-4,{}\n", energy_error)}});
  }
};

// G/G_max of a run takes the largest modulus of the sample with the same seed, not that of another one.
TEST_F(CyclicShearReport, ShowsTheRunsOnAPageOfTheirOwn) {
  draw();
  write_test("tests/a", 1e-5, 1, 100, 0.005, 0);
  write_test("tests/b", 1e-5, 2, 200, 0.005, 0);
  write_test("tests/c", 1e-3, 1, 40, 0.10, 1e-4);
  write_test("tests/d", 1e-3, 2, 60, 0.12, 3e-4, 5);
  const std::string page = sound_page("tests", "loops", 2);
  EXPECT_TRUE(contains(page, "2 acceptance criteria hold"));
  const std::string soils = data("loops", "loops_soils");
  // Of three cycles, which both runs have: 0.06 % is the mean of 0.03 and 0.09 %.
  EXPECT_TRUE(contains(soils, {"soil 1: E,0.001,2,3,0.000 ± 0.000,", ",1.000 ± 0.000,",
                               "soil 1: E,0.1,2,3,0.060 ± ", ",50.0 ± ", ",0.350 ± ", ",0.110 ± "}));
  EXPECT_TRUE(contains(data("loops", "loops_runs"), {",3 of 3,", ",5 of 5,"}));
  EXPECT_TRUE(contains(data("loops", "loops_amplitude"),
                       {"soil 1,0.1,0.06,0.35,0.11", "sand: mean,0.1,,0.29,0.155"}));
}

TEST_F(CyclicShearReport, HasNoModulusRatioOfOneAmplitude) {
  write_test("tests/a", 1e-3, 1, 40, 0.10, 1e-4, 1);
  sound_page("tests", "loops", 1); // and too few cycles for the second figure
  EXPECT_TRUE(contains(data("loops", "loops_soils"), "soil 1: E,0.1,1,1,0.010,0.200,40.0,,0.100,0.100"));
}

TEST_F(CyclicShearReport, MarksRunsThatMissTheCriteria) {
  write_test("tests/a", 1e-3, 1, 40, 0.10, 1e-4, 3, 2e-3);
  EXPECT_TRUE(contains(sound_page("tests", "loops", 2), "1 of 2 acceptance criteria hold"));
}

TEST_F(CyclicShearReport, RefusesWhatItCannotRead) {
  expect_refused("loops.csv", header, "0 rows; allowed are 1 or more");
  expect_refused("loops.csv", header + "1,1e-3,x,0,0,0,0.2\n", "column 'secant_modulus_MPa' is 'x'");
  expect_refused("loops.csv", "cycle\n1\n", "amplitude");
}

} // namespace cyclic_shear

// The reports of the oedometer, of the loosest and the densest packing, and of plate load tests.
using namespace drumlin::post;

// The report of runs of the oedometer: what it reads, refuses and shows.
namespace oedometer {

const std::string header = "stress_kPa,settlement_mm,strain,void_ratio,porosity,modulus_MPa,inertial_number,"
                           "coordination,work_J,stored_J,contact_heat_J,drag_heat_J,energy_error\n";

class OedometerReport : public ElementReport {
protected:
  /// Writes an oedometer test of three loads. \param error of the energy balance at the last one
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
  draw();
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
  draw();
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
  EXPECT_TRUE(contains(read_text(root / "report/density/index.html"),
                       "Void ratio of the loosest packing 0.500 ± 0.254, of the frictionless 0.250 ± 0.000"));
}

// With a shaken packing every row says how its packing was made.
TEST_F(DensityReport, SaysWhichPackingWasShaken) {
  std::string columns = header;
  columns.insert(columns.size() - 1, ",made");
  write_run("run", "density.csv",
            columns + "1,0.8,0.45,0.5,0.667,0,0.9,3.1,poured\n1,0.8,0.45,0.3,0.769,1,1,3.5,shaken\n"
                      "0,0,0,0.25,0.8,1.25,1.04,3.9,frictionless\n",
            "deck,density\nsample,random\nseed,1\n");
  EXPECT_TRUE(contains(report("run"), "density/index.html"));
  EXPECT_TRUE(contains(read_text(root / "report/density/index.html"),
                       "Void ratio of the loosest packing 0.500, of the shaken 0.300"));
  EXPECT_TRUE(contains(data("density", "density_packings"), ",frictionless,"));
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

class PlateReport : public ElementReport {
protected:
  /// Writes a plate load test. \param settlement of the plate at the end of the first loading, 100 kPa, in mm
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
  draw();
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

// The report of tests of soil under its own weight: Rankine's, Janssen's and the slope's formulas, what it
// reads, refuses and shows.
namespace own_weight {

using namespace drumlin::post;

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

class OwnWeightReport : public ElementReport {
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
  draw();
  write_run("tests/a", "wall.csv", text(failing(35)), parameters(1));
  write_run("tests/b", "wall.csv", text(failing(39)), parameters(2));
  const std::string page = sound_page("tests", "wall", 1);
  EXPECT_TRUE(contains(page, "2 acceptance criteria hold"));
  EXPECT_TRUE(contains(data("wall", "wall_soils"), {"soil 1: E,2,", ",37.0 ± 25.4"}));
}

TEST_F(OwnWeightReport, ShowsSilosOfSeveralHeightsWithOneLineOfJanssen) {
  draw();
  write_run("tests/a", "silo.csv", text(silo(0.8, 0.3)), parameters(1, "layers,20\n"));
  write_run("tests/b", "silo.csv", text(silo(1.0, 0.3)), parameters(2, "layers,40\n"));
  sound_page("tests", "silo", 1);
  EXPECT_TRUE(contains(data("silo", "silo_runs"), ",0.3,0.8,0.9,"));
}

TEST_F(OwnWeightReport, ShowsHeapsOnAPageOfTheirOwn) {
  draw();
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

} // namespace own_weight

} // namespace
} // namespace drumlin::test
