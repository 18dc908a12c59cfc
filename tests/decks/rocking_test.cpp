// Drum and frame that tilt, in.rocking in both engines, against the exact solution: unequal halves that lose
// contact at both ends, equal ones against in.chain, free rocking against its frequency; energy, restarts and
// ranks.
#include "tests/support/engine_runs.h"
#include "chain/analysis.h"
#include "chain/two_ends.h"
#include "files/roller.h"

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

using post::ChainHistory;
using post::Transition;

constexpr int cycles = 10, samples = 100;
/// Exciter, bonds and dashpots beside the middle: everything couples with the tilt.
/// A folder with the files of machine and soil, and a run of in.rocking with them.
class RockingRun {
public:
  explicit RockingRun(const std::string &of_machine = read_text(test_deck("rocking.machine")),
                      const std::string &of_soil = read_text(test_deck("rocking.soil"))) {
    std::ofstream(folder_ / "machine") << of_machine;
    std::ofstream(folder_ / "soil") << of_soil;
  }

  Variables files() const {
    return given("roller {}, contacts {}", (folder_ / "machine").string(), (folder_ / "soil").string());
  }
  /// The first value of a variable counts.
  Variables variables(const Variables &more) const {
    Variables all = more;
    for (const Variables &some :
         {files(), given("tilt 1e-4, cycles {}, samples_per_cycle {}", cycles, samples)})
      all.insert(all.end(), some.begin(), some.end());
    return all;
  }
  ChainRun run(const Variables &more, const std::string &deck = "in.rocking", int ranks = 1) const {
    well(run_deck(chain_deck(deck), variables(more), folder_.path(), ranks));
    return read_run(folder_.path());
  }
  post::TwoEnds direct(Transition transition) const {
    const std::string file = (folder_ / "machine").string();
    const Roller roller = read_roller(roller_text(file), file);
    post::ChainParameters p;
    p.m2 = roller.m2;
    p.m3 = roller.m3;
    p.k23 = roller.k23;
    p.c23 = roller.c23;
    p.omega = 2.0 * pi * roller.settings[0].frequency;
    p.Fw = roller.settings[0].me_re * p.omega * p.omega;
    p.transition = transition;
    post::TwoEnds ends = post::two_ends(p, roller);
    ends.contacts = read_contacts((folder_ / "soil").string(), *roller.width);
    ends.tilt = 1e-4;
    return ends;
  }
  fs::path operator/(const std::string &name) const { return folder_ / name; }
  const Scratch &folder() const { return folder_; }

private:
  Scratch folder_;
};

using Column = std::vector<double> ChainHistory::*;
constexpr Column ends_columns[] = {
    &ChainHistory::x_drum,     &ChainHistory::v_drum,      &ChainHistory::x_frame, &ChainHistory::theta_drum,
    &ChainHistory::omega_drum, &ChainHistory::theta_frame, &ChainHistory::F_bond,  &ChainHistory::omega_frame,
    &ChainHistory::F_left,     &ChainHistory::F_right,     &ChainHistory::a_left,  &ChainHistory::a_right};

class Rocking : public ::testing::TestWithParam<Transition> {};

// The exact motion, and the order of the error: it varies with the places of the events within the steps, so
// that it is fitted over six time steps. The drum leaves the soil at both ends.
TEST_P(Rocking, FollowsTheDirectSolver) {
  const RockingRun rocking;
  post::ExactOptions options;
  options.cycles = cycles;
  options.samples_per_cycle = samples;
  const post::TwoEndsResult exact = post::solve_two_ends(rocking.direct(GetParam()), options);
  std::set<long> broken;
  for (const post::ContactEvent &event : exact.events)
    if (!event.make) broken.insert(event.id_j);
  ASSERT_EQ(broken, (std::set<long>{2, 3, 4, 5})) << "each of the four contacts is lost";
  const std::vector<double> steps = {500, 1000, 2000, 4000, 8000, 16000};
  std::vector<std::vector<double>> errors(std::size(ends_columns));
  for (const double count : steps) {
    const ChainRun run =
        rocking.run(given("steps_per_cycle {}, transition {}", count, post::transition_name(GetParam())));
    ASSERT_EQ(run.history.size(), exact.history.size());
    for (std::size_t n = 0; n < errors.size(); ++n)
      errors[n].push_back(post::relative_rms(run.history.*ends_columns[n], exact.history.*ends_columns[n], 0,
                                             exact.history.size()));
    if (count < 2000) continue;
    ASSERT_EQ(run.events.size(), exact.events.size());
    for (std::size_t n = 0; n < exact.events.size(); ++n) {
      EXPECT_NEAR(run.events[n].time, exact.events[n].time, 1e-6) << n;
      EXPECT_EQ(run.events[n].id_i, exact.events[n].id_j - 1) << n; // ball j of the soil
    }
  }
  for (std::size_t n = 0; n < errors.size(); ++n) {
    EXPECT_LT(errors[n][2], 1e-5) << n;
    EXPECT_LT(fitted_order(steps, errors[n]), -1.9) << n;
  }
}

