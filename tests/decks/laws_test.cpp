// Contact laws in both engines: that of Hertz, the one that yields, suction.
#include "tests/support/engine_runs.h"
#include "chain/analysis.h"
#include "physics/laws/yield_contact.h"

namespace drumlin::test {
namespace {

// The Hertz law in both engines: whole impacts against the closed form of the restitution at several speeds,
// their event log and heat, an oblique impact against an integration of its equations in far smaller steps,
// walls against balls, and transitions without damping. (laws_test has what holds for all laws.)
namespace hertz {

/// Balls 1 to 4 of oblique.scene strike the floor, 5 to 8 the balls 9 to 12, at these angles from the normal
/// and 1 m/s.
constexpr std::array<double, 4> angles = {72 * pi / 180, 76 * pi / 180, 80 * pi / 180, 85 * pi / 180};
constexpr double radius = 0.03, mass = 1e-4, E = 2e9, nu = 0.3, mu = 0.5;

/// e of an impact, the closed form of the linear law of the same D.
double closed_form(const std::string &transition, double D) {
  post::ImpactParameters p;
  p.transition = post::transition_from_name(transition);
  p.damping_ratio = D;
  p.speed = 1;
  const double end = post::impact_duration(p);
  return std::isinf(end) ? 0.0 : -post::impact_state(p, end).rate;
}

/// A run of oblique.scene.
struct Impacts {
  std::vector<Frame> frames;
  std::vector<post::ContactEvent> events; ///< of the pairs of balls
  double normal_heat, friction_heat;      ///< J

  /// J, that the balls have lost.
  double lost() const { return kinetic(frames.front()) - kinetic(frames.back()); }

private:
  static double kinetic(const Frame &frame) {
    double sum = 0;
    for (const auto &[id, ball] : frame.balls)
      for (std::size_t a = 0; a < 3; ++a)
        sum += 0.5 * mass * (ball.v[a] * ball.v[a] + 0.4 * radius * radius * ball.omega[a] * ball.omega[a]);
    return sum;
  }
};

class HertzImpacts : public BothEngines {
protected:
  static Impacts impacts(Variables variables) {
    variables.emplace_back("normal", "hertz");
    const Scratch folder;
    const Outcome outcome = well(run("oblique", folder, variables));
    return {read_dump(folder / "balls.txt"), post::read_events(folder / "events.csv"),
            number_behind(outcome.output, "heat of the normal dashpots "),
            number_behind(outcome.output, " of friction ")};
  }

  static Impacts head_on_impacts(Variables variables) {
    variables = with(variables, given("across 0, tangential off, mu -1"));
    return impacts(variables);
  }

  /// e of the eight head-on impacts.
  static std::array<double, 8> head_on(const Variables &variables) {
    const std::vector<Frame> frames = head_on_impacts(variables).frames;
    const std::map<long, Ball> &begin = frames.front().balls, &end = frames.back().balls;
    std::array<double, 8> e{};
    for (long id = 1; id <= 4; ++id)
      e.at(static_cast<std::size_t>(id) - 1) = -end.at(id).v[2] / begin.at(id).v[2];
    for (long id = 5; id <= 8; ++id)
      e.at(static_cast<std::size_t>(id) - 1) = (end.at(id + 4).v[2] - end.at(id).v[2]) / begin.at(id).v[2];
    return e;
  }

