// A run that leaves the process in the middle of a cycle and continues from its restart file must write the
// same files, byte for byte, as a run without interruption.
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"
#include "tests/support/host_deck.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <string>

namespace drumlin::test {
namespace {

using post::ChainParameters;
using post::Transition;

void expect_same_files(const std::string &name, Transition transition, const std::string &stepping,
                       int ranks) {
  const ChainParameters p = post::table1_case(name, transition);
  constexpr int steps_per_cycle = 400, cycles = 5, before = 133, after = 3467; // fourteen cycles
  const Scratch stayed, left;
  const auto chain = [&](const Scratch &scratch) {
    const std::string decks = chain_with_bottom(scratch.path(), -3.5).string(); // 2 ranks: soil | drum, frame
    return Variables{{"case", name},
                     {"transition", post::transition_name(transition)},
                     {"stepping", stepping},
                     {"steps_per_cycle", std::to_string(steps_per_cycle)},
                     {"cycles", std::to_string(cycles)},
                     {"before", std::to_string(before)},
                     {"after", std::to_string(after)},
                     {"here", decks},
                     {"chain", decks},
                     {"tests", test_deck("split.in").parent_path().string()}};
  };
  well(run_deck(test_deck("split.in"), chain(stayed), stayed.path(), ranks));
  well(run_deck(test_deck("stop.in"), chain(left), left.path(), ranks));
  const std::size_t rows_before = post::read_chain(left / "chain.csv").size();
  const std::size_t events_before = post::read_events(left / "events.csv").size();
  well(run_deck(test_deck("resume.in"),
                {{"transition", post::transition_name(transition)},
                 {"stepping", stepping},
                 {"k", number(p.k)},
                 {"D", number(p.D)},
                 {"omega", number(p.omega)},
                 {"steps_per_cycle", std::to_string(steps_per_cycle)},
                 {"after", std::to_string(after)}},
                left.path(), ranks));
  for (const char *file : {"chain.csv", "events.csv", "cycles.csv"})
    EXPECT_EQ(read_text(left / file), read_text(stayed / file)) << file;

  // There is something to compare: rows, cycles and events on both sides of the restart.
  EXPECT_EQ(rows_before, 200u * cycles + 1 + before / 2);
  EXPECT_EQ(post::read_chain(left / "chain.csv").size(), 200u * 14 + 1);
  EXPECT_EQ(post::read_table(left / "cycles.csv").rows(), 1 + 14u);
  EXPECT_GT(events_before, 3u);
  EXPECT_GT(post::read_events(left / "events.csv").size(), events_before + 3);
}

// Velocity or law changed between two runs: the force of the set-up is that of the present ones, not that of
// the step before.
TEST(ASetUp, TakesWhatTheDeckHasChangedBetweenTwoRuns) {
  const std::string softer = property("kn", "5e6");
  const struct {
    std::string lines;
    double k, c_of_rate;
  } changes[] = {{"velocity all set 0 0 0 units box", 1e7, 0.0},
                 {"unfix kn\n" + softer, 5e6, std::sqrt(2000 * 5e6)}, // c = 2 D sqrt(m k), D = 0.5
                 {"", 1e7, std::sqrt(2000 * 1e7)}};
  for (const auto &change : changes) {
    const Scratch folder;
    const std::string lines = "run 1500\n" + change.lines +
                              "\ncompute f drum reduce sum fz\nthermo_style custom step c_f\nrun 0\n"
                              "print \"force $(c_f) overlap $(0.75-xcm(drum,z)) rate $(-vcm(drum,z))\"";
    const Outcome run = run_host(host_pair_style() + host_properties(), lines, folder.path(), 1);
    std::smatch found;
    ASSERT_TRUE(std::regex_search(run.output, found,
                                  std::regex("\nforce ([0-9.e+-]+) overlap ([0-9.e+-]+) rate ([0-9.e+-]+)")))
        << run.output;
    const double force = std::stod(found[1]), d = std::stod(found[2]), rate = std::stod(found[3]);
    const double expected = change.k * d + change.c_of_rate * rate - 2000 * 9.81;
    EXPECT_NEAR(force, expected, 1e-6 * 2000 * 9.81) << change.lines;
  }
}

class Restart : public ::testing::TestWithParam<int> {};

TEST_P(Restart, ContinuesBitwiseDuringExcitation) {
  for (const char *stepping : {"second", "stock"}) {
    expect_same_files("II", Transition::B, stepping, GetParam());
    expect_same_files("III", Transition::A, stepping, GetParam());
  }
}

INSTANTIATE_TEST_SUITE_P(One, Restart, ::testing::Values(1));
INSTANTIATE_TEST_SUITE_P(Ranks, Restart, ::testing::Values(2));

} // namespace
} // namespace drumlin::test
