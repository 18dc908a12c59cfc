// Advice from invented curves for which the answer is known, and the command as a user calls it.
#include "advice/steps.h"

#include "engine/deck_run.h"
#include "runs/chain_files.h"
#include "support/files.h"
#include "support/process.h"
#include "support/usage_error.h"
#include "tests/support/checks.h"
#include "tests/support/lines.h"
#include "tests/support/tool.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace drumlin::post {
namespace {

using namespace test;

/// Errors (100/N)^order for all cases, both transitions and steppings.
std::vector<ChainPoint> power_laws() {
  std::vector<ChainPoint> points;
  for (const char *name : {"I", "II", "III", "IV"})
    for (const Transition transition : {Transition::A, Transition::B})
      for (const auto &[stepping, order] : {std::pair{"second", 2}, std::pair{"stock", 1}})
        for (int steps = 50; steps <= 12800; steps *= 2) {
          ChainPoint point{name, transition, stepping, steps, {}};
          point.errors.velocity = std::pow(100.0 / steps, order);
          point.errors.force = 4.0 * point.errors.velocity;
          point.errors.loop_s = accuracy_cycles * steps * 1e-6;
          points.push_back(point);
        }
  return points;
}

/// Chains that are all alike.
double even(const ChainParameters &) { return 1.0; }

ChainParameters other_chain(Transition transition) {
  ChainParameters p = table1_case("II", transition);
  p.k = 7e7;
  p.Fw = 5e4;
  return p;
}

TEST(Advice, ForAMeasuredChainComesFromItsOwnCurve) {
  AdviceRequest request;
  request.parameters = table1_case("III", Transition::A);
  request.error = 1e-2; // 1000 steps by the power law, of the measured ones 1600
  const StepAdvice advice = advise(request, power_laws());
  EXPECT_TRUE(advice.measured);
  EXPECT_EQ(advice.from, "III");
  EXPECT_EQ(advice.steps_per_cycle, 1600);
  EXPECT_NEAR(advice.seconds_per_step, 1e-6, 1e-12);
  request.measure = ErrorMeasure::force;
  EXPECT_EQ(advise(request, power_laws()).steps_per_cycle, 3200);
}

TEST(Advice, ForOtherChainsHasAMargin) {
  AdviceRequest request;
  request.parameters = table1_case("II", Transition::B);
  request.parameters.Fw *= 1.0 + 1e-9; // nearly the measured chain, but not measured
  request.error = 1e-4;
  const StepAdvice advice = advise(request, power_laws(), even);
  EXPECT_FALSE(advice.measured);
  // By the power law 10^4, scaled from a case whose fastest time is that of the excitation.
  const ChainParameters &p = request.parameters;
  EXPECT_NEAR(advice.steps_per_cycle, scaling_margin * 1e4 * std::sqrt(p.k / p.m2) / p.omega,
              advised_multiple);
}

TEST(Advice, GoesWithTheSensitivity) {
  AdviceRequest request;
  request.parameters = other_chain(Transition::B);
  request.error = 1e-4;
  const auto steps = [&](double factor) {
    return advise(request, power_laws(),
                  [factor](const ChainParameters &p) { return p.Fw == 5e4 ? factor : 1.0; })
        .steps_per_cycle;
  };
  EXPECT_NEAR(steps(100.0), 10 * steps(1.0), 10 * advised_multiple);
  EXPECT_THROW(steps(1.01 * most_sensitive), UsageError);
  EXPECT_THROW(steps(std::numeric_limits<double>::quiet_NaN()), UsageError);
}

TEST(Advice, NeverFallsWhenTheErrorFalls) {
  for (const ChainParameters &p : {table1_case("II", Transition::B), other_chain(Transition::A)})
    for (const char *stepping : {"second", "stock"}) {
      int last = 0;
      for (const double error : {0.9, 0.2, 0.04, 0.03, 1e-2, 1e-3, 3e-4, 1e-4}) {
        const int steps =
            advise({p, stepping, ErrorMeasure::velocity, error}, power_laws(), even).steps_per_cycle;
        EXPECT_GE(steps, last) << stepping << " " << error;
        EXPECT_EQ(steps % advised_multiple, 0);
        last = steps;
      }
    }
}

TEST(Advice, NeverStepsBeyondTheStabilityLimit) {
  for (const char *stepping : {"second", "stock"})
    for (const double k : {1e6, 1e10, 1e12})
      for (const double D : {0.0, 2.0, 50.0}) {
        ChainParameters p = other_chain(Transition::B);
        p.k = k;
        p.D = D;
        const double steps =
            advise({p, stepping, ErrorMeasure::velocity, 0.9}, power_laws(), even).steps_per_cycle;
        EXPECT_GE(steps, stability_margin * critical_steps(p, stepping)) << stepping << " " << k << " " << D;
      }
}

TEST(CriticalSteps, AreTheClosedFormForAContactAlone) {
  ChainParameters p = table1_case("IV", Transition::B);
  p.k23 = 1e-3;
  p.c23 = 0.0;
  const double w0 = std::sqrt(p.k / p.m2);
  EXPECT_NEAR(critical_steps(p, "second"), p.period() * w0 / 2.0, 1e-6);
  EXPECT_NEAR(critical_steps(p, "stock"), p.period() * w0 / (2.0 * (std::sqrt(1.0 + p.D * p.D) - p.D)), 1e-4);
}

TEST(CriticalSteps, KnowTheBond) {
  ChainParameters p = table1_case("II", Transition::B);
  p.k = 1e3; // the bond is the stiff one: a free pair of effective mass m2 m3 / (m2 + m3)
  const double w = std::sqrt(p.k23 * (p.m2 + p.m3) / (p.m2 * p.m3));
  EXPECT_NEAR(critical_steps(p, "second"), p.period() * w / 2.0, 1e-3);
}

// The steady state of a linear chain changes by about the same relative amount as its parameters.
TEST(Sensitivity, OfALinearChainIsOfTheOrderOfOne) {
  const double s = sensitivity(table1_case("I", Transition::A));
  EXPECT_GT(s, 0.3);
  EXPECT_LT(s, 3.0);
}

TEST(ScalingSummary, CountsAndNamesTheWorst) {
  const auto point = [](int set, double target, double error) {
    return ScalingPoint{set, "second", target, {}, 200, error};
  };
  const std::string text =
      scaling_summary({point(1, 1e-3, 5e-4), point(1, 1e-4, 3e-4), point(4, 1e-3, 1e-5)});
  EXPECT_TRUE(contains(text, {"2 other parameter sets: 2 of 3", "had 3 times"}));
  EXPECT_EQ(scaling_summary({}).find("not tested"), 0u);
}

class AdviseCommand : public test::Tool {
protected:
  Outcome run(const std::vector<std::string> &words) const { return drumlin("advise", words); }
};

TEST_F(AdviseCommand, AnswersFromTheStudyThatComesWithTheProject) {
  const Outcome outcome = run({"--error", "1e-3", "--case", "II", "--transition", "B"});
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_EQ(outcome.output.find("200 steps per cycle"), 0u) << outcome.output;
  const Outcome other = run({"--error", "1e-3", "--D", "0.4", "--stepping", "stock", "--measure", "force"});
  EXPECT_EQ(other.status, 0) << other.output;
  EXPECT_TRUE(printed(other, {"tested on 12 other parameter sets", "-var D 0.4 -var stepping stock"}));
  EXPECT_FALSE(other.says("outside")) << other.output;
  EXPECT_TRUE(printed(run({"--error", "1e-3", "--D", "20"}), "outside    D = 20, tested from "));
}

// The soil settles by -2 to 2 mm per cycle in the complete scene, and by 0.5 mm more with k / 10.
TEST_F(AdviseCommand, TakesTheErrorOfASettlementInMillimetres) {
  std::string rows = "scene,seed,quantity,unit,value,cost [s]\n";
  for (int seed = 1; seed <= 5; ++seed) {
    rows += fmt::format("complete,{},settlement,m,{},10\n", seed, 1e-3 * (seed - 3));
    rows += fmt::format("k / 10,{},settlement,m,{},3\n", seed, 1e-3 * (seed - 2.5));
  }
  write_files({{folder_ / "plan", "scaled_to 400\n" + read_text(input_file("study/fidelity/plan"))},
               {folder_ / "runs.csv", rows}});
  const auto ask = [this](const std::string &within) {
    return run({"--bed", "--from", ".", "--question", "settlement", "--within", within});
  };
  const Outcome wide = ask("0.6mm"), narrow = ask("0.4mm");
  EXPECT_EQ(wide.output.find("k / 10: "), 0u) << wide.output;
  EXPECT_TRUE(printed(wide, {"within 0.6 mm", "error      +0.5 +- 0.0 mm against the complete scene",
                             "differs from another by 1.6 mm"}));
  // One bed differs by 1.58 mm, with the interval 0.947 to 4.54 mm (chi squared 11.14 and 0.484): 2.045
  // * 1.58 / sqrt(30) = 0.590 and 2.048 * 1.58 / sqrt(29) = 0.601; 2.179 * 0.947 / sqrt(13) = 0.572 and 2.201
  // * 0.947 / sqrt(12) = 0.602; (1.971 * 4.54 / 0.6)^2 = 222.6.
  EXPECT_TRUE(printed(wide, {"k / 10: 30 (13 to 223) x 3 s = 90 s; 0.5 +- 2.0 mm, one bed +- 1.6 (5 seeds)",
                             "complete: 30 (13 to 223) x 10 s = 300 s;"}));
  EXPECT_EQ(narrow.output.find("complete: "), 0u) << narrow.output;
  EXPECT_TRUE(printed(narrow, "'k / 10' keeps to 0.5 mm"));
}

// The study of drives that comes with the project: five beds of its first scene gain 0.033 +- 0.016.
TEST_F(AdviseCommand, TellsHowManyBedsTheGainOfDensityNeeds) {
  const Outcome outcome = run({"--bed", "--question", "density", "--within", "20%"});
  EXPECT_TRUE(
      printed(outcome, {"for        lift_gain within 20 %", "0.033 +- 0.016 -, one bed +- 0.013 (5 seeds)",
                        "bed --layer 0.4 --layer 0.3 --relative-density 0.9 --relative-density 0.1"}));
  EXPECT_FALSE(outcome.says("for  cycles"));
}

TEST_F(AdviseCommand, RefusesACurveFileThatItCannotRead) {
  std::filesystem::create_directories(folder_ / "mine");
  write_files({{folder_ / "mine" / "chain.csv", "case,steps\nI,50\n"}});
  const Outcome outcome = run({"--from", "mine"});
  EXPECT_NE(outcome.status, 0);
  EXPECT_TRUE(printed(outcome, "chain.csv"));
  EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
}

} // namespace
} // namespace drumlin::post
