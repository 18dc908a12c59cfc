// Makes and breaks located within a step, against exact free flight. Those of impacts, of every law, are in
// law_impact_test.

#include "physics/scheme/event_location.h"
#include "physics/laws/linear_contact.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace drumlin::physics;

constexpr double k = 1e8;
constexpr double m = 2000.0;
double damping(double D) { return 2.0 * D * std::sqrt(m * k); }

TEST(EventLocation, MakeOutOfFreeFlightIsExact) {
  // d(t) = d0 + v t + g t^2 / 2 through zero, upwards, at any place of the step and also with an approach
  // that slows down.
  for (const double g : {9.81, -9.81, 0.0})
    for (const double share : {0.0, 1e-9, 0.1, 0.5, 0.999}) {
      const double dt = 1e-3;
      const double s = share * dt;
      const double rate = 0.7; // at the event
      const auto at = [&](double t) { return OverlapState{rate * t + 0.5 * g * t * t, rate + g * t}; };
      const OverlapState before = at(-s);
      const auto event = locate_transition(LinearLaw(k, damping(0.5), Transition::B), dt, before, at(dt - s));
      ASSERT_TRUE(event.has_value());
      EXPECT_TRUE(event->make);
      EXPECT_NEAR(event->since, s, 1e-12 * dt + 1e-16);
      EXPECT_NEAR(event->rate, rate, 1e-9);
      EXPECT_EQ(event->overlap, 0.0);
      EXPECT_NEAR(event->force, damping(0.5) * rate, 1e-3);
    }
}

TEST(EventLocation, ABallThatTurnsRoundIntoContactIsFound) {
  // It moves away from the other, is pulled back and meets it within the same step.
  const double dt = 1.0;
  const auto at = [](double t) { return OverlapState{-1.0 - t + 4.0 * t * t, -1.0 + 8.0 * t}; };
  const auto event = locate_transition(LinearLaw(k, 0.0, Transition::A), dt, at(0.0), at(dt));
  ASSERT_TRUE(event.has_value());
  EXPECT_NEAR(event->since, (1.0 + std::sqrt(17.0)) / 8.0, 1e-12);
}

TEST(EventLocation, RemakeUnderBHappensWithOverlap) {
  // k d + c d' crosses zero upwards while d > 0: the clamp lets go without a gap.
  const double c = damping(0.5);
  const double dt = 1e-5;
  const OverlapState before{1e-3, -k * 1e-3 / c - 0.01};
  const OverlapState after{1e-3 - 1e-5 * 0.2, -k * 1e-3 / c + 0.02};
  const auto event = locate_transition(LinearLaw(k, c, Transition::B), dt, before, after);
  ASSERT_TRUE(event.has_value());
  EXPECT_TRUE(event->make);
  EXPECT_GT(event->overlap, 0.0);
  EXPECT_EQ(event->force, 0.0);
  EXPECT_FALSE(locate_transition(LinearLaw(k, c, Transition::A), dt, before, after).has_value());
}

TEST(EventLocation, NothingHappensWithinAContactOrAFlight) {
  const double c = damping(0.5);
  EXPECT_FALSE(
      locate_transition(LinearLaw(k, c, Transition::B), 1e-5, {1e-3, 0.1}, {1.001e-3, 0.1}).has_value());
  EXPECT_FALSE(
      locate_transition(LinearLaw(k, c, Transition::B), 1e-5, {-1e-3, 0.1}, {-0.999e-3, 0.1}).has_value());
}

} // namespace
