// Element tests of soil: oedometer, packings, simple shear, plate load.
#include "tests/support/engine_runs.h"
#include "bed/dump_readers.h"

namespace drumlin::test {
namespace {

// The oedometer: regular lattices against their moduli in closed form, energy balances, both engines against
// each other. The loosest and the densest packing.
namespace soil {

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
  return given("sample {}, loads 6 7 6, ratio 1e-9, friction {}, k {}, kt {}", lattice.name, friction,
               lattice.kn, lattice.kt);
}

class Oedometer : public ::testing::TestWithParam<std::tuple<std::string, Lattice, std::string>> {
protected:
  void SetUp() override { SKIP_WITHOUT_LAMMPS(std::get<0>(GetParam()) == "lammps"); }
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
    const post::Table rows =
        run_oedometer("liggghts", given("sample hexagonal, loads 100 5, ratio 1e-9, dt {}, ramp {}, every {}",
                                        step / finer, 200 * finer, 100 * finer));
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
    const post::Table rows =
        run_oedometer(engine, given("columns 10, layers 10, loads 50 200 50, ramp 1000, ratio 1e-3"));
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
      void_ratio.push_back(
          run_oedometer(engine, given("columns 10, layers 10, loads 10, ramp 1000, ratio 1e-2, rolling 0.45, "
                                      "prepare_rolling 0.45, prepare_tensile_strength {}",
                                      strength))
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
        run_element_test(GetParam(), "density", given("sample hexagonal, beside {}", beside));
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
    Variables variables = given("shares 1 0 0.2, columns 10, layers 12, k 1e7");
    if (dimensions == 3)
      variables = given("shares 1 0 0.2, dimension 3, columns 4, rows 4, layers 10, k 4e5");
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
               given("sample hexagonal, densest shaken"), scratch.path());
  well(outcome);
  EXPECT_TRUE(contains(outcome.output, "density: shaken by 50 cycles of 2.39"));
  const post::Table lattice = post::read_table(scratch / "density.csv");
  EXPECT_NEAR(lattice.numbers("solid_fraction")[1], lattice.numbers("solid_fraction")[0], 5e-4);
  for (const int dimensions : {2, 3}) {
    Variables variables = given("columns 10, layers 12, k 1e7");
    if (dimensions == 3) variables = given("dimension 3, columns 4, rows 4, layers 8, beside 1, k 4e5");
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

} // namespace soil

// The simple shear test: a hexagonal lattice against its strength and stiffness in closed form, a disordered
// sample in both engines.
namespace shear {

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
    const post::Table rows =
        run_element_test(GetParam(), "shear",
                         given("sample hexagonal, columns 4, layers 9, friction 0.3, rolling 0, stepping {}, "
                               "samples_of_strain 25, ramp 400, inertial_number 2e-5, strain 2.5e-4",
                               stepping));
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
    const post::Table rows = run_element_test(
        GetParam(), "shear",
        given("sample hexagonal, columns 4, layers 9, rolling 0, ratio 1e-6, samples_of_strain 4, "
              "inertial_number 1e-3, strain 1e-4, dt {}, ramp {}, every {}",
              steps.back(), 200 * finer, 200 * finer));
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
      run_loops(GetParam(), given("sample hexagonal, columns 4, layers {}, rolling 0, D {}, dt {}, ramp "
                                  "8000, every 800, cycles 2, amplitude {}, inertial_number {}",
                                  layers, damping, 0.025 * std::sqrt(mass / kn), amplitude,
                                  rate * 2 * 0.02 * std::sqrt(2650 / 1e5)));
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
  const Variables variables =
      given("sample hexagonal, columns 4, layers 7, rolling 0, samples_of_way 8, cycles 2, amplitude 1e-5");
  const post::Table one = run_loops(GetParam(), variables), two = run_loops(GetParam(), variables, 2);
  ASSERT_EQ(two.rows(), 2u);
  for (const char *column : {"amplitude", "secant_modulus_MPa", "damping_ratio", "damping_ratio_of_heat"})
    EXPECT_LT(relative_difference(two.numbers(column), one.numbers(column)), 1e-6) << column;
}

// In a disordered sample the area of a loop is what the contacts dissipate, less the work of the normal
// stress; a dense one has hardly changed its volume after so few cycles.
TEST_P(Shear, DissipatesTheAreaOfTheLoop) {
  for (const char *dimension : {"2", "3"}) {
    Variables variables = given("columns 10, layers 10, seating 50, ramp 1000, cycles 2, amplitude 2e-3");
    if (std::string(dimension) == "3")
      variables = given("dimension 3, columns 4, rows 4, layers 8, seating 50, ramp 1000, cycles 2, "
                        "samples_of_way 40, amplitude 2e-3");
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
  const post::Table rows = run_element_test(
      GetParam(), "shear",
      given("sample hexagonal, columns 4, layers 7, rolling 0, samples_of_way 4, cycles 5, amplitude 1e-5"));
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
  const post::Table rows = run_element_test(
      GetParam(), "shear",
      given("columns 10, layers 10, seating 50, ramp 1000, samples_of_strain 10, strain 0.01"));
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
  const Variables variables = given("sample hexagonal, columns 4, layers 7, friction 0.3, rolling 0, "
                                    "samples_of_strain 20, ramp 400, inertial_number 1e-4, strain 3e-4");
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
                                            given("sample hexagonal, columns 4, layers 20, rolling 0.45, "
                                                  "samples_of_strain 20, inertial_number 5e-3, strain 0.08"));
  EXPECT_LT(rows.numbers("volumetric_strain").back(), -0.085);
  for (const double stress : rows.numbers("normal_stress_kPa"))
    EXPECT_NEAR(stress, 100, 20);
}

INSTANTIATE_TEST_SUITE_P(Engines, Shear, ::testing::Values("liggghts", "lammps"));

} // namespace shear

// The plate load test: the forces below one loaded ball against Flamant's solution, the balance of forces and
// of energy, a disordered bed in both engines.
namespace plate {

constexpr double radius = 0.02, root3 = 1.7320508075688772; // m

std::filesystem::path in_settle() { return chain_deck("../bed/in.settle"); }

const Variables own_contacts = given("k 1e9, dt 1e-5"); // of lattices, in in.plate
const Variables without_pouring = given("case gravel, k 1e9, pour_k 1e9, pour_friction 0.8, pour_rolling "
                                        "0.3, pour_dt 1e-5, fall 0, drag 2000, ratio 1e-6");

/// A lattice of balls between walls, square or hexagonal. In a hexagonal one the balls of a row overlap, so
/// that their contacts carry a force, and just touch those of other rows; in a square one all just touch.
struct Lattice {
  int columns; ///< balls in the first row
  int rows;
  bool hexagonal;

