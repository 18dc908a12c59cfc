// Fixes of the engine that change the box, masses or velocities beside the forces: fix deform, fix adapt, fix
// move. The oracle is mostly the same scene as another observer sees it: inside a deforming box instead of
// across its side, with a ball that had its size from the start, or on a moved ball of another mass, which
// must not matter.
#include "tests/support/engine_runs.h"

namespace drumlin::test {
namespace {

using Vector = std::array<double, 3>;

std::string words(const Vector &v) { return number(v[0]) + " " + number(v[1]) + " " + number(v[2]); }

/// The last row of a file of numbers.
std::vector<double> last_row(const std::filesystem::path &file) {
  std::ifstream in(file);
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) last = line;
  std::istringstream row(last);
  std::vector<double> numbers;
  for (double value = 0; row >> value;)
    numbers.push_back(value);
  return numbers;
}

/// What two balls have come to.
struct Result {
  std::vector<Frame> frames;
  std::vector<post::ContactEvent> events;
  double heat = 0, rubbed = 0; ///< J, of the normal dashpots and of friction
  double x_drum = 0, v_drum = 0,
         a_drum = 0; ///< m, m/s, m/s2, of ball 1 along y, as fix roller/history has them
  const Ball &ball(long id) const { return frames.back().balls.at(id); }
};

class EngineFixes : public BothEngines {
protected:
  static Result run_pair(const Variables &variables) {
    return run_pair_with(std::get<1>(GetParam()), variables);
  }
  static Result run_pair_with(const std::string &stepping, Variables variables, int ranks = 1) {
    const Scratch folder;
    variables.emplace_back("stepping", stepping);
    well(run_scene(std::get<0>(GetParam()), "pair", variables, folder.path(), ranks));
    const std::vector<double> heat = last_row(folder / "heat.txt");
    const post::Table drum = post::read_table(folder / "history.csv");
    return {read_dump(folder / "balls.txt"),
            post::read_events(folder / "events.csv"),
            heat.at(1),
            heat.at(2),
            drum.numbers("x_drum").back(),
            drum.numbers("v_drum").back(),
            drum.numbers("a_drum").back()};
  }
};

INSTANTIATE_TEST_SUITE_P(Both, EngineFixes, engines_and_steppings(), engine_and_stepping);

/// The velocity over the place in a deforming box, 3 x 3, 1/s.
using Rate = std::array<Vector, 3>;

/// Two balls that approach each other along with a box of sides 1.
struct Deforming {
  const char *name;
  Vector one, two;    ///< places of the pair inside the box, m
  Vector shift;       ///< m, which brings the pair across a side
  std::string deform; ///< "x erate R y erate R" or, of a box whose sides are sheared, "xy erate R" (R in 1/s)
  Variables law{};
  Vector drift{}; ///< m/s, of both balls

  bool sheared() const { return deform[1] != ' '; }
  Rate rate() const {
    Rate rates{};
    std::istringstream words(deform);
    std::string axes, erate;
    for (double value = 0; words >> axes >> erate >> value;)
      rates.at(static_cast<std::size_t>(axes.front() - 'x')).at(static_cast<std::size_t>(axes.back() - 'x')) =
          value;
    return rates;
  }
};

Vector times(const Rate &rate, const Vector &x) {
  Vector v{};
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b)
      v[a] += rate[a][b] * x[b];
  return v;
}

/// A place in the box of sides 1 from 0, with what the box's sides move relative to one another, m/s.
struct Wrapped {
  Vector x, jump;
};
Wrapped wrap(const Deforming &scene, Vector x) {
  Vector boxes{};
  for (std::size_t a = 0; a < 3; ++a) {
    boxes[a] = std::floor(x[a]);
    x[a] -= boxes[a];
  }
  return {x, times(scene.rate(), boxes)};
}

