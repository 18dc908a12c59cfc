// The output values of the fixes, read by all output features of the engines: computes, averages, histograms,
// variables and thermo.

#include "tests/support/checks.h"
#include "tests/support/host_deck.h"

#include <gtest/gtest.h>

namespace drumlin::test {
namespace {

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

} // namespace
} // namespace drumlin::test
