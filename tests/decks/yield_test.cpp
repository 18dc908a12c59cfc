// The law that yields in both engines: whole impacts against the closed form of the restitution, and how
// their heat divides into yielding and dashpots; lattices that are loaded, unloaded and loaded again.
// (laws_test has what holds for all laws: engines, ranks, restarts.)
#include "tests/support/balls_run.h"
#include "tests/support/checks.h"
#include "tests/support/element_runs.h"
#include "tests/support/engine_and_scheme.h"

#include "physics/laws/yield_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <string>
#include <tuple>
#include <vector>

namespace drumlin::test {
namespace {

constexpr double mass = 1e-4, k1 = 6e5; // kg, N/m, of oblique.scene

/// The number behind the last occurrence of a text.
double number_behind(const std::string &output, const std::string &text) {
  const std::size_t found = output.rfind(text);
  if (found == std::string::npos) throw std::runtime_error(output);
  return std::stod(output.substr(found + text.size()));
}

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
    const Variables law = {{"normal", "yield"},
                           {"parameters", lammps ? number(k1) + " " + number(ratio)
                                                 : "include " + (folder / "properties").string()},
                           {"across", "0"},
                           {"tangential", "off"},
                           {"mu", "-1"}};
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
      const Impacts found = head_on(ratio, {{"transition", transition}, {"D", number(D)}});
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
    EXPECT_LT(worst(head_on(2.0, {{"transition", transition},
                                  {"damping", "restitution"},
                                  {"property", "coefficientRestitution"},
                                  {"D", "0.4"}}),
                    0.4),
              second() ? 1e-4 : 5e-3)
        << transition;
}

INSTANTIATE_TEST_SUITE_P(Engines, YieldImpacts, engines_and_steppings(), engine_and_stepping);

// A ball that bounces on, forgets and yields anew: a primitive plane and a mesh give the same force.
TEST(YieldWalls, PlaneAndMeshAreOne) {
  for (const char *stepping : {"second", "stock"}) {
    const auto run = [stepping](const char *obstacle) {
      return run_balls({{"normal", "yield"},
                        {"ratio", "3"},
                        {"obstacle", obstacle},
                        {"stepping", stepping},
                        {"models", "tangential coulomb"},
                        {"dashpot", "0.1"},
                        {"velocity2", "0.05 0 -0.5"},
                        {"g", "9.81"},
                        {"gap", "0.0001"},
                        {"dt", "1e-4"},
                        {"steps", "4000"},
                        {"every", "10"}});
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
  const post::Table rows = run_element_test(GetParam(), "oedometer",
                                            {{"sample", "hexagonal"},
                                             {"loads", "6 7 6 6.5 6.9 7 8"},
                                             {"ratio", "1e-9"},
                                             {"k", number(kn)},
                                             {"kt", number(kt)},
                                             {"yield", number(ratio)}});
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

} // namespace
} // namespace drumlin::test
