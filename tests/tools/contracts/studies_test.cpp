#include "bed/packing.h"
#include "calibration/evaluations.h"
#include "calibration/soil_tests.h"
#include "engine/deck_run.h"
#include "experiment/quantity.h"
#include "experiment/scene.h"
#include "map/course.h"
#include "map/meter_study.h"
#include "support/csv.h"
#include "support/files.h"
#include "support/resumed.h"

#include "tests/support/checks.h"
#include "tests/support/page.h"
#include "tests/support/scratch_study.h"
#include "tests/support/tool.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <sys/resource.h>

namespace drumlin::test {
namespace {

// `drumlin study meter --quick`: the rows against closed forms, and an
// interrupted call that continues to the same result.
namespace meter {

namespace fs = std::filesystem;
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
    variables.insert(variables.end(), {{"case", "loose"},
                                       {"balls", (scratch_ / "balls.data").string()},
                                       {"bed", (scratch_ / "soil").string()}});
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

} // namespace soil

} // namespace
} // namespace drumlin::test
