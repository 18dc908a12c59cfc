// Two balls: momentum, the effective mass, mirror images, the two ways to give damping, and the bond.
#include "tests/support/balls_run.h"
#include "tests/support/checks.h"
#include "tests/support/host_deck.h"
#include "tests/support/engine_and_scheme.h"

#include "chain/analysis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

/// Under A and under B.
class EitherTransition : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Law, EitherTransition, ::testing::Values("A", "B"),
                         [](const auto &test) { return test.param; });

/// Largest departure of the total momentum from its start, over the sum of the balls' largest momenta.
double momentum_drift(const BallsRun &run, double m1, double m2) {
  const std::vector<double> v1 = run.series(1, &Ball::v, 2);
  const std::vector<double> v2 = run.series(2, &Ball::v, 2);
  double drift = 0, scale = 0;
  for (std::size_t n = 0; n < v1.size(); ++n) {
    drift = std::max(drift, std::fabs(m1 * (v1[n] - v1[0]) + m2 * (v2[n] - v2[0])));
    scale = std::max(scale, m1 * std::fabs(v1[n]) + m2 * std::fabs(v2[n]));
  }
  return drift / scale;
}

TEST_P(EitherTransition, FreePairKeepsItsMomentumAndReboundsWithItsEffectiveMass) {
  constexpr double m1 = 500, m2 = 3000, k = 1e8;
  post::ImpactParameters p;
  p.transition = post::transition_from_name(GetParam());
  p.mass = m1 * m2 / (m1 + m2);
  p.speed = 0.9;
  const auto restitution_error = [&](double D, int steps) {
    p.damping_ratio = D;
    const BallsRun run = run_balls({{"fixed", "3"},
                                    {"transition", GetParam()},
                                    {"dashpot", number(D)},
                                    {"m1", number(m1)},
                                    {"m2", number(m2)},
                                    {"velocity1", "0 0 0.6"},
                                    {"velocity2", "0 0 -0.3"},
                                    {"dt", number(pi / std::sqrt(k / p.mass) / steps)},
                                    {"steps", std::to_string(3 * steps)}});
    EXPECT_LT(momentum_drift(run, m1, m2), 1e-14);
    const auto &end = run.frames.back().balls;
    const double e = (end.at(2).v[2] - end.at(1).v[2]) / p.speed;
    return std::fabs(e + post::impact_state(p, post::impact_duration(p)).rate / p.speed);
  };
  for (const double D : {0.2, 0.5}) {
    const double coarse = restitution_error(D, 250), fine = restitution_error(D, 2000);
    RecordProperty("restitution_error_" + number(D), number(coarse) + ", " + number(fine));
    EXPECT_LT(fine, 1e-3);
    EXPECT_LT(fine, 0.25 * coarse);
  }
}

// A drum driven onto a fixed ball, and seen in a mirror: a ball driven onto a fixed drum. Each sign of the
// law, of the effective mass with a fixed partner on either side, and of the exciter has its mirror image.
TEST_P(EitherTransition, DrumOnFixedBallMirrorsBallOnFixedDrum) {
  const auto run = [&](int fixed) {
    const double up = fixed == 1 ? 1 : -1;
    return run_balls({{"fixed", std::to_string(fixed)},
                      {"driven", std::to_string(3 - fixed)},
                      {"transition", GetParam()},
                      {"r1", "0.5"},
                      {"r2", "0.5"},
                      {fixed == 1 ? "m2" : "m1", "1500"},
                      {fixed == 1 ? "m1" : "m2", "700"},
                      {fixed == 1 ? "velocity2" : "velocity1", vector_text(0, 0, -0.4 * up)},
                      {"excitation", "amplitude 1e4 omega 5 phase 1.4 direction 0 0 " + number(-up)},
                      {"dt", "1e-5"},
                      {"steps", "6000"}});
  };
  const BallsRun drum = run(1);
  const BallsRun ball = run(2);
  EXPECT_GT(drum.events.size(), 2u);
  ASSERT_EQ(drum.events.size(), ball.events.size());
  for (std::size_t i = 0; i < drum.events.size(); ++i) {
    EXPECT_EQ(drum.events[i].make, ball.events[i].make);
    EXPECT_NEAR(drum.events[i].time, ball.events[i].time, 1e-12);
  }
  for (const auto part : {&Ball::x, &Ball::v, &Ball::f}) {
    std::vector<double> image = ball.series(1, part, 2);
    for (double &value : image)
      value = -value;
    EXPECT_LT(relative_difference(image, drum.series(2, part, 2)), 1e-12);
  }
}

