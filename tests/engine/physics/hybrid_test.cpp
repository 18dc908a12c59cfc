// Hybrid pair styles: a scene gives the same results with the law as a part of a hybrid style as with the law
// alone, with every fix.

#include "tests/support/checks.h"
#include "tests/support/host_deck.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <tuple>

namespace drumlin::test {
namespace {

const std::string outputs =
    "fix guard all guard every 1 links 1\n"
    "fix events all contact/events file events.csv\n"
    "fix contacts all contact/local every 5\n"
    "fix history drum roller/history file history.csv every 1 axis 0 0 1\n"
    "dump state all custom 5 state.txt id z vz fz\n"
    "dump contacts all local 5 contacts.txt f_contacts[1] f_contacts[2] f_contacts[5] f_contacts[9]\n";

/// The files that the run wrote.
std::vector<std::string> files_of(const Scratch &folder, const Outcome &outcome) {
  EXPECT_TRUE(outcome.ok()) << outcome.output;
  std::vector<std::string> texts;
  for (const char *name : {"state.txt", "events.csv", "contacts.txt", "history.csv"})
    texts.push_back(read_text(folder / name));
  return texts;
}

std::vector<std::string> in_liggghts(const std::string &pair, int ranks) {
  const Scratch folder;
  const std::string excite = "fix excite drum drum/excite amplitude 1e6 omega 5e4\n";
  const std::string wall =
      "fix wall all wall/gran model hooke/transition tangential history primitive type 1 zplane -0.99\n";
  return files_of(folder, run_host(pair + host_properties(), excite + wall + outputs, folder.path(), ranks));
}

TEST(HybridPairStyle, GoesAsTheLawAloneInLiggghts) {
  const std::string law = "gran model hooke/transition tangential history";
  for (const int ranks : {1, 2}) {
    const std::vector<std::string> alone = in_liggghts("pair_style " + law + "\npair_coeff * *\n", ranks);
    EXPECT_EQ(in_liggghts("pair_style hybrid " + law + "\npair_coeff * * gran\n", ranks), alone);
    EXPECT_EQ(in_liggghts("pair_style hybrid/overlay " + law + "\npair_coeff * * gran\n", ranks), alone);
  }
}

std::vector<std::string> in_lammps(const std::string &pair, int ranks) {
  const Scratch folder;
  const std::string scene =
      "fix gravity all gravity 9.81 vector 0 0 -1\nvelocity drum set 0 0 -1 units box\n"
      "fix wall all wall/gran/transition 1 zplane -0.99 NULL\nfix integrate all nve/sphere\n";
  write_text(folder / "lines", pair + scene + outputs + "run 20\n");
  return files_of(folder, run_deck(std::filesystem::path(DRUMLIN_SOURCE_DIR) / "tests/support/host.lammps",
                                   {{"lines", (folder / "lines").string()}}, folder.path(), ranks));
}

TEST(HybridPairStyle, GoesAsTheLawAloneInLammps) {
  if (!post::has_lammps()) GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  const std::string law = "gran/hooke/transition tangential history", name = "gran/hooke/transition";
  const std::string coefficients = " 1e7 0.5 0.3\n";
  for (const int ranks : {1, 2}) {
    const std::vector<std::string> alone =
        in_lammps(fmt::format("pair_style {}\npair_coeff * *{}", law, coefficients), ranks);
    EXPECT_EQ(
        in_lammps(fmt::format("pair_style hybrid {}\npair_coeff * * {}{}", law, name, coefficients), ranks),
        alone);
    EXPECT_EQ(
        in_lammps(
            fmt::format(
                "pair_style hybrid/overlay {} lj/cut 0.1\npair_coeff * * lj/cut 0 1\npair_coeff * * {}{}",
                law, name, coefficients),
            ranks),
        alone);
  }
}

/// A run in two halves, the second from the first's restart file in a process of its own; the last dump of
/// both. `again` has the lines of the pair style in the second deck.
std::vector<std::string> in_halves(const std::string &pair, const std::string &again, int ranks) {
  const Scratch folder;
  const std::string scene = "fix gravity all gravity 9.81 vector 0 0 -1\n"
                            "fix wall all wall/gran/transition 1 zplane -0.99 NULL\n"
                            "fix integrate all nve/sphere\n";
  const std::string rest = "dump state all custom 10 state.txt id x z vx vz fx fz tqy\ndump_modify state "
                           "format float %.17g\nrun 10\n";
  write_text(folder / "lines", pair + "velocity drum set 0.3 0 -1 units box\n" + scene +
                                   "run 10\nwrite_restart half.restart\n" + rest);
  well(run_deck(std::filesystem::path(DRUMLIN_SOURCE_DIR) / "tests/support/host.lammps",
                {{"lines", (folder / "lines").string()}}, folder.path(), ranks));
  std::vector<std::string> states = {read_text(folder / "state.txt")};
  write_text(folder / "second.lammps", "plugin load ${plugin}\natom_modify map array sort 0 0\nnewton off\n"
                                       "comm_modify vel yes\nread_restart half.restart\ntimestep 1e-5\n" +
                                           again + scene + rest);
  const Outcome second = run_deck(folder / "second.lammps", {}, folder.path(), ranks);
  states.push_back(second.ok() ? read_text(folder / "state.txt") : second.output);
  return states;
}

// Pair style hybrid keeps no coefficients in restart files; settings and contact history are there, also if a
// deck gives them again.
TEST(HybridPairStyle, ContinuesFromARestartFileBitwiseInLammps) {
  if (!post::has_lammps()) GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  const std::string law = "gran/hooke/transition tangential history transition A damping coefficient";
  const std::string alone = "pair_coeff * * 1e7 1e4 0.3\n";
  const std::string part = "pair_coeff * * gran/hooke/transition 1e7 1e4 0.3\n";
  const std::string hybrid = fmt::format("pair_style hybrid {}\n", law);
  const std::string again = "pair_style " + law + "\n" + alone;
  for (const auto &[first, second, ranks] : {std::tuple(hybrid + part, part, 1),
                                             {hybrid + part, hybrid + part, 2},
                                             {again, std::string(), 1},
                                             {again, again, 1}}) {
    const std::vector<std::string> states = in_halves(first, second, ranks);
    EXPECT_EQ(states[0], states[1]) << second << ", ranks " << ranks;
  }
  EXPECT_TRUE(contains(in_halves(hybrid + part, "", 1)[1], "ERROR: "));
}

/// The second pair_style line of a deck replaces the first: its settings decide what the contact history
/// contains.
TEST(PairStyle, MayBeGivenAgainInLammps) {
  if (!post::has_lammps()) GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  const std::string second =
      "pair_style gran/hooke/transition tangential history stepping stock transition A\n"
      "pair_coeff * * 1e7 0.5 0.3\n";
  const std::string before = "pair_style gran/hooke/transition\npair_coeff * * 1e6 0.1\n";
  EXPECT_EQ(in_lammps(before + "run 0\n" + second, 1), in_lammps(second, 1));
}

/// The helper fix of the second-order scheme does nothing once no pair style needs it.
TEST(PairStyle, GivesWayToTheEnginesOwnBetweenTwoRuns) {
  const Scratch folder;
  std::string stiffness = "pair_style gran model hooke/stiffness\npair_coeff * *\n";
  for (const char *name : {"kt", "gamman", "gammat"})
    stiffness += property(name, "1e5");
  well(run_host(host_pair_style() + host_properties(), "run 2\n" + stiffness, folder.path(), 1));
}

} // namespace
} // namespace drumlin::test
