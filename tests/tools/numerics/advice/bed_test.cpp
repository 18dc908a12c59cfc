// Which scene of a bed is advised, on invented results, against numbers worked out by hand.
#include "advice/bed.h"

#include "engine/deck_run.h"
#include "support/files.h"
#include "support/usage_error.h"
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

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
      spot.rfind("bed --layer 0.4 --layer 0.3 --relative-density 0.9 --relative-density 0.1 --spot ", 0), 0U)
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

} // namespace
} // namespace drumlin::test
