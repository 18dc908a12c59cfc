// Experiments and studies as a user calls them.
#include "tests/support/page.h"
#include "tests/support/run_folders.h"
#include "tests/support/tool.h"
#include "bed/packing.h"
#include "calibration/evaluations.h"
#include "calibration/soil_tests.h"
#include "engine/deck_run.h"
#include "engine/places.h"
#include "experiment/quantity.h"
#include "experiment/results.h"
#include "experiment/scene.h"
#include "map/course.h"
#include "map/map_results.h"
#include "support/resumed.h"

#include <sys/resource.h>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

// Experiments as a user runs them: on a deck of one's own, which costs one file, and on beds; interrupted,
// resumed, and with a run that fails.
namespace experiment {

/// A deck of the stock engine that writes a CSV file: the height of the seed, times a factor.
constexpr const char *own_deck = "variable factor index 1\n"
                                 "variable seed index 0\n"
                                 "variable high equal v_factor*(10*v_seed)\n"
                                 "if \"${factor} > 8\" then \"unknown_command\"\n"
                                 "print \"time,height\" file out.csv\n"
                                 "print \"0,0\" append out.csv\n"
                                 "print \"1,${high}\" append out.csv\n";

constexpr const char *own_plan = "title    Heights\n"
                                 "about    Three factors.\n"
                                 "quantity height m last out.csv height\n"
                                 "quantity mean_height m largest out.csv height\n"
                                 "axis     factor factor [-]\n"
                                 "deck     in.own\n"
                                 "seeds    3\n"
                                 "seed_variable seed\n"
                                 "scene    one\n"
                                 "at       factor 1\n"
                                 "scene    two\n"
                                 "from     one\n"
                                 "differs  twice the factor\n"
                                 "set      factor 2\n"
                                 "at       factor 2\n"
                                 "scene    four\n"
                                 "from     two\n"
                                 "differs  twice the factor again\n"
                                 "set      factor 4\n"
                                 "at       factor 4\n";

using Values = std::map<std::tuple<std::string, int, std::string>, double>;

Values values_in(const fs::path &out) {
  Values values;
  for (const post::Result &row : post::read_points(out / "runs.csv", post::result_rows()))
    values[{row.scene, row.seed, row.quantity}] = row.value;
  return values;
}

// Else a bed of one scene would be taken for that of another.
TEST(FilesOfABed, AreNamedForAllThatMadeThem) {
  post::Scene scene;
  scene.deck = "bed/in.bed";
  scene.bed = post::SoilBed{};
  std::set<std::string> names{post::placed_name(scene, 1), post::placed_name(scene, 2)};
  for (auto change : std::vector<void (*)(post::Scene &)>{
           [](post::Scene &other) { ++other.bed->packing.balls; },
           [](post::Scene &other) {
             other.bed->layers = {{other.bed->packing, 0.4}};
           },
           [](post::Scene &other) {
             other.bed->layers = {
                 {other.bed->packing, 0.4, post::Pouring{0.5, 0.1, 0.1, 0.2, 0.3, 0.1, 0.8, 0.4}}};
           },
           [](post::Scene &other) { other.bed->packing.radius_max += 1e-3; },
           [](post::Scene &other) { other.bed->ratio = "2e-2"; },
           [](post::Scene &other) {
             other.bed->spots = {{0.0, 0.5}};
           },
           [](post::Scene &other) { other.stiffness = 1e8; },
           [](post::Scene &other) {
             other.settings = {{post::Scope::all, "k", "1e8"}};
           },
           [](post::Scene &other) {
             other.settings = {{post::Scope::settle, "drag", "40"}};
           },
           [](post::Scene &other) {
             other.settings = {{post::Scope::placed, "sink", "0.1"}};
           }}) {
    post::Scene other = scene;
    change(other);
    names.insert(post::placed_name(other, 1));
  }
  EXPECT_EQ(names.size(), 12U);
}

TEST(OwnStudy, RunsAnyDeckThatWritesATableAndContinues) {
  const Scratch scratch;
  post::write_files({{scratch / "in.own", own_deck}, {scratch / "heights.plan", own_plan}});
  const auto run = [&](const std::vector<std::string> &options = {}) {
    std::vector<std::string> words = {DRUMLIN_TOOLS, "study", "heights.plan"};
    words.insert(words.end(), options.begin(), options.end());
    return run_program(words, {}, scratch.path(), 100.0);
  };
  const Outcome whole = run();
  ASSERT_TRUE(whole.ok()) << whole.output;
  const fs::path out = scratch / "results/study/heights";
  const Values values = values_in(out);
  ASSERT_EQ(values.size(), 3U * 3U * 2U);
  EXPECT_EQ(values.at({"one", 3, "height"}), 30.0);
  EXPECT_EQ(values.at({"four", 2, "height"}), 80.0);
  // Twice the factor adds 10, 20 and 30 to a mean of 20: +100 +- 124 %.
  const std::string page = post::read_text(out / "index.html");
  EXPECT_NE(page.find("+100 ± 124"), std::string::npos);
  expect_sound_page(out, 2, "index.html", 0);

  interrupt(out / "runs.csv"); // leaves some of a run's rows
  fs::remove(out / "index.html");
  const Outcome rest = run({"--jobs", "2"});
  ASSERT_TRUE(rest.ok()) << rest.output;
  EXPECT_EQ(values_in(out), values);
  expect_sound_page(out, 2, "index.html", 0);

  // Another plan is another study.
  post::write_files(
      {{scratch / "heights.plan", std::string(own_plan) + "scene too high\nfrom one\nset factor 9\n"}});
  const Outcome other = run();
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(other.says("ERROR: drumlin study: --out is 'results/study/heights'; allowed: the folder of a "
                         "study with the same settings"))
      << other.output;
  const Outcome failing = run({"--fresh"});
  EXPECT_EQ(failing.status, 1);
  EXPECT_TRUE(failing.says("seed 2, too high: ")) << failing.output;
  EXPECT_TRUE(failing.says("ERROR: drumlin study: 3 of the runs failed; the page tells which\n"))
      << failing.output;
  EXPECT_EQ(values_in(out), values);
  EXPECT_NE(post::read_text(out / "index.html").find("Missing: seed 2, too high"), std::string::npos);
}

TEST(OwnStudy, FailsWhereAKnownValueIsNotMet) {
  const Scratch scratch;
  for (const bool met : {true, false}) {
    const std::string known = met ? "expect height 80 1e-9 by hand\n" : "expect height 81 0.9 by hand\n";
    post::write_files({{scratch / "in.own", own_deck}, {scratch / "heights.plan", own_plan + known}});
    const Outcome outcome =
        run_program({DRUMLIN_TOOLS, "study", "heights.plan", "--fresh"}, {}, scratch.path(), 100.0);
    EXPECT_EQ(outcome.status, met ? 0 : 1) << outcome.output;
    EXPECT_EQ(outcome.says("ERROR: drumlin study: 1 of 1 known values are not met; the page tells which\n"),
              !met);
  }
}

// Heights in proportion to a factor: an error of order -1.
TEST(OwnStudy, WritesTablesAndOrdersAndComparesWithAnEarlierTable) {
  const Scratch scratch;
  const std::string plan = "title T\nquantity height m last out.csv height\n"
                           "quantity loop s last cost.csv loop [s]\n"
                           "quantity memory B last cost.csv memory [B]\nlog_axis share 1/factor\n"
                           "order height\ntable heights.csv share seed factor=factor high=height loop\n"
                           "deck in.own\nset seed 1\n";
  const std::string scenes =
      "scene a\nover factor 1 0.5 0.25 0.0625 0.03125\nat share factor\nscene without place\nset factor 3\n";
  post::write_files({{scratch / "in.own", own_deck}, {scratch / "heights.plan", plan + scenes}});
  const auto run = [&] {
    return run_program({DRUMLIN_TOOLS, "study", "heights.plan", "--fresh"}, {}, scratch.path(), 100.0);
  };
  const Outcome first = run();
  ASSERT_TRUE(first.ok()) << first.output;
  const fs::path out = scratch / "results/study/heights";
  EXPECT_EQ(post::read_text(out / "heights.csv"),
            "share,seed,factor,high,loop\n1,1,1,10,\n0.5,1,0.5,5,\n0.25,1,0.25,2.5,\n"
            "0.0625,1,0.0625,0.625,\n0.03125,1,0.03125,0.3125,\n"); // the deck has no loop
  const post::Table orders = post::read_table(out / "data/orders.csv");
  ASSERT_EQ(orders.rows(), 1U);
  EXPECT_EQ(orders.text("order of the finer half [-]")[0], "-1.00");
  EXPECT_GT(values_in(out).at({"a: factor 1", 1, "memory"}), 1e6); // no process of an engine is smaller

  fs::copy_file(out / "heights.csv", scratch / "heights.csv");
  const auto at_most = [&](const char *factor) {
    post::write_files(
        {{scratch / "heights.plan", plan + fmt::format("at_most {} heights.csv height\n", factor) + scenes}});
    return run();
  };
  EXPECT_TRUE(at_most("1.001").ok());
  EXPECT_TRUE(at_most("0.999").says("ERROR: drumlin study: 5 of 5 known values are not met"));
}

// Scenes run in turn, on a file that a deck has made once, each on its ranks.
TEST(OwnStudy, AlternatesScenesInRoundsOnAFileThatADeckMakes) {
  const Scratch scratch;
  post::write_files(
      {{scratch / "bed.plan",
        "title T\nquantity end m last end.csv height_m\nquantity loop s last cost.csv loop [s]\n"
        "deck study/in.cost_bed\nrounds 2\nset steps 20\n"
        "made data study/in.cost_bed data from=lattice columns=20 rows=6 steps=500\n"
        "scene one\nscene two\nfrom one\ndiffers ranks\nranks 2\n"
        "set law \"hooke/transition tangential history stepping stock damping coefficient\"\n"}});
  const auto run = [&] {
    return run_program({DRUMLIN_TOOLS, "study", "bed.plan", "--keep"}, {}, scratch.path(), 100.0);
  };
  const Outcome outcome = run();
  ASSERT_TRUE(outcome.ok()) << outcome.output;
  std::size_t last = 0;
  for (const char *line :
       {"[1/4] seed 1, one", "[2/4] seed 1, two", "[3/4] seed 2, one", "[4/4] seed 2, two"}) {
    EXPECT_NE(outcome.output.find(line, last), std::string::npos) << line << "\n" << outcome.output;
    last = outcome.output.find(line);
  }
  const fs::path out = scratch / "results/study/bed";
  EXPECT_TRUE(fs::exists(made_file(out / "beds", "data_", "")));
  const auto ranks = [&](const char *scene) {
    const std::string screen = post::read_text(out / "runs" / scene / "1/screen.txt");
    return screen.find(" on 2 procs for 20 steps") != std::string::npos ? 2 : 1;
  };
  EXPECT_EQ(ranks("1_one"), 1);
  EXPECT_EQ(ranks("2_two"), 2);
  const Values values = values_in(out);
  EXPECT_GT(values.at({"two", 2, "loop"}), 0.0);
  EXPECT_EQ(values.at({"one", 1, "end"}), values.at({"one", 2, "end"}));
  EXPECT_FALSE(run().says("making")); // once
}

TEST(StudiesWithKnownValues, MeetThemInTheirFirstScenes) {
  for (const char *name : {"accuracy", "benchmarks", "extremes", "stability"}) {
    const ScratchStudy study(name);
    const Outcome outcome = study.run();
    ASSERT_TRUE(outcome.ok()) << outcome.output;
    expect_sound_page(study.out(), name == std::string("extremes") ? 0 : 1, "index.html", 0);
    EXPECT_NE(post::read_text(study.out() / "index.html").find(" acceptance criteria hold."),
              std::string::npos);
    EXPECT_GE(post::read_table(study.out() / "data/values.csv").rows(), 3U);
  }
}

// Parts in folders of their own, two of them at the same time and one killed before its end, are one call.
TEST(OwnStudy, PartsTogetherAreOneCall) {
  const Scratch scratch;
  post::write_files({{scratch / "in.own", own_deck}, {scratch / "heights.plan", own_plan}});
  const auto program = [&](const std::vector<std::string> &options) {
    post::Program made;
    made.words = {DRUMLIN_TOOLS, "study", "heights.plan"};
    made.words.insert(made.words.end(), options.begin(), options.end());
    made.folder = scratch.path();
    made.output = scratch / (options.size() > 2 ? "part" + options[3].substr(0, 1) + ".txt" : "all.txt");
    return made;
  };
  const auto run = [&](const std::vector<std::string> &options) { return run_program(program(options)); };
  ASSERT_TRUE(run({"--out", "whole"}).ok());
  const auto part = [&](int number) {
    return program({"--out", "out", "--part", fmt::format("{}/4", number)});
  };
  std::thread other([&] { run_program(part(1)); });
  run_program(part(2));
  other.join();
  post::Program killed = part(3);
  killed.limit = 0.02;
  killed.stop_signal = SIGKILL;
  run_program(killed);
  ASSERT_TRUE(run_program(part(3)).ok());
  // Runs 4 and 8 of the nine are of the part that has not been made.
  const Outcome page =
      run_program(tool_words("study heights.plan --out out --page-only"), {}, scratch.path());
  ASSERT_TRUE(page.ok()) << page.output;
  EXPECT_TRUE(page.says("missing: two, seed 1\nmissing: four, seed 2\n")) << page.output;
  EXPECT_EQ(values_in(scratch / "out").size(), 7U * 2U);
  EXPECT_EQ(values_in(scratch / "out/parts/3_of_4").size(), 2U * 2U);
  ASSERT_TRUE(run({"--out", "out"}).ok());
  const post::Table whole = post::read_table(scratch / "whole/runs.csv"),
                    parts = post::read_table(scratch / "out/runs.csv");
  ASSERT_EQ(parts.rows(), whole.rows());
  for (const std::string &column : whole.header())
    if (column != "cost [s]") { // processor time
      EXPECT_EQ(parts.text(column), whole.text(column)) << column;
    }
  for (const char *wrong : {"0/4", "5/4", "3", "3/", "x/y"})
    EXPECT_TRUE(run({"--out", "out", "--part", wrong})
                    .says(fmt::format("ERROR: drumlin study: --part is '{}'; allowed: K/N, every N-th run, "
                                      "beginning with the K-th: 3/8",
                                      wrong)));
}

// What a deck includes belongs to what the results depend on, and nothing that a call reads is removed by it.
TEST(OwnStudy, ContinuesOnlyWithTheFilesOfTheEarlierCall) {
  const Scratch scratch;
  const fs::path out = scratch / "out";
  std::string plan = own_plan;
  plan.replace(plan.find("in.own"), 6, "out/in.own");
  post::write_files(
      {{scratch / "in.own", "variable seed index 0\nvariable factor index 1\ninclude ${here}/part\n"},
       {scratch / "part", own_deck},
       {scratch / "heights.plan", own_plan},
       {scratch / "inner.plan", plan}});
  const auto run = [&](const char *name, const char *option) {
    return run_program(tool_words("study {} --out out --quick {}", name, option), {}, scratch.path(), 100.0);
  };
  ASSERT_TRUE(run("heights.plan", "--fresh").ok());
  const std::string rows = post::read_text(out / "runs.csv");
  post::write_files({{scratch / "part", std::string(own_deck) + "# more\n"}});
  const Outcome other = run("heights.plan", "--jobs=1");
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(other.says("(its study.txt has 'deck in.own ")) << other.output;
  EXPECT_EQ(post::read_text(out / "runs.csv"), rows);
  post::write_files({{out / "in.own", own_deck}});
  const Outcome inner = run("inner.plan", "--fresh");
  EXPECT_EQ(inner.status, 2);
  EXPECT_TRUE(inner.says("ERROR: drumlin study: --out is 'out'; allowed: another folder than deck '"))
      << inner.output;
  EXPECT_TRUE(fs::exists(out / "in.own"));
  EXPECT_EQ(post::read_text(out / "runs.csv"), rows);
}

// A result of an engine that is killed is not stored.
TEST(OwnStudy, LeavesOutARunWhoseEngineIsKilled) {
  const Scratch scratch;
  post::write_files({{scratch / "in.own", std::string(own_deck) + "if \"${seed} == 2\" then \"shell sh " +
                                              (scratch / "kill").string() + "\"\n"},
                     // shell runs sh, which runs this: the engine is the parent of its parent
                     {scratch / "kill", "kill -9 $(cut -d ' ' -f 4 /proc/$PPID/stat)\n"},
                     {scratch / "heights.plan", own_plan}});
  const Outcome outcome =
      run_program(tool_words("study heights.plan --quick --out out"), {}, scratch.path(), 100.0);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(outcome.says("ERROR: drumlin study: 3 of the runs failed; the page tells which\n"))
      << outcome.output;
  const Values values = values_in(scratch / "out");
  EXPECT_EQ(values.size(), 3U * 2U);
  EXPECT_EQ(values.count({"one", 2, "height"}), 0U);
  EXPECT_NE(post::read_text(scratch / "out/index.html").find("10 (one)"), std::string::npos); // no interval
}

// A column that the deck does not write, and a row of another plan, are told before the other runs are made.
TEST(OwnStudy, StopsAtTheFirstRunWithoutAColumnOfThePlan) {
  const Scratch scratch;
  std::string plan = own_plan;
  plan.replace(plan.find("out.csv height"), 14, "out.csv depth");
  post::write_files({{scratch / "in.own",
                      std::string(own_deck) + "shell echo run >> " + (scratch / "count").string() + "\n"},
                     {scratch / "depths.plan", plan},
                     {scratch / "heights.plan", own_plan}});
  const auto run = [&](const char *name, const char *out) {
    return run_program(tool_words("study {} --out {} --jobs 1", name, out), {}, scratch.path(), 100.0);
  };
  const Outcome outcome = run("depths.plan", "depths");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(std::regex_search(
      outcome.output, std::regex("ERROR: drumlin study: seed 1, one: [^\n]*out.csv, line 1: the header is "
                                 "'time,height'; allowed: one that names 'depth'\n")))
      << outcome.output;
  EXPECT_EQ(post::read_text(scratch / "count"), "run\n");

  ASSERT_TRUE(run("heights.plan", "heights").ok());
  const std::string rows = post::read_text(scratch / "heights/runs.csv");
  const std::string foreign =
      rows.substr(0, rows.find('\n', rows.find('\n') + 1) + 1) + "other,1,height,m,1,0.1\n";
  post::write_files({{scratch / "heights/runs.csv", foreign}, {scratch / "count", ""}});
  const Outcome other = run("heights.plan", "heights");
  EXPECT_EQ(other.status, 1);
  EXPECT_TRUE(other.says("'other,1,height'; allowed: a row of this call")) << other.output;
  EXPECT_EQ(post::read_text(scratch / "count"), "");
  EXPECT_EQ(post::read_text(scratch / "heights/runs.csv"), foreign);
}

TEST(OwnStudy, OfABadPlanWritesNothing) {
  const Scratch scratch;
  post::write_files(
      {{scratch / "in.own", own_deck}, {scratch / "bad.plan", std::string(own_plan) + "seeds 0\n"}});
  const auto expect_refused = [&](const std::vector<std::string> &words, const std::string &message) {
    std::vector<std::string> all = {DRUMLIN_TOOLS, "study"};
    all.insert(all.end(), words.begin(), words.end());
    const Outcome outcome = run_program(all, {}, scratch.path(), 100.0);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.output, "ERROR: drumlin study: " + message + "\n");
    EXPECT_FALSE(fs::exists(scratch / "results"));
  };
  expect_refused({"bad.plan"}, "bad.plan, line 21: seeds is '0'; allowed: a whole number from 1 to 1000");
  post::write_files({{scratch / "own.plan", own_plan}});
  expect_refused({"own.plan", "--balls", "150"},
                 "--balls is '150'; allowed: with a plan of beds in the plane that has stiffness and all of "
                 "r2, r3, m2, m3, k23, c23, Fw, but no place");
}

