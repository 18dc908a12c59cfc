// The engines' own fixes, run styles and walls beside the plugin: plugin/doc/with_other_styles.md. Two balls
// over a floor, one of which falls on it, in both engines, and lines of the test's own.
#include "tests/support/engine_runs.h"

namespace drumlin::test {
namespace {

constexpr double k = 1e5, mass = 1.0, radius = 0.05; // N/m, kg, m

/// What a test sets of the scene.
struct Scene {
  bool lammps;
  std::string stepping;
  double dt; // s
  int steps;
  std::string lines;                               // before the integration
  std::string integrate = "nve/sphere";            // fix of all balls; empty: the lines have their own
  double damping = 60.0;                           // N s/m
  double friction = 0.0;                           // mu
  std::string floor = "primitive type 1 zplane 0"; // of LIGGGHTS
  std::string before_floor{};                      // lines
  std::string velocity = "0.3 0 -1";               // m/s, of ball 1
  std::string start = "0 0 0.051", second_start = "0.3 0 0.5";
  std::string skin = "0.02";
};

std::string deck(const Scene &scene) {
  const std::string settings = "transition B damping coefficient stepping " + scene.stepping;
  std::string text = scene.lammps ? "plugin load ${plugin}\natom_style sphere 1\ncomm_modify vel yes\n"
                                  : "atom_style granular\ncommunicate single vel yes\n";
  text +=
      fmt::format("units si\natom_modify map array sort 0 0\nnewton off\nboundary f f f\nprocessors 2 1 1\n"
                  "region box block -1 1 -1 1 -1 1 units box\ncreate_box 2 box\nneighbor {} bin\n"
                  "neigh_modify delay 0\ncreate_atoms 1 single {}\ncreate_atoms 2 single {}\n"
                  "set group all diameter {}\nset group all mass {}\ngroup a id 1\ngroup b id 2\n",
                  scene.skin, scene.start, scene.second_start, 2 * radius, mass);
  if (scene.lammps) {
    text +=
        fmt::format("pair_style gran/hooke/transition tangential coulomb {}\npair_coeff * * {} {} {} 2e4 0\n"
                    "fix floor all wall/gran/transition 1 zplane 0 NULL\n",
                    settings, k, scene.damping, scene.friction);
  } else {
    const std::string model = "model hooke/transition tangential coulomb ";
    text += "pair_style gran " + model + settings + "\npair_coeff * *\n";
    for (const auto &[name, value] : {std::pair("kn", k),
                                      {"kt", 2e4},
                                      {"gamman_abs", scene.damping},
                                      {"gammat_abs", 0.0},
                                      {"coefficientFriction", scene.friction}})
      text += fmt::format("fix {0} all property/global {0} peratomtypepair 2 {1} {1} {1} {1}\n", name, value);
    text += scene.before_floor + "\n";
    text += "fix floor all wall/gran " + model + scene.floor + " " + settings + "\n";
  }
  text += scene.lines + "\n";
  if (!scene.integrate.empty()) text += "fix integrate all " + scene.integrate + "\n";
  text += fmt::format(
      "velocity a set {} units box\ntimestep {}\nthermo_modify lost error norm no\nthermo 1000000\n"
      "dump state all custom {} state.dump id x y z vx vy vz fx fy fz omegax omegay omegaz tqx tqy tqz\n"
      "dump_modify state sort id format {} \"%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g "
      "%.17g %.17g %.17g %.17g %.17g\"\nrun {}\n",
      scene.velocity, number(scene.dt), scene.steps, scene.lammps ? "line" : "", scene.steps);
  return text;
}

Outcome run(const Scene &scene, const Scratch &folder, int ranks = 1) {
  const auto file = folder / (scene.lammps ? "deck.lammps" : "deck.in");
  std::string text = deck(scene);
  if (ranks == 1) text.replace(text.find("processors 2 1 1"), 16, "processors 1 1 1");
  write_text(file, text);
  return run_deck(file, {}, folder.path(), ranks);
}

/// The last frame of a run.
std::map<long, Ball> last_frame(const Scene &scene, int ranks = 1) {
  const Scratch folder;
  write_floor(folder / "floor.stl", 0.1, false);
  const Outcome outcome = run(scene, folder, ranks);
  if (outcome.says("multi/old has been removed")) return {}; // LAMMPS of 2025 and later
  EXPECT_TRUE(outcome.ok()) << outcome.output;
  EXPECT_FALSE(outcome.says("WARNING: pair_style")) << outcome.output;
  return outcome.ok() ? read_dump(folder / "state.dump").back().balls : std::map<long, Ball>();
}

/// Largest difference of positions, m, and velocities, m/s, of a ball; infinite where one is not a number.
double difference(const std::map<long, Ball> &one, const std::map<long, Ball> &other, long id = 1) {
  if (one.count(id) == 0 || other.count(id) == 0) return HUGE_VAL;
  double most = 0.0;
  for (std::size_t a = 0; a < 3; ++a)
    for (const double change : {one.at(id).x[a] - other.at(id).x[a], one.at(id).v[a] - other.at(id).v[a]})
      most = std::isfinite(change) ? std::max(most, std::fabs(change)) : HUGE_VAL;
  return most;
}

// --- fixes that add forces
// ----------------------------------------------------------------------------------------

struct Beside {
  const char *engines; // L: LIGGGHTS, M: LAMMPS
  std::string lines;
  std::string integrate = "nve/sphere";
};

const Beside besides[] = {
    {"LM", "fix f all gravity 9.81 vector 0 0 -1"},
    {"LM", "fix f all addforce 2 0 -30"},
    {"LM", "fix f all viscous 20"},
    {"LM", "fix f a spring tether 1000 0 0 0.1 0"},
    {"LM", "fix f all spring/self 1000"},
    {"LM", "fix f all setforce NULL 0 NULL"},
    {"LM", "fix f all lineforce 0 0 1"},
    {"LM", "fix f all planeforce 0 1 0"},
    {"LM", "fix f all aveforce NULL NULL 0"},
    {"LM", "fix f b freeze"},
    {"LM", "fix f all nve", ""},
    {"LM", "fix g b nve/noforce\nfix f a nve/sphere", ""},
    {"L", "fix f a drag 0.1 0 0.5 10 0.01"},
    {"L", "fix g all gravity 9.81 vector 0 0 -1\nfix f all buoyancy level 0.5 dim z density 500"},
    {"LM", "region q sphere 0 0 0.3 0.35 units box\nfix f a wall/region q harmonic 500 0 0.2"},
    {"M", "fix f a wall/harmonic zlo -0.1 500 0 0.2 units box"},
    {"M", "fix f a wall/lj126 zlo -0.1 1 0.1 0.25 units box"},
    {"M", "fix f a wall/lj93 zlo -0.1 1 0.1 0.25 units box"},
    {"M", "fix f a wall/lj1043 zlo -0.1 1 0.1 0.25 units box"},
    {"M", "fix f a wall/morse zlo -0.1 1 10 0.1 0.25 units box"},
    {"M", "fix f a indent 500 sphere 0 0 0.15 0.05 units box"},
    {"M", "fix f a wall/gran hooke/history 1e5 NULL 10 NULL 0 0 xplane NULL 0.053"},
    {"M", "region w block -1 0.053 -1 1 -1 1 units box\n"
          "fix f a wall/gran/region hooke/history 1e5 NULL 10 NULL 0 0 region w"},
    {"M", "comm_style tiled\nfix f all balance 100 1.0 shift x 5 1.0"},
    {"L", "communicate multi vel yes"},
};

/// The fix `f` of the lines, for the name of a test.
std::string name_of(const std::string &lines) {
  const std::regex fix("fix f [ab]l?l? ([a-z0-9/]+)");
  std::smatch found;
  std::string name = std::regex_search(lines, found, fix) ? found[1].str() : lines.substr(0, lines.find(' '));
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

void PrintTo(const Beside &beside, std::ostream *out) { *out << beside.lines; }

class OtherStyles : public ::testing::TestWithParam<std::tuple<bool, Beside>> {
public:
  static std::string name(const ::testing::TestParamInfo<ParamType> &test) {
    return name_of(std::get<1>(test.param).lines) + (std::get<0>(test.param) ? "_lammps" : "_liggghts");
  }
};

// The error of `stock` with a step a hundred times shorter is 1e-5.
TEST_P(OtherStyles, GoWithTheSecondOrderScheme) {
  const auto &[lammps, beside] = GetParam();
  if (std::string(beside.engines).find(lammps ? 'M' : 'L') == std::string::npos)
    GTEST_SKIP() << "not of this engine";
  SKIP_WITHOUT_LAMMPS(lammps);
  const auto fine = last_frame({lammps, "stock", 1e-6, 20000, beside.lines, beside.integrate});
  const auto second = last_frame({lammps, "second", 1e-4, 200, beside.lines, beside.integrate});
  for (const long id : {1L, 2L})
    EXPECT_LT(difference(second, fine, id), 3e-4) << "ball " << id;
  EXPECT_GT(second.at(1).v[2], -1.0) << "the ball has met the floor";
}

INSTANTIATE_TEST_SUITE_P(Forces, OtherStyles,
                         ::testing::Combine(::testing::Bool(), ::testing::ValuesIn(besides)),
                         OtherStyles::name);

TEST(OtherStylesOnRanks, GiveTheResultsOfOneRank) {
  SKIP_WITHOUT_LAMMPS(true);
  const Scene scene{true, "second", 1e-4, 400, "comm_style tiled\nfix f all balance 50 1.0 shift x 5 1.0"};
  EXPECT_LT(difference(last_frame(scene, 2), last_frame(scene, 1)), 1e-12);
}

class NeighborStyles : public ::testing::TestWithParam<const char *> {};

// A drum of 0.7 m over a ball of 0.1 m.
TEST_P(NeighborStyles, FindContactsOfUnequalBallsInLammps) {
  SKIP_WITHOUT_LAMMPS(true);
  Scene scene{true, "second", 1e-5, 100,
              std::string("neighbor 0.02 ") + GetParam() + "\nset atom 2 diameter 0.7 mass 1"};
  scene.second_start = "0 0 0.4505";
  scene.velocity = "0 0 0";
  const auto balls = last_frame(scene);
  if (balls.empty()) GTEST_SKIP() << "this LAMMPS has no neighbor style " << GetParam();
  EXPECT_GT(balls.at(2).f[2], 10.0);
}

INSTANTIATE_TEST_SUITE_P(Lammps, NeighborStyles, ::testing::Values("nsq", "bin", "multi", "multi/old"),
                         [](const auto &test) { return name_of(std::string(test.param)); });

// --- a rigid body of LIGGGHTS
// -------------------------------------------------------------------------------------

// Two balls, one body, hit a third. The engine's own law, which steps as `stock` does, has the same contact
// as the plugin's under A, and under B with its limitForce.
TEST(RigidBodyOfLiggghts, BouncesUnderStockAsWithTheEnginesLaw) {
  const double m_eff = 5.0 * 4.0 / 9.0, c = 200.0; // kg, N s/m
  const auto velocities = [&](const std::string &pair_style) {
    const Scratch folder;
    std::string text =
        "atom_style granular\natom_modify map array sort 0 0\ncommunicate single vel yes\nunits si\n"
        "newton off\nboundary f f f\nregion box block -1 1 -1 1 -1 1 units box\ncreate_box 2 box\n"
        "neighbor 0.02 bin\nneigh_modify delay 0\ncreate_atoms 1 single 0 0 0.4\n"
        "create_atoms 1 single 0 0 0.2\ncreate_atoms 2 single 0 0 -0.05\n"
        "set group all diameter 0.2\nset atom 1 mass 2\nset atom 2 mass 3\nset atom 3 mass 4\n"
        "group body id 1 2\ngroup free id 3\n";
    for (const auto &[name, value] : {std::pair("kn", 1e5),
                                      {"kt", 2e4},
                                      {"gamman_abs", c},
                                      {"gammat_abs", 0.0},
                                      {"gamman", c / m_eff},
                                      {"gammat", 0.0}})
      text += fmt::format("fix {0} all property/global {0} peratomtypepair 2 {1} {1} {1} {1}\n", name,
                          number(value));
    text +=
        "pair_style gran model " + pair_style +
        "\npair_coeff * *\nneigh_modify exclude group body body\nfix b body rigid single\n"
        "fix i free nve/sphere\nvelocity body set 0 0 -0.5 units box\ntimestep 4e-6\nthermo 100000\n"
        "dump state all custom 60000 state.dump id x y z vx vy vz fx fy fz omegax omegay omegaz tqx tqy tqz\n"
        "dump_modify state sort id format \"%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g "
        "%.17g %.17g %.17g %.17g %.17g\"\nrun 60000\n";
    write_text(folder / "deck.in", text);
    well(run_deck(folder / "deck.in", {}, folder.path(), 1));
    std::vector<double> found;
    const auto frames = read_dump(folder / "state.dump");
    if (!frames.empty())
      for (const auto &numbered : frames.back().balls)
        found.push_back(numbered.second.v[2]);
    found.resize(3, HUGE_VAL);
    return found;
  };
  for (const auto &[transition, limit] : {std::pair("A", "off"), {"B", "on"}}) {
    const auto ours =
        velocities(std::string("hooke/transition tangential off stepping stock damping coefficient "
                               "transition ") +
                   transition);
    const auto own = velocities(std::string("hooke/stiffness tangential off limitForce ") + limit);
    for (std::size_t n = 0; n < 3; ++n)
      EXPECT_NEAR(ours[n], own[n], 1e-12) << transition << ", ball " << n + 1; // m/s
    EXPECT_NEAR(5.0 * ours[0] + 4.0 * ours[2], -2.5, 1e-12) << transition;     // kg m/s
    EXPECT_GT(ours[0], -0.4) << transition << ": no contact";
  }
}

// --- another time step within a run
// -------------------------------------------------------------------------------

/// The numbers of a row of a table that the plugin wrote, from its start or, below 0, from its end.
std::vector<double> row_of(const std::filesystem::path &file, int number) {
  const std::vector<std::string> rows = lines_of(read_text(file));
  std::istringstream line(
      rows.at(static_cast<std::size_t>(number < 0 ? static_cast<int>(rows.size()) + number : number)));
  std::vector<double> numbers;
  for (std::string part; std::getline(line, part, ',');)
    numbers.push_back(part == "make" || part == "break" ? 0.0 : std::stod(part));
  return numbers;
}

class TimeStepWithinARun : public ::testing::TestWithParam<std::tuple<bool, std::string>> {};

// Ball 2 falls freely from rest under 1 m/s2: its speed is the time. The excitation of ball 1 lets fix
// dt/reset shorten the step.
TEST_P(TimeStepWithinARun, LeavesClocksRight) {
  const auto &[lammps, stepping] = GetParam();
  SKIP_WITHOUT_LAMMPS(lammps);
  constexpr double w = 2 * pi * 10, F = 100.0;
  for (const char *place : {"before", "behind"}) {
    const std::string reset = "fix dt all dt/reset 1 1e-6 1e-4 1e-5 units box\n";
    Scene scene{lammps, stepping, 1e-4, 3000, ""};
    scene.velocity = "0 0 0";
    scene.start = "0 0 0.3";
    scene.lines =
        (place == std::string("before") ? reset : "") +
        "fix g b gravity 1 vector 0 0 1\n"
        "fix f a drum/excite amplitude 100 frequency 10 direction 0 0 1\n"
        "fix h a roller/history file history.csv every 1 axis 0 0 1\n"
        "create_atoms 1 single 0.5 0 0.5\ncreate_atoms 2 single 0.601 0 0.5\ngroup c id 3\ngroup d id 4\n"
        "group cd id 3 4\nset group cd diameter 0.1\nset group cd mass 1\nvelocity c set 0.05 0 0 units box\n"
        "fix e cd contact/events file events.csv\n" +
        (place == std::string("behind") ? reset : "");
    const Scratch folder;
    well(run(scene, folder));
    const auto balls = read_dump(folder / "state.dump").back().balls;
    const double time = balls.at(2).v[2];
    EXPECT_LT(time, 0.1) << "the step has become shorter";
    const std::vector<double> history = row_of(folder / "history.csv", -1);
    EXPECT_NEAR(history[0], time, 1e-12) << stepping << ' ' << place;
    EXPECT_NEAR(balls.at(1).v[2], F / (mass * w) * (1 - std::cos(w * time)), 2e-4 * F / (mass * w));
    // Balls with a gap of 1 mm at 50 mm/s.
    const std::vector<double> event = row_of(folder / "events.csv", 1);
    EXPECT_NEAR(event[0], 0.001 / 0.05, 1e-6) << "the make, in a step of another length than the first";
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, TimeStepWithinARun,
                         ::testing::Combine(::testing::Bool(), ::testing::Values("second", "stock")),
                         [](const auto &test) {
                           return std::get<1>(test.param) +
                                  (std::get<0>(test.param) ? "_lammps" : "_liggghts");
                         });

// --- moving walls
// ---------------------------------------------------------------------------------------------------

/// Energies and heats of contact/energy at the end: f_E[4], f_E[5].
std::array<double, 2> heats(Scene scene) {
  scene.lines += "\nfix E all contact/energy";
  const Scratch folder;
  write_floor(folder / "floor.stl", 0.9, false);
  const auto file = folder / "deck.in";
  std::string text = deck(scene);
  text.replace(text.find("processors 2 1 1"), 16, "processors 1 1 1");
  write_text(file, text + "print \"heats $(f_E[4]) $(f_E[5]) end\"\n");
  const Outcome outcome = well(run_deck(file, {}, folder.path()));
  std::smatch found;
  const std::regex line("\nheats ([0-9.e+-]+) ([0-9.e+-]+) end");
  if (!std::regex_search(outcome.output, found, line)) return {HUGE_VAL, HUGE_VAL};
  return {std::stod(found[1]), std::stod(found[2])};
}

struct MovingWall {
  const char *name;
  std::string lines, floor; // the wall that moves, and how
  std::string ball;         // velocity of the ball, seen from the wall at rest
  std::string frame;        // velocity of the ball that meets the moving wall
  std::string rest;         // the same wall at rest, and its lines
  std::string rest_lines;
};

const std::string mesh = "fix m all mesh/surface file floor.stl type 1";
const std::string planar = "fix m all mesh/surface/planar file floor.stl type 1";
const std::string of_mesh = "mesh n_meshes 1 meshes m";
const MovingWall walls[] = {
    {"shear", "", "primitive type 1 zplane 0 shear x 1.0", "-1 0 -1", "0 0 -1", "primitive type 1 zplane 0",
     ""},
    {"shear_along_y", "", "primitive type 1 zplane 0 shear y -0.7", "0 0.7 -1", "0 0 -1",
     "primitive type 1 zplane 0", ""},
    {"belt", mesh + " surface_vel 1 0 0", of_mesh, "-1 0 -1", "0 0 -1", of_mesh, mesh},
    {"moved_mesh", mesh + "\nfix mm all move/mesh mesh m linear 1 0 0.5", of_mesh, "-1 0 -1.5", "0 0 -1",
     of_mesh, mesh},
    {"moved_mesh_file", mesh + "\nfix mm all move/mesh/file mesh m linear 1 0 0.5", of_mesh, "-1 0 -1.5",
     "0 0 -1", of_mesh, mesh},
    {"moved_mesh_gran", mesh + "\nfix mm all move/mesh/gran mesh m linear 1 0 0.5", of_mesh, "-1 0 -1.5",
     "0 0 -1", of_mesh, mesh},
    {"moved_planar_mesh", planar + "\nfix mm all move/mesh mesh m linear 1 0 0.5", of_mesh, "-1 0 -1.5",
     "0 0 -1", "primitive type 1 zplane 0", ""},
    {"planar_mesh", planar, of_mesh, "0.5 0.2 -1", "0.5 0.2 -1", "primitive type 1 zplane 0", ""},
};

class HeatAtAMovingWall : public ::testing::TestWithParam<std::tuple<std::string, MovingWall>> {};
void PrintTo(const MovingWall &wall, std::ostream *out) { *out << wall.name; }

// A moving wall and the same wall seen from itself: heat does not depend on the frame.
TEST_P(HeatAtAMovingWall, IsThatOfTheWallAtRest) {
  const auto &[stepping, wall] = GetParam();
  Scene scene{false, stepping, 2e-5, 2000, ""};
  scene.before_floor = wall.lines;
  scene.friction = 0.3;
  scene.floor = wall.floor;
  scene.velocity = wall.frame;
  const auto moving = heats(scene);
  scene.before_floor = wall.rest_lines;
  scene.floor = wall.rest;
  scene.velocity = wall.ball;
  const auto rest = heats(scene);
  EXPECT_GT(rest[0], 0.02);
  EXPECT_GT(rest[1], 0.02);
  EXPECT_NEAR(moving[0], rest[0], 2e-3 * rest[0]);
  EXPECT_NEAR(moving[1], rest[1], 2e-3 * rest[1]);
}

INSTANTIATE_TEST_SUITE_P(Walls, HeatAtAMovingWall,
                         ::testing::Combine(::testing::Values("second", "stock"), ::testing::ValuesIn(walls)),
                         [](const auto &test) {
                           return std::string(std::get<1>(test.param).name) + "_" + std::get<0>(test.param);
                         });

// --- fixes that change velocities beside the integration
// --------------------------------------------------------------

struct Changing {
  bool lammps;
  const char *line; // the fix f, which integrates, too, if its name begins with n
};
void PrintTo(const Changing &changing, std::ostream *out) { *out << changing.line; }

// Energies of 1 J are temperatures of some 1e22 K.
const Changing changing[] = {
    {false, "momentum 3 linear 1 1 1 angular"},
    {false, "nve/limit absolute 1e-5"},
    {true, "momentum 3 linear 1 1 1 angular"},
    {true, "momentum/chunk 3 chunks linear 1 1 1 angular"},
    {true, "flow/gauss 1 0 1"},
    {true, "nve/limit 1e-5"},
    {true, "ehex 1 1.0"},
    {true, "heat 1 1.0"},
    {true, "langevin 1e22 1e22 0.01 4711"},
    {true, "nvt temp 1e22 1e22 0.01"},
    {true, "nvt/sphere temp 1e22 1e22 0.01"},
    {true, "nvt/sllod temp 1e22 1e22 0.01"},
    {true, "npt temp 1e22 1e22 0.01 iso 1 1 0.1"},
    {true, "npt/sphere temp 1e22 1e22 0.01 iso 1 1 0.1"},
    {true, "nph iso 1 1 0.1"},
    {true, "nph/sphere iso 1 1 0.1"},
    {true, "press/berendsen iso 1 1 1 modulus 100"},
    {true, "recenter 0.01 0 0"},
    {true, "temp/berendsen 1e22 1e22 0.01"},
    {true, "temp/csld 1e22 1e22 0.01 4711"},
    {true, "temp/csvr 1e22 1e22 0.01 4711"},
    {true, "temp/rescale 2 1e22 1e22 1e20 1"},
    {true, "thermal/conductivity 2 x 4"},
    {true, "viscosity 2 y x 4"},
    {true, "wall/reflect zlo -0.21"},
    {true, "wall/reflect/stochastic diffusive 4711 zlo -0.21 1e22 0 0 0"},
    {true, "wall/piston zlo vel 5"},
};

/// Balls 1 and 2 fly at each other, with the law of the plugin under `stock` or with the engine's own; ball 3
/// flies alone.
std::string collision(const Changing &test, bool own_law, bool with_fix) {
  constexpr double c = 60.0, m_eff = 0.5 * mass;
  std::string text = test.lammps ? "plugin load ${plugin}\natom_style sphere\ncomm_modify vel yes\n"
                                 : "atom_style granular\ncommunicate single vel yes\n";
  const std::string line = test.line, style = line.substr(0, line.find(' '));
  const bool sheared = style == "nvt/sllod";
  text += fmt::format("units si\natom_modify map array sort 0 0\nnewton off\nboundary {0}\n"
                      "region box {1} -0.5 0.5 -0.5 0.5 -0.5 0.5 {2}units box\ncreate_box 2 box\n"
                      "neighbor 0.02 bin\nneigh_modify delay 0\ncreate_atoms 1 single -0.051 0 0.01\n"
                      "create_atoms 2 single 0.051 0.01 0\ncreate_atoms 2 single -0.4 0.3 -0.2\n"
                      "set group all diameter {3}\nset group all mass {4}\n"
                      "group a id 1\ngroup b id 2\ngroup c id 3\n",
                      line.find("wall") == 0 ? "f p s" : "p p p", sheared ? "prism" : "block",
                      sheared ? "0 0 0 " : "", 2 * radius, mass);
  if (test.lammps)
    text += own_law ? fmt::format("pair_style gran/hooke {} 0 {} 0 0 0\npair_coeff * *\n", k, c / m_eff)
                    : fmt::format("pair_style gran/hooke/transition tangential off transition A damping "
                                  "coefficient stepping stock\npair_coeff * * {} {}\n",
                                  k, c);
  else {
    text += own_law ? "pair_style gran model hooke/stiffness tangential off tangential_damping off "
                      "absolute_damping on limitForce off\n"
                    : "pair_style gran model hooke/transition tangential off transition A damping "
                      "coefficient stepping stock\n";
    text += "pair_coeff * *\n";
    for (const auto &[name, value] :
         {std::pair("kn", k), {"kt", 0.0}, {"gamman_abs", c}, {"gammat_abs", 0.0}})
      text += fmt::format("fix {0} all property/global {0} peratomtypepair 2 {1} {1} {1} {1}\n", name, value);
  }
  text += "velocity a set 1 0.1 0 units box\nvelocity b set -0.7 -0.1 0.2 units box\n"
          "velocity c set 0.2 0.5 -1 units box\n";
  text += "fix g all gravity 5 vector 1 0 -1\n";
  if (style == "ehex") text += "region all block INF INF INF INF INF INF\n";
  if (style == "momentum/chunk") text += "compute chunks all chunk/atom type\n";
  if (with_fix) text += "fix f all " + line + "\n";
  if (sheared) text += "fix d all deform 1 xy erate 0.1 remap v\n";
  if (!with_fix || line[0] != 'n') text += "fix integrate all nve/sphere\n";
  text += fmt::format("timestep 2e-5\nthermo_modify lost error norm no\nthermo 1000000\n"
                      "dump state all custom 1000 state.dump id x y z vx vy vz fx fy fz omegax omegay omegaz "
                      "tqx tqy tqz\ndump_modify state sort id format {} \"%d %.17g %.17g %.17g %.17g %.17g "
                      "%.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\"\nrun 1000\n",
                      test.lammps ? "line" : "");
  return text;
}

class ChangedVelocities : public ::testing::TestWithParam<Changing> {};

// With the engine's own law of the same force the balls move alike, and otherwise than without the fix.
TEST_P(ChangedVelocities, GoWithTheEnginesSchemeAsWithTheEnginesLaw) {
  const Changing &test = GetParam();
  SKIP_WITHOUT_LAMMPS(test.lammps);
  const auto last = [&test](bool own_law, bool with_fix) {
    const Scratch folder;
    const auto file = folder / (test.lammps ? "deck.lammps" : "deck.in");
    write_text(file, collision(test, own_law, with_fix));
    const Outcome outcome = run_deck(file, {}, folder.path());
    if (outcome.says("Unrecognized fix style")) return std::map<long, Ball>();
    EXPECT_TRUE(outcome.ok()) << outcome.output;
    return outcome.ok() ? read_dump(folder / "state.dump").back().balls : std::map<long, Ball>();
  };
  const auto plugin = last(false, true);
  if (plugin.empty() && !HasFailure()) GTEST_SKIP() << "not in this LAMMPS";
  const auto own = last(true, true), without = last(false, false);
  double changed = 0.0;
  for (long id = 1; id <= 3; ++id) {
    EXPECT_LT(difference(plugin, own, id), 1e-9) << id;
    changed = std::max(changed, difference(plugin, without, id));
  }
  EXPECT_GT(changed, 1e-6) << "the fix has done nothing";
}

INSTANTIATE_TEST_SUITE_P(Fixes, ChangedVelocities, ::testing::ValuesIn(changing), [](const auto &test) {
  const std::string line = test.param.line;
  return name_of("fix f a " + line) + (test.param.lammps ? "_lammps" : "_liggghts");
});

// --- contacts beyond the neighbour list
// ---------------------------------------------------------------------------

class GrowingBalls : public ::testing::TestWithParam<std::tuple<bool, int>> {};

// Two balls at rest, 0.2 m apart, that grow from 0.1 to 0.3 m.
TEST_P(GrowingBalls, AreStoppedByTheGuardBeforeTheyMissOneAnother) {
  const auto &[lammps, ranks] = GetParam();
  SKIP_WITHOUT_LAMMPS(lammps);
  const WaitForRanks at_once(0);
  Scene scene{lammps, "second", 1e-5, 4000, ""};
  scene.start = "-0.1 0 0.5";
  scene.second_start = "0.1 0 0.5";
  scene.velocity = "0 0 0";
  scene.lines = "variable grown equal 0.1+0.2*step/4000\nfix grow all adapt 1 atom diameter v_grown\nfix "
                "guard all guard overlap 100";
  const Scratch missing, found;
  const Outcome stopped = run(scene, missing, ranks);
  EXPECT_EQ(stopped.status, 1);
  EXPECT_TRUE(stopped.says("ERROR: fix guard: ") && stopped.says("contacts may be missing") &&
              stopped.says("allowed: at most"))
      << stopped.output;
  scene.skin = "0.45"; // the list has all contacts
  well(run(scene, found, ranks));
  EXPECT_GT(read_dump(found / "state.dump").back().balls.at(2).v[0], 0.1) << "they push one another";
}

INSTANTIATE_TEST_SUITE_P(Engines, GrowingBalls,
                         ::testing::Combine(::testing::Bool(), ::testing::Values(1, 2)),
                         [](const auto &test) {
                           return std::string(std::get<0>(test.param) ? "Lammps" : "Liggghts") +
                                  (std::get<1>(test.param) == 2 ? "OnRanks" : "");
                         });

// --- inserted balls
// ------------------------------------------------------------------------------------------------

struct Insertion {
  const char *name;
  bool lammps;
  double time; // s, until the ball has met the floor
  std::string lines;
};
void PrintTo(const Insertion &insertion, std::ostream *out) { *out << insertion.name; }

const std::string templates =
    "fix t all particletemplate/sphere 15485863 atom_type 1 density constant 1909.86 radius constant "
    "0.05\nfix d all particledistribution/discrete 15485867 1 t 1.0\n"
    "region in block 0.5 0.7 -0.1 0.1 0.055 0.2 units box\n";
const Insertion insertions[] = {
    {"insert_pack", false, 0.3,
     templates + "fix f all insert/pack seed 32452843 distributiontemplate d insert_every once overlapcheck "
                 "yes vel constant 0 0 -1 all_in yes particles_in_region 1 region in"},
    {"insert_rate_region", false, 0.3,
     templates +
         "fix f all insert/rate/region seed 32452843 distributiontemplate d nparticles 1 particlerate 1e6 "
         "insert_every 10000000 overlapcheck yes vel constant 0 0 -1 all_in yes region in"},
    {"insert_stream", false, 0.65,
     templates + "fix face all mesh/surface/planar file floor.stl type 1 move 0.5 0 0.4\n"
                 "fix f all insert/stream seed 32452867 distributiontemplate d nparticles 1 particlerate 1e4 "
                 "overlapcheck yes all_in no vel constant 0 0 -1 insertion_face face extrude_length 0.25"},
    {"pour", true, 0.3,
     "region in block 0.5 0.7 -0.1 0.1 0.055 0.4 units box\nfix g all gravity 9.81 vector 0 0 -1\n"
     "fix f all pour 1 1 4767548 vol 0.9 100 diam one 0.1 dens 1909.86 1909.86 vel 0 0 0 0 -1 region in"},
};

class Inserted : public ::testing::TestWithParam<Insertion> {};

// The third ball falls on the floor as with the engine's scheme and a far shorter step.
TEST_P(Inserted, BallsGoWithTheSecondOrderScheme) {
  SKIP_WITHOUT_LAMMPS(GetParam().lammps);
  const std::string lines = GetParam().lines;
  const auto fine = last_frame(
      {GetParam().lammps, "stock", 1e-5, static_cast<int>(std::lround(GetParam().time / 1e-5)), lines});
  const auto second = last_frame(
      {GetParam().lammps, "second", 1e-4, static_cast<int>(std::lround(GetParam().time / 1e-4)), lines});
  ASSERT_EQ(fine.size(), 3u);
  ASSERT_EQ(second.size(), 3u);
  const Ball &one = fine.at(3), &other = second.at(3);
  EXPECT_GT(one.v[2], 0.1) << "it has met the floor";
  EXPECT_NEAR(one.x[2], other.x[2], 3e-3);
  EXPECT_NEAR(one.v[2], other.v[2], 3e-3);
}

INSTANTIATE_TEST_SUITE_P(Fixes, Inserted, ::testing::ValuesIn(insertions),
                         [](const auto &test) { return std::string(test.param.name); });

// --- styles on no list
// ---------------------------------------------------------------------------------------------

// One warning, which names the fix, for two runs.
TEST(OtherStylesOnNoList, GetOneWarning) {
  for (const bool lammps : {false, true}) {
    if (lammps && !post::has_lammps()) continue;
    const Scratch folder;
    const auto file = folder / (lammps ? "deck.lammps" : "deck.in");
    std::string text = deck({lammps, "second", 1e-5, 10, "fix added all external pf/array 1"});
    text.replace(text.find("processors 2 1 1"), 16, "processors 1 1 1");
    write_text(file, text + "run 10\n");
    const Outcome outcome = well(run_deck(file, {}, folder.path()));
    const std::string warning = "it has not been tried beside fix added (external); ";
    const std::size_t first = outcome.output.find(warning);
    ASSERT_NE(first, std::string::npos) << outcome.output;
    EXPECT_EQ(outcome.output.find(warning, first + 1), std::string::npos) << outcome.output;
  }
}

// A fix that acts without a pair style of the plugin looks for itself.
TEST(OtherStylesWithoutThePairStyle, AreRefusedByTheFixesThatAct) {
  SKIP_WITHOUT_LAMMPS(true);
  for (const std::string lines :
       {"drum/excite amplitude 1 omega 100 direction 0 0 1", "bond/spring 1 2 1e4 10",
        "boundary/absorb normal 0 0 -1 area 1 density 1800 speeds 300 170", "guard"}) {
    const Scratch folder;
    const auto file = folder / "deck.lammps";
    std::string text = deck({true, "second", 1e-5, 10, "fix act all " + lines});
    for (const std::string word : {"processors 2 1 1", "pair_style ", "pair_coeff ", "fix floor "}) {
      const std::size_t begin = text.find(word);
      text.erase(begin, text.find('\n', begin) - begin);
    }
    text.insert(text.rfind("run "), "run_style respa 2 2\n");
    write_text(file, text);
    EXPECT_TRUE(fails_with(run_deck(file, {}, folder.path()),
                           "ERROR: fix " + lines.substr(0, lines.find(' ')) + ": run_style is 'respa'"));
  }
}

} // namespace
} // namespace drumlin::test
