// The simple shear test: a hexagonal lattice against its strength and stiffness in closed form, a disordered
// sample in both engines.
#include "tests/support/element_runs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

class Shear : public InEngine {};

/// Shear stress over normal stress of each row.
std::vector<double> ratios(const post::Table &table) {
  std::vector<double> values = table.numbers("shear_stress_kPa");
  const std::vector<double> normal = table.numbers("normal_stress_kPa");
  for (std::size_t n = 0; n < values.size(); ++n)
    values[n] /= normal[n];
  return values;
}

// A hexagonal lattice with rows along the platen has contacts at 60 degrees to the rows. Since all balls but
// those of the plates turn freely, these contacts carry no friction: with equal angular velocities neighbours
// roll on each other. Under shear one contact of each ball with the row below is compressed and the other
// unloaded, by half the displacement u of the row: the shear force of a ball is kn u/2, and the modulus,
// force over width times row height over displacement, is root3/4 kn. With an even number of rows between the
// plates their balls, which do not turn, change nothing. When the second contact opens, the rows climb over
// each other at 30 degrees: that is the angle of friction.
TEST_P(Shear, FindsStrengthAndStiffnessOfAHexagonalLattice) {
  for (const std::string stepping : {"stock", "second"}) {
    SCOPED_TRACE(stepping);
    const post::Table rows = run_element_test(GetParam(), "shear",
                                              {{"sample", "hexagonal"},
                                               {"columns", "4"},
                                               {"layers", "9"},
                                               {"friction", "0.3"},
                                               {"rolling", "0"},
                                               {"stepping", stepping},
                                               {"samples_of_strain", "25"},
                                               {"ramp", "400"},
                                               {"inertial_number", "2e-5"},
                                               {"strain", "2.5e-4"}});
    const std::vector<double> ratio = ratios(rows), shear = rows.numbers("shear_stress_kPa"),
                              strain = rows.numbers("shear_strain");
    constexpr double kn = 1e9;
    const double root3 = std::sqrt(3.0), modulus = 1e3 * (shear[12] - shear[4]) / (strain[12] - strain[4]);
    EXPECT_NEAR(modulus, root3 / 4 * kn, 1e-3 * kn);
    EXPECT_NEAR(*std::max_element(ratio.begin(), ratio.end()), 1 / root3, 1e-3);
    EXPECT_NEAR(ratio.back(), 1 / root3, 2e-3);
    for (const double error : rows.numbers("energy_error"))
      EXPECT_LT(std::fabs(error), 1e-4);
  }
}

TEST_P(Shear, HasASecondOrderEnergyErrorOnALattice) {
  std::vector<double> steps, errors;
  for (const int finer : {1, 2, 4}) {
    steps.push_back(0.1 * std::sqrt(pi * 0.02 * 0.02 * 2650 / 1e9) / finer);
    const post::Table rows = run_element_test(GetParam(), "shear",
                                              {{"sample", "hexagonal"},
                                               {"columns", "4"},
                                               {"layers", "9"},
                                               {"rolling", "0"},
                                               {"ratio", "1e-6"},
                                               {"samples_of_strain", "4"},
                                               {"inertial_number", "1e-3"},
                                               {"strain", "1e-4"},
                                               {"dt", number(steps.back())},
                                               {"ramp", std::to_string(200 * finer)},
                                               {"every", std::to_string(200 * finer)}});
    double largest = 0.0;
    for (const double error : rows.numbers("energy_error"))
      largest = std::max(largest, std::fabs(error));
    errors.push_back(largest);
  }
  EXPECT_NEAR(fitted_order(steps, errors), 2, 0.1);
  EXPECT_LT(errors.front(), 2e-4);
}

/// loops.csv of a run of in.shear.
post::Table run_loops(const std::string &engine, const Variables &variables, int ranks = 1) {
  return run_element_test(engine, "shear", variables, ranks, "loops.csv");
}

