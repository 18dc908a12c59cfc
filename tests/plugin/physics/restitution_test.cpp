/// One impact on a fixed ball without gravity, under both transition conditions: closed form, CVODE with root
/// finding, and the core's law stepped as the engines step it.

#include "physics/contact_law.h"
#include "tests/plugin/physics/velocity_verlet.h"
#include "tests/support/ode.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

namespace {

using namespace drumlin::physics;

constexpr double pi = 3.14159265358979323846;
constexpr double mass = 2000.0, stiffness = 1e8, speed = 0.4;

/// Restitution in closed form. With b = c/2m, w0^2 = k/m, the impact is
/// d = v/w exp(-bt) sin wt, w^2 = w0^2 - b^2 (sinh for b > w0).
/// A ends at wt = pi. B ends at the first root of w0^2 d + 2b d' = 0, which is tan wt = 2bw / (2b^2 - w0^2):
/// in the second quadrant for b < w0/sqrt2, in the first for b < w0; tanh for b > w0. There cos wt = (2b^2 -
/// w0^2)/w0^2 and sin wt = 2bw/w0^2, so that d' = v exp(-bt) (cos wt - b/w sin wt) is -v exp(-bt) in all
/// three branches.
double closed_form(Transition transition, double ratio) {
  const double b = ratio; // in units of w0
  if (b < 1.0) {
    const double w = std::sqrt(1.0 - b * b);
    const double angle = transition == Transition::A ? pi : std::atan2(2.0 * b * w, 2.0 * b * b - 1.0);
    return std::exp(-b * angle / w);
  }
  if (transition == Transition::A) return 0.0;
  const double w = std::sqrt(b * b - 1.0);
  return std::exp(-b * std::atanh(2.0 * b * w / (2.0 * b * b - 1.0)) / w);
}

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
  if (impact.advance(60.0 / w0, {end}) < 0) return 0.0; // never lets go
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
  EXPECT_NEAR(by_cvode(transition, ratio), closed_form(transition, ratio), 1e-9);
}

TEST_P(Restitution, TheSteppedLawConvergesToTheClosedForm) {
  const double exact = closed_form(transition, ratio);
  for (const double w0_dt : {1e-2, 1e-3, 1e-4}) // the stock stepping is of first order
    EXPECT_NEAR(by_stepping(transition, ratio, w0_dt), exact, 0.6 * w0_dt) << "w0 dt " << w0_dt;
}

TEST_P(Restitution, ExtrapolatesToTheClosedForm) {
  // Under A the step in which the ball leaves jitters by up to one step; the mean over many step sizes
  // smooths that.
  const double exact = closed_form(transition, ratio);
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
  EXPECT_NEAR(closed_form(Transition::A, 0.2), 0.526621, 5e-7);
  EXPECT_NEAR(closed_form(Transition::A, 0.5), 0.163034, 5e-7);
  EXPECT_NEAR(closed_form(Transition::A, 0.8), 0.015165, 5e-7);
  EXPECT_NEAR(closed_form(Transition::B, 0.2), 0.571740, 5e-7);
  EXPECT_NEAR(closed_form(Transition::B, 0.5), 0.298436, 5e-7);
  EXPECT_NEAR(closed_form(Transition::B, 0.8), 0.179783, 5e-7);
  EXPECT_NEAR(closed_form(Transition::B, 2.0), 0.047769, 5e-7);
}

} // namespace
