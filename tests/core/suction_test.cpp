/// Suction, a constant attraction of balls that touch: long runs and rest, under both schemes. Impacts with
/// suction, of every law, are in law_impact_test.

#include "physics/laws/hertz_contact.h"
#include "physics/laws/linear_contact.h"
#include "tests/core/velocity_verlet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace drumlin::physics;
using verlet::Scheme;

constexpr double k = 1e8, m = 2000.0;
const double w0 = std::sqrt(k / m);
double coefficient(double D) { return 2.0 * D * std::sqrt(m * k); }

/// A ball that has been at rest at an overlap, and some steps later.
template <class Law>
verlet::Ball<Law> after(const Law &law, double suction, double force, double overlap, Scheme scheme,
                        int steps) {
  verlet::Ball<Law> ball(m, -overlap, 0.0, 0.1 / w0, {{0.0, 1.0, law, suction}}, force, scheme);
  for (int n = 0; n < steps; ++n)
    ball.step();
  return ball;
}

// 300 bounces of a ball under its weight: the energy of the flight is that of the beginning.
TEST(Suction, KeepsTheEnergyOfABouncingBall) {
  const double dt = M_PI / (w0 * 100.0), weight = 9.81 * m, suction = 0.1 * std::sqrt(k * m);
  verlet::Ball<LinearLaw> ball(m, 0.001, 0.0, dt, {{0.0, 1.0, {k, 0.0, Transition::B}, suction}}, -weight);
  const double begin = weight * 0.001;
  double worst = 0.0, work = 0.0;
  int bounces = 0;
  bool apart = true;
  for (int n = 0; n < 10000000 && bounces < 300; ++n) {
    ball.step();
    const double d = std::max(0.0, -ball.x);
    worst = std::max(worst, std::fabs(0.5 * m * ball.v * ball.v + weight * ball.x + 0.5 * k * d * d -
                                      suction * d - begin));
    if (apart && d > 0.0) {
      ++bounces;
      work += begin;
    }
    apart = d == 0.0;
  }
  EXPECT_EQ(bounces, 300);
  EXPECT_LT(worst, 1e-3 * work);
}

/// A pair that sticks, after 10^6 steps: with a dashpot it has come to rest, without one it still swings
/// about the place of rest. \param place of rest, m
template <class Law>
void expect_sticking(const Law &damped, const Law &undamped, double suction, double place) {
  for (const Scheme scheme : {Scheme::second, Scheme::stock}) {
    const auto rest = after(damped, suction, 0.0, 1.5 * place, scheme, 1000000);
    EXPECT_NEAR(-rest.x, place, 1e-12 * place);
    EXPECT_NEAR(rest.v, 0.0, 1e-12 * w0 * place);
    const auto swings = after(undamped, suction, 0.0, 1.2 * place, scheme, 1000000);
    const double begin = after(undamped, suction, 0.0, 1.2 * place, scheme, 0).energy();
    EXPECT_NEAR(swings.energy(), begin, 1e-2 * (begin - rest.energy()));
  }
}

TEST(Suction, NeitherMovesNorHeatsAStickingPair) {
  const double suction = 1e5;
  for (const Transition transition : {Transition::A, Transition::B}) {
    expect_sticking<LinearLaw>({k, coefficient(0.3), transition}, {k, 0.0, transition}, suction, suction / k);
    const double hertz = 1e10; // a slope of 1.5e8 N/m at 1e-4 m
    expect_sticking<HertzLaw>({hertz, coefficient(0.3), transition}, {hertz, 0.0, transition}, suction,
                              std::pow(suction / hertz, 2.0 / 3.0));
  }
}

TEST(Suction, IsTheForceThatPullsABallOff) {
  const double suction = 1e4;
  for (const double share : {0.99, 1.01}) {
    const double place = (1.0 - share) * suction / k;
    const auto end = after(LinearLaw(k, coefficient(0.3), Transition::B), suction, share * suction,
                           std::fabs(place), Scheme::second, 20000);
    if (share < 1.0) {
      EXPECT_NEAR(-end.x, place, 1e-9 * suction / k);
    } else {
      EXPECT_GT(end.x, 100.0 * suction / k);
    }
  }
}

} // namespace
