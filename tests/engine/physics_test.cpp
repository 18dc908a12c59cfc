// Hybrid pair styles, restitution and surfaces, against the engines' own laws and closed forms.
#include "tests/support/engine_runs.h"

namespace drumlin::test {
namespace {

// Hybrid pair styles: a scene gives the same results with the law as a part of a hybrid style as with the law
// alone, with every fix.
namespace hybrid {

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
  SKIP_WITHOUT_LAMMPS(true);
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
  SKIP_WITHOUT_LAMMPS(true);
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
  SKIP_WITHOUT_LAMMPS(true);
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

} // namespace hybrid

// damping restitution: an impact in the engine gives back the share of the speed that the deck asks for,
// under A and B.
namespace restitution {

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
  SKIP_WITHOUT_LAMMPS(true);
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

} // namespace restitution

// drumlin/repeat: sums of whole numbers, of which the inner ones are within the outer ones.
TEST(Repeat, ExecutesCommandsForEachNumber) {
  for (const int ranks : {1, 2}) {
    const Scratch scratch;
    const Outcome outcome = run_host(host_pair_style() + host_properties(),
                                     "variable sum equal 0\n"
                                     "drumlin/repeat n 4 \"variable sum equal $(v_sum+v_n)\" "
                                     "\"drumlin/repeat m ${n} 'variable sum equal $(v_sum+v_m^2)'\"\n"
                                     "drumlin/repeat never 0 \"variable sum equal 0\"\n"
                                     "print \"sum ${sum} of ${n}\"\n",
                                     scratch.path(), ranks);
    EXPECT_TRUE(outcome.says("\nsum 60 of 4\n")) << outcome.output; // 1 + ... + 4, 1 + 5 + 14 + 30
  }
}

// drumlin/surface against closed forms of the mean height of spheres and discs.
namespace surface {

constexpr double pi = 3.14159265358979323846;
constexpr double soil_radius = 0.5, drum_radius = 0.75; // m, of in.host, whose centres have y = 0

/// The number behind "height " in an output.
double printed_height(const Outcome &outcome) {
  EXPECT_TRUE(outcome.ok()) << outcome.output;
  const std::string mark = "\nheight ";
  const std::size_t at = outcome.output.rfind(mark);
  EXPECT_NE(at, std::string::npos) << outcome.output;
  return at == std::string::npos ? NAN : std::stod(outcome.output.substr(at + mark.size()));
}

double height_in_host(const std::string &arguments, int ranks) {
  const Scratch scratch;
  return printed_height(run_host(host_pair_style() + host_properties(),
                                 "drumlin/surface h " + arguments + "\nprint \"height ${h}\"\n",
                                 scratch.path(), ranks));
}

/// Mean height of the part of a sphere's upper half with |x| > d: volume over area.
double mean_of_sphere(double r, double d) {
  const double volume = pi * (r * r * (r - d) - (r * r * r - d * d * d) / 3.0);
  const double area = 2.0 * (r * r * std::acos(d / r) - d * std::sqrt(r * r - d * d));
  return volume / area;
}

TEST(Surface, OfSpheresIsTheirVolumeOverTheirAreaOnRanksOneAndTwo) {
  EXPECT_NEAR(mean_of_sphere(soil_radius, 0.0), 2.0 / 3.0 * soil_radius, 1e-15);
  for (const int ranks : {1, 2}) {
    EXPECT_NEAR(height_in_host("soil spacing 0.005", ranks), mean_of_sphere(soil_radius, 0.0), 2e-4);
    EXPECT_NEAR(height_in_host("drum spacing 0.005", ranks), mean_of_sphere(drum_radius, 0.0), 2e-4);
    EXPECT_NEAR(height_in_host("drum spacing 0.005 beyond 0.4 0", ranks), mean_of_sphere(drum_radius, 0.4),
                2e-4);
    // Only the right half is far enough from a line on the left.
    EXPECT_NEAR(height_in_host("drum spacing 0.005 beyond 1 -0.6", ranks), mean_of_sphere(drum_radius, 0.4),
                2e-4);
  }
}

/// Area under the circle of radius r from u to its right end.
double area_from(double u, double r) {
  return 0.5 * (r * r * std::acos(u / r) - u * std::sqrt(r * r - u * u));
}

// A disc across the periodic side, and a lower one near this side, of which only a part is seen from above.
TEST(Surface, ReachesAcrossAPeriodicSide) {
  const double r = 0.3, low = 0.85, seen = 1.0 - r; // m: the higher disc covers x > 0.7 and x < -0.7
  const double expected =
      (2.0 * (r * 1.0 + area_from(0.0, r)) + area_from(low - seen, r)) / (2.0 * r + seen - (low - r));
  const Scratch scratch;
  write_text(scratch / "discs.in", "units si\natom_style granular\natom_modify map array\nnewton off\n"
                                   "communicate single vel yes\ndimension 2\nboundary p f p\n"
                                   "region box block -1 1 -1 3 -0.1 0.1 units box\ncreate_box 2 box\n"
                                   "create_atoms 1 single -1 1 0\ncreate_atoms 1 single 0.85 0 0\n"
                                   "set group all diameter 0.6\n"
                                   "drumlin/surface h all spacing 0.001\nprint \"height ${h}\"\n");
  EXPECT_NEAR(printed_height(run_engine(scratch / "discs.in", {}, scratch.path(), 1)), expected, 2e-4);
}

} // namespace surface

// drumlin/density of two layers of a square or cubic lattice, beside sections summed over the height.
namespace density {

constexpr double pi = 3.14159265358979323846;
constexpr double radius = 0.1; // m
constexpr int rows_of_lower = 8, rows = 16;

/// Share of solids between two heights of the lattice. Its balls touch their neighbours, the lowest row the
/// floor at height 0.
double solids_between(double from, double to, bool flat) {
  constexpr int slices = 200000;
  const double slice = (to - from) / slices;
  double sum = 0.0;
  for (int n = 0; n < slices; ++n) {
    const double y = from + (n + 0.5) * slice;
    const double off = y - radius * (1.0 + 2.0 * std::floor(y / (2.0 * radius)));
    const double square = y < 2.0 * radius * rows ? radius * radius - off * off : 0.0;
    sum += flat ? 2.0 * std::sqrt(square) / (2.0 * radius) : pi * square / (4.0 * radius * radius);
  }
  return sum / slices;
}

std::string lattice_deck(bool flat, const std::string &sides) {
  return fmt::format(
      "units si\natom_style granular\natom_modify map array\nnewton off\ncommunicate single vel yes\n"
      "dimension {}\nboundary {} f p\nregion box block -1 1 0 4 {} {} units box\ncreate_box 4 box\n"
      "lattice {} 0.2 origin 0.5 0.5 {}\nregion soil block -1 1 0 {} INF INF units box\n"
      "create_atoms 1 region soil\nregion upper block INF INF {} INF INF INF units box\n"
      "group upper region upper\nset group upper type 4\nset group all diameter 0.2\n"
      "drumlin/density tops all layers 2 scale 0.5,0.5 0.2,0.2 0.5,1.2\nprint \"tops ${{tops}}\"\n",
      flat ? 2 : 3, sides, flat ? -0.1 : -0.4, flat ? 0.1 : 0.4, flat ? "sq" : "sc", flat ? 0.0 : 0.5,
      2.0 * radius * rows, 2.0 * radius * rows_of_lower);
}

TEST(Density, OfLayersOfALatticeIsThatOfItsSections) {
  for (const bool flat : {true, false})
    for (const std::string sides : {"p", "f"})
      for (const int ranks : {1, 2}) {
        SCOPED_TRACE(fmt::format("flat {}, sides {}, ranks {}", flat, sides, ranks));
        const Scratch scratch;
        write_text(scratch / "lattice.in", lattice_deck(flat, sides));
        const Outcome outcome = run_engine(scratch / "lattice.in", {}, scratch.path(), ranks);
        ASSERT_TRUE(outcome.ok()) << outcome.output;
        const double first = number_behind(outcome.output, "\ntops ");
        const double second = number_behind(outcome.output, fmt::format("\ntops {:.17g},", first));
        const double rise = radius * (flat ? pi / 4.0 : 2.0 / 3.0); // mean, over lines that meet a ball
        EXPECT_NEAR(first, radius * (2 * rows_of_lower - 1) + rise, 0.05 * radius);
        EXPECT_NEAR(second - first, 2.0 * radius * (rows - rows_of_lower), 1e-12);
        double below = 0.0;
        for (const auto &[layer, top] : {std::pair{1, first}, std::pair{2, second}}) {
          // These layers are thin: the margin is a quarter of their thickness, not two diameters.
          const double beside = 0.25 * (top - below);
          const double phi = solids_between(below + beside, top - beside, flat);
          const std::string line = fmt::format(
              "drumlin/density: layer {}, {:.3f} to {:.3f} m: solid fraction ", layer, below, top);
          EXPECT_NEAR(number_behind(outcome.output, line), phi, 6e-5);
          below = top;
        }
        const double found = (0.5 - (1.0 / solids_between(0.25 * first, 0.75 * first, flat) - 1.0)) / 0.3;
        EXPECT_EQ(outcome.says("WARNING: drumlin/density: layer 1 is "), std::fabs(found - 0.5) > 0.25);
        EXPECT_TRUE(outcome.says("WARNING: drumlin/density: layer 2 is looser than asked for, by "));
      }
}

} // namespace density

} // namespace
} // namespace drumlin::test
