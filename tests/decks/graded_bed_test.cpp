// The decks of the bed on balls of a given grading: the files note it, and the time steps follow the smallest
// ball.
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"

#include "runs/parameter_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

fs::path deck(const char *name) { return fs::path(DRUMLIN_SOURCE_DIR) / "inputs/bed" / name; }

/// A scene of the decks from balls to a cycle of excitation, hardly settled; its parameters.csv.
std::map<std::string, std::string> parameters_of(const Scratch &folder, const std::vector<std::string> &sizes,
                                                 const std::string &case_name, const char *last_deck) {
  std::vector<std::string> words = {DRUMLIN_TOOLS, "bed", "--balls", "40",
                                    "--width",     "0.4", "--out",   "balls"};
  words.insert(words.end(), sizes.begin(), sizes.end());
  well(run_program(words, {}, folder.path()));
  well(
      run_deck(deck("in.settle"),
               {{"case", case_name}, {"balls", "balls"}, {"bed", "soil"}, {"fall", "0.01"}, {"ratio", "1e9"}},
               folder.path()));
  well(run_deck(deck("in.place"),
                {{"case", case_name},
                 {"bed", "soil"},
                 {"start", "roller"},
                 {"sink", "0"},
                 {"ratio", "1e9"},
                 {"r2", "0.1"},
                 {"r3", "0.05"},
                 {"m2", "1000"},
                 {"m3", "500"}},
                folder.path()));
  // A cycle of 20 Hz, from which the number of steps follows.
  well(run_deck(deck(last_deck),
                {{"start", "roller"}, {"out", "B"}, {"cycles", "1"}, {"Fw", "1"}, {"balance", "1e30"}},
                folder.path()));
  return post::read_parameters(folder / "B/parameters.csv");
}

/// Time steps at 20 Hz in half of an undamped oscillation of two of the smallest balls on each other: closed
/// form.
double steps_in_contact(double mass, double k, double steps_per_cycle) {
  constexpr double pi = 3.141592653589793;
  return pi * std::sqrt(0.5 * mass / k) * 20.0 * steps_per_cycle;
}

TEST(GradedBedDecks, NoteTheGradingAndFollowTheSmallestDisc) {
  const Scratch folder;
  std::map<std::string, std::string> made =
      parameters_of(folder, {"--sieve", "WMM", "--cut", "14"}, "gravel", "in.bed");
  EXPECT_EQ(made["grading"], "WMM_from_14mm");
  EXPECT_EQ(made["r_min"], "0.007");
  EXPECT_EQ(made["r_max"], "0.0265");
  EXPECT_NEAR(std::stod(made["d50"]), 0.0276, 0.002);
  EXPECT_NEAR(std::stod(made["C_u"]), 1.9, 0.2);
  const auto disc = [](double r) { return 3.141592653589793 * r * r * 2650.0; };
  const double steps = std::stod(made["steps_per_cycle"]);
  EXPECT_EQ(std::fmod(steps, 250.0), 0.0);
  EXPECT_NEAR(steps_in_contact(disc(0.007), 1e9, steps), steps_in_contact(disc(0.016), 1e9, 8000), 0.3);
}

TEST(GradedBedDecks, FollowTheSmallestSphere) {
  const Scratch folder;
  std::map<std::string, std::string> made =
      parameters_of(folder, {"--sieve", "WMM", "--cut", "20", "--depth", "0.08"}, "gravel3d", "in.bed3d");
  const auto sphere = [](double r) { return 4.0 / 3.0 * 3.141592653589793 * r * r * r * 2650.0; };
  const double steps = std::stod(made["steps_per_cycle"]);
  EXPECT_NEAR(steps_in_contact(sphere(0.010), 4e7, steps), steps_in_contact(sphere(0.016), 4e7, 12500), 0.3);
}

TEST(GradedBedDecks, KeepTheStepsOfGravel) {
  const Scratch folder;
  std::map<std::string, std::string> made = parameters_of(folder, {}, "gravel", "in.bed");
  EXPECT_EQ(made["steps_per_cycle"], "8000");
  EXPECT_EQ(made["grading"], "uniform");
}

// The base course has about as many steps in a contact, which is unloaded with the stiffness k yield.
TEST(GradedBedDecks, HaveStepsForContactsOfTheBaseCourseThatAreUnloaded) {
  const Scratch folder;
  std::map<std::string, std::string> made = parameters_of(folder, {}, "base", "in.bed");
  const double k2 = std::stod(made["k"]) * std::stod(made["yield"]),
               mass = 3.141592653589793 * 2.56e-4 * 2650;
  EXPECT_NEAR(steps_in_contact(mass, k2, std::stod(made["steps_per_cycle"])),
              steps_in_contact(mass, 1e9, 8000), 0.5);
}

} // namespace
} // namespace drumlin::test