  double overlap() const { return hexagonal ? 2e-4 * 2 * radius : 0.0; } ///< m
  double pitch() const { return 2 * radius - overlap(); }
  double row_distance() const {
    return hexagonal ? std::sqrt(4 * radius * radius - pitch() * pitch() / 4) : 2 * radius;
  }
  /// Makes it with gravity in a folder: soil.restart there.
  void make(const std::filesystem::path &folder, const std::string &gravity) const {
    std::string balls;
    int id = 0;
    for (int row = 0; row < rows; ++row) {
      const int in_row = columns - (hexagonal ? row % 2 : 0);
      for (int column = 0; column < in_row; ++column)
        balls += fmt::format("{} 1 {} 2650 {:.17g} {:.17g} 0\n", ++id, 2 * radius,
                             (column - 0.5 * (in_row - 1)) * pitch(), radius + row * row_distance());
    }
    const double wall = 0.5 * (columns - 1) * pitch() + radius - overlap();
    std::ofstream(folder / "balls.data")
        << fmt::format("# lattice\n\n{} atoms\n3 atom types\n\n{:.17g} {:.17g} xlo xhi\n0 {:.17g} ylo yhi\n"
                       "-0.02 0.02 zlo zhi\n\nAtoms\n\n{}",
                       id, -wall, wall, rows * row_distance() + 0.5, balls);
    const Variables variables =
        with(without_pouring, given("g {}, balls balls.data, bed soil.restart", gravity));
    well(run_deck(in_settle(), variables, folder));
  }
};

/// A hexagonal lattice, prestressed also by a gravity a hundred times the earth's, below a plate that is one
/// ball on the middle ball of its upper row.
class LineLoad {
public:
  LineLoad(int columns, int rows) : lattice_{columns, rows, true} { lattice_.make(scratch_.path(), "981"); }

