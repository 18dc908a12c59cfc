/// The Hertz law: its definitions, and whole impacts with the second-order scheme against the closed form of
/// e, which is that of the linear law with the same D, and against CVODE.

#include "physics/hertz_contact.h"
#include "physics/restitution.h"
#include "tests/plugin/physics/velocity_verlet.h"
#include "tests/support/ode.h"

#include <boost/math/special_functions/zeta.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>

namespace {

using namespace drumlin::physics;

constexpr double k = 1e8, m = 2000.0;

/// Duration, s, of an undamped impact: 2.94 d_max / v, d_max from 2/5 k d^(5/2) = m v^2 / 2.
double duration(double speed) { return 2.94 / speed * std::pow(1.25 * m * speed * speed / k, 0.4); }

HertzLaw law_of(Transition transition, double D) {
  return HertzContact{k, D, Damping::ratio, transition}.of_mass(m);
}

/// The impact of Fc = k d^(3/2) + c d^(1/4) d', written out here, by CVODE. \returns e
double by_cvode(Transition transition, double D, double speed) {
  const double c = 2.0 * D * std::sqrt(1.25 * k * m);
  const auto force = [c](const oracle::State &y) {
    const double d = std::fmax(0.0, y[0]);
    return k * std::pow(d, 1.5) + c * std::pow(d, 0.25) * y[1];
  };
  oracle::Ode impact(
      [&](double, const oracle::State &y, oracle::State &f) {
        f[0] = y[1];
        f[1] = -force(y) / m;
      },
      0.0, {0.0, speed}, {1e-3 * speed, speed});
  impact.advance(1e-3 * duration(speed)); // away from the start, where the force is 0 too
  const oracle::Event end = transition == Transition::A
                                ? oracle::Event([](double, const oracle::State &y) { return y[0]; })
                                : oracle::Event([&](double, const oracle::State &y) { return force(y) / k; });
  if (impact.advance(100.0 * duration(speed), {end}) < 0) return NAN;
  return -impact.state()[1] / speed;
}

/// Largest error of e over 50 phases of the make in its step.
double worst_error(Transition transition, double D, double speed, int steps_per_contact) {
  const double dt = duration(speed) / steps_per_contact;
  double worst = 0.0;
  for (int n = 0; n < 50; ++n) {
    const double gap = (n + 0.5) / 50.0 * dt * speed;
    verlet::SecondOrderBall<HertzLaw> ball(m, gap, -speed, dt, {{0.0, 1.0, law_of(transition, D)}});
    for (int step = 0; step < 20 * steps_per_contact && (step < 3 || ball.x <= gap); ++step)
      ball.step();
    ball.step();
    worst = std::fmax(worst, std::fabs(ball.v / speed - restitution(transition, D)));
  }
  return worst;
}

class HertzImpact : public testing::TestWithParam<std::tuple<Transition, double>> {
protected:
  Transition transition = std::get<0>(GetParam());
  double D = std::get<1>(GetParam());
};

TEST_P(HertzImpact, ClosedFormAndCvodeAgreeAtAnySpeed) {
  for (const double speed : {0.01, 1.0, 100.0})
    EXPECT_NEAR(by_cvode(transition, D, speed), restitution(transition, D), 1e-6) << speed;
}

TEST_P(HertzImpact, SchemeConvergesWithTheSquareOfTheStep) {
  const double coarse = worst_error(transition, D, 1.0, 50), fine = worst_error(transition, D, 1.0, 800);
  EXPECT_LT(coarse, 4e-4);
  EXPECT_LT(fine, 8e-7);
  EXPECT_GT(std::log(coarse / fine) / std::log(16.0), 1.9) << coarse << " " << fine;
}

TEST_P(HertzImpact, SchemeErrsAlikeAtAnySpeed) {
  for (const double speed : {0.01, 100.0})
    EXPECT_NEAR(worst_error(transition, D, speed, 50), worst_error(transition, D, 1.0, 50), 1e-9) << speed;
}

INSTANTIATE_TEST_SUITE_P(, HertzImpact,
                         testing::Values(std::tuple(Transition::A, 0.1), std::tuple(Transition::A, 0.3),
                                         std::tuple(Transition::A, 0.5), std::tuple(Transition::B, 0.1),
                                         std::tuple(Transition::B, 0.3), std::tuple(Transition::B, 0.5),
                                         std::tuple(Transition::B, 1.0), std::tuple(Transition::B, 2.0)),
                         [](const auto &row) {
                           return std::string(std::get<0>(row.param) == Transition::A ? "A" : "B") + "_D" +
                                  std::to_string(std::lround(10.0 * std::get<1>(row.param)));
                         });

TEST(HertzLaw, IsItsFormula) {
  const HertzLaw a(k, 3e5, Transition::A), b(k, 3e5, Transition::B);
  for (const double d : {1e-8, 1e-4, 1e-2})
    for (const double rate : {-1.0, 0.0, 0.3}) {
      const double force = k * std::pow(d, 1.5) + 3e5 * std::pow(d, 0.25) * rate;
      EXPECT_NEAR(a.force(d, rate), force, 1e-12 * std::fabs(force));
      EXPECT_EQ(b.force(d, rate), force > 0.0 ? a.force(d, rate) : 0.0);
      EXPECT_EQ(b.acts(d, rate), force > 0.0);
      EXPECT_TRUE(a.acts(d, rate));
    }
  for (const double d : {0.0, -1e-3}) {
    EXPECT_EQ(a.force(d, 1.0), 0.0);
    EXPECT_EQ(a.energy(d), 0.0);
    EXPECT_FALSE(a.acts(d, 1.0));
  }
}

TEST(HertzLaw, StiffnessAndEnergyBelongToTheSpring) {
  const HertzLaw law(k, 0.0, Transition::B);
  for (const double d : {1e-5, 1e-3, 1e-2}) {
    const double h = 1e-4 * d;
    const double slope = (law.spring(d + h) - law.spring(d - h)) / (2.0 * h);
    EXPECT_NEAR(law.stiffness(d), slope, 1e-7 * slope);
    EXPECT_NEAR((law.energy(d + h) - law.energy(d - h)) / (2.0 * h), law.spring(d), 1e-7 * law.spring(d));
    EXPECT_DOUBLE_EQ(law.spring_change(d, h, 1.0), law.spring(d) - law.spring(d - h));
  }
}

TEST(HertzLaw, RefusesBadParameters) {
  EXPECT_EQ((HertzContact{1e8, 0.5, Damping::ratio, Transition::A}).invalid(), "");
  EXPECT_EQ((HertzContact{-1.0, 0.5, Damping::ratio, Transition::A}).invalid(),
            "stiffness is '-1 N/m^1.5'; allowed: finite and > 0");
  EXPECT_EQ((HertzContact{1.0, -2.0, Damping::coefficient, Transition::A}).invalid(),
            "damping coefficient is '-2 N s/m^1.25'; allowed: finite and >= 0");
}

TEST(HertzLaw, FirstWeightIsThatOfTheZetaFunction) {
  // zeta(s, 2) = zeta(s) - 1; the weights make up for a sum over t^(1/4), here of 10^5 steps.
  EXPECT_NEAR(HertzLaw::first_weight(1.0), -2.0 * (boost::math::zeta(-0.25) - 1.0) - 1.0, 1e-9);
  for (const double share : {0.01, 0.2, 0.5, 0.9}) {
    const int steps = 100000;
    double sum = 0.5 * (1.0 + HertzLaw::first_weight(share)) * std::pow(share, 0.25);
    for (int n = 1; n < steps; ++n)
      sum += std::pow(n + share, 0.25);
    const double end = steps + share;
    const double integral =
        0.8 * std::pow(end, 1.25) - 0.5 * std::pow(end, 0.25) + 0.25 / 12.0 * std::pow(end, -0.75);
    EXPECT_NEAR(sum, integral, 1e-7) << share;
  }
}

} // namespace