TEST_P(EitherTransition, RatioAndCoefficientAreOneDamping) {
  constexpr double m1 = 500, m2 = 3000, k = 1e8, D = 0.35;
  struct Scene {
    const char *obstacle, *fixed;
    double mass; // effective mass of the contact
  };
  for (const Scene &scene : {Scene{"ball", "3", m1 * m2 / (m1 + m2)}, Scene{"ball", "1", m2},
                             Scene{"ball", "2", m1}, Scene{"plane", "3", m2}, Scene{"mesh", "3", m2}}) {
    const auto run = [&](const char *damping, const char *property, double value) {
      return run_balls({{"obstacle", scene.obstacle},
                        {"fixed", scene.fixed},
                        {"transition", GetParam()},
                        {"damping", damping},
                        {"property", property},
                        {"dashpot", number(value)},
                        {"m1", number(m1)},
                        {"m2", number(m2)},
                        {"velocity1", "0 0 0.6"},
                        {"velocity2", "0 0 -0.3"},
                        {"dt", "1e-5"},
                        {"steps", "1500"}});
    };
    const BallsRun ratio = run("ratio", "dampingRatio", D);
    const BallsRun coefficient = run("coefficient", "gamman_abs", 2 * D * std::sqrt(scene.mass * k));
    for (const auto &[id, ball] : ratio.frames.front().balls) {
      EXPECT_LT(relative_difference(coefficient.series(id, &Ball::v, 2), ratio.series(id, &Ball::v, 2)),
                1e-14)
          << scene.obstacle << ", fixed " << scene.fixed << ", ball " << id;
    }
    double change = 0;
    for (const auto &[id, ball] : ratio.frames.front().balls)
      change += std::fabs(ratio.frames.back().balls.at(id).v[2] - ball.v[2]);
    EXPECT_GT(change, 0.1) << "no contact";
  }
}

// The bond: a damped oscillator.

constexpr double bond_k = 1e6, bond_c = 8e3, stretch = 0.01;

BallsRun run_bond(const std::string &fixed, double m1, double m2, const std::string &more, double dt,
                  int steps) {
  return run_balls({{"fixed", fixed},
                    {"gap", "0.5"},
                    {"m1", number(m1)},
                    {"m2", number(m2)},
                    {"k23", number(bond_k)},
                    {"bond", number(bond_c) + " length " + number(0.5 + 0.75 + 0.5 - stretch) + more},
                    {"dt", number(dt)},
                    {"steps", std::to_string(steps)}});
}

/// Stretch at time t of a mass released at rest.
double released(double mass, double t) {
  const std::complex<double> half = bond_c / (2 * mass);
  const std::complex<double> root = std::sqrt(half * half - bond_k / mass);
  const std::complex<double> s1 = -half + root, s2 = -half - root;
  return (stretch * (s1 * std::exp(s2 * t) - s2 * std::exp(s1 * t)) / (s1 - s2)).real();
}

TEST(Bond, FollowsTheDampedOscillatorInFirstOrder) {
  constexpr double m1 = 600, m2 = 1000, time = 0.5;
  for (const std::string fixed : {"1", "2", "3"}) {
    const double mass = fixed == "1" ? m2 : fixed == "2" ? m1 : m1 * m2 / (m1 + m2);
    std::vector<double> all_steps, errors;
    for (const int steps : {500, 1000, 2000, 4000}) {
      const BallsRun run = run_bond(fixed, m1, m2, "", time / steps, steps);
      const std::vector<double> x1 = run.series(1, &Ball::x, 2), x2 = run.series(2, &Ball::x, 2);
      std::vector<double> found, exact;
      for (std::size_t n = 0; n < x1.size(); ++n) {
        found.push_back((x2[n] - x1[n]) - (x2[0] - x1[0]) + stretch);
        exact.push_back(released(mass, time / steps * static_cast<double>(n)));
      }
      all_steps.push_back(steps);
      errors.push_back(relative_difference(found, exact));
      if (fixed == "3") {
        EXPECT_LT(momentum_drift(run, m1, m2), 1e-14);
      }
    }
    RecordProperty("order_fixed_" + fixed, number(fitted_order(all_steps, errors)));
    EXPECT_NEAR(fitted_order(all_steps, errors), -1, 0.1) << "fixed: " << fixed;
    EXPECT_LT(errors.back(), 2e-3);
  }
}

