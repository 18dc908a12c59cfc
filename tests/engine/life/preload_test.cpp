// Loading the plugin, several engines in one process, output files and signals.
#include "tests/support/engine_runs.h"
#include "engine/engine_command.h"

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

// The library that is loaded into an engine, and into nothing else.

// The preloaded library in processes that it was not built for: an engine that it cannot extend is stopped
// with one clear line. (That other programs do not notice it is tested in
// tests/decks/other_programs_test.cpp.)
namespace preload {

/// The environment of a process with the library.
std::vector<std::string> preload(const fs::path &library, const Scratch &scratch) {
  std::vector<std::string> environment = mpi_environment(scratch.path());
  environment.push_back("LD_PRELOAD=" + library.string());
  return environment;
}

void expect_refusal(const Outcome &outcome, const std::vector<std::string> &says) {
  EXPECT_FALSE(outcome.timed_out);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_FALSE(outcome.says("the engine runs"));
  std::vector<std::string> errors;
  for (const std::string &line : lines_of(outcome.output))
    if (contains(line, "ERROR") && !contains(line, "PMIX ERROR")) // MPI may have its say on a busy machine
      errors.push_back(line);
  ASSERT_EQ(errors.size(), 1U) << outcome.output;
  EXPECT_EQ(errors.front().rfind("ERROR: drumlin ", 0), 0U) << errors.front();
  for (const std::string &words : says)
    EXPECT_TRUE(contains(errors.front(), words));
}

TEST(PreloadedStub, TheFakeEnginesRunWithoutIt) {
  const Scratch scratch;
  for (const char *program : {FAKE_LAMMPS_PROGRAM, FAKE_LIGGGHTS_PROGRAM, FAKE_ONE_PROGRAM}) {
    const Outcome outcome = well(run_program({program}, {}, scratch.path()));
    EXPECT_EQ(outcome.output, "the engine runs\n");
  }
}

TEST(PreloadedStub, RefusesLammps) {
  const Scratch scratch;
  expect_refusal(run_program({FAKE_LAMMPS_PROGRAM}, preload(plugin_library(), scratch), scratch.path()),
                 {"built for LIGGGHTS 3.8.0", "another engine (liblammps.so.0)", "take the preload away"});
}

TEST(PreloadedStub, RefusesAnotherLiggghts) {
  const Scratch scratch;
  expect_refusal(run_program({FAKE_LIGGGHTS_PROGRAM}, preload(plugin_library(), scratch), scratch.path()),
                 {"built for LIGGGHTS 3.8.0", "runs libliggghts.so.3.7.0",
                  "build drumlin against the installed version"});
}

TEST(PreloadedStub, TakesThePlaceOfAProgramThatExportsTheEngine) {
  const Scratch scratch;
  expect_refusal(run_program({FAKE_ONE_PROGRAM}, preload(plugin_library(), scratch), scratch.path()),
                 {"cannot load the plugin", "undefined symbol"});
}

TEST(PreloadedStub, SaysWhenThePluginIsNotInItsFolder) {
  const Scratch scratch;
  const fs::path alone = scratch / "libdrumlin.so";
  fs::copy_file(plugin_library(), alone);
  write_text(scratch / "in.empty", "units si\n");
  expect_refusal(run_program({"liggghts", "-in", "in.empty"}, preload(alone, scratch), scratch.path()),
                 {"cannot load the plugin", "libdrumlin-liggghts.so"});
  expect_refusal(
      run_program({"mpirun", "-np", "2", "-x", "LD_PRELOAD=" + alone.string(), "liggghts", "-in", "in.empty"},
                  mpi_environment(scratch.path()), scratch.path()),
      {"cannot load the plugin", "libdrumlin-liggghts.so"});
}

TEST(PreloadedStub, FollowsALinkToThePlugin) {
  const Scratch scratch;
  fs::create_symlink(plugin_library(), scratch / "link.so");
  write_text(scratch / "in.empty", "drumlin/check k 1 positive\n");
  well(run_program({"liggghts", "-in", "in.empty"}, preload(scratch / "link.so", scratch), scratch.path()));
}

TEST(PreloadedStub, LeavesADeckOfTheStockEngineAsItIs) {
  const Scratch scratch;
  write_text(scratch / "in.stock", "units si\nprint \"done\"\n");
  const Outcome outcome =
      well(run_program({"liggghts", "-in", "in.stock"}, preload(plugin_library(), scratch), scratch.path()));
  EXPECT_TRUE(printed(outcome, {"done", "plugin for LIGGGHTS 3.8.0"}));
}

std::vector<std::string> without_lines_of_mpi(const std::vector<std::string> &lines) {
  std::vector<std::string> others;
  bool of_mpi = false;
  for (const std::string &line : lines)
    if (line.rfind("-----", 0) == 0)
      of_mpi = !of_mpi;
    else if (!of_mpi)
      others.push_back(line);
  return others;
}

// An error is one line: neither the joke or tip that LIGGGHTS adds at random nor the text of MPI_Abort
// follows it. (The text of Open MPI 5 cannot be switched off; it is between two lines of dashes and is left
// out here.)
TEST(PreloadedStub, LeavesErrorsOneLine) {
  const Scratch scratch;
  write_text(scratch / "in.error", "units nowhere\n");
  const auto lines_of_error = [&](const std::string &libraries, const std::vector<std::string> &words) {
    std::vector<std::string> command = {"liggghts", "-log", "none"};
    command.insert(command.end(), words.begin(), words.end());
    std::vector<std::string> environment = mpi_environment(scratch.path());
    environment.push_back("LD_PRELOAD=" + libraries);
    const Outcome outcome = run_program(command, environment, scratch.path());
    EXPECT_EQ(outcome.status, 1);
    return lines_of(outcome.output);
  };
  const std::string with_plugin = plugin_library() + ":" RAND_RETURNS_ZERO;
  const bool silent = run_program({"mpirun", "--version"}, {}, scratch.path()).says("(Open MPI) 4.");
  for (const std::vector<std::string> &words : {std::vector<std::string>{"-in", "in.error", "-var"},
                                                {"-nonsense"},
                                                {"-in", "nowhere"},
                                                {"-in", "in.error", "-log", "/nowhere/log"}}) {
    const std::vector<std::string> lines = without_lines_of_mpi(lines_of_error(with_plugin, words));
    if (silent) {
      EXPECT_EQ(lines, lines_of_error(with_plugin, words)) << words.back();
    }
    ASSERT_EQ(lines.size(), 1U) << words.back() << lines.back();
    EXPECT_EQ(lines.front().rfind("ERROR", 0), 0U) << lines.front();
    EXPECT_GT(lines_of_error(RAND_RETURNS_ZERO, words).size(), 1U) << words.back();
  }
  EXPECT_EQ(lines_of_error(with_plugin, {"-in", "in.error"}).size(),
            3U); // the first two lines name engine and plugin
}

// A signal within the first malloc() behind the engine's handlers, at its start: they must not allocate.
TEST(PreloadedStub, EndsAnEngineThatASignalMeetsWhileItAllocates) {
  const Scratch scratch;
  write_text(scratch / "in.stock", "print \"not reached\"\n");
  const auto run = [&](const std::string &libraries) {
    std::vector<std::string> environment = mpi_environment(scratch.path());
    environment.push_back("LD_PRELOAD=" + libraries);
    return run_program({"liggghts", "-in", "in.stock"}, environment, scratch.path());
  };
  EXPECT_EQ(run(SIGNAL_IN_MALLOC).status, 99); // without the plugin the engine would hang
  const Outcome outcome = run(plugin_library() + ":" SIGNAL_IN_MALLOC);
  EXPECT_TRUE(fails_with(outcome, ": stopped by a signal before the end of the deck"));
  EXPECT_FALSE(outcome.says("not reached"));
}

TEST(PreloadedStub, WithoutItTheEngineDoesNotKnowTheCommands) {
  const Scratch scratch;
  write_text(scratch / "in.check", "drumlin/check k 1 positive\n");
  EXPECT_TRUE(fails_with(run_program({"liggghts", "-in", "in.check"}, {}, scratch.path()),
                         "Unknown command: drumlin/check"));
}

TEST(PreloadedStub, GivesADeckItsFolderAsHere) {
  const Scratch scratch;
  fs::create_directories(scratch.path() / "some where");
  write_text(scratch.path() / "some where" / "in.here", "print \"here is <${here}>\"\n");
  write_text(scratch / "in.here", "print \"here is <${here}>\"\n");
  const auto here = [&scratch](const std::vector<std::string> &words) {
    std::vector<std::string> command = {"liggghts"};
    command.insert(command.end(), words.begin(), words.end());
    for (const std::string &line :
         lines_of(run_program(command, preload(plugin_library(), scratch), scratch.path()).output))
      if (line.rfind("here is", 0) == 0) return line;
    return std::string("nothing");
  };
  EXPECT_EQ(here({"-in", "in.here"}), "here is <.>");
  EXPECT_EQ(here({"-in", "some where/in.here"}), "here is <some where>");
  EXPECT_EQ(here({"-i", "./some where/in.here"}), "here is <./some where>");
  EXPECT_EQ(here({"-in", "in.here", "-var", "here", "elsewhere"}), "here is <elsewhere>");
  // Of a link the folder of its target; of a path with blanks the one from the working directory, if it has
  // none.
  fs::create_directories(scratch.path() / "decks");
  write_text(scratch.path() / "decks" / "in.here", "print \"here is <${here}>\"\n");
  fs::create_symlink("decks/in.here", scratch.path() / "in.link");
  EXPECT_EQ(here({"-in", "in.link"}), "here is <" + fs::canonical(scratch.path() / "decks").string() + ">");
  const fs::path inside = scratch.path() / "some where";
  EXPECT_TRUE(printed(run_program({"liggghts", "-in", (inside / "in.here").string()},
                                  preload(plugin_library(), scratch), inside),
                      "here is <.>"));
}

TEST(PluginLoad, NamesThePackageThatIsMissing) {
  SKIP_WITHOUT_LAMMPS(true);
  const Scratch scratch;
  const std::vector<std::string> words = {FAKE_LAMMPS_PROGRAM, DRUMLIN_LAMMPS_PLUGIN};
  const Outcome other = run_program(words, {"FAKE_VERSION=1"}, scratch.path());
  const std::size_t number =
      other.output.find(" (20"); // built for LAMMPS 29 Sep 2021 (20210929), but this is 1
  ASSERT_NE(number, std::string::npos) << other.output;
  expect_refusal(run_program(words, {"FAKE_VERSION=" + other.output.substr(number + 2, 8)}, scratch.path()),
                 {"this LAMMPS has no package GRANULAR; allowed: one built with -DPKG_GRANULAR=ON"});
}

} // namespace preload