TEST(BedStudy, ContinuesWhereItWasInterruptedAndABedThatFailsStopsNoOther) {
  const ScratchStudy study("fidelity");
  const Outcome whole = study.run();
  ASSERT_TRUE(whole.ok()) << whole.output;
  const Values values = values_in(study.out());
  ASSERT_EQ(values.size(), 3U * 2U * 5U);
  // The peak force exceeds the weight of the scaled roller: 3000 kg times 150/2500.
  EXPECT_GT(values.at({"complete", 1, "force"}), 180.0 * 9.81);
  EXPECT_NE(values.at({"complete", 1, "force"}), values.at({"complete", 2, "force"}));
  for (const post::Result &row : post::read_points(study.out() / "runs.csv", post::result_rows())) {
    EXPECT_GT(row.cost, 0.01) << row.scene; // four cycles of 150 balls, whatever the machine does besides
    EXPECT_LT(row.cost, 10.0) << row.scene;
  }
  const fs::path beds = study.out() / "beds";
  std::map<fs::path, fs::file_time_type> made;
  for (const fs::directory_entry &entry : fs::directory_iterator(beds))
    made[entry.path()] = entry.last_write_time();
  EXPECT_EQ(made.size(), 6U); // a roller for each run: no scene of these shares its soil

  interrupt(study.out() / "runs.csv");
  fs::remove(study.out() / "index.html");
  const Outcome rest = study.run();
  ASSERT_TRUE(rest.ok()) << rest.output;
  EXPECT_EQ(values_in(study.out()), values);
  for (const auto &[file, time] : made)
    EXPECT_EQ(fs::last_write_time(file), time) << file;
  expect_sound_page(study.out(), 1);

  fs::remove(study.out() / "runs.csv");
  const fs::path bed = made.begin()->first;
  fs::remove(bed);
  fs::create_directory(bed); // no deck takes that for a bed
  const Outcome outcome = study.run();
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(outcome.says(": bed/in.bed: ERROR: drumlin/variable: variable start is ")) << outcome.output;
  EXPECT_EQ(values_in(study.out()).size(), 5U * 5U) << outcome.output;
  EXPECT_NE(post::read_text(study.out() / "index.html").find("Missing: seed "), std::string::npos);
}