const std::vector<Deforming> &deforming() {
  static const std::vector<Deforming> all = {
      {"along y", {0.5, 0.5503, 0.5}, {0.5, 0.45, 0.5}, {0, 0.5, 0}, "y erate -0.5", {{"c", "600"}}},
      {"along y, through the side",
       {0.5, 0.5503, 0.5},
       {0.5, 0.45, 0.5},
       {0, 0.524, 0},
       "y erate -0.5",
       {{"c", "600"}},
       {0, 4, 0}},
      {"along y, solved for together with others",
       {0.5, 0.5503, 0.5},
       {0.5, 0.45, 0.5},
       {0, 0.5, 0},
       "y erate -0.5",
       {{"c", "3e5"}}},
      {"oblique along z, hertz, friction",
       {0.5, 0.53, 0.5402},
       {0.5, 0.47, 0.46},
       {0, 0, 0.5},
       "z erate -0.5",
       given("normal hertz, damping ratio, c 0.3, mu 0.5, ct 20")},
      {"along x and y, a corner",
       {0.535, 0.536, 0.5},
       {0.464, 0.465, 0.5},
       {0.5, 0.5, 0},
       "x erate -0.5 y erate -0.25",
       given("c 300, mu 0.3")}};
  return all;
}
const std::vector<Deforming> &sheared() {
  static const std::vector<Deforming> all = {{"xy, friction",
                                              {0.536, 0.535, 0.5},
                                              {0.464, 0.464, 0.5},
                                              {0, 0.5, 0},
                                              "xy erate -2",
                                              given("c 600, mu 0.5")},
                                             {"yz, through the side",
                                              {0.5, 0.536, 0.535},
                                              {0.5, 0.464, 0.464},
                                              {0, 0, 0.49},
                                              "yz erate -2",
                                              given("c 300, mu 0.3"),
                                              {0, 0, 4}}};
  return all;
}

Variables variables_of(const Deforming &scene, const Vector &shift) {
  std::array<Vector, 2> places{scene.one, scene.two};
  std::array<std::string, 2> at, velocity;
  for (std::size_t n = 0; n < 2; ++n) {
    for (std::size_t a = 0; a < 3; ++a)
      places[n][a] += shift[a];
    const Wrapped wrapped = wrap(scene, places[n]);
    Vector v = times(scene.rate(), wrapped.x);
    for (std::size_t a = 0; a < 3; ++a)
      v[a] += scene.drift[a];
    at[n] = words(wrapped.x);
    velocity[n] = std::string("velocity ") + (n == 0 ? "one" : "two") + " set " + words(v) + " units box";
  }
  Variables all =
      given("box {}, one {}, two {}, first {}, second {}, dt 2e-6, third {}, steps 15000, every 15000",
            scene.sheared() ? "prism 0 1 0 1 0 1 0 0 0" : "block 0 1 0 1 0 1", at[0], at[1], velocity[0],
            velocity[1], "fix deform all deform 1 " + scene.deform + " remap v units box");
  all.insert(all.end(), scene.law.begin(), scene.law.end());
  return all;
}

/// Velocity of ball 1 relative to ball 2, or to its image that is nearest.
Vector relative_velocity(const Deforming &scene, const Result &result) {
  const Ball &one = result.ball(1), &two = result.ball(2);
  const Rate rate = scene.rate();
  Vector boxes{}, v{};
  for (std::size_t a = 3; a-- > 0;) { // sides that are sheared along others first
    boxes[a] = std::round(one.x[a] - two.x[a] - (a == 0 ? 0.03 * (rate[0][1] * boxes[1]) : 0.0) -
                          (a == 1 ? 0.03 * (rate[1][2] * boxes[2]) : 0.0));
  }
  const Vector jump = times(scene.rate(), boxes);
  for (std::size_t a = 0; a < 3; ++a)
    v[a] = one.v[a] - two.v[a] - jump[a];
  return v;
}

