// The front script ./drumlin, called with unusual names and from unusual folders: the user's arguments reach
// the engine unchanged, or one line says what is wrong.
#include "tests/support/engine_runs.h"

#include <unistd.h>

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
    fs::create_directories(place / "build/release/bin");
    for (const char *file : {"drumlin", "CMakeLists.txt"})
      fs::copy_file(root / file, place / file);
    fs::create_directory_symlink(fs::path(post::plugin_library()).parent_path(), place / "build/release/lib");
    fs::create_symlink(DRUMLIN_TOOLS, place / "build/release/bin/drumlin-tools");
    std::ofstream(place / "build/release/bin/places")
        << "inputs=../../../inputs\nliggghts_plugin=../lib/libdrumlin.so\nliggghts=liggghts\n";
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
    EXPECT_TRUE(printed(outcome, text));
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
    std::string words = "<-in><my.deck>";
    for (const std::string &name : hostile) {
      arguments.insert(arguments.end(), {"-var", "name", name});
      words += "<-var><name><" + name + ">";
    }
    EXPECT_TRUE(printed(well(call(script, arguments, folder)), words));
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
  const Outcome help = well(call(script, {"--help"}, folder));
  well(call(script, {"report", "--help"}, folder));
}

const std::vector<std::string> short_chain = words_of("run chain/in.chain -var cycles 1 -var out out");

/// The same with another deck and another folder for results.
std::vector<std::string> short_run(const std::string &deck, const std::string &out) {
  std::vector<std::string> words = short_chain;
  words[1] = deck;
  words.back() = out;
  return words;
}

TEST_F(FrontScript, RunsInACheckoutWhosePathHasSpaces) {
  const fs::path place = checkout("my check out");
  for (const std::string deck :
       {"inputs/chain/in.chain", "chain/in.chain", "../my check out/inputs/chain/in.chain"}) {
    fs::remove_all(folder / "work here");
    fs::create_directory(folder / "work here");
    const Outcome outcome =
        well(call(place / "drumlin", short_run(deck, "of a/run"), folder / "work here", true));
    EXPECT_TRUE(fs::is_regular_file(folder / "work here/of a/run/chain.csv")) << outcome.output;
  }
  fs::create_directory_symlink(place, folder / "link");
  const Outcome linked = well(call(folder / "link/drumlin", short_chain, folder, true));
  EXPECT_TRUE(fs::is_regular_file(folder / "out/chain.csv")) << linked.output;
  EXPECT_TRUE(printed(linked, "LD_PRELOAD=" + (folder / "link/build/release/lib/libdrumlin.so").string()));
}

TEST_F(FrontScript, TakesFilesInFoldersWithSpaces) {
  const fs::path place = checkout("checkout");
  fs::create_directory(folder / "a bed");
  Outcome outcome = well(
      call(place / "drumlin",
           {"run", "bed/in.settle", "-var", "balls", "a bed/balls.data", "-var", "bed", "b/soil.restart"},
           folder, false));
  const std::size_t begin = outcome.output.find("<balls><") + 8;
  const fs::path handed = outcome.output.substr(begin, outcome.output.find('>', begin) - begin);
  EXPECT_EQ(handed.string().find(' '), std::string::npos) << outcome.output;
  EXPECT_EQ(fs::canonical(handed.parent_path()) / handed.filename(), folder / "a bed/balls.data");
  EXPECT_TRUE(printed(outcome, "<b/soil.restart>"));
  expect_one_line(call(place / "drumlin", {"run", "bed/in.bed", "-var", "start", "a bed/of mine"}, folder),
                  "-var start is 'a bed/of mine'; allowed: ");
}

