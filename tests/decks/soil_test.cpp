// The oedometer: regular lattices against their moduli in closed form, energy balances, both engines against
// each other. The loosest and the densest packing.
#include "tests/support/element_runs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <tuple>
#include <vector>

namespace drumlin::test {
namespace {

post::Table run_oedometer(const std::string &engine, const Variables &variables, int ranks = 1) {
  return run_element_test(engine, "oedometer", variables, ranks);
}

/// The column without its first row, the state before the first load.
std::vector<double> after_loads(const post::Table &table, const std::string &column) {
  std::vector<double> values;
  const std::vector<std::string> cells = table.text(column);
  for (std::size_t n = 1; n < cells.size(); ++n)
    values.push_back(post::number_from_text(cells[n]));
  return values;
}

constexpr double diameter = 0.04; // m, the deck's

/// A regular lattice. A uniform compression along y, with n the unit vector of a contact and d the diameter,
/// gives
///   modulus = sum over the contacts of a ball of d^2 n_y^2 (kn n_y^2 + kt (1 - n_y^2)) / (2 V),
/// V being the volume (area) per ball. No ball rotates, as each is at a centre of symmetry.
struct Lattice {
  const char *name;
  double kn, kt;             // N/m
  double normal, tangential; // 1/m (1 in two dimensions): modulus = normal kn + tangential kt
  double void_ratio;
  double volume; // m3 (m2), from centre to centre of the plates, of the deck's numbers of columns, rows and
                 // layers
};

const double root2 = std::sqrt(2.0), root3 = std::sqrt(3.0);
const Lattice lattices[] = {
    {"hexagonal", 1e8, 3e7, 3 * root3 / 4, root3 / 4, 2 * root3 / pi - 1, 8 * diameter * 4 * root3 *diameter},
    {"square", 1e8, 3e7, 1, 0, 4 / pi - 1, 4 * diameter * 4 * diameter},
    {"cubic", 4e6, 1e6, 1 / diameter, 0, 6 / pi - 1, 4 * diameter * 4 * diameter * 4 * diameter},
    {"face_centred", 4e6, 1e6, root2 / diameter, root2 / diameter, 3 * root2 / pi - 1,
     8 / root2 *diameter * 32 * diameter *diameter}};

void PrintTo(const Lattice &lattice, std::ostream *out) { *out << lattice.name; }

Variables small_loads(const Lattice &lattice, const std::string &friction) {
  return {{"sample", lattice.name}, {"loads", "6 7 6"},        {"ratio", "1e-9"},
          {"friction", friction},   {"k", number(lattice.kn)}, {"kt", number(lattice.kt)}};
}

class Oedometer : public ::testing::TestWithParam<std::tuple<std::string, Lattice, std::string>> {
protected:
  void SetUp() override {
    if (std::get<0>(GetParam()) == "lammps" && !post::has_lammps())
      GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  }
};

// At these loads the strains are below 1e-4: the modulus differs from that of small strains by so much.
TEST_P(Oedometer, MeasuresTheModulusOfALattice) {
  const auto &[engine, lattice, friction] = GetParam();
  const post::Table rows = run_oedometer(engine, small_loads(lattice, friction));
  ASSERT_EQ(rows.rows(), 4u);
  const double modulus =
      lattice.normal * lattice.kn + (friction == "0" ? 0.0 : lattice.tangential * lattice.kt);
  for (const double measured : after_loads(rows, "modulus_MPa"))
    EXPECT_NEAR(measured, 1e-6 * modulus, 2e-10 * modulus);
  EXPECT_NEAR(rows.numbers("void_ratio").front(), lattice.void_ratio, 2e-4);
  for (const double error : after_loads(rows, "energy_error"))
    EXPECT_LT(std::fabs(error), 1e-7);
  // The energy s^2/(2 M) per volume, from 5 to 6 and 7 kPa.
  const std::vector<double> stored = after_loads(rows, "stored_J");
  EXPECT_NEAR(stored[0], lattice.volume * (36e6 - 25e6) / (2 * modulus), 1e-3 * stored[0]);
  EXPECT_NEAR(stored[1], lattice.volume * (49e6 - 25e6) / (2 * modulus), 1e-3 * stored[1]);
}

// The state at rest does not depend on the step, the energy error is of second order in it.
TEST(OedometerLattice, HasASecondOrderEnergyError) {
  const double step = 0.1 * std::sqrt(pi * 0.02 * 0.02 * 2650 / 1e8);
  std::vector<double> steps, errors, moduli;
  for (const int finer : {1, 2, 4}) {
    const post::Table rows = run_oedometer("liggghts", {{"sample", "hexagonal"},
                                                        {"loads", "100 5"},
                                                        {"ratio", "1e-9"},
                                                        {"dt", number(step / finer)},
                                                        {"ramp", std::to_string(200 * finer)},
                                                        {"every", std::to_string(100 * finer)}});
    steps.push_back(step / finer);
    errors.push_back(std::fabs(after_loads(rows, "energy_error").back()));
    moduli.push_back(after_loads(rows, "modulus_MPa").front());
  }
  EXPECT_NEAR(fitted_order(steps, errors), 2, 0.1);
  EXPECT_LT(errors.front(), 1e-6);
  EXPECT_NEAR(moduli.back(), moduli.front(), 1e-6 * moduli.front());
}

// A disordered sample becomes stiffer with stress, dissipates energy, and the energy balance holds.
TEST(OedometerSample, LoadsADisorderedSample) {
  for (const char *engine : {"liggghts", "lammps"}) {
    if (std::string(engine) == "lammps" && !post::has_lammps()) continue;
    const post::Table rows = run_oedometer(
        engine,
        {{"columns", "10"}, {"layers", "10"}, {"loads", "50 200 50"}, {"ramp", "1000"}, {"ratio", "1e-3"}});
    const std::vector<double> modulus = after_loads(rows, "modulus_MPa");
    EXPECT_GT(modulus[0], 10) << engine;
    EXPECT_GT(modulus[1], modulus[0]) << engine;
    EXPECT_LT(modulus[1], 130) << engine; // less than the hexagonal lattice, which is the densest packing
    EXPECT_GT(modulus[2], modulus[1]) << engine;
    EXPECT_GT(after_loads(rows, "contact_heat_J")[2], 0) << engine;
    for (const double error : after_loads(rows, "energy_error"))
      EXPECT_LT(std::fabs(error), 1e-4) << engine;
  }
}

// A sample that is made moist is looser than one that is made dry with the same friction.
TEST(OedometerSample, IsLooserIfItIsMadeMoist) {
  for (const char *engine : {"liggghts", "lammps"}) {
    if (std::string(engine) == "lammps" && !post::has_lammps()) continue;
    std::vector<double> void_ratio;
    for (const char *strength : {"0", "2e4"})
      void_ratio.push_back(run_oedometer(engine, {{"columns", "10"},
                                                  {"layers", "10"},
                                                  {"loads", "10"},
                                                  {"ramp", "1000"},
                                                  {"ratio", "1e-2"},
                                                  {"rolling", "0.45"},
                                                  {"prepare_rolling", "0.45"},
                                                  {"prepare_tensile_strength", strength}})
                               .numbers("void_ratio")
                               .front());
    EXPECT_GT(void_ratio[1], void_ratio[0] + 0.02) << engine;
  }
}

class Density : public InEngine {};
INSTANTIATE_TEST_SUITE_P(Engines, Density, ::testing::Values("liggghts", "lammps"),
                         [](const auto &engine) { return engine.param; });

// Rows of touching discs, eight above the floor's, whatever their friction. The area between the two planes
// is summed from chords of the discs; the mean height of the surface is pi/4 radius above the upper centres.
TEST_P(Density, MeasuresTheSolidFractionOfALattice) {
  for (const double beside : {0.0, 1.3, 2.0}) {
    const post::Table packings =
        run_element_test(GetParam(), "density", {{"sample", "hexagonal"}, {"beside", number(beside)}});
    const double radius = 0.5 * diameter, apart = root3 * radius;
    const double low = radius + beside * diameter, high = 8 * apart + 0.25 * pi * radius - beside * diameter;
    double area = 0.0;
    constexpr int strips = 20000;
    for (int i = 0; i < strips; ++i)
      for (int row = 1; row <= 8; ++row) {
        const double above = low + (i + 0.5) * (high - low) / strips - row * apart;
        if (std::fabs(above) < radius)
          area += 2.0 * std::sqrt(radius * radius - above * above) * (high - low) / strips;
      }
    for (const double solid : packings.numbers("solid_fraction"))
      EXPECT_NEAR(solid, area / (diameter * (high - low)), 5e-4) << beside;
    EXPECT_EQ(packings.rows(), 2u);
  }
}

// Without friction a packing comes to rest when it has as many contacts as its balls have coordinates,
// 2 d contacts a ball, less those of balls that bear nothing. A loose packing has fewer. Between them: order.
TEST_P(Density, MakesTheLoosestAndTheDensestPacking) {
  for (const int dimensions : {2, 3}) {
    Variables variables = {{"shares", "1 0 0.2"}, {"columns", "10"}, {"layers", "12"}, {"k", "1e7"}};
    if (dimensions == 3)
      variables = {{"shares", "1 0 0.2"}, {"dimension", "3"}, {"columns", "4"},
                   {"rows", "4"},         {"layers", "10"},   {"k", "4e5"}};
    const post::Table packings = run_element_test(GetParam(), "density", variables);
    ASSERT_EQ(packings.rows(), 3u);
    const std::vector<double> voids = packings.numbers("void_ratio"),
                              solid = packings.numbers("solid_fraction"),
                              relative = packings.numbers("relative_density"),
                              compaction = packings.numbers("compaction"),
                              contacts = packings.numbers("coordination"),
                              friction = packings.numbers("friction"), rolling = packings.numbers("rolling");
    EXPECT_GT(voids[0], voids[2]);
    EXPECT_GT(voids[2], voids[1]);
    EXPECT_LT(solid[1], dimensions == 2 ? pi / std::sqrt(12.0) : pi / std::sqrt(18.0)); // regular lattices
    EXPECT_GT(solid[1], dimensions == 2 ? 0.81 : 0.58);
    EXPECT_LE(contacts[1], 2.0 * dimensions);
    EXPECT_GT(contacts[1], contacts[0] + 0.3);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(voids[i], 1.0 / solid[i] - 1.0, 1e-12);
      EXPECT_NEAR(relative[i], (voids[0] - voids[i]) / (voids[0] - voids[1]), 1e-12);
      EXPECT_NEAR(compaction[i], solid[i] / solid[1], 1e-12);
    }
    EXPECT_NEAR(friction[2], 0.16, 1e-12);
    EXPECT_NEAR(rolling[2], 0.09, 1e-12);
  }
}

// Shaking brings a packing that keeps its friction from the loosest towards the densest, but not beyond that
// without friction; a lattice has nowhere to go.
// 60 Hz with a double amplitude of 0.33 mm are 2.39 g (165 um times 142,122 per second squared, by hand).
TEST_P(Density, ShakesThePackingUntilItStays) {
  const Scratch scratch;
  const Outcome outcome =
      run_deck(chain_deck("../soil/in.density" + std::string(GetParam() == "lammps" ? ".lammps" : "")),
               {{"sample", "hexagonal"}, {"densest", "shaken"}}, scratch.path());
  well(outcome);
  EXPECT_TRUE(contains(outcome.output, "density: shaken by 50 cycles of 2.39"));
  const post::Table lattice = post::read_table(scratch / "density.csv");
  EXPECT_NEAR(lattice.numbers("solid_fraction")[1], lattice.numbers("solid_fraction")[0], 5e-4);
  for (const int dimensions : {2, 3}) {
    Variables variables = {{"columns", "10"}, {"layers", "12"}, {"k", "1e7"}};
    if (dimensions == 3)
      variables = {{"dimension", "3"}, {"columns", "4"}, {"rows", "4"},
                   {"layers", "8"},    {"beside", "1"},  {"k", "4e5"}};
    const std::vector<double> frictionless =
        run_element_test(GetParam(), "density", variables).numbers("solid_fraction");
    variables.emplace_back("densest", "shaken");
    const post::Table packings = run_element_test(GetParam(), "density", variables);
    ASSERT_EQ(packings.rows(), 2u);
    const std::vector<double> solid = packings.numbers("solid_fraction");
    EXPECT_NEAR(solid[0], frictionless[0], 1e-6) << dimensions;
    EXPECT_GT(solid[1], solid[0] + (dimensions == 2 ? 0.02 : 0.01)) << dimensions;
    EXPECT_LT(solid[1], frictionless[1] + 0.005) << dimensions;
    EXPECT_EQ(packings.numbers("friction")[1], 0.8) << dimensions;
    EXPECT_EQ(packings.numbers("share")[1], 1) << dimensions;
  }
}

std::string oedometer_name(const ::testing::TestParamInfo<Oedometer::ParamType> &info) {
  const auto &[engine, lattice, friction] = info.param;
  return engine + "_" + lattice.name + (friction == "0" ? "_frictionless" : "_friction");
}

INSTANTIATE_TEST_SUITE_P(Lattices, Oedometer,
                         ::testing::Combine(::testing::Values("liggghts", "lammps"),
                                            ::testing::ValuesIn(lattices), ::testing::Values("0", "0.5")),
                         oedometer_name);

} // namespace
} // namespace drumlin::test
