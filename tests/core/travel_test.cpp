/// The programme of a roller that drives: its place against the integral of its speed, and closed forms.

#include "physics/bodies/travel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace {

using namespace drumlin::physics;

Travel programme() {
  Travel t;
  t.from = -1.0;
  t.to = 2.0;
  t.speed = 1.5;
  t.ramp = 0.4;
  t.pause = 0.3;
  t.passes = 3;
  return t;
}

/// Of the page: from the start of a pass.
double speed_in_pass(const Travel &t, double since) {
  const double left = t.pass_time() - since;
  if (since < 0.0 || left < 0.0) return 0.0;
  const double u = std::fmin(1.0, std::fmin(since, left) / t.ramp);
  return t.speed * (3.0 * u * u - 2.0 * u * u * u);
}

TEST(Travel, IsTheIntegralOfItsSpeed) {
  for (const bool one_way : {false, true})
    for (const double sign : {1.0, -1.0}) {
      Travel t = programme();
      t.one_way = one_way;
      if (sign < 0.0) std::swap(t.from, t.to);
      EXPECT_NEAR(t.duration(), 3 * (3.0 / 1.5 + 0.4) + 2 * 0.3, 1e-14);
      double distance = 0.0;
      constexpr int steps = 90000;
      const double h = (t.duration() + 0.5) / steps;
      const auto velocity = [&](double time) {
        double all = 0.0;
        for (int pass = 0; pass < 3; ++pass)
          all += (one_way || pass % 2 == 0 ? sign : -sign) *
                 speed_in_pass(t, time - pass * (t.pass_time() + t.pause));
        return all;
      };
      for (int n = 0; n <= steps; ++n) {
        const double time = n * h;
        const TravelState now = travel_state(t, time);
        ASSERT_NEAR(now.velocity, velocity(time), 1e-9) << time;
        ASSERT_NEAR(now.distance, distance, 1e-9) << time;
        const double place =
            one_way ? std::fabs(now.distance) - 3.0 * (now.pass - 1) : std::fabs(now.distance);
        ASSERT_NEAR(now.place, t.from + sign * place, 1e-9) << time;
        ASSERT_EQ(now.pass, std::min(3, 1 + static_cast<int>(time / (t.pass_time() + t.pause)))) << time;
        const double slope = (velocity(time + 1e-6) - velocity(time - 1e-6)) / 2e-6;
        ASSERT_NEAR(now.acceleration, slope, 1e-4) << time;
        const TravelState next = travel_state(t, time + h);
        EXPECT_NEAR(mean_velocity(t, time, time + h, now, next) * h, next.distance - now.distance, 1e-12);
        distance += h / 6 * (velocity(time) + 4 * velocity(time + h / 2) + velocity(time + h));
      }
    }
}

TEST(Travel, TurnsAtOnceWithoutRampsAndPauses) {
  Travel t;
  t.to = 3.0;
  t.speed = 0.7;
  t.passes = 1000;
  for (int n = 0; n < 100000; ++n) {
    const double time = t.duration() * n / 100000.0; // a turn at every hundredth
    const TravelState now = travel_state(t, time);
    ASSERT_EQ(std::fabs(now.velocity), 0.7) << time;
    const double way = std::fmod(0.7 * time, 6.0);
    ASSERT_NEAR(now.place, way < 3.0 ? way : 6.0 - way, 1e-9) << time;
  }
  const TravelState last = travel_state(t, t.duration());
  EXPECT_EQ(last.velocity, -0.7) << "it drives until then";
  EXPECT_NEAR(last.place, 0.0, 1e-9);
  for (int n = 1; n <= 1000; ++n) // times that rounding moves about a turn
    for (const double ulps : {-2.0, -1.0, 0.0, 1.0, 2.0}) {
      const double turn = n * (3.0 / 0.7);
      ASSERT_EQ(std::fabs(travel_state(t, turn + ulps * 1e-16 * turn).velocity), 0.7) << n;
    }
  const TravelState end = travel_state(t, t.duration() + 1.0);
  EXPECT_EQ(end.velocity, 0.0);
  EXPECT_EQ(end.pass, 1000);
  EXPECT_EQ(end.place, 0.0);
}

TEST(Travel, StaysOnAWayThatItsRampsFill) {
  Travel t = programme();
  t.ramp = t.length() / t.speed;
  EXPECT_EQ(t.invalid(), "");
  const TravelState middle = travel_state(t, t.ramp);
  EXPECT_NEAR(middle.velocity, t.speed, 1e-12);
  EXPECT_NEAR(middle.place, 0.5, 1e-12);
  t.ramp *= 1.001;
  EXPECT_EQ(t.invalid().rfind("way is '3 m' long; allowed: more than 0, and at least 3.00", 0), 0u)
      << t.invalid();
}

// A drum of the radius 0.5 m rolls from 0 on: a ball 0.4 m from the axle, at first above it, is where the
// cycloid has it.
TEST(Travel, RollsABallOnACycloid) {
  const InPlane top{0.0, 0.4};
  for (double way = 0.0; way < 10.0; way += 0.37) {
    const double angle = way / 0.5, spin = 3.0 / 0.5;
    const InPlane place = Turn(angle)(top), v = turning_velocity(spin, place);
    EXPECT_NEAR(place.along, 0.4 * std::sin(angle), 1e-15);
    EXPECT_NEAR(place.up, 0.4 * std::cos(angle), 1e-15);
    EXPECT_NEAR(v.along, 0.4 * spin * std::cos(angle), 1e-14);
    EXPECT_NEAR(v.up, -0.4 * spin * std::sin(angle), 1e-14);
  }
}

// The mean velocity of a step leads from the place at its beginning to that at its end, however long it is.
TEST(Travel, LeadsABallOfADrumAlongTheChord) {
  const InPlane ball{0.3, -0.2};
  for (const double change : {-2.0, -1e-3, 0.0, 1e-6, 0.1, 3.0})
    for (const double begin : {0.0, 1.0, -4.0}) {
      const double time = 0.01;
      const InPlane from = Turn(begin)(ball), to = Turn(begin + change)(ball);
      const InPlane mean = turning_velocity(spin_of_chord(change, time), Turn(begin + 0.5 * change)(ball));
      EXPECT_NEAR(to.along - from.along, time * mean.along, 1e-15);
      EXPECT_NEAR(to.up - from.up, time * mean.up, 1e-15);
    }
}

} // namespace