/// Only the working folder can be written, and the user is not the one who has built the checkout.
TEST_F(FrontScript, RunsInstalledFromAReadOnlyPrefixThatWasMoved) {
  well(run_program({"cmake", "--install", DRUMLIN_BINARY_DIR, "--prefix", (folder / "first").string()}, {},
                   folder, 60.0));
  const fs::path prefix = folder / "moved pre fix";
  fs::rename(folder / "first", prefix);
  const auto writable = [&](bool yes) {
    return run_program({"chmod", "-R", yes ? "u+w" : "a-w", prefix.string()}, {}, folder);
  };
  writable(false);
  const fs::path script = prefix / "bin/drumlin";
  fs::create_directory(folder / "work here");
  for (const char *deck : {"chain/in.chain", "inputs/chain/in.impact"}) {
    const Outcome outcome =
        well(call(script, {"run", deck, "-var", "out", "of a/run"}, folder / "work here", true));
    EXPECT_TRUE(fs::is_regular_file(folder / "work here/of a/run/chain.csv")) << outcome.output;
    EXPECT_FALSE(outcome.says(root.string())) << outcome.output;
  }
  EXPECT_TRUE(printed(well(call(script, {"advise", "--error", "1e-3", "--case", "II"}, folder / "work here")),
                      " drumlin run "));
  EXPECT_TRUE(
      printed(call(script, {"run", "bed/in.bed", "-var", "start", "none"}, folder / "work here", true),
              "which 'drumlin run inputs/bed/in.place -var start none' makes"));
  expect_one_line(call(script, {"demo", "--balls", "1"}, folder / "work here"),
                  "demo: --balls is '1'; allowed: ");
  expect_one_line(call(script, {"run"}, folder), "allowed: drumlin run [-np N] DECK");
  for (const char *command : {"setup", "test", "check"})
    expect_one_line(call(script, {command}, folder),
                    std::string("allowed: ./drumlin ") + command + " in a checkout");
  fs::create_symlink(script, folder / "bin/drumlin-link");
  EXPECT_TRUE(call(folder / "bin/drumlin-link", {"run", "chain/in.chain"}, folder).says("<-in>"));
  const Outcome help = call(script, {"--help"}, folder);
  EXPECT_FALSE(help.says("./drumlin")) << help.output;
  EXPECT_FALSE(help.says("setup")) << help.output;
  writable(true);
}

/// A shell line around the script, which it has as $drumlin.
TEST_F(FrontScript, RunsInPlacesOfAllKinds) {
  const fs::path place = checkout("checkout");
  const auto shell = [&](const std::string &line) {
    fs::remove_all(folder / "out");
    return run_program(
        {"bash", "-c", line},
        {"drumlin=" + (place / "drumlin").string(), "run=run chain/in.chain -var cycles 1 -var out out"},
        folder, 60.0);
  };
  for (const char *line :
       {"$drumlin $run >&-", "$drumlin $run >&- 2>&-", "$drumlin $run <&-", "$drumlin $run >/dev/full",
        "set -o pipefail; $drumlin $run | head -n 2", "umask 077; $drumlin $run",
        "LC_ALL=de_DE.UTF-8 $drumlin $run", "LC_NUMERIC=de_DE.UTF-8 $drumlin $run",
        "cd / && cd - >/dev/null && env -u HOME -u PWD $drumlin $run"}) {
    SCOPED_TRACE(line);
    well(shell(line));
    std::size_t rows = 0;
    std::ifstream table(folder / "out/chain.csv");
    for (std::string row; std::getline(table, row); ++rows)
      EXPECT_EQ(std::count(row.begin(), row.end(), ','), 9) << row; // nothing of what the engine prints
    EXPECT_EQ(rows, 202U);
  }
  for (const char *line : {"$drumlin --help >&-", "$drumlin --version >&-", "$drumlin --help | head -n 1"})
    EXPECT_TRUE(shell(line).ok()) << line;
  for (const char *line : {"$drumlin --help >/dev/full", "$drumlin --version >/dev/full",
                           "$drumlin advise --error 1e-3 >/dev/full"}) {
    const Outcome outcome = shell(line);
    EXPECT_NE(outcome.status, 0) << line;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << line << "\n"
                                                                                 << outcome.output;
  }
}

