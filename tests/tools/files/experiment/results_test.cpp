// Quantities of records that are known, and effects against numbers worked out by hand.
#include "tests/support/page.h"
#include "experiment/results.h"
#include "chain/exact_solution.h"
#include "runs/chain_files.h"
#include "experiment/page.h"
#include "support/files.h"
#include "support/resumed.h"
#include "runs/parameter_file.h"

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

using post::Comparison;
using post::Result;
using post::Results;

constexpr double none = std::numeric_limits<double>::quiet_NaN();
// Student's t of 97.5 % for one and for two degrees of freedom
constexpr double t_1 = 12.706204736174698, t_2 = 4.302652729911275;

std::vector<double> values_of(const std::vector<std::string> &names, const fs::path &folder, double width) {
  std::vector<post::Quantity> quantities;
  quantities.reserve(names.size());
  for (const std::string &name : names)
    quantities.push_back(*post::named_quantity(name));
  return post::measured(quantities, folder, width);
}

// Four cycles after the start; what counts are the last two, and settlement from the end of the second on.
TEST(Quantities, OfABedAreOfTheSecondHalfAndPerMetreOfWidth) {
  const post::TemporaryFolder temporary(testing::TempDir(), "quantities");
  post::write_files(
      {{temporary.path() / "cycles.csv", "cycle,a_drum_max,F_contact_max,contact_share,settlement\n"
                                         "0,900,9000,1,0\n"
                                         "1,90,900,0.25,0.5\n"
                                         "2,70,700,0.25,0.6\n"
                                         "3,20,200,0.5,0.65\n"
                                         "4,30,600,1,0.8\n"},
       {temporary.path() / "parameters.csv", "name,value\ndrum_depth,-0.07\nr2,0.35\n"}});
  const std::vector<std::string> names =
      words_of("acceleration force settlement contact total_settlement depth");
  const std::vector<double> plane = values_of(names, temporary.path(), 1.0);
  EXPECT_DOUBLE_EQ(plane[0], 25.0);
  EXPECT_DOUBLE_EQ(plane[1], 400.0);
  EXPECT_NEAR(plane[2], 0.1, 1e-15);
  EXPECT_DOUBLE_EQ(plane[3], 0.75);
  EXPECT_DOUBLE_EQ(plane[4], 0.8);
  EXPECT_DOUBLE_EQ(plane[5], -0.1);
  const std::vector<double> space = values_of(names, temporary.path(), 0.2);
  EXPECT_DOUBLE_EQ(space[1], 2000.0); // N/m
  EXPECT_EQ(space[0], plane[0]);
}

// What counts is from the end of the second cycle to that of the fourth: the exciter does 60 J, bed and
// roller release 20 J, and 80 J leave.
TEST(Quantities, SharesOfTheHeatOfABedAddUpToOne) {
  const post::TemporaryFolder temporary(testing::TempDir(), "shares");
  const auto values = [&](const std::string &header, const std::string &last, double width) {
    post::write_files({{temporary.path() / "cycles.csv", header + last}});
    return values_of(
        {"radiation", "friction", "dashpots", "yielding", "bond", "released", "energy_error", "work"},
        temporary.path(), width);
  };
  const std::string header = "work_excitation,kinetic,potential,stored_contact,stored_bond,stored_ground,"
                             "dissipated_contact,dissipated_bond,dissipated_friction,dissipated_ground,"
                             "dissipated_yield\n"
                             "0,1,0,2,0,0,0,0,0,0,0\n"
                             "10,7,0,0,0,0,1,1,1,2,0\n"
                             "40,9,1,2,3,4,4,4,4,6,6\n"
                             "50,9,1,2,3,4,5,5,5,5,5\n";
  // Stores fall from 19 J to -1 J; heats rise by 8, 4, 40, 20 and 8 J.
  const std::vector<double> found = values(header, "100,1,-2,0,0,0,12,8,44,26,14\n", 2.0);
  const std::vector<double> shares = {0.25, 0.5, 0.1, 0.1, 0.05};
  for (std::size_t i = 0; i < shares.size(); ++i)
    EXPECT_NEAR(found[i], shares[i], 1e-15) << i;
  EXPECT_NEAR(found[5], 20.0 / 60.0, 1e-15);
  // Since the start: stores 3 J to -1 J, 104 J of heat, 100 J of work.
  EXPECT_NEAR(found[6], (-4.0 + 104.0) / 100.0 - 1.0, 1e-15);
  EXPECT_NEAR(found[7], 15.0, 1e-15); // per cycle and metre
  // Between rigid walls, without yielding.
  const std::string plain = "work_excitation,kinetic,potential,stored_contact,stored_bond,dissipated_contact,"
                            "dissipated_bond,dissipated_friction\n0,0,0,0,0,0,0,0\n";
  const std::vector<double> rigid = values(plain, "8,0,0,0,0,2,1,6\n", 1.0);
  EXPECT_EQ(rigid[0], 0.0);
  EXPECT_NEAR(rigid[1], 6.0 / 9.0, 1e-15);
  EXPECT_EQ(rigid[3], 0.0);
  EXPECT_NEAR(rigid[6], 1.0 / 8.0, 1e-15);
  // An exciter without force, a bed without heat.
  const std::vector<double> still = values(plain, "0,0,0,0,0,0,0,0\n", 1.0);
  for (std::size_t i = 0; i < 7; ++i)
    EXPECT_TRUE(std::isnan(still[i])) << i;
  EXPECT_THROW(values(plain, "", 1.0), std::runtime_error);
}

