// What decks get and give: values of the fixes in the output of the engines, variables, notes.
#include "tests/support/checks.h"
#include "tests/support/host_deck.h"

#include <gtest/gtest.h>

namespace drumlin::test {
namespace {

// The output values of the fixes, read by all output features of the engines: computes, averages, histograms,
// variables and thermo.
namespace outputs {

const std::string takers =
    "fix contacts all contact/local every 5\n"
    "fix guard all guard\n"
    "fix events all contact/events file ev.csv\n"
    "fix excite drum drum/excite amplitude 1e6 omega 5e4 direction 0 0 -1\n"
    "fix bond all bond/spring 1 2 1 1\n"
    "fix history drum roller/history file history.csv every 5 axis 0 0 1\n"
    "compute deepest all reduce max f_contacts[9] ${local}\n"
    "compute total all reduce sum f_contacts[3] f_contacts[4] f_contacts[5] ${local}\n"
    "fix averages all ave/time 5 1 5 c_deepest c_total[3] f_guard f_guard[1] f_guard[2] f_events f_bond "
    "f_bond[1] f_bond[5] f_excite f_excite[1] f_history[8] file averages.txt\n"
    "fix histogram all ave/histo 5 1 5 0 0.1 5 f_contacts[9] mode vector file histogram.txt\n"
    "variable d equal c_deepest+f_history[8]\n"
    "thermo_style custom step f_guard f_guard[1] f_events f_bond f_bond[2] f_excite f_excite[6] f_history[1] "
    "f_history[10] c_deepest c_total[3] v_d\n"
    "thermo 5\n";

void expect_outputs(const Scratch &folder, const Outcome &outcome) {
  ASSERT_TRUE(outcome.ok()) << outcome.output;
  EXPECT_GT(lines_of(read_text(folder / "averages.txt")).size(), 4U);
  // The wall of the host's line holds the soil ball with an overlap of 0.01 m, which is in the first of five
  // bins.
  const std::vector<std::string> histogram = lines_of(read_text(folder / "histogram.txt"));
  ASSERT_GT(histogram.size(), 4U);
  EXPECT_EQ(histogram[4].rfind("1 0.01 ", 0), 0U) << histogram[4];
  EXPECT_FALSE(contains(histogram[4], " 0 0"));
}

TEST(OutputsOfFixes, GoIntoAllOutputsOfLiggghts) {
  const Scratch folder;
  const std::string wall = "variable local string \"\"\n"
                           "fix wall all wall/gran model hooke/transition primitive type 1 zplane -0.99\n";
  expect_outputs(folder, run_host(host_pair_style() + host_properties(), wall + takers, folder.path(), 1));
}

TEST(OutputsOfFixes, GoIntoAllOutputsOfLammps) {
  if (!post::has_lammps()) GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  const Scratch folder;
  // Later releases of LAMMPS need a keyword which says that the numbers are not per-atom values.
  write_text(folder / "lines", "variable local string \"\"\n"
                               "if \"$(version) > 20231120\" then \"variable local string 'inputs local'\"\n"
                               "pair_style gran/hooke/transition\npair_coeff * * 1e7 0.5\n"
                               "fix wall all wall/gran/transition 1 zplane -0.99 NULL\n" +
                                   takers + "fix integrate all nve/sphere\nrun 20\n");
  expect_outputs(folder, run_deck(std::filesystem::path(DRUMLIN_SOURCE_DIR) / "tests/support/host.lammps",
                                  {{"lines", (folder / "lines").string()}}, folder.path()));
}

} // namespace outputs

// drumlin/variable: where a value comes from, the rows of drumlin/record, and notes of drumlin/write that a
// later deck takes. In both engines, without a box, and again after `clear`.
namespace variables {

const std::string declarations = "drumlin/variable k 1 positive N/m soil \"stiffness\"\n"
                                 "drumlin/variable D 0.3 \"each positive\" 1 soil \"damping ratio\"\n"
                                 "drumlin/variable mu 0.5 non_negative 1 soil \"friction\"\n"
                                 "drumlin/variable loads \"25 50\" words kPa test \"stresses\"\n"
                                 "drumlin/variable made 1 noted - test \"a value that only files give\"\n"
                                 "drumlin/variable out results output_folder - run \"folder\"\n"
                                 "drumlin/variables\n";

class DeckVariablesTest : public ::testing::TestWithParam<bool> {
protected:
  /// Runs lines, in LAMMPS behind `plugin load`.
  Outcome run(const std::string &lines, const Variables &variables) {
    const bool lammps = GetParam();
    const std::filesystem::path deck = folder_ / (lammps ? "own.lammps" : "own.in");
    write_text(deck, load() + lines);
    return run_deck(deck, variables, folder_.path());
  }
  /// Begins a deck; after `clear` LAMMPS has unloaded the plugin.
  static std::string load() { return GetParam() ? "plugin load ${plugin}\n" : ""; }
  /// The value of a row of parameters.csv; "none": there is no such row.
  std::string row(const std::string &name) const {
    std::string value = "none";
    for (const std::string &line : lines_of(read_text(folder_ / "parameters.csv")))
      if (line.rfind(name + ",", 0) == 0) value = value == "none" ? line.substr(name.size() + 1) : "twice";
    return value;
  }
  static std::string box() {
    return "units si\natom_style " + std::string(GetParam() ? "sphere" : "granular") +
           "\nregion box block 0 1 0 1 0 1 units box\ncreate_box 1 box\n"
           "create_atoms 1 single 0.5 0.5 0.5 units box\nset group all diameter 0.1 density 1000\n";
  }
  void SetUp() override {
    if (GetParam() && !post::has_lammps())
      GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  }