  static constexpr double load = 1000.0; // N per metre: 25 kPa on the width of a ball

  /// Force through the gap above each ball, downwards, by its row below the upper one and its distance from
  /// the load, m; and the force of the floor and the walls.
  struct Forces {
    std::map<int, std::map<double, double>> into_row;
    double reaction = 0.0;
  };

  /// What the load changes.
  Forces change() const {
    const Forces before = forces("2e-3", "10"), loaded = forces("25", "500");
    Forces change;
    change.reaction = loaded.reaction - before.reaction;
    for (const auto &[row, balls] : loaded.into_row)
      for (const auto &[x, force] : balls)
        change.into_row[row][x] = force - before.into_row.at(row).at(x);
    return change;
  }

  /// What is recorded of the bed under the load.
  post::Table table() const { return post::read_table(scratch_ / "25/plate.csv"); }

private:
  Forces forces(const std::string &stress, const std::string &steps) const {
    const Variables variables =
        with(own_contacts,
             given("here {}, g 981, bed soil.restart, plate_width 0.04, plate_thickness 0.04, seating 1e-3, "
                   "max_stress {}, stages 1, reload 0, drag 2000, ramp {}, every {}, out {}",
                   chain_deck("../soil").string(), stress, steps, steps, stress));
    well(run_deck(test_deck("plate_contacts.in"), variables, scratch_.path()));
    std::map<long, std::vector<double>> balls;
    double top = 0.0;
    for (const std::vector<double> &ball : post::read_text_dump(scratch_ / (stress + "/balls.dump")).rows) {
      balls[std::lround(ball[0])] = ball;
      if (ball[1] == 1.0) top = std::max(top, ball[3]);
    }
    Forces all;
    const auto row_of = [&](long id) {
      return static_cast<int>(std::lround((top - balls[id][3]) / lattice_.row_distance()));
    };
    for (const auto &[id, ball] : balls)
      if (row_of(id) >= 0) all.into_row[row_of(id)][column(ball[2])] = 0.0;
    for (const std::vector<double> &contact :
         post::read_text_dump(scratch_ / (stress + "/contacts.dump")).rows) {
      const long i = std::lround(contact[0]), j = std::lround(contact[1]);
      if (j == 0) {
        all.reaction += contact[3];
        continue;
      }
      if (row_of(i) == row_of(j)) continue;
      const long lower = row_of(i) > row_of(j) ? i : j;
      all.into_row[row_of(lower)][column(balls[lower][2])] -= (lower == i ? 1.0 : -1.0) * contact[3];
    }
    return all;
  }

  /// Distance from the middle as on the regular lattice.
  static double column(double x) { return std::round(x / radius) * radius; }

