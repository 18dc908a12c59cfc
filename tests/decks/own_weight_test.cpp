// Tests of soil under its own weight: a hexagonal lattice without friction between its balls against the
// equilibrium of its balls, behind a smooth wall and in a silo; Janssen's and Rankine's theory; the angle of
// repose with and without friction; disordered samples in both engines.
#include "support/statistics.h"
#include "tests/support/checks.h"
#include "tests/support/element_runs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

/// Forces of a hexagonal lattice on walls and floor over its weight.
struct Statics {
  double walls = 0.0; ///< normal force on both walls
  double floor = 0.0;
};

/// Equilibrium of the balls of a lattice, row by row from above, if the balls of a row are apart and have no
/// friction between each other, so that all forces are normal ones in contacts at 60 degrees, and the outer
/// balls of every second row, the longer ones, slide down the walls. The lowest row is a shorter one. A
/// contact of a ball inside passes on the force from above in its direction and half of the ball's weight.
/// \param columns balls in a longer row
Statics statics(int columns, int layers, double wall_friction) {
  const double sine = std::sqrt(0.75), cosine = 0.5;
  // To the right and to the left down, of each ball of a row; weights are 1. Outside of the outer balls there
  // is none.
  std::vector<double> right, left;
  double walls = 0.0, weight = 0.0;
  for (int row = layers; row > 0; --row) {
    const bool longer = row % 2 == 0;
    const int balls = longer ? columns : columns - 1;
    std::vector<double> from_left(static_cast<std::size_t>(balls), 0.0), from_right = from_left;
    for (std::size_t n = 0; n < right.size(); ++n) {
      if (longer) {
        from_left[n + 1] = right[n];
        from_right[n] = left[n];
        continue;
      }
      if (n < from_left.size()) from_left[n] = right[n];
      if (n > 0) from_right[n - 1] = left[n];
    }
    right = from_left;
    left = from_right;
    for (std::size_t n = 0; n < right.size(); ++n) {
      right[n] += 0.5 / sine;
      left[n] += 0.5 / sine;
    }
    weight += balls;
    if (!longer) continue;
    // The outer balls: from one side f, to the same side g; N = (f + g) cos 60, (g - f) sin 60 = weight -
    // friction N.
    const auto reflected = [&](double f) {
      const double g = (f * (sine - wall_friction * cosine) + 1.0) / (sine + wall_friction * cosine);
      walls += (f + g) * cosine;
      return g;
    };
    right.front() = reflected(from_right.front());
    left.front() = 0.0;
    left.back() = reflected(from_left.back());
    right.back() = 0.0;
  }
  const double floor = sine * (std::accumulate(right.begin(), right.end(), 0.0) +
                               std::accumulate(left.begin(), left.end(), 0.0));
  return {walls / weight, floor / weight};
}

/// A run of an element test, and what follows from its CSV file.
class WeightRun {
public:
  WeightRun(const std::string &engine, const std::string &name, const Variables &variables)
      : table_(run_element_test(engine, name, variables)) {}

  double last(const std::string &column) const { return table_.numbers(column).back(); }
  double first(const std::string &column) const { return table_.numbers(column).front(); }
  std::vector<double> side_force() const { return table_.numbers("side_force_N"); }
  double walls() const { return last("left_force_N") + last("side_force_N"); }
  double wall_friction() const { return last("left_friction_N") + last("side_friction_N"); }
  /// Expects that the absolute energy error of each row of the CSV file is below a bound.
  /// \param bound largest error that is allowed, relative to the largest work up to that row
  void expect_energy_balance(double bound = 1e-3) const {
    for (const double error : table_.numbers("energy_error"))
      EXPECT_LT(std::fabs(error), bound);
  }

private:
  post::Table table_;
};

double ball_weight() { return 2650 * pi * 0.02 * 0.02 * 9.81; } // N, the decks' balls

class OwnWeight : public InEngine {};

Variables lattice(int layers, Variables more) {
  more.insert(more.end(), {{"sample", "hexagonal"}, {"columns", "8"}, {"layers", std::to_string(layers)}});
  return more;
}