class EnergyOfABond : public BothEngines {
protected:
  static constexpr double k = 1e4, m_eff = 1, e0 = 0.01, length = 0.19, volume = 0.4 * 0.3 * 0.6;

  struct Row {
    double t, e, energy, force, potential, kinetic, pressure;
  };
  static std::vector<Row> rows_of(const Variables &variables) {
    const Scratch folder;
    well(run("bond", folder, variables));
    std::ifstream in(folder / "energies.txt");
    std::vector<Row> rows;
    for (Row r{}; in >> r.t >> r.e >> r.energy >> r.force >> r.potential >> r.kinetic >> r.pressure;)
      rows.push_back(r);
    return rows;
  }
  /// The contribution of the tension to the pressure across x: the sum of x f over both balls, over the
  /// volume, Pa.
  static double pressure(double force, double e) { return -force * (length + e) / volume; }
};

// e(t) = e0 cos(w t), w^2 = k / m_eff; the rest of the energy is kinetic.
TEST_P(EnergyOfABond, IsItsScalarAndWithFixModifyPartOfThePotentialEnergy) {
  constexpr double most = 0.5 * k * e0 * e0;
  const std::vector<Row> rows = rows_of({});
  EXPECT_GE(rows.size(), 40u);
  for (const Row &row : rows) {
    const double e = e0 * std::cos(std::sqrt(k / m_eff) * row.t);
    EXPECT_NEAR(row.e, e, 1e-4 * e0) << row.t;
    EXPECT_NEAR(row.force, k * e, 1e-4 * k * e0) << row.t;
    EXPECT_NEAR(row.energy, 0.5 * k * e * e, 1e-4 * most) << row.t;
    EXPECT_NEAR(row.potential, row.energy, 1e-5 * most) << row.t;
    EXPECT_NEAR(row.potential + row.kinetic, most, 1e-4 * most) << row.t;
  }
}

// With a dashpot so heavy that under second-order stepping its force is known last, too: then it stops the
// balls within some steps.
TEST_P(EnergyOfABond, ItsTensionCountsInThePressure) {
  for (const auto &[c, least] : {std::pair{"0", 40u}, {"1e5", 4u}}) {
    const bool stiff = std::string(c) != "0";
    if (stiff && std::get<1>(GetParam()) == "stock") continue; // unstable: dt c / m_eff = 1
    std::size_t pulled = 0;
    for (const Row &row : rows_of({{"c", c}, {"every", stiff ? "1" : "100"}})) {
      const double expected = pressure(row.force, row.e);
      EXPECT_NEAR(row.pressure, expected, 1e-5 * k * e0 * length / volume) << row.t << ", c " << c;
      pulled += std::fabs(row.force) > 0.01 * k * e0 ? 1 : 0;
    }
    EXPECT_GE(pulled, least) << "c " << c;
  }
}

INSTANTIATE_TEST_SUITE_P(Decks, EnergyOfABond, engines_and_steppings(), engine_and_stepping);