  Lattice lattice_;
  Scratch scratch_;
};

/// Force between x - radius and x + radius at a depth below a line load on a half-space: integral of
/// Flamant's vertical stress 2 P y^3/(pi (x^2 + y^2)^2).
double flamant(double load, double x, double depth) {
  const auto from_middle = [&](double u) {
    return load / pi * (std::atan(u / depth) + u * depth / (u * u + depth * depth));
  };
  return from_middle(x + radius) - from_middle(x - radius);
}

/// Root mean square of the difference from Flamant's forces in a row, over that of these forces. The depth is
/// that of the contacts above the row below the point where the plate touches its ball.
double difference(const LineLoad::Forces &change, int row) {
  double squares = 0.0, all = 0.0;
  for (const auto &[x, force] : change.into_row.at(row)) {
    const double exact = flamant(LineLoad::load, x, radius + (row - 0.5) * root3 * radius);
    squares += (force - exact) * (force - exact);
    all += exact * exact;
  }
  return std::sqrt(squares / all);
}

// The walls disturb the forces in proportion to the square of depth over size, the balls to that of diameter
// over depth. Both become small if the depth grows as the square root of the size.
TEST(PlateOnALattice, SpreadsALineLoadLikeFlamant) {
  const LineLoad small(15, 9), large(31, 17);
  const LineLoad::Forces in_small = small.change(), in_large = large.change();
  EXPECT_LT(difference(in_small, 3), 0.045);
  EXPECT_LT(difference(in_large, 5), 0.033);
  for (const LineLoad::Forces &forces : {in_small, in_large})
    EXPECT_NEAR(forces.reaction, LineLoad::load, 1e-3 * LineLoad::load);
  for (const LineLoad *lattice : {&small, &large}) {
    const post::Table rows = lattice->table();
    EXPECT_NEAR(rows.numbers("plate_force_N").back(), LineLoad::load, 1e-2 * LineLoad::load);
    EXPECT_LT(std::fabs(rows.numbers("energy_error").back()), 1e-3);
  }
}

class PlateOnColumns : public InEngine {};

// A square lattice carries a load straight down: below the plate are columns, each a series of the springs of
// its balls, of the floor and of the plate, which neighbours do not touch with any force.
struct Columns {
  static constexpr int rows = 9, columns = 15, below = 5;
  static constexpr double k = 1e9, width = below * 2 * radius;