void expect_same_contact(const Deforming &scene, const Result &across, const Result &inside) {
  constexpr double tolerance = 4e-3; // the engine's ghosts follow the box by one step
  const Vector u = relative_velocity(scene, across), v = relative_velocity(scene, inside);
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_NEAR(u[a], v[a], tolerance * 0.05);
    for (const long id : {1L, 2L})
      EXPECT_NEAR(across.ball(id).omega[a], inside.ball(id).omega[a], tolerance * 5);
  }
  EXPECT_GE(inside.events.size(), 2u);
  ASSERT_EQ(across.events.size(), inside.events.size());
  for (std::size_t n = 0; n < across.events.size(); ++n) {
    EXPECT_EQ(across.events[n].make, inside.events[n].make);
    EXPECT_NEAR(across.events[n].time, inside.events[n].time, 1e-4);
    EXPECT_NEAR(across.events[n].overlap_rate, inside.events[n].overlap_rate, tolerance * 0.1);
  }
  EXPECT_GT(inside.heat, 0.0);
  EXPECT_GT(across.heat, 0.0);
  EXPECT_NEAR(across.heat, inside.heat, 0.02 * inside.heat);
  EXPECT_NEAR(across.rubbed, inside.rubbed, 0.02 * std::max(inside.heat, inside.rubbed));
}

TEST_P(EngineFixes, ContactAcrossADeformingSideIsThatInside) {
  std::vector<Deforming> scenes = deforming();
  if (std::get<0>(GetParam()) == "lammps") // LIGGGHTS has no contacts across sides that are sheared
    scenes.insert(scenes.end(), sheared().begin(), sheared().end());
  for (const Deforming &scene : scenes) {
    SCOPED_TRACE(scene.name);
    expect_same_contact(scene, run_pair(variables_of(scene, scene.shift)), run_pair(variables_of(scene, {})));
  }
}

TEST_P(EngineFixes, BondAcrossADeformingSideIsThatInside) {
  for (Deforming scene : deforming()) {
    SCOPED_TRACE(scene.name);
    scene.law = given(
        "fourth fix bond all bond/spring 1 2 1e5 60 length 0.105, fifth neigh_modify exclude group one two");
    const Result across = run_pair(variables_of(scene, scene.shift)),
                 inside = run_pair(variables_of(scene, {}));
    const Vector u = relative_velocity(scene, across), v = relative_velocity(scene, inside);
    for (std::size_t a = 0; a < 3; ++a)
      EXPECT_NEAR(u[a], v[a], 4e-3 * 0.05);
  }
}

TEST_P(EngineFixes, DrumKeepsItsVelocityThroughADeformingSide) {
  const Result free =
      run_pair(given("one 0.5 0.95 0.5, two 0.5 0.5 0.5, box block 0 1 0 1 0 1, first velocity one set 0 4 0 "
                     "units box, second fix deform all deform 1 y erate -0.5 remap v units box"));
  EXPECT_LT(free.ball(1).x[1], 0.5) << "still on the side where it was";
  EXPECT_NEAR(free.v_drum, 4.0, 1e-12);
  EXPECT_NEAR(free.x_drum, 4.0 * 0.03, 1e-3);
  EXPECT_NEAR(free.ball(1).v[1], 4.5, 1e-12);
}

// With `remap x` the box moves the balls, and with `none` the ghosts, without a velocity. The second-order
// scheme is of first order in this motion then, as the engine's own is.
TEST_P(EngineFixes, OtherRemappingsConvergeToTheEnginesScheme) {
  for (const char *remap : {"x", "none"})
    for (const bool across : {false, true}) {
      SCOPED_TRACE(std::string(remap) + (across ? ", across" : ", inside"));
      Deforming scene = deforming().front();
      Variables coarse = variables_of(scene, across ? scene.shift : Vector{});
      coarse = with(given("third {}, dt 1e-5, steps 3000, every 3000",
                          std::string("fix deform all deform 1 y erate -0.5 remap ") + remap),
                    coarse);
      Variables fine = coarse;
      fine = with(given("dt 5e-7, steps 60000, every 60000"), fine);
      const Result rough = run_pair(coarse), exact = run_pair_with("stock", fine);
      for (const long id : {1L, 2L})
        EXPECT_NEAR(rough.ball(id).v[1], exact.ball(id).v[1], 2e-3 * 0.05);
    }
}