// As above the shear force of a ball is that of one contact pair, kn u/2 and c u'/2 of the dashpot, whether
// two contacts are compressed or not: over a cycle of angular frequency w the lattice is a spring and a
// dashpot side by side, whose damping ratio is c w/(2 kn), with c = 2 D sqrt(kn m*). m* is half the mass of a
// ball, at the plates, which do not give way, the whole.
TEST_P(Shear, FindsModulusAndDampingRatioOfAnElasticLattice) {
  constexpr double kn = 1e9, mass = pi * 0.02 * 0.02 * 2650, damping = 1, amplitude = 1e-5, rate = 1.5e-3;
  constexpr int layers = 9;
  const post::Table loops =
      run_loops(GetParam(), {{"sample", "hexagonal"},
                             {"columns", "4"},
                             {"layers", std::to_string(layers)},
                             {"rolling", "0"},
                             {"D", number(damping)},
                             {"dt", number(0.025 * std::sqrt(mass / kn))},
                             {"ramp", "8000"},
                             {"every", "800"},
                             {"cycles", "2"},
                             {"amplitude", number(amplitude)},
                             {"inertial_number", number(rate * 2 * 0.02 * std::sqrt(2650 / 1e5))}});
  ASSERT_EQ(loops.rows(), 2u);
  const double of_soil = damping * rate / amplitude * std::sqrt(mass / 2 / kn),
               ratio = of_soil * (layers - 3 + 2 * std::sqrt(2.0)) / (layers - 1);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_NEAR(loops.numbers("amplitude")[n], amplitude, 1e-6 * amplitude);
    EXPECT_NEAR(1e6 * loops.numbers("secant_modulus_MPa")[n], std::sqrt(3.0) / 4 * kn, 5e-3 * kn);
    EXPECT_NEAR(loops.numbers("damping_ratio")[n], ratio, 0.02 * ratio);
    EXPECT_NEAR(loops.numbers("damping_ratio_of_heat")[n], ratio, 0.02 * ratio);
    EXPECT_NEAR(loops.numbers("volumetric_strain")[n], 0, 1e-4 * amplitude);
  }
}

TEST_P(Shear, HasTheSameLoopsOnTwoRanks) {
  const Variables variables = {{"sample", "hexagonal"}, {"columns", "4"},        {"layers", "7"},
                               {"rolling", "0"},        {"samples_of_way", "8"}, {"cycles", "2"},
                               {"amplitude", "1e-5"}};
  const post::Table one = run_loops(GetParam(), variables), two = run_loops(GetParam(), variables, 2);
  ASSERT_EQ(two.rows(), 2u);
  for (const char *column : {"amplitude", "secant_modulus_MPa", "damping_ratio", "damping_ratio_of_heat"})
    EXPECT_LT(relative_difference(two.numbers(column), one.numbers(column)), 1e-6) << column;
}

// In a disordered sample the area of a loop is what the contacts dissipate, less the work of the normal
// stress; a dense one has hardly changed its volume after so few cycles.
TEST_P(Shear, DissipatesTheAreaOfTheLoop) {
  for (const char *dimension : {"2", "3"}) {
    Variables variables = {{"columns", "10"}, {"layers", "10"}, {"seating", "50"},
                           {"ramp", "1000"},  {"cycles", "2"},  {"amplitude", "2e-3"}};
    if (std::string(dimension) == "3")
      variables = {{"dimension", "3"}, {"columns", "4"},         {"rows", "4"},
                   {"layers", "8"},    {"seating", "50"},        {"ramp", "1000"},
                   {"cycles", "2"},    {"samples_of_way", "40"}, {"amplitude", "2e-3"}};
    const post::Table loops = run_loops(GetParam(), variables);
    ASSERT_EQ(loops.rows(), 2u) << dimension;
    for (std::size_t n = 0; n < 2; ++n) {
      const double ratio = loops.numbers("damping_ratio")[n];
      EXPECT_GT(ratio, 0.05) << dimension;
      EXPECT_LT(ratio, 2 / pi) << dimension; // that of a rectangle
      EXPECT_NEAR(loops.numbers("damping_ratio_of_heat")[n], ratio, 0.02 * ratio) << dimension;
      EXPECT_NEAR(loops.numbers("amplitude")[n], 2e-3, 1e-7) << dimension;
      EXPECT_LT(std::fabs(loops.numbers("volumetric_strain")[n]), 4e-3) << dimension;
    }
  }
}

