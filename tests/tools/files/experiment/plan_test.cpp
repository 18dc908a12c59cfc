// Plans: what a file says, each bad line, and the four plans of the project.
#include "tests/support/prelude.h"
#include "experiment/plan.h"
#include "engine/deck_run.h"
#include "experiment/results.h"
#include "support/files.h"
#include "support/resumed.h"
#include "support/usage_error.h"

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

using post::Plan;
using post::Scene;
using post::SceneDeck;
using post::Variables;

class PlanTest : public ::testing::Test {
protected:
  PlanTest() : temporary_(testing::TempDir(), "plan") {
    post::write_files({{temporary_.path() / "in.own", "print \"${gap} ${name} ${seed} ${x}\"\n"}});
  }
  fs::path file() const { return temporary_.path() / "my.plan"; }
  Plan read(const std::string &text) const {
    post::write_files({{file(), text}});
    return post::read_plan(file());
  }
  /// Expects the message after the name of the file.
  void expect_refused(const std::string &text, const std::string &message) const {
    try {
      read(text);
      ADD_FAILURE() << "read: " << text;
    } catch (const post::UsageError &error) {
      const std::string what = error.what();
      EXPECT_EQ(what.rfind(file().string() + message, 0), 0U) << what << "\n" << text;
      EXPECT_EQ(what.find('\n'), std::string::npos);
    }
  }
  post::TemporaryFolder temporary_;
};

TEST_F(PlanTest, GivesEachSceneWhatItsLinesAndTheSceneAboveSay) {
  const Plan plan = read("# a plan\n"
                         "title    What the gap does   # a comment\n"
                         "about    One &   # and more\n"
                         "         sentence.\n"
                         "quantity gap mm mean out.csv gap\r\n"
                         "axis     gap gap between two plates [mm]\n"
                         "deck     in.own\n"
                         "seeds    3\n"
                         "seed_variable seed\n"
                         "set      gap 1\n"
                         "set      name a#b\n"
                         "\n"
                         "scene    narrow\n"
                         "  at     gap 1\n"
                         "scene    wide / 10\n"
                         "  from    narrow\n"
                         "  differs twice the gap\n"
                         "  set     gap 2\n"
                         "  at      gap 2\n"
                         "  seeds   2\n"
                         "scene    wider\n"
                         "  from    wide / 10\n"
                         "  differs three times the gap\n"
                         "  paired  no\n"
                         "  set     gap 3\n"
                         "scene    slow\n"
                         "  from    narrow\n"
                         "  series  slow\n"
                         "compare  wide / 10 | narrow | wider than narrow\n"
                         "compare  wider | narrow | wider than narrow\n");
  EXPECT_EQ(plan.title, "What the gap does");
  EXPECT_EQ(plan.about, std::vector<std::string>{"One sentence."});
  ASSERT_EQ(plan.quantities.size(), 1U);
  EXPECT_EQ(plan.quantities[0].unit, "mm");
  EXPECT_EQ(plan.axes.at(0).label, "gap between two plates [mm]");
  ASSERT_EQ(plan.scenes.size(), 4U);
  const Scene &wider = plan.scene("wider");
  EXPECT_EQ(wider.deck, (temporary_.path() / "in.own").string());
  EXPECT_EQ(post::variables_of(wider, SceneDeck::run), (given("gap 3, name a#b")));
  EXPECT_EQ(plan.scene("wide / 10").at.at("gap"), 2.0);
  EXPECT_TRUE(wider.at.empty()); // else a figure has it as a further seed of the scene above
  EXPECT_EQ(plan.scene("slow").at.at("gap"), 1.0);
  EXPECT_EQ(wider.seeds, 2);
  EXPECT_EQ(plan.scene("narrow").seeds, 3);
  ASSERT_EQ(plan.comparisons.size(), 3U);
  using Pair = std::pair<std::string, std::string>;
  EXPECT_EQ(plan.comparisons[0].pairs, (std::vector<Pair>{{"wide / 10", "narrow"}}));
  EXPECT_TRUE(plan.comparisons[0].paired);
  EXPECT_EQ(plan.comparisons[1].pairs, (std::vector<Pair>{{"wider", "wide / 10"}}));
  EXPECT_FALSE(plan.comparisons[1].paired);
  EXPECT_EQ(plan.comparisons[2].words, "wider than narrow");
  EXPECT_EQ(plan.comparisons[2].pairs, (std::vector<Pair>{{"wide / 10", "narrow"}, {"wider", "narrow"}}));
}

TEST_F(PlanTest, MakesAsManyScenesAsALineOverHasValues) {
  const Plan plan = read("title T\nquantity gap m last out.csv gap\naxis twice 2 x\ndeck in.own\nset name n\n"
                         "scene a\nover x,gap 1,5 2,6\nat twice x*2\nexpect gap 5 0.1 by hand\n"
                         "scene b\nfrom a\nset name m\n");
  ASSERT_EQ(plan.scenes.size(), 4U);
  const Scene &last = plan.scenes[3];
  EXPECT_EQ(plan.scenes[0].name, "a: x 1");
  EXPECT_EQ(last.name, "b: x 2");
  EXPECT_EQ(last.family, "b");
  EXPECT_EQ(post::value_of(last, "x") + post::value_of(last, "gap") + post::value_of(last, "name"), "26m");
  EXPECT_EQ(plan.scenes[1].at.at("twice"), 4.0);
  ASSERT_EQ(last.expected.size(), 1U);
  EXPECT_EQ(last.expected[0].value, 5.0);
  EXPECT_EQ(last.expected[0].source, "by hand");
}

