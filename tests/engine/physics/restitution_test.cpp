// damping restitution: an impact in the engine gives back the share of the speed that the deck asks for,
// under A and B.

#include "tests/support/checks.h"
#include "tests/support/host_deck.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <sstream>

namespace drumlin::test {
namespace {

constexpr double speed = 0.4;
// The gap puts the first contact inside a step.
const std::string impact = "displace_atoms drum move 0 0 1.3e-5 units box\n"
                           "velocity drum set 0 0 -0.4 units box\n"
                           "dump state drum custom 5000 state.txt id vz\n";

/// The last vz of the drum over its speed before.
double measured(const Scratch &folder, const Outcome &outcome) {
  EXPECT_TRUE(outcome.ok()) << outcome.output;
  std::istringstream words(read_text(folder / "state.txt"));
  std::string last;
  while (words >> last) {
  }
  return std::stod(last) / speed;
}

class DampingRestitution : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Transition, DampingRestitution, ::testing::Values("A", "B"),
                         [](const auto &row) { return row.param; });

TEST_P(DampingRestitution, IsThatOfAnImpactInLiggghts) {
  for (const double e : {0.3, 0.7}) {
    const Scratch folder;
    const std::string law = "pair_style gran model hooke/transition damping restitution transition " +
                            GetParam() + "\npair_coeff * *\n" +
                            property("coefficientRestitution", std::to_string(e));
    const Outcome outcome =
        run_host(law + host_properties(), "unfix gravity\n" + impact + "run 5000\n", folder.path(), 1);
    EXPECT_NEAR(measured(folder, outcome), e, 2e-5);
  }
}

TEST_P(DampingRestitution, IsThatOfAnImpactInLammps) {
  if (!post::has_lammps()) GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  for (const double e : {0.3, 0.7}) {
    const Scratch folder;
    write_text(folder / "lines",
               fmt::format("pair_style gran/hooke/transition damping restitution transition {}\n"
                           "pair_coeff * * 1e7 {}\nfix integrate drum nve/sphere\nfix soil soil freeze\n{}"
                           "run 5000\n",
                           GetParam(), e, impact));
    const Outcome outcome = run_deck(std::filesystem::path(DRUMLIN_SOURCE_DIR) / "tests/support/host.lammps",
                                     {{"lines", (folder / "lines").string()}}, folder.path(), 1);
    EXPECT_NEAR(measured(folder, outcome), e, 2e-5);
  }
}

} // namespace
} // namespace drumlin::test