TEST_P(EngineFixes, PartsOfABoxThatDeformAreRefused) {
  const Scratch folder;
  EXPECT_TRUE(
      fails_with(run("pair", folder, {{"first", "fix deform one deform 1 y erate -0.5 remap v units box"}}),
                 "group of fix deform (deform) is 'one'"));
}

TEST_P(EngineFixes, GroundOfABoxThatDeformsIsRefused) {
  const Scratch folder;
  EXPECT_TRUE(
      fails_with(run("pair", folder,
                     given("first fix deform all deform 1 y erate -0.5 remap v units box, second fix ground "
                           "one boundary/absorb normal 0 1 0 area 1 density 2000 speeds 300 0")),
                 "the box is deformed by fix deform"));
}

TEST(EngineFixesInLiggghts, TriclinicBoxIsRefused) {
  const Scratch folder;
  EXPECT_TRUE(fails_with(run_scene("liggghts", "pair", {{"box", "prism 0 1 0 1 0 1 0 0 0"}}, folder.path()),
                         "the box is triclinic"));
}

/// A ball that flies along -y onto a ball at rest, and has its size and mass from the start or grows before
/// the impact.
Variables flying(bool grows, const Variables &more) {
  Variables all = given(
      "one 0.5 0.8 0.5, two 0.5 0.59 0.5, box block 0 1 0 1 0 1, sides f f f, skin 0.2, integrated one, dt "
      "1e-4, steps 2000, every 2000, first velocity one set 0 -1 0, second fix hold two freeze");
  if (grows) {
    constexpr double share = 0.2; // of the radius, at the start
    all = with(
        all,
        given("d1 {}, m1 {}, third variable grown equal 0.1*(0.2+0.8*((step<400)*step/400+(step>=400))), "
              "fourth fix grow one adapt 1 atom diameter v_grown",
              share * 0.1, share * share * share));
  }
  all.insert(all.begin(), more.begin(), more.end()); // the first value of a variable holds
  return all;
}

TEST_P(EngineFixes, GrownBallReboundsAsOneOfItsSize) {
  for (const Variables &law : {given("c 1000, mu 0.4"), given("damping ratio, c 0.3"),
                               given("normal hertz, damping ratio, c 0.5, E 1e7")}) {
    const Result grown = run_pair(flying(true, law)), full = run_pair(flying(false, law));
    EXPECT_NEAR(grown.ball(1).v[1], full.ball(1).v[1], 1e-6);
    EXPECT_GT(full.ball(1).v[1], 0.1);
    EXPECT_NEAR(grown.heat, full.heat, 1e-5 * full.heat);
    ASSERT_EQ(grown.events.size(), full.events.size());
    ASSERT_EQ(full.events.size(), 2u);
    for (std::size_t n = 0; n < 2; ++n) {
      EXPECT_NEAR(grown.events[n].time, full.events[n].time, 1e-8);
      EXPECT_NEAR(grown.events[n].force, full.events[n].force, 1e-5 * full.events[0].force);
    }
  }
}

TEST_P(EngineFixes, AccelerationOfAGrownDrumIsThatOfOneOfItsSize) {
  const Variables in_contact = given("damping ratio, c 0.3, steps 1110, every 1110");
  const Result grown = run_pair(flying(true, in_contact)), full = run_pair(flying(false, in_contact));
  EXPECT_GT(full.a_drum, 100.0);
  EXPECT_NEAR(full.a_drum, full.ball(1).f[1],
              0.1 * full.a_drum); // of 1 kg; stock's force is that of half a step before
  EXPECT_NEAR(grown.a_drum, full.a_drum, 1e-4 * full.a_drum);
}

