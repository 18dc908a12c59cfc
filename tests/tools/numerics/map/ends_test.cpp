// Motions of a drum with two ends: their orbits against those of the chain and CVODE, their modes, and the
// map of the command.
#include "files/roller.h"
#include "map/ends.h"
#include "map/ends_map.h"
#include "map/orbits.h"
#include "support/csv.h"
#include "support/files.h"
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"
#include "tests/support/lines.h"
#include "tests/support/tool.h"
#include "tests/support/two_ends_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

using namespace post;
namespace fs = std::filesystem;

TwoEnds equal_halves(double k, double D, int contacts, double hertz = 29.0) {
  const Roller roller = read_roller(DRUMLIN_SOURCE_DIR "/inputs/rollers/Axas2020");
  ChainParameters chain;
  set_machine(chain, roller, roller.settings.front());
  chain.transition = Transition::B;
  chain.Fw *= std::pow(hertz / 29.0, 2);
  chain.omega *= hertz / 29.0;
  chain.k = k;
  chain.D = D;
  TwoEnds machine = two_ends(chain, Roller()); // equal bonds
  machine.contacts = equal_contacts(contacts, 2.13, chain.k, chain.damping());
  return machine;
}

std::optional<OrbitOf<EndsCycles>> orbit_of(const TwoEndsSolver &solver) {
  TwoEndsMotion motion = solver.start();
  for (int cycle = 0; cycle < 300; ++cycle)
    solver.finish_cycle(motion);
  return newton_orbit(EndsCycles{solver}, motion.state, 1);
}

// Four of the eight multipliers are those of bouncing, which the chain has.
TEST(EndsOrbit, EqualHalvesHaveTheMultipliersOfTheChain) {
  for (const double k : {15e6, 40e6}) {
    const TwoEnds machine = equal_halves(k, 0.2, 2);
    const TwoEndsSolver solver(machine);
    const auto orbit = orbit_of(solver);
    ASSERT_TRUE(orbit);
    const ChainSolver chain(machine.chain);
    ChainMotion motion = chain.start();
    for (int cycle = 0; cycle < 300; ++cycle)
      chain.finish_cycle(motion);
    const auto single = find_orbit(chain, motion.state, 1);
    ASSERT_TRUE(single);
    for (const std::complex<double> &of_chain : single->multipliers) {
      double nearest = 1.0;
      for (const std::complex<double> &one : orbit->multipliers)
        nearest = std::min(nearest, std::abs(one - of_chain));
      EXPECT_LT(nearest, 1e-8);
    }
  }
}

// Two contacts at L/sqrt(12) and any number of equal ones along the width are the same in unbroken contact.
TEST(EndsOrbit, TwoContactsAreALineOfSpringsInUnbrokenContactOnly) {
  const auto multipliers = [](double k, int contacts, double ratio) {
    TwoEnds machine = equal_halves(k, 0.2, contacts);
    for (AxleLink &contact : machine.contacts) {
      const double share = 1.0 + ratio * contact.y; // a linear slope of the stiffness
      contact.k *= share;
      contact.c *= share;
    }
    const auto orbit = orbit_of(TwoEndsSolver(machine));
    EXPECT_TRUE(orbit);
    return orbit ? std::abs(orbit->multipliers[0]) : 0.0;
  };
  for (const int contacts : {4, 8, 16})
    EXPECT_NEAR(multipliers(12e6, contacts, 0.0), multipliers(12e6, 2, 0.0), 1e-9) << contacts;
  EXPECT_GT(std::fabs(multipliers(35e6, 16, 0.6) - multipliers(35e6, 2, 0.6)), 1e-4);
}

TEST(EndsOrbit, EqualHalvesLoseContactWhereTheChainDoes) {
  for (const Transition transition : {Transition::A, Transition::B})
    for (const double k : {10e6, 25e6, 60e6}) {
      TwoEnds machine = equal_halves(k, 0.25, 2);
      machine.chain.transition = transition;
      const double weight = (machine.chain.m2 + machine.chain.m3) * machine.chain.g;
      EXPECT_NEAR(2.0 * ends_margin(machine), contact_margin(machine.chain), 1e-9 * weight);
    }
}

