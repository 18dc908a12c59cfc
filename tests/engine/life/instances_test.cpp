// Engine instances of one process, and signals that end them.
#include "tests/support/checks.h"
#include "tests/support/host_deck.h"

#include "engine/engine_command.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

namespace drumlin::test {
namespace {

// Engine instances of one process: after the command clear, one after the other, side by side; and that the
// plugin keeps no state for the process.
namespace instances {

namespace fs = std::filesystem;

class ClearCommand : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Engine, ClearCommand, ::testing::Values("in", "lammps"),
                         [](const auto &test) { return test.param == "in" ? "liggghts" : "lammps"; });

TEST_P(ClearCommand, LeavesADeckThatLoopsItsRuns) {
  if (GetParam() == "lammps" && !post::has_lammps())
    GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  const fs::path deck = fs::path(DRUMLIN_SOURCE_DIR) / ("tests/engine/life/clear." + GetParam());
  const std::vector<std::string> values = {"0.2", "0.5"};
  for (const int ranks : {1, 2}) {
    const Scratch loop;
    well(run_deck(deck, {{"deck", deck.string()}}, loop.path(), ranks));
    for (const std::string &D : values) {
      const Scratch alone;
      well(run_deck(deck, {{"deck", deck.string()}, {"D", D}}, alone.path(), ranks));
      for (const std::string &name : {"state_" + D + ".txt", "events_" + D + ".csv"})
        EXPECT_EQ(read_text(loop / name), read_text(alone / name)) << name << ", ranks " << ranks;
    }
    EXPECT_NE(read_text(loop / "state_0.2.txt"), read_text(loop / "state_0.5.txt"));
  }
}

/// Runs scenes in LAMMPS instances of one process: with walls, a clump, a bond and all contact observers. The
/// two differ in their laws, so that the results change if one uses anything of the other.
Outcome run_instances(const Scratch &folder, const std::string &how) {
  const auto scene = [&](const std::string &name, const std::string &law, const std::string &lines) {
    write_text(folder / (name + ".lines"),
               "pair_style gran/" + law + "\nfix gravity all gravity 9.81 vector 0 0 -1\n" + lines +
                   "fix integrate all nve/sphere\nfix events all contact/events file ${instance}.events\n"
                   "fix history drum roller/history file ${instance}.history every 50\n"
                   "fix contacts all contact/local every 50\n"
                   "dump contacts all local 50 ${instance}.contacts f_contacts[*]\n"
                   "dump state all custom 50 ${instance}.state id x y z vx vy vz fx fy fz\n"
                   "dump_modify state sort id\ntimestep 1e-4\nvelocity drum set 0.1 0 -1\n");
  };
  scene("first", "hooke/transition tangential history transition A",
        "pair_coeff * * 1e7 0.5 0.3\nfix wall all wall/gran/transition 1 zplane -0.99 NULL\n"
        "fix body drum clump\nfix guard all guard links 7\n");
  scene("second", "hertz/transition stepping stock tangential off transition B",
        "pair_coeff * * 2e8 0.3 1.5\nfix side all wall/gran/transition 1 zplane -0.995 NULL\n"
        "fix bond all bond/spring 1 2 1e4 10\nfix guard all guard links 3\n");
  const fs::path library = fs::path(LAMMPS_PROGRAM).parent_path() / "liblammps.so.0";
  return run_program({TWO_INSTANCES_PROGRAM, library.string(), DRUMLIN_LAMMPS_PLUGIN,
                      std::string(DRUMLIN_SOURCE_DIR) + "/tests/support/host.lammps", how},
                     mpi_environment(folder.path()), folder.path(), 600.0);
}

TEST(TwoLammpsInstances, EachGivesWhatItGivesAlone) {
  if (!post::has_lammps()) GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  const Scratch alone;
  for (const char *name : {"first", "second"})
    well(run_instances(alone, name));
  for (const char *how : {"after", "in_turns"}) {
    const Scratch together;
    well(run_instances(together, how));
    for (const std::string name : {"first", "second"})
      for (const char *kind : {".events", ".history", ".contacts", ".state"}) {
        const std::string text = read_text(alone / (name + kind));
        EXPECT_GT(std::count(text.begin(), text.end(), '\n'), 1) << name << kind;
        EXPECT_EQ(read_text(together / (name + kind)), text) << how << ", " << name << kind;
      }
  }
}

/// The names of what a library has in writable memory, of the plugin's own namespaces and without what the
/// compiler makes of classes.
std::set<std::string> writable_names(const fs::path &library) {
  const Scratch folder;
  const Outcome listed =
      well(run_program({"nm", "-C", "--defined-only", library.string()}, {}, folder.path()));
  const auto holds = [](const std::string &name, const char *word) {
    return name.find(word) != std::string::npos;
  };
  std::istringstream lines(listed.output);
  std::set<std::string> names;
  std::string address, kind, name;
  while (lines >> address >> kind && std::getline(lines >> std::ws, name)) {
    const bool own = holds(name, "drumlin::") || holds(name, "(anonymous");
    const bool of_a_class = holds(name, "vtable") || holds(name, "typeinfo") || holds(name, "VTT for");
    if (own && !of_a_class && !holds(name, "guard variable") && holds("bBdD", kind.c_str()))
      names.insert(name.substr(name.rfind("::") + 2));
  }
  return names;
}

// Signals and the files to restore at exit() belong to the process; the other names are of constants.
TEST(PluginLibraries, KeepNoStateForTheProcess) {
  const std::set<std::string> allowed = {"signals", "sets",           "drop_in_forms", "history_id",
                                         "name",    "placeholder_id", "other_fixes",   "remembered_numbers"};
  for (const char *engine : {"liggghts", "lammps"}) {
    if (std::string(engine) == "lammps" && !post::has_lammps()) continue;
    const std::set<std::string> names = writable_names(fs::path(post::plugin_library()).parent_path() /
                                                       (std::string("libdrumlin-") + engine + ".so"));
    EXPECT_EQ(names.count("signals"), 1u) << engine << ": nothing was read";
    for (const std::string &name : names)
      EXPECT_EQ(allowed.count(name), 1u) << engine << ": " << name;
  }
}

} // namespace instances

// Signals that meet a run outside of the plugin's own commands, and Ctrl-C inside. (A SIGTERM inside is
// tested with the decks.)
namespace signals {

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

} // namespace signals

} // namespace
} // namespace drumlin::test