// A deck of the other engine makes its own soil and roller, in decks of that engine.
TEST(BedStudy, RunsInBothEngines) {
  if (!post::has_lammps()) GTEST_SKIP() << "built without LAMMPS";
  const Scratch scratch;
  post::write_files({{scratch / "engines.plan", "title    Engines\n"
                                                "quantity force\n"
                                                "balls    60\n"
                                                "width    0.3\n"
                                                "ratio    1e-2\n"
                                                "set      case loose\n"
                                                "set      m2 100\n"
                                                "set      m3 50\n"
                                                "set      r2 0.08\n"
                                                "set      r3 0.05\n"
                                                "set_run  Fw 2000\n"
                                                "set_run  cycles 2\n"
                                                "scene    LIGGGHTS\n"
                                                "deck     bed/in.bed\n"
                                                "scene    LAMMPS\n"
                                                "from     LIGGGHTS\n"
                                                "differs  the other engine\n"
                                                "deck     bed/in.bed.lammps\n"}});
  const auto run = [&](const std::vector<std::string> &environment, const std::string &out) {
    return run_program(tool_words("study engines.plan --out {}", out), environment, scratch.path(), 100.0);
  };
  // Where there is no LAMMPS its scene is left out, which is said first.
  post::write_files({{scratch / "places", "inputs=" + post::places().inputs.string() +
                                              "\nliggghts_plugin=" + post::plugin_library() +
                                              "\nliggghts=" + post::places().liggghts + "\n"}});
  const Outcome without = run({"DRUMLIN_PLACES=" + (scratch / "places").string()}, "liggghts");
  ASSERT_TRUE(without.ok()) << without.output;
  EXPECT_EQ(without.output.rfind("SKIPPED: 1 of 2 scenes: LAMMPS is not set up", 0), 0U) << without.output;
  EXPECT_EQ(values_in(scratch / "liggghts").size(), 1U);

  const Outcome outcome = run({}, "out");
  ASSERT_TRUE(outcome.ok()) << outcome.output;
  const Values values = values_in(scratch / "out");
  ASSERT_EQ(values.size(), 2U);
  for (const auto &[key, force] : values) // the peak force exceeds the weight
    EXPECT_GT(force, 150.0 * 9.81) << std::get<0>(key);
}