/// A built checkout in which nothing can be written still runs decks; commands that would write into it say
/// so.
TEST_F(FrontScript, RunsInAReadOnlyCheckout) {
  if (!can_mount_small_disk()) GTEST_SKIP() << "SKIPPED: a file system of its own needs root";
  const fs::path place = checkout("checkout");
  const std::string script = "mount --bind \"$0\" \"$0\" && mount -o remount,bind,ro \"$0\" && "
                             "exec \"$0/drumlin\" \"$@\"";
  const auto read_only = [&](const std::vector<std::string> &arguments) {
    std::vector<std::string> words = words_of("unshare --mount sh -c {} {}", script, place.string());
    words.insert(words.end(), arguments.begin(), arguments.end());
    return run_program(words, {}, folder, 60.0);
  };
  const Outcome outcome = well(read_only(short_chain));
  EXPECT_TRUE(fs::is_regular_file(folder / "out/chain.csv")) << outcome.output;
  for (const char *command : {"setup", "test", "check"})
    expect_one_line(read_only({command}), "cannot be written; allowed: a checkout of one's own");
}

/// Two jobs make a run: the first stops at its time, the second continues; a third has nothing to do.
TEST_F(FrontScript, JobScriptsContinueUntilTheCyclesAreDone) {
  const fs::path place = checkout("checkout");
  for (const auto &file : fs::directory_iterator(root / "inputs/jobs"))
    fs::copy_file(file, folder / file.path().filename());
  put("bin/liggghts", "#!/bin/sh\necho \"$@\" >>calls\ncase \"$*\" in\n"
                      "*'start a/stopped.restart'*) echo 'drumlin/run: 100 %, step 2 of 2' ;;\n"
                      "*'start none'*) echo 'ERROR: no start'; exit 1 ;;\n"
                      "*) : >a/stopped.restart; echo 'drumlin/run: stopped at step 1 of 2' ;;\nesac\n");
  put("bin/sbatch", "#!/bin/sh\necho sbatch \"$@\" >>calls\n");
  fs::permissions(folder / "bin/sbatch", fs::perms::owner_all);
  const auto job = [&](const std::string &script, const std::string &start) {
    return run_program({"env", "PATH=" + (folder / "bin").string() + ":/usr/bin:/bin",
                        "drumlin=" + (place / "drumlin").string(), "out=a", "start=" + start, "ranks=1",
                        "limit=7", "SLURM_NTASKS=1", "SLURM_SUBMIT_DIR=" + folder.string(), "bash", script},
                       {}, folder);
  };
  for (const char *script : {"bed.mpirun", "bed.slurm"}) {
    SCOPED_TRACE(script);
    const bool slurm = std::string(script) == "bed.slurm";
    fs::remove_all(folder / "a");
    fs::remove(folder / "calls");
    const Outcome failed = job(script, "none");
    EXPECT_EQ(failed.status, 1);
    EXPECT_EQ(failed.output, "ERROR: no start\n");
    EXPECT_EQ(job(script, "b.restart").status, slurm ? 0 : 4);
    EXPECT_EQ(job(script, "b.restart").status, 0);
    EXPECT_EQ(job(script, "b.restart").output, "all cycles are done: a\n");
    const std::string calls = post::read_text(folder / "calls");
    EXPECT_EQ(std::count(calls.begin(), calls.end(), '\n'), slurm ? 4 : 3) << calls;
    EXPECT_EQ(calls.find("sbatch bed.slurm\n") != std::string::npos, slurm) << calls;
    EXPECT_TRUE(contains(calls, "-var time_limit 7"));
  }
}

