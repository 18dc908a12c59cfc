// Suction between two balls, and of a soil: forces, friction, energies and records in closed form, in both
// engines and with both schemes.
#include "tests/support/checks.h"
#include "tests/support/engine_and_scheme.h"
#include "tests/support/host_deck.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

constexpr double k = 1e6, diameter = 0.1; // of pair.scene: N/m, m

class Suction : public BothEngines {};
INSTANTIATE_TEST_SUITE_P(Both, Suction, engines_and_steppings(), engine_and_stepping);

double gap_of(const Ball &one, const Ball &two) {
  return std::hypot(one.x[0] - two.x[0], one.x[1] - two.x[1], one.x[2] - two.x[2]) - diameter;
}

// Two heavy balls slide past each other. The net force is k d - F_a, here a tension; friction is mu k d.
TEST_P(Suction, PullsAndLeavesFrictionToTheSpring) {
  constexpr double mu = 0.5;
  for (const double pull : {60.0, 150.0}) {
    const Scratch folder;
    well(run("pair", folder,
             {{"one", "0 0.0999 0.5"},
              {"two", "0 0 0.5"},
              {"m1", "1e7"},
              {"m2", "1e7"},
              {"c", "0"},
              {"mu", number(mu)},
              {"suction", number(pull)},
              {"first", "velocity one set 1 0 0 units box"},
              {"box", "block -0.5 0.5 -0.5 0.5 0 1"},
              {"steps", "200"},
              {"every", "100"}}));
    const auto balls = read_dump(folder / "balls.txt").back().balls;
    const Ball &one = balls.at(1), &two = balls.at(2);
    const double d = -gap_of(one, two), distance = diameter - d;
    const std::array<double, 2> normal{(one.x[0] - two.x[0]) / distance, (one.x[1] - two.x[1]) / distance};
    const double push = one.f[0] * normal[0] + one.f[1] * normal[1];
    const double across = one.f[0] * normal[1] - one.f[1] * normal[0];
    EXPECT_NEAR(push, k * d - pull, 1e-6 * k * d);
    EXPECT_NEAR(across, -mu * k * d, 1e-6 * k * d);
  }
}

// Two balls that meet at 1 m/s: they leave each other or stick. Kinetic energy, spring, -F_a d and the heat
// of the dashpot are what they brought.
TEST_P(Suction, ClosesTheEnergyBalance) {
  for (const char *transition : {"A", "B"})
    for (const double pull : {30.0, 2000.0}) {
      const Scratch folder;
      well(run("pair", folder,
               {{"one", "0 0.55001 0.5"},
                {"two", "0 0.45 0.5"},
                {"transition", transition},
                {"c", "200"},
                {"suction", number(pull)},
                {"first", "velocity one set 0 -0.5 0 units box"},
                {"second", "velocity two set 0 0.5 0 units box"},
                {"dt", "1e-5"},
                {"steps", "1000"},
                {"every", "1000"}}));
      const auto balls = read_dump(folder / "balls.txt").back().balls;
      std::ifstream file(folder / "heat.txt");
      double t = 0, heat = 0, rubbed = 0;
      while (file >> t >> heat >> rubbed) {
      }
      const double d = std::max(0.0, -gap_of(balls.at(1), balls.at(2)));
      double energy = heat + 0.5 * k * d * d - pull * d;
      for (const auto &[id, ball] : balls)
        for (const double v : ball.v)
          energy += 0.5 * v * v;
      EXPECT_EQ(d > 0.0, pull > 1000.0) << transition;
      // Under `stock` the make falls within a step whose force begins at its end.
      const double scheme = std::get<1>(GetParam()) == "stock" ? 2e-2 * 0.25 + 0.5 * pull * 1.0 * 1e-5 : 0.0;
      EXPECT_NEAR(energy, 0.25, 1e-3 * 0.25 + scheme) << transition << ' ' << pull;
    }
}

// A pair that sticks lies still: from half a million steps on it has the same bits.
TEST_P(Suction, LetsAPairLieStillForAMillionSteps) {
  constexpr double pull = 2000.0;
  const Scratch folder;
  well(run("pair", folder,
           {{"one", "0 0.099 0.5"},
            {"two", "0 0 0.5"},
            {"box", "block -0.5 0.5 -0.5 0.5 0 1"},
            {"c", "200"},
            {"suction", number(pull)},
            {"steps", "1000000"},
            {"every", "500000"}}));
  const std::vector<Frame> frames = read_dump(folder / "balls.txt");
  ASSERT_EQ(frames.size(), 3u);
  for (const long id : {1, 2})
    EXPECT_EQ(frames[1].balls.at(id).x, frames[2].balls.at(id).x);
  EXPECT_NEAR(-gap_of(frames[2].balls.at(1), frames[2].balls.at(2)), pull / k, 1e-12 * pull / k + 1e-16);
}