TEST(Quantities, OfAnyTableAreAColumnInSixWays) {
  const post::TemporaryFolder temporary(testing::TempDir(), "quantities");
  post::write_files({{temporary.path() / "out.csv", "t,gap\n0,7\n1,-2\n2,4\n3,1\n"},
                     {temporary.path() / "one.csv", "t,gap\n0,7\n"},
                     {temporary.path() / "holes.csv", "t,gap\n0,\n1,-2\n2,4\n3,\n"},
                     {temporary.path() / "empty.csv", "t,gap\n0,\n1,\n"},
                     {temporary.path() / "cut.csv", "t,gap\n0,7\n1,123"}}); // by a kill: of 1234.5
  const auto value = [&](const char *way, const char *file) {
    return post::measured({post::column_quantity("gap", "m", way, file, "gap")}, temporary.path(), 1.0).at(0);
  };
  EXPECT_EQ(value("last", "out.csv"), 1.0);
  EXPECT_EQ(value("mean", "out.csv"), 2.5);
  EXPECT_EQ(value("largest", "out.csv"), 7.0);
  EXPECT_EQ(value("smallest", "out.csv"), -2.0);
  EXPECT_EQ(value("per_row", "out.csv"), 1.5); // from -2 to 1 in two rows
  EXPECT_EQ(value("gain", "out.csv"), -6.0);
  EXPECT_EQ(value("gain", "holes.csv"), 6.0); // empty cells are left out
  EXPECT_EQ(value("last", "holes.csv"), 4.0);
  EXPECT_TRUE(std::isnan(value("last", "empty.csv")));
  EXPECT_EQ(value("last", "one.csv"), 7.0);
  EXPECT_EQ(value("last", "cut.csv"), 7.0);
  EXPECT_THROW(value("mean", "one.csv"), std::runtime_error);
  EXPECT_THROW(value("last", "other.csv"), std::runtime_error);
}

// The record of CVODE under the name that a bed's has: the origin of each contact then counts as unknown.
TEST(Quantities, OfTheLawAreThoseOfARecordWithKnownLaw) {
  post::ExactOptions options;
  options.cycles = 10.0;
  options.samples_per_cycle = 250;
  for (const char *name : {"II", "III"}) {
    post::ChainParameters p = post::table1_case(name, post::Transition::B);
    p.k *= 1.7;
    p.D = 0.3;
    const post::ChainHistory history = post::solve_chain(p, options).history;
    const post::TemporaryFolder temporary(testing::TempDir(), "identified_law");
    const fs::path &folder = temporary.path();
    post::write_files(
        {{folder / "bed.csv", post::chain_text(history)},
         {folder / "parameters.csv",
          post::parameters_text(given("omega {}, Fw {}, m2 {}, m3 {}, g {}", post::number_text(p.omega),
                                      post::number_text(p.Fw), post::number_text(p.m2),
                                      post::number_text(p.m3), post::number_text(p.g)))}});
    const std::vector<double> found = values_of({"k", "D", "R2"}, folder, 2.0);
    EXPECT_NEAR(found[0], p.k / 2.0, 1e-3 * p.k) << name; // per metre
    EXPECT_NEAR(found[1], p.D, 1e-3 * p.D) << name;
    EXPECT_GT(found[2], 0.999) << name;
  }
}

