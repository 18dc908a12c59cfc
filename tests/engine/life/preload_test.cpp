// The library that is loaded into an engine, and into nothing else.
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"
#include "tests/support/host_deck.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace drumlin::test {
namespace {

// The preloaded library in processes that it was not built for: an engine that it cannot extend is stopped
// with one clear line. (That other programs do not notice it is tested in
// tests/decks/other_programs_test.cpp.)
namespace preload {

namespace fs = std::filesystem;

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
  if (!post::has_lammps()) GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
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

} // namespace
} // namespace drumlin::test
