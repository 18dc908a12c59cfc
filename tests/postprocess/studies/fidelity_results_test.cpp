// The effects that the fidelity study computes, against numbers worked out by hand.
#include "studies/fidelity/advice.h"
#include "studies/fidelity/results.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

using post::FidelityRun;

// Four cycles after the start; what counts are the last two, and settlement from the end of the second on.
TEST(BedValues, AreOfTheSecondHalfAndPerMetreOfWidth) {
  const post::Table cycles("cycles.csv",
                           {"cycle", "a_drum_max", "F_contact_max", "contact_share", "settlement"},
                           {{"0", "900", "9000", "1", "0"},
                            {"1", "90", "900", "0.25", "0.5"},
                            {"2", "70", "700", "0.25", "0.6"},
                            {"3", "20", "200", "0.5", "0.65"},
                            {"4", "30", "600", "1", "0.8"}},
                           {2, 3, 4, 5, 6});
  const post::BedValues plane = post::bed_values(cycles, 1.0);
  EXPECT_DOUBLE_EQ(plane[0], 25.0);
  EXPECT_DOUBLE_EQ(plane[1], 400.0);
  EXPECT_NEAR(plane[2], 0.1, 1e-15);
  EXPECT_DOUBLE_EQ(plane[3], 0.75);
  const post::BedValues space = post::bed_values(cycles, 0.2);
  EXPECT_DOUBLE_EQ(space[1], 2000.0); // N/m
  EXPECT_EQ(space[0], plane[0]);
}

// The seeds differ by far more than the variant changes them: only differences seed by seed show it.
TEST(Effect, ComparesSeedBySeed) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const std::vector<FidelityRun> runs = {
      {"base", 1, {10.0, 100.0, 1e-3, 1.0, 5e6}, 2.0}, {"base", 2, {20.0, 300.0, 3e-3, 0.5, none}, 4.0},
      {"base", 3, {90.0, 500.0, 5e-3, 0.6, 5e6}, 3.0}, {"A", 2, {21.0, 290.0, 3e-3, 0.5, 6e6}, 8.0},
      {"A", 1, {11.0, 110.0, 1e-3, 1.0, 6e6}, 6.0},    {"A", 4, {7.0, 7.0, 7.0, 7.0, 7.0}, 7.0}};
  const std::optional<post::Effect> found = post::effect_of(runs, {"A instead of B", "A", "base"});
  ASSERT_TRUE(found.has_value());
  const post::Effect &effect = *found;
  EXPECT_EQ(effect.seeds, 2);
  EXPECT_DOUBLE_EQ(effect.change[0].mean, 1.0 / 15.0);
  EXPECT_DOUBLE_EQ(effect.change[0].half_width, 0.0);
  EXPECT_TRUE(effect.change[0].significant());
  EXPECT_DOUBLE_EQ(effect.difference[0].mean, 1.0);
  EXPECT_DOUBLE_EQ(effect.change[1].mean, 0.0);
  // of +10 and -10, over the mean of 100 and 300; t for 1 degree of freedom
  EXPECT_NEAR(effect.change[1].half_width, 12.7062 * 10.0 / 200.0, 1e-3);
  EXPECT_FALSE(effect.change[2].significant());
  EXPECT_DOUBLE_EQ(effect.cost, 2.5);           // of 3 and 2
  EXPECT_DOUBLE_EQ(effect.change[4].mean, 0.2); // of seed 1 alone: seed 2 of the base has no stiffness
  EXPECT_FALSE(effect.change[4].significant());
  EXPECT_FALSE(post::effect_of(runs, {"", "A", "B"}).has_value());
}

