// Calibration on small beds in the engine: it continues where it was interrupted, and its case file makes the
// bed that it measured.
#include "calibration/evaluations.h"
#include "calibration/soil_tests.h"
#include "engine/deck_run.h"
#include "experiment/quantity.h"
#include "experiment/scene.h"
#include "support/csv.h"
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"
#include "tests/support/page.h"
#include "tests/support/scratch_study.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

// A bed 0.4 m wide under a small roller.
post::CalibrationTask small_task() {
  post::CalibrationTask task;
  task.vary = {{"k", 2e6, 2e7}};
  task.targets = {{"k", 1e6, 0.05}};
  task.fixed = {{"m2", "100"},  {"m3", "50"},   {"r2", "0.1"}, {"r3", "0.05"},
                {"k23", "5e4"}, {"c23", "500"}, {"Fw", "2940"}};
  task.seeds = 2;
  task.balls = 100;
  task.cycles = 4;
  return task;
}

TEST(CalibratedBed, ContinuesWhereItWasInterrupted) {
  const Scratch scratch;
  const post::CalibrationTask task = small_task();
  std::vector<std::string> words = {
      DRUMLIN_TOOLS, "calibrate", "--target", "k=1e6", "--vary",        "k=2e6:2e7", "--seeds", "2",
      "--balls",     "60",        "--cycles", "4",     "--evaluations", "1",         "--out",   "out"};
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
  run("in.settle",
      {{"case", "small"}, {"ratio", "1"}, {"balls", (scratch / "balls.data").string()}, {"bed", soil}});
  run("in.place", {{"ratio", "1"}, {"bed", soil}, {"start", start}});
  run("in.bed", {{"start", start}, {"balance", "10"}, {"cycles", "4"}, {"Fw", "2940"}});
  const std::vector<double> law =
      post::measured({*post::named_quantity("k"), *post::named_quantity("D")}, scratch / "run", 1.0);
  EXPECT_EQ(law[0], measured[0]);
  EXPECT_EQ(law[1], measured[1]);
}

} // namespace
} // namespace drumlin::test