TEST_P(EngineFixes, ExcitationOfAGrownDrumIsItsForce) {
  const Variables excited =
      given("fifth fix excite one drum/excite amplitude 30 omega 20 direction 0 1 0, steps 450, every 450");
  const Result grown = run_pair(flying(true, excited)), full = run_pair(flying(false, excited));
  EXPECT_GT(std::fabs(full.ball(1).f[1]), 1.0);
  EXPECT_NEAR(grown.ball(1).f[1], full.ball(1).f[1], 1e-9);
}

TEST_P(EngineFixes, ClumpOfAGrownBallHasItsMass) {
  const Variables clump = given("integrated all, first fix gravity one gravity 30 vector 0 1 0, second group "
                                "both union one two, fifth fix clump both clump, steps 450, every 450");
  const Result grown = run_pair(flying(true, clump)), full = run_pair(flying(false, clump));
  for (const long id : {1L, 2L}) {
    EXPECT_NEAR(full.ball(id).f[1], 15.0, 1e-9);
    EXPECT_NEAR(grown.ball(id).f[1], full.ball(id).f[1], 1e-9);
  }
}

/// A ball on another, which a fix moves in some way.
struct Moved {
  const char *name, *move;
  Variables more{};
};

Variables on_moved(const Moved &scene, double mass, double dt = 1e-4, int steps = 500) {
  return with(scene.more, given("one 0.5 0.5 0.5, two 0.5 0.59999 0.5, box block 0 1 0 1 0 1, sides f f f, "
                                "m1 {}, c 1000, mu 0.5, ct 20, integrated two, first fix gravity two gravity "
                                "9.81 vector 0 -1 0, second {}, dt {}, steps {}, every {}",
                                mass, scene.move, dt, steps, steps));
}

const std::vector<Moved> &moved() {
  static const std::vector<Moved> all = {
      {"wiggle", "fix move one move wiggle 0.001 0.002 0 0.2 units box"},
      {"linear", "fix move one move linear 0.02 0.05 0 units box"},
      {"not integrated", "print none"},
      {"rotate", "fix move one move rotate 0.49 0.5 0.5 0 0 1 0.4 units box"},
      {"variable", "variable speed equal 0.06*cos(30*step*dt)",
       given("third variable place equal 0.002*sin(30*step*dt), fourth fix move one move variable NULL "
             "v_place NULL NULL v_speed NULL units box")},
      {"variable speed",
       "variable speed equal 0.06*cos(30*step*dt)",
       {{"third", "fix move one move variable NULL NULL NULL NULL v_speed NULL units box"}}},
      {"in a clump", "fix move one move wiggle 0 0.002 0 0.2 units box", {{"third", "fix clump one clump"}}},
      {"bond", "fix move one move wiggle 0 0.002 0 0.2 units box",
       given("third fix bond all bond/spring 1 2 1e5 900 length 0.1, fourth neigh_modify exclude group one "
             "two")},
  };
  return all;
}

TEST_P(EngineFixes, MassOfAMovedBallDoesNotMatter) {
  for (const Moved &scene : moved()) {
    SCOPED_TRACE(scene.name);
    const Result light = run_pair(on_moved(scene, 0.01)), heavy = run_pair(on_moved(scene, 1e9));
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_NEAR(light.ball(1).x[a], heavy.ball(1).x[a], 1e-12);
      EXPECT_NEAR(light.ball(2).x[a], heavy.ball(2).x[a], 1e-12);
      EXPECT_NEAR(light.ball(2).v[a], heavy.ball(2).v[a], 1e-10);
    }
  }
}

// Both balls have infinite mass for the scheme: the force of the law with their positions and velocities.
TEST_P(EngineFixes, ForceOnAMovedBallIsThatOfTheLaw) {
  for (const double c : {100.0, 3e4}) {
    const Moved scene{"between", "fix move one move wiggle 0 0.002 0 0.2 units box",
                      given("c {}, mu 0, two 0.5 0.5995 0.5, first group nobody id 3, integrated nobody", c)};
    const Result result = run_pair(on_moved(scene, 0.01, 1e-4, 50));
    const Ball &one = result.ball(1), &two = result.ball(2);
    const double force = 1e6 * (0.1 - (two.x[1] - one.x[1])) + c * (one.v[1] - two.v[1]);
    EXPECT_GT(force, 500.0);
    EXPECT_NEAR(one.f[1], -force, 1e-7 * force);
  }
}

