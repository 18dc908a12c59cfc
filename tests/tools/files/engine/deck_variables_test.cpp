// The variables of a deck, read without the engine.
#include "engine/deck_variables.h"

#include "tests/support/engine_runs.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>

namespace drumlin::test {
namespace {

class DeckHelp : public ::testing::Test {
protected:
  void write(const char *name, const std::string &text) const { std::ofstream(scratch_ / name) << text; }
  std::string text(const std::map<std::string, std::string> &given = {}) const {
    return post::variables_text(post::deck_variables(scratch_ / "in.deck", given), 100);
  }
  /// "DEFAULT UNIT (RANGE)" of a variable, with one blank between words; empty: not listed.
  std::string line(const std::string &name, const std::map<std::string, std::string> &given = {}) const {
    std::istringstream lines(text(given));
    for (std::string one; std::getline(lines, one);) {
      std::istringstream words(one);
      std::string word, rest;
      if (one.rfind("  ", 0) != 0 || one.rfind("   ", 0) == 0 || !(words >> word) || word != name) continue;
      for (; words >> word;)
        rest += (rest.empty() ? "" : " ") + word;
      return rest;
    }
    return "";
  }
  const Scratch scratch_;
};

TEST_F(DeckHelp, ReadsDeclarationsWhereverTheyStand) {
  write("in.deck", "variable k index 2e8 # its own default\n"
                   "include ${here}/shared\n"
                   "drumlin/variable out results/v_2/rev_1 output_folder - run \"where # it goes\"\n"
                   "drumlin/variable note none noted - run \"of a file\"\n"
                   "drumlin/variable n $(2*v_k) \"integer 1 &\n  9\" - run \"a count &\n   of things\"\n");
  write("shared", "drumlin/variable k 1e8 positive N/m soil 'stiffness'\n"
                  "drumlin/variable case one \"suffix_of ${here}/case.\" - soil \"a case\"\n"
                  "include ${here}/case.${case}\n"
                  "drumlin/variable D 0.5 \"each non_negative\" 1 soil \"damping\"\n");
  write("case.one", "variable D index 0.1\n");
  write("case.two", "variable D index 0.2\n");
  EXPECT_EQ(line("k"), "2e8 N/m (> 0)");
  EXPECT_EQ(line("out"), "results/v_2/rev_1 (a folder)");
  EXPECT_EQ(line("note"), "");
  EXPECT_EQ(line("n"), "2*k (1 to 9)");
  EXPECT_EQ(line("case"), "one (one, two)");
  EXPECT_EQ(line("D"), "0.1 (>= 0, or a list)");
  EXPECT_EQ(line("D", {{"case", "two"}}), "0.2 (>= 0, or a list)");
  EXPECT_NE(text().find("where # it goes"), std::string::npos);
  EXPECT_NE(text().find("a count of things"), std::string::npos);
  EXPECT_LT(text().find("soil:"), text().find("run:")); // what every deck has stands last
}

TEST_F(DeckHelp, ReadsTables) {
  write("in.deck", "drumlin/variables ${here}/table scene\ninclude ${here}/case.${case}\n"
                   "drumlin/variables ${here}/table soil\ndrumlin/variables\n");
  write("table",
        "# name default unit rule group meaning\ncase one - \"suffix_of ${here}/case.\" scene a case\n"
        "k 1e8 N/m positive soil stiffness\nkt $(2/7*v_k) N/m positive soil of tangential springs\n"
        "speed 1 m/s positive way of another deck\n");
  write("case.one", "variable k index 2e8\n");
  EXPECT_EQ(line("case"), "one (one)");
  EXPECT_EQ(line("k"), "2e8 N/m (> 0)");
  EXPECT_EQ(line("kt"), "2/7*k N/m (> 0)");
  EXPECT_EQ(line("speed"), "");
}

TEST_F(DeckHelp, FollowsConditionsThatItKnows) {
  write("in.deck", "drumlin/variable dimension 2 \"one_of 2 3\" - run \"of the scene\"\n"
                   "if \"${dimension} == 3\" then \"variable k index 4e6\" else \"variable k index 5e6\"\n"
                   "variable with equal 0\n"
                   "variable same equal v_with\n"
                   "if \"${same} == 0\" then \"jump SELF behind\"\n"
                   "drumlin/variable hidden 1 any - run \"not declared\"\n"
                   "label behind\n"
                   "if \"$(step) > 0\" then \"jump SELF nowhere\"\n"
                   "drumlin/variable k 1e8 positive N/m run \"stiffness\"\n"
                   "label nowhere\n");
  EXPECT_EQ(line("k"), "5e6 N/m (> 0)");
  EXPECT_EQ(line("k", {{"dimension", "3"}}), "4e6 N/m (> 0)");
  EXPECT_EQ(line("hidden"), "");
}

TEST_F(DeckHelp, EndsWhenAFileIncludesItself) {
  write("in.deck", "include ${here}/in.deck\ninclude ${here}/in.deck\ninclude ${here}/missing\n"
                   "drumlin/variable k 1e8 positive N/m run \"stiffness\"\ndrumlin/variable too few words\n");
  EXPECT_EQ(line("k"), "1e8 N/m (> 0)");
}

} // namespace
} // namespace drumlin::test