// The preloaded library prints in the engine's process and in no other.
namespace others {

TEST(Preload, LeavesOtherProgramsAlone) {
  const Scratch scratch;
  const std::string preload = "LD_PRELOAD=" + plugin_library();
  const Outcome echo = run_program({"/bin/echo", "untouched"}, {preload}, scratch.path());
  EXPECT_EQ(echo.status, 0);
  EXPECT_EQ(echo.output, "untouched\n");
  const std::vector<std::string> failing = {"/bin/ls",
                                            "no-such-file"}; // its text is not the same in every release
  const Outcome alone = run_program(failing, {"LC_ALL=C"}, scratch.path());
  const Outcome fails = run_program(failing, {preload, "LC_ALL=C"}, scratch.path());
  EXPECT_EQ(alone.status, 2);
  EXPECT_EQ(fails.status, 2);
  EXPECT_EQ(fails.output, alone.output);
  const Outcome child =
      run_program({"/bin/sh", "-c", "/bin/sh -c '/bin/echo grandchild; exit 3'"}, {preload}, scratch.path());
  EXPECT_EQ(child.status, 3);
  EXPECT_EQ(child.output, "grandchild\n");
}

TEST(Preload, StartLineNamesBothVersions) {
  const Scratch scratch;
  std::ofstream(scratch / "in.empty") << "print \"here is ${here}\"\n";
  const Outcome outcome = well(run_deck(scratch / "in.empty", {}, scratch.path()));
  EXPECT_TRUE(printed(outcome, {std::string("drumlin ") + DRUMLIN_VERSION +
                                    ", plugin for LIGGGHTS 3.8.0, loaded in LIGGGHTS 3.8.0\n",
                                "here is " + scratch.path().string() + "\n"}));
}

} // namespace others