TEST_F(PlanTest, TakesTheValueOfAnotherSceneAsAScaleAndMeasuresWhatIsKnown) {
  const std::string own = "title T\nquantity gap m last out.csv gap\nquantity height m last out.csv h\n"
                          "quantity time s last out.csv t\ndeck in.own\n"
                          "scene a\nover x 1 2 3\nexpect gap 5 0.1 by hand\n";
  const Plan plan =
      read(own + "scene b\nfrom a\nexpect gap 0 1.2 the other | a\nexpect height 1 1 by hand\n");
  EXPECT_EQ(plan.scenes[3].expected[0].scale_of, "a: x 1");
  EXPECT_EQ(plan.scenes[3].expected[0].source, "the other");
  const auto names = [&plan](std::size_t scene) {
    std::string all;
    for (const post::Quantity &one : plan.measured_in(plan.scenes[scene]))
      all += one.name + " ";
    return all;
  };
  EXPECT_EQ(names(0), "gap time ");
  EXPECT_EQ(names(3), "gap height time ");
  EXPECT_EQ(plan.quick().quantities.size(), 2U); // its three scenes have no height
  expect_refused(own + "scene b\nset x 1\nexpect gap 0 1 the other | a\n",
                 ": expect is 'a'; allowed: behind | a scene, which has the same line over as this one");
}

