// Balls that fall on one another between walls, with each contact law of the list: the engines against each
// other on 1, 2 and 4 ranks, and from restart files.
#include "tests/support/balls_run.h"
#include "tests/support/checks.h"
#include "tests/support/frame_distance.h"
#include "tests/core/law_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace drumlin::test {
namespace {

struct Scene {
  std::string name;
  Variables variables;
  bool all_runs = false;       ///< on each number of ranks with newton off and on, by night on four
  std::string properties = {}; ///< of a law that the decks do not know: commands of LIGGGHTS,
  std::string words = {};      ///< words of LAMMPS's pair_coeff
};

void PrintTo(const Scene &scene, std::ostream *out) { *out << scene.name; }

class LawBounce : public ::testing::TestWithParam<Scene> {
protected:
  void SetUp() override {
    if (!post::has_lammps()) GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  }
  /// \param folder of the run
  static Variables variables(const Scratch &folder, bool lammps) {
    Variables all = GetParam().variables;
    if (GetParam().words.empty()) return all;
    std::ofstream(folder / "properties") << GetParam().properties;
    all.emplace_back("parameters", lammps ? GetParam().words : "include " + (folder / "properties").string());
    return all;
  }
};

TEST_P(LawBounce, IsOneInBothEnginesOnSeveralRanksWithNewtonOffAndOn) {
  const Scratch liggghts;
  well(run_deck(test_deck("bounce.in"), variables(liggghts, false), liggghts.path()));
  const std::vector<Frame> expected = read_dump(liggghts / "balls.txt");
  ASSERT_EQ(expected.size(), 13u);
  std::vector<std::pair<int, const char *>> runs = {{1, "off"}, {2, "on"}, {4, "off"}};
  if (GetParam().all_runs) runs.insert(runs.end(), {{1, "on"}, {2, "off"}, {4, "on"}});
  for (const auto &[ranks, newton] : runs) {
    if (ranks > most_ranks()) continue;
    const Scratch lammps;
    const Variables more = with(variables(lammps, true), {{"newton", newton}});
    well(run_deck(test_deck("bounce.lammps"), more, lammps.path(), ranks));
    EXPECT_LT(distance(read_dump(lammps / "balls.txt"), expected), 1e-9)
        << "ranks " << ranks << ", newton " << newton;
  }
  for (int ranks = 2; ranks <= most_ranks(); ranks *= 2) {
    if (ranks > 2 && !GetParam().all_runs) continue;
    const Scratch more;
    well(run_deck(test_deck("bounce.in"), variables(more, false), more.path(), ranks));
    EXPECT_LT(distance(read_dump(more / "balls.txt"), expected), 1e-9) << ranks;
  }
}

// From a file of write_restart between two runs, and from one that `restart` has written within a run. Under
// the second-order scheme a run in two parts is also that in one; under `stock` the engine's set-up takes
// other velocities for the dashpots.
TEST_P(LawBounce, ContinuesBitwiseInPartsOnRanks) {
  struct Run {
    const char *deck, *resume;
    int ranks;
    const char *newton; ///< in LAMMPS alone
  };
  const std::pair<std::string, std::string> stock{"stepping", "stock"};
  std::vector<Run> runs = {{"bounce.in", "bounce.resume.in", 1, ""},
                           {"bounce.lammps", "bounce.resume.lammps", 1, "off"},
                           {"bounce.in", "bounce.resume.in", 2, ""},
                           {"bounce.lammps", "bounce.resume.lammps", 2, "on"}};
  if (GetParam().all_runs)
    runs.insert(runs.end(), {{"bounce.in", "bounce.resume.in", 4, ""},
                             {"bounce.lammps", "bounce.resume.lammps", 4, "off"},
                             {"bounce.lammps", "bounce.resume.lammps", 4, "on"}});
  for (const auto &[deck, resume, ranks, newton] : runs) {
    if (ranks > most_ranks()) continue;
    const Scratch stayed;
    Variables law = variables(stayed, std::string(deck) == "bounce.lammps");
    if (*newton != '\0') law.emplace_back("newton", newton);
    well(run_deck(test_deck(deck), law, stayed.path(), ranks));
    const auto second_part = [](const Scratch &run) {
      const std::string all = read_text(run / "balls.txt"), from = "ITEM: TIMESTEP\n7000\n";
      return all.find(from) == std::string::npos ? "" : all.substr(all.find(from));
    };
    const std::string expected = second_part(stayed);
    ASSERT_FALSE(expected.empty());
    const bool is_lammps = std::string(resume) == "bounce.resume.lammps";
    for (const char *file : {"first.restart", "during.6000"}) {
      const Scratch left;
      Variables resumed = with(law, {{"start", (stayed / file).string()}});
      if (is_lammps) resumed.emplace_back("law", "restart");
      well(run_deck(test_deck(resume), resumed, left.path(), ranks));
      EXPECT_EQ(expected, second_part(left))
          << deck << ", " << file << ", ranks " << ranks << ", newton " << newton;
    }
    if (std::find(law.begin(), law.end(), stock) != law.end()) continue;
    const Scratch whole;
    well(run_deck(test_deck(deck), with(law, {{"part", "12000"}, {"rest", "0"}}), whole.path(), ranks));
    EXPECT_EQ(expected, second_part(whole)) << deck << ", ranks " << ranks << ", newton " << newton;
  }
}

/// A law that the decks do not know, with its parameters in the words of both engines.
template <class Law>
Scene scene_of() {
  const std::string law = Law::name;
  std::string commands = "#", words;
  for_each_given<Law>(1e5, [&](const auto &p, double value) {
    if (may_be_left_out(p)) return;
    const std::string number = test::number(value);
    const bool of_types = std::is_same_v<std::decay_t<decltype(p)>, physics::MaterialParameter>;
    commands += std::string("\nfix ") + p.property + " all property/global " + p.property +
                (of_types ? " peratomtype " + number + " " + number
                          : " peratomtypepair 2 " + number + " " + number + " " + number + " " + number);
    words += (words.empty() ? "" : " ") + number;
  });
  return {law.substr(0, law.find('/')),
          {{"normal", law.substr(0, law.find('/'))}, {"tangential", "coulomb"}, {"rolling", "epsd2"}},
          false,
          commands + "\n",
          words};
}

/// Scenes that show what the loop over contacts has, with the Hertz law, and one for each law that is not
/// among them.
std::vector<Scene> scenes() {
  const Variables hertz = {{"normal", "hertz"}};
  std::vector<Scene> all = {
      {"coulomb_and_rolling", {{"normal", "hertz"}, {"tangential", "coulomb"}, {"rolling", "epsd2"}}, true},
      {"coulomb_A_stock",
       {{"normal", "hertz"}, {"tangential", "coulomb"}, {"transition", "A"}, {"stepping", "stock"}}},
      {"history", {{"normal", "hertz"}}},
      {"heavy_dashpots", {{"normal", "hertz"}, {"D", "40"}, {"tangential", "off"}, {"mu", "-1"}}},
      {"hooke", {{"normal", "hooke"}, {"tangential", "coulomb"}, {"rolling", "epsd2"}}},
      {"suction",
       {{"normal", "hooke"}, {"tangential", "coulomb"}, {"rolling", "epsd2"}, {"suction", "20"}},
       true},
      {"suction_heavy_dashpots",
       {{"normal", "hertz"}, {"D", "40"}, {"tangential", "off"}, {"mu", "-1"}, {"suction", "20"}}},
      {"suction_A_stock",
       {{"normal", "hertz"}, {"transition", "A"}, {"stepping", "stock"}, {"suction", "20"}}}};
  for_each_law([&all](auto law) {
    using Law = typename decltype(law)::type;
    if constexpr (!std::is_same_v<Law, physics::LinearContact> && !std::is_same_v<Law, physics::HertzContact>)
      all.push_back(scene_of<Law>());
  });
  return all;
}

INSTANTIATE_TEST_SUITE_P(Balls, LawBounce, ::testing::ValuesIn(scenes()),
                         [](const auto &scene) { return scene.param.name; });

} // namespace
} // namespace drumlin::test
