// The chain that drives over soil that changes, in both engines, against the exact solution: steps, ramps and
// a random field of k and D; over uniform soil against the chain that stands.
#include "tests/support/chain_by_cvode.h"
#include "tests/support/checks.h"
#include "tests/support/engine_and_scheme.h"
#include "tests/support/lines.h"

#include "chain/analysis.h"
#include "chain/exact_solution.h"
#include "support/csv.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

constexpr int samples = 50;

/// A way, and how the roller of Table 1 drives over it.
struct Drive {
  const char *name;
  Way way;
  double speed;
  int passes;

  double duration() const { return passes * (way.back().s - way.front().s) / speed; }
};

// Places of steps are such that none coincides with the end of a time step.
const Drive steps{
    "steps", {{0, 1e7, 0.1}, {0.2123, 1e7, 0.1}, {0.2123, 1.6e7, 0.2}, {0.3, 1.6e7, 0.2}}, 1, 2};
const Drive onto_stiff_soil{
    "onto_stiff_soil", {{3, 2e7, 0.25}, {3.2071, 2e7, 0.25}, {3.2071, 8e7, 0.25}, {3.45, 8e7, 0.25}}, 1, 2};
const Drive ramps{"ramps", {{-1, 3e7, 0.3}, {-0.8, 6e7, 0.2}, {-0.5, 2e7, 0.4}}, 1.5, 2};

Drive random_field() {
  post::RandomSoil soil;
  soil.mean = 4.5e7;
  soil.variation = 0.3;
  soil.correlation = 0.1;
  soil.D = 0.3;
  soil.to = 0.4;
  soil.step = 0.02;
  return {"random", post::random_way(soil), 1, 1};
}

class DrivenChain : public BothEngines {
protected:
  static Outcome run_chain_over(const Drive &drive, int steps_per_cycle, const Scratch &folder,
                                const Variables &more = {}) {
    write(folder / "way.csv", post::way_text(drive.way));
    const auto &[engine, stepping] = GetParam();
    return run_deck(chain_deck(engine == "lammps" ? "in.way.lammps" : "in.way"),
                    with(more, {{"way", (folder / "way.csv").string()},
                                {"speed", number(drive.speed)},
                                {"passes", std::to_string(drive.passes)},
                                {"steps_per_cycle", std::to_string(steps_per_cycle)},
                                {"samples_per_cycle", std::to_string(samples)},
                                {"stepping", stepping}}),
                    folder.path());
  }
  static void write(const fs::path &file, const std::string &text) { std::ofstream(file) << text; }

  static post::ChainHistory exact(const Drive &drive, post::Transition transition) {
    post::ChainParameters p = post::table1_case("II", transition);
    p.k = drive.way.front().k;
    p.D = drive.way.front().D;
    post::ExactOptions options;
    options.way = post::drive(drive.way, drive.speed, drive.passes);
    options.cycles = drive.duration() / p.period();
    options.samples_per_cycle = samples;
    return drumlin::test::solve_by_cvode(p, options).history;
  }

  /// RMS error of a column over its RMS value, where both have rows.
  static double error(const std::vector<double> &run, const std::vector<double> &expected) {
    EXPECT_LE(expected.size(), run.size() + 1);
    return post::relative_rms(run, expected, 0, std::min(run.size(), expected.size()));
  }
  static bool second() { return std::get<1>(GetParam()) == "second"; }
};