// Work, energies and heat of cycles.csv: the heat of the rotating bodies' links and their kinetic energy.
TEST_P(Rocking, KeepsItsEnergyBalance) {
  const RockingRun rocking;
  rocking.run(given("steps_per_cycle 2000, transition {}", post::transition_name(GetParam())));
  const post::CycleColumns table = post::read_cycle_columns(rocking / "cycles.csv");
  const auto of = [&](std::size_t row, const char *name) { return table.at(name)[row]; };
  const auto sum = [&](std::size_t row) {
    return of(row, "kinetic") + of(row, "potential") + of(row, "stored_contact") + of(row, "stored_bond") +
           of(row, "dissipated_contact") + of(row, "dissipated_bond") - of(row, "work_excitation");
  };
  const double work = of(table.rows - 1, "work_excitation");
  ASSERT_GT(work, 1e3);
  for (std::size_t row = 1; row < table.rows; ++row)
    EXPECT_NEAR(sum(row), sum(0), 1e-6 * work) << row;
}

INSTANTIATE_TEST_SUITE_P(Transitions, Rocking, ::testing::Values(Transition::A, Transition::B),
                         [](const auto &test) { return post::transition_name(test.param); });

/// A symmetric machine; springs and dashpots of its bond are at the same places.
constexpr const char *symmetric = "drum_mass 4 t\nframe_mass 3 t\nwidth 2 m\nbond_stiffness 3 MN/m\n"
                                  "bond_damping 30 kN s/m\nfrequency 30 Hz\nforce 250 kN\n";

TEST(RockingHalves, AreTheChainIfTheyAreEqual) {
  const RockingRun rocking(symmetric);
  for (const std::string stepping : {"second", "stock"})
    for (const std::string transition : {"A", "B"}) {
      const Variables common = given(
          "roller {}, k 3e7, D 0.2, transition {}, tilt 0, cycles 8, stepping {}, samples_per_cycle 100",
          (rocking / "machine").string(), transition, stepping);
      Variables chain = common;
      chain.erase(chain.begin() + 4);
      const Scratch scratch;
      well(run_deck(chain_deck("in.chain"), chain, scratch.path()));
      const ChainHistory single = read_run(scratch.path()).history;
      for (const std::string contacts : {"1", "2", "5", "32"}) {
        SCOPED_TRACE(testing::Message() << stepping << " " << transition << " " << contacts);
        Variables ends = common;
        ends.emplace_back("contacts", contacts);
        const ChainHistory halves = rocking.run(ends).history;
        for (const Column column :
             {&ChainHistory::x_drum, &ChainHistory::v_drum, &ChainHistory::a_drum, &ChainHistory::x_frame,
              &ChainHistory::v_frame, &ChainHistory::F_contact, &ChainHistory::F_bond})
          EXPECT_LT(relative_difference(halves.*column, single.*column), 1e-10);
        for (std::size_t n = 0; n < halves.size(); ++n) {
          EXPECT_NEAR(halves.theta_drum[n], 0, 1e-12);
          EXPECT_NEAR(halves.F_left[n], halves.F_right[n], 1e-6);
        }
      }
    }
}

// Two springs k/2 at +-b, pressed by the weight, without excitation and, but for a frame of hardly any mass,
// without bonds: theta = tilt cos(w t) with w = sqrt(k b^2 / I).
TEST(RockingFreely, HasTheFrequencyOfTwoSprings) {
  constexpr double k = 20e6, b = 0.7, inertia = 1800, tilt = 1e-4;
  const double w = b * std::sqrt(k / inertia);
  const RockingRun rocking("drum_mass 4 t\nframe_mass 0.001 kg\nwidth 2 m\ndrum_inertia 1800 kg m2\n"
                           "frame_inertia 0.0005 kg m2\nbond_stiffness 1 N/m\nbond_damping 0 N s/m\n"
                           "frequency 10 Hz\nforce 1 N\n",
                           "y (m),k (N/m),c (N s/m)\n-0.7,10e6,0\n0.7,10e6,0\n");
  std::vector<double> errors;
  const std::vector<double> steps = {500, 1000, 2000};
  for (const double count : steps) {
    const ChainHistory h = rocking.run(given("steps_per_cycle {}, Fw 0, tilt {}", count, tilt)).history;
    double error = 0.0;
    for (std::size_t n = 0; n < h.size(); ++n) {
      error = std::max(error, std::fabs(h.theta_drum[n] / tilt - std::cos(w * h.time[n])));
      EXPECT_NEAR(h.x_drum[n], h.x_drum[0], 1e-9);
      EXPECT_NEAR(h.a_right[n] - h.a_left[n], -2 * w * w * h.theta_drum[n], 1e-3 * w * w * tilt);
    }
    errors.push_back(error);
  }
  EXPECT_LT(errors.back(), 1e-3);
  EXPECT_NEAR(fitted_order(steps, errors), -2, 0.1);
}

// The files of a run are all that ./drumlin meter needs: from both ends it has the soil below each half,
// which are the contacts of the deck where none is lost.
TEST(RockingMeters, TellTheSoilBelowEachHalf) {
  const std::string place = number(2.13 / std::sqrt(12.0));
  const RockingRun rocking(post::read_text(chain_deck("in.chain").parent_path() / "../rollers/Axas2020"),
                           "y (m),k (N/m),c (N s/m)\n-" + place + ",9e6,58508\n" + place + ",6e6,39006\n");
  rocking.run({{"cycles", "60"}});
  const Outcome meter = well(run_program(tool_words("meter . --out values"), {}, rocking.folder().path()));
  EXPECT_TRUE(meter.says("Both together: 9 MN/m below the left half, 6 MN/m below the right one"))
      << meter.output;
}

} // namespace
} // namespace drumlin::test