// Engine instances of one process, and signals that end them.

// Engine instances of one process: after the command clear, one after the other, side by side; and that the
// plugin keeps no state for the process.
namespace instances {

class ClearCommand : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Engine, ClearCommand, ::testing::Values("in", "lammps"),
                         [](const auto &test) { return test.param == "in" ? "liggghts" : "lammps"; });

TEST_P(ClearCommand, LeavesADeckThatLoopsItsRuns) {
  SKIP_WITHOUT_LAMMPS(GetParam() == "lammps");
  const fs::path deck = fs::path(DRUMLIN_SOURCE_DIR) / ("tests/engine/life/clear." + GetParam());
  const std::vector<std::string> values = {"0.2", "0.5"};
  for (const int ranks : {1, 2}) {
    const Scratch loop;
    well(run_deck(deck, {{"deck", deck.string()}}, loop.path(), ranks));
    for (const std::string &D : values) {
      const Scratch alone;
      well(run_deck(deck, given("deck {}, D {}", deck.string(), D), alone.path(), ranks));
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
  SKIP_WITHOUT_LAMMPS(true);
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
  SKIP_WITHOUT_LAMMPS(true);
  const Scratch inside, after;
  const Outcome stopped = lammps_until_interrupted("drumlin/run 2000000000\n", inside);
  EXPECT_TRUE(fails_with(stopped, "ERROR: drumlin/run: stopped by a signal at step "));
  EXPECT_EQ(errors_in(stopped.output), 1U) << stopped.output;
  EXPECT_EQ(lammps_until_interrupted(std::string("drumlin/run 100\n") + for_ever, after).status, 130);
}

TEST(Signal, EndsRunWithOneLineInLiggghts) {
  const Scratch folder;
  write_text(folder / "pair", host_pair_style() + host_properties());
  write_text(folder / "lines", for_ever);
  const Outcome stopped = run_until_interrupted("in.host", {}, folder);
  EXPECT_TRUE(fails_with(stopped, ": stopped by a signal before the end of the deck"));
  EXPECT_EQ(errors_in(stopped.output), 1U) << stopped.output;
}

} // namespace signals

// What decks get and give: values of the fixes in the output of the engines, variables, notes.

// The output values of the fixes, read by all output features of the engines: computes, averages, histograms,
// variables and thermo.
namespace outputs {

const std::string takers =
    "fix contacts all contact/local every 5\n"
    "fix guard all guard\n"
    "fix events all contact/events file ev.csv\n"
    "fix excite drum drum/excite amplitude 1e6 omega 5e4 direction 0 0 -1\n"
    "fix bond all bond/spring 1 2 1 1\n"
    "fix history drum roller/history file history.csv every 5 axis 0 0 1\n"
    "compute deepest all reduce max f_contacts[9] ${local}\n"
    "compute total all reduce sum f_contacts[3] f_contacts[4] f_contacts[5] ${local}\n"
    "fix averages all ave/time 5 1 5 c_deepest c_total[3] f_guard f_guard[1] f_guard[2] f_events f_bond "
    "f_bond[1] f_bond[5] f_excite f_excite[1] f_history[8] file averages.txt\n"
    "fix histogram all ave/histo 5 1 5 0 0.1 5 f_contacts[9] mode vector file histogram.txt\n"
    "variable d equal c_deepest+f_history[8]\n"
    "thermo_style custom step f_guard f_guard[1] f_events f_bond f_bond[2] f_excite f_excite[6] f_history[1] "
    "f_history[10] c_deepest c_total[3] v_d\n"
    "thermo 5\n";

void expect_outputs(const Scratch &folder, const Outcome &outcome) {
  ASSERT_TRUE(outcome.ok()) << outcome.output;
  EXPECT_GT(lines_of(read_text(folder / "averages.txt")).size(), 4U);
  // The wall of the host's line holds the soil ball with an overlap of 0.01 m, which is in the first of five
  // bins.
  const std::vector<std::string> histogram = lines_of(read_text(folder / "histogram.txt"));
  ASSERT_GT(histogram.size(), 4U);
  EXPECT_EQ(histogram[4].rfind("1 0.01 ", 0), 0U) << histogram[4];
  EXPECT_FALSE(contains(histogram[4], " 0 0"));
}

TEST(OutputsOfFixes, GoIntoAllOutputsOfLiggghts) {
  const Scratch folder;
  const std::string wall = "variable local string \"\"\n"
                           "fix wall all wall/gran model hooke/transition primitive type 1 zplane -0.99\n";
  expect_outputs(folder, run_host(host_pair_style() + host_properties(), wall + takers, folder.path(), 1));
}

TEST(OutputsOfFixes, GoIntoAllOutputsOfLammps) {
  SKIP_WITHOUT_LAMMPS(true);
  const Scratch folder;
  // Later releases of LAMMPS need a keyword which says that the numbers are not per-atom values.
  write_text(folder / "lines", "variable local string \"\"\n"
                               "if \"$(version) > 20231120\" then \"variable local string 'inputs local'\"\n"
                               "pair_style gran/hooke/transition\npair_coeff * * 1e7 0.5\n"
                               "fix wall all wall/gran/transition 1 zplane -0.99 NULL\n" +
                                   takers + "fix integrate all nve/sphere\nrun 20\n");
  expect_outputs(folder, run_deck(std::filesystem::path(DRUMLIN_SOURCE_DIR) / "tests/support/host.lammps",
                                  {{"lines", (folder / "lines").string()}}, folder.path()));
}

} // namespace outputs

// drumlin/variable: where a value comes from, the rows of drumlin/record, and notes of drumlin/write that a
// later deck takes. In both engines, without a box, and again after `clear`.
namespace variables {

const std::string declarations = "drumlin/variable k 1 positive N/m soil \"stiffness\"\n"
                                 "drumlin/variable D 0.3 \"each positive\" 1 soil \"damping ratio\"\n"
                                 "drumlin/variable mu 0.5 non_negative 1 soil \"friction\"\n"
                                 "drumlin/variable loads \"25 50\" words kPa test \"stresses\"\n"
                                 "drumlin/variable made 1 noted - test \"a value that only files give\"\n"
                                 "drumlin/variable out results output_folder - run \"folder\"\n"
                                 "drumlin/variables\n";

class DeckVariablesTest : public ::testing::TestWithParam<bool> {
protected:
  /// Runs lines, in LAMMPS behind `plugin load`.
  Outcome run(const std::string &lines, const Variables &variables) {
    const bool lammps = GetParam();
    const std::filesystem::path deck = folder_ / (lammps ? "own.lammps" : "own.in");
    write_text(deck, load() + lines);
    return run_deck(deck, variables, folder_.path());
  }
  /// Begins a deck; after `clear` LAMMPS has unloaded the plugin.
  static std::string load() { return GetParam() ? "plugin load ${plugin}\n" : ""; }
  /// The value of a row of parameters.csv; "none": there is no such row.
  std::string row(const std::string &name) const {
    std::string value = "none";
    for (const std::string &line : lines_of(read_text(folder_ / "parameters.csv")))
      if (line.rfind(name + ",", 0) == 0) value = value == "none" ? line.substr(name.size() + 1) : "twice";
    return value;
  }
  static std::string box() {
    return "units si\natom_style " + std::string(GetParam() ? "sphere" : "granular") +
           "\nregion box block 0 1 0 1 0 1 units box\ncreate_box 1 box\n"
           "create_atoms 1 single 0.5 0.5 0.5 units box\nset group all diameter 0.1 density 1000\n";
  }
  void SetUp() override { SKIP_WITHOUT_LAMMPS(GetParam()); }

  Scratch folder_;
};

// The command line comes before an earlier line, this before the default; a value that the deck records
// itself stands in the file instead of the declared one.
TEST_P(DeckVariablesTest, RecordTheirValues) {
  well(run("variable D index 0.4\nvariable mu index 0.6\n" + declarations +
               "drumlin/record parameters.csv deck own loads * kt $(v_k/2)\n",
           given("k 8, mu 0.7")));
  EXPECT_EQ(row("k"), "8");
  EXPECT_EQ(row("D"), "0.4");
  EXPECT_EQ(row("mu"), "0.7");
  EXPECT_EQ(row("loads"), "\"25,50\"");
  EXPECT_EQ(row("made"), "1");
  EXPECT_EQ(row("kt"), "4");
}

TEST_P(DeckVariablesTest, AreNotedInFilesAndTaken) {
  well(run(declarations + box() +
               "variable E index 3\ndrumlin/write data own.data made 7 groups soil values_of E\n",
           given("k 8, D 0.1,0.2")));
  const std::string take = "drumlin/take own.data \"the first deck\" mu fixed test free soil\n";
  EXPECT_TRUE(printed(run(take + declarations, {}), "variable loads is '25 50'; allowed: a file that notes"));
  const std::string record = "drumlin/record parameters.csv E ${E}\n";
  const std::string free = "drumlin/take own.data \"the first deck\" mu free soil\n";
  well(run(free + declarations + "clear\n" + load() + declarations + record, {{"mu", "0.9"}}));
  EXPECT_EQ(row("k"), "8");
  EXPECT_EQ(row("D"), "\"0.1,0.2\"");
  EXPECT_EQ(row("mu"), "0.9"); // changed on purpose
  EXPECT_EQ(row("made"), "7");
  EXPECT_EQ(row("E"), "3");
  // The same number in another notation is the same value; another number is not.
  EXPECT_TRUE(run(free + declarations, given("k 8.0e0, D 1e-1,0.2")).ok());
  EXPECT_TRUE(
      printed(run(free + declarations, {{"D", "0.1,0.3"}}),
              "ERROR: drumlin/variable: variable D is '0.1,0.3'; allowed: 0.1,0.2, with which 'own.data' "
              "was made; for another value run the first deck again"));
}

// A file that was made before a deck had the variable was made with its default.
TEST_P(DeckVariablesTest, ThatAreNewHaveTheirDefaultsInEarlierFiles) {
  well(run(declarations + box() + "drumlin/write data own.data made 7 groups soil\n", {}));
  const auto taken = [](const std::string &later) {
    return "drumlin/take own.data \"the first deck\" pull free soil" + later + "\n" +
           "drumlin/variable pull 0 non_negative N soil attraction\n" +
           "drumlin/variable yield 1 positive 1 soil stiffness\n" + declarations +
           "drumlin/record parameters.csv\n";
  };
  EXPECT_TRUE(printed(run(taken(""), {}), "variable pull is '0'; allowed: a file that notes"));
  well(run(taken(" later pull yield"), {{"pull", "5"}}));
  EXPECT_EQ(row("pull"), "5"); // changed on purpose
  EXPECT_EQ(row("yield"), "1");
  EXPECT_TRUE(printed(run(taken(" later pull yield"), {{"yield", "3"}}),
                      "variable yield is '3'; allowed: 1, with which 'own.data' was made"));
}

// The report compares linear chains alone, and takes the law from this row.
TEST_P(DeckVariablesTest, ARecordNamesTheLawOfThePairStyle) {
  const bool lammps = GetParam();
  for (const char *law : {"hooke/transition", "hertz/transition", "yield/transition"}) {
    const std::string style =
        fmt::format(lammps ? "pair_style gran/{}\n" : "pair_style gran model {}\n", law);
    well(run("drumlin/record before.csv\n" + box() + style + "drumlin/record parameters.csv\n", {}));
    EXPECT_EQ(row("contact_law"), law);
    EXPECT_FALSE(contains(read_text(folder_ / "before.csv"), "contact_law"));
  }
}

// A table does what its lines would do in the deck: formulas of variables above, values that the deck has set
// before, groups of which each has its own default; what is declared already keeps its declaration.
TEST_P(DeckVariablesTest, StandInATable) {
  write_text(folder_ / "own.variables",
             "# name default unit rule group meaning\n"
             "case    II   -      \"one_of I II\" scene a case\n"
             "limit   5    -      any           scene of others\n\n"
             "k       1e8  N/m    positive      soil  stiffness, of \"all\" contacts\n"
             "kt      $(2/7*v_k) \"N s\" \"below ${limit}e9\" soil tangential\n"
             "of_kt   ${kt} N/m   positive      soil  the same text\n"
             "length  3    m      positive      short of the run\n"
             "length  30   m      positive      long  of the run\n"
             "out     out  -      output_folder long  of files\n");
  const std::string deck = "drumlin/variable limit 4 any - run \"of a deck of one's own\"\n"
                           "drumlin/variables own.variables scene\nvariable k index 7e8\n"
                           "drumlin/variables own.variables soil long\ndrumlin/variables\n"
                           "drumlin/record parameters.csv\n";
  well(run(deck, {{"case", "I"}}));
  EXPECT_EQ(row("case"), "I");
  EXPECT_EQ(row("limit"), "4");
  EXPECT_EQ(row("k"), "7e8");
  EXPECT_EQ(std::stod(row("kt")), 2.0 / 7.0 * 7e8);
  EXPECT_EQ(row("of_kt"), row("kt"));
  EXPECT_EQ(row("length"), "30");
  EXPECT_TRUE(printed(run(deck, {{"kt", "4e9"}}), "ERROR: drumlin/variable: variable kt is '4e9'; allowed: "
                                                  "a finite number below 4e+09"));
  EXPECT_TRUE(
      printed(run(deck, {{"kk", "1"}}), "allowed: k, the nearest of limit, case, k, kt, of_kt, length"));
}

TEST_P(DeckVariablesTest, OfAnUnknownNameAreRefusedFirst) {
  EXPECT_TRUE(printed(run(declarations, given("K 1, k -1")),
                      "ERROR: drumlin/variables: -var K is '1', a variable that this deck does not have; "
                      "allowed: k, the nearest of k, D, mu, loads, out"));
  EXPECT_TRUE(printed(run(declarations, {{"made", "1"}}), "-var made is '1', a variable that this deck"));
  EXPECT_TRUE(printed(run(declarations, {{"D", "1 2"}}), "ERROR: drumlin/variable"));
  EXPECT_TRUE(run(declarations, {{"loads", "100 200"}}).ok());
}

INSTANTIATE_TEST_SUITE_P(Engines, DeckVariablesTest, ::testing::Bool(),
                         [](const auto &engine) { return engine.param ? "Lammps" : "Liggghts"; });

} // namespace variables

} // namespace
} // namespace drumlin::test
