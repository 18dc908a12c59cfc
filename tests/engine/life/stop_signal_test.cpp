// Signals that meet a run outside of the plugin's own commands, and Ctrl-C inside. (A SIGTERM inside is
// tested with the decks.)

#include "engine/engine_command.h"

#include "tests/support/checks.h"
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

/// The host deck of an engine, ended by Ctrl-C's signal in the middle of its run.
Outcome run_until_interrupted(const std::string &deck, const std::vector<std::string> &more,
                              const Scratch &folder) {
  std::vector<std::string> arguments = {"-log", "none"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const post::EngineCommand command =
      post::engine_command(std::string(DRUMLIN_SOURCE_DIR) + "/tests/support/" + deck, arguments, 1);
  post::Program program;
  program.words = command.words;
  program.environment = mpi_environment(folder.path());
  program.environment.insert(program.environment.end(), command.environment.begin(),
                             command.environment.end());
  program.folder = folder.path();
  program.output = folder / post::program_output_file;
  program.limit = 600.0;
  program.stop_signal = SIGINT;
  program.stop_when = after_processor_time(1.0);
  return run_program(program);
}

Outcome lammps_until_interrupted(const std::string &lines, const Scratch &folder) {
  write_text(folder / "lines", "pair_style gran/hooke/transition\npair_coeff * * 1e7 0.5\n"
                               "fix integrate all nve/sphere\n" +
                                   lines);
  return run_until_interrupted("host.lammps", {"-var", "lines", (folder / "lines").string()}, folder);
}

TEST(Signal, EndsDrumlinRunWithOneLineAndRunAsTheEngineHasItInLammps) {
  if (!post::has_lammps()) GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  const Scratch inside, after;
  const Outcome stopped = lammps_until_interrupted("drumlin/run 2000000000\n", inside);
  EXPECT_TRUE(fails_with(stopped, "ERROR: drumlin/run: stopped by a signal at step "));
  EXPECT_EQ(errors_in(stopped.output), 1) << stopped.output;
  EXPECT_EQ(lammps_until_interrupted(std::string("drumlin/run 100\n") + for_ever, after).status, 130);
}

TEST(Signal, EndsRunWithOneLineInLiggghts) {
  const Scratch folder;
  write_text(folder / "pair", host_pair_style() + host_properties());
  write_text(folder / "lines", for_ever);
  const Outcome stopped = run_until_interrupted("in.host", {}, folder);
  EXPECT_TRUE(fails_with(stopped, ": stopped by a signal before the end of the deck"));
  EXPECT_EQ(errors_in(stopped.output), 1) << stopped.output;
}

} // namespace
} // namespace drumlin::test