// A study of a drive gives the numbers that its decks and `drumlin passes` give when they are run by hand.
TEST(DriveStudy, MeasuresWhatPassesLeave) {
  const Scratch scratch;
  const Variables soil = given("case loose, friction 0.8, rolling 0.45"),
                  roller = given("m2 100, m3 50, r2 0.1, r3 0.05, k23 5e4, c23 500"),
                  drive = given("speed 2, ramp 0.05, margin 0.05, omega 314.1592653589793, Fw 2940, "
                                "steps_per_cycle 1000, samples_per_cycle 100, passes 2, balance 10");
  const auto lines = [](const char *keyword, const Variables &variables) {
    std::string text;
    for (const auto &[name, value] : variables)
      text += fmt::format("{} {} {}\n", keyword, name, value);
    return text;
  };
  post::write_files(
      {{scratch / "drive.plan",
        "title T\nquantity gain - gain passes.csv solid_fraction_2 [-]\n"
        "quantity settlement m last passes.csv settlement [m]\nquantity CMV - mean passes.csv CMV [-]\n"
        "quantity cell N largest way.csv peak_force [N]\n"
        "deck bed/in.drive\nwidth 1\nratio 1\n"
        "layer 0.25 relative_density 1.237\nlayer 0.15 relative_density 0.137\n" +
            lines("set", soil) + lines("set", roller) + "set_placed place -0.3\n" + lines("set_run", drive) +
            "scene a/spot\nspot -0.1 0.1\nset k 1e8,1e8,5e7\n"}});
  const Outcome study =
      run_program(tool_words("study drive.plan --out out --keep"), {}, scratch.path(), 200.0);
  ASSERT_TRUE(study.ok()) << study.output;
  const Values values = values_in(scratch / "out");
  ASSERT_EQ(values.size(), 4U);

  const Outcome balls = run_program(tool_words("bed --width 1 --layer 0.25 --layer 0.15 --relative-density "
                                               "1.237 --relative-density 0.137 --spot -0.1:0.1 --out balls"),
                                    {}, scratch.path(), 100.0);
  ASSERT_TRUE(balls.ok()) << balls.output;
  const auto run = [&](const char *deck, const Variables &more) {
    const Variables all =
        post::joined(post::joined(post::joined(soil, {{"k", "1e8,1e8,5e7"}}), roller), more);
    const Outcome outcome = run_deck(post::input_file(deck), all, scratch.path());
    ASSERT_TRUE(outcome.ok()) << outcome.output;
  };
  run("bed/in.settle", given("balls balls, bed soil, ratio 1"));
  run("bed/in.place", given("bed soil, start roller, ratio 1, place -0.3"));
  run("bed/in.drive", post::joined(drive, given("start roller, out B, place -0.3")));
  const Outcome passes = run_program({DRUMLIN_TOOLS, "passes", "B"}, {}, scratch.path(), 100.0);
  ASSERT_TRUE(passes.ok()) << passes.output;
  EXPECT_EQ(post::read_text(scratch / "out/runs/1_a_spot/1/passes.csv"),
            post::read_text(scratch / "B/passes.csv"));
  const post::Table table = post::read_table(scratch / "B/passes.csv");
  const std::vector<double> density = table.numbers("solid_fraction_2 [-]");
  ASSERT_EQ(density.size(), 3U);
  EXPECT_EQ(values.at({"a/spot", 1, "gain"}), density[2] - density[0]);
  EXPECT_NE(values.at({"a/spot", 1, "gain"}), 0.0);
  EXPECT_EQ(values.at({"a/spot", 1, "settlement"}), table.numbers("settlement [m]")[2]);
  EXPECT_EQ(values.at({"a/spot", 1, "CMV"}), post::number_from_text(table.text("CMV [-]")[2]));
  const std::vector<double> forces = post::read_table(scratch / "B/way.csv").numbers("peak_force [N]");
  EXPECT_EQ(values.at({"a/spot", 1, "cell"}), *std::max_element(forces.begin(), forces.end()));
}