Result row(const char *scene, int seed, double value, double cost = 1.0) {
  return {scene, seed, "force", "N/m", value, cost};
}

// The seeds differ by far more than the scene changes them: only differences seed by seed show it.
TEST(Effect, OfPairsIsTakenSeedBySeed) {
  const Results results({row("base", 1, 100.0), row("A", 3, 912.0), row("A", 1, 110.0), row("base", 2, 500.0),
                         row("A", 2, 511.0), row("base", 3, 900.0), row("A", 4, 5000.0), row("B", 1, 7.0)});
  const std::optional<post::Change> change = change_of(results, {"", {{"A", "base"}}, true}, "force");
  ASSERT_TRUE(change.has_value());
  EXPECT_DOUBLE_EQ(change->difference.mean, 11.0); // of 10, 11, 12
  EXPECT_NEAR(change->difference.half_width, t_2 / std::sqrt(3.0), 1e-9);
  EXPECT_TRUE(change->difference.significant());
  EXPECT_DOUBLE_EQ(change->relative.mean, 11.0 / 500.0);
  EXPECT_NEAR(change->relative.half_width, t_2 / std::sqrt(3.0) / 500.0, 1e-12);
  const std::optional<post::Change> single = change_of(results, {"", {{"B", "base"}}, true}, "force");
  ASSERT_TRUE(single.has_value());
  EXPECT_EQ(single->difference.mean, -93.0);
  EXPECT_FALSE(single->difference.significant()); // one seed has no interval
  EXPECT_FALSE(change_of(results, {"", {{"A", "C"}}, true}, "force").has_value());
  EXPECT_FALSE(change_of(results, {"", {{"A", "base"}}, true}, "k").has_value());
}

TEST(Effect, OfIndependentSamplesHasTheScatterOfBoth) {
  const Results results(
      {row("base", 1, 100.0), row("base", 2, 300.0), row("wide", 1, 220.0), row("wide", 2, 420.0)});
  const std::optional<post::Change> change = change_of(results, {"", {{"wide", "base"}}, false}, "force");
  ASSERT_TRUE(change.has_value());
  EXPECT_NEAR(change->relative.mean, 120.0 / 200.0, 1e-12);
  EXPECT_NEAR(change->relative.half_width, t_2 * std::sqrt(2.0e4) / 200.0,
              1e-8); // Welch: two degrees of freedom
  const Results fewer({row("base", 1, 100.0), row("base", 2, 300.0), row("wide", 1, 220.0)});
  EXPECT_FALSE(change_of(fewer, {"", {{"wide", "base"}}, false}, "force")->relative.significant());
}

TEST(Effect, OfSeveralPairsOfScenesCountsAllOfThem) {
  const Results results({row("1 rigid", 1, 100.0), row("1 absorb", 1, 101.0), row("2 rigid", 1, 200.0),
                         row("2 absorb", 1, 202.0), row("3 absorb", 1, 1e9)});
  const Comparison compared{
      "", {{"1 absorb", "1 rigid"}, {"2 absorb", "2 rigid"}, {"3 absorb", "3 rigid"}}, true};
  const std::optional<post::Change> change = change_of(results, compared, "force"); // 1 and 2 of 100 and 200
  ASSERT_TRUE(change.has_value());
  EXPECT_NEAR(change->relative.mean, 1.5 / 150.0, 1e-15);
  EXPECT_NEAR(change->relative.half_width, t_1 * 0.5 / 150.0, 1e-8);
}