TEST(FidelityPlan, HasScenesOfDifferentNamesAndKeepsProportions) {
  for (const int balls : {200, 2500}) {
    const post::FidelityPlan plan = post::fidelity_plan(balls);
    std::set<std::string> names, soils;
    for (const post::FidelityScene &scene : plan.scenes) {
      EXPECT_TRUE(names.insert(scene.name).second) << scene.name;
      EXPECT_EQ(scene.name.find(','), std::string::npos) << scene.name;
      EXPECT_EQ(scene.bed.packing.invalid(), "") << scene.name;
      // A bed that hardens after it has settled is wedged between its walls: k is that of all decks, and pour_k is not given.
      for (const post::Variables &of_one_deck : {scene.run, scene.bed.settle, scene.bed.place})
        for (const auto &[name, value] : of_one_deck)
          EXPECT_TRUE(name != "k" && name != "pour_k" && name != "pour_dt")
              << scene.name << ": " << name << " " << value;
    }
    // What shares the soil of the complete scene must settle as it does; four scenes differ later only.
    int sharing = 0;
    for (const post::FidelityScene &scene : plan.scenes) {
      if (&scene == &plan.reference() || scene.soil() != plan.reference().soil()) continue;
      ++sharing;
      const std::vector<std::string> commands = post::scene_commands(scene, 8),
                                     complete = post::scene_commands(plan.reference(), 8);
      EXPECT_EQ(commands[0], complete[0]) << scene.name;
      EXPECT_EQ(commands[1], complete[1]) << scene.name;
      EXPECT_NE(commands[3], complete[3]) << scene.name;
    }
    EXPECT_EQ(sharing, 4);
    for (const post::BedComparison &one : plan.comparisons())
      EXPECT_EQ(names.count(one.base), 1u) << one.variant;
    EXPECT_EQ(plan.reference().base, "");
    EXPECT_EQ(plan.reference().bed.packing.balls, balls);
  }
  // A quarter of the balls: lengths halve, masses and forces per metre are a quarter, so that the pressure under the drum over
  // its radius stays the same.
  const auto value = [](const post::FidelityScene &scene, const std::string &name) {
    for (const auto &[variable, text] : scene.run_variables())
      if (variable == name) return std::stod(text);
    return 0.0;
  };
  const post::FidelityPlan small = post::fidelity_plan(625);
  EXPECT_DOUBLE_EQ(small.reference().bed.packing.width, 1.0);
  EXPECT_DOUBLE_EQ(value(small.reference(), "r2"), 0.175);
  EXPECT_DOUBLE_EQ(value(small.reference(), "m2"), 500.0);
  EXPECT_DOUBLE_EQ(value(small.reference(), "Fw"), 14.7e3);
  EXPECT_DOUBLE_EQ(value(small.reference(), "k"), 2.5e8); // k / m2 stays the same
  EXPECT_DOUBLE_EQ(value(small.reference(), "dt"), 1.25e-5);
  EXPECT_EQ(value(small.reference(), "steps_per_cycle"), 4000.0);
  EXPECT_EQ(value(small.scenes[2], "steps_per_cycle"), 2000.0); // balls twice as large
  const post::FidelityPlan whole = post::fidelity_plan(2500);
  EXPECT_EQ(value(whole.reference(), "steps_per_cycle"), 8000.0);

  const auto layered =
      std::find_if(whole.scenes.begin(), whole.scenes.end(),
                   [](const post::FidelityScene &scene) { return !scene.bed.layers.empty(); });
  ASSERT_NE(layered, whole.scenes.end());
  EXPECT_NEAR(layered->bed.packing.balls, 2500, 50); // as deep as the complete bed
  const std::vector<std::string> commands = post::scene_commands(*layered, 8);
  EXPECT_EQ(commands[0], "bed --layer 1.24 --layer 0.7 --width 2");
  EXPECT_EQ(commands[1].find("run inputs/bed/in.settle -var case base_course -var k 1e+08,1e+09 "), 0u)
      << commands[1];
}