// One seed of each scene: no deck refuses a variable that a plan gives it.
TEST(BedStudy, RunsEverySceneOfTheProjectsPlans) {
  const Scratch scratch;
  for (const char *study : {"fidelity", "friction", "stiffness", "damping", "scatter"}) {
    std::string plan = post::read_text(post::input_file("study") / study / "plan");
    plan = std::regex_replace(plan, std::regex("\nseeds +[0-9]+"), "\nseeds 1");
    plan = std::regex_replace(plan, std::regex("\nset_run +cycles +[0-9]+"), "\nset_run cycles 4");
    post::write_files({{scratch / (std::string(study) + ".plan"), plan}});
    const Outcome outcome = run_program(
        tool_words("study {} --balls 100 --jobs 2", std::string(study) + ".plan"), {}, scratch.path(), 250.0);
    EXPECT_TRUE(outcome.ok()) << outcome.output;
  }
}

// The laws of a scene do the same work, on one rank and on two: they end with the balls at the same height.
TEST(TimingStudy, RunsEverySceneOfItsPlan) {
  const Scratch scratch;
  std::string plan = post::read_text(post::input_file("study/timing/plan"));
  for (const auto &[long_one, short_one] :
       {std::pair{"rounds +[0-9]+", "rounds 1"},
        {"set +steps +[0-9]+", "set steps 50"},
        {"columns=100 layers=1 rows=26 steps=30000", "columns=20 layers=1 rows=6 steps=2000"},
        {"columns=40 layers=40 rows=21 steps=15000", "columns=6 layers=6 rows=5 steps=1000"},
        {"copies_x=4 copies_y=2", "copies_x=2 copies_y=1"}})
    plan = std::regex_replace(plan, std::regex(long_one), short_one);
  post::write_files({{scratch / "timing.plan", plan}});
  const Outcome outcome = run_program({DRUMLIN_TOOLS, "study", "timing.plan"}, {}, scratch.path(), 500.0);
  ASSERT_TRUE(outcome.ok()) << outcome.output;
  const auto family = [](const std::string &scene) { return scene.substr(0, scene.find(':')); };
  std::map<std::string, std::map<std::string, double>> ends;
  for (const auto &[run, value] : values_in(scratch / "results/study/timing"))
    if (std::get<2>(run) == "end") ends[family(std::get<0>(run))][std::get<0>(run)] = value;
  ASSERT_EQ(ends.size(), 5U);
  // Over many jumps of the force rounding grows on the chain. LAMMPS's law has the dashpot of each pair.
  EXPECT_NEAR(ends["chain"]["chain: stock"], ends["chain"]["chain: engine law"], 1e-4);
  EXPECT_NEAR(ends["bed 2500"]["bed 2500: stock"], ends["bed 2500"]["bed 2500: engine law"], 1e-6);
  for (const char *bed : {"bed 2500 with coulomb", "bed 32000", "bed 256000"}) {
    EXPECT_EQ(ends[bed].size(), post::has_lammps() ? 12U : 6U);
    for (const auto &[scene, end] : ends[bed])
      EXPECT_NEAR(end, ends[bed].begin()->second, 1e-5) << scene;
  }
}

