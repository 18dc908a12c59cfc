// The biaxial test: regular lattices against their strength and stiffness in closed form, the forces on the plates against sums over the
// contacts of a cut, a disordered sample in both engines.
#include "bed/dump_readers.h"
#include "tests/support/element_runs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

post::Table run_biaxial(const std::string &engine, const Variables &variables) {
  return run_element_test(engine, "biaxial", variables);
}

constexpr double diameter = 0.04, kn = 1e9, kt = 2.0 / 7.0 * kn; // m, N/m; the deck's
constexpr int columns = 6, layers = 7;
const double root3 = std::sqrt(3.0);

/// A lattice that is loaded slowly, so that it is close to equilibrium all the time.
Variables lattice(const std::string &sample, const std::string &friction, const std::string &strain) {
  return {{"sample", sample},
          {"friction", friction},
          {"columns", std::to_string(columns)},
          {"layers", std::to_string(layers)},
          {"samples_of_strain", "25"},
          {"inertial_number", "1e-4"},
          {"ramp", "400"},
          {"strain", strain}};
}

/// Axial stress over side stress of each row.
std::vector<double> ratios(const post::Table &table) {
  const std::vector<double> axial = table.numbers("axial_stress_kPa"),
                            side = table.numbers("side_stress_kPa");
  std::vector<double> values;
  for (std::size_t n = 0; n < axial.size(); ++n)
    values.push_back(axial[n] / side[n]);
  return values;
}

/// Change of the axial stress over that of the strain between two rows, Pa.
double modulus(const post::Table &table, std::size_t from, std::size_t to) {
  const std::vector<double> axial = table.numbers("axial_stress_kPa"), strain = table.numbers("strain");
  return 1e3 * (axial[to] - axial[from]) / (strain[to] - strain[from]);
}

class Biaxial : public InEngine {};

/// When a hexagonal lattice, rows across the load, has yielded, the balls of a row are apart, and all forces are in contacts at 60 degrees,
/// inclined by the angle of friction to their normals: the ratio of the stresses is tan 60 tan(60 + phi).
double strength(double friction) { return root3 * std::tan(pi / 3 + std::atan(friction)); }

/// Modulus of the hexagonal lattice between the opening of the contacts within rows and yielding. Rows approach by a, and neighbours in a row
/// separate by 2 b, so that a contact at 60 degrees is compressed by (root3 a - b)/2 and sheared by (a + root3 b)/2. The side force is constant:
/// b = root3 a (kn - kt)/(kn + 3 kt). A ball at a plate has two such contacts above or below it and one with the plate.
double hexagonal_modulus() {
  const double a = 1.0, b = root3 * a * (kn - kt) / (kn + 3 * kt);
  const double axial_force = (kn * (3 * a - root3 * b) + kt * (a + root3 * b)) / 4; // of a contact
  const double height = (layers - 1) * root3 / 2 * diameter;
  const double settlement = (layers - 1) * a + 2 * 2 * axial_force / kn;
  return 2 * axial_force / diameter * height / settlement;
}

/// Columns of a square lattice, each with a contact less than layers, and those with the plates; heights and widths are between centres.
double square_modulus() {
  const double force_per_width = columns / ((columns - 1) * diameter);
  return force_per_width * kn / (layers + 1) * (layers - 1) * diameter;
}

TEST_P(Biaxial, FindsStrengthAndStiffnessOfAHexagonalLattice) {
  const post::Table rows = run_biaxial(GetParam(), lattice("hexagonal", "0.3", "9e-4"));
  const std::vector<double> ratio = ratios(rows);
  const double highest = *std::max_element(ratio.begin(), ratio.end());
  EXPECT_NEAR(highest, strength(0.3), 5e-3 * highest);
  EXPECT_NEAR(ratio.back(), strength(0.3), 1e-2 * highest);
  EXPECT_NEAR(modulus(rows, 14, 18), hexagonal_modulus(), 5e-3 * hexagonal_modulus());
}

TEST(BiaxialLattice, HasATripleStrengthWithoutFriction) {
  const std::vector<double> ratio = ratios(run_biaxial("liggghts", lattice("hexagonal", "0", "4e-4")));
  EXPECT_NEAR(*std::max_element(ratio.begin(), ratio.end()), 3, 0.1);
  EXPECT_NEAR(std::accumulate(ratio.end() - 8, ratio.end(), 0.0) / 8, 3,
              0.02); // it has yielded, and vibrates
}

TEST(BiaxialLattice, HasTheStiffnessOfItsColumnsIfSquare) {
  const post::Table rows = run_biaxial("liggghts", lattice("square", "0.5", "1e-4"));
  EXPECT_NEAR(modulus(rows, 18, 25), square_modulus(), 1e-3 * square_modulus());
  EXPECT_NEAR(rows.numbers("side_strain").back(), 0, 1e-7);
}

const Variables small = {{"columns", "8"},           {"layers", "9"},  {"seating", "50"},
                         {"samples_of_strain", "8"}, {"ramp", "1000"}, {"strain", "0.005"}};