// The statics themselves: without friction of the walls the floor carries all, and a wall as much as the sum
// over the longer rows, j rows below the top, of j weights over tan 60, a third of the hydrostatic force for
// many rows.
TEST(LatticeStatics, AreThoseOfSmoothWalls) {
  const Statics smooth = statics(8, 9, 0.0);
  EXPECT_NEAR(smooth.floor, 1.0, 1e-12);
  EXPECT_NEAR(smooth.walls, 2 * (2 + 4 + 6 + 8) / std::sqrt(3.0) / 67, 1e-12);
  const Statics rough = statics(8, 9, 0.3);
  EXPECT_NEAR(rough.floor + 0.3 * rough.walls, 1.0, 1e-12);
}

// Rankine: smooth walls carry a third of the hydrostatic force, since the friction angle of the lattice is 30
// degrees, and more by the outer balls.
TEST_P(OwnWeight, FindsTheActiveForceOfALattice) {
  for (const std::string stepping : {"stock", "second"}) {
    SCOPED_TRACE(stepping);
    const WeightRun run(GetParam(), "wall",
                        lattice(9, {{"friction", "0"},
                                    {"rolling", "0"},
                                    {"stepping", stepping},
                                    {"inertial_number", "1e-4"},
                                    {"strain", "2e-4"},
                                    {"ramp", "1000"},
                                    {"samples_of_strain", "10"}}));
    const double exact = statics(8, 9, 0.0).walls * 67 * ball_weight();
    EXPECT_NEAR(run.walls(), exact, 5e-3 * exact);
    EXPECT_NEAR(run.last("floor_force_N"), 67 * ball_weight(), 2e-3 * 67 * ball_weight());
  }
}

// Janssen, without a parameter: the lattice's ratio of the stresses is 1/3; its equilibrium has the effects
// of its few columns besides. Rolling resistance keeps the outer balls from rolling down the walls, and
// friction of 1e-6 between balls is none.
TEST_P(OwnWeight, FindsTheFloorForceOfALatticeInASilo) {
  const WeightRun run(GetParam(), "silo",
                      lattice(25, {{"friction", "1e-6"},
                                   {"rolling", "1e-5"},
                                   {"wall_friction", "0.3"},
                                   {"strain", "1e-4"},
                                   {"ramp", "1000"},
                                   {"samples_of_strain", "8"}}));
  const Statics exact = statics(8, 25, 0.3);
  const double balls = 12 * 8 + 13 * 7, weight = balls * ball_weight();
  EXPECT_NEAR(run.walls(), exact.walls * weight, 2e-3 * weight);
  EXPECT_NEAR(run.last("floor_force_N"), exact.floor * weight, 2e-3 * weight);
  EXPECT_NEAR(run.wall_friction(), 0.3 * run.walls(), 1e-3 * run.walls());
  const double height = 25 * std::sqrt(3.0) * 0.02, width = 8 * 0.04, x = 2 * 0.3 / 3 * height / width;
  EXPECT_NEAR(exact.floor, (1 - std::exp(-x)) / x, 0.02) << "the lattice is too small for Janssen's theory";
  run.expect_energy_balance();
}

TEST_P(OwnWeight, StandsOnTheFloorAloneBetweenSmoothWalls) {
  const WeightRun run(GetParam(), "silo",
                      lattice(9, {{"friction", "0"},
                                  {"rolling", "0"},
                                  {"wall_friction", "0"},
                                  {"ratio", "1e-6"},
                                  {"strain", "1e-5"},
                                  {"ramp", "200"},
                                  {"samples_of_strain", "1"}}));
  EXPECT_NEAR(run.first("floor_force_N"), 67 * ball_weight(), 1e-5 * 67 * ball_weight());
  EXPECT_NEAR(run.first("left_force_N"), run.first("side_force_N"), 1e-4 * run.first("side_force_N"));
}

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

const Variables disordered = {{"columns", "7"}, {"layers", "9"}, {"k", "1e7"}, {"ramp", "1000"}};