  static post::Table load(const std::string &engine, int ranks = 1) {
    const Scratch scratch;
    Lattice{columns, rows, false}.make(scratch.path(), "9.81");
    const Variables variables =
        with(own_contacts, given("bed {}, plate_width {}, plate_thickness 0.04, max_stress 60, stages 2, "
                                 "ramp 500, drag 2000, ratio 1e-6",
                                 (scratch / "soil.restart").string(), width));
    return run_element_test(engine, "plate", variables, ranks);
  }
};

TEST_P(PlateOnColumns, HasTheSubgradeReactionOfTheColumnsBelowIt) {
  constexpr double width = Columns::width;
  const post::Table table = Columns::load(GetParam());
  const std::vector<double> stress = table.numbers("stress_kPa"), settlement = table.numbers("settlement_mm");
  const double reaction = 1e-6 * Columns::below * Columns::k / (Columns::rows + 1) / width; // MN/m3 = kPa/mm
  ASSERT_EQ(stress.size(), 7u);
  for (std::size_t n = 1; n < stress.size(); ++n) {
    EXPECT_NEAR(settlement[n], (stress[n] - stress[0]) / reaction, 1e-5 * 50 / reaction) << n;
    EXPECT_NEAR(table.numbers("plate_force_N")[n], 1e3 * stress[n] * width, 1e-4 * 60e3 * width) << n;
    EXPECT_LT(std::fabs(table.numbers("energy_error")[n]), 1e-4) << n;
  }
}

TEST_P(PlateOnColumns, IsTheSameOnTwoRanks) {
  const post::Table one = Columns::load(GetParam()), two = Columns::load(GetParam(), 2);
  for (const char *column : {"settlement_mm", "plate_force_N"})
    EXPECT_LT(relative_difference(two.numbers(column), one.numbers(column)), 1e-6) << column;
}

// The plate must lie on the bed, between its walls; the bed has the contacts with which it was made.
TEST_P(PlateOnColumns, RefusesAPlateThatIsNotOnTheBed) {
  const Scratch scratch;
  Lattice{5, 2, false}.make(scratch.path(), "9.81");
  for (const auto &[more, says] : std::vector<std::pair<Variables, std::string>>{
           {{{"plate_offset", "0.2"}},
            "ERROR: drumlin/check: variable plate_offset is '0.2'; allowed: a finite number below 0.05, so "
            "that"},
           {{{"plate_offset", "-0.2"}},
            "ERROR: drumlin/check: variable plate_offset is '-0.2'; allowed: a finite number above -0.05, so "
            "that"},
           {{{"plate_width", "0.3"}},
            "ERROR: drumlin/check: variable plate_width is '0.3'; allowed: a finite number below 0.2, the "
            "width of"},
           {{{"k", "1e8"}}, "ERROR: drumlin/variable: variable k is '1e8'; allowed: 1e9"}}) {
    Variables variables = more; // the engine takes the first of a name
    variables = with(variables, given("bed {}, plate_width 0.1", (scratch / "soil.restart").string()));
    EXPECT_TRUE(contains(error_of([&] { run_element_test(GetParam(), "plate", variables); }), says));
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, PlateOnColumns, ::testing::Values("liggghts", "lammps"));

class Plate : public InEngine {};

// A bed of 150 balls of gravel.
TEST_P(Plate, SettlesForGoodUnderItsFirstLoading) {
  const Scratch bed;
  well(run_program({DRUMLIN_TOOLS, "bed", "--balls", "150", "--width", "0.6", "--out", "balls.data"}, {},
                   bed.path()));
  well(run_deck(in_settle(), given("case gravel, balls balls.data, bed soil.restart"), bed.path()));
  const post::Table rows =
      run_element_test(GetParam(), "plate",
                       {{"bed", (bed / "soil.restart").string()},
                        {"plate_width", "0.15"},
                        {"max_stress", "60"},
                        {"stages", "3"},
                        {"ratio", "5e-3"}, // so that the force is within 1 % of the load at rest
                        {"ramp", "1000"}});
  EXPECT_EQ(rows.numbers("phase"), (std::vector<double>{0, 1, 1, 1, 2, 2, 2, 3, 3}));
  const std::vector<double> stress = rows.numbers("stress_kPa"), settlement = rows.numbers("settlement_mm"),
                            force = rows.numbers("plate_force_N"), error = rows.numbers("energy_error");
  const std::vector<double> expected = {10, 20, 40, 60, 30, 15, 10, 20, 40};
  for (std::size_t n = 0; n < expected.size(); ++n) {
    EXPECT_NEAR(stress[n], expected[n], 1e-9);
    EXPECT_NEAR(force[n], 1e3 * expected[n] * 0.15, 1e-2 * 1e3 * expected[n] * 0.15) << n;
    EXPECT_LT(std::fabs(error[n]), 1e-3) << n;
  }
  EXPECT_NEAR(settlement[0], 0, 1e-9);
  for (const std::size_t n : {1U, 2U, 3U, 7U, 8U})
    EXPECT_GT(settlement[n], settlement[n - 1]) << n;
  for (const std::size_t n : {4U, 5U, 6U})
    EXPECT_LT(settlement[n], settlement[n - 1]) << n;
  EXPECT_GT(settlement[6], 0) << "no permanent settlement";
  // Contacts are linear: reloading is as stiff as the first loading, up to what grains that move make of it.
  const double first = settlement[2] - settlement[0];
  EXPECT_NEAR(settlement[8] - settlement[6], first, 0.1 * first);
}

INSTANTIATE_TEST_SUITE_P(Engines, Plate, ::testing::Values("liggghts", "lammps"));

} // namespace plate

} // namespace
} // namespace drumlin::test
