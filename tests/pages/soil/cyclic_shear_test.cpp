// The report of cyclic simple shear tests: what it reads, measures, refuses and shows.
#include "report/soil/cyclic_shear.h"

#include "tests/support/checks.h"
#include "tests/support/element_report.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

namespace {

using namespace drumlin::post;
using namespace drumlin::test;
namespace test = drumlin::test;

const std::string header = "cycle,amplitude,secant_modulus_MPa,damping_ratio,damping_ratio_of_heat,"
                           "volumetric_strain,void_ratio\n";

class CyclicShearReport : public test::ElementReport {
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

// Seeds have moduli of their own: the ratio is that of each.
TEST_F(CyclicShearReport, ShowsTheRunsOnAPageOfTheirOwn) {
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

} // namespace