// Partial uplift that is not stable against tilting ends in rocking: the drum is low on one side in one cycle
// and on the other side in the next. CVODE returns to the same state after two cycles, and to its mirror
// image after one.
TEST(EndsModes, ADrumRocks) {
  TwoEnds machine = equal_halves(74e6, 0.23, 2, 22.0);
  machine.drum_inertia = 2900.0;
  machine.tilt = 1e-5;
  const TwoEndsSolver solver(machine);
  TwoEndsMotion motion = solver.start();
  const EndsPoint point = judge_ends_from(solver, motion, 300);
  EXPECT_EQ(point.mode, EndsMode::rocking) << ends_mode_names[static_cast<std::size_t>(point.mode)];
  EXPECT_EQ(point.period, 2);
  EXPECT_LT(point.multiplier, 1.0);
  EXPECT_GT(point.tilt, 1e-4);
  EXPECT_NEAR(point.contact_share[0], point.contact_share[1], 1e-6);
  const TwoEndsState scale = EndsCycles{solver}.scale();
  const TwoEndsState start = motion.state;
  TwoEndsOracle oracle(machine, start);
  const auto apart = [&](int cycles, bool mirrored) {
    const oracle::State &y = oracle.at(cycles * machine.chain.period());
    double most = 0.0;
    for (int i = 0; i < 8; ++i) {
      const bool tilt = i % 4 >= 2;
      const double expected = tilt && mirrored ? -start[i] : start[i];
      most = std::max(most, std::fabs(y[static_cast<std::size_t>(i)] - expected) / scale[i]);
    }
    return most;
  };
  EXPECT_LT(apart(1, true), 1e-6);
  EXPECT_LT(apart(2, false), 1e-6);
}

// CVODE goes on from the state that the machine settles to, and tells which ends leave the soil within two
// cycles and whether the state is the same after one. The halves are never quite equal, since CVODE would
// find one of two contacts that break at the same time.
TEST(EndsModes, AreTold) {
  struct Scene {
    TwoEnds machine;
    double ratio;
    EndsMode mode;
    int ends_lost, period;
  };
  for (Scene scene : {Scene{equal_halves(12e6, 0.2, 2), 1.5, EndsMode::continuous_contact, 0, 1},
                      Scene{equal_halves(25e6, 0.2, 2), 2.5, EndsMode::uplift_of_one_end, 1, 1},
                      Scene{equal_halves(38e6, 0.2, 4), 1.02, EndsMode::uplift_of_both_ends, 2, 1},
                      Scene{equal_halves(55e6, 0.2, 2), 1.02, EndsMode::double_jump, 2, 2},
                      Scene{equal_halves(50e6, 0.2, 2), 3.0, EndsMode::combined, 2, 2}}) {
    SCOPED_TRACE(ends_mode_names[static_cast<std::size_t>(scene.mode)]);
    for (AxleLink &contact : scene.machine.contacts) {
      const double share = 2.0 / (1.0 + scene.ratio) * (contact.y < 0.0 ? scene.ratio : 1.0);
      contact.k *= share;
      contact.c *= share;
    }
    scene.machine.tilt = 1e-5;
    const TwoEndsSolver solver(scene.machine);
    TwoEndsMotion motion = solver.start();
    EXPECT_EQ(judge_ends_from(solver, motion, 300).mode, scene.mode);
    const TwoEndsState scale = EndsCycles{solver}.scale();
    TwoEndsOracle oracle(scene.machine, motion.state);
    const auto apart = [&](int cycles) {
      const oracle::State &y = oracle.at(cycles * scene.machine.chain.period());
      double most = 0.0;
      for (int i = 0; i < 8; ++i)
        most = std::max(most, std::fabs(y[static_cast<std::size_t>(i)] - motion.state[i]) / scale[i]);
      return most;
    };
    const double after_one = apart(1), after_two = apart(2);
    EXPECT_LT(after_two, 1e-5);
    EXPECT_EQ(after_one < 1e-5 ? 1 : 2, scene.period) << after_one;
    EXPECT_EQ(int(oracle.left_lost()) + int(oracle.right_lost()), scene.ends_lost);
  }
}

/// What a cycle makes of small differences of the state, by CVODE.
TwoEndsMatrix growth_in_a_cycle(const TwoEnds &machine, const TwoEndsState &state) {
  TwoEndsMatrix growth;
  const TwoEndsState scale = EndsCycles{TwoEndsSolver(machine)}.scale();
  for (int i = 0; i < 8; ++i) {
    TwoEndsState ends[2];
    constexpr double small = 1e-5;
    for (int side = 0; side < 2; ++side) {
      TwoEndsState start = state;
      start[i] += (side == 0 ? -small : small) * scale[i];
      TwoEndsOracle oracle(machine, start);
      const oracle::State &end = oracle.at(machine.chain.period());
      ends[side] = Eigen::Map<const TwoEndsState>(end.data());
    }
    growth.col(i) = (ends[1] - ends[0]) / (2.0 * small * scale[i]);
  }
  return growth;
}