post::Plan made_up_plan() {
  post::Plan plan;
  plan.title = "Made up";
  plan.quantities = {*post::named_quantity("force"), *post::named_quantity("settlement"),
                     *post::named_quantity("k")};
  plan.axes = {{"load", "static load [kN/m]"}};
  plan.scenes = {{"base", "in.own"}, {"A", "in.own"}};
  plan.scenes[0].at["load"] = 10.0;
  plan.scenes[1].at["load"] = 20.0;
  plan.comparisons = {{"A instead of B", {{"A", "base"}}, true}};
  return plan;
}

TEST(Effect, LeavesOutWhatIsMissingAndComparesCosts) {
  std::vector<Result> rows;
  for (int seed = 1; seed <= 3; ++seed) {
    rows.push_back({"base", seed, "force", "N/m", 100.0 * seed, 2.0 * seed});
    rows.push_back({"A", seed, "force", "N/m", 110.0 * seed, 5.0 * seed});
    rows.push_back({"base", seed, "k", "N/m per m", seed == 2 ? none : 5e6, 2.0 * seed});
    rows.push_back({"A", seed, "k", "N/m per m", 6e6, 5.0 * seed});
  }
  const post::Plan plan = made_up_plan();
  const std::vector<post::Effect> effects = effects_of(plan, Results(rows));
  ASSERT_EQ(effects.size(), 1U);
  EXPECT_EQ(effects[0].seeds, 3U);
  EXPECT_DOUBLE_EQ(effects[0].cost, 2.5);
  EXPECT_FALSE(effects[0].changes[1].has_value());
  EXPECT_DOUBLE_EQ(effects[0].changes[2]->relative.mean, 0.2); // of seeds 1 and 3
  EXPECT_TRUE(effects_of(plan, Results({rows[0]})).empty());
  for (Result &row : rows)
    if (row.scene == "base" && row.quantity == "force") row.value = 0.0;
  const std::vector<post::Effect> of_zero = effects_of(plan, Results(rows));
  ASSERT_EQ(of_zero.size(), 1U);
  EXPECT_FALSE(of_zero[0].changes[0].has_value()); // relative to zero
  EXPECT_TRUE(of_zero[0].changes[2].has_value());
}

// Three scenes whose means are -0.02, 0.01 and 0.05 m, 9 and 11 kN/m, and 3 to 5 MN/m.
TEST(ShownQuantities, HaveUnitsThatFitAndChangesInThemWhereValuesHaveBothSigns) {
  const std::vector<post::Quantity> asked = {
      post::column_quantity("lift_rise", "m", "last", "passes.csv", "lift [m]"),
      post::column_quantity("gain", "-", "gain", "passes.csv", "density [-]"),
      post::column_quantity("force", "N/m", "mean", "passes.csv", "force [N]"),
      post::column_quantity("stiffness", "N/m", "mean", "passes.csv", "k [N/m]"),
      *post::named_quantity("settlement"),
      *post::named_quantity("force")};
  std::vector<Result> rows;
  for (int seed = 1; seed <= 2; ++seed) {
    const double aside = seed == 1 ? -1e-3 : 1e-3;
    for (const auto &[scene, rise] : {std::pair("a", -0.02), std::pair("b", 0.01), std::pair("c", 0.05)})
      rows.push_back({scene, seed, "lift_rise", "m", rise + aside, 1.0});
    rows.push_back({"a", seed, "gain", "-", 0.03 + aside, 1.0});
    rows.push_back({"a", seed, "stiffness", "N/m", seed == 1 ? 3e6 : 5e6, 1.0});
    rows.push_back({"a", seed, "force", "N/m", seed == 1 ? 9e3 : 11e3, 1.0});
  }
  const std::vector<post::Quantity> shown = post::as_shown(asked, Results(rows));
  ASSERT_EQ(shown.size(), asked.size());
  EXPECT_TRUE(shown[0].absolute);
  EXPECT_DOUBLE_EQ(shown[0].tolerance, 0.1 * 0.05);
  EXPECT_FALSE(shown[1].absolute);
  EXPECT_EQ(shown[1].tolerance, asked[1].tolerance);
  EXPECT_EQ(shown[4].tolerance, asked[4].tolerance);
  for (const auto &[n, unit, scale] :
       {std::tuple(0U, "mm", 1e3), std::tuple(1U, "-", 1.0), std::tuple(2U, "kN/m", 1e-3),
        std::tuple(3U, "MN/m", 1e-6), std::tuple(4U, "mm", 1e3), std::tuple(5U, "kN/m", 1e-3)}) {
    EXPECT_EQ(shown[n].shown_unit, unit) << n;
    EXPECT_EQ(shown[n].scale, scale) << n;
  }
}

