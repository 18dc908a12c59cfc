// The command clear: a deck that loops over a parameter does what a run for each value does.

#include "tests/support/host_deck.h"

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
  const fs::path deck = fs::path(DRUMLIN_SOURCE_DIR) / ("tests/plugin/liggghts/clear." + GetParam());
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

/// Runs a scene in two LAMMPS instances of one process.
Outcome run_two_instances(const Scratch &folder, const std::string &how) {
  write_text(folder / "lines",
             "pair_style gran/hooke/transition tangential history\npair_coeff * * 1e7 0.5 0.3\n"
             "fix gravity all gravity 9.81 vector 0 0 -1\n"
             "fix wall all wall/gran/transition 1 zplane -0.99 NULL\nfix body drum clump\n"
             "fix integrate all nve/sphere\nfix guard all guard\n"
             "dump state all custom 100 ${instance}.txt id z vz\nrun 300\n");
  const fs::path library = fs::path(LAMMPS_PROGRAM).parent_path() / "liblammps.so.0";
  return run_program({TWO_INSTANCES_PROGRAM, library.string(), DRUMLIN_LAMMPS_PLUGIN,
                      std::string(DRUMLIN_SOURCE_DIR) + "/tests/support/host.lammps",
                      (folder / "lines").string(), how},
                     mpi_environment(folder.path()), folder.path(), 20.0);
}

TEST(TwoLammpsInstances, GiveOneResultOneAfterTheOtherAndAreRefusedSideBySide) {
  if (!post::has_lammps()) GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  const Scratch after, beside;
  const Outcome both = run_two_instances(after, "after");
  ASSERT_TRUE(both.ok()) << both.output;
  EXPECT_EQ(read_text(after / "first.txt"), read_text(after / "second.txt"));
  const Outcome refused = run_two_instances(beside, "beside");
  EXPECT_EQ(refused.status, 1) << refused.output;
  EXPECT_TRUE(refused.says("ERROR: plugin load: drumlin is loaded in another LAMMPS instance"))
      << refused.output;
}

} // namespace
} // namespace drumlin::test
