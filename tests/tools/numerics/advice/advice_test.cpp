#include "tests/support/tool.h"
#include "advice/bed.h"
#include "advice/steps.h"
#include "engine/deck_run.h"
#include "experiment/plan.h"
#include "support/process.h"
#include "support/resumed.h"
#include "support/usage_error.h"

#include <unistd.h>

namespace drumlin::test {
namespace {

// Which scene of a bed is advised, on invented results, against numbers worked out by hand.
namespace beds {

namespace fs = std::filesystem;

using post::BedAdvice;
using post::BedExperiment;
using post::Result;

// Invented runs of five seeds. add() gives each run of a scene the force of the complete bed of the same
// seed, times a factor of the scene, times a deviation of the seed that the complete bed does not have.
class BedAdviceTest : public ::testing::Test {
protected:
  BedAdviceTest() : temporary_(testing::TempDir(), "bed_advice") {
    post::write_files({{temporary_.path() / "plan",
                        "scaled_to 400\n" + post::read_text(post::input_file("study/fidelity/plan"))}});
  }
  void add(const std::string &scene, double factor, double scatter, double cpu, int seeds = 5) {
    for (int seed = 1; seed <= seeds; ++seed) {
      const double own = factor * (1.0 + scatter * (seed % 2 == 0 ? 1.0 : -2.0 / 3.0));
      rows_.push_back({scene, seed, "force", "N/m", own * 1e5 * (1.0 + 0.1 * (seed - 3)), cpu});
    }
  }
  BedExperiment experiment() const {
    post::write_files({{temporary_.path() / "runs.csv", post::result_rows().text(rows_)}});
    return post::read_bed_experiment(temporary_.path());
  }
  /// Name of the scene that is advised.
  std::string advice(double within) const {
    const BedExperiment all = experiment();
    return post::advise_bed(all, {"force", "force", within}).scene->name;
  }
  void expect_refused(const std::string &message) const {
    const std::string error = error_of([this] { advice(0.1); });
    EXPECT_TRUE(contains(error, message));
    EXPECT_FALSE(contains(error, "\n"));
  }
  post::TemporaryFolder temporary_;
  std::vector<Result> rows_;
};

TEST_F(BedAdviceTest, NamesTheCheapestSceneWithinTheError) {
  add("complete", 1.0, 0.0, 10.0);
  add("k / 10", 1.04, 0.0, 3.0);
  add("k / 100", 0.7, 0.0, 1.0);     // cheaper, but off
  add("large balls", 1.0, 0.2, 0.5); // right in the mean, but the interval is wide
  add("A", 1.0, 0.0, 9.5);           // hardly cheaper than the complete scene
  add("one size", 1.0, 0.0, 0.1, 1); // one seed has no interval
  const BedExperiment all = experiment();
  EXPECT_EQ(all.plan.scenes.front().bed->packing.balls, 400);
  const BedAdvice found = post::advise_bed(all, {"force", "force", 0.1});
  ASSERT_NE(found.scene, nullptr);
  EXPECT_EQ(found.scene->name, "k / 10");
  EXPECT_EQ(found.differs, "k / 10 with 0.32 times the steps");
  EXPECT_NEAR(found.error.mean, 0.04, 1e-12);
  EXPECT_NEAR(found.cost, 0.3, 1e-12);
  EXPECT_EQ(found.seeds, 5U);
  EXPECT_EQ(found.cpu_s, 3.0);
  EXPECT_NEAR(found.scatter, 0.1 * std::sqrt(2.5), 1e-12); // of -2 to 2 tenths
  // 2.179 * 0.1581 / sqrt(12) is 0.0994 (12 degrees of freedom: 13 beds 0.0955; 11 degrees of freedom: 12
  // beds 0.1005)
  EXPECT_EQ(found.beds, 13);
  EXPECT_EQ(advice(0.5), "large balls");
  EXPECT_EQ(advice(0.03), "complete");

  const std::vector<std::string> commands = post::scene_commands(*found.scene);
  ASSERT_EQ(commands.size(), 4U);
  EXPECT_EQ(commands[0], "bed --balls 400 --width 0.8");
  EXPECT_EQ(commands[1].rfind("run inputs/bed/in.settle -var case gravel ", 0), 0U) << commands[1];
  EXPECT_TRUE(contains(commands[1], " -var k 1.6e+07 "));
  EXPECT_TRUE(contains(commands[3], " -var steps_per_cycle 1250"));
  EXPECT_FALSE(contains(commands[3], " -var ratio"));
  EXPECT_EQ(post::scene_words(*found.scene),
            "2 dimensions, 400 discs of 16 to 24 mm radius, box 0.8 m wide, under a drum of 0.14 m radius");
  const std::vector<std::string> layers =
      post::scene_commands(post::read_plan(post::input_file("study/fidelity/plan")).scene("layers"));
  EXPECT_EQ(layers[0], "bed --layer 1.24 --layer 0.7 --width 2");
  const std::string spot = post::scene_commands(
      post::read_plan(post::input_file("study/drive/plan")).scene("soft spot of 1 m"))[0];
  EXPECT_EQ(
      spot.rfind("bed --layer 0.4 --layer 0.3 --relative-density 1.237 --relative-density 0.137 --spot ", 0),
      0U)
      << spot;
}

// The complete beds settle by -2 to 2 mm per cycle: no error relative to their mean exists, but one in mm
// does.
TEST_F(BedAdviceTest, CountsErrorsOfTheSettlementInMillimetresIfAsked) {
  for (const char *scene : {"complete", "k / 10", "k / 100"})
    for (int seed = 1; seed <= 5; ++seed) {
      const double more = std::string(scene) == "k / 10"    ? 0.5e-3
                          : std::string(scene) == "k / 100" ? 3e-3
                                                            : 0.0;
      rows_.push_back(
          {scene, seed, "settlement", "m", 1e-3 * (seed - 3) + more, more > 0.0 ? 1e-3 / more : 10.0});
    }
  const BedExperiment all = experiment();
  const BedAdvice found = post::advise_bed(all, {"settlement", "settlement", 1e-3, true});
  EXPECT_EQ(found.scene->name, "k / 10");
  EXPECT_NEAR(found.error.mean, 0.5e-3, 1e-12);
  EXPECT_NEAR(found.scatter, 1e-3 * std::sqrt(2.5), 1e-12);
  // A relative error of a mean of zero:
  EXPECT_TRUE(contains(error_of([&] {
                         post::advise_bed(all, {"settlement", "settlement", 0.1});
                       }),
                       "or --within in mm per cycle, as 2mm"));
}

TEST_F(BedAdviceTest, RefusesWhatTheTableDoesNotAnswer) {
  expect_refused(
      "the table of results is '0 scenes'; allowed: one with two seeds or more of a scene and of the");
  add("A", 1.0, 0.0, 9.0);
  expect_refused(
      "the table of results is '1 scenes'; allowed: one with two seeds or more of a scene and of the");
  add("complete", 1.0, 0.0, 10.0, 1);
  expect_refused("allowed: one with two seeds or more of a scene and of the complete one");
  rows_.back().unit = "kN/m";
  expect_refused("runs.csv, column 'unit' is 'kN/m'; allowed: N/m, that of force");
  rows_.clear();
  add("complete", 1.0, 0.0, 10.0);
  add("k / 10", 1.3, 0.0, 3.0); // 30 % in the mean, with a half width of 2.776 * 0.3 * 0.158 / sqrt(5)
  const BedExperiment all = experiment();
  const BedAdvice found = post::advise_bed(all, {"force", "force", 0.1});
  EXPECT_EQ(found.scene, &all.plan.scenes.front());
  EXPECT_EQ(found.closest, "k / 10");
  EXPECT_NEAR(found.least_error, 0.3589, 1e-4);
  for (Result &row : rows_) // forces of complete beds from -2e4 to 2e4: their mean is zero
    if (row.quantity == "force") row.value -= 1e5;
  expect_refused(
      "--question is 'force'; allowed: a result whose mean over the complete beds differs from zero");
}

// Forces of 80 to 120 kN/m, +- 10 % and +- 0, and of +- 20 kN/m about zero.
TEST_F(BedAdviceTest, CountsTheBedsOfEachScene) {
  add("complete", 1.0, 0.0, 10.0);
  add("k / 10", 1.0, 0.0, 3.0);
  for (int seed = 1; seed <= 4; ++seed)
    rows_.push_back({"A", seed, "force", "N/m", 2e5, 9.0});
  for (int seed = 1; seed <= 5; ++seed)
    rows_.push_back({"history", seed, "force", "N/m", 1e4 * (seed - 3), 1.0});
  add("one size", 1.0, 0.0, 0.1, 1);
  const BedExperiment all = experiment();
  const std::vector<post::SceneScatter> found = post::scatter_of_scenes(all, {"force", "force", 0.1});
  ASSERT_EQ(found.size(), 4U); // one seed has no scatter
  EXPECT_EQ(found[0].scene->name, "A");
  EXPECT_EQ(found[0].seeds, 4U);
  EXPECT_EQ(found[0].beds, 2);
  EXPECT_EQ(found[0].total_s(), 18.0);
  EXPECT_EQ(found[1].scene->name, "k / 10");
  EXPECT_NEAR(found[1].mean.mean, 1e5, 1e-6);
  EXPECT_NEAR(found[1].scatter.estimate, 1e4 * std::sqrt(2.5), 1e-6);
  EXPECT_EQ(found[1].beds, 13); // as of the complete scene, see above
  EXPECT_EQ(found[1].total_s(), 39.0);
  // The interval of the scatter is 0.599 to 2.874 times it (chi squared of 4 degrees of freedom: 11.143 and
  // 0.484): 9.47 % gives 2.447 * 0.0947 / sqrt(7) = 0.0876 and 2.571 * 0.0947 / sqrt(6) = 0.0994; 45.4 %
  // gives 1.990 * 0.454 / sqrt(82) = 0.0999 and 1.990 * 0.454 / sqrt(81) = 0.1004.
  EXPECT_EQ(found[1].least_beds, 6);
  EXPECT_EQ(found[1].most_beds, 82);
  EXPECT_EQ(found[2].scene->name, "complete");
  EXPECT_EQ(found[3].scene->name, "history"); // no error relative to a mean of zero
  EXPECT_EQ(found[3].beds, 0);
  const std::vector<post::SceneScatter> absolute =
      post::scatter_of_scenes(all, {"force", "force", 1e4, true});
  EXPECT_EQ(absolute[0].scene->name, "history");
  EXPECT_EQ(absolute[0].beds, 13);
}

// A layer of sizes of its own is that of the command which the advice prints, bit for bit.
TEST_F(BedAdviceTest, NamesTheCommandsOfLayersOfOtherSizes) {
  post::write_files({{temporary_.path() / "own.plan",
                      "title T\nquantity force\ndeck bed/in.bed\nballs 50\nwidth 0.6\nscene a\n"
                      "layer 0.2\nlayer 0.1 20-30\nradius_min 0.02\nradius_max 0.03\n"}});
  const post::Plan plan = post::read_plan(temporary_.path() / "own.plan");
  const post::Scene &scene = plan.scenes.front();
  const std::string command = post::scene_commands(scene)[0];
  EXPECT_EQ(command, "bed --layer 0.2 --layer 0.1:20-30:20 --width 0.6 --radius-min 0.02 --radius-max 0.03");
  std::vector<std::string> words = {DRUMLIN_TOOLS};
  std::istringstream in(command);
  for (std::string word; in >> word;)
    words.push_back(word);
  const Outcome outcome = run_program(words, {}, temporary_.path(), 100.0);
  ASSERT_TRUE(outcome.ok()) << outcome.output;
  EXPECT_EQ(post::read_text(temporary_.path() / "results/bed/balls.data"),
            post::bed_data(scene.bed->layers, post::soil_density, post::pack_layers(scene.bed->layers)));
}

// The copy of the plan that its study writes.
TEST_F(BedAdviceTest, IsGivenOnDecksOfOnesOwn) {
  const fs::path own = temporary_.path() / "my decks";
  fs::create_directory(own);
  std::string plan = post::read_text(post::input_file("study/fidelity/plan"));
  plan.replace(plan.find("bed/in.bed"), 10, "in.bed");
  post::write_files(
      {{own / "in.settle", ""}, {own / "in.place", ""}, {own / "in.bed", ""}, {own / "plan", plan}});
  post::write_files({{temporary_.path() / "plan", post::read_plan(own / "plan").copy()}});
  add("complete", 1.0, 0.0, 10.0);
  add("k / 10", 1.04, 0.0, 3.0);
  const BedExperiment all = experiment();
  const BedAdvice found = post::advise_bed(all, {"force", "force", 0.1});
  EXPECT_EQ(found.scene->name, "k / 10");
  EXPECT_EQ(
      post::scene_commands(*found.scene)[1].rfind("run '" + (own / "in.settle").string() + "' -var ", 0), 0U);
}

TEST_F(BedAdviceTest, NeedsAPlanOfBedsAndItsResults) {
  EXPECT_THROW(post::read_bed_experiment(temporary_.path()), post::UsageError); // without results
  post::write_files(
      {{temporary_.path() / "in.own", ""},
       {temporary_.path() / "plan", "title T\nquantity gap m last out.csv gap\ndeck in.own\nscene a\n"}});
  add("a", 1.0, 0.0, 1.0);
  EXPECT_THROW(experiment(), post::UsageError);
}

} // namespace beds

// Advice from invented curves for which the answer is known, and the command as a user calls it.
namespace steps {

using namespace post;
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

// The plan of accuracy runs random chains with the number of steps that `advise` gives for a wanted error:
// with other numbers it would not test the advice.
TEST(Advice, IsWhatThePlanOfAccuracyRuns) {
  const std::vector<ChainPoint> known = read_points(input_file("study/accuracy/chain.csv"), chain_points());
  std::size_t chains = 0;
  for (const Scene &scene : read_plan(input_file("study/accuracy/plan")).scenes) {
    if (scene.at.count("target_error") == 0) continue;
    AdviceRequest request;
    for (const ChainNumber &number : chain_numbers)
      request.parameters.*number.value = number_from_text(value_of(scene, number.name));
    request.parameters.transition = transition_from_name(value_of(scene, "transition"));
    request.stepping = value_of(scene, "stepping");
    request.error = scene.at.at("target_error");
    EXPECT_EQ(std::to_string(advise(request, known).steps_per_cycle), value_of(scene, "steps_per_cycle"))
        << scene.name;
    ++chains;
  }
  EXPECT_EQ(chains, 36U);
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
  const auto point = [](double k, double target, double error) {
    ScalingPoint one{"second", target, {}, 200, error};
    one.parameters.k = k;
    return one;
  };
  const std::string text =
      scaling_summary({point(1e7, 1e-3, 5e-4), point(1e7, 1e-4, 3e-4), point(4e7, 1e-3, 1e-5)});
  EXPECT_TRUE(contains(text, {"2 other parameter sets: 2 of 3", "had 3 times"}));
  EXPECT_EQ(scaling_summary({}).find("not tested"), 0u);
}

class AdviseCommand : public test::Tool {
protected:
  Outcome run(const std::vector<std::string> &words) const { return drumlin("advise", words); }
};

TEST_F(AdviseCommand, AnswersFromTheStudyThatComesWithTheProject) {
  const Outcome outcome = run(words_of("--error 1e-3 --case II --transition B"));
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_EQ(outcome.output.find("200 steps per cycle"), 0u) << outcome.output;
  const Outcome other = run(words_of("--error 1e-3 --D 0.4 --stepping stock --measure force"));
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
    return run(words_of("--bed --from . --question settlement --within {}", within));
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
                        "bed --layer 0.4 --layer 0.3 --relative-density 1.237 --relative-density 0.137"}));
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

} // namespace steps

} // namespace
} // namespace drumlin::test