// gnuplot would draw the part behind an underscore as a subscript.
TEST(ExperimentPage, WritesNamesOfThePlanAsTheyAre) {
  post::Plan plan = made_up_plan();
  plan.quantities = {post::column_quantity("lift_gain", "-", "gain", "passes.csv", "density [-]")};
  std::vector<Result> rows;
  for (int seed = 1; seed <= 3; ++seed) {
    rows.push_back({"base", seed, "lift_gain", "-", 0.01 * seed, 2.0});
    rows.push_back({"A", seed, "lift_gain", "-", -0.01 * seed, 2.0});
  }
  const post::TemporaryFolder temporary(testing::TempDir(), "experiment_names");
  post::write_experiment_page(temporary.path(), plan, Results(rows), {});
  expect_sound_page(temporary.path(), 2, "index.html", 0);
  // Of 0.01, 0.02 and 0.03: -0.02, -0.04 and -0.06, which would be -200 %.
  EXPECT_NE(post::read_text(temporary.path() / "index.html").find("-0.040 ± 0.050"), std::string::npos);
  for (const char *name : {"changes", "over_load"}) {
    const std::string drawn = post::read_text(temporary.path() / "figures" / (std::string(name) + ".svg"));
    EXPECT_NE(drawn.find("lift_gain"), std::string::npos) << name;
  }
}

/// A scene with a known value in both engines, and another.
post::Plan plan_with_known_values() {
  post::Plan plan;
  plan.title = "T";
  plan.quantities = {post::column_quantity("height", "m", "last", "f.csv", "h"),
                     post::column_quantity("time", "s", "last", "f.csv", "t")};
  plan.axes = {{"load", "load [N]"}};
  plan.published = {{"load", "s", "a book", "height", 2.5, 0.3}};
  plan.between_engines = 1e-3;
  const auto add = [&plan](const std::string &name, const std::string &family, const std::string &twin) {
    post::Scene scene;
    scene.name = name, scene.family = family, scene.twin = twin, scene.series = "s";
    if (twin.empty()) scene.at["load"] = static_cast<double>(plan.scenes.size());
    scene.expected = {{"height", 0.5, 2.0, 0.01, "a book"}};
    plan.scenes.push_back(scene);
  };
  add("a: x 1", "a", "");
  add("a: x 1 in LAMMPS", "a", "a: x 1");
  add("b", "b", "");
  return plan;
}

TEST(KnownValues, AreMetWithinTheirTolerancesAndInBothEngines) {
  const post::Plan plan = plan_with_known_values();
  const auto holds = [&plan](double first, double twin, double other) {
    std::vector<bool> found;
    for (const post::Judged &row :
         post::judged(plan, Results({{"a: x 1", 1, "height", "m", first, 1.0},
                                     {"a: x 1 in LAMMPS", 1, "height", "m", twin, 1.0},
                                     {"b", 1, "height", "m", other, 1.0}})))
      found.push_back(row.holds);
    return found;
  };
  using Found = std::vector<bool>;
  EXPECT_EQ(holds(0.518, 0.519, 0.481), (Found{true, true, true})); // errors are relative to 2 m
  EXPECT_EQ(holds(0.521, 0.5195, 0.479), (Found{false, true, false}));
  EXPECT_EQ(holds(0.500, 0.503, none), (Found{true, false, false}));
  post::Plan scaled = plan;
  scaled.scenes[2].expected = {{"height", 0.0, 1.0, 1.2, "a", "a: x 1"}};
  for (const double other : {1.19, 1.21}) // times that of the other scene
    EXPECT_EQ(post::judged(scaled, Results({{"a: x 1", 1, "height", "m", 0.5, 1.0},
                                            {"b", 1, "height", "m", 0.5 * other, 1.0}}))
                  .back()
                  .holds,
              other < 1.2);
  EXPECT_EQ(post::judged(plan, Results({{"b", 1, "time", "s", 1.0, 1.0}})).size(), 1U); // it gave no height
}