// A disordered sample fails, carried by both walls alike; the force is between those of friction angles of 25
// and 50 degrees.
TEST_P(OwnWeight, FindsTheActiveForceOfADisorderedSample) {
  const Variables variables = with(disordered, {{"strain", "5e-3"}, {"samples_of_strain", "5"}});
  const WeightRun run(GetParam(), "wall", variables);
  EXPECT_GT(run.first("side_force_N"), 2 * run.last("side_force_N"));
  EXPECT_NEAR(run.last("left_force_N"), run.last("side_force_N"), 0.1 * run.last("side_force_N"));
  EXPECT_NEAR(run.last("floor_force_N"), run.first("floor_force_N"), 0.02 * run.first("floor_force_N"));
  run.expect_energy_balance();
}

// A vertical cut: the wall moves away from the soil, which stands by its cohesion or follows the wall. A cut
// can be as high as 4 c/gamma tan(45 + phi/2). With the cohesion c that biaxial tests give, half of Rumpf's
// strength times tan(phi), this is 4 times the height of the sample for the larger suction, and 0.2 times
// for the smaller one.
TEST_P(OwnWeight, StandsAsAVerticalCutByItsSuction) {
  const auto force_behind = [](const std::string &suction) {
    const Variables variables =
        with(disordered, {{"strain", "0.1"}, {"samples_of_strain", "10"}, {"suction", suction}});
    const WeightRun run(GetParam(), "wall", variables);
    run.expect_energy_balance();
    return run.side_force();
  };
  const std::vector<double> stands = force_behind("200"), falls = force_behind("10");
  for (std::size_t row = 5; row < stands.size(); ++row) {
    EXPECT_DOUBLE_EQ(stands[row], 0.0) << row;
    EXPECT_GT(falls[row], 0.02 * falls.front()) << row;
  }
}

// Full friction of the walls, and the balance of the vertical forces.
TEST_P(OwnWeight, MobilisesTheFrictionOfTheWallsOfASilo) {
  const Variables variables =
      with(disordered, {{"strain", "1e-3"}, {"samples_of_strain", "5"}, {"inertial_number", "1e-4"}});
  const WeightRun run(GetParam(), "silo", variables);
  EXPECT_NEAR(run.wall_friction(), 0.3 * run.walls(), 0.01 * run.walls());
  EXPECT_NEAR(run.last("floor_force_N") + run.wall_friction(),
              run.first("floor_force_N") + run.first("left_friction_N") + run.first("side_friction_N"),
              5e-3 * run.first("floor_force_N"));
  EXPECT_LT(run.last("floor_force_N"), 0.9 * run.first("floor_force_N"));
}

// The floor moves by 4e-9 m in a time step, and its position is a multiple of 2e-12 m, the spacing of
// floating-point numbers there. If rounding changed this distance, the work computed from the velocity would
// be wrong, and the energy error 6e-3.
TEST_P(OwnWeight, BalancesTheEnergyOfASlowFloor) {
  const WeightRun run(
      GetParam(), "silo",
      {{"columns", "8"}, {"layers", "8"}, {"strain", "1e-4"}, {"ramp", "1000"}, {"samples_of_strain", "5"}});
  run.expect_energy_balance(2e-4);
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
  all.insert(all.end(), {{"columns", "8"},
                         {"layers", "14"},
                         {"samples_of_strain", "30"},
                         {"inertial_number", "8e-3"},
                         {"k", "1e6"},
                         {"out", "out"}});
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
  const Heap level =
      heap("liggghts",
           {{"friction", "0"}, {"rolling", "0"}, {"floor", "plate"}, {"layers", "12"}, {"strain", "0.8"}});
  const double length = 0.39 + 0.8 * 0.34; // m, between the walls at the end
  EXPECT_LT(std::fabs(level.angle), 180 / pi * 0.04 / length);
  EXPECT_GT(level.wall_force, 0);
}

// The slope stands without the wall, and is not steeper than friction allows: atan 0.8 = 39 degrees, and a
// few degrees for so few balls.
TEST(Repose, GrowsWithFriction) {
  const Heap smooth = heap("liggghts", {{"friction", "0.2"}, {"rolling", "0.05"}}),
             rough = heap("liggghts", {});
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

} // namespace
} // namespace drumlin::test