// Where the map has a boundary to motions of two cycles, a difference turns its sign in a cycle and keeps its
// size: the multiplier is -1, here by CVODE. Between the points of these rows rocking begins, or double jump.
TEST(EndsBoundaries, HaveAMultiplierOfMinusOne) {
  EndsFamily family;
  const Roller roller = read_roller(DRUMLIN_SOURCE_DIR "/inputs/rollers/Axas2020");
  set_machine(family.chain.base, roller, roller.settings.front());
  family.chain.base.transition = Transition::B;
  family.chain.base.D = 0.2;
  family.roller = roller;
  MapGrid grid;
  grid.chain = family.chain;
  grid.x = {"k", 35e6, 55e6, 5, false};
  grid.y = {"ratio", 1.02, 2.0, 2, false};
  std::vector<EndsPoint> points;
  for (std::size_t i = 0; i < grid.size(); ++i)
    points.push_back(judged(family, grid, i));
  const std::vector<BoundaryPoint> found = ends_boundaries(family, grid, points, 2);
  int doublings = 0;
  for (const BoundaryPoint &point : found) {
    if (point.kind != "period doubling") continue;
    SCOPED_TRACE(std::to_string(point.x) + " N/m, ratio " + std::to_string(point.y));
    ++doublings;
    const TwoEnds machine = family.at({{"k", point.x}, {"ratio", point.y}});
    // The orbit is followed from soil on which it is stable.
    const TwoEndsSolver below(family.at({{"k", 0.98 * point.x}, {"ratio", point.y}}));
    TwoEndsMotion motion = below.start();
    for (int cycle = 0; cycle < 600; ++cycle)
      below.finish_cycle(motion);
    const TwoEndsSolver solver(machine);
    const auto orbit = newton_orbit(EndsCycles{solver}, motion.state, 1);
    ASSERT_TRUE(orbit);
    const auto multipliers = floquet_multipliers<8>(growth_in_a_cycle(machine, orbit->state));
    double nearest = 1.0;
    for (const std::complex<double> &one : multipliers)
      nearest = std::min(nearest, std::abs(one + 1.0));
    EXPECT_LT(nearest, 1e-3);
  }
  EXPECT_EQ(doublings, 3);
}

class EndsMapCommand : public Tool {
protected:
  Outcome map(const std::vector<std::string> &words) const { return drumlin("map", words); }
  const std::string axas_ = DRUMLIN_SOURCE_DIR "/inputs/rollers/Axas2020";
};

TEST_F(EndsMapCommand, WritesModesOverStiffnessAndRatio) {
  draw();
  const Outcome outcome = well(map({"--contacts", "2", "--roller", axas_, "--D", "0.2", "--x",
                                    "k:10e6:60e6:4", "--y", "ratio:1:3:3:log", "--out", "m"}));
  EXPECT_TRUE(printed(outcome, "m: 12 points on 2 contacts: continuous contact at "));
  const Table table = read_table(scratch_ / "m/regimes.csv");
  EXPECT_EQ(table.rows(), 12U);
  for (const char *column : {"k [N/m]", "ratio [-]", "regime", "period [cycles]", "multiplier [-]",
                             "exponent [1/cycle]", "tilt [rad]", "contact_left [-]", "contact_right [-]"})
    EXPECT_TRUE(table.has(column)) << column;
  EXPECT_EQ(table.text("regime").front(), "continuous contact");
  // The side of the stiffer soil is the one that lifts off.
  EXPECT_LT(table.numbers("contact_left [-]").back(), table.numbers("contact_right [-]").back());
  for (const char *name :
       {"modes.png", "tilt.png", "contact_left.png", "contact_right.png", "index.html", "parameters.csv"})
    EXPECT_TRUE(fs::is_regular_file(scratch_ / "m" / name)) << name;
  EXPECT_GT(read_table(scratch_ / "m/boundaries.csv").rows(), 1U);

  // Continued where it was interrupted, it is the same.
  const std::string whole = read_text(scratch_ / "m/regimes.csv");
  const std::vector<std::string> lines = lines_of(whole);
  std::string part;
  for (std::size_t i = 0; i < 6; ++i)
    part += lines[i] + "\n";
  write_files({{scratch_ / "m/regimes.csv", part}});
  const Outcome more = well(map({"--contacts", "2", "--roller", axas_, "--D", "0.2", "--x", "k:10e6:60e6:4",
                                 "--y", "ratio:1:3:3:log", "--out", "m"}));
  EXPECT_TRUE(printed(more, "5 of 12 points are there already"));
  EXPECT_EQ(read_text(scratch_ / "m/regimes.csv"), whole);

  well(map({"--contacts", "3", "--roller", axas_, "--D", "0.2", "--sweep", "k:20e6:60e6:5", "--out", "s"}));
  const Table sweep = read_table(scratch_ / "s/sweep.csv");
  EXPECT_EQ(sweep.rows(), 10U);
  EXPECT_EQ(sweep.text("direction").back(), "down");
  EXPECT_TRUE(fs::is_regular_file(scratch_ / "s/sweep.png"));
}

} // namespace
} // namespace drumlin::test
