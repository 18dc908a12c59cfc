// Rolling resistance and friction of balls of one size and of very different ones.
#include "tests/support/engine_runs.h"

namespace drumlin::test {
namespace {

// Rolling resistance in both engines: a ball that rolls to rest on a plane, with its energy balance; a ball
// that circles around another, so that the normal turns; heaps in two and three dimensions, engine against
// engine.
namespace rolling {

class RollingBall : public BothEngines {};
INSTANTIATE_TEST_SUITE_P(Decks, RollingBall, engines_and_steppings(), engine_and_stepping);

/// A contact law and the overlap of a ball at rest on the floor of slide.scene, m.
struct Resting {
  const char *normal;
  double overlap;
};

/// Without slip, v = a w with a the distance of the contact point from the centre, friction and the limit L =
/// mu_r r N of the rolling torque give (I + m a^2) w' = -L: the ball comes to rest at a constant rate.
TEST_P(RollingBall, SlowsDownAsTheClosedFormAndItsEnergyBecomesHeat) {
  constexpr double m = 0.3, r = 0.03, mu_r = 0.5, N = m * 9.81, w0 = 10;
  const double hertz = 4.0 / 3.0 * 2e7 / (2 * (1 - 0.3 * 0.3)) * std::sqrt(r); // N/m^(3/2)
  for (const Resting &law : {Resting{"hooke", N / 1e5}, {"hertz", std::pow(N / hertz, 2.0 / 3.0)}}) {
    const double arm = r - 0.5 * law.overlap, inertia = 0.4 * m * r * r + m * arm * arm,
                 rate = mu_r * r * N / inertia;
    const Scratch folder;
    well(run(
        "slide", folder,
        given(
            "normal {}, rest {}, tangential coulomb, rolling epsd2, mu_r {}, mu 2, D 0.5, spin {}, speed {}",
            law.normal, law.overlap, mu_r, w0, w0 * arm)));
    const post::Table table = post::read_table(folder / "bed.csv");
    const std::vector<double> time = table.numbers("time"), kinetic = table.numbers("kinetic"),
                              elastic = table.numbers("elastic"), potential = table.numbers("potential"),
                              heat = table.numbers("dissipated");
    const double start = 0.5 * inertia * w0 * w0, whole = kinetic[0] + elastic[0] + potential[0];
    EXPECT_NEAR(kinetic.front(), start, 1e-9 * start);
    for (std::size_t n = 0; n < time.size(); ++n) {
      const double w = w0 - rate * time[n];
      EXPECT_NEAR(kinetic[n], 0.5 * inertia * w * w, 3e-3 * start) << law.normal << ' ' << time[n];
      EXPECT_NEAR(kinetic[n] + elastic[n] + potential[n] + heat[n], whole, 1e-4 * start)
          << law.normal << ' ' << time[n];
    }
    EXPECT_GT(heat.back(), 0.5 * start) << law.normal;
  }
}

/// With q^2 = kr/I and the turn W of the normal, the spin along the tangent is w0 cos(p t), p^2 = q^2 + W^2,
/// and that along the normal, into which the axes turn, w0 W/p sin(p t): it never exceeds w0. (LIGGGHTS's own
/// epsd2 keeps the torque as the normal turns; there the spin grows by a factor e^(W t).)
TEST_P(RollingBall, OnABallIsNotSpunUpAsTheNormalTurns) {
  constexpr double w0 = 1e-3, W = 20, r_eff = 0.015, inertia = 0.4 * 0.3 * 0.03 * 0.03, dt = 1e-5;
  const double q2 = 2.0 / 7.0 * 1e5 * r_eff * r_eff / inertia, p = std::sqrt(q2 + W * W);
  const Scratch folder;
  well(run("orbit", folder, {}));
  double largest = 0.0;
  const std::vector<Frame> frames = read_dump(folder / "balls.txt");
  ASSERT_EQ(frames.size(), 301u);
  for (const Frame &frame : frames) {
    const double t = dt * static_cast<double>(frame.step);
    const Ball &ball = frame.balls.at(2);
    const double x = ball.x[0] - 0.2, y = ball.x[1] - 0.15, distance = std::hypot(x, y);
    EXPECT_NEAR(distance, 0.0599, 1e-6);
    EXPECT_NEAR((ball.omega[1] * x - ball.omega[0] * y) / distance, w0 * std::cos(p * t), 5e-3 * w0) << t;
    EXPECT_NEAR((ball.omega[0] * x + ball.omega[1] * y) / distance, w0 * W / p * std::sin(p * t), 5e-3 * w0)
        << t;
    largest = std::max(largest, std::hypot(ball.omega[0], ball.omega[1]));
  }
  EXPECT_LE(largest, w0 * (1 + 1e-12));
}

/// Dimension and stepping of a heap.
class RollingHeap : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {};
INSTANTIATE_TEST_SUITE_P(
    Decks, RollingHeap, ::testing::Combine(::testing::Values("2", "3"), ::testing::Values("second", "stock")),
    [](const auto &test) { return "in" + std::get<0>(test.param) + "D_" + std::get<1>(test.param); });

/// In time steps in which a deck asks for the pressure, LIGGGHTS computes the contacts in its own loop; in
/// all others the plugin computes them in another one. Both give the same motion and the same forces on
/// balls, bit for bit, the same forces of contacts in fix contact/local to 1e-9 N, and the same energies in
/// fix contact/energy. With D = 20, `stepping second` solves for the damping forces of contacts that share a
/// ball together, after the loop: the force that fix contact/local prints must be the solved one, not the one
/// that the loop has computed before.
TEST_P(RollingHeap, IsTheSameInTheLoopsOfEngineAndPlugin) {
  const auto &[dimension, stepping] = GetParam();
  for (const char *damping : {"0.2", "20"}) {
    const auto heap = [&, d = dimension, s = stepping](const Scratch &folder, const char *observed,
                                                       const char *pressed) {
      well(run_scene("liggghts", "heap",
                     given("dimension {}, stepping {}, contact_D {}, observed {}, pressed {}, steps 2400", d,
                           s, damping, observed, pressed),
                     folder.path()));
      return post::read_text(folder / "balls.txt");
    };
    const Scratch plain, engine, plugin;
    const std::string expected = heap(plain, "0", "0");
    EXPECT_EQ(heap(engine, "1", "1"), expected) << damping;
    EXPECT_EQ(heap(plugin, "1", "0"), expected) << damping;
    // The file has nine decimal places. "-0.000000000" counts as equal to "0.000000000".
    const auto forces = [](const Scratch &folder) {
      return std::regex_replace(post::read_text(folder / "contacts.txt"), std::regex("-(0\\.0* )"), "$1");
    };
    EXPECT_GT(forces(engine).size(), 2000u) << damping;
    EXPECT_TRUE(forces(plugin) == forces(engine)) << damping;
    const post::Table of_engine = post::read_table(engine / "energies.csv");
    const post::Table of_plugin = post::read_table(plugin / "energies.csv");
    for (const char *column :
         {"kinetic", "normal", "tangential", "damping_heat", "friction_heat", "contacts"}) {
      const double value = of_engine.numbers(column).at(0);
      EXPECT_GT(value, 0.0) << column << ' ' << damping;
      EXPECT_NEAR(of_plugin.numbers(column).at(0), value, 1e-12 * value) << column << ' ' << damping;
    }
  }
}

/// A contact in the dump contacts.txt: the IDs of its two balls (0 for a wall), the three components of the
/// force on the first ball, N, and of the unit normal.
using ContactRow = std::array<double, 8>;

/// Normal component of the contact force, N. It is positive if it pushes the balls apart.
double push_of(const ContactRow &row) { return row[2] * row[5] + row[3] * row[6] + row[4] * row[7]; }
/// Magnitude of the friction force, N.
double friction_of(const ContactRow &row) {
  const double push = push_of(row);
  return std::hypot(row[2] - push * row[5], row[3] - push * row[6], row[4] - push * row[7]);
}

/// The contacts in the dump, by time step.
std::map<long, std::vector<ContactRow>> rows_of_contacts(const std::filesystem::path &dump) {
  std::ifstream file(dump);
  std::map<long, std::vector<ContactRow>> rows;
  long step = 0;
  for (std::string line; std::getline(file, line);) {
    if (line == "ITEM: TIMESTEP" && std::getline(file, line)) step = std::stol(line);
    std::istringstream words(line);
    ContactRow row{};
    std::size_t numbers = 0;
    while (numbers < row.size() && words >> row[numbers])
      ++numbers;
    if (numbers == row.size()) rows[step].push_back(row); // else a line of the dump's header
  }
  return rows;
}

/// With heavy damping, `stepping second` computes friction first and the final normal forces of contacts that
/// share a ball afterwards. Friction must not exceed mu times these final forces Fn, and the torque of a ball
/// not the sum over its contacts of friction times its radius and of mu_r R Fn, the limit of rolling
/// resistance with the effective radius R.
TEST_P(RollingHeap, FrictionAndRollingKeepTheirLimitsAtAnyDamping) {
  constexpr double mu = 0.4, mu_r = 0.2; // of heap.scene, as the radius, m
  const auto radius = [](long id) { return 0.5 * (0.07 + 0.02 * std::sin(7.0 * static_cast<double>(id))); };
  const auto &[dimension, stepping] = GetParam();
  for (const char *engine : {"liggghts", "lammps"}) {
    if (std::string(engine) == "lammps" && !post::has_lammps()) continue;
    for (const char *damping : {"10", "40"}) {
      const Scratch folder;
      well(run_scene(
          engine, "heap",
          given("dimension {}, stepping {}, contact_D {}, observed 1, steps 4000, contacts_every 20",
                dimension, stepping, damping),
          folder.path()));
      int contacts = 0, at_limit = 0;
      std::map<long, std::map<long, double>>
          largest; // torque of each ball that its contacts allow, N m, by step
      for (const auto &[step, rows] : rows_of_contacts(folder / "contacts.txt"))
        for (const ContactRow &row : rows) {
          const double push = push_of(row), rub = friction_of(row);
          // N: the file has nine decimal places of forces, N, and of normals.
          const double digits = 1e-8 * (1.0 + std::hypot(row[2], row[3], row[4]));
          EXPECT_LE(rub, mu * std::max(0.0, push) + digits)
              << engine << ' ' << damping << ", step " << step << ", balls " << row[0] << ' ' << row[1];
          const long i = std::lround(row[0]), j = std::lround(row[1]); // j = 0: a wall
          const double reduced = j == 0 ? radius(i) : radius(i) * radius(j) / (radius(i) + radius(j));
          for (const long ball : {i, j})
            largest[step][ball] += radius(ball) * rub + mu_r * reduced * std::fabs(push);
          ++contacts;
          at_limit += rub > 0.999 * mu * push ? 1 : 0;
        }
      EXPECT_GT(contacts, 1000) << engine << ' ' << damping;
      EXPECT_GT(at_limit, contacts / 100) << engine << ' ' << damping;

      int turned = 0;
      for (const Frame &frame : read_dump(folder / "balls.txt"))
        for (const auto &[id, ball] : frame.balls) {
          const double torque = std::hypot(ball.torque[0], ball.torque[1], ball.torque[2]);
          EXPECT_LE(torque, (1.0 + 1e-6) * largest[frame.step][id] + 1e-9)
              << engine << ' ' << damping << ", ball " << id << " in step " << frame.step;
          turned += torque > 0.0 ? 1 : 0;
        }
      EXPECT_GT(turned, 100) << engine << ' ' << damping;
    }
  }
}

/// The friction force Ft of a heavily damped contact is limited twice: to the friction coefficient times a
/// preliminary normal force, and, when all normal forces are known, to the coefficient times the final one.
/// The second limitation must also shorten the tangential spring, so that its force is again Ft. Without a
/// tangential dashpot the energy of this spring is Ft^2/(2 kt). The test compares the elastic energy of all
/// tangential springs with the sum of Ft^2/(2 kt) over the contacts.
TEST_P(RollingHeap, TheSpringOfFrictionFollowsTheLimit) {
  constexpr double kt = 2.0 / 7.0 * 1e5; // N/m, of heap.scene
  const auto &[dimension, stepping] = GetParam();
  for (const auto &[engine, undamped_friction] :
       {std::pair("liggghts", "fix ct all property/global gammat_abs peratomtypepair 3 0 0 0 0 0 0 0 0 0"),
        std::pair("lammps", "pair_coeff * * 1e5 20 0.4 NULL 0")}) {
    if (std::string(engine) == "lammps" && !post::has_lammps()) continue;
    const Scratch folder;
    well(run_scene(engine, "heap",
                   given("dimension {}, stepping {}, contact_D 20, rolling_history 0, line_of_law {}, "
                         "observed 1, steps 4000, contacts_every 4000",
                         dimension, stepping, undamped_friction),
                   folder.path()));
    double stored = 0.0; // J, of the last step
    const std::map<long, std::vector<ContactRow>> steps = rows_of_contacts(folder / "contacts.txt");
    for (const ContactRow &row : steps.at(4000))
      stored += friction_of(row) * friction_of(row) / (2.0 * kt);
    const double energy = post::read_table(folder / "energies.csv").numbers("tangential").at(0);
    EXPECT_GT(energy, 0.0) << engine;
    EXPECT_NEAR(stored, energy, 1e-6 * energy) << engine;
  }
}

} // namespace rolling

// Friction between balls of very different sizes, in both engines: a small ball rolls down the groove between
// two large ones and falls off; a ball stays at rest between a large and a small one.
namespace sizes {

class SizeRatio : public BothEngines {};
INSTANTIATE_TEST_SUITE_P(Decks, SizeRatio, engines_and_steppings(), engine_and_stepping);

constexpr double large = 5e-3, g = 9.81;

/// Angle from the top of the groove and distance from the line of the large centres, in units of that in
/// contact.
struct Place {
  double angle, distance;
};

std::vector<Place> path_in_the_groove(const std::filesystem::path &dump, double contact) {
  std::vector<Place> path;
  for (const Frame &frame : read_dump(dump)) {
    const Ball &ball = frame.balls.at(3);
    const double y = ball.x[1] - 0.15, z = ball.x[2] - 0.3;
    path.push_back({std::atan2(y, z), std::hypot(y, z) / contact});
  }
  return path;
}

/// Force towards the groove, in weights, at which the ball comes off; < 0: the ball is wedged in, and it
/// takes a pull. The weight W is carried by normal and tangential springs of both contacts, N = n W and T = t
/// W, unless friction slides, T = mu N. As the force falls to W' the springs unload by n (W - W') and t (W -
/// W'), until friction slides the other way, T = -mu N.
double force_at_the_end(double sine) {
  constexpr double kt = 2.0 / 7.0, mu = 0.5; // kt over k
  const double cosine = std::sqrt(1 - sine * sine), stiffness = 2 * (sine * sine + kt * cosine * cosine);
  const double n = sine / stiffness, t = kt * cosine / stiffness;
  return t <= mu * n ? 0.0 : 1 - 2 * mu * 0.5 / (sine + mu * cosine) / (t + mu * n);
}

/// With l the distance of the ball from the line of the large centres and R + r that of the centres, rolling
/// without slip is (1 + 0.4 (R + r)^2/l^2) l a'' = g sin a. At the angle where g cos a - v^2/l has fallen to
/// force_at_the_end() the ball comes off; friction across the groove can only make that earlier. (With the
/// normal of the end of the step in the slip velocity the ball sticks to the groove down to its bottom.)
TEST_P(SizeRatio, RollsDownTheGrooveAndFallsOff) {
  for (const double ratio : {1.0, 3.0, 20.0, 100.0}) {
    const double r = large / ratio, length = std::sqrt((large + r) * (large + r) - large * large);
    const double slowed = 1 + 0.4 * std::pow((large + r) / length, 2);
    const double leaves = std::acos((force_at_the_end(length / (large + r)) * slowed + 2) / (2 + slowed));
    const Scratch folder;
    well(run("groove", folder, {{"ratio", number(ratio)}}));
    const std::vector<Place> path = path_in_the_groove(folder / "balls.txt", length);
    double angle = 0.01745, rate = 0, farthest = 0; // velocity Verlet with 100 steps for a row
    const double dt = 3000e-6 / 100;
    const auto kick = [&] { rate += 0.5 * dt * g / (length * slowed) * std::sin(angle); };
    int rows = 0;
    for (const Place &place : path) {
      if (angle < 0.5) {
        ++rows;
        EXPECT_NEAR(place.angle, angle, 1e-3 * angle) << "ratio " << ratio << ", row " << rows;
        EXPECT_NEAR(place.distance, 1, 1e-5) << "ratio " << ratio << ", row " << rows;
      }
      if (place.distance < 1.001) farthest = std::max(farthest, std::fabs(place.angle));
      for (int n = 0; n < 100; ++n) {
        kick();
        angle += dt * rate;
        kick();
      }
    }
    EXPECT_GT(rows, 10);
    EXPECT_LT(farthest, leaves + 0.15) << "ratio " << ratio;
    EXPECT_GT(farthest, 0.5) << "ratio " << ratio;
  }
}

TEST_P(SizeRatio, StaysAtRestBetweenALargeAndASmallBall) {
  for (const double ratio : {1.0, 3.0, 20.0, 100.0}) {
    const Scratch folder;
    well(run("wedge", folder, {{"ratio", number(ratio)}}));
    const std::vector<Frame> frames = read_dump(folder / "balls.txt");
    ASSERT_EQ(frames.size(), 11u);
    const Ball &middle = frames[5].balls.at(3), &end = frames[10].balls.at(3);
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_NEAR(end.v[a], 0, 1e-9) << "ratio " << ratio;            // m/s
      EXPECT_NEAR(end.x[a], middle.x[a], 1e-12) << "ratio " << ratio; // m
      EXPECT_NEAR(end.x[a], frames[0].balls.at(3).x[a], 1e-8) << "ratio " << ratio;
      EXPECT_NEAR(end.omega[a], 0, 1e-9 / (large / ratio)) << "ratio " << ratio; // rad/s
    }
  }
}

} // namespace sizes

} // namespace
} // namespace drumlin::test