// Scenes that differ in the walls alone share soil and roller, and the study of stiffness shares the soil
// under other rollers.
TEST(BedStudy, MakesOneBedForScenesThatShareIt) {
  const ScratchStudy box("box"), stiffness("stiffness");
  const Outcome walls = box.run();
  ASSERT_TRUE(walls.ok()) << walls.output;
  const auto beds = [](const ScratchStudy &study) {
    std::size_t count = 0;
    for (const fs::directory_entry &entry : fs::directory_iterator(study.out() / "beds"))
      count += entry.is_regular_file() ? 1 : 0;
    return count;
  };
  EXPECT_EQ(beds(box), 2U * 2U); // of each seed the soil and one roller
  const Values values = values_in(box.out());
  EXPECT_NE(values.at({"default rigid", 1, "force"}), values.at({"default absorb", 1, "force"}));
  expect_sound_page(box.out(), 3);
  const Outcome amplitudes = stiffness.run();
  ASSERT_TRUE(amplitudes.ok()) << amplitudes.output;
  EXPECT_EQ(values_in(stiffness.out()).size(), 3U * 2U * 7U);
  expect_sound_page(stiffness.out(), 4);
}

} // namespace experiment

namespace studies {

// `drumlin study meter --quick`: the rows against closed forms, and an
// interrupted call that continues to the same result.
namespace meter {

using namespace post;

const MapAxis axis = {"k", 1e6, 200e6, 8, true};

void expect_right(const CoursePoint &point) {
  SCOPED_TRACE(point.value);
  EXPECT_EQ(point.roller, "Axas2020-29Hz");
  const double k = point.value;
  const bool held = point.motion.regime == Regime::continuous_contact;
  ChainParameters p = soil_machine(point.roller).chain;
  p.k = k;
  EXPECT_EQ(held, contact_margin(p) > 0.0);
  if (held) {
    EXPECT_NEAR(point.motion.meter.k_1, k, 1e-9 * k);
    EXPECT_NEAR(point.motion.meter.c_1, p.damping(), 1e-9 * p.damping());
  }
  EXPECT_NEAR(point.exact.k, k, 1e-6 * k);
  EXPECT_NEAR(point.exact.D, p.D, 1e-6);
  EXPECT_NEAR(point.measured.k, k, (held ? 0.3 : 0.02) * k);
  EXPECT_GT(point.E_vib, 0.0);
}

TEST(MeterStudy, RowsAgreeWithOrbitsAndAnInterruptedCallContinues) {
  const ScratchStudy study("meter");
  std::optional<SketchedPictures> sketched{std::in_place};
  well(study.run());
  const fs::path rows = study.out() / "records.csv";
  const CsvSchema<CoursePoint> columns = course_columns(axis, true);
  const std::vector<CoursePoint> points = read_points(rows, columns);
  ASSERT_EQ(points.size(), 8U);
  for (const CoursePoint &point : points)
    expect_right(point);
  EXPECT_EQ(points.front().motion.regime, Regime::continuous_contact);
  EXPECT_EQ(points[4].motion.regime, Regime::partial_uplift);
  EXPECT_EQ(points.back().motion.regime, Regime::period_2);
  const std::string courses = read_text(study.out() / "data/courses.csv");

  interrupt(rows);
  fs::remove(study.out() / "index.html");
  sketched.reset(); // the second page is drawn
  well(study.run());
  EXPECT_EQ(read_points(rows, columns).size(), 8U);
  EXPECT_EQ(read_text(study.out() / "data/courses.csv"), courses);
  expect_sound_page(study.out(), 11);
}

} // namespace meter

// Which failures of a run are its scene's, and which may pass.
namespace decks {

class FaultsOfRuns : public ::testing::Test {
protected:
  FaultsOfRuns() {
    post::PackingOptions packing;
    packing.balls = 60;
    packing.width = 0.4;
    post::write_files(
        {{scratch_ / "balls.data", post::bed_data(packing, 2650.0, post::pack_balls(packing))}});
  }
  /// "scene: WHY" or "may pass: WHY" of in.settle with some other variables.
  std::string fault(Variables variables, double limit = 600.0) const {
    variables = with(variables, given("case loose, balls {}, bed {}", (scratch_ / "balls.data").string(),
                                      (scratch_ / "soil").string()));
    try {
      const post::DeckRun run("bed/in.settle", variables, 1, limit);
      run.must_succeed();
    } catch (const post::SceneFault &fault) {
      return std::string("scene: ") + fault.what();
    } catch (const std::runtime_error &fault) {
      return std::string("may pass: ") + fault.what();
    }
    return "none";
  }