TEST(ExperimentPage, ShowsKnownValuesAndPublishedPoints) {
  const post::TemporaryFolder temporary(testing::TempDir(), "experiment_known");
  std::vector<Result> rows;
  for (const auto &[scene, value] : {std::pair{"a: x 1", 0.5}, {"a: x 1 in LAMMPS", 0.5}, {"b", 0.6}}) {
    rows.push_back({scene, 1, "height", "m", value, 1.0});
    rows.push_back({scene, 1, "time", "s", 1.0, 1.0});
  }
  post::write_experiment_page(temporary.path(), plan_with_known_values(), Results(rows), {});
  expect_sound_page(temporary.path(), 1, "index.html", 0);
  EXPECT_NE(post::read_text(temporary.path() / "index.html").find("1 of 2 acceptance criteria hold"),
            std::string::npos);
  const post::Table summary = post::read_table(temporary.path() / "data/summary.csv");
  EXPECT_EQ(summary.text("scene"), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(summary.text("runs"), (std::vector<std::string>{"2", "1"}));
  EXPECT_EQ(summary.text("largest error"), (std::vector<std::string>{"0.0e+00", "5.0e-02"}));
  EXPECT_NE(post::read_text(temporary.path() / "figures/over_load.svg").find("published, s, a book"),
            std::string::npos);
}

TEST(ResultRows, ComeBackBitForBit) {
  const post::TemporaryFolder temporary(testing::TempDir(), "results");
  const fs::path file = temporary.path() / "runs.csv";
  const std::vector<Result> rows = {{"k / 10", 2, "force", "N/m", 0.1 + 0.2, 1.5},
                                    {"k / 10", 2, "k", "N/m per m", none, none}};
  post::write_files({{file, post::result_rows().text(rows)}});
  EXPECT_EQ(post::read_text(file), "scene,seed,quantity,unit,value,cost [s]\n"
                                   "k / 10,2,force,N/m,0.30000000000000004,1.5\n"
                                   "k / 10,2,k,N/m per m,,\n");
  const std::vector<Result> again = post::read_points(file, post::result_rows());
  ASSERT_EQ(again.size(), 2U);
  EXPECT_EQ(again[0].value, 0.1 + 0.2);
  EXPECT_TRUE(std::isnan(again[1].value) && std::isnan(again[1].cost));
}

TEST(ExperimentPage, SaysWhatDiffersByHowMuchAndWhatIsMissing) {
  std::vector<Result> rows;
  for (int seed = 1; seed <= 3; ++seed) {
    rows.push_back({"base", seed, "force", "N/m", 1000.0 * seed, 2.0});
    rows.push_back({"A", seed, "force", "N/m", 1000.0 * seed + 400.0 + seed, 4.0});
    rows.push_back({"base", seed, "settlement", "m", 0.0, 2.0});
    rows.push_back({"A", seed, "settlement", "m", 1e-4 * seed, 4.0});
  }
  const post::TemporaryFolder temporary(testing::TempDir(), "experiment_page");
  const fs::path &folder = temporary.path();
  post::write_experiment_page(folder, made_up_plan(), Results(rows), {"seed 4, A: failed"});
  const std::string page = post::read_text(folder / "index.html");
  for (const char *words :
       {"Missing: seed 4, A: failed", "+20.10 ± 0.12 *", "A instead of B (+20 %, time x 2)", "+0.20 ± 0.25",
        "static load [kN/m]", "scenes: 2, of them 1 larger", "by chance 0.1 would be"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
  expect_sound_page(folder, 2, "index.html", 0);
}

} // namespace
} // namespace drumlin::test
