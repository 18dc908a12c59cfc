// The Hertz law in both engines: whole impacts against the closed form of the restitution at several speeds,
// their event log and heat, an oblique impact against an integration of its equations in far smaller steps,
// walls against balls, and transitions without damping. (laws_test has what holds for all laws.)
#include "tests/support/balls_run.h"
#include "tests/support/checks.h"
#include "tests/support/engine_and_scheme.h"
#include "tests/support/frame_distance.h"

#include "chain/analysis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace drumlin::test {
namespace {

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

/// The number behind the last occurrence of a text.
double number_behind(const std::string &output, const std::string &text) {
  const std::size_t found = output.rfind(text);
  if (found == std::string::npos) throw std::runtime_error(output);
  return std::stod(output.substr(found + text.size()));
}

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
    variables.insert(variables.end(), {{"across", "0"}, {"tangential", "off"}, {"mu", "-1"}});
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
      EXPECT_LT(worst({{"transition", transition}, {"D", D}}, closed_form(transition, std::stod(D))),
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
    const Impacts found = head_on_impacts({{"transition", transition}, {"D", number(D)}});
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
    EXPECT_LT(worst({{"transition", transition},
                     {"damping", "restitution"},
                     {"property", "coefficientRestitution"},
                     {"D", "0.6"}},
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
        most = std::max(most, worst({{"D", D},
                                     {"dt", number(factor * dt)},
                                     {"steps", std::to_string(std::lround(2.5e-4 / dt))}},
                                    closed_form("B", std::stod(D))));
      return most;
    };
    const double coarse = largest(8e-7), fine = largest(1e-7);
    RecordProperty(std::string("errors_") + D, number(coarse) + ", " + number(fine));
    EXPECT_GT(std::log(coarse / fine) / std::log(8.0), 1.9) << D << ": " << coarse << " " << fine;
  }
}

/// Duration of an undamped contact, s. \param m, R effective mass, kg, and radius, m
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
    const Impacts found =
        head_on_impacts({{"transition", transition}, {"D", number(D)}, {"dt", number(dt)}, {"steps", "500"}});
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
             {{"normal", "hertz"},
              {"damping", "ratio"},
              {"transition", transition},
              {"c", number(D)},
              {"one", "0 0.2001 0.5"},
              {"dt", number(duration(E_eff, 1, 0.025, 1) / 23)},
              {"steps", "400"},
              {"integrated", "one"},
              {"first", "velocity one set 0 -1 0"},
              {"second", "fix hold two freeze"},
              {"third", "fix cycles one roller/history file " + (folder / "c.csv").string() +
                            " every 400 axis 0 1 0 cycles " + (folder / "cycles.csv").string() + " 400"}}));
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
    Variables variables = {
        {"across", number(across)}, {"D", "0.3"}, {"ct", "0"}, {"dt", "5e-8"}, {"steps", "5000"}};
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
      return run_balls({{"normal", "hertz"},
                        {"obstacle", obstacle},
                        {"stepping", stepping},
                        {"models", "tangential coulomb"},
                        {"dashpot", "0.3"},
                        {"velocity2", "0.05 0 -0.5"},
                        {"gap", "0.0001"},
                        {"dt", "1e-5"},
                        {"steps", "4000"},
                        {"every", "10"}});
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
    const Outcome outcome = run("slide", folder,
                                {{"normal", "hertz"},
                                 {"rest", number(overlap)},
                                 {"tangential", "off"},
                                 {"mu", "-1"},
                                 {"guard", "step 1"},
                                 {"dt", number(share * critical)},
                                 {"steps", "50"}});
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
      return run_balls({{"normal", "hertz"},
                        {"obstacle", obstacle},
                        {"stepping", "second"},
                        {"gap", number(-overlap)},
                        {"guard", "step 1"},
                        {"dt", number(dt)},
                        {"steps", "1"}});
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
      well(run("bounce", folder,
               {{"normal", normal},
                {"transition", transition},
                {"D", "0"},
                {"tangential", tangential},
                {"rolling", "epsd2"},
                {"first", "6000"},
                {"rest", "0"},
                {"every", "500"}}));
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

} // namespace
} // namespace drumlin::test