TEST_P(EngineFixes, ForceOfAWallOnAMovedBallIsThatOfTheLaw) {
  const auto &[engine, stepping] = GetParam();
  const std::string wall = engine == "lammps"
                               ? "fix floor all wall/gran/transition 1 yplane 0.4505 NULL"
                               : "fix floor all wall/gran model hooke/transition tangential coulomb "
                                 "primitive type 1 yplane 0.4505 transition B damping coefficient stepping " +
                                     stepping;
  for (const double c : {100.0, 3e4}) {
    const Moved scene{"on a wall", "fix move one move wiggle 0 -0.002 0 0.2 units box",
                      given("c {}, two 0.5 0.7 0.5, first {}", c, wall)};
    const Ball one = run_pair(on_moved(scene, 0.01, 1e-4, 50)).ball(1);
    const double force = 1e6 * (0.4505 + 0.05 - one.x[1]) - c * one.v[1];
    EXPECT_GT(force, 500.0);
    EXPECT_NEAR(one.f[1], force, 1e-7 * force);
  }
}

/// Overlap, m, of a ball of 1 kg on one that wiggles by 2 mm at 5 Hz, both with one velocity at the start: m
/// d'' = m (a + g) - k d - c d', solved with a fine step. \param c N s/m
double overlap_on_wiggle(double c, double end) {
  constexpr double m = 1, k = 1e6, g = 9.81, amplitude = 0.002, w = 10 * pi;
  const auto slope = [&](double t, const std::array<double, 2> &y) {
    return std::array<double, 2>{y[1], g - amplitude * w * w * std::sin(w * t) - (k * y[0] + c * y[1]) / m};
  };
  constexpr int steps = 20000;
  const double h = end / steps;
  std::array<double, 2> y{1e-5, 0};
  for (int n = 0; n < steps; ++n) { // Runge and Kutta
    const double t = n * h;
    const auto after = [&](double share, const std::array<double, 2> &s) {
      return std::array<double, 2>{y[0] + share * h * s[0], y[1] + share * h * s[1]};
    };
    const auto s1 = slope(t, y), s2 = slope(t + h / 2, after(0.5, s1)), s3 = slope(t + h / 2, after(0.5, s2)),
               s4 = slope(t + h, after(1, s3));
    for (std::size_t a = 0; a < 2; ++a)
      y[a] += h / 6 * (s1[a] + 2 * s2[a] + 2 * s3[a] + s4[a]);
  }
  return y[0];
}

// With the heavier dashpot and the coarser step, the contact is solved for together with others.
TEST_P(EngineFixes, BallOnAWigglingOneFollowsIt) {
  const bool second = std::get<1>(GetParam()) == "second";
  for (const double c : {100.0, 1000.0, 10000.0}) {
    SCOPED_TRACE(c);
    if (c > 1000.0 && !second) continue; // unstable
    // The engine gives the ball below its velocity in the first step only.
    const Moved wiggle{
        "wiggle", "fix move one move wiggle 0 0.002 0 0.2 units box",
        given("third {}, c {}", "velocity all set 0 " + number(0.002 * 10 * pi) + " 0 units box", c)};
    std::vector<double> errors;
    for (const int steps : {100, 400}) {
      const double end = 0.01;
      const Result result = run_pair(on_moved(wiggle, 0.01, end / steps, steps));
      const double overlap = 0.1 - (result.ball(2).x[1] - result.ball(1).x[1]);
      errors.push_back(std::fabs(overlap / overlap_on_wiggle(c, end) - 1));
      RecordProperty("relative_error_" + number(c) + "_" + std::to_string(steps), number(errors.back()));
    }
    EXPECT_LT(errors[0], second ? 1e-4 : 5e-3);
    EXPECT_LT(errors[1], (second ? 0.1 : 0.3) * errors[0]);
  }
}

