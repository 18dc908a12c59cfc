// The plate load test: the forces below one loaded ball against Flamant's solution, the balance of forces and
// of energy, a disordered bed in both engines.
#include "bed/dump_readers.h"
#include "tests/support/checks.h"
#include "tests/support/element_runs.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::test {
namespace {

constexpr double radius = 0.02, root3 = 1.7320508075688772; // m

std::filesystem::path in_settle() { return chain_deck("../bed/in.settle"); }

const Variables own_contacts = {{"k", "1e9"}, {"dt", "1e-5"}}; // of lattices, in in.plate
const Variables without_pouring = {
    {"case", "gravel"},  {"k", "1e9"},  {"pour_k", "1e9"}, {"pour_friction", "0.8"}, {"pour_rolling", "0.3"},
    {"pour_dt", "1e-5"}, {"fall", "0"}, {"drag", "2000"},  {"ratio", "1e-6"}};

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
        with(without_pouring, {{"g", gravity}, {"balls", "balls.data"}, {"bed", "soil.restart"}});
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
    const Variables variables = with(own_contacts, {{"here", chain_deck("../soil").string()},
                                                    {"g", "981"},
                                                    {"bed", "soil.restart"},
                                                    {"plate_width", "0.04"},
                                                    {"plate_thickness", "0.04"},
                                                    {"seating", "1e-3"},
                                                    {"max_stress", stress},
                                                    {"stages", "1"},
                                                    {"reload", "0"},
                                                    {"drag", "2000"},
                                                    {"ramp", steps},
                                                    {"every", steps},
                                                    {"out", stress}});
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
    const Variables variables = with(own_contacts, {{"bed", (scratch / "soil.restart").string()},
                                                    {"plate_width", number(width)},
                                                    {"plate_thickness", "0.04"},
                                                    {"max_stress", "60"},
                                                    {"stages", "2"},
                                                    {"ramp", "500"},
                                                    {"drag", "2000"},
                                                    {"ratio", "1e-6"}});
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
    variables.insert(variables.end(), {{"bed", (scratch / "soil.restart").string()}, {"plate_width", "0.1"}});
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
  well(run_deck(in_settle(), {{"case", "gravel"}, {"balls", "balls.data"}, {"bed", "soil.restart"}},
                bed.path()));
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

} // namespace
} // namespace drumlin::test