  Scratch folder_;
};

// The command line comes before an earlier line, this before the default; a value that the deck records
// itself stands in the file instead of the declared one.
TEST_P(DeckVariablesTest, RecordTheirValues) {
  well(run("variable D index 0.4\nvariable mu index 0.6\n" + declarations +
               "drumlin/record parameters.csv deck own loads * kt $(v_k/2)\n",
           {{"k", "8"}, {"mu", "0.7"}}));
  EXPECT_EQ(row("k"), "8");
  EXPECT_EQ(row("D"), "0.4");
  EXPECT_EQ(row("mu"), "0.7");
  EXPECT_EQ(row("loads"), "\"25,50\"");
  EXPECT_EQ(row("made"), "1");
  EXPECT_EQ(row("kt"), "4");
}

TEST_P(DeckVariablesTest, AreNotedInFilesAndTaken) {
  well(run(declarations + box() +
               "variable E index 3\ndrumlin/write data own.data made 7 groups soil values_of E\n",
           {{"k", "8"}, {"D", "0.1,0.2"}}));
  const std::string take = "drumlin/take own.data \"the first deck\" mu fixed test free soil\n";
  EXPECT_TRUE(printed(run(take + declarations, {}), "variable loads is '25 50'; allowed: a file that notes"));
  const std::string record = "drumlin/record parameters.csv E ${E}\n";
  const std::string free = "drumlin/take own.data \"the first deck\" mu free soil\n";
  well(run(free + declarations + "clear\n" + load() + declarations + record, {{"mu", "0.9"}}));
  EXPECT_EQ(row("k"), "8");
  EXPECT_EQ(row("D"), "\"0.1,0.2\"");
  EXPECT_EQ(row("mu"), "0.9"); // changed on purpose
  EXPECT_EQ(row("made"), "7");
  EXPECT_EQ(row("E"), "3");
  // The same number in another notation is the same value; another number is not.
  EXPECT_TRUE(run(free + declarations, {{"k", "8.0e0"}, {"D", "1e-1,0.2"}}).ok());
  EXPECT_TRUE(
      printed(run(free + declarations, {{"D", "0.1,0.3"}}),
              "ERROR: drumlin/variable: variable D is '0.1,0.3'; allowed: 0.1,0.2, with which 'own.data' "
              "was made; for another value run the first deck again"));
}

// A file that was made before a deck had the variable was made with its default.
TEST_P(DeckVariablesTest, ThatAreNewHaveTheirDefaultsInEarlierFiles) {
  well(run(declarations + box() + "drumlin/write data own.data made 7 groups soil\n", {}));
  const auto taken = [](const std::string &later) {
    return "drumlin/take own.data \"the first deck\" pull free soil" + later + "\n" +
           "drumlin/variable pull 0 non_negative N soil attraction\n" +
           "drumlin/variable yield 1 positive 1 soil stiffness\n" + declarations +
           "drumlin/record parameters.csv\n";
  };
  EXPECT_TRUE(printed(run(taken(""), {}), "variable pull is '0'; allowed: a file that notes"));
  well(run(taken(" later pull yield"), {{"pull", "5"}}));
  EXPECT_EQ(row("pull"), "5"); // changed on purpose
  EXPECT_EQ(row("yield"), "1");
  EXPECT_TRUE(printed(run(taken(" later pull yield"), {{"yield", "3"}}),
                      "variable yield is '3'; allowed: 1, with which 'own.data' was made"));
}

// A table does what its lines would do in the deck: formulas of variables above, values that the deck has set
// before, groups of which each has its own default; what is declared already keeps its declaration.
TEST_P(DeckVariablesTest, StandInATable) {
  write_text(folder_ / "own.variables",
             "# name default unit rule group meaning\n"
             "case    II   -      \"one_of I II\" scene a case\n"
             "limit   5    -      any           scene of others\n\n"
             "k       1e8  N/m    positive      soil  stiffness, of \"all\" contacts\n"
             "kt      $(2/7*v_k) \"N s\" \"below ${limit}e9\" soil tangential\n"
             "of_kt   ${kt} N/m   positive      soil  the same text\n"
             "length  3    m      positive      short of the run\n"
             "length  30   m      positive      long  of the run\n"
             "out     out  -      output_folder long  of files\n");
  const std::string deck = "drumlin/variable limit 4 any - run \"of a deck of one's own\"\n"
                           "drumlin/variables own.variables scene\nvariable k index 7e8\n"
                           "drumlin/variables own.variables soil long\ndrumlin/variables\n"
                           "drumlin/record parameters.csv\n";
  well(run(deck, {{"case", "I"}}));
  EXPECT_EQ(row("case"), "I");
  EXPECT_EQ(row("limit"), "4");
  EXPECT_EQ(row("k"), "7e8");
  EXPECT_EQ(std::stod(row("kt")), 2.0 / 7.0 * 7e8);
  EXPECT_EQ(row("of_kt"), row("kt"));
  EXPECT_EQ(row("length"), "30");
  EXPECT_TRUE(printed(run(deck, {{"kt", "4e9"}}), "ERROR: drumlin/variable: variable kt is '4e9'; allowed: "
                                                  "a finite number below 4e+09"));
  EXPECT_TRUE(
      printed(run(deck, {{"kk", "1"}}), "allowed: k, the nearest of limit, case, k, kt, of_kt, length"));
}

TEST_P(DeckVariablesTest, OfAnUnknownNameAreRefusedFirst) {
  EXPECT_TRUE(printed(run(declarations, {{"K", "1"}, {"k", "-1"}}),
                      "ERROR: drumlin/variables: -var K is '1', a variable that this deck does not have; "
                      "allowed: k, the nearest of k, D, mu, loads, out"));
  EXPECT_TRUE(printed(run(declarations, {{"made", "1"}}), "-var made is '1', a variable that this deck"));
  EXPECT_TRUE(printed(run(declarations, {{"D", "1 2"}}), "ERROR: drumlin/variable"));
  EXPECT_TRUE(run(declarations, {{"loads", "100 200"}}).ok());
}

INSTANTIATE_TEST_SUITE_P(Engines, DeckVariablesTest, ::testing::Bool(),
                         [](const auto &engine) { return engine.param ? "Lammps" : "Liggghts"; });

} // namespace variables

} // namespace
} // namespace drumlin::test
