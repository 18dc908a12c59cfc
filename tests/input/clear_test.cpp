// The command clear: a deck that loops over a parameter does what a run for each value does.

#include "host.h"

#include <gtest/gtest.h>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

class ClearCommand : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Engine, ClearCommand, ::testing::Values("in", "lammps"),
                         [](const auto &test) { return test.param == "in" ? "liggghts" : "lammps"; });

TEST_P(ClearCommand, LeavesADeckThatLoopsItsRuns) {
  if (GetParam() == "lammps" && !post::has_lammps())
    GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  const fs::path deck = fs::path(DRUMLIN_SOURCE_DIR) / ("tests/input/clear." + GetParam());
  const std::vector<std::string> values = {"0.2", "0.5"};
  for (const int ranks : {1, 2}) {
    const Scratch loop;
    const Outcome outcome = run_deck(deck, {{"deck", deck.string()}}, loop.path(), ranks);
    ASSERT_TRUE(outcome.ok()) << outcome.output;
    for (const std::string &D : values) {
      const Scratch alone;
      const Outcome once = run_deck(deck, {{"deck", deck.string()}, {"D", D}}, alone.path(), ranks);
      ASSERT_TRUE(once.ok()) << once.output;
      for (const std::string &name : {"state_" + D + ".txt", "events_" + D + ".csv"})
        EXPECT_EQ(read_text(loop / name), read_text(alone / name)) << name << ", ranks " << ranks;
    }
    EXPECT_NE(read_text(loop / "state_0.2.txt"), read_text(loop / "state_0.5.txt"));
  }
}

} // namespace
} // namespace drumlin::test
