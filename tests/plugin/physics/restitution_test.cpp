/// One impact on a fixed ball without gravity, under both transition conditions: closed form, CVODE with root
/// finding, and the core's law stepped as the engines step it.

#include "physics/laws/linear_contact.h"
#include "physics/laws/restitution.h"
#include "tests/plugin/physics/velocity_verlet.h"
#include "tests/support/ode.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <tuple>

namespace {

using namespace drumlin::physics;

constexpr double mass = 2000.0, stiffness = 1e8, speed = 0.4;

double by_cvode(Transition transition, double ratio) {
  const double c = 2.0 * ratio * std::sqrt(mass * stiffness);
  oracle::Ode impact(
      [c](double, const oracle::State &y, oracle::State &f) {
        f[0] = y[1];
        f[1] = -(stiffness * y[0] + c * y[1]) / mass;
      },
      0.0, {0.0, speed}, {1e-3, speed});
  const double w0 = std::sqrt(stiffness / mass);
  impact.advance(1e-4 / w0); // away from the start, where d = 0 too
  const oracle::Event end = transition == Transition::A
                                ? oracle::Event([](double, const oracle::State &y) { return y[0]; })
                                : oracle::Event([c](double, const oracle::State &y) {
                                    return (stiffness * y[0] + c * y[1]) / stiffness;
                                  });
  if (impact.advance(60.0 / w0, {end}) < 0) return 0.0; // never ends
  return -impact.state()[1] / speed;
}

double by_stepping(Transition transition, double ratio, double w0_dt) {
  const double c = LinearContact{stiffness, ratio, Damping::ratio, transition}.damping_coefficient(mass);
  const double dt = w0_dt / std::sqrt(stiffness / mass);
  // The wall is at x = 0, the ball comes from above: d = -x.
  verlet::Balls<1> ball{{mass}, {0.0}, {-speed}};
  const auto forces = [&](double, const std::array<double, 1> &x, const std::array<double, 1> &v) {
    return std::array<double, 1>{LinearLaw(stiffness, c, transition).force(-x[0], -v[0])};
  };
  const int longest = static_cast<int>(60.0 / w0_dt);
  for (int n = 0; n < longest; ++n) {
    verlet::stock_step(ball, 0.0, dt, forces);
    if (ball.x[0] > 0.0) return ball.v[0] / speed;
  }
  return 0.0;
}

class Restitution : public testing::TestWithParam<std::tuple<Transition, double>> {
protected:
  Transition transition = std::get<0>(GetParam());
  double ratio = std::get<1>(GetParam());
};

TEST_P(Restitution, ClosedFormAndCvodeAgree) {
  EXPECT_NEAR(by_cvode(transition, ratio), restitution(transition, ratio), 1e-9);
}

TEST_P(Restitution, TheSteppedLawConvergesToTheClosedForm) {
  const double exact = restitution(transition, ratio);
  for (const double w0_dt : {1e-2, 1e-3, 1e-4}) // the stock stepping is of first order
    EXPECT_NEAR(by_stepping(transition, ratio, w0_dt), exact, 0.6 * w0_dt) << "w0 dt " << w0_dt;
}

TEST_P(Restitution, ExtrapolatesToTheClosedForm) {
  // Under A the step in which the ball leaves jitters by up to one step; the mean over many step sizes
  // smooths that.
  const double exact = restitution(transition, ratio);
  double mean = 0.0;
  const int count = 64;
  for (int i = 0; i < count; ++i) {
    const double h = 1e-3 * (1.0 + 0.003 * i);
    mean += (2.0 * by_stepping(transition, ratio, 0.5 * h) - by_stepping(transition, ratio, h)) / count;
  }
  EXPECT_NEAR(mean, exact, 2e-5);
}

INSTANTIATE_TEST_SUITE_P(, Restitution,
                         testing::Combine(testing::Values(Transition::A, Transition::B),
                                          testing::Values(0.0, 0.2, 0.5, 0.8, 2.0)),
                         [](const auto &row) {
                           return std::string(std::get<0>(row.param) == Transition::A ? "A" : "B") + "_D" +
                                  std::to_string(std::lround(10.0 * std::get<1>(row.param)));
                         });

// The values that the project's reference lists, computed there by other means.
TEST(RestitutionReference, HoldsTheListedValues) {
  EXPECT_NEAR(restitution(Transition::A, 0.2), 0.526621, 5e-7);
  EXPECT_NEAR(restitution(Transition::A, 0.5), 0.163034, 5e-7);
  EXPECT_NEAR(restitution(Transition::A, 0.8), 0.015165, 5e-7);
  EXPECT_NEAR(restitution(Transition::B, 0.2), 0.571740, 5e-7);
  EXPECT_NEAR(restitution(Transition::B, 0.5), 0.298436, 5e-7);
  EXPECT_NEAR(restitution(Transition::B, 0.8), 0.179783, 5e-7);
  EXPECT_NEAR(restitution(Transition::B, 2.0), 0.047769, 5e-7);
}

TEST(RestitutionReference, FallsWithDAndDoesNotJumpAtCriticalDamping) {
  for (const Transition transition : {Transition::A, Transition::B})
    for (int n = 0; n < 99; ++n)
      EXPECT_GT(restitution(transition, 0.01 * n), restitution(transition, 0.01 * (n + 1))) << n;
  EXPECT_NEAR(restitution(Transition::B, 1.0), restitution(Transition::B, 1.0 - 1e-6), 1e-6);
  EXPECT_NEAR(restitution(Transition::B, 1.0), restitution(Transition::B, 1.0 + 1e-6), 1e-6);
  EXPECT_NEAR(restitution(Transition::B, 1e4) * 4e8, 1.0, 1e-6); // 1 / (4 D^2)
}

TEST(RestitutionReference, GivesBackTheDampingRatio) {
  for (const Transition transition : {Transition::A, Transition::B}) {
    for (const double e : {1.0, 0.999, 0.7, 0.3, 0.05, 1e-4})
      EXPECT_NEAR(restitution(transition, damping_ratio_of_restitution(transition, e)), e, 1e-14 + 1e-12 * e)
          << e;
    EXPECT_EQ(damping_ratio_of_restitution(transition, 1.0), 0.0);
  }
}

} // namespace