TEST(Bond, BreaksOnceAtItsStrengthAndNeverPullsAgain) {
  constexpr double m1 = 600, m2 = 1000, time = 0.5,
                   strength = 8000; // released, it swings back to about -7 kN
  const BallsRun whole =
      run_bond("1", m1, m2, " strength " + number(1.01 * bond_k * stretch), time / 1000, 1000);
  EXPECT_FALSE(contains(whole.output, "broke"));
  EXPECT_NE(whole.frames.back().balls.at(2).f[2], 0);

  // Started at rest below its strength and driven beyond it.
  const BallsRun run = run_balls({{"gap", "0.5"},
                                  {"m2", number(m2)},
                                  {"k23", number(bond_k)},
                                  {"bond", number(bond_c) + " length current strength " + number(strength)},
                                  {"excitation", "amplitude 3000 omega 31.6 direction 0 0 1"},
                                  {"dt", "5e-4"},
                                  {"steps", "2000"}});
  const std::string words = "WARNING: fix bond/spring bond: the bond of balls 1 and 2 broke at step ";
  const std::size_t found = run.output.find(words);
  ASSERT_NE(found, std::string::npos) << run.output;
  EXPECT_EQ(run.output.find(words, found + 1), std::string::npos) << "it broke twice";
  const long step = std::stol(run.output.substr(found + words.size()));
  double largest = 0;
  for (const Frame &frame : run.frames) {
    const double push = 3000 * std::sin(31.6 * 5e-4 * static_cast<double>(frame.step));
    const double bond = frame.balls.at(2).f[2] - push;
    if (frame.step >= step)
      ASSERT_NEAR(bond, 0, 1e-9 * strength) << "step " << frame.step;
    else
      largest = std::max(largest, std::fabs(bond));
  }
  EXPECT_LE(largest, strength);
  EXPECT_GT(largest, 0.95 * strength);
}

/// With light damping, solved for contact by contact, and with heavy damping, solved for in a second pass.
TEST(Reaction, OfAFixedBallIsTheForceOnTheOtherBall) {
  constexpr double m2 = 500, g = 9.81;
  for (const char *fix : {"freeze", "setforce 0 0 0"})
    for (const char *dashpot : {"0.2", "5"}) {
      const BallsRun run = run_balls({{"stepping", "second"},
                                      {"held", fix},
                                      {"dashpot", dashpot},
                                      {"m2", number(m2)},
                                      {"gap", "1e-4"},
                                      {"g", number(g)},
                                      {"dt", "1e-4"},
                                      {"steps", "2000"}});
      ASSERT_EQ(run.reaction.size() + 1, run.frames.size());
      ASSERT_FALSE(run.events.empty());
      const auto made = static_cast<std::size_t>(std::ceil(run.events.front().time / 1e-4));
      double most = 0, miss = 0;
      for (std::size_t n = made + 1; n < run.frames.size(); ++n) {
        const double contact = run.frames[n].balls.at(2).f[2] + m2 * g;
        most = std::max(most, contact);
        miss = std::max(miss, std::fabs(run.reaction[n - 1] + contact));
      }
      EXPECT_GT(most, m2 * g) << fix << ", D = " << dashpot;
      EXPECT_LT(miss, 1e-10 * most) << fix << ", D = " << dashpot;
      EXPECT_NEAR(run.reaction.back(), -m2 * g, 0.01 * m2 * g) << fix << ", D = " << dashpot;
    }
}

// Velocity or law changed between two runs: the force of the set-up is that of the present ones, not that of
// the step before.
TEST(ASetUp, TakesWhatTheDeckHasChangedBetweenTwoRuns) {
  const std::string softer = property("kn", "5e6");
  const struct {
    std::string lines;
    double k, c_of_rate;
  } changes[] = {{"velocity all set 0 0 0 units box", 1e7, 0.0},
                 {"unfix kn\n" + softer, 5e6, std::sqrt(2000 * 5e6)}, // c = 2 D sqrt(m k), D = 0.5
                 {"", 1e7, std::sqrt(2000 * 1e7)}};
  for (const auto &change : changes) {
    const Scratch folder;
    const std::string lines = "run 1500\n" + change.lines +
                              "\ncompute f drum reduce sum fz\nthermo_style custom step c_f\nrun 0\n"
                              "print \"force $(c_f) overlap $(0.75-xcm(drum,z)) rate $(-vcm(drum,z))\"";
    const Outcome run = run_host(host_pair_style() + host_properties(), lines, folder.path(), 1);
    std::smatch found;
    ASSERT_TRUE(std::regex_search(run.output, found,
                                  std::regex("\nforce ([0-9.e+-]+) overlap ([0-9.e+-]+) rate ([0-9.e+-]+)")))
        << run.output;
    const double force = std::stod(found[1]), d = std::stod(found[2]), rate = std::stod(found[3]);
    const double expected = change.k * d + change.c_of_rate * rate - 2000 * 9.81;
    EXPECT_NEAR(force, expected, 1e-6 * 2000 * 9.81) << change.lines;
  }
}

} // namespace
} // namespace drumlin::test