// The record of makes and breaks: under B, too, the contact ends at d = 0, where it pulls with F_a.
TEST_P(Suction, IsInTheRecordOfEvents) {
  constexpr double pull = 30.0;
  const Scratch folder;
  well(run("pair", folder,
           {{"one", "0 0.55001 0.5"},
            {"two", "0 0.45 0.5"},
            {"c", "0"},
            {"suction", number(pull)},
            {"first", "velocity one set 0 -1 0 units box"},
            {"dt", "1e-5"},
            {"steps", "500"}}));
  const std::vector<post::ContactEvent> events = post::read_events(folder / "events.csv");
  ASSERT_EQ(events.size(), 2u);
  for (const post::ContactEvent &event : events)
    EXPECT_NEAR(event.force, -pull, 1e-9);
  // The oscillator of the reduced mass about d = F_a/k, until it is at 0 again.
  const double w = std::sqrt(k / 0.5), phase = std::atan(pull / k * w);
  EXPECT_NEAR(events[1].time - events[0].time, (pi + 2.0 * phase) / w, 2e-5);
}

// A ball that hangs under a wall of the same type, and does not where the suction is less than its weight.
TEST_P(Suction, HoldsABallUnderAWallThatHasIt) {
  const bool lammps = std::get<0>(GetParam()) == "lammps";
  const std::string wall =
      lammps
          ? "fix wall all wall/gran/transition 1 zplane NULL 0.9"
          : "fix wall all wall/gran model hooke/transition tangential coulomb primitive type 1 zplane 0.9 " +
                std::string("damping coefficient stepping ") + std::get<1>(GetParam());
  for (const double pull : {9.0, 11.0}) {
    const Scratch folder;
    Variables all = {{"one", "0 0 0.850001"},
                     {"two", "0 0.3 0.5"},
                     {"c", "500"},
                     {"suction", number(pull)},
                     {"sides", "p p f"},
                     {"box", "block -0.5 0.5 -0.5 0.5 0 1"},
                     {"second", "fix gravity all gravity 9.81 vector 0 0 -1"},
                     {"steps", "20000"}};
    all.emplace_back("first", wall);
    well(run("pair", folder, all));
    const Ball ball = read_dump(folder / "balls.txt").back().balls.at(1);
    if (pull > 9.81) {
      EXPECT_NEAR(ball.x[2] + 0.05 - 0.9, (pull - 9.81) / k, 1e-9);
    } else {
      EXPECT_LT(ball.x[2], 0.849);
    }
  }
}

// Rumpf's formula for balls of one size: F_a = S pi d^(n-1)/(P Z) in n dimensions.
TEST_P(Suction, FollowsFromTheTensileStrengthOfASoil) {
  const bool lammps = std::get<0>(GetParam()) == "lammps";
  for (const char *test : {"biaxial", "triaxial"}) {
    const bool flat = std::string(test) == "biaxial";
    const Variables small = {{"sample", flat ? "hexagonal" : "cubic"},
                             {"columns", "4"},
                             {"layers", "4"},
                             {"tensile_strength", "1e4"},
                             {"solid_fraction", "0.7"},
                             {"contacts_per_ball", "4.5"},
                             {"strain", "1e-2"},
                             {"samples_of_strain", "1"},
                             {"stepping", std::get<1>(GetParam())}};
    const Scratch folder;
    const Outcome outcome =
        well(run_deck(chain_deck(std::string("../soil/in.") + test + (lammps ? ".lammps" : "")),
                      with(small, {{"rows", flat ? "1" : "4"}}), folder.path()));
    const std::size_t at = outcome.output.rfind("suction ");
    ASSERT_NE(at, std::string::npos);
    const double expected = 1e4 * pi * (flat ? 0.04 : 0.04 * 0.04) / (0.7 * 4.5);
    EXPECT_NEAR(std::stod(outcome.output.substr(at + 8)), expected, 1e-9 * expected);
  }
  const Scratch folder;
  const Outcome both =
      run_deck(chain_deck(std::string("../soil/in.biaxial") + (lammps ? ".lammps" : "")),
               {{"sample", "hexagonal"}, {"tensile_strength", "1"}, {"suction", "1"}}, folder.path());
  EXPECT_TRUE(
      printed(both, "ERROR: drumlin/check: variable suction is '1'; allowed: a finite number at most 0"));
}

} // namespace
} // namespace drumlin::test