  static double worst(const Variables &variables, double exact) {
    double most = 0;
    for (const double e : head_on(variables))
      most = std::max(most, std::fabs(e - exact));
    return most;
  }
};

TEST_P(HertzImpacts, ReboundAsTheClosedFormAtAnySpeed) {
  const bool second = std::get<1>(GetParam()) == "second";
  for (const char *transition : {"A", "B"})
    for (const char *D : {"0", "0.1", "0.3", "0.5"})
      EXPECT_LT(worst(given("transition {}, D {}", transition, D), closed_form(transition, std::stod(D))),
                second ? 1e-5 : 5e-3)
          << transition << ", D " << D;
  EXPECT_LT(worst({{"D", "2"}}, closed_form("B", 2)), second ? 1e-5 : 5e-3);
}

/// A make is at d = 0 with the speed v of the impact. The contact breaks with e v: under A, and without a
/// dashpot, at d = 0; under B where k d^(3/2) = c d^(1/4) e v. Without a dashpot it lasts (4/5) G(2/5) G(1/2)
/// / G(9/10) d/v, with the gamma function G and d = (5/4 m v^2 / k)^(2/5). The heat is m v^2 (1 - e^2) / 2.
TEST_P(HertzImpacts, LogMakeAndBreakAndBecomeHeatAsTheClosedForms) {
  constexpr double gap = 1e-6, m_eff = 0.5 * mass;
  const double k = 4.0 / 3.0 * 0.5 * E / (1 - nu * nu) * std::sqrt(0.5 * radius); // of two balls
  const bool second = std::get<1>(GetParam()) == "second";
  for (const auto &[transition, D] : {std::pair{"A", 0.0}, {"A", 0.3}, {"B", 0.3}, {"B", 2.0}}) {
    const double e = closed_form(transition, D), c = 2 * D * std::sqrt(1.25 * k * m_eff);
    const Impacts found = head_on_impacts(given("transition {}, D {}", transition, D));
    ASSERT_EQ(found.events.size(), 8u) << transition << ", D " << D;
    const double tolerance = second ? 1e-4 : 1e-2;
    double heat = 0;
    for (std::size_t n = 0; n < angles.size(); ++n) {
      const double v = std::cos(angles.at(n)), start = gap / v;
      const std::string where =
          std::string(transition) + ", D " + number(D) + ", pair " + std::to_string(n + 1);
      const auto event = [&, id = static_cast<long>(n) + 5](bool make) {
        return *std::find_if(found.events.begin(), found.events.end(), [&](const post::ContactEvent &one) {
          return one.id_i == id && one.id_j == id + 4 && one.make == make;
        });
      };
      const post::ContactEvent make = event(true), end = event(false);
      EXPECT_NEAR(make.time, start, 1e-12) << where; // s
      EXPECT_NEAR(make.overlap, 0, 1e-15) << where;
      EXPECT_NEAR(make.overlap_rate, v, tolerance * v) << where;
      EXPECT_EQ(make.force, 0) << where;
      const double deepest = std::pow(1.25 * m_eff * v * v / k, 0.4);
      EXPECT_NEAR(end.overlap_rate, -e * v, tolerance * v) << where;
      EXPECT_NEAR(end.overlap, std::string(transition) == "B" ? std::pow(c * e * v / k, 0.8) : 0.0,
                  tolerance * deepest)
          << where;
      if (D == 0) {
        const double share = 0.8 * std::tgamma(0.4) * std::tgamma(0.5) / std::tgamma(0.9);
        EXPECT_NEAR(end.time - start, share * deepest / v, tolerance * deepest / v) << where;
      }
      heat += 0.5 * (mass + m_eff) * v * v * (1 - e * e); // of the ball on the floor and of the pair
    }
    EXPECT_NEAR(found.normal_heat, heat, (second ? 1e-3 : 1e-2) * found.lost() + 1e-12)
        << transition << ", D " << D;
    EXPECT_NEAR(found.friction_heat, 0, 1e-9 * heat + 1e-18);
  }
}

TEST_P(HertzImpacts, ReboundWithTheRestitutionThatIsAskedFor) {
  const double tolerance = std::get<1>(GetParam()) == "second" ? 1e-5 : 5e-3;
  for (const char *transition : {"A", "B"})
    EXPECT_LT(
        worst(given("transition {}, damping restitution, property coefficientRestitution, D 0.6", transition),
              0.6),
        tolerance)
        << transition;
}

class HertzImpactsUnderSecond : public HertzImpacts {};

/// The contacts take some 50 and 400 steps. The phase of the make in its step differs with the ball and the
/// step.
TEST_P(HertzImpactsUnderSecond, ErrorFallsWithTheSquareOfTheStep) {
  for (const char *D : {"0.3", "2"}) {
    const auto largest = [D](double dt) {
      double most = 0;
      for (const double factor : {1.0, 1.03, 1.07})
        most = std::max(most, worst(given("D {}, dt {}, steps {}", D, factor * dt, std::lround(2.5e-4 / dt)),
                                    closed_form("B", std::stod(D))));
      return most;
    };
    const double coarse = largest(8e-7), fine = largest(1e-7);
    RecordProperty(std::string("errors_") + D, number(coarse) + ", " + number(fine));
    EXPECT_GT(std::log(coarse / fine) / std::log(8.0), 1.9) << D << ": " << coarse << " " << fine;
  }
}

/// Contact time [s] of an undamped Hertzian impact with speed v [m/s]. \param m effective mass [kg] \param R
/// effective radius [m]
double duration(double E_eff, double m, double R, double v) {
  const double k = 4.0 / 3.0 * E_eff * std::sqrt(R);
  return 0.8 * std::tgamma(0.4) * std::tgamma(0.5) / std::tgamma(0.9) * std::pow(1.25 * m * v * v / k, 0.4) /
         v;
}

// The contact of the fastest pair takes 23 steps, and the others more.
TEST_P(HertzImpactsUnderSecond, BecomeHeatInFewSteps) {
  constexpr double E_eff = 0.5 * E / (1 - nu * nu);
  for (const auto &[transition, D] : {std::pair{"A", 0.1}, {"A", 0.5}, {"B", 0.3}, {"B", 1.0}, {"B", 3.0}}) {
    const double dt = duration(E_eff, 0.5 * mass, 0.5 * radius, std::cos(angles.front())) / 23;
    const Impacts found = head_on_impacts(given("transition {}, D {}, dt {}, steps 500", transition, D, dt));
    double before = 0, heat = 0;
    for (const double angle : angles) {
      const double v = std::cos(angle), e = closed_form(transition, D);
      before += 0.5 * 2 * mass * v * v;
      heat += 0.5 * 1.5 * mass * v * v * (1 - e * e);
    }
    EXPECT_NEAR(found.normal_heat, found.lost(), 1e-4 * before) << transition << ' ' << D;
    EXPECT_NEAR(found.normal_heat, heat, 1e-3 * before) << transition << ' ' << D;
  }
}

// The same in the energies of a drum that strikes a ball at rest.
TEST_P(HertzImpactsUnderSecond, BecomeHeatInTheCyclesOfADrum) {
  constexpr double E_eff = 0.5 * 2e8 / (1 - nu * nu);
  for (const auto &[transition, D] : {std::pair{"A", 0.5}, {"B", 0.3}, {"B", 1.0}, {"B", 3.0}}) {
    const Scratch folder;
    well(run("pair", folder,
             given("normal hertz, damping ratio, transition {}, c {}, one 0 0.2001 0.5, dt {}, steps 400, "
                   "integrated one, first velocity one set 0 -1 0, second fix hold two freeze, third {}",
                   transition, D, duration(E_eff, 1, 0.025, 1) / 23,
                   "fix cycles one roller/history file " + (folder / "c.csv").string() +
                       " every 400 axis 0 1 0 cycles " + (folder / "cycles.csv").string() + " 400")));
    const post::Table cycles = post::read_table(folder / "cycles.csv");
    const double e = closed_form(transition, D), before = cycles.numbers("kinetic").front(),
                 heat = cycles.numbers("dissipated_contact").back();
    EXPECT_NEAR(before, 0.5, 1e-12);
    EXPECT_NEAR(heat, before - cycles.numbers("kinetic").back(), 1e-4 * before) << transition << ' ' << D;
    EXPECT_NEAR(heat, before * (1 - e * e), 1e-3 * before) << transition << ' ' << D;
  }
}

/// Velocities along the floor and up after the impact of a ball, by steps of 2 ns: transition B, no
/// tangential dashpot. The tangential force F grows by kt u while the contact is loaded and shrinks with kt
/// besides while it is unloaded; it is at most mu Fn.
std::array<double, 2> oblique(double along, double down, double D) {
  const double E_eff = 0.5 * E / (1 - nu * nu), G_eff = 0.25 * E / ((2 - nu) * (1 + nu));
  const double k = 4.0 / 3.0 * E_eff * std::sqrt(radius), c = 2 * D * std::sqrt(1.25 * k * mass);
  const double dt = 2e-9;
  double d = 0, rate = down, slip = along, friction = 0, v = along;
  for (int step = 0; step < 100000; ++step) {
    const double middle = d + 0.5 * dt * rate; // the midpoint's rule
    if (middle < 0) break;
    const double force = std::max(0.0, k * std::pow(middle, 1.5) + c * std::pow(middle, 0.25) * rate);
    const double kt = 8 * G_eff * std::sqrt(radius * middle);
    friction += dt * kt * slip;
    if (rate < 0 && d > 0) friction *= std::sqrt(std::max(0.0, d + dt * rate) / d);
    friction = std::max(-mu * force, std::min(mu * force, friction));
    d += dt * rate;
    rate -= dt * force / mass;
    v -= dt * friction / mass;
    const double arm = (radius - 0.5 * middle) / radius; // I = 0.4 m r^2
    slip -= dt * friction / mass * (1 + 2.5 * arm * arm);
  }
  return {v, -rate};
}

TEST_P(HertzImpacts, StickAndSlideAsTheEquationsOfAnObliqueImpact) {
  const double tolerance = std::get<1>(GetParam()) == "second" ? 2e-4 : 2e-3;
  for (const double across : {0.1, 0.25, 1.0}) {
    Variables variables = given("across {}, D 0.3, ct 0, dt 5e-8, steps 5000", across);
    if (across == 0.25 && std::get<0>(GetParam()) == "lammps")
      variables.emplace_back("walls", "block"); // the floor is a face of a region
    const Impacts found = impacts(variables);
    const std::vector<Frame> &frames = found.frames;
    EXPECT_NEAR(found.normal_heat + found.friction_heat, found.lost(), 1e-2 * found.lost()) << across;
    EXPECT_GT(found.friction_heat, 0.02 * found.lost()) << across;
    for (long id = 1; id <= 4; ++id) {
      const double angle = angles.at(static_cast<std::size_t>(id) - 1);
      const auto [along, up] = oblique(across * std::sin(angle), std::cos(angle), 0.3);
      const Ball &end = frames.back().balls.at(id);
      EXPECT_NEAR(end.v[0], along, tolerance * std::cos(angle)) << "ball " << id << ", across " << across;
      EXPECT_NEAR(end.v[2], up, tolerance * std::cos(angle)) << "ball " << id << ", across " << across;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Decks, HertzImpacts, engines_and_steppings(), engine_and_stepping);
INSTANTIATE_TEST_SUITE_P(Decks, HertzImpactsUnderSecond,
                         ::testing::Combine(::testing::Values("liggghts", "lammps"),
                                            ::testing::Values("second")),
                         engine_and_stepping);

// For the same overlap and rate a primitive plane and a mesh give the same force.
TEST(HertzWalls, PlaneAndMeshAreOne) {
  for (const char *stepping : {"second", "stock"}) {
    const auto run = [stepping](const char *obstacle) {
      return run_balls(given("normal hertz, obstacle {}, stepping {}, models tangential coulomb, dashpot "
                             "0.3, velocity2 0.05 0 -0.5, gap 0.0001, dt 1e-5, steps 4000, every 10",
                             obstacle, stepping));
    };
    const BallsRun plane = run("plane"), mesh = run("mesh");
    EXPECT_GT(plane.frames.back().balls.at(1).v[2], 0.1) << "no rebound";
    for (const std::size_t axis : {std::size_t{0}, std::size_t{2}})
      EXPECT_LT(relative_difference(mesh.series(1, &Ball::v, axis), plane.series(1, &Ball::v, axis)), 1e-9)
          << stepping;
  }
}

class HertzGuard : public BothEngines {};
INSTANTIATE_TEST_SUITE_P(Decks, HertzGuard, engines_and_steppings(), engine_and_stepping);

TEST_P(HertzGuard, EndsARunBeyondTheCriticalStepInBothEngines) {
  constexpr double m = 0.3, r = 0.03, overlap = 1e-4;
  const double k = 4.0 / 3.0 * 0.5 * 2e7 / (1 - nu * nu) * std::sqrt(r);
  const double critical = 2 * std::sqrt(m / (1.5 * k * std::sqrt(overlap)));
  for (const double share : {0.999, 1.001}) {
    const Scratch folder;
    const Outcome outcome =
        run("slide", folder,
            given("normal hertz, rest {}, tangential off, mu -1, guard step 1, dt {}, steps 50", overlap,
                  share * critical));
    EXPECT_EQ(outcome.ok(), share < 1) << outcome.output;
  }
}

// 2 sqrt(m / (3/2 k sqrt(d))), k = 4/3 E* sqrt(R): on a plane R is the ball's radius.
TEST(HertzGuardInLiggghts, CriticalStepIsThatOfTheTangentStiffness) {
  for (const char *obstacle : {"ball", "plane", "mesh"}) {
    const double R = std::string(obstacle) == "ball" ? 0.5 * 0.75 / 1.25 : 0.75, overlap = 0.003;
    const double k = 4.0 / 3.0 * 0.5 * 1e9 / (1 - nu * nu) * std::sqrt(R);
    const double critical = 2 * std::sqrt(2000 / (1.5 * k * std::sqrt(overlap)));
    const auto run = [&](double dt) {
      return run_balls(
          given("normal hertz, obstacle {}, stepping second, gap {}, guard step 1, dt {}, steps 1", obstacle,
                -overlap, dt));
    };
    EXPECT_NO_THROW(run(0.999 * critical)) << obstacle;
    EXPECT_THROW(run(1.001 * critical), std::runtime_error) << obstacle;
  }
}

class WithoutDamping : public BothEngines {};
INSTANTIATE_TEST_SUITE_P(Decks, WithoutDamping, engines_and_steppings(), engine_and_stepping);

// Without a dashpot no contact is in tension, and A and B are the same law.
TEST_P(WithoutDamping, TransitionsAreTheSameBitForBit) {
  for (const auto &[normal, tangential] :
       {std::pair{"hooke", "history"}, {"hooke", "coulomb"}, {"hertz", "coulomb"}}) {
    std::vector<std::string> dumps;
    for (const char *transition : {"A", "B"}) {
      const Scratch folder;
      well(run(
          "bounce", folder,
          given("normal {}, transition {}, D 0, tangential {}, rolling epsd2, first 6000, rest 0, every 500",
                normal, transition, tangential)));
      dumps.push_back(read_text(folder / "balls.txt"));
      const std::vector<Frame> frames = read_dump(folder / "balls.txt");
      int spinning = 0; // after contacts
      for (const auto &[id, ball] : frames.back().balls)
        spinning += ball.omega[1] != 0.0 ? 1 : 0;
      EXPECT_GT(spinning, 10) << normal << ", " << tangential;
    }
    EXPECT_TRUE(dumps[0] == dumps[1])
        << normal << ", " << tangential; // no list of their differences, which takes minutes
  }
}

} // namespace hertz

// The law that yields in both engines: whole impacts against the closed form of the restitution, and how
// their heat divides into yielding and dashpots; lattices that are loaded, unloaded and loaded again.
// (laws_test has what holds for all laws: engines, ranks, restarts.)
namespace of_yield {

constexpr double mass = 1e-4, k1 = 6e5; // kg, N/m, of oblique.scene

class YieldImpacts : public BothEngines {
protected:
  /// What head-on impacts of oblique.scene have lost and turned into heat, J, and their e.
  struct Impacts {
    std::array<double, 8> e; ///< balls 1 to 4 strike the floor, 5 to 8 another ball of their kind
    double lost, dashpots, friction, yielding;
  };

  static Impacts head_on(double ratio, const Variables &more) {
    const Scratch folder;
    const bool lammps = std::get<0>(GetParam()) == "lammps";
    std::ofstream(folder / "properties") << "fix stiffnessRatio all property/global stiffnessRatio "
                                            "peratomtypepair 2 "
                                         << ratio << ' ' << ratio << ' ' << ratio << ' ' << ratio
                                         << "\nfix kn all property/global kn peratomtypepair 2 " << k1 << ' '
                                         << k1 << ' ' << k1 << ' ' << k1 << '\n';
    const Variables law =
        given("normal yield, parameters {}, across 0, tangential off, mu -1",
              lammps ? number(k1) + " " + number(ratio) : "include " + (folder / "properties").string());
    const Outcome outcome = well(run("oblique", folder, with(law, more)));
    const std::vector<Frame> frames = read_dump(folder / "balls.txt");
    const std::map<long, Ball> &begin = frames.front().balls, &end = frames.back().balls;
    Impacts found{{},
                  kinetic(begin) - kinetic(end),
                  number_behind(outcome.output, "heat of the normal dashpots "),
                  number_behind(outcome.output, " of friction "),
                  number_behind(outcome.output, " of yielding ")};
    for (long id = 1; id <= 8; ++id) {
      const double other = id > 4 ? end.at(id + 4).v[2] : 0.0;
      found.e.at(static_cast<std::size_t>(id) - 1) = (other - end.at(id).v[2]) / begin.at(id).v[2];
    }
    return found;
  }

  static double kinetic(const std::map<long, Ball> &balls) {
    double sum = 0;
    for (const auto &[id, ball] : balls)
      sum += 0.5 * mass * ball.v[2] * ball.v[2];
    return sum;
  }

  static double worst(const Impacts &impacts, double exact) {
    double most = 0;
    for (const double e : impacts.e)
      most = std::max(most, std::fabs(e - exact));
    return most;
  }

  static bool second() { return std::get<1>(GetParam()) == "second"; }
};

/// Speeds from 0.09 to 0.31 m/s. Without a dashpot all heat is that of yielding, (1 - k1/k2) m v^2 / 2. With
/// a dashpot yielding gives (1 - k1/k2) k1 d_max^2 / 2, with the closed form of the largest overlap, d_max =
/// v sqrt(m/k1) exp(-b t1), and the dashpot the rest.
TEST_P(YieldImpacts, ReboundAndBecomeHeatAsTheClosedFormsAtAnySpeed) {
  for (const double ratio : {1.0, 1.5, 4.0})
    for (const auto &[transition, D] :
         {std::pair{"A", 0.0}, {"A", 0.05}, {"B", 0.0}, {"B", 0.1}, {"B", 0.5}}) {
      const std::string where = std::string(transition) + ", D " + number(D) + ", ratio " + number(ratio);
      const Impacts found = head_on(ratio, given("transition {}, D {}", transition, D));
      const double e = physics::restitution_of_yield(
          transition[0] == 'A' ? physics::Transition::A : physics::Transition::B, D, ratio);
      EXPECT_LT(worst(found, e), second() ? 1e-4 : 5e-3) << where;
      EXPECT_EQ(found.friction, 0) << where;
      double energy = 0; // of the approach
      for (std::size_t n = 0; n < 4; ++n) {
        const double v = std::cos(std::array{72., 76., 80., 85.}.at(n) * pi / 180);
        energy += 0.5 * (mass + 0.5 * mass) * v * v;
      }
      EXPECT_NEAR(found.yielding + found.dashpots, found.lost,
                  (second() ? 1e-3 : 5e-3) * found.lost + 3e-5 * energy)
          << where;
      const double w = std::sqrt(1 / ratio - D * D), t = std::atan2(w, D) / w; // in units of m and k2
      if (!(D * D < 1 / ratio)) continue;
      const double yielding = (1 - 1 / ratio) * std::exp(-2 * D * t) * energy;
      EXPECT_NEAR(found.yielding, yielding, (second() ? 1e-3 : 1e-2) * energy) << where;
    }
}

TEST_P(YieldImpacts, ReboundWithTheRestitutionThatIsAskedFor) {
  for (const char *transition : {"A", "B"})
    EXPECT_LT(
        worst(head_on(2.0, given("transition {}, damping restitution, property coefficientRestitution, D 0.4",
                                 transition)),
              0.4),
        second() ? 1e-4 : 5e-3)
        << transition;
}

INSTANTIATE_TEST_SUITE_P(Engines, YieldImpacts, engines_and_steppings(), engine_and_stepping);

// A ball that bounces on, forgets and yields anew: a primitive plane and a mesh give the same force.
TEST(YieldWalls, PlaneAndMeshAreOne) {
  for (const char *stepping : {"second", "stock"}) {
    const auto run = [stepping](const char *obstacle) {
      return run_balls(
          given("normal yield, ratio 3, obstacle {}, stepping {}, models tangential coulomb, dashpot 0.1, "
                "velocity2 0.05 0 -0.5, g 9.81, gap 0.0001, dt 1e-4, steps 4000, every 10",
                obstacle, stepping));
    };
    const BallsRun plane = run("plane"), mesh = run("mesh");
    const std::vector<double> v = plane.series(1, &Ball::v, 2);
    int rebounds = 0;
    for (std::size_t n = 1; n < v.size(); ++n)
      rebounds += v[n - 1] < 0 && v[n] > 0 ? 1 : 0;
    EXPECT_GE(rebounds, 2) << stepping;
    for (const std::size_t axis : {std::size_t{0}, std::size_t{2}})
      EXPECT_LT(relative_difference(mesh.series(1, &Ball::v, axis), plane.series(1, &Ball::v, axis)), 1e-9)
          << stepping;
  }
}

class YieldInTheSoil : public InEngine {};

/// A hexagonal lattice in the oedometer: the modulus of the closed form of soil_test, with k in first loading
/// and with k2 in unloading and reloading. (The seating stress was once exceeded, while the lattice came to
/// rest: the first row is not compared.)
TEST_P(YieldInTheSoil, LoadsUnloadsAndReloadsALatticeAsItsStiffnessesSay) {
  constexpr double kn = 1e8, kt = 3e7, ratio = 2.5;
  const post::Table rows = run_element_test(
      GetParam(), "oedometer",
      given("sample hexagonal, loads 6 7 6 6.5 6.9 7 8, ratio 1e-9, k {}, kt {}, yield {}", kn, kt, ratio));
  const auto modulus_of = [](double k) { return std::sqrt(3.0) / 4 * (3 * k + kt); };
  const std::vector<std::string> modulus = rows.text("modulus_MPa");
  ASSERT_EQ(modulus.size(), 8u);
  for (const auto &[row, k] :
       {std::pair<std::size_t, double>{2, kn}, {3, ratio * kn}, {4, ratio * kn}, {5, ratio * kn}, {7, kn}})
    EXPECT_NEAR(post::number_from_text(modulus.at(row)), 1e-6 * modulus_of(k), 5e-9 * modulus_of(k)) << row;
  for (std::size_t row = 1; row < 8; ++row)
    EXPECT_LT(std::fabs(rows.numbers("energy_error").at(row)), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Engines, YieldInTheSoil, ::testing::Values("liggghts", "lammps"),
                         [](const auto &test) { return test.param; });

} // namespace of_yield

// Suction between two balls, and of a soil: forces, friction, energies and records in closed form, in both
// engines and with both schemes.
namespace suction {

constexpr double k = 1e6, diameter = 0.1; // of pair.scene: N/m, m

class Suction : public BothEngines {};
INSTANTIATE_TEST_SUITE_P(Both, Suction, engines_and_steppings(), engine_and_stepping);

double gap_of(const Ball &one, const Ball &two) {
  return std::hypot(one.x[0] - two.x[0], one.x[1] - two.x[1], one.x[2] - two.x[2]) - diameter;
}

// Two heavy balls slide past each other. The net force is k d - F_a, here a tension; friction is mu k d.
TEST_P(Suction, PullsAndLeavesFrictionToTheSpring) {
  constexpr double mu = 0.5;
  for (const double pull : {60.0, 150.0}) {
    const Scratch folder;
    well(run("pair", folder,
             given("one 0 0.0999 0.5, two 0 0 0.5, m1 1e7, m2 1e7, c 0, mu {}, suction {}, first velocity "
                   "one set 1 0 0 units box, box block -0.5 0.5 -0.5 0.5 0 1, steps 200, every 100",
                   mu, pull)));
    const auto balls = read_dump(folder / "balls.txt").back().balls;
    const Ball &one = balls.at(1), &two = balls.at(2);
    const double d = -gap_of(one, two), distance = diameter - d;
    const std::array<double, 2> normal{(one.x[0] - two.x[0]) / distance, (one.x[1] - two.x[1]) / distance};
    const double push = one.f[0] * normal[0] + one.f[1] * normal[1];
    const double across = one.f[0] * normal[1] - one.f[1] * normal[0];
    EXPECT_NEAR(push, k * d - pull, 1e-6 * k * d);
    EXPECT_NEAR(across, -mu * k * d, 1e-6 * k * d);
  }
}

// Two balls that meet at 1 m/s: they leave each other or stick. Kinetic energy, spring, -F_a d and the heat
// of the dashpot are what they brought.
TEST_P(Suction, ClosesTheEnergyBalance) {
  for (const char *transition : {"A", "B"})
    for (const double pull : {30.0, 2000.0}) {
      const Scratch folder;
      well(run(
          "pair", folder,
          given(
              "one 0 0.55001 0.5, two 0 0.45 0.5, transition {}, c 200, suction {}, first velocity one set 0 "
              "-0.5 0 units box, second velocity two set 0 0.5 0 units box, dt 1e-5, steps 1000, every 1000",
              transition, pull)));
      const auto balls = read_dump(folder / "balls.txt").back().balls;
      std::ifstream file(folder / "heat.txt");
      double t = 0, heat = 0, rubbed = 0;
      while (file >> t >> heat >> rubbed) {
      }
      const double d = std::max(0.0, -gap_of(balls.at(1), balls.at(2)));
      double energy = heat + 0.5 * k * d * d - pull * d;
      for (const auto &[id, ball] : balls)
        for (const double v : ball.v)
          energy += 0.5 * v * v;
      EXPECT_EQ(d > 0.0, pull > 1000.0) << transition;
      // Under `stock` the make falls within a step whose force begins at its end.
      const double scheme = std::get<1>(GetParam()) == "stock" ? 2e-2 * 0.25 + 0.5 * pull * 1.0 * 1e-5 : 0.0;
      EXPECT_NEAR(energy, 0.25, 1e-3 * 0.25 + scheme) << transition << ' ' << pull;
    }
}

// A pair that sticks lies still: from half a million steps on it has the same bits.
TEST_P(Suction, LetsAPairLieStillForAMillionSteps) {
  constexpr double pull = 2000.0;
  const Scratch folder;
  well(run("pair", folder,
           given("one 0 0.099 0.5, two 0 0 0.5, box block -0.5 0.5 -0.5 0.5 0 1, c 200, suction {}, steps "
                 "1000000, every 500000",
                 pull)));
  const std::vector<Frame> frames = read_dump(folder / "balls.txt");
  ASSERT_EQ(frames.size(), 3u);
  for (const long id : {1, 2})
    EXPECT_EQ(frames[1].balls.at(id).x, frames[2].balls.at(id).x);
  EXPECT_NEAR(-gap_of(frames[2].balls.at(1), frames[2].balls.at(2)), pull / k, 1e-12 * pull / k + 1e-16);
}

// The record of makes and breaks: under B, too, the contact ends at d = 0, where it pulls with F_a.
TEST_P(Suction, IsInTheRecordOfEvents) {
  constexpr double pull = 30.0;
  const Scratch folder;
  well(run("pair", folder,
           given("one 0 0.55001 0.5, two 0 0.45 0.5, c 0, suction {}, first velocity one set 0 -1 0 units "
                 "box, dt 1e-5, steps 500",
                 pull)));
  const std::vector<post::ContactEvent> events = post::read_events(folder / "events.csv");
  ASSERT_EQ(events.size(), 2u);
  for (const post::ContactEvent &event : events)
    EXPECT_NEAR(event.force, -pull, 1e-9);
  // The oscillator of the reduced mass about d = F_a/k, until it is at 0 again.
  const double w = std::sqrt(k / 0.5), phase = std::atan(pull / k * w);
  EXPECT_NEAR(events[1].time - events[0].time, (pi + 2.0 * phase) / w, 2e-5);
}

// A ball that hangs under a wall of the same type, and does not where the suction is less than its weight.
TEST_P(Suction, HoldsABallUnderAWallThatHasIt) {
  const bool lammps = std::get<0>(GetParam()) == "lammps";
  const std::string wall =
      lammps
          ? "fix wall all wall/gran/transition 1 zplane NULL 0.9"
          : "fix wall all wall/gran model hooke/transition tangential coulomb primitive type 1 zplane 0.9 " +
                std::string("damping coefficient stepping ") + std::get<1>(GetParam());
  for (const double pull : {9.0, 11.0}) {
    const Scratch folder;
    Variables all = given("one 0 0 0.850001, two 0 0.3 0.5, c 500, suction {}, sides p p f, box block -0.5 "
                          "0.5 -0.5 0.5 0 1, second fix gravity all gravity 9.81 vector 0 0 -1, steps 20000",
                          pull);
    all.emplace_back("first", wall);
    well(run("pair", folder, all));
    const Ball ball = read_dump(folder / "balls.txt").back().balls.at(1);
    if (pull > 9.81) {
      EXPECT_NEAR(ball.x[2] + 0.05 - 0.9, (pull - 9.81) / k, 1e-9);
    } else {
      EXPECT_LT(ball.x[2], 0.849);
    }
  }
}

// Rumpf's formula for balls of one size: F_a = S pi d^(n-1)/(P Z) in n dimensions.
TEST_P(Suction, FollowsFromTheTensileStrengthOfASoil) {
  const bool lammps = std::get<0>(GetParam()) == "lammps";
  for (const char *test : {"biaxial", "triaxial"}) {
    const bool flat = std::string(test) == "biaxial";
    const Variables small = given("sample {}, columns 4, layers 4, tensile_strength 1e4, solid_fraction 0.7, "
                                  "contacts_per_ball 4.5, strain 1e-2, samples_of_strain 1, stepping {}",
                                  flat ? "hexagonal" : "cubic", std::get<1>(GetParam()));
    const Scratch folder;
    const Outcome outcome =
        well(run_deck(chain_deck(std::string("../soil/in.") + test + (lammps ? ".lammps" : "")),
                      with(small, {{"rows", flat ? "1" : "4"}}), folder.path()));
    const std::size_t at = outcome.output.rfind("suction ");
    ASSERT_NE(at, std::string::npos);
    const double expected = 1e4 * pi * (flat ? 0.04 : 0.04 * 0.04) / (0.7 * 4.5);
    EXPECT_NEAR(std::stod(outcome.output.substr(at + 8)), expected, 1e-9 * expected);
  }
  const Scratch folder;
  const Outcome both = run_deck(chain_deck(std::string("../soil/in.biaxial") + (lammps ? ".lammps" : "")),
                                given("sample hexagonal, tensile_strength 1, suction 1"), folder.path());
  EXPECT_TRUE(
      printed(both, "ERROR: drumlin/check: variable suction is '1'; allowed: a finite number at most 0"));
}

} // namespace suction

} // namespace
} // namespace drumlin::test
