// What LAMMPS alone has: faces of regions, data files, partitions, suffixes, rigid bodies, compute
// pair/local. That it gives the results of LIGGGHTS is a matter of the table `invariances`.
#include "tests/support/chain_by_cvode.h"
#include "tests/support/engine_runs.h"
#include "bed/dump_readers.h"
#include "chain/analysis.h"
#include "chain/exact_solution.h"

namespace drumlin::test {
namespace {

/// Everything here needs an lmp with the plugin.
class InLammps : public ::testing::Test {
protected:
  void SetUp() override { SKIP_WITHOUT_LAMMPS(true); }
};

// The Hertz law's dashpot has no value at a negative overlap: a contact that has ended has no force.
TEST(InLammpsWalls, WithoutHistoryEndsAContactWithoutAForce) {
  SKIP_WITHOUT_LAMMPS(true);
  const Scratch folder;
  well(run_scene("lammps", "bounce", given("normal hertz, tangential no_history, stepping stock"),
                 folder.path()));
  const std::vector<Frame> frames = read_dump(folder / "balls.txt");
  ASSERT_FALSE(frames.empty());
  for (const auto &[id, ball] : frames.back().balls)
    for (const double value : {ball.x[0], ball.v[0], ball.v[2], ball.omega[1]})
      EXPECT_TRUE(std::isfinite(value)) << "ball " << id;
}

TEST_F(InLammps, RefusesAnotherVersionOnRanksOneAndTwo) {
  const WaitForRanks at_once(0);
  const Scratch folder;
  for (const int ranks : {1, 2}) {
    EXPECT_TRUE(fails_with(
        run_deck(chain_deck("in.chain.lammps"), {{"plugin", DRUMLIN_OTHER_LAMMPS}}, folder.path(), ranks),
        "ERROR: drumlin " DRUMLIN_VERSION ": built for LAMMPS 1 Feb 2003 (20030201), but this is 20"));
  }
}

/// With -partition each partition is a run of its own. With a folder of its own, its files are byte by byte
/// those of a single run.
TEST_F(InLammps, PartitionsAreRunsOfTheirOwnOnRanksOneAndTwo) {
  const Scratch scratch;
  const std::string drumlin = std::string(DRUMLIN_SOURCE_DIR) + "/drumlin";
  std::ofstream(scratch / "both.lammps") << "variable out world both/A both/B\n"
                                            "variable transition world A B\n"
                                            "variable here index "
                                         << chain_deck("").string() << "\ninclude ${here}/in.chain.lammps\n";
  const Outcome both = well(
      run_program({drumlin, "run", "-np", "2", "both.lammps", "-partition", "2x1", "-var", "cycles", "3"}, {},
                  scratch.path()));
  for (const char *transition : {"A", "B"}) {
    const Scratch alone;
    well(run_deck(chain_deck("in.chain.lammps"), given("transition {}, cycles 3", transition), alone.path()));
    for (const char *table : {"chain.csv", "events.csv", "cycles.csv"})
      EXPECT_EQ(read_text(alone / table), read_text(scratch / "both" / transition / table)) << table;
  }
}

/// With a suffix LAMMPS takes its own accelerated variants where it has them, and refuses a suffix whose
/// package is not in the lmp.
TEST_F(InLammps, SuffixesChangeNoResult) {
  const Scratch plain;
  well(run_deck(chain_deck("in.chain.lammps"), {{"cycles", "1"}}, plain.path()));
  for (const std::string suffix : {"opt", "omp"}) {
    const Scratch folder;
    const Outcome outcome = run_program({std::string(DRUMLIN_SOURCE_DIR) + "/drumlin", "run",
                                         chain_deck("in.chain.lammps").string(), "-sf", suffix, "-var",
                                         "cycles", "1", "-var", "out", "."},
                                        {}, folder.path());
    if (outcome.status == 1) {
      EXPECT_TRUE(printed(outcome, "ERROR: Using suffix " + suffix + " without "));
      continue;
    }
    ASSERT_TRUE(outcome.ok()) << outcome.output;
    EXPECT_EQ(read_text(plain / "chain.csv"), read_text(folder / "chain.csv")) << suffix;
  }
}

TEST_F(InLammps, RefusesTheHistoryOfAnotherWallOnRanksOneAndTwo) {
  const WaitForRanks at_once(0);
  const Scratch block;
  well(run_scene("lammps", "bounce", {{"walls", "block"}}, block.path()));
  for (const int ranks : {1, 2}) {
    const Scratch folder;
    EXPECT_TRUE(fails_with(
        run_scene("lammps", "bounce",
                  given("again 1, start {}, walls cylinder", (block / "first.restart").string()),
                  folder.path(), ranks),
        "fix wall/gran/transition: the restart file holds another wall under the ID 'walls'; allowed: "));
  }
}

/// No dashpots and no friction: contacts without history, whose forces are those of a potential energy.
const Variables springs = given("D 0, tangential off, mu -1");

TEST_F(InLammps, ContinuesFromADataFileWithoutContactHistory) {
  const Scratch stayed, left;
  well(run_scene("lammps", "bounce", springs, stayed.path()));
  const Variables from = given("start {}, again 1, data 1, law deck", (stayed / "first.data").string());
  well(run_scene("lammps", "bounce", with(springs, from), left.path()));
  std::vector<Frame> whole = read_dump(stayed / "balls.txt");
  const std::vector<Frame> rest = read_dump(left / "balls.txt");
  whole.erase(whole.begin(), whole.end() - static_cast<std::ptrdiff_t>(rest.size()));
  ASSERT_EQ(rest.size(), 7u);
  EXPECT_LT(distance(whole, rest), 1e-9);
}

// However far the ball moves in one step, the shear spring of a broken contact with a face is deleted.
TEST_F(InLammps, HistoryOfABallPutBackOnAFaceOfARegionStartsAtZero) {
  const auto force = [](const char *lifted) {
    const Scratch folder;
    well(run_deck(test_deck("lift.lammps"), {{"lifted", lifted}}, folder.path()));
    std::array<double, 2> along_and_up{};
    std::ifstream in(folder / "force.txt");
    EXPECT_TRUE(in >> along_and_up[0] >> along_and_up[1]);
    return along_and_up;
  };
  constexpr double kn = 1e5, kt = 2.0 / 7.0 * kn, overlap = 1e-4, slid = 0.1 * 50e-6;
  const std::array<double, 2> stayed = force("0"), put_back = force("0.01"), hopped = force("0.002");
  EXPECT_NEAR(std::fabs(stayed[0]), kt * slid, 0.05 * kt * slid);
  for (const std::array<double, 2> &again : {put_back, hopped}) {
    EXPECT_NEAR(again[0], 0, 1e-12);
    EXPECT_NEAR(std::fabs(again[1]), kn * overlap, 0.05 * kn * overlap);
  }
}

/// Energy of the springs and of the weight in bounce.scene, J. \param pipe whether the walls are those of a
/// cylinder, not planes
double energy(const std::map<long, Ball> &balls, bool pipe) {
  constexpr double k = 1e5, density = 2500.0, gravity = 9.81;
  const auto radius = [](long id) { return 0.5 * (0.06 + 0.02 * std::sin(7.0 * static_cast<double>(id))); };
  const auto spring = [](double overlap) { return overlap > 0.0 ? 0.5 * k * overlap * overlap : 0.0; };
  double sum = 0.0;
  for (const auto &[i, one] : balls) {
    const double r = radius(i);
    const auto &[x, y, z] = one.x;
    sum += 4.0 / 3.0 * pi * r * r * r * density * gravity * z + spring(r - z);
    sum += pipe ? spring(r + std::hypot(x - 0.225, y - 0.15) - 0.15)
                : spring(r - x) + spring(x + r - 0.4) + spring(r - y) + spring(y + r - 0.3);
    for (const auto &[j, other] : balls)
      if (j < i) sum += spring(r + radius(j) - std::hypot(x - other.x[0], y - other.x[1], z - other.x[2]));
  }
  return sum;
}

TEST_F(InLammps, ForcesAreTheCentralDifferencesOfTheEnergy) {
  constexpr double h = 1e-7; // m
  for (const char *stepping : {"second", "stock"})
    for (const char *walls : {"planes", "block", "cylinder"}) {
      const bool pipe = std::string(walls) == "cylinder";
      const Scratch folder;
      const Variables variables = with(springs, given("stepping {}, walls {}", stepping, walls));
      well(run_scene("lammps", "bounce", variables, folder.path()));
      double largest = 0.0;
      for (const Frame &frame : read_dump(folder / "balls.txt"))
        for (const auto &[id, ball] : frame.balls)
          for (std::size_t axis = 0; axis < 3; ++axis) {
            std::map<long, Ball> moved = frame.balls;
            moved.at(id).x[axis] = ball.x[axis] + h;
            const double above = energy(moved, pipe);
            moved.at(id).x[axis] = ball.x[axis] - h;
            const double force = -(above - energy(moved, pipe)) / (2.0 * h);
            EXPECT_NEAR(ball.f[axis], force, 1e-3) // N
                << stepping << ", " << walls << ", step " << frame.step << ", ball " << id;
            largest = std::max(largest, std::fabs(force));
          }
      EXPECT_GT(largest, 50.0);
    }
}

// Without dashpots no force jumps, so that second-order steps add no impulse to it. compute pair/local has no
// contacts with walls.
TEST_F(InLammps, ContactsOfADumpExplainTheForcesOnBallsOnRanksOneAndTwo) {
  for (const auto &[ranks, newton] : {std::pair{1, "off"}, {2, "off"}, {1, "on"}, {2, "on"}}) {
    const Scratch folder;
    well(
        run_scene("lammps", "bounce", given("D 0, dump_every 500, newton {}", newton), folder.path(), ranks));
    std::array<std::size_t, 2> judged{};
    const std::map<long, post::StepDump> steps = post::dumped_steps(folder / "dump");
    EXPECT_EQ(steps.size(), 25u);
    for (const auto &[step, files] : steps) {
      const std::vector<post::Ball> balls = post::read_ball_dump(files.balls); // IDs from 1 on
      const post::BedContacts contacts = post::read_contact_dump(files.contacts, balls);
      std::vector<post::Vector> weightless;
      weightless.reserve(balls.size());
      for (const post::Ball &ball : balls)
        weightless.push_back({ball.force[0], ball.force[1], ball.force[2] + 9.81 * ball.mass});
      std::array<std::vector<post::Vector>, 2> rest{
          weightless, weightless}; // by fix contact/local, by compute pair/local
      const auto pair = [](std::vector<post::Vector> &forces, std::size_t i, std::size_t j,
                           const post::Vector &force) {
        for (std::size_t a = 0; a < 3; ++a) {
          forces[i][a] -= force[a];
          forces[j][a] += force[a];
        }
      };
      std::vector<bool> touches(balls.size(), false), at_wall(balls.size(), false);
      for (const post::BallContact &contact : contacts.balls) {
        pair(rest[0], contact.i, contact.j, contact.force);
        touches[contact.i] = touches[contact.j] = true;
      }
      for (const post::WallContact &contact : contacts.walls) {
        for (std::size_t a = 0; a < 3; ++a)
          rest[0][contact.i][a] -= contact.force[a];
        at_wall[contact.i] = true;
      }
      const post::TextDump own =
          post::read_text_dump(folder.path() / "dump" / ("own_" + std::to_string(step) + ".dump"));
      EXPECT_EQ(own.rows.size(), contacts.balls.size());
      for (const std::vector<double> &row : own.rows)
        pair(rest[1], static_cast<std::size_t>(row[0]) - 1, static_cast<std::size_t>(row[1]) - 1,
             {row[2] + row[5], row[3] + row[6], row[4] + row[7]});
      for (std::size_t n = 0; n < balls.size(); ++n)
        for (std::size_t source = 0; source < 2; ++source) {
          if (source == 0 ? !touches[n] && !at_wall[n] : !touches[n] || at_wall[n]) continue;
          ++judged.at(source);
          EXPECT_LT(std::hypot(rest.at(source)[n][0], rest.at(source)[n][1], rest.at(source)[n][2]),
                    1e-6) // N
              << "ball " << balls[n].id << ", step " << step << ", ranks " << ranks << ", newton " << newton
              << (source == 0 ? ", fix contact/local" : ", compute pair/local");
        }
    }
    EXPECT_GT(judged[0], 50u);
    EXPECT_GT(judged[1], 20u);
  }
}

TEST_F(InLammps, AnImpactConvergesToTheClosedForm) {
  for (const post::Transition transition : {post::Transition::A, post::Transition::B}) {
    post::ImpactParameters p;
    p.transition = transition;
    p.speed = 0.5;
    const double exact = -post::impact_state(p, post::impact_duration(p)).rate;
    for (const char *count : {"100", "400", "1600"}) {
      const Scratch folder;
      well(run_deck(chain_deck("in.impact.lammps"),
                    given("transition {}, D {}, steps_per_contact {}, samples 100",
                          post::transition_name(transition), p.damping_ratio, count),
                    folder.path()));
      const double error = std::fabs(read_run(folder.path()).history.v_drum.back() - exact);
      EXPECT_LT(error, p.speed / (std::stod(count) * std::stod(count))) // of second order
          << post::transition_name(transition) << ", " << count << " steps";
    }
  }
}

// Contacts use the mass of the body. Oracles: restitution by the closed form, momentum, and LAMMPS's own law,
// which steps as `stock` does.
TEST_F(InLammps, RigidBodyBouncesWithItsMassOnRanksOneAndTwo) {
  constexpr double M = 2.0 + 3.0, m = 4.0, v = -0.5, D = 0.3, k = 1e5;
  post::ImpactParameters impact;
  impact.damping_ratio = D;
  const double restitution = -post::impact_state(impact, post::impact_duration(impact)).rate / impact.speed;
  for (const std::string target : {"ball", "floor"}) {
    const double m_eff = target == "ball" ? M * m / (M + m) : M;
    // Contacts end with a relative velocity of -restitution of that before; a floor has any momentum.
    const double body = target == "ball" ? (M - restitution * m) / (M + m) * v : -restitution * v;
    const double ball = target == "ball" ? M / (M + m) * (1.0 + restitution) * v : 0.0;
    for (const auto &[rigid, ranks] : {std::pair{"rigid", 1},
                                       {"rigid", 2},
                                       {"rigid/nve", 1},
                                       {"small", 1},
                                       {"small", 2},
                                       {"nve/small", 1}}) {
      const auto velocities = [&, rigid = rigid, ranks = ranks](const Variables &law) {
        const Scratch folder;
        const Variables variables = with(law, given("target {}, rigid {}, D {}", target, rigid, D));
        well(run_deck(test_deck("dumbbell.lammps"), variables, folder.path(), ranks));
        std::vector<double> values(3);
        std::ifstream in(folder / "velocities.txt");
        for (double &value : values)
          in >> value;
        return values;
      };
      const std::vector<double> found = velocities({});
      const std::string where = target + ", " + rigid + ", ranks " + std::to_string(ranks);
      EXPECT_NEAR(found[0], body, 1e-3 * std::fabs(v)) << where;
      EXPECT_NEAR(found[1], body, 1e-3 * std::fabs(v)) << where;
      EXPECT_NEAR(found[2], ball, 1e-3 * std::fabs(v)) << where;
      const std::vector<double> own = velocities({{"gamma", number(2.0 * D * std::sqrt(k / m_eff))}});
      for (std::size_t n = 0; n < 3; ++n)
        EXPECT_NEAR(found[n], own[n], 1e-9) << where << ", ball " << n + 1; // m/s
    }
  }
}

} // namespace
} // namespace drumlin::test