// The platen starts in the middle and is at either side at the turns, after all cycles as after the first.
TEST_P(Shear, ReturnsToTheSamePlacesAtTheTurns) {
  const post::Table rows = run_element_test(GetParam(), "shear",
                                            {{"sample", "hexagonal"},
                                             {"columns", "4"},
                                             {"layers", "7"},
                                             {"rolling", "0"},
                                             {"samples_of_way", "4"},
                                             {"cycles", "5"},
                                             {"amplitude", "1e-5"}});
  ASSERT_EQ(rows.rows(), 1 + 4 * 11u);
  const std::vector<double> strain = rows.numbers("shear_strain"), cycle = rows.numbers("cycle");
  for (std::size_t way = 0; way < 11; ++way) {
    EXPECT_NEAR(strain[4 * way + 4], way % 2 == 0 ? 1e-5 : -1e-5, 1e-11) << way;
    EXPECT_EQ(cycle[4 * way + 4], (way + 1) / 2);
  }
  EXPECT_EQ(strain[0], 0);
}

// A dense sample fails and dilates; the normal stress stays what it should be.
TEST_P(Shear, ShearsADisorderedSample) {
  const post::Table rows = run_element_test(GetParam(), "shear",
                                            {{"columns", "10"},
                                             {"layers", "10"},
                                             {"seating", "50"},
                                             {"ramp", "1000"},
                                             {"samples_of_strain", "10"},
                                             {"strain", "0.01"}});
  const std::vector<double> ratio = ratios(rows);
  const double highest = *std::max_element(ratio.begin(), ratio.end());
  EXPECT_GT(highest, 0.4);
  EXPECT_LT(highest, 1.5);
  EXPECT_LT(rows.numbers("volumetric_strain").back(), -3e-4);
  for (const double stress : rows.numbers("normal_stress_kPa"))
    EXPECT_NEAR(stress, 100, 5);
  for (const double number : rows.numbers("inertial_number"))
    EXPECT_LT(number, 1e-3);
  for (const double error : rows.numbers("energy_error"))
    EXPECT_LT(std::fabs(error), 1e-3);
}

// Ranks add forces in other orders. Until the rows climb over each other this makes no difference, then it
// grows: the motion is unstable.
TEST_P(Shear, HasTheSameStrengthOnTwoRanks) {
  const Variables variables = {{"sample", "hexagonal"}, {"columns", "4"},
                               {"layers", "7"},         {"friction", "0.3"},
                               {"rolling", "0"},        {"samples_of_strain", "20"},
                               {"ramp", "400"},         {"inertial_number", "1e-4"},
                               {"strain", "3e-4"}};
  const post::Table one = run_element_test(GetParam(), "shear", variables),
                    two = run_element_test(GetParam(), "shear", variables, 2);
  const std::vector<double> of_one = ratios(one), of_two = ratios(two);
  ASSERT_EQ(of_one.size(), of_two.size());
  const auto strength =
      static_cast<std::size_t>(std::max_element(of_one.begin(), of_one.end()) - of_one.begin());
  EXPECT_NEAR(of_one[strength], 1 / std::sqrt(3.0), 1e-2);
  ASSERT_LT(strength + 2, of_one.size()) << "the sample does not yield";
  for (const char *column : {"shear_stress_kPa", "normal_stress_kPa", "stored_J", "work_J"})
    for (std::size_t n = 0; n <= strength; ++n)
      EXPECT_NEAR(two.numbers(column)[n], one.numbers(column)[n],
                  1e-6 * std::fabs(one.numbers(column)[strength]))
          << column << n;
  for (std::size_t n = strength; n < of_one.size(); ++n)
    EXPECT_NEAR(of_two[n], of_one[n], 2e-2) << n;
}

// The platen of a dense sample that dilates rises above the box in which the sample was made.
TEST_P(Shear, FollowsALatticeThatDilatesFar) {
  const post::Table rows = run_element_test(GetParam(), "shear",
                                            {{"sample", "hexagonal"},
                                             {"columns", "4"},
                                             {"layers", "20"},
                                             {"rolling", "0.45"},
                                             {"samples_of_strain", "20"},
                                             {"inertial_number", "5e-3"},
                                             {"strain", "0.08"}});
  EXPECT_LT(rows.numbers("volumetric_strain").back(), -0.085);
  for (const double stress : rows.numbers("normal_stress_kPa"))
    EXPECT_NEAR(stress, 100, 20);
}

INSTANTIATE_TEST_SUITE_P(Engines, Shear, ::testing::Values("liggghts", "lammps"));

} // namespace
} // namespace drumlin::test
