// `drumlin study accuracy --quick`: its results meet the acceptance criteria, and an interrupted call
// continues to the same result.
#include "experiment/study.h"
#include "lab/accuracy/results.h"
#include "tests/support/page.h"
#include "tests/support/scratch_study.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

namespace drumlin::test {
namespace {

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

} // namespace
} // namespace drumlin::test