/// An lmp without the packages that the plugin needs: `run` and CMake name them, `run` before the engine
/// starts.
TEST_F(FrontScript, NamesThePackagesThatAnLmpLacks) {
  const fs::path place = checkout("checkout");
  std::ofstream(place / "build/release/bin/places", std::ios::app)
      << "lammps_plugin=../lib/libdrumlin.so\nlammps=lmp\n";
  const std::vector<std::pair<std::string, std::string>> builds = {{"MOLECULE RIGID", "GRANULAR, PLUGIN"},
                                                                   {"GRANULAR OPENMP", "PLUGIN"},
                                                                   {"EXTRA-GRANULAR PLUGIN", "GRANULAR"},
                                                                   {"", "GRANULAR, PLUGIN"},
                                                                   {"GRANULAR MOLECULE PLUGIN RIGID", ""}};
  for (const auto &[packages, missing] : builds) {
    SCOPED_TRACE(packages);
    put("bin/lmp", "#!/bin/sh\n[ \"$1\" = -h ] || { echo started; exit 0; }\ncat <<'TXT'\n\n"
                   "Large-scale Atomic/Molecular Massively Parallel Simulator - Update 2 of 29 Sep 2021\n\n"
                   "Installed packages:\n\n" +
                       packages +
                       " \n\nList of individual style options included in this LAMMPS executable\n\n"
                       "* Atom styles:\n\natomic body charge ellipsoid GRANULAR PLUGIN\nTXT\n");
    fs::permissions(folder / "bin/lmp", fs::perms::owner_all);
    const Outcome run = call(place / "drumlin", {"run", "chain/in.chain.lammps"}, folder);
    const Outcome cmake =
        run_program({"cmake", "-DLAMMPS_PROGRAM=" + (folder / "bin/lmp").string(),
                     "-DLAMMPS_VERSION=29 Sep 2021", "-P", root / "plugin/lammps/check_program.cmake"},
                    {}, folder);
    if (missing.empty()) {
      EXPECT_EQ(run.status, 0) << run.output;
      EXPECT_TRUE(printed(run, "\nstarted\n"));
      EXPECT_EQ(cmake.status, 0) << cmake.output;
    } else {
      expect_one_line(run, "the engine 'lmp' has been built without " + missing + "; allowed: ");
      EXPECT_NE(cmake.status, 0);
      EXPECT_TRUE(printed(cmake, "without " + missing.substr(0, 8))); // CMake breaks the line
    }
  }
}

TEST_F(FrontScript, FindsTheIncludesOfALinkedDeck) {
  const fs::path place = checkout("checkout");
  fs::create_directories(folder / "decks");
  fs::create_symlink(place / "inputs/chain/in.chain", folder / "decks/mine");
  fs::create_symlink("mine", folder / "decks/of mine");
  for (const char *deck : {"decks/mine", "decks/of mine"}) {
    fs::remove_all(folder / "out");
    const Outcome outcome = well(
        call(place / "drumlin", {"run", deck, "-var", "cycles", "1", "-var", "out", "out"}, folder, true));
    EXPECT_TRUE(fs::is_regular_file(folder / "out/chain.csv")) << outcome.output;
  }
}

/// Whether a text has these, one after the other.
void expect_in_order(const std::string &text, const std::vector<std::string> &parts) {
  std::size_t at = 0;
  for (const std::string &part : parts) {
    const std::size_t found = text.find(part, at);
    ASSERT_NE(found, std::string::npos) << part << " is missing or in another place of\n" << text;
    at = found + part.size();
  }
}

// The line that `run` prints is a whole command: a shell that reads it makes the same tables, without
// drumlin.
TEST_F(FrontScript, PrintsTheCommandThatItRuns) {
  const fs::path place = checkout("checkout");
  for (const char *ranks : {"1", "2"}) {
    SCOPED_TRACE(ranks);
    const std::vector<std::string> words = {"run",  "-np", ranks, "chain/in.chain", "-var", "cycles", "1",
                                            "-var", "out", "out"};
    const Outcome outcome = well(call(place / "drumlin", words, folder, true));
    ASSERT_EQ(outcome.output.rfind("+ ", 0), 0u) << outcome.output;
    const std::string line = outcome.output.substr(2, outcome.output.find('\n') - 2);
    const std::string table = post::read_text(folder / "out/chain.csv");
    fs::remove_all(folder / "out");
    const Outcome again = run_program(
        {"env", "-i", "PATH=/usr/bin:/bin", "HOME=" + folder.string(), "sh", "-c", line}, {}, folder, 60.0);
    ASSERT_TRUE(again.ok()) << line << "\n" << again.output;
    EXPECT_EQ(post::read_text(folder / "out/chain.csv"), table);
    EXPECT_FALSE(contains(line, "drumlin-tools"));
    fs::remove_all(folder / "out");
  }
}