TEST_F(PlanTest, TakesKnownValuesAndPublishedPointsFromFiles) {
  const std::string own = "title T\nquantity gap m last out.csv gap\ndeck in.own\nexpect known.csv\n";
  const auto known = [this](const std::string &rows) {
    post::write_files(
        {{temporary_.path() / "known.csv", "scene,quantity,value,scale,tolerance,source\n" + rows}});
  };
  known("a: x 2,gap,3,10,1e-3,book\n");
  post::write_files(
      {{temporary_.path() / "points.csv", "axis,series,source,quantity,at,value\nload,s,paper,gap,1,2\n"}});
  const Plan plan = read(own + "published points.csv\nscene a\nover x 1 2\n");
  EXPECT_TRUE(plan.scenes[0].expected.empty());
  ASSERT_EQ(plan.scenes[1].expected.size(), 1U);
  EXPECT_EQ(plan.scenes[1].expected[0].scale, 10.0);
  ASSERT_EQ(plan.published.size(), 1U);
  EXPECT_EQ(plan.published[0].value, 2.0);
  EXPECT_EQ(plan.copy().rfind("deck_folder ", 0), 0U);

  const auto refused = [&](const char *row, const char *message) {
    known(std::string(row) + "\n");
    try {
      read(own + "scene a\n");
      ADD_FAILURE() << row;
    } catch (const std::runtime_error &error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  };
  refused("b,gap,3,1,1,s", "'scene' is 'b'; allowed: a scene of the plan");
  refused("a,height,3,1,1,s", "'quantity' is 'height'; allowed: a quantity of the plan");
  refused("a,gap,3,0,1,s", "'value' is '3'; allowed: a number, with a scale above zero and a tolerance");
}

TEST_F(PlanTest, ExpectsOfEachSceneAtMostWhatAnEarlierTableHas) {
  const std::string own = "title T\nquantity gap m last out.csv gap\nquantity time s last out.csv t\n"
                          "log_axis size 2 x\ndeck in.own\norder gap\n"
                          "table found.csv x size width=gap time\n";
  const std::string scenes = "scene a\nover x 1 2\nat size x*2\nscene no size\nset x 1\n";
  const auto earlier = [this](const std::string &rows) {
    post::write_files({{temporary_.path() / "found.csv", "x,size,width,time\n" + rows}});
  };
  earlier("2.0,4,-3,1\n1,2,,\n");
  const Plan plan = read(own + "at_most 1.5 found.csv gap\n" + scenes);
  EXPECT_TRUE(plan.scenes[0].expected.empty()); // it had no value
  ASSERT_EQ(plan.scenes[1].expected.size(), 1U);
  const post::Expected &expected = plan.scenes[1].expected[0];
  EXPECT_EQ(expected.value, 0.0);
  EXPECT_EQ(expected.scale, 3.0);
  EXPECT_EQ(expected.tolerance, 1.5);
  EXPECT_EQ(expected.source, "of found.csv");
  EXPECT_EQ(plan.errors, std::vector<std::string>{"gap"});
  EXPECT_TRUE(Plan::key_in(plan.tables.at(0), plan.scenes[2]).empty());
  EXPECT_EQ(Plan::key_in(plan.tables[0], plan.scenes[1]), (std::vector<std::string>{"2", "4"}));

  earlier("3,6,1,1\n");
  try {
    read(own + "at_most 1.5 found.csv gap\n" + scenes);
    ADD_FAILURE() << "a row of no scene";
  } catch (const std::runtime_error &error) {
    EXPECT_NE(std::string(error.what()).find("'x' is '3'; allowed: a row of a scene of the plan"),
              std::string::npos)
        << error.what();
  }
  for (const char *text : {"0 found.csv gap", "1.5 found.csv", "1.5 found.csv x"})
    expect_refused(fmt::format("{}at_most {}\n{}", own, text, scenes),
                   fmt::format(", line 8: at_most is '{}'; allowed: X FILE QUANTITY ...", text));
  expect_refused("title T\nquantity gap m last out.csv gap\nat_most 1 found.csv gap\n",
                 ", line 3: at_most is 'found.csv'; allowed: a file with the name of a table above");
}

TEST_F(PlanTest, RunsScenesInLammpsTooWhereItIsSetUp) {
  post::write_files({{temporary_.path() / "in.own.lammps", "print \"${x}\"\n"}});
  const Plan plan = read("title T\nquantity gap m last out.csv gap\ndeck in.own\nalso_in_lammps 1e-9\n"
                         "scene a\nset x 1\nscene b\nset x 2\n");
  EXPECT_EQ(plan.between_engines, 1e-9);
  if (!post::has_lammps()) {
    EXPECT_EQ(plan.scenes.size(), 2U);
    return;
  }
  ASSERT_EQ(plan.scenes.size(), 4U);
  EXPECT_EQ(plan.scenes[1].name, "a in LAMMPS");
  EXPECT_EQ(plan.scenes[1].twin, "a");
  EXPECT_EQ(fs::path(plan.scenes[1].deck).filename(), "in.own.lammps");
  fs::remove(temporary_.path() / "in.own.lammps");
  expect_refused("title T\nquantity gap m last out.csv gap\ndeck in.own\nalso_in_lammps 1e-9\nscene a\n",
                 ": also_in_lammps is '1e-09'; allowed: with a deck in.own.lammps");
}

TEST_F(PlanTest, LeavesOutScenesWhoseEngineIsNotSetUp) {
  post::write_files({{temporary_.path() / "in.own.lammps", "print \"${x}\"\n"}});
  const std::string own = "title T\nquantity gap m last out.csv gap\nset x \"1 2\"\nrounds 3\n";
  const Plan plan = read(own + "deck in.own\nscene a\nscene b\nfrom a\ndiffers engine\ndeck in.own.lammps\n");
  EXPECT_EQ(post::value_of(plan.scenes[0], "x"), "1 2");
  EXPECT_TRUE(plan.scenes[0].rounds && plan.scenes[0].seeds == 3);
  const bool both = post::has_lammps(), none = !both && post::plugin_library().empty(); // as under sanitizers
  EXPECT_EQ(plan.scenes.size(), both || none ? 2U : 1U);
  EXPECT_EQ(plan.comparisons.size(), plan.scenes.size() - 1);
  EXPECT_EQ(plan.left_out.empty(), both || none);
  EXPECT_EQ(read(own + "deck in.own.lammps\nscene b\n").scenes.size(), 1U); // which the study refuses
}

TEST_F(PlanTest, ReadsWhatEditorsOfWindowsWrite) {
  const Plan plan = read("\xEF\xBB\xBFtitle T\r\nquantity gap m last out.csv gap\r\ndeck in.own\r\nscene a");
  EXPECT_EQ(plan.title, "T");
  EXPECT_EQ(plan.scenes.at(0).name, "a");
}

// The copy of a plan beside its results is read where its decks are not.
TEST_F(PlanTest, HasACopyThatFindsItsDecks) {
  const std::string text = "title T\nquantity gap m last out.csv gap\ndeck ./in.own\nscene a\n";
  const Plan plan = read(text);
  EXPECT_EQ(plan.text, text); // results depend on it, not on the name of the folder
  const fs::path other = temporary_.path() / "results";
  fs::create_directory(other);
  post::write_files({{other / "plan", plan.copy()}});
  const Plan copied = post::read_plan(other / "plan");
  EXPECT_EQ(copied.scenes.at(0).deck, (temporary_.path() / "in.own").string());
  EXPECT_EQ(copied.copy(), plan.copy());
  EXPECT_EQ(read("deck_folder results/..\n" + text).scenes.at(0).deck, plan.scenes[0].deck);
  const Plan of_project = read("title T\nquantity force\ndeck bed/in.bed\nballs 100\nwidth 0.4\nscene a\n");
  EXPECT_EQ(of_project.copy(), of_project.text);
}

// Engines ignore a variable that a deck does not have, so that two scenes would be the same.
TEST_F(PlanTest, RefusesVariablesThatAUsersDeckDoesNotHave) {
  const std::string own = "title T\nquantity gap m last out.csv gap\ndeck in.new\n";
  const auto deck = [this](const std::string &text) {
    post::write_files({{temporary_.path() / "in.new", text}});
  };
  post::write_files({{temporary_.path() / "part", "variable speed index 1\nvariable d equal 2*v_depth\n"},
                     {temporary_.path() / "law.a", "print \"${grip}\"\n"}});
  deck("include ${here}/part\nif \"${x} == 1\" then \"include ${here}/law.${law}\"\nprint \"a\" append "
       "${here}/log\n");
  for (const char *name : {"speed", "depth", "grip", "law", "x"})
    EXPECT_EQ(read(own + "set " + name + " 1\nscene a\n").scenes.size(), 1U) << name;
  expect_refused(
      own + "scene a\nset spee 1\n",
      ", line 4: scene is 'a'; allowed: without set spee, a variable that deck in.new does not have");
  expect_refused(own + "scene a\nset dept 1\n", ", line 4: scene is 'a'; allowed: without set dept,");
  expect_refused(
      own + "seed_variable seed\nscene a\n",
      ", line 5: scene is 'a'; allowed: without seed_variable seed, which deck in.new does not have");
  EXPECT_EQ(post::deck_files(temporary_.path() / "in.new").size(), 3U); // without what it writes
  deck("include ${folder}/part\n");                                     // which only the engine finds
  EXPECT_EQ(read(own + "set other 1\nscene a\n").scenes.size(), 1U);
}

TEST_F(PlanTest, GivesEachDeckOfABedItsVariables) {
  const Plan plan =
      read("title T\nquantity force\ndeck bed/in.bed\nballs 100\nwidth 0.4\nratio 0.5\n"
           "set_settle pour_friction 0.8\nset_placed drum clump\nset_run cycles 4\nset rolling 0.1\n"
           "scene one\nscene hard\nfrom one\nset_run rolling 0.2\nstiffness 1e9\nfrequency 40\n"
           "scene dense\nfrom hard\nset k 1e8,1e9\nmore_steps 2\nlayer 0.2\nlayer 0.3\n");
  const Scene &one = plan.scene("one"), &hard = plan.scene("hard"), &dense = plan.scene("dense");
  EXPECT_EQ(post::variables_of(one, SceneDeck::settle), (given("pour_friction 0.8, rolling 0.1, ratio 0.5")));
  EXPECT_EQ(post::variables_of(one, SceneDeck::place), (given("drum clump, rolling 0.1, ratio 0.5")));
  EXPECT_EQ(post::variables_of(one, SceneDeck::run), (given("cycles 4, drum clump, rolling 0.1")));
  // Case gravel has 8000 steps per cycle of 20 Hz for these balls and this stiffness.
  EXPECT_EQ(post::value_of(hard, "rolling"), "0.2");
  EXPECT_EQ(post::value_of(hard, "k"), "1e+09");
  EXPECT_EQ(post::value_of(hard, "dt"), "6.25e-06");
  EXPECT_EQ(post::value_of(hard, "omega"), "251.32741228718345"); // 80 pi
  EXPECT_EQ(post::value_of(hard, "steps_per_cycle"), "4000");
  EXPECT_EQ(post::value_of(dense, "k"), "1e8,1e9");
  EXPECT_EQ(post::value_of(dense, "steps_per_cycle"), "8000");
  ASSERT_EQ(dense.bed->layers.size(), 2U);
  EXPECT_EQ(dense.bed->balls(),
            post::balls_of({dense.bed->packing, 0.2}) + post::balls_of({dense.bed->packing, 0.3}));
  // What differs after the soil has settled does not change the soil.
  EXPECT_NE(post::soil_text(one), post::soil_text(hard));
  const Plan shared = read(
      "title T\nquantity force\ndeck bed/in.bed\nballs 100\nwidth 0.4\n"
      "stiffness 1e8\nscene one\nscene other\nfrom one\nset_placed m3 50\nset_run Fw 10\nmore_steps 2\n");
  EXPECT_EQ(post::soil_text(shared.scenes[0]), post::soil_text(shared.scenes[1]));
  EXPECT_FALSE(shared.can_be_scaled()); // the roller's other variables are those of the deck
  const std::string whole =
      "title T\nquantity force\ndeck bed/in.drive\nballs 100\nwidth 0.4\nstiffness 1e8\n"
      "set r2 1\nset r3 1\nset m2 1\nset m3 1\nset k23 1\nset c23 1\nset Fw 1\n";
  EXPECT_TRUE(read(whole + "scene one\n").can_be_scaled());
  EXPECT_FALSE(read(whole + "scene one\nset_placed place -0.1\n").can_be_scaled()); // nor is its way
}

// Contacts that yield are stiffer in unloading, and layers of finer discs need the steps of the finest.
TEST_F(PlanTest, MakesStepsForTheStiffestAndSmallestContacts) {
  const Plan plan = read("title T\nquantity force\ndeck bed/in.bed\nballs 100\nwidth 2\nstiffness 1e9\n"
                         "scene plain\nscene yields\nfrom plain\nset yield 4\n"
                         "scene wrong\nfrom plain\nset yield none\n"
                         "scene layers\nfrom plain\nlayer 0.7\nlayer 0.3 16-24\nradius_min 0.032\n"
                         "radius_max 0.048\n");
  EXPECT_EQ(post::value_of(plan.scene("plain"), "dt"), "6.25e-06");
  EXPECT_EQ(post::value_of(plan.scene("yields"), "dt"), "3.125e-06");
  EXPECT_EQ(post::value_of(plan.scene("yields"), "steps_per_cycle"), "16000");
  EXPECT_EQ(post::value_of(plan.scene("wrong"), "dt"), "6.25e-06"); // which the decks refuse
  const Scene &layers = plan.scene("layers");
  EXPECT_EQ(post::value_of(layers, "dt"), "3.125e-06"); // of discs of 8 mm radius
  ASSERT_EQ(layers.bed->layers.size(), 2U);
  EXPECT_EQ(layers.bed->layers[0].packing.smallest_radius(), 0.032);
  EXPECT_EQ(layers.bed->layers[1].packing.smallest_radius(), 0.008);
  EXPECT_EQ(layers.bed->layers[1].packing.balls, post::balls_of(layers.bed->layers[1]));
  EXPECT_GT(layers.bed->layers[1].packing.balls, 4 * layers.bed->layers[0].packing.balls);
  EXPECT_NE(post::soil_text(layers), post::soil_text(plan.scene("plain")));
}

// A layer with relative_density is poured with the friction that gives this density. Scenes whose layers or
// spots differ do not share their soil.
TEST_F(PlanTest, PoursLayersOfADensityAndMakesSpots) {
  const Plan plan = read("title T\nquantity force\ndeck bed/in.drive\nwidth 2\nradius_min 0.024\n"
                         "radius_max 0.036\nlayer 0.4 relative_density 1\nlayer 0.3 relative_density 0\n"
                         "scene plain\nscene spot\nfrom plain\nspot -0.5 -0.25\nspot 0 1\n"
                         "scene moved\nfrom spot\nspot 0 1\n"
                         "scene dense\nfrom plain\nlayer 0.4 relative_density 1\n"
                         "layer 0.3 relative_density 1\n");
  const post::MeasuredPackings packings = post::packings_of_gravel(2);
  const std::vector<post::BedLayer> &layers = plan.scene("plain").bed->layers;
  ASSERT_EQ(layers.size(), 2U);
  EXPECT_EQ(layers[0].pouring->void_ratio, packings.shaken());
  EXPECT_EQ(layers[1].pouring->void_ratio, packings.loosest());
  EXPECT_EQ(layers[1].pouring->friction, packings.of_loosest().friction);
  EXPECT_EQ(layers[1].packing.balls, post::balls_of(layers[1]));
  EXPECT_GT(plan.scene("dense").bed->layers[1].packing.balls, layers[1].packing.balls);
  ASSERT_EQ(plan.scene("spot").bed->spots.size(), 2U);
  EXPECT_EQ(plan.scene("spot").bed->spots[0].to, -0.25);
  EXPECT_EQ(plan.scene("moved").bed->spots.size(), 1U);
  std::set<std::string> soils;
  for (const Scene &scene : plan.scenes)
    soils.insert(post::soil_text(scene));
  EXPECT_EQ(soils.size(), 4U);
}

TEST_F(PlanTest, RefusesEachBadLine) {
  const std::string own = "title T\nquantity gap m last out.csv gap\ndeck in.own\n";
  const std::string bed = "title T\nquantity force\ndeck bed/in.bed\nballs 100\nwidth 0.4\n";
  expect_refused("", ": title is ''; allowed: a line of it");
  expect_refused("title T\n", ": quantity is ''; allowed: a line for each");
  expect_refused(own, ": scene is ''; allowed: a line for each");
  expect_refused(own + "ball 5\n",
                 ", line 4: the keyword is 'ball'; allowed: about, also_in_lammps, at, at_most, axis, ");
  expect_refused(own + "note that &\n",
                 ", line 4: the last line is 'note that &'; allowed: a line below one that ends with &");
  expect_refused(own + "seeds\n", ", line 4: seeds is ''; allowed: a value after it");
  expect_refused(own + "seeds 0\n", ", line 4: seeds is '0'; allowed: a whole number from 1 to 1000");
  expect_refused(own + "seeds 2.5\n", ", line 4: seeds is '2.5'; allowed: a whole number from 1 to 1000");
  expect_refused(own + "title U\n", ", line 4: title is 'U'; allowed: once before the first scene");
  expect_refused(own + "scene a\nabout it\n", ", line 5: about is 'it'; allowed: before the first scene");
  expect_refused(own + "scene a\nseeds 1\nseeds 1\n", ", line 6: seeds is '1'; allowed: once in a scene");
  expect_refused(own + "scene a, b\n", ", line 4: scene is 'a, b'; allowed: a name without commas and |");
  expect_refused(own + "scene -nan\n",
                 ", line 4: scene is '-nan'; allowed: a name that does not mean no value");
  expect_refused(own + "scene a\nscene a\n", ", line 5: scene is 'a'; allowed: each name once");
  expect_refused(own + "scene a\nfrom b\n", ", line 5: from is 'b'; allowed: the name of a scene above");
  expect_refused(own + "scene a\nfrom a\n", ", line 5: from is 'a'; allowed: the name of a scene above");
  expect_refused(own + "from a\n", ", line 4: from is 'a'; allowed: below the line of a scene");
  expect_refused(own + "scene a\nscene b\nset x 1\nfrom a\n",
                 ", line 7: from is 'a'; allowed: the first line of a scene");
  expect_refused(own + "scene a\ndiffers by name\n",
                 ", line 5: differs is 'by name'; allowed: below a line from");
  expect_refused(own + "paired maybe\n", ", line 4: paired is 'maybe'; allowed: yes, no");
  expect_refused(own + "scene a\ncompare a | a\n",
                 ", line 5: compare is 'a | a'; allowed: SCENE | SCENE | what differs, in words");
  expect_refused(own + "scene a\ncompare a | b | it\n",
                 ", line 5: compare is 'b'; allowed: the name of a scene");
  expect_refused("title T\nquantity noise\n",
                 ", line 2: quantity is 'noise'; allowed: acceleration, force, ");
  expect_refused("title T\nquantity gap m\n",
                 ", line 2: quantity is 'gap m'; allowed: the name of a bed's quantity");
  expect_refused(
      "title T\nquantity gap m middle f.csv x\n",
      ", line 2: quantity is 'gap m middle f.csv x'; allowed: NAME UNIT WAY FILE COLUMN, WAY one of last");
  for (const auto &[column, unit] : {std::pair{"passes.csv settlement [m]", "m"},
                                     {"cycles.csv settlement", "m"},
                                     {"plate.csv stress_kPa", "kPa"},
                                     {"chain.csv F_contact", "N"},
                                     {"out/bed.csv a_drum", "m/s2"}}) {
    expect_refused(fmt::format("title T\nquantity gap mm last {}\n", column),
                   fmt::format(", line 2: quantity is 'gap mm last {}'; allowed: NAME UNIT WAY FILE COLUMN, "
                               "UNIT {}, that of the column",
                               column, unit));
    EXPECT_EQ(read(fmt::format("title T\nquantity gap {} last {}\ndeck in.own\nscene a", unit, column))
                  .quantities.front()
                  .label,
              "gap");
  }
  EXPECT_EQ(read("title T\nquantity work J/m last cycles.csv work_excitation\nquantity gap mm last my.csv "
                 "gap\ndeck in.own\nscene a")
                .quantities.back()
                .label,
            "gap, unit as given");
  expect_refused("title T\nquantity a/b m last f.csv x\n",
                 ", line 2: quantity is 'a/b m last f.csv x'; allowed: NAME");
  for (const char *name_and_unit : {"nan m", "gap nan"})
    expect_refused(fmt::format("title T\nquantity {} last f.csv x\n", name_and_unit),
                   fmt::format(", line 2: quantity is '{} last f.csv x'; allowed: NAME UNIT WAY FILE COLUMN, "
                               "NAME and UNIT not nan",
                               name_and_unit));
  for (const char *file : {"/f.csv", "a/../../f.csv"})
    expect_refused(fmt::format("title T\nquantity gap m last {} x\n", file),
                   fmt::format(", line 2: quantity is 'gap m last {} x'; allowed: NAME UNIT WAY FILE COLUMN, "
                               "FILE in the folder of the run",
                               file));
  expect_refused("title T\nquantity k\nquantity k\n",
                 ", line 3: quantity is 'k'; allowed: each quantity once");
  for (const char *text : {"a.csv", "a.txt x", "b/a.csv x", "runs.csv x", "a.csv x=", "a.csv x y-z"})
    expect_refused(fmt::format("{}table {}\n", own, text),
                   fmt::format(", line 4: table is '{}'; allowed: NAME.csv COLUMN COLUMN", text));
  expect_refused(own + "table a.csv x\ntable a.csv y\n",
                 ", line 5: table is 'a.csv y'; allowed: each table once");
  expect_refused(own + "order height\n", ", line 4: order is 'height'; allowed: a quantity of the plan");
  expect_refused("title T\naxis load\n", ", line 2: axis is 'load'; allowed: NAME LABEL");
  expect_refused("title T\naxis a x [m]\naxis a y [m]\n",
                 ", line 3: axis is 'a y [m]'; allowed: each axis once");
  expect_refused(own + "scene a\nat load 3\n", ", line 5: at is 'load 3'; allowed: AXIS NUMBER");
  expect_refused(own + "axis load load [N]\nscene a\nat load much\n",
                 ", line 6: at is 'load much'; allowed: AXIS NUMBER");
  expect_refused("deck in.other\n",
                 ", line 1: deck is 'in.other'; allowed: a deck in the folder of the plan, or in ");
  expect_refused("deck_folder inner\ndeck in.own\n", ", line 2: deck is 'in.own'; allowed: a deck in " +
                                                         (temporary_.path() / "inner").string() + ", or");
  expect_refused(own + "deck_folder .\n", ", line 4: deck_folder is '.'; allowed: above the line deck");
  expect_refused("title T\nquantity gap m last out.csv gap\nscene a\n",
                 ", line 3: scene is 'a'; allowed: with a line deck");
  expect_refused(own + "set gap\n", ", line 4: set is 'gap'; allowed: NAME VALUE");
  expect_refused(own + "set gap 1 2\n", ", line 4: set is 'gap 1 2'; allowed: NAME VALUE");
  for (const char *text : {"a in.own", "a in.own b c", "a in.own b =1", "a in.own b-c"})
    expect_refused(fmt::format("{}made {}\n", own, text),
                   fmt::format(", line 4: made is '{}'; allowed: VARIABLE DECK OUTPUT NAME=VALUE ...", text));
  expect_refused(own + "made a in.other b\n",
                 ", line 4: made is 'in.other'; allowed: a deck in the folder of the plan, or in ");
  expect_refused(own + "seed_variable seed\nrounds 2\nscene a\n",
                 ", line 6: scene is 'a'; allowed: rounds without a bed and without seed_variable");
  expect_refused(own + "set g-p 1\n", ", line 4: set is 'g-p 1'; allowed: NAME VALUE");
  expect_refused(own + "set gap 1\nset gap 2\n", ", line 5: set is 'gap 2'; allowed: each variable once");
  expect_refused(own + "seed_variable a b\n",
                 ", line 4: seed_variable is 'a b'; allowed: the name of a variable");
  expect_refused(own + "seeds 2\nscene a\n",
                 ", line 5: scene is 'a'; allowed: one seed, rounds, or seed_variable");
  expect_refused(own + "stiffness 1e9\nscene a\n",
                 ", line 5: scene is 'a'; allowed: stiffness on a bed: with balls or layer");
  expect_refused(own + "scene a\nset_placed x 1\n",
                 ", line 4: scene is 'a'; allowed: set_settle and set_placed on");
  expect_refused(own + "set out x\nscene a\n",
                 ", line 5: scene is 'a'; allowed: without set out, which the study");
  expect_refused(own + "seed_variable seed\nset seed 3\nscene a\n",
                 ", line 6: scene is 'a'; allowed: without set seed, which the study gives");
  expect_refused(
      own + "balls 100\nscene a\n",
      ", line 5: scene is 'a'; allowed: beds of decks beside which there are in.settle and in.place");
  expect_refused(bed + "set start x\nscene a\n",
                 ", line 7: scene is 'a'; allowed: without set start, which the");
  expect_refused(bed + "frequency 30\nscene a\n",
                 ", line 7: scene is 'a'; allowed: frequency and more_steps with stiffness");
  expect_refused("deck " + std::string(5000, 'x') + "\n", ", line 1: deck is 'xxx");
  expect_refused(own + "stiffness -1\n",
                 ", line 4: stiffness is '-1'; allowed: a number from 1e-06 to 1e+15 [N/m]");
  const char *const over = "NAME VALUE VALUE ..., or NAME,NAME VALUE,VALUE ...";
  for (const char *line : {"x", "x,y 1,2 3", "x-y 1"})
    expect_refused(own + "scene a\nover " + line + "\n",
                   fmt::format(", line 5: over is '{}'; allowed: {}", line, over));
  expect_refused(own + "scene a\nover x 1 1\n", ", line 5: over is 'x 1 1'; allowed: each value once");
  expect_refused(own + "scene a\nset x 1\nover x 1\n",
                 ", line 6: over is 'x 1'; allowed: each variable once");
  expect_refused(own + "over x 1\n", ", line 4: over is 'x 1'; allowed: below the line of a scene");
  expect_refused(own + "scene a\nover nil 1 2\n",
                 ", line 4: scene is 'a'; allowed: without set nil, a variable that deck");
  expect_refused(own + "scene a\nover x 1 2\nscene b\nfrom a\ndiffers it\n",
                 ": scene is 'b'; allowed: without over, since it is compared");
  expect_refused(
      own + "axis load load [N]\nscene a\nover x 1 b\nat load x\n",
      ", line 7: at is 'load x'; allowed: AXIS NUMBER, an axis that a line `axis` names; or, below");
  const char *const expect = "QUANTITY VALUE TOLERANCE SOURCE";
  for (const char *line : {"gap 1", "gap 1 2", "gap one 2 s", "gap 1 -1 s", "gap 1 nan s", "gap inf 1 s",
                           "height 1 1 s", "known.csv"})
    expect_refused(own + "scene a\nexpect " + line + "\n",
                   fmt::format(", line 5: expect is '{}'; allowed: {}", line, expect));
  expect_refused(own + "expect none.csv\n", ", line 4: expect is 'none.csv'; allowed: a file in the folder");
  expect_refused(own + "expect gap 1 1 s\n", ", line 4: expect is 'gap 1 1 s'; allowed: below the line of a");
  expect_refused(own + "also_in_lammps yes\n", ", line 4: also_in_lammps is 'yes'; allowed: a number from 0");
  expect_refused(own + "balls many\n",
                 ", line 4: balls is 'many'; allowed: a whole number from 1 to 10000000");
  expect_refused(bed + "radius_min x\n",
                 ", line 6: radius_min is 'x'; allowed: a number from 1e-06 to 1000 [m]");
  expect_refused(bed + "radius_min 0.03\nscene a\n",
                 ", line 7: scene is 'a'; allowed: a bed of which radius-max is '0.024'; allowed: ");
  expect_refused(bed + "grading fine\n", ", line 6: grading is 'fine'; allowed: uniform, mass");
  expect_refused(bed + "layer 0.01\nscene a\n",
                 ", line 7: scene is 'a'; allowed: a bed of which layer is '0.01'");
  expect_refused(
      bed + "layer 0.3 48-32\n",
      ", line 6: layer is '0.3 48-32'; allowed: a number from 1e-06 to 100000 [m], and behind it "
      "nothing, the smallest and the largest size, in mm, as 32-48, or relative_density and a number "
      ">= 0");
  expect_refused(bed + "layer 0.3 relative_density 2\nscene a\n",
                 ", line 7: scene is 'a'; allowed: relative densities of at most 1.");
  expect_refused(bed + "layer 0.3 relative_density -1\n",
                 ", line 6: layer is '0.3 relative_density -1'; allowed: a number from ");
  expect_refused(bed + "layer 0.3 relative_density 1\nlayer 0.3\nscene a\n",
                 ", line 8: scene is 'a'; allowed: relative_density of all layers, or of none");
  expect_refused(bed + "layer 0.3 relative_density 1\nradius_min 0.01\nscene a\n",
                 ", line 8: scene is 'a'; allowed: relative_density of layers without sizes of their own");
  for (const char *spot : {"0", "0.1 0.1", "0 x", "1 nan"})
    expect_refused(bed + "spot " + spot + "\n",
                   std::string(", line 6: spot is '") + spot +
                       "'; allowed: FROM TO, m from the middle of the box, in the order of the way");
  expect_refused(bed + "spot 0 0.1\nspot 0 0.2\n", ", line 7: spot is '0 0.2'; allowed: FROM TO");
  for (const char *spot : {"0 5", "0 0.01"})
    expect_refused(bed + "layer 0.3\nspot " + spot + "\nscene a\n",
                   ", line 8: scene is 'a'; allowed: a spot in the width of a bed of layers");
  expect_refused(bed + "layer 0.3 16 24\n", ", line 6: layer is '0.3 16 24'; allowed: a number from ");
  expect_refused(bed + "layer thick\n", ", line 6: layer is 'thick'; allowed: a number from ");
  expect_refused(bed + "layer 0\n", ", line 6: layer is '0'; allowed: a number from ");
  expect_refused(bed + "depth 0.2\nstiffness 1e8\nscene a\n",
                 ", line 8: scene is 'a'; allowed: stiffness and layer on a bed in the plane");
  expect_refused(
      "scaled_to 150\n" + bed + "scene a\n",
      ", line 1: scaled_to is '150'; allowed: with a plan of beds in the plane that has stiffness");
  expect_refused(bed + "seed_variable seed\nscene a\n",
                 ", line 7: scene is 'a'; allowed: without seed_variable");
}

/// The plan of a study of the project.
Plan plan_of(const std::string &study) {
  return post::read_plan(post::input_file("study/" + study + "/plan"));
}

double number_of(const Scene &scene, const std::string &name) {
  return std::stod(post::value_of(scene, name));
}

TEST(PlansOfTheProject, AreCompleteAndHaveTheResultsBesideThem) {
  const auto runs = [](const std::string &study) {
    std::size_t count = 0;
    for (const Scene &scene : plan_of(study).scenes)
      count += static_cast<std::size_t>(scene.seeds);
    return count;
  };
  EXPECT_EQ(runs("fidelity"), 19U * 5U);
  EXPECT_EQ(runs("friction"), 2U * 5U);
  EXPECT_EQ(runs("stiffness"), 8U * 5U);
  EXPECT_EQ(runs("box"), 3U * 6U + 10U * 3U);
  EXPECT_EQ(runs("suction"), 9U * 5U);
  EXPECT_EQ(runs("penetration"), 6U * 3U);
  EXPECT_EQ(runs("extremes"), 235U);
  EXPECT_EQ(runs("stability"), 6U * 30U + 2U);
  EXPECT_EQ(runs("benchmarks"), (post::has_lammps() ? 2U : 1U) * 143U);
  EXPECT_EQ(runs("drive"), 3U * 5U + 20U * 3U);
  for (const char *study : {"fidelity", "box", "friction", "stiffness", "damping", "scatter"}) {
    const Plan plan = plan_of(study);
    EXPECT_TRUE(plan.can_be_scaled()) << study;
    EXPECT_FALSE(plan.comparisons.empty()) << study;
    for (const Scene &scene :
         plan.scenes) { // a bed that hardens after it has settled is wedged between its walls
      EXPECT_TRUE(scene.bed.has_value()) << scene.name;
      const auto k_of = [&scene](SceneDeck stage) {
        for (const auto &[name, value] : post::variables_of(scene, stage))
          if (name == "k") return value;
        return std::string();
      };
      EXPECT_EQ(k_of(SceneDeck::settle), k_of(SceneDeck::run)) << scene.name;
      EXPECT_EQ(k_of(SceneDeck::settle), k_of(SceneDeck::place)) << scene.name;
    }
  }
  for (const char *study : {"fidelity", "box", "friction", "stiffness", "damping", "scatter", "drive"}) {
    const Plan plan = plan_of(study);
    const std::vector<post::Result> results =
        post::read_points(post::input_file(fmt::format("study/{}/runs.csv", study)), post::result_rows());
    EXPECT_FALSE(results.empty()) << study;
    std::set<std::string> scenes, quantities;
    for (const Scene &scene : plan.scenes)
      scenes.insert(scene.name);
    for (const post::Quantity &quantity : plan.quantities)
      quantities.insert(quantity.name + quantity.unit);
    for (const post::Result &result : results) {
      EXPECT_EQ(scenes.count(result.scene), 1U) << result.scene;
      EXPECT_EQ(quantities.count(result.quantity + result.unit), 1U) << result.quantity;
    }
  }
}

TEST(PlansOfTheProject, KeepTheProportionsOfABedOfAnotherSize) {
  // A quarter of the balls: lengths halve, masses and forces per metre are a quarter, so that the pressure
  // under the drum over its radius stays the same.
  const Plan small = plan_of("fidelity").with_balls(625);
  const Scene &complete = small.scene("complete");
  EXPECT_EQ(complete.bed->packing.balls, 625);
  EXPECT_DOUBLE_EQ(complete.bed->packing.width, 1.0);
  EXPECT_DOUBLE_EQ(number_of(complete, "r2"), 0.175);
  EXPECT_DOUBLE_EQ(number_of(complete, "m2"), 500.0);
  EXPECT_DOUBLE_EQ(number_of(complete, "Fw"), 14.7e3);
  EXPECT_DOUBLE_EQ(number_of(complete, "k"), 2.5e8); // k / m2 stays the same
  EXPECT_DOUBLE_EQ(number_of(complete, "dt"), 1.25e-5);
  EXPECT_EQ(number_of(complete, "steps_per_cycle"), 4000.0);
  EXPECT_EQ(number_of(complete, "cycles"), 8.0);
  EXPECT_EQ(number_of(small.scene("large balls"), "steps_per_cycle"), 2000.0);
  EXPECT_EQ(number_of(small.scene("twice the steps"), "steps_per_cycle"), 8000.0);
  EXPECT_EQ(number_of(small.scene("absorb"), "ground_depth"), 1.0);
  EXPECT_EQ(post::value_of(small.scene("layers"), "k"), "2.5e+07,2.5e+08");
  EXPECT_EQ(small.scene("large balls").bed->packing.balls, 156);
  EXPECT_NEAR(small.scene("layers").bed->balls(), 625, 25); // as deep as the complete bed
  EXPECT_EQ(plan_of("fidelity").with_balls(2500).scene("absorb").bed->packing.width, 2.0);
  // Stresses go with the lengths, and so does the attraction of balls that stay as large as they are.
  EXPECT_EQ(post::value_of(plan_of("damping").with_balls(150).scene("base rigid"), "suction"), "500");
  // Four scenes differ once the soil of the complete one has settled, and share it.
  int sharing = 0;
  for (const Scene &scene : small.scenes)
    sharing += post::soil_text(scene) == post::soil_text(complete) ? 1 : 0;
  EXPECT_EQ(sharing, 1 + 4);

  const Plan quick = plan_of("box").quick();
  EXPECT_EQ(quick.scenes.size(), 3U);
  EXPECT_EQ(quick.scenes[0].bed->packing.balls, 150);
  EXPECT_EQ(quick.scenes[0].seeds, 2);
  EXPECT_EQ(post::value_of(quick.scenes[0], "cycles"), "4");
  ASSERT_EQ(quick.comparisons.size(), 3U); // two, and that over all boxes, of which one is left
  EXPECT_EQ(quick.comparisons[2].pairs.size(), 1U);
}

} // namespace
} // namespace drumlin::test