  Scratch scratch_;
};

TEST_F(FaultsOfRuns, AreTheScenesWhereTheEngineSaysSo) {
  EXPECT_EQ(fault({{"settle_limit", "1000"}})
                .rfind("scene: bed/in.settle: ERROR: drumlin/settle: unbalanced ratio is ", 0),
            0U)
      << fault({{"settle_limit", "1000"}});
}

TEST_F(FaultsOfRuns, MayPassWhereTheMachineIsAtFault) {
  const std::string slow = fault({}, 1e-3), missing = fault({{"balls", "none"}});
  EXPECT_EQ(slow, "may pass: bed/in.settle: was stopped at its time limit");
  EXPECT_EQ(missing.rfind("may pass: bed/in.settle: ERROR: ", 0), 0U) << missing;
  // A limit on the size of files stands for a full disk.
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  for (const rlim_t size : {100U, 2000U, 9000U}) {
    rlimit limit = before;
    limit.rlim_cur = size;
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
    const std::string full = fault({});
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
    EXPECT_EQ(full.rfind("may pass: ", 0), 0U) << full;
  }
  ::signal(SIGXFSZ, handler);
}

} // namespace decks

// Calibration on small beds in the engine: it continues where it was interrupted, and its case file makes the
// bed that it measured.
namespace soil {

namespace fs = std::filesystem;

// A bed 0.4 m wide under a small roller.
post::CalibrationTask small_task() {
  post::CalibrationTask task;
  task.vary = {{"k", 2e6, 2e7}};
  task.targets = {{"k", 1e6, 0.05}};
  task.fixed = given("m2 100, m3 50, r2 0.1, r3 0.05, k23 5e4, c23 500, Fw 2940");
  task.seeds = 2;
  task.balls = 100;
  task.cycles = 4;
  return task;
}

TEST(CalibratedBed, ContinuesWhereItWasInterrupted) {
  const Scratch scratch;
  const post::CalibrationTask task = small_task();
  std::vector<std::string> words = tool_words(
      "calibrate --target k=1e6 --vary k=2e6:2e7 --seeds 2 --balls 60 --cycles 4 --evaluations 1 --out out");
  for (const auto &[name, value] : task.fixed)
    words.insert(words.end(), {"--set", fmt::format("{}={}", name, value)});
  const auto calibrate = [&] { return run_program(words, {}, scratch.path(), 200.0); };
  // On two small beds intervals are so wide that k may be found or not.
  const auto expect_answer = [](const Outcome &outcome) {
    EXPECT_TRUE(outcome.says("case.calibrated") ||
                outcome.says("ERROR: drumlin calibrate: --vary is 'k'; allowed: "))
        << outcome.output;
    EXPECT_EQ(outcome.ok(), outcome.says("case.calibrated: copy it to inputs/bed")) << outcome.output;
  };
  expect_answer(calibrate());
  const fs::path rows = scratch / "out/evaluations.csv";
  const std::vector<post::Evaluation> whole = post::read_evaluations(task, rows);
  ASSERT_GE(whole.size(), 3u); // the search's, and one to each side
  for (const post::Evaluation &one : whole)
    EXPECT_EQ(one.failure(), "") << one.number;
  EXPECT_TRUE(fs::is_empty(scratch / "out/beds")); // no beds of points are left

  interrupt(rows);
  fs::remove(scratch / "out/index.html");
  expect_answer(calibrate());
  const std::vector<post::Evaluation> again = post::read_evaluations(task, rows);
  for (const post::Evaluation &one : whole) {
    const auto same = [&one](const post::Evaluation &other) {
      return other.point == one.point && other.seeds[0].values == one.seeds[0].values &&
             other.seeds[1].values == one.seeds[1].values;
    };
    EXPECT_EQ(std::count_if(again.begin(), again.end(), same), 1) << one.number;
  }
  expect_sound_page(scratch / "out", 2);

  words[3] = "k=2e6";
  EXPECT_TRUE(printed(calibrate(),
                      "ERROR: drumlin calibrate: --out is 'out'; allowed: the folder of a calibration "
                      "with the same settings"));
}

TEST(CalibratedBed, IsMadeByTheCaseFile) {
  const Scratch scratch;
  post::CalibrationTask task = small_task();
  task.vary.push_back({"D", 0.1, 0.6});
  task.vary.push_back({"friction", 0.2, 1.0});
  task.targets.push_back({"D", 0.2, 0.05});
  task.targets.push_back({"force", 4e3, 0.05});
  post::Evaluation point;
  point.number = 1;
  point.point = {1e7, 0.25, 0.6};
  fs::create_directories(scratch / "out");
  fs::create_directories(scratch / "run");
  const std::vector<double> measured = post::SoilTests(task, scratch / "out").measure(point, 1);

  fs::copy(post::input_file(""), scratch / "inputs", fs::copy_options::recursive);
  const fs::path decks = scratch / "inputs/bed";
  post::write_files({{decks / "case.small", post::case_text(task, point.point, {"A small bed."})}});
  post::PackingOptions packing;
  packing.balls = 100;
  packing.width = 0.4;
  post::write_files(
      {{scratch / "balls.data", post::bed_data(packing, post::soil_density, post::pack_balls(packing))}});
  const std::string soil = (scratch / "soil").string(), start = (scratch / "start").string();
  const auto run = [&](const char *deck, const Variables &variables) {
    well(run_deck(decks / deck, variables, scratch / "run", 1, 60.0));
  };
  run("in.settle", given("case small, ratio 1, balls {}, bed {}", (scratch / "balls.data").string(), soil));
  run("in.place", given("ratio 1, bed {}, start {}", soil, start));
  run("in.bed", given("start {}, balance 10, cycles 4, Fw 2940", start));
  const std::vector<double> law =
      post::measured({*post::named_quantity("k"), *post::named_quantity("D")}, scratch / "run", 1.0);
  EXPECT_EQ(law[0], measured[0]);
  EXPECT_EQ(law[1], measured[1]);
}

} // namespace soil

} // namespace studies

} // namespace
} // namespace drumlin::test