TEST_P(DrivenChain, FollowsTheExactSolutionOverStepsRampsAndARandomField) {
  std::vector<double> counts, errors; // of each number of steps, over all scenes
  for (const int steps_per_cycle : {500, 1000, 2000, 4000}) {
    if (!second() && steps_per_cycle != 2000) continue;
    double squares = 0;
    for (const Drive &drive : {steps, onto_stiff_soil, ramps, random_field()})
      for (const post::Transition transition : {post::Transition::A, post::Transition::B}) {
        SCOPED_TRACE(drive.name + post::transition_name(transition));
        const post::ChainHistory expected = exact(drive, transition);
        const Scratch folder;
        well(run_chain_over(drive, steps_per_cycle, folder,
                            {{"transition", post::transition_name(transition)}}));
        const post::ChainHistory run = post::read_chain(folder / "chain.csv");
        ASSERT_TRUE(run.has(post::ColumnGroup::way));
        EXPECT_LT(error(run.s, expected.s), 1e-12);
        EXPECT_EQ(std::vector<double>(run.pass.begin(), run.pass.begin() + 20),
                  std::vector<double>(expected.pass.begin(), expected.pass.begin() + 20));
        const double one = error(run.v_drum, expected.v_drum);
        if (steps_per_cycle == 2000) {
          EXPECT_LT(one, second() ? 1e-5 : 1e-2);
        }
        squares += one * one;
      }
    counts.push_back(steps_per_cycle);
    errors.push_back(std::sqrt(squares));
  }
  // Those of single scenes scatter with the phases of makes and breaks in the time steps.
  if (second()) {
    EXPECT_LT(fitted_order(counts, errors), -1.9);
  }
}

TEST_P(DrivenChain, IsOverUniformSoilTheChainThatStands) {
  const Drive uniform{"uniform", {{-2, 4e7, 0.3}, {5, 4e7, 0.3}, {7, 4e7, 0.3}}, 20, 2};
  const Scratch driven, standing;
  well(run_chain_over(uniform, 500, driven));
  well(run_deck(chain_deck(std::get<0>(GetParam()) == "lammps" ? "in.chain.lammps" : "in.chain"),
                {{"k", "4e7"},
                 {"D", "0.3"},
                 {"cycles", "18"},
                 {"steps_per_cycle", "500"},
                 {"samples_per_cycle", std::to_string(samples)},
                 {"stepping", std::get<1>(GetParam())}},
                standing.path()));
  const post::ChainHistory one = post::read_chain(driven / "chain.csv"),
                           two = post::read_chain(standing / "chain.csv");
  EXPECT_EQ(one.size(), two.size());
  EXPECT_LT(relative_difference(one.v_drum, two.v_drum), 1e-9);
  EXPECT_LT(relative_difference(one.F_contact, two.F_contact), 1e-9);
  EXPECT_FALSE(two.has(post::ColumnGroup::way));
  // The report does not compare a chain that drives with the solution of one that stands.
  well(run_program({DRUMLIN_TOOLS, "report", driven.path().string(), "--out", (driven / "report").string()},
                   {}, driven.path()));
  std::string pages;
  for (const auto &entry : fs::recursive_directory_iterator(driven / "report"))
    if (entry.path().extension() == ".html") pages += read_text(entry.path());
  EXPECT_TRUE(contains(pages, "the roller drives"));
}

TEST_P(DrivenChain, BalancesItsEnergyWithTheWorkOfTheDrive) {
  for (const Drive &drive : {steps, onto_stiff_soil, ramps}) {
    const Scratch folder;
    well(run_chain_over(drive, 4000, folder));
    const post::Table cycles = post::read_table(folder / "cycles.csv");
    const auto column = [&](const char *name) { return cycles.numbers(name); };
    std::vector<double> change(cycles.rows());
    for (const char *name :
         {"kinetic", "potential", "stored_contact", "stored_bond", "dissipated_contact", "dissipated_bond"}) {
      const std::vector<double> values = column(name);
      for (std::size_t n = 0; n < change.size(); ++n)
        change[n] += values[n] - values[0];
    }
    double worst = 0, most = 0, drives = 0;
    for (std::size_t n = 0; n < change.size(); ++n) {
      worst = std::max(worst, std::fabs(change[n] - column("work_excitation")[n] - column("work_travel")[n]));
      most = std::max(most, std::fabs(column("work_excitation")[n]));
      drives = std::max(drives, std::fabs(column("work_travel")[n]));
    }
    EXPECT_LT(worst, 1e-3 * most) << drive.name;
    if (second()) {
      EXPECT_LT(worst, 2e-2 * drives) << drive.name;
    }
  }
}