// Invented runs of five seeds. add() gives each run of a scene the force of the complete bed of the same seed, times a factor of the
// scene, times a deviation of the seed that the complete bed does not have.
class BedAdviceTest : public ::testing::Test {
protected:
  void add(const std::string &scene, double factor, double scatter, double cpu, int seeds = 5) {
    for (int seed = 1; seed <= seeds; ++seed) {
      const double force = 1e5 * (1.0 + 0.1 * (seed - 3));
      const double own = factor * (1.0 + scatter * (seed % 2 == 0 ? 1.0 : -2.0 / 3.0));
      runs_.push_back({scene, seed, {10.0, own * force, 1e-3, 0.5, 5e6}, cpu, 400});
    }
  }
  /// Name of the scene that is advised.
  std::string advice(double within) const {
    const post::FidelityPlan plan = post::plan_of(runs_);
    return post::advise_bed(plan, runs_, {post::BedQuantity::force, within}).scene->name;
  }
  void expect_refused(double within, const std::string &message) const {
    try {
      ADD_FAILURE() << advice(within);
    } catch (const std::runtime_error &error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  std::vector<FidelityRun> runs_;
};

TEST_F(BedAdviceTest, NamesTheCheapestSceneWithinTheError) {
  add("complete", 1.0, 0.0, 10.0);
  add("k / 10", 1.04, 0.0, 3.0);
  add("k / 100", 0.7, 0.0, 1.0);     // cheaper, but off
  add("large balls", 1.0, 0.2, 0.5); // right in the mean, but the interval is wide
  add("A", 1.0, 0.0, 9.5);           // hardly cheaper than the complete scene
  add("one size", 1.0, 0.0, 0.1, 1); // one seed has no interval
  const post::FidelityPlan plan = post::plan_of(runs_);
  EXPECT_EQ(plan.reference().bed.packing.balls, 400);
  const post::BedAdvice found = post::advise_bed(plan, runs_, {post::BedQuantity::force, 0.1});
  ASSERT_NE(found.scene, nullptr);
  EXPECT_EQ(found.scene->name, "k / 10");
  EXPECT_NEAR(found.effect.change[1].mean, 0.04, 1e-12);
  EXPECT_NEAR(found.effect.cost, 0.3, 1e-12);
  EXPECT_EQ(found.cpu_s, 3.0);
  EXPECT_NEAR(found.scatter, 0.1 * std::sqrt(2.5), 1e-12); // of -2 to 2 tenths
  // 2.179 * 0.1581 / sqrt(12) is 0.0994 (12 degrees of freedom: 13 beds 0.0955; 11 degrees of freedom: 12 beds 0.1005)
  EXPECT_EQ(found.beds, 13);
  EXPECT_EQ(advice(0.5), "large balls");
  EXPECT_EQ(advice(0.03), "complete");

  const std::vector<std::string> commands = post::scene_commands(*found.scene, plan.cycles);
  ASSERT_EQ(commands.size(), 4u);
  EXPECT_EQ(commands[0], "bed --balls 400 --width 0.8");
  EXPECT_NE(commands[1].find("run inputs/bed/in.settle -var k 1.6e+07 "), std::string::npos) << commands[1];
  EXPECT_NE(commands[3].find(" -var steps_per_cycle 1250 "), std::string::npos) << commands[3];
}

// The complete beds settle by -2 to 2 mm per cycle: no error relative to their mean exists, but one in mm does.
TEST_F(BedAdviceTest, CountsErrorsOfTheSettlementInMillimetresIfAsked) {
  add("complete", 1.0, 0.0, 10.0);
  add("k / 10", 1.0, 0.0, 3.0);
  add("k / 100", 1.0, 0.0, 1.0);
  for (FidelityRun &run : runs_)
    run.values[2] = 1e-3 * (run.seed - 3) + (run.variant == "k / 10"    ? 0.5e-3
                                             : run.variant == "k / 100" ? 3e-3
                                                                        : 0.0);
  const post::FidelityPlan plan = post::plan_of(runs_);
  const post::BedAdvice found =
      post::advise_bed(plan, runs_, {post::BedQuantity::settlement, 1e-3, "settlement", true});
  EXPECT_EQ(found.scene->name, "k / 10");
  EXPECT_NEAR(found.effect.difference[2].mean, 0.5e-3, 1e-12);
  EXPECT_NEAR(found.scatter, 1e-3 * std::sqrt(2.5), 1e-12);
  try {
    post::advise_bed(plan, runs_, {post::BedQuantity::settlement, 0.1, "settlement"});
    ADD_FAILURE() << "a relative error of a mean of zero";
  } catch (const std::runtime_error &error) {
    EXPECT_NE(std::string(error.what()).find("or --within in mm per cycle, as 2mm"), std::string::npos)
        << error.what();
  }
}

TEST_F(BedAdviceTest, RefusesWhatTheTableDoesNotAnswer) {
  expect_refused(0.1, "the table of scenes is '0 runs'; allowed: one with runs of the scene 'complete'");
  add("A", 1.0, 0.0, 9.0);
  expect_refused(0.1, "the table of scenes is '5 runs'; allowed: one with runs of the scene 'complete'");
  add("complete", 1.0, 0.0, 10.0, 1);
  expect_refused(0.1, "allowed: one with two seeds or more of a scene and of the complete one");
  runs_.clear();
  add("complete", 1.0, 0.0, 10.0);
  add("k / 10", 1.3, 0.0, 3.0); // 30 % in the mean, with a half width of 2.776 * 0.3 * 0.158 / sqrt(5)
  const post::FidelityPlan plan = post::plan_of(runs_);
  const post::BedAdvice found = post::advise_bed(plan, runs_, {post::BedQuantity::force, 0.1});
  EXPECT_EQ(found.scene, &plan.reference());
  EXPECT_EQ(found.closest, "k / 10");
  EXPECT_NEAR(found.least_error, 0.3589, 1e-4);
  for (FidelityRun &run : runs_) // forces of complete beds from -2e4 to 2e4: their mean is zero
    run.values[1] -= 1e5;
  expect_refused(0.1, "--question is 'force'; allowed: a result whose mean over the complete "
                      "beds differs from zero");
}

} // namespace
} // namespace drumlin::test
