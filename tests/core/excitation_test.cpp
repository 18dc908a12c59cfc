/// The exciter against the turning of its rotor, by CVODE, and closed forms.

#include "physics/bodies/excitation.h"
#include "tests/support/ode.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace drumlin::physics;

constexpr double pi = 3.14159265358979323846;

Excitation directed() {
  Excitation e;
  e.amplitude = 58.8e3;
  e.angular_frequency = 40.0 * pi;
  return e;
}

Excitation swept() {
  Excitation e = directed();
  e.phase = 0.3;
  e.start = 0.25;
  e.sweep_frequency = 80.0 * pi;
  e.sweep_duration = 1.5;
  return e;
}

TEST(Excitation, IsThePapersForce) { // Fe = Fw sin(w t), Eq. (1)
  for (int i = 0; i <= 50; ++i) {
    // quarter periods, where the sine is 0, 1, 0, -1
    const double expected = i % 2 == 0 ? 0.0 : (i % 4 == 1 ? 58.8e3 : -58.8e3);
    EXPECT_NEAR(excitation_force(directed(), i * 0.0125), expected, 1e-8);
  }
  EXPECT_GT(excitation_force(directed(), 1e-3), 0.0); // it begins by pushing the drum down
}

TEST(Excitation, TurnsByTheIntegralOfItsFrequency) {
  for (const double target : {80.0 * pi, 0.0, 20.0 * pi}) {
    Excitation e = swept();
    e.sweep_frequency = target;
    // The rotor, from rest at the start, with the frequency as the user describes it: straight from w to w2,
    // then w2.
    for (const double t : {0.25, 0.3, 1.0, 1.7499, 1.75, 1.7501, 2.5}) {
      oracle::Ode rotor(
          [&](double, const oracle::State &y, oracle::State &f) {
            f[0] = 1.0; // the clock
            f[1] = y[0] < 1.75 ? 40.0 * pi + (target - 40.0 * pi) * (y[0] - 0.25) / 1.5 : target;
          },
          0.25, {0.25, 0.3}, {1.0, 1.0});
      if (t > 0.25) rotor.advance(std::min(t, 1.75));
      if (t > 1.75) {
        rotor.restart(rotor.state());
        rotor.advance(t);
      }
      EXPECT_NEAR(excitation_phase(e, t), rotor.state()[1], 1e-7) << t;
    }
  }
}

TEST(Excitation, HasTheFrequencyAsTheSlopeOfItsPhase) {
  const Excitation e = swept();
  const double h = 1e-5;
  for (int i = 0; i < 400; ++i) {
    const double t = 0.0052 * i;
    const double slope = (excitation_phase(e, t + h) - excitation_phase(e, t - h)) / (2.0 * h);
    EXPECT_NEAR(excitation_frequency(e, t), slope, 1e-3) << t;
  }
  EXPECT_EQ(excitation_frequency(e, 0.25), 40.0 * pi);
  EXPECT_NEAR(excitation_frequency(e, 1.0), 60.0 * pi, 1e-12);
  EXPECT_EQ(excitation_frequency(e, 1.75), 80.0 * pi);
  EXPECT_EQ(excitation_frequency(e, 99.0), 80.0 * pi);
}

TEST(Excitation, DoesNotJumpWhereASweepStartsAndEnds) {
  for (const bool eccentric : {false, true}) {
    Excitation e = swept();
    e.eccentric = eccentric;
    e.eccentric_mass = 50.0;
    e.eccentric_radius = 0.07;
    e.phase = -pi / 2.0; // so that the amplitude itself shows
    const double h = 1e-9;
    for (const double edge : {0.25 + 2.0 * h, 1.75}) { // just after the start the force is there at once
      EXPECT_NEAR(excitation_phase(e, edge - h), excitation_phase(e, edge + h), 1e-6);
      EXPECT_NEAR(excitation_frequency(e, edge - h), excitation_frequency(e, edge + h), 1e-6);
      EXPECT_NEAR(excitation_force(e, edge - h), excitation_force(e, edge + h),
                  1e-5 * excitation_amplitude(e, edge));
    }
  }
}

TEST(Excitation, StartsAndRamps) {
  Excitation e = directed();
  e.start = 0.5;
  e.phase = pi / 2.0;
  EXPECT_EQ(excitation_amplitude(e, 0.4999), 0.0);
  EXPECT_EQ(excitation_force(e, 0.4999), 0.0);
  EXPECT_EQ(excitation_amplitude(e, 0.5), 58.8e3);
  EXPECT_NEAR(excitation_force(e, 0.5), 58.8e3, 1e-9); // the phase counts from the start
  e.ramp = 0.2;
  EXPECT_EQ(excitation_amplitude(e, 0.5), 0.0);
  EXPECT_NEAR(excitation_amplitude(e, 0.55), 14.7e3, 1e-8);
  EXPECT_NEAR(excitation_amplitude(e, 0.6), 29.4e3, 1e-8);
  EXPECT_NEAR(excitation_amplitude(e, 0.7 - 1e-12), 58.8e3, 1e-5);
  EXPECT_EQ(excitation_amplitude(e, 0.71), 58.8e3);
}

TEST(Excitation, OfAnEccentricMassIsItsCentripetalForce) {
  Excitation e = swept();
  e.eccentric = true;
  e.eccentric_mass = 50.0;
  e.eccentric_radius = 0.07;
  e.rotating = true;
  // The force on the drum is me re times the acceleration of a point on the unit circle, which does not
  // depend on how the core writes it; before the sweep and after it the point turns evenly.
  for (const double t : {2.0, 2.003, 2.5}) {
    const double h = 1e-5;
    const auto at = [&](double time) { return std::sin(excitation_phase(e, time)); };
    const double acceleration = (at(t + h) - 2.0 * at(t) + at(t - h)) / (h * h);
    EXPECT_NEAR(excitation_force(e, t), -50.0 * 0.07 * acceleration, 2.0);
  }
  const double slow = excitation_amplitude(e, 0.25), fast = excitation_amplitude(e, 1.8);
  EXPECT_NEAR(fast / slow, 4.0, 1e-12); // twice the frequency
  EXPECT_NEAR(slow, 50.0 * 0.07 * 15791.367041742974, 1e-7);
}

TEST(Excitation, RotatingKeepsItsMagnitudeAndTurnsAtItsFrequency) {
  Excitation e = directed();
  e.rotating = true;
  for (int i = 0; i < 200; ++i) {
    const double t = 7.3e-4 * i, h = 1e-4;
    const auto now = excitation_components(e, t);
    const auto later = excitation_components(e, t + h);
    EXPECT_NEAR(std::hypot(now[0], now[1]), 58.8e3, 1e-8);
    EXPECT_EQ(now[0], excitation_force(e, t));
    // From the second direction, axis x n, towards the first, n.
    const double turned = (now[1] * later[0] - now[0] * later[1]) / (58.8e3 * 58.8e3);
    EXPECT_NEAR(std::asin(turned) / h, 40.0 * pi, 1e-6);
  }
  EXPECT_NEAR(excitation_components(e, 0.0)[1], 58.8e3, 1e-9);
}

TEST(Excitation, DirectedKeepsItsDirection) {
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(excitation_components(directed(), 1e-3 * i)[1], 0.0);
    EXPECT_EQ(excitation_components(directed(), 1e-3 * i)[0], excitation_force(directed(), 1e-3 * i));
  }
}

} // namespace