// A dense sample fails at a multiple of the side stress and dilates; the side stress stays what it should be.
TEST_P(Biaxial, ShearsADisorderedSample) {
  const post::Table rows = run_biaxial(GetParam(), small);
  const std::vector<double> ratio = ratios(rows), side = rows.numbers("side_stress_kPa");
  EXPECT_NEAR(ratio.front(), 1, 2e-3);
  const double highest = *std::max_element(ratio.begin(), ratio.end());
  EXPECT_GT(highest, 2.5);
  EXPECT_LT(highest, 8);
  EXPECT_LT(rows.numbers("volumetric_strain").back(), -3e-4);
  EXPECT_NEAR(rows.numbers("strain").back(), 0.005, 1e-4);
  for (const double stress : side)
    EXPECT_NEAR(stress, 100, 5);
  for (const double number : rows.numbers("inertial_number"))
    EXPECT_LT(number, 1e-3);
  for (const double error : rows.numbers("energy_error"))
    EXPECT_LT(std::fabs(error), 1e-3);
}

// Much too fast a test throws the side platen off the sample.
TEST_P(Biaxial, EndsWhenAPlatenIsOffTheSample) {
  const Variables fast = {{"sample", "hexagonal"}, {"columns", "4"},        {"layers", "5"},
                          {"seating", "1"},        {"side", "1"},           {"ratio", "0.1"},
                          {"strain", "0.9"},       {"inertial_number", "1"}};
  try {
    run_biaxial(GetParam(), fast);
    ADD_FAILURE() << "it goes on";
  } catch (const std::runtime_error &error) {
    EXPECT_NE(std::string(error.what()).find("ERROR: drumlin/check: variable side_stress is '"),
              std::string::npos)
        << error.what();
  }
}

/// A force between balls i and j, or on ball i by a plate j.
struct Contact {
  long i, j;
  std::array<double, 2> force; // on i
};

/// Sum of the forces in direction `axis` on the balls beyond a cut across it by those before the cut.
double force_through_cut(const std::vector<Contact> &contacts,
                         const std::map<long, std::array<double, 2>> &places, std::size_t axis, double cut) {
  double sum = 0.0;
  for (const Contact &contact : contacts) {
    const bool i_beyond = places.at(contact.i)[axis] > cut, j_beyond = places.at(contact.j)[axis] > cut;
    if (i_beyond != j_beyond) sum += (i_beyond ? 1.0 : -1.0) * contact.force[axis];
  }
  return sum;
}

// At rest the contacts of any cut through the sample carry what the plates on both sides of it do.
TEST(BiaxialEquilibrium, TheForcesOnThePlatesGoThroughEveryCut) {
  const Scratch scratch;
  const Variables variables = {{"here", chain_deck("../soil").string()},
                               {"columns", "8"},
                               {"layers", "9"},
                               {"seating", "50"},
                               {"samples_of_strain", "1"},
                               {"ramp", "200"},
                               {"strain", "1e-5"},
                               {"inertial_number", "1e-5"}};
  const Outcome outcome = run_deck(test_deck("biaxial_contacts.in"), variables, scratch.path());
  ASSERT_TRUE(outcome.ok()) << outcome.output;
  std::map<long, std::array<double, 2>> places;
  std::vector<long> plates; // left, side, base, top
  for (const std::vector<double> &row : post::read_text_dump(scratch / "balls.dump").rows) {
    places[std::lround(row[0])] = {row[2], row[3]};
    if (std::lround(row[1]) == 2) plates.push_back(std::lround(row[0]));
  }
  ASSERT_EQ(plates.size(), 4u);
  std::sort(plates.begin(), plates.end());
  std::vector<Contact> contacts;
  for (const std::vector<double> &row : post::read_text_dump(scratch / "contacts.dump").rows)
    contacts.push_back({std::lround(row[0]), std::lround(row[1]), {row[2], row[3]}});
  const post::Table table = post::read_table(scratch / "plates.csv");
  const double scale = 100e3 * 8 * diameter; // N, side stress times the sample's width
  for (std::size_t n = 0; n < 4; ++n) {
    const char *const name = std::array{"left", "side", "base", "top"}[n];
    const std::size_t axis = n / 2;
    double sum = 0.0;
    for (const Contact &contact : contacts)
      if (contact.i == plates[n] || contact.j == plates[n])
        sum += (contact.i == plates[n] ? 1.0 : -1.0) * contact.force[axis];
    const double force = table.numbers(name).front();
    EXPECT_NEAR(sum, force, 1e-5 * scale) << name;
    for (const double cut : {0.12, 0.17, 0.22, 0.27})
      EXPECT_NEAR(force_through_cut(contacts, places, axis, cut), std::fabs(force), 2e-3 * scale)
          << name << ", cut at " << cut;
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, Biaxial, ::testing::Values("liggghts", "lammps"));

} // namespace
} // namespace drumlin::test