// The scene in a frame that moves with the ball below.
TEST_P(EngineFixes, BallOnOneThatMovesIsThatOnOneAtRest) {
  for (const char *damping : {"1000", "100"}) {
    const Variables falls = given("c {}, two 0.5 0.6005 0.5, mu 0", damping);
    Moved rests{"rests", "velocity two set 0 -0.5 0 units box", falls};
    Moved moves{"moves", "fix move one move linear 0 0.2 0 units box", falls};
    moves.more.insert(moves.more.begin(), {"third", "velocity two set 0 -0.3 0 units box"});
    const Result still = run_pair(on_moved(rests, 0.01)), moving = run_pair(on_moved(moves, 0.01));
    EXPECT_NEAR(moving.ball(2).v[1] - 0.2, still.ball(2).v[1], 1e-9);
    EXPECT_NEAR(moving.ball(2).x[1] - 0.2 * 0.05, still.ball(2).x[1], 1e-11);
  }
}

// A moved ball that is free in the direction of the contact has its own mass there.
TEST_P(EngineFixes, BallThatIsFreeInOneDirectionHasItsMassThere) {
  const Variables falls = given("two 0.5 0.6005 0.5, mu 0, third velocity two set 0 -0.5 0 units box");
  Moved moves{"moves", "fix move one move linear 0.1 NULL 0 units box", falls};
  Moved free{"free", "velocity one set 0.1 0 0 units box", falls};
  free.more.insert(free.more.begin(), {"integrated", "all"});
  // The one is accelerated along x by the other, which moves past it: little in a short time.
  const Result driven = run_pair(on_moved(moves, 0.5, 1e-5, 800)),
               by_forces = run_pair(on_moved(free, 0.5, 1e-5, 800));
  for (const long id : {1L, 2L})
    EXPECT_NEAR(driven.ball(id).v[1], by_forces.ball(id).v[1], 1e-3);
  EXPECT_LT(driven.ball(1).v[1], -0.1);
}

TEST_P(EngineFixes, RanksAgreeWithOne) {
  std::vector<Variables> scenes = {flying(true, given("c 1000, mu 0.4"))};
  for (const Deforming &scene : deforming()) {
    scenes.push_back(variables_of(scene, scene.shift));
    if (most_ranks() == 2 && scene.name != std::string("along x and y, a corner")) continue; // by night
    Deforming bond = scene;
    bond.law = given(
        "fourth fix bond all bond/spring 1 2 1e5 3e5 length 0.105, fifth neigh_modify exclude group one two");
    scenes.push_back(variables_of(bond, scene.shift));
  }
  if (std::get<0>(GetParam()) == "lammps")
    for (const Deforming &scene : sheared())
      scenes.push_back(variables_of(scene, scene.shift));
  for (Moved scene : moved()) {
    scene.more.insert(scene.more.begin(), {"box", "block 0 1 0 1.1 0 1"}); // the balls are on different ranks
    scenes.push_back(on_moved(scene, 0.01));
  }
  for (const Variables &scene : scenes) {
    SCOPED_TRACE(scene.back().second + scene.front().second);
    const std::string &stepping = std::get<1>(GetParam());
    const Result one = run_pair_with(stepping, scene);
    Variables along_y = with(scene, {{"ranks", "1 2 1"}});
    if (std::get<0>(GetParam()) == "lammps") along_y.emplace_back("newton", "on");
    const Result two = run_pair_with(stepping, along_y, 2);
    for (const long id : {1L, 2L})
      for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_NEAR(two.ball(id).x[a], one.ball(id).x[a], 1e-12);
        EXPECT_NEAR(two.ball(id).v[a], one.ball(id).v[a], 1e-10);
      }
    EXPECT_NEAR(two.heat, one.heat, 1e-9 * std::fabs(one.heat));
    EXPECT_EQ(two.events.size(), one.events.size());
  }
}

} // namespace
} // namespace drumlin::test