// The tool becomes the engine: its exit status and its end by a signal are those of `run`.
TEST_F(FrontScript, RunEndsAsTheEngineEnds) {
  const fs::path place = checkout("checkout");
  put("my.deck", "run 0\n");
  const auto ends = [&](const std::string &script) {
    put("bin/liggghts", "#!/bin/sh\n" + script + "\n");
    return call(place / "drumlin", {"run", "my.deck"}, folder).status;
  };
  EXPECT_EQ(ends("exit 0"), 0);
  EXPECT_EQ(ends("exit 7"), 7);
  EXPECT_EQ(ends("kill -TERM $$"), 128 + 15);
  EXPECT_EQ(ends("[ $PPID -eq " + std::to_string(::getpid()) + " ] || exit 3"),
            0); // no process waits in between
  fs::remove(folder / "bin/liggghts");
  fs::create_directory(folder / "bin/liggghts");
  std::vector<std::string> words = {"env", "PATH=" + (folder / "bin").string(), DRUMLIN_TOOLS, "run",
                                    "my.deck"};
  expect_one_line(run_program(words, {}, folder), "run: the engine 'liggghts' cannot be run; allowed: ");
}

/// The names of all demo runs, in their order.
std::vector<std::string> demo_lines(bool with_lammps) {
  std::vector<std::string> lines;
  int done = 0;
  const auto add = [&](const std::string &name) {
    std::string number = std::to_string(++done);
    if (number.size() < 2) number.insert(0, " ");
    lines.push_back("[" + number + (with_lammps ? "/29] " : "/21] ") + name);
  };
  for (const char *transition : {"A", "B"}) {
    add(std::string("impact, ") + transition);
    for (const char *chain_case : {"I", "II", "III", "IV"}) {
      add(std::string("chain, case ") + chain_case + ", " + transition);
      if (with_lammps) add("in LAMMPS");
    }
  }
  add("first pages of the report");
  add("results/demo/bed/balls.data: 300 balls");
  for (const char *name :
       {"bed comes to rest", "roller comes to rest", "bed, 1 cycles, A", "bed, 1 cycles, B"}) {
    add(name);
    lines.emplace_back("        drumlin/");
    if (name[0] == 'b' && name[3] == ',') add("results/demo/bed/"); // its series for ParaView
  }
  add("regimes of the roller");
  add("what the meter says of the soil");
  add("report");
  lines.emplace_back("The report: ");
  lines.emplace_back("The bed, for ParaView: ");
  lines.emplace_back("The commands of these steps: results/demo/commands.sh");
  return lines;
}

TEST_F(FrontScript, DemoOfFewCyclesAndBalls) {
  well(run_program({"cmake", "--install", DRUMLIN_BINARY_DIR, "--prefix", (folder / "pre fix").string()}, {},
                   folder, 60.0));
  const fs::path script = folder / "pre fix/bin/drumlin", work = folder / "work here";
  fs::create_directories(work / "results/demo/of an earlier call");
  const Outcome outcome = well(
      run_program(words_of("env -u HOME {} demo --cycles 1 --balls 300", script.string()), {}, work, 280.0));
  const bool with_lammps = post::has_lammps();
  if (!with_lammps) std::puts("SKIPPED: the demo in LAMMPS: LAMMPS is not set up (./drumlin setup lammps)");
  expect_in_order(outcome.output, demo_lines(with_lammps));
  const fs::path results = work / "results/demo";
  EXPECT_FALSE(fs::exists(results / "of an earlier call"));
  for (const char *transition : {"A", "B"}) {
    EXPECT_TRUE(fs::is_regular_file(results / "impact" / transition / "chain.csv"));
    EXPECT_TRUE(fs::is_regular_file(results / "bed" / transition / "bed.csv"));
    EXPECT_TRUE(fs::is_regular_file(results / "bed" / transition / "vtk/balls.pvd"));
    for (const char *chain_case : {"I", "II", "III", "IV"})
      for (const char *engine : {"chain", "lammps"}) {
        const fs::path run = results / engine / (std::string(chain_case) + "-" + transition);
        const bool wanted = with_lammps || std::string(engine) == "chain";
        EXPECT_EQ(fs::is_regular_file(run / "chain.csv"), wanted) << run;
        EXPECT_EQ(fs::is_regular_file(run / "screen.txt"), wanted) << run;
        EXPECT_EQ(fs::is_regular_file(run / "log.liggghts"), wanted) << run;
      }
  }
  for (const char *page : {"index.html", "bed.html", "studies/map/index.html", "studies/meter/index.html"})
    EXPECT_TRUE(fs::is_regular_file(work / "report" / page)) << page;
  EXPECT_FALSE(outcome.says("./drumlin")) << outcome.output;
  // A user can type each command.
  const std::string commands = post::read_text(results / "commands.sh");
  expect_in_order(commands, {"# impact, A\ndrumlin run ",
                             "in.impact' -var out results/demo/impact/A -var transition A\n",
                             "# report\ndrumlin report results/demo --out report\n"});
  const fs::path written = work / "results/demo/chain/IV-B/chain.csv";
  const std::string was = post::read_text(written);
  fs::remove(written);
  const std::size_t begin = commands.find("drumlin run", commands.find("# chain, case IV, B\n"));
  std::string line = commands.substr(begin, commands.find('\n', begin) - begin);
  line.replace(0, std::string("drumlin").size(), "'" + script.string() + "'");
  well(run_program({"bash", "-c", line}, {}, work, 60.0));
  EXPECT_EQ(post::read_text(written), was);
}

