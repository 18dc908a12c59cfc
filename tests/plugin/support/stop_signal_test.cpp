// Signals that meet a run outside of the plugin's own commands, and Ctrl-C inside. (A SIGTERM inside is tested with the decks.)

#include "tests/support/host_deck.h"

#include <gtest/gtest.h>

namespace drumlin::test {
namespace {

constexpr const char *for_ever = "run 2000000000\n";

int errors_in(const std::string &output) {
  int errors = 0;
  for (const std::string &line : lines_of(output))
    errors += line.find("ERROR") != std::string::npos ? 1 : 0;
  return errors;
}

/// LAMMPS with the host deck, ended by a signal after 2 s.
Outcome lammps_until(const std::string &signal, const std::string &lines, const Scratch &folder) {
  write_text(folder / "lines", "pair_style gran/hooke/transition\npair_coeff * * 1e7 0.5\n"
                               "fix integrate all nve/sphere\n" +
                                   lines);
  return run_program({"timeout", "--preserve-status", "-s", signal, "2", LAMMPS_PROGRAM, "-in",
                      std::string(DRUMLIN_SOURCE_DIR) + "/tests/support/host.lammps", "-log", "none", "-var",
                      "plugin", DRUMLIN_LAMMPS_PLUGIN, "-var", "lines", (folder / "lines").string()},
                     mpi_environment(folder.path()), folder.path(), 20.0);
}

TEST(Signal, EndsDrumlinRunWithOneLineAndRunAsTheEngineHasItInLammps) {
  if (!post::has_lammps()) GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  const Scratch inside, after;
  const Outcome stopped = lammps_until("INT", "drumlin/run 2000000000\n", inside);
  EXPECT_EQ(stopped.status, 1);
  EXPECT_TRUE(stopped.says("ERROR: drumlin/run: stopped by a signal at step ")) << stopped.output;
  EXPECT_EQ(errors_in(stopped.output), 1) << stopped.output;
  EXPECT_EQ(lammps_until("INT", std::string("drumlin/run 100\n") + for_ever, after).status, 130);
}

TEST(Signal, EndsRunWithOneLineInLiggghts) {
  const Scratch folder;
  write_text(folder / "pair", host_pair_style() + host_properties());
  write_text(folder / "lines", for_ever);
  const Outcome stopped = run_program(
      {"timeout", "--preserve-status", "-s", "INT", "2", "liggghts", "-in",
       std::string(DRUMLIN_SOURCE_DIR) + "/tests/support/in.host", "-log", "none"},
      [&] {
        std::vector<std::string> environment = mpi_environment(folder.path());
        environment.push_back("LD_PRELOAD=" + plugin_library());
        return environment;
      }(),
      folder.path(), 20.0);
  EXPECT_EQ(stopped.status, 1);
  EXPECT_TRUE(stopped.says(": stopped by a signal before the end of the deck")) << stopped.output;
  EXPECT_EQ(errors_in(stopped.output), 1) << stopped.output;
}

} // namespace
} // namespace drumlin::test
