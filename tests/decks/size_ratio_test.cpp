// Friction between balls of very different sizes, in both engines: a small ball rolls down the groove between
// two large ones and falls off; a ball stays at rest between a large and a small one.
#include "tests/support/checks.h"
#include "tests/support/engine_and_scheme.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace drumlin::test {
namespace {

class SizeRatio : public BothEngines {};
INSTANTIATE_TEST_SUITE_P(Decks, SizeRatio, engines_and_steppings(), engine_and_stepping);

constexpr double large = 5e-3, g = 9.81;

/// Angle from the top of the groove and distance from the line of the large centres, in units of that in
/// contact.
struct Place {
  double angle, distance;
};

std::vector<Place> path_in_the_groove(const std::filesystem::path &dump, double contact) {
  std::vector<Place> path;
  for (const Frame &frame : read_dump(dump)) {
    const Ball &ball = frame.balls.at(3);
    const double y = ball.x[1] - 0.15, z = ball.x[2] - 0.3;
    path.push_back({std::atan2(y, z), std::hypot(y, z) / contact});
  }
  return path;
}

/// Force towards the groove, in weights, at which the ball comes off; < 0: the ball is wedged in, and it
/// takes a pull. The weight W is carried by normal and tangential springs of both contacts, N = n W and T = t
/// W, unless friction slides, T = mu N. As the force falls to W' the springs unload by n (W - W') and t (W -
/// W'), until friction slides the other way, T = -mu N.
double force_at_the_end(double sine) {
  constexpr double kt = 2.0 / 7.0, mu = 0.5; // kt over k
  const double cosine = std::sqrt(1 - sine * sine), stiffness = 2 * (sine * sine + kt * cosine * cosine);
  const double n = sine / stiffness, t = kt * cosine / stiffness;
  return t <= mu * n ? 0.0 : 1 - 2 * mu * 0.5 / (sine + mu * cosine) / (t + mu * n);
}

/// With l the distance of the ball from the line of the large centres and R + r that of the centres, rolling
/// without slip is (1 + 0.4 (R + r)^2/l^2) l a'' = g sin a. At the angle where g cos a - v^2/l has fallen to
/// force_at_the_end() the ball comes off; friction across the groove can only make that earlier. (With the
/// normal of the end of the step in the slip velocity the ball sticks to the groove down to its bottom.)
TEST_P(SizeRatio, RollsDownTheGrooveAndFallsOff) {
  for (const double ratio : {1.0, 3.0, 20.0, 100.0}) {
    const double r = large / ratio, length = std::sqrt((large + r) * (large + r) - large * large);
    const double slowed = 1 + 0.4 * std::pow((large + r) / length, 2);
    const double leaves = std::acos((force_at_the_end(length / (large + r)) * slowed + 2) / (2 + slowed));
    const Scratch folder;
    well(run("groove", folder, {{"ratio", number(ratio)}}));
    const std::vector<Place> path = path_in_the_groove(folder / "balls.txt", length);
    double angle = 0.01745, rate = 0, farthest = 0; // velocity Verlet with 100 steps for a row
    const double dt = 3000e-6 / 100;
    const auto kick = [&] { rate += 0.5 * dt * g / (length * slowed) * std::sin(angle); };
    int rows = 0;
    for (const Place &place : path) {
      if (angle < 0.5) {
        ++rows;
        EXPECT_NEAR(place.angle, angle, 1e-3 * angle) << "ratio " << ratio << ", row " << rows;
        EXPECT_NEAR(place.distance, 1, 1e-5) << "ratio " << ratio << ", row " << rows;
      }
      if (place.distance < 1.001) farthest = std::max(farthest, std::fabs(place.angle));
      for (int n = 0; n < 100; ++n) {
        kick();
        angle += dt * rate;
        kick();
      }
    }
    EXPECT_GT(rows, 10);
    EXPECT_LT(farthest, leaves + 0.15) << "ratio " << ratio;
    EXPECT_GT(farthest, 0.5) << "ratio " << ratio;
  }
}

TEST_P(SizeRatio, StaysAtRestBetweenALargeAndASmallBall) {
  for (const double ratio : {1.0, 3.0, 20.0, 100.0}) {
    const Scratch folder;
    well(run("wedge", folder, {{"ratio", number(ratio)}}));
    const std::vector<Frame> frames = read_dump(folder / "balls.txt");
    ASSERT_EQ(frames.size(), 11u);
    const Ball &middle = frames[5].balls.at(3), &end = frames[10].balls.at(3);
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_NEAR(end.v[a], 0, 1e-9) << "ratio " << ratio;            // m/s
      EXPECT_NEAR(end.x[a], middle.x[a], 1e-12) << "ratio " << ratio; // m
      EXPECT_NEAR(end.x[a], frames[0].balls.at(3).x[a], 1e-8) << "ratio " << ratio;
      EXPECT_NEAR(end.omega[a], 0, 1e-9 / (large / ratio)) << "ratio " << ratio; // rad/s
    }
  }
}

} // namespace
} // namespace drumlin::test
