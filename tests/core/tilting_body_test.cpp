// A body that tilts: its shares of force and moment against Newton's and Euler's laws, and its energy.
#include "physics/bodies/tilting_body.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace drumlin::physics {
namespace {

struct Ball {
  double mass;
  Vec3 x, v, f;
};

/// Balls on an axle along (0.6, 0.8, 0), tilted, each with a force of its own, that move as one body.
struct Body {
  TiltAxes axes{{0.8, -0.6, 0.0}, {0.6, 0.8, 0.0}};
  std::vector<Ball> balls;
  Vec3 speed{0.3, -0.2, 0.5};
  double rate = 0.4, tilt = 0.02;
  double mass = 0.0, centre = 0.0, inertia = 0.0;

  explicit Body(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (int n = 0; n < 7; ++n) {
      Ball ball{1.5 + number(random), scaled(3.0 + number(random), axes.axle), {}, {}};
      ball.x = sum(ball.x, number(random), axes.axis);
      ball.f = {number(random), number(random), number(random)};
      balls.push_back(ball);
      mass += ball.mass;
      centre += ball.mass * dot(ball.x, axes.axle);
    }
    centre /= mass;
    for (Ball &ball : balls) {
      const double s = dot(ball.x, axes.axle) - centre;
      inertia += ball.mass * s * s;
      ball.x = sum(ball.x, 2.0 + tilt * s, axes.rise);
      ball.v = sum(speed, rate * s, axes.rise);
    }
  }
  AxleSums sums() const {
    AxleSums all;
    for (const Ball &ball : balls)
      all.add(axes, ball.mass, ball.x, ball.v, ball.f);
    return all;
  }
};

TEST(TiltingBody, HasMassInertiaAndMotionOfItsBalls) {
  for (unsigned seed = 1; seed < 50; ++seed) {
    const Body body(seed);
    const AxleSums sums = body.sums();
    EXPECT_NEAR(dot(body.axes.rise, Vec3{0, 0, 1}), 1, 1e-15) << "axis x axle points upwards";
    EXPECT_NEAR(sums.mass(), body.mass, 1e-13);
    EXPECT_NEAR(sums.centre(), body.centre, 1e-13);
    EXPECT_NEAR(sums.inertia(), body.inertia, 1e-12);
    EXPECT_NEAR(sums.height(), 2, 1e-13);
    EXPECT_NEAR(sums.tilt(), body.tilt, 1e-12);
    EXPECT_NEAR(sums.rate(), body.rate, 1e-12);
    double kinetic = 0;
    for (const Ball &ball : body.balls)
      kinetic += 0.5 * ball.mass * dot(ball.v, ball.v);
    EXPECT_NEAR(kinetic,
                0.5 * body.mass * dot(body.speed, body.speed) + 0.5 * body.inertia * body.rate * body.rate,
                1e-12);
  }
}

// The shares have the force and the moment of the forces and do the same work. They keep the balls on a
// straight axle, whose places along it do not change relative to each other: the accelerations of all balls
// lie on the line through those of two. No other shares do.
TEST(TiltingBody, SharesOutForceAndMoment) {
  for (unsigned seed = 1; seed < 50; ++seed) {
    Body body(seed);
    const AxleSums sums = body.sums();
    Vec3 force{};
    double moment = 0, work = 0;
    for (const Ball &ball : body.balls) {
      force = sum(force, 1, ball.f);
      moment += (dot(ball.x, body.axes.axle) - body.centre) * dot(ball.f, body.axes.rise);
      work += dot(ball.f, ball.v);
    }
    EXPECT_NEAR(sums.moment(), moment, 1e-12);
    std::vector<Vec3> accelerations;
    std::vector<double> places;
    double shared_work = 0;
    for (Ball &ball : body.balls) {
      const double s = dot(ball.x, body.axes.axle);
      ball.f = sums.share(body.axes, ball.mass, s, sums.force(), sums.moment());
      accelerations.push_back(scaled(1 / ball.mass, ball.f));
      places.push_back(s);
      shared_work += dot(ball.f, ball.v);
    }
    EXPECT_NEAR(shared_work, work, 1e-12);
    const Vec3 slope = scaled(1 / (places[1] - places[0]), sum(accelerations[1], -1, accelerations[0]));
    EXPECT_NEAR(dot(slope, body.axes.axle), 0, 1e-12);
    EXPECT_NEAR(dot(slope, body.axes.axis), 0, 1e-12);
    for (std::size_t n = 2; n < places.size(); ++n) {
      const Vec3 on_line = sum(accelerations[0], places[n] - places[0], slope);
      for (std::size_t a = 0; a < 3; ++a)
        EXPECT_NEAR(accelerations[n][a], on_line[a], 1e-11);
    }
    const AxleSums again = body.sums();
    EXPECT_NEAR(again.moment(), moment, 1e-12);
    for (std::size_t a = 0; a < 3; ++a)
      EXPECT_NEAR(again.force()[a], force[a], 1e-12);
  }
}

} // namespace
} // namespace drumlin::physics