// Nothing else acts on the chain along the way: the work of the drive is what the changes of the soil take,
// the integral of d^2 / 2 over k, here by the overlaps of chain.csv and the way as it is written below.
TEST(DrivenChainInLiggghts, CountsTheWorkOfTheSoilsChanges) {
  const Scratch folder;
  std::ofstream(folder / "way.csv") << post::way_text(
      {{0, 40e6, 0.2}, {0.3, 40e6, 0.2}, {0.3, 80e6, 0.2}, {0.7, 120e6, 0.2}});
  const auto stiffness = [](double s) { return s < 0.3 ? 40e6 : 80e6 + (s - 0.3) / 0.4 * 40e6; };
  well(run_deck(test_deck("way_work.in"),
                {{"here", (fs::path(DRUMLIN_SOURCE_DIR) / "inputs/chain").string()},
                 {"way", (folder / "way.csv").string()},
                 {"speed", "1"},
                 {"stepping", "second"},
                 {"steps_per_cycle", "2000"},
                 {"samples_per_cycle", "2000"},
                 {"out", folder.path().string()}},
                folder.path()));
  const post::ChainHistory run = post::read_chain(folder / "chain.csv");
  double expected = 0;
  for (std::size_t i = 1; i < run.s.size(); ++i) {
    const double overlap = std::max(0.0, -0.5 * (run.x_drum[i - 1] + run.x_drum[i]));
    expected += 0.5 * overlap * overlap * (stiffness(run.s[i]) - stiffness(run.s[i - 1]));
  }
  const double work = post::read_table(folder / "work.csv").numbers("work").front();
  EXPECT_GT(expected, 1.0);
  EXPECT_NEAR(work, expected, 1e-2 * expected);
  const double drive = post::read_table(folder / "cycles.csv").numbers("work_travel").back();
  EXPECT_NEAR(work, drive, 1e-9 * drive);
}

/// A drum that rolls over a row of balls (travel.scene) whose contacts with it change along the way.
class DrumOnChangingSoil : public BothEngines {
protected:
  static Variables variables() {
    return {{"words", "from 0 to 0.5 speed 1 ramp 0.1 passes 2 rotation towed"},
            {"row", "1"},
            {"with_way", "1"},
            {"way", test_deck("travel.way.csv").string()}};
  }
};

TEST_P(DrumOnChangingSoil, BalancesItsEnergyWithTheWorkOfTheDrive) {
  std::vector<double> counts, errors;
  const bool second = std::get<1>(GetParam()) == "second";
  for (const double dt : second ? std::vector{1e-4, 2e-4, 0.5e-4} : std::vector{1e-4}) {
    const Scratch folder;
    well(run("travel", folder,
             with(variables(), {{"dt", number(dt)},
                                {"steps", std::to_string(std::lround(1.2 / dt))},
                                {"every", std::to_string(std::lround(2e-3 / dt))}})));
    const post::Table rows = post::read_table(folder / "travel.csv");
    const auto of = [&rows](const char *column) { return rows.numbers(column); };
    const std::vector<double> work = of("work"), torque_work = of("torque_work"), kinetic = of("kinetic"),
                              springs = of("springs"), heat = of("heat"), height = of("height");
    double worst = 0, most = 0;
    const auto balance = [&](std::size_t n) {
      return kinetic[n] + springs[n] + heat[n] + 10 * 9.81 * height[n] - work[n] - torque_work[n];
    };
    for (std::size_t n = 0; n < rows.rows(); ++n) {
      worst = std::max(worst, std::fabs(balance(n) - balance(0)));
      most = std::max(most, std::fabs(work[n]));
    }
    counts.push_back(1 / dt);
    errors.push_back(worst / most);
  }
  EXPECT_LT(errors[0], 1e-3);
  if (second) {
    EXPECT_LT(fitted_order(counts, errors), -1.7) << errors[0] << ' ' << errors[1] << ' ' << errors[2];
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, DrumOnChangingSoil, engines_and_steppings(), engine_and_stepping);
INSTANTIATE_TEST_SUITE_P(Engines, DrivenChain, engines_and_steppings(), engine_and_stepping);

} // namespace
} // namespace drumlin::test