// The engine's output is in a file, which one line names; no run after the failed one is started.
TEST_F(FrontScript, DemoEndsAtTheFirstRunThatFails) {
  const fs::path place = checkout("checkout");
  const std::vector<std::string> words = {"env", "PATH=" + (folder / "bin").string() + ":/usr/bin:/bin",
                                          DRUMLIN_TOOLS, "demo"};
  const auto demo = [&](const std::string &engine) {
    put("bin/liggghts", "#!/bin/sh\n" + engine + "\n");
    return run_program(words, {"DRUMLIN_PLACES=" + (place / "build/release/bin/places").string()}, folder);
  };
  const Outcome failed = demo("echo going well; echo 'ERROR: too hot'; echo more; exit 5");
  EXPECT_EQ(failed.status, 1);
  EXPECT_EQ(failed.output.substr(failed.output.find('\n') + 1), // behind the line that says what is run
            "[ 1/26] impact, A              failed\n"
            "ERROR: drumlin demo: impact, A failed; its output is in "
            "results/demo/impact/A/screen.txt: ERROR: too hot\n");
  EXPECT_EQ(post::read_text(folder / "results/demo/impact/A/screen.txt"),
            "going well\nERROR: too hot\nmore\n");
  EXPECT_FALSE(fs::exists(folder / "results/demo/chain"));
  EXPECT_TRUE(demo("exit 6").says("results/demo/impact/A/screen.txt: exit status 6\n"));
}

TEST_F(FrontScript, DemoEndsWhenNobodyReadsIt) {
  const fs::path place = checkout("checkout");
  put("bin/liggghts", "#!/bin/sh\nsleep 0.2\n");
  const std::string line = "set -o pipefail; PATH=" + (folder / "bin").string() + ":/usr/bin:/bin; ";
  const std::string places = "DRUMLIN_PLACES=" + (place / "build/release/bin/places").string();
  EXPECT_TRUE(
      fails_with(run_program({"bash", "-c", line + DRUMLIN_TOOLS + " demo | head -n 1"}, {places}, folder),
                 "ERROR: drumlin demo: nobody reads its output any more, so it has stopped\n"));
  EXPECT_FALSE(fs::exists(folder / "results/demo/bed"));
  const Outcome full =
      run_program({"bash", "-c", line + DRUMLIN_TOOLS + " demo >/dev/full"}, {places}, folder);
  expect_in_order(full.output,
                  {"ERROR: drumlin demo: standard output cannot be written; allowed: one that can\n"});
  EXPECT_EQ(full.status, 1);
}

TEST_F(FrontScript, IsFoundThroughALinkToIt) {
  const fs::path place = checkout("checkout");
  fs::create_symlink(place / "drumlin", folder / "bin/drumlin-link");
  put("my.deck", "run 0\n");
  EXPECT_TRUE(printed(well(call(folder / "bin/drumlin-link", {"run", "my.deck"}, folder)),
                      (place / "build/release/lib/libdrumlin.so").string()));
}

} // namespace
} // namespace drumlin::test
