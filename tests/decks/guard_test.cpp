// fix guard in the engine: the critical time step of scenes whose limit is known in closed form, and the runs
// that it stops.
#include "tests/support/engine_runs.h"

namespace drumlin::test {
namespace {

constexpr double k = 1e8, m1 = 500, m2 = 2000;
/// Mass that limits the time step at the lighter ball of a free pair: 1/m1 + 1/sqrt(m1 m2), see
/// physics::link_burden().
constexpr double m_limit = 1 / (1 / m1 + 1 / 1000.0);

struct GuardValues {
  double critical, steps_per_contact, overlap;
};

/// The values that fix guard gives for a scene of balls.in in its last step.
GuardValues guard_values(Variables variables, const std::string &words = "step 1e9") {
  for (const auto &[name, value] : given("guard {}, steps 2, dt 1e-6, gap -0.003", words))
    variables.emplace_back(name, value);
  const BallsRun run = run_balls(variables);
  std::smatch found;
  const std::regex line("critical step ([0-9.e+-]+) s, pi/\\(w0 dt\\) ([0-9.e+-]+), overlap ([0-9.e+-]+)");
  std::string values; // the engine echoes the command before it prints
  for (std::sregex_iterator at(run.output.begin(), run.output.end(), line), end; at != end; ++at)
    values = (found = *at).str();
  if (values.empty()) throw std::runtime_error(run.output);
  return {std::stod(found[1]), std::stod(found[2]), std::stod(found[3])};
}

Variables on(const char *obstacle, const char *stepping, double D) {
  return given("obstacle {}, stepping {}, dashpot {}", obstacle, stepping, D);
}

/// Root of k dt^2/4 + c dt/2 = m.
double root(double stiffness, double damping, double mass) {
  return (std::sqrt(damping * damping + 4 * stiffness * mass) - damping) / stiffness;
}

TEST(GuardCriticalStep, OfOneContactIsTheClosedForm) {
  const double w0 = std::sqrt(k / m2);
  for (const char *obstacle : {"ball", "plane", "mesh"})
    for (const double D : {0.0, 0.5, 10.0}) {
      const GuardValues second = guard_values(on(obstacle, "second", D));
      EXPECT_NEAR(second.critical, 2 / w0, 1e-5 * second.critical) << obstacle << ", D = " << D;
      EXPECT_NEAR(second.steps_per_contact, pi / (w0 * 1e-6), 1e-5 * second.steps_per_contact);
      EXPECT_NEAR(second.overlap, 0.003 / (std::string(obstacle) == "ball" ? 0.5 : 0.75),
                  1e-3 * second.overlap);
      const double stock = 2 / w0 * (std::sqrt(1 + D * D) - D);
      EXPECT_NEAR(guard_values(on(obstacle, "stock", D)).critical, stock, 1e-4 * stock)
          << obstacle << ", D = " << D;
    }
}

TEST(GuardCriticalStep, OfContactsAtRightAnglesIsThatOfEach) {
  const double w0 = std::sqrt(k / m2);
  EXPECT_NEAR(guard_values(on("corner", "second", 0.5)).critical, 2 / w0, 1e-5 / w0);
}

TEST(GuardCriticalStep, SumsBondAndContactOfAFreePair) {
  Variables pair = on("ball", "stock", 0.0);
  for (const auto &[name, value] : given("fixed 3, m1 {}, k23 2e7, bond 3e5 length current", m1))
    pair.emplace_back(name, value);
  const double stock = root(k + 2e7, 3e5, m_limit);
  EXPECT_NEAR(guard_values(pair).critical, stock, 1e-5 * stock);
}

TEST(GuardCriticalStep, IncludesFrictionAndRolling) {
  Variables pair = on("ball", "second", 0.5);
  for (const auto &[name, value] : given("fixed 3, m1 {}, kt 1e8, ct 1e5, mu 0.5", m1))
    pair.emplace_back(name, value);
  // A sphere's tangential mass is 2/7 of its own.
  const Variables sliding = with(pair, {{"models", "tangential history"}});
  const double slides = root(1e8, 1e5, m_limit * 2 / 7);
  EXPECT_NEAR(guard_values(sliding).critical, slides, 1e-5 * slides);
  // kr = kt r_eff^2 in the rotation of both balls, I = 0.4 m r^2, in addition to the shear spring.
  const Variables rolling = with(pair, given("mu_r 0.1, models tangential history rolling_friction epsd2"));
  const double r_eff = 0.5 * 0.75 / 1.25;
  const double kr = 1e8 * r_eff * r_eff / 0.4 * (1 / (m1 * 0.25) + 1 / std::sqrt(m1 * 0.25 * m2 * 0.5625));
  const double rolls = root(1e8 * 3.5 / m_limit + kr, 1e5 * 3.5 / m_limit, 1);
  EXPECT_NEAR(guard_values(rolling).critical, rolls, 1e-5 * rolls);
}

TEST(GuardStops, BeyondTheGivenShareOfTheCriticalStep) {
  const double critical = 2 / std::sqrt(k / m2);
  for (const double share : {0.25, 1.0}) {
    const auto run = [&](double dt) {
      Variables variables = on("plane", "second", 0.5);
      for (const auto &[name, value] :
           given("guard {}, dt {}, gap -0.003, steps 2", "step " + number(share), dt))
        variables.emplace_back(name, value);
      return run_balls(variables);
    };
    EXPECT_NO_THROW(run(0.999 * share * critical));
    EXPECT_TRUE(contains(error_of([&] { run(1.001 * share * critical); }),
                         "at step 0, where ball 1 has the critical step 0.008944 s"));
  }
}

// There is no contact at set-up: the run stops at a later check.
TEST(GuardStops, WhenTheContactIsMade) {
  Variables variables = on("plane", "second", 0.5);
  for (const auto &[name, value] : given("guard step 0.001, velocity2 0 0 -0.5, gap 1.05e-4, steps 100"))
    variables.emplace_back(name, value);
  EXPECT_TRUE(contains(error_of([&] { run_balls(variables); }),
                       {"no contact and no bond yet",
                        "at step 21, where ball 1 has the critical step 0.008944 s (mostly because of the "
                        "link of ball 1 and a wall)"}));
}

} // namespace
} // namespace drumlin::test
