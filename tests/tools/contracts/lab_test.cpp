#include "engine/engine_run.h"
#include "experiment/study.h"
#include "lab/accuracy/results.h"
#include "lab/timing/results.h"

#include "tests/support/checks.h"
#include "tests/support/page.h"
#include "tests/support/scratch_study.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <vector>

namespace drumlin::test {
namespace {

// `drumlin study accuracy --quick`: its results meet the acceptance criteria, and an interrupted call
// continues to the same result.
namespace accuracy {

namespace fs = std::filesystem;
using post::Transition;

/// The errors of each point, which unlike the times do not depend on the load of the machine.
std::map<std::string, double> errors_of(const fs::path &out) {
  std::map<std::string, double> errors;
  for (const post::ChainPoint &p : post::read_points(out / "chain.csv", post::chain_points())) {
    const std::string point = fmt::format("{} {} {} {} ", p.chain_case, post::transition_name(p.transition),
                                          p.stepping, p.steps_per_cycle);
    errors[point + "velocity"] = p.errors.velocity;
    if (p.stepping == "reference") continue;
    errors[point + "force"] = p.errors.force;
    errors[point + "acceleration"] = p.errors.acceleration;
    errors[point + "events"] = p.errors.event_time_s;
    errors[point + "energy"] = p.errors.energy;
  }
  for (const post::ImpactPoint &p : post::read_points(out / "impacts.csv", post::impact_points()))
    errors[fmt::format("{} {} {} {}", post::transition_name(p.transition), p.damping_ratio, p.stepping,
                       p.steps_per_contact)] = p.errors.worst;
  for (const post::ScalingPoint &p : post::read_points(out / "scaling.csv", post::scaling_points()))
    errors[fmt::format("{} {} {} {}", p.set, p.stepping, p.target, p.steps_per_cycle)] = p.error;
  return errors;
}

TEST(AccuracyStudy, ContinuesWhereItWasInterrupted) {
  const ScratchStudy study("accuracy");
  const fs::path out = study.out();
  const post::Outcome whole = study.run();
  ASSERT_TRUE(whole.ok()) << whole.output;
  const std::map<std::string, double> errors = errors_of(out);
  EXPECT_EQ(post::read_points(out / "chain.csv", post::chain_points()).size(), 15u);
  EXPECT_EQ(post::read_points(out / "impacts.csv", post::impact_points()).size(), 12u);
  EXPECT_EQ(post::read_points(out / "scaling.csv", post::scaling_points()).size(), 1u);
  for (const char *file : {"chain.csv", "impacts.csv", "scaling.csv"})
    interrupt(out / file);
  fs::remove(out / "index.html");
  const post::Outcome rest = study.run();
  ASSERT_TRUE(rest.ok()) << rest.output;
  EXPECT_LT(std::count(rest.output.begin(), rest.output.end(), '\n'), 20) << "nothing is measured twice";
  EXPECT_EQ(errors_of(out), errors);

  // What was measured is within the acceptance criteria, and the law of the engine is the plugin's with stock
  // stepping.
  for (const Transition transition : {Transition::A, Transition::B}) {
    const auto at_400 = [&](const char *stepping, auto error) {
      for (const post::ErrorPoint &point : post::chain_curve(
               post::read_points(out / "chain.csv", post::chain_points()), "II", transition, stepping, error))
        if (point.steps == 400) return point.error;
      return std::nan("");
    };
    EXPECT_LT(at_400("second", &post::ChainErrors::velocity), 3e-4);
    EXPECT_LT(at_400("second", &post::ChainErrors::force), 1e-3);
    EXPECT_LT(at_400("second", &post::ChainErrors::acceleration), 1e-3);
    EXPECT_LT(at_400("second", &post::ChainErrors::event_time_s), 0.05 * 0.05 / 400);
    EXPECT_GT(at_400("stock", &post::ChainErrors::velocity), 3e-3);
    EXPECT_LT(at_400("stock", &post::ChainErrors::velocity), 3e-2);
    if (transition == Transition::B) {
      EXPECT_NEAR(at_400("reference", &post::ChainErrors::velocity),
                  at_400("stock", &post::ChainErrors::velocity), 1e-2);
    }
    const auto impacts = post::impact_curve(post::read_points(out / "impacts.csv", post::impact_points()),
                                            transition, 0.5, "second", &post::ReboundErrors::worst);
    ASSERT_EQ(impacts.size(), 3u);
    EXPECT_LT(impacts[1].error, 1.5e-4);
    EXPECT_NEAR(impacts[0].error / impacts[2].error, 16, 4);
  }
  for (const post::ScalingPoint &point : post::read_points(out / "scaling.csv", post::scaling_points()))
    EXPECT_LT(point.error, point.target);

  expect_sound_page(out, 6);
}

} // namespace accuracy

// `drumlin study timing --quick`: every variant runs, each law on one rank and on two, those that compute the
// same end with the balls at the same positions, and an interrupted call measures what is missing and nothing
// twice. Times are not judged.
namespace timing {

namespace fs = std::filesystem;

TEST(TimingStudy, ContinuesWhereItWasInterrupted) {
  const ScratchStudy study("timing");
  const post::Outcome whole = study.run();
  ASSERT_TRUE(whole.ok()) << whole.output;
  const fs::path rows = study.out() / "runs.csv";
  const std::vector<post::TimedRun> runs = post::read_timed_runs(rows);
  // Nine variants of the chain, eleven of the parts of a bed, three laws of each engine on three beds and two
  // numbers of ranks.
  const std::size_t count = 9 + 11 + 18 + (post::has_lammps() ? 18 : 0);
  ASSERT_EQ(runs.size(), count);
  for (const post::TimedRun &run : runs)
    EXPECT_GT(run.peak_bytes, 1e6) << run.scene << ", " << run.variant; // no process of the engine is smaller
  const fs::path bed = made_file(study.out(), "bed_100_", ".data");
  const fs::path copies = made_file(study.out(), "bed_288_", ".data");
  const auto made = fs::last_write_time(bed), copied = fs::last_write_time(copies);

  interrupt(rows);
  fs::remove(study.out() / "index.html");
  const post::Outcome rest = study.run();
  ASSERT_TRUE(rest.ok()) << rest.output;
  EXPECT_EQ(fs::last_write_time(bed), made) << "the bed is settled once";
  EXPECT_EQ(fs::last_write_time(copies), copied) << "the copies are made once";
  const std::vector<post::TimedRun> again = post::read_timed_runs(rows);
  ASSERT_EQ(again.size(), count);
  std::size_t kept = 0;
  for (const post::TimedRun &run : runs) {
    const auto same = [&run](const post::TimedRun &other) {
      return other.scene == run.scene && other.variant == run.variant && other.ranks == run.ranks;
    };
    ASSERT_EQ(std::count_if(again.begin(), again.end(), same), 1) << run.scene << ", " << run.variant;
    const post::TimedRun &other = *std::find_if(again.begin(), again.end(), same);
    EXPECT_NEAR(other.place, run.place, 1e-6) << "the same work: " << run.variant;
    if (other.loop_s == run.loop_s) ++kept;
  }
  EXPECT_EQ(kept, count / 2 - 1) << "every second row but the last, cut one is kept";
  expect_sound_page(study.out(), 2);
}

TEST(TimingStudy, RefusesAPathThatTheEngineWouldSplitAndTellsOfItsOldNames) {
  const ScratchStudy study("timing");
  const fs::path spaced = study.out().parent_path() / "two words";
  const post::Outcome outcome = post::run_program(
      {DRUMLIN_TOOLS, "study", "timing", "--quick", "--out", spaced.string()}, {}, fs::temp_directory_path());
  EXPECT_EQ(outcome.status, 2) << outcome.output;
  EXPECT_TRUE(outcome.says("two words") && outcome.says("allowed: a path without spaces")) << outcome.output;
  for (const char *name : {"cost", "speed"}) {
    const post::Outcome old =
        post::run_program({DRUMLIN_TOOLS, "study", name}, {}, fs::temp_directory_path());
    EXPECT_EQ(old.status, 2) << old.output;
    EXPECT_TRUE(printed(old, "allowed: timing"));
  }
}

} // namespace timing

} // namespace
} // namespace drumlin::test
