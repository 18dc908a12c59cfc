// The front script ./drumlin with hostile names, from strange places: what a user gives reaches the engine as it is, or one line says
// what is wrong.
#include "engine_run.h"

#include "decks/engine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;
using post::Outcome;
using post::run_program;

const fs::path root = DRUMLIN_SOURCE_DIR;

/// A checkout of any name, in which the plugin is built already, and an engine that prints its arguments.
class FrontScript : public ::testing::Test {
protected:
  FrontScript() : folder(fs::canonical(scratch.path())) {
    fs::create_directories(folder / "bin");
    put("bin/liggghts", "#!/bin/sh\nprintf '<%s>' \"$LD_PRELOAD\" \"$@\"\n");
    fs::permissions(folder / "bin/liggghts", fs::perms::owner_all);
  }

  void put(const std::string &file, const std::string &text) const { std::ofstream(folder / file) << text; }

  fs::path checkout(const std::string &name) const {
    fs::path place = folder / name;
    fs::create_directories(place / "build/release");
    fs::copy_file(root / "drumlin", place / "drumlin");
    const fs::path library = fs::path(post::plugin_library()).parent_path();
    fs::create_directory_symlink(library, place / "build/release/lib");
    fs::create_directory_symlink(library.parent_path() / "bin", place / "build/release/bin");
    fs::copy(root / "inputs", place / "inputs", fs::copy_options::recursive);
    return place;
  }

  /// Calls the script of a checkout in a folder, without HOME, with the engine that prints, or the real one.
  Outcome call(const fs::path &script, const std::vector<std::string> &arguments, const fs::path &where,
               bool real_engine = false) const {
    std::vector<std::string> words = {"env", "-u", "HOME", "-u", "XDG_CACHE_HOME"};
    if (!real_engine) words.push_back("PATH=" + (folder / "bin").string() + ":/usr/bin:/bin");
    words.push_back(script.string());
    words.insert(words.end(), arguments.begin(), arguments.end());
    return run_program(words, {}, where, 60.0);
  }

  static void expect_one_line(const Outcome &outcome, const std::string &text) {
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_EQ(outcome.output.rfind("ERROR: drumlin", 0), 0u) << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    EXPECT_TRUE(outcome.says(text)) << outcome.output;
  }

  Scratch scratch;
  fs::path folder;
};

const std::vector<std::string> hostile = {"B[1]",
                                          "x$(touch pwned)",
                                          "x;echo pwned;",
                                          "`touch pwned`",
                                          "A&B",
                                          "-x",
                                          "run(1)",
                                          "100%",
                                          "{}",
                                          "it's",
                                          "a\"b",
                                          "b\\",
                                          "x y",
                                          "two\nlines",
                                          "*",
                                          "",
                                          "~"};

TEST_F(FrontScript, HandsArgumentsToTheEngineAsTheyAre) {
  const fs::path script = checkout("checkout") / "drumlin";
  put("my.deck", "run 0\n");
  for (const char *ranks : {"1", "2"}) {
    std::vector<std::string> arguments = {"run", "-np", ranks, "my.deck"};
    std::string printed = "<-in><my.deck>";
    for (const std::string &name : hostile) {
      arguments.insert(arguments.end(), {"-var", "out", name});
      printed += "<-var><out><" + name + ">";
    }
    const Outcome outcome = call(script, arguments, folder);
    EXPECT_TRUE(outcome.ok()) << outcome.output;
    EXPECT_TRUE(outcome.says(printed)) << outcome.output;
  }
  EXPECT_FALSE(fs::exists(folder / "pwned"));
}

TEST_F(FrontScript, HandsArgumentsToTheToolsAsTheyAre) {
  const fs::path script = checkout("checkout") / "drumlin";
  for (const std::string &name : hostile) {
    for (const char *command : {"report", "vtk"})
      expect_one_line(call(script, {command, "--", "none/" + name}, folder),
                      name == "two\nlines" ? "lines" : name);
    if (name != "-x" && !name.empty()) expect_one_line(call(script, {name}, folder), "");
    expect_one_line(call(script, {"run", name.empty() ? "." : name}, folder), "cannot be read");
  }
  expect_one_line(call(script, {"report", "--", "-x"}, folder), "'-x' is no folder");
  expect_one_line(call(script, {"setup", "x$(touch pwned)"}, folder), "is unknown");
  expect_one_line(call(script, {"setup", "lammps", "x;touch pwned"}, folder), "is no release");
  EXPECT_FALSE(fs::exists(folder / "pwned"));
}

TEST_F(FrontScript, RunsWithoutHome) {
  const fs::path script = checkout("checkout") / "drumlin";
  const Outcome help = call(script, {"--help"}, folder);
  EXPECT_TRUE(help.ok()) << help.output;
  const Outcome version = call(script, {"report", "--help"}, folder);
  EXPECT_TRUE(version.ok()) << version.output;
}

TEST_F(FrontScript, RunsInACheckoutWhosePathHasSpaces) {
  const fs::path place = checkout("my check out");
  const std::vector<std::string> short_chain = {
      "run", "inputs/chain/in.chain", "-var", "cycles", "1", "-var", "out", "out"};
  const Outcome inside = call(place / "drumlin", short_chain, place, true);
  EXPECT_TRUE(inside.ok()) << inside.output;
  EXPECT_TRUE(fs::is_regular_file(place / "out/chain.csv")) << inside.output;
  // From elsewhere the engine would split the path: one line, which names the way out, and that way works.
  std::vector<std::string> from_elsewhere = short_chain;
  from_elsewhere[1] = (place / "inputs/chain/in.chain").string();
  expect_one_line(call(place / "drumlin", from_elsewhere, folder),
                  "a path with blanks, at which the engine splits it; allowed: ");
  fs::create_directory_symlink(place, folder / "link");
  from_elsewhere[1] = "link/inputs/chain/in.chain";
  const Outcome linked = call(folder / "link/drumlin", from_elsewhere, folder, true);
  EXPECT_TRUE(linked.ok()) << linked.output;
  EXPECT_TRUE(fs::is_regular_file(folder / "out/chain.csv")) << linked.output;
}

TEST_F(FrontScript, FindsTheIncludesOfALinkedDeck) {
  const fs::path place = checkout("checkout");
  fs::create_directories(folder / "decks");
  fs::create_symlink(place / "inputs/chain/in.chain", folder / "decks/mine");
  fs::create_symlink("mine", folder / "decks/of mine");
  for (const char *deck : {"decks/mine", "decks/of mine"}) {
    fs::remove_all(folder / "out");
    const Outcome outcome =
        call(place / "drumlin", {"run", deck, "-var", "cycles", "1", "-var", "out", "out"}, folder, true);
    EXPECT_TRUE(outcome.ok()) << outcome.output;
    EXPECT_TRUE(fs::is_regular_file(folder / "out/chain.csv")) << outcome.output;
  }
}

TEST_F(FrontScript, IsFoundThroughALinkToIt) {
  const fs::path place = checkout("checkout");
  fs::create_symlink(place / "drumlin", folder / "bin/drumlin-link");
  put("my.deck", "run 0\n");
  const Outcome outcome = call(folder / "bin/drumlin-link", {"run", "my.deck"}, folder);
  EXPECT_TRUE(outcome.ok()) << outcome.output;
  EXPECT_TRUE(outcome.says((place / "build/release/lib/libdrumlin.so").string())) << outcome.output;
}

} // namespace
} // namespace drumlin::test
