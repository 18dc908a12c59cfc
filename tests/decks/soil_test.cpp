// Element tests of soil beyond the table of elements_test.cpp: what compares several runs, cuts and heaps.
#include "tests/support/engine_runs.h"
#include "bed/dump_readers.h"
#include "support/statistics.h"

namespace drumlin::test {
namespace {

// The oedometer, and the loosest and the densest packing.
namespace soil {

constexpr double diameter = 0.04; // m, the decks'
const double root3 = std::sqrt(3.0);

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

/// Solid fraction of rows of discs, eight above the floor's, `apart` from each other: the area between two
/// planes is summed from chords of the discs; the mean height of the surface is pi/4 radius above the upper
/// centres.
double solid_fraction_of_rows(double apart, double beside) {
  const double radius = 0.5 * diameter;
  const double low = radius + beside * diameter, high = 8 * apart + 0.25 * pi * radius - beside * diameter;
  double area = 0.0;
  constexpr int strips = 20000;
  for (int i = 0; i < strips; ++i)
    for (int row = 1; row <= 8; ++row) {
      const double above = low + (i + 0.5) * (high - low) / strips - row * apart;
      if (std::fabs(above) < radius)
        area += 2.0 * std::sqrt(radius * radius - above * above) * (high - low) / strips;
    }
  return area / (diameter * (high - low));
}

// Rows of touching discs, whatever their friction.
TEST_P(Density, MeasuresTheSolidFractionOfALattice) {
  for (const double beside : {0.0, 1.3, 2.0}) {
    const post::Table packings = run_element_test(
        GetParam(), "density", given("sample hexagonal, beside {}, densest frictionless", beside));
    for (const double solid : packings.numbers("solid_fraction"))
      EXPECT_NEAR(solid, solid_fraction_of_rows(0.5 * root3 * diameter, beside), 5e-4) << beside;
    EXPECT_EQ(packings.rows(), 2u);
    EXPECT_FALSE(packings.has("made"));
  }
}

// A lattice under the plate of a shaken packing is as much lower as its modulus in closed form says.
TEST_P(Density, PutsItsLoadOnTheSoilThatIsShaken) {
  constexpr double load = 7e5, k = 1e8; // Pa, N/m
  for (const double friction : {0.0, 0.8}) {
    const std::vector<double> solid = run_element_test(GetParam(), "density",
                                                       {{"sample", "hexagonal"},
                                                        {"beside", "0"},
                                                        {"friction", number(friction)},
                                                        {"shaking_load", number(load)}})
                                          .numbers("solid_fraction");
    const double modulus = 0.25 * root3 * k * (3.0 + (friction > 0.0 ? 2.0 / 7.0 : 0.0));
    const double apart = 0.5 * root3 * diameter,
                 rise = solid_fraction_of_rows(apart * (1.0 - load / modulus), 0.0) /
                            solid_fraction_of_rows(apart, 0.0) -
                        1.0;
    EXPECT_NEAR(solid[1] / solid[0] - 1.0, rise, 0.02 * rise) << friction;
  }
}

// Without friction a packing comes to rest when it has as many contacts as its balls have coordinates,
// 2 d contacts a ball, less those of balls that bear nothing. A loose packing has fewer. Between them: order.
TEST_P(Density, MakesTheLoosestAndTheDensestPacking) {
  for (const int dimensions : {2, 3}) {
    Variables variables = given("densest frictionless, shares 1 0 0.2, columns 10, layers 12, k 1e7");
    if (dimensions == 3)
      variables =
          given("densest frictionless, shares 1 0 0.2, dimension 3, columns 4, rows 4, layers 10, k 4e5");
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

// Shaking brings a packing that keeps its friction from the loosest towards that without friction, but not
// beyond it, under the plate and without it; a lattice has nowhere to go. Each row says how its packing was
// made. 60 Hz with a double amplitude of 0.33 mm are 2.39 g (165 um times 142,122 per second squared, by
// hand).
TEST_P(Density, ShakesThePackingUntilItStays) {
  const Scratch scratch;
  const Outcome outcome =
      run_deck(chain_deck("../soil/in.density" + std::string(GetParam() == "lammps" ? ".lammps" : "")),
               given("sample hexagonal, shaking_load 0"), scratch.path());
  well(outcome);
  EXPECT_TRUE(contains(outcome.output, "density: shaken by 50 cycles of 2.39"));
  const post::Table lattice = post::read_table(scratch / "density.csv");
  EXPECT_NEAR(lattice.numbers("solid_fraction")[1], lattice.numbers("solid_fraction")[0], 5e-4);
  for (const int dimensions : {2, 3}) {
    Variables variables = given("columns 10, layers 12, k 1e7");
    if (dimensions == 3)
      variables = given("dimension 3, columns 4, rows 4, layers 8, beside 1, k 4e5, shaking_load 0");
    const post::Table packings = run_element_test(GetParam(), "density", variables);
    const std::vector<std::string> made = {"poured", "shaken", "frictionless"};
    EXPECT_EQ(packings.text("made"), made);
    const std::vector<double> solid = packings.numbers("solid_fraction"),
                              relative = packings.numbers("relative_density");
    ASSERT_EQ(solid.size(), 3u);
    EXPECT_GT(solid[1], solid[0] + 0.005) << dimensions;
    EXPECT_LT(solid[1], solid[2] + 0.01) << dimensions;
    EXPECT_EQ(relative[1], 1) << dimensions;
    EXPECT_NEAR(relative[2], (1 / solid[0] - 1 / solid[2]) / (1 / solid[0] - 1 / solid[1]), 1e-9);
    EXPECT_EQ(packings.numbers("friction")[1], 0.8) << dimensions;
    EXPECT_EQ(packings.numbers("share")[1], 1) << dimensions;
  }
}

} // namespace soil

// The simple shear test.
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
  well(run_program(tool_words("bed --balls 150 --width 0.6 --out balls.data"), {}, bed.path()));
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

// The biaxial and the triaxial test: the forces on the plates against sums over the contacts of a cut.
namespace compression {

void expect_energy_balance(const post::Table &rows, double limit) {
  for (const double error : rows.numbers("energy_error"))
    EXPECT_LT(std::fabs(error), limit);
}

constexpr double diameter = 0.04; // m, the decks'

class Biaxial : public InEngine {};

// Much too fast a test throws the side platen off the sample.
TEST_P(Biaxial, EndsWhenAPlatenIsOffTheSample) {
  const Variables fast = given(
      "sample hexagonal, columns 4, layers 5, seating 1, side 1, ratio 0.1, strain 0.9, inertial_number 1");
  EXPECT_TRUE(contains(error_of([&] { run_element_test(GetParam(), "biaxial", fast); }),
                       "ERROR: drumlin/check: variable inertial_number is '1'; allowed: a finite number "
                       "below 1, with which a platen left the sample"));
}

/// A force between balls i and j, or on ball i by a plate j.
struct Contact {
  long i, j;
  std::array<double, 3> force; // on i
};

/// Sum of the forces in direction `axis` on the balls beyond a cut across it by those before the cut.
double force_through_cut(const std::vector<Contact> &contacts,
                         const std::map<long, std::array<double, 3>> &places, std::size_t axis, double cut) {
  double sum = 0.0;
  for (const Contact &contact : contacts) {
    const bool i_beyond = places.at(contact.i)[axis] > cut, j_beyond = places.at(contact.j)[axis] > cut;
    if (i_beyond != j_beyond) sum += (i_beyond ? 1.0 : -1.0) * contact.force[axis];
  }
  return sum;
}

/// At rest the contacts of any cut through the sample carry what the plates on both sides of it do.
/// \param scale N, side stress times the area of a plate
void expect_equilibrium(const std::string &deck, const Variables &more, std::size_t dimension, double scale) {
  const Scratch scratch;
  const std::string soil = chain_deck("../soil").string();
  post::write_files({{scratch / "in.contacts", "include " + soil + "/in." + deck + "\ninclude " +
                                                   test_deck("compression_contacts.in").string() + "\n"}});
  const Variables variables = with(
      given("here {}, seating 50, samples_of_strain 1, ramp 200, strain 1e-5, inertial_number 1e-5", soil),
      more);
  well(run_deck(scratch / "in.contacts", variables, scratch.path()));
  std::map<long, std::array<double, 3>> places;
  std::vector<long> plates; // left, side, base, top, and in space back, front
  std::array<double, 3> lowest{1.0, 1.0, 1.0}, highest{};
  for (const std::vector<double> &row : post::read_text_dump(scratch / "balls.dump").rows) {
    const long id = std::lround(row[0]);
    places[id] = {row[2], row[3], row[4]};
    if (std::lround(row[1]) == 2)
      plates.push_back(id);
    else
      for (std::size_t axis = 0; axis < dimension; ++axis) {
        lowest[axis] = std::min(lowest[axis], places[id][axis]);
        highest[axis] = std::max(highest[axis], places[id][axis]);
      }
  }
  ASSERT_EQ(plates.size(), 2 * dimension);
  std::sort(plates.begin(), plates.end());
  std::vector<Contact> contacts;
  for (const std::vector<double> &row : post::read_text_dump(scratch / "contacts.dump").rows)
    contacts.push_back({std::lround(row[0]), std::lround(row[1]), {row[2], row[3], row[4]}});
  const post::Table table = post::read_table(scratch / "plates.csv");
  for (std::size_t n = 0; n < plates.size(); ++n) {
    const char *const name = std::array{"left", "side", "base", "top", "back", "front"}[n];
    const std::size_t axis = n / 2;
    double sum = 0.0;
    for (const Contact &contact : contacts)
      if (contact.i == plates[n] || contact.j == plates[n])
        sum += (contact.i == plates[n] ? 1.0 : -1.0) * contact.force[axis];
    const double force = table.numbers(name).front();
    EXPECT_NEAR(sum, force, 1e-5 * scale) << name;
    for (const double share : {0.2, 0.4, 0.6, 0.8}) {
      const double cut = lowest[axis] + share * (highest[axis] - lowest[axis]);
      EXPECT_NEAR(force_through_cut(contacts, places, axis, cut), std::fabs(force), 2e-3 * scale)
          << name << ", cut at " << cut;
    }
  }
}

TEST(BiaxialEquilibrium, TheForcesOnThePlatesGoThroughEveryCut) {
  expect_equilibrium("biaxial", given("columns 8, layers 9"), 2, 100e3 * 8 * diameter);
}

TEST(TriaxialEquilibrium, TheForcesOnThePlatesGoThroughEveryCut) {
  expect_equilibrium("triaxial", given("columns 4, rows 4, layers 6"), 3, 100e3 * std::pow(6 * diameter, 2));
}

// A user changes the stress path by defining the force on the side platens (variable push_side) in the deck.
// With a force that keeps the mean stress constant, stresses are as wanted and energy is balanced.
TEST(StressPath, OfAConstantMeanStressIsKeptAndBalanced) {
  const std::string soil = chain_deck("../soil").string();
  for (const std::string test : {"biaxial", "triaxial"}) {
    const double sides = test == "biaxial" ? 1.0 : 2.0;
    const std::string push =
        fmt::format("-({}e3*v_side-f_on_top[3]/(v_width*v_depth))/{}*", sides + 1.0, sides);
    std::string deck = post::read_text(soil + "/in." + test);
    const std::size_t place = deck.rfind("include");
    std::string words = fmt::format("variable push_side equal {}v_height*v_depth\n", push);
    if (sides > 1.0) words += fmt::format("variable push_front equal {}v_width*v_height\n", push);
    deck.insert(place, words);
    const Scratch scratch;
    post::write_files({{scratch / "in.path", deck}});
    const std::string layers_of_test = sides > 1.0 ? "5" : "7";
    well(run_deck(scratch / "in.path",
                  given("here {}, sample {}, columns 4, layers {}, samples_of_strain 4, ramp 400, "
                        "inertial_number 1e-4, strain 1e-4",
                        soil, sides > 1.0 ? "face_centred" : "hexagonal", layers_of_test),
                  scratch.path()));
    const post::Table rows = post::read_table(scratch / (test + ".csv"));
    const std::vector<double> axial = rows.numbers("axial_stress_kPa"),
                              side = rows.numbers("side_stress_kPa");
    for (std::size_t n = 0; n < axial.size(); ++n)
      EXPECT_NEAR((axial[n] + sides * side[n]) / (sides + 1.0), 100.0, 0.1) << test;
    EXPECT_GT(axial.back(), 120.0) << test;
    expect_energy_balance(rows, 1e-2); // 0.2 with the work of a constant side stress
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, Biaxial, ::testing::Values("liggghts", "lammps"));

} // namespace compression

// Soil under its own weight: a vertical cut, the angle of repose.
namespace own_weight {

class OwnWeight : public InEngine {};

/// The default value of a variable in an input file: VALUE of the line `variable NAME index VALUE`, or of the
/// line `NAME VALUE` of a table.
std::string default_of(const std::string &file, const std::string &name) {
  std::istringstream lines(read_text(chain_deck(file)));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string command, variable, style, value;
    words >> command >> variable >> style >> value;
    if (command == "variable" && variable == name && style == "index") return value;
    if (command == name) return variable;
  }
  return "none in " + file;
}

// By default the element tests of strength are made with the friction and rolling friction of the bed's soil.
TEST(DefaultContacts, AreThoseOfTheBed) {
  for (const std::string deck : {"own_weight", "compression", "in.shear", "in.density"})
    for (const std::string name : {"friction", "rolling"})
      EXPECT_EQ(default_of("../soil/" + deck, name), default_of("../bed/variables", name)) << deck;
}

const Variables disordered = given("columns 7, layers 9, k 1e7, ramp 1000");

// A vertical cut: the wall moves away from the soil, which stands by its cohesion or follows the wall. A cut
// can be as high as 4 c/gamma tan(45 + phi/2). With the cohesion c that biaxial tests give, half of Rumpf's
// strength times tan(phi), this is 4 times the height of the sample for the larger suction, and 0.2 times
// for the smaller one.
TEST_P(OwnWeight, StandsAsAVerticalCutByItsSuction) {
  const auto force_behind = [](const std::string &suction) {
    const Variables variables =
        with(disordered, given("strain 0.1, samples_of_strain 10, suction {}", suction));
    const post::Table rows = run_element_test(GetParam(), "wall", variables);
    for (const double error : rows.numbers("energy_error"))
      EXPECT_LT(std::fabs(error), 1e-3);
    return rows.numbers("side_force_N");
  };
  const std::vector<double> stands = force_behind("200"), falls = force_behind("10");
  for (std::size_t row = 5; row < stands.size(); ++row) {
    EXPECT_DOUBLE_EQ(stands[row], 0.0) << row;
    EXPECT_GT(falls[row], 0.02 * falls.front()) << row;
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, OwnWeight, ::testing::Values("liggghts", "lammps"));

/// A heap that is left when the wall has gone.
struct Heap {
  double angle = 0.0;      ///< degrees
  double wall_force = 0.0; ///< N, at the end
  double energy_error = 0.0;
};

/// The heap of 105 balls, coarse, soft and fast, with ten times the inertial number of the default.
Heap heap(const std::string &engine, const Variables &variables) {
  const Scratch scratch;
  Variables all = variables; // the engine takes the first of a name
  all = with(all, given("columns 8, layers 14, samples_of_strain 30, inertial_number 8e-3, k 1e6, out out"));
  well(run_deck(chain_deck(std::string("../soil/in.repose") + (engine == "lammps" ? ".lammps" : "")), all,
                scratch.path()));
  const post::Table surface = post::read_table(scratch / "out/surface.csv"),
                    rows = post::read_table(scratch / "out/repose.csv");
  const std::vector<double> x = surface.numbers("x_m"), height = surface.numbers("height_m");
  std::vector<double> x_of_slope, slope;
  Heap result;
  for (std::size_t n = 0; n < x.size(); ++n) {
    if (height[n] < 0.04) continue; // a ball: the floor before the wall
    x_of_slope.push_back(x[n]);
    slope.push_back(height[n]);
  }
  result.angle = -180 / pi * std::atan(post::fit_line(x_of_slope, slope).slope.mean);
  result.wall_force = rows.numbers("side_force_N").back();
  result.energy_error = rows.numbers("energy_error").back();
  return result;
}

// Balls without friction on a smooth floor lie level, within a ball over the length of the surface, and press
// on the wall.
TEST(Repose, IsLevelWithoutFriction) {
  const Heap level = heap("liggghts", given("friction 0, rolling 0, floor plate, layers 12, strain 0.8"));
  const double length = 0.39 + 0.8 * 0.34; // m, between the walls at the end
  EXPECT_LT(std::fabs(level.angle), 180 / pi * 0.04 / length);
  EXPECT_GT(level.wall_force, 0);
}

// The slope stands without the wall, and is not steeper than friction allows: atan 0.8 = 39 degrees, and a
// few degrees for so few balls.
TEST(Repose, GrowsWithFriction) {
  const Heap smooth = heap("liggghts", given("friction 0.2, rolling 0.05")), rough = heap("liggghts", {});
  for (const Heap &one : {rough, smooth}) {
    EXPECT_EQ(one.wall_force, 0);
    EXPECT_LT(std::fabs(one.energy_error), 1e-3);
    EXPECT_GT(one.angle, 10);
    EXPECT_LT(one.angle, 45);
  }
  EXPECT_GT(rough.angle, smooth.angle + 3);
  if (!post::has_lammps()) return;
  const Heap in_lammps = heap("lammps", {});
  EXPECT_EQ(in_lammps.wall_force, 0);
  EXPECT_NEAR(in_lammps.angle, rough.angle, 10);
}

} // namespace own_weight

} // namespace
} // namespace drumlin::test
