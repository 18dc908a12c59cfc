/// Suction: a constant attraction of balls that touch, against closed forms and CVODE, under both schemes.

#include "tests/plugin/physics/velocity_verlet.h"

#include "physics/laws/hertz_contact.h"
#include "physics/laws/linear_contact.h"
#include "physics/laws/yield_contact.h"

#include "tests/support/ode.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace {

using namespace drumlin::physics;

constexpr double k = 1e8, m = 2000.0;
const double w0 = std::sqrt(k / m);
double coefficient(double D) { return 2.0 * D * std::sqrt(m * k); }

/// Overlap and its rate of a ball that meets a fixed partner at x = 0.
struct Flight {
  double d, rate;
};

template <class Law>
Flight second_order(const Law &law, double suction, double weight, const Flight &start, double dt,
                    int steps) {
  verlet::SecondOrderBall<Law> ball(m, -start.d, -start.rate, dt, {{0.0, 1.0, law, {}, suction}}, -weight);
  for (int n = 0; n < steps; ++n)
    ball.step();
  return {-ball.x, -ball.v};
}

template <class Law>
Flight stock(const Law &law, double suction, double weight, const Flight &start, double dt, int steps) {
  verlet::Balls<1> ball{{m}, {-start.d}, {-start.rate}, {-weight}};
  for (int n = 0; n < steps; ++n)
    verlet::stock_step(ball, 0.0, dt, [&](double, const auto &x, const auto &v) {
      const double d = -x[0];
      return std::array<double, 1>{(d > 0.0 ? law.force(d, -v[0]) - suction : 0.0) - weight};
    });
  return {-ball.x[0], -ball.v[0]};
}

/// The same by CVODE, which is started again where the balls touch or separate and where, under B, spring and
/// dashpot together become zero.
Flight exact(double c, bool no_tension, double suction, const Flight &start, double time) {
  enum class Phase { apart, pushed, pulled } phase = start.d > 0.0 ? Phase::pushed : Phase::apart;
  const auto push = [c](const oracle::State &y) { return k * y[0] + c * y[1]; };
  const double size = std::fabs(start.rate) / w0;
  oracle::Ode ode(
      [&](double, const oracle::State &y, oracle::State &dydt) {
        const double force = phase == Phase::apart    ? 0.0
                             : phase == Phase::pushed ? push(y) - suction
                                                      : -suction;
        dydt = {y[1], -force / m};
      },
      0.0, {start.d, start.rate}, {size, size * w0});
  const oracle::Event touch = [](double, const oracle::State &y) { return y[0]; };
  const oracle::Event balance = [&](double, const oracle::State &y) {
    return no_tension && phase != Phase::apart ? push(y) : 1.0;
  };
  while (ode.time() < time) {
    const int event = ode.advance(time, {touch, balance});
    if (event == 0)
      phase = phase != Phase::apart ? Phase::apart : Phase::pushed;
    else if (event == 1)
      phase = phase == Phase::pushed ? Phase::pulled : Phase::pushed;
    else
      break;
    ode.restart(ode.state());
  }
  return {ode.state()[0], ode.state()[1]};
}

struct Row {
  Transition transition;
  double D, suction; // over the largest force without it
};

class SuctionImpact : public testing::TestWithParam<Row> {};

/// Largest error of the rate for makes at 20 places within a time step; impact at 1 m/s, after which the ball
/// leaves or sticks.
double worst_error(const Row &row, int steps_per_contact) {
  const double c = coefficient(row.D), suction = row.suction * std::sqrt(k * m);
  const double dt = M_PI / (w0 * steps_per_contact);
  double worst = 0.0;
  for (int n = 0; n < 20; ++n) {
    const Flight start{-(n + 0.5) / 20.0 * dt, 1.0};
    const int steps = 3 * steps_per_contact;
    const Flight now = second_order(LinearLaw(k, c, row.transition), suction, 0.0, start, dt, steps);
    const Flight truth = exact(c, row.transition == Transition::B, suction, start, steps * dt);
    worst = std::max({worst, std::fabs(now.rate - truth.rate), w0 * std::fabs(now.d - truth.d)});
  }
  return worst;
}

TEST_P(SuctionImpact, ErrsWithTheSquareOfTheStep) {
  const double at_100 = worst_error(GetParam(), 100), at_400 = worst_error(GetParam(), 400);
  EXPECT_LT(at_100, 2e-3);
  EXPECT_GT(std::log(at_100 / at_400) / std::log(4.0), 1.85) << at_100 << " " << at_400;
}

INSTANTIATE_TEST_SUITE_P(, SuctionImpact,
                         testing::Values(Row{Transition::B, 0.0, 0.3}, Row{Transition::A, 0.0, 1.0},
                                         Row{Transition::B, 0.1, 0.1}, Row{Transition::B, 0.1, 0.3},
                                         Row{Transition::B, 0.3, 0.1}, Row{Transition::B, 0.3, 1.0},
                                         Row{Transition::A, 0.1, 0.1}, Row{Transition::A, 0.1, 0.3},
                                         Row{Transition::A, 0.3, 0.1}, Row{Transition::A, 0.3, 1.0},
                                         Row{Transition::B, 10.0, 0.3}),
                         [](const auto &row) {
                           return std::string(row.param.transition == Transition::A ? "A" : "B") + "D" +
                                  std::to_string(static_cast<int>(10 * row.param.D)) + "F" +
                                  std::to_string(static_cast<int>(10 * row.param.suction));
                         });

/// Kinetic energy, energy stored and heat of a ball of 1 kg, J, that has come at 1 m/s, after `steps` steps.
template <class Law>
double energy_after(const Law &law, double suction, bool stock, double dt, double onset, int steps) {
  ContactState state;
  double rate = 1.0, d = -onset * dt, force = 0.0, shift = 0.0, power = 0.0, heat = 0.0;
  for (int n = 0; n < steps; ++n) {
    const double before = rate;
    rate -= 0.5 * dt * force;
    d += dt * (rate - 0.5 * dt * shift);
    const StepMotion motion{d, rate, before, dt};
    const ContactState old = state;
    StepResult own = stock ? advance_stock(law, motion, state) : advance(law, motion, state, {1.0});
    StepResult step = own;
    if (stock)
      step.force = step.kick = own.force - (d > 0.0 ? suction : 0.0);
    else
      step = with_suction(own, suction, motion, old, false);
    if (!stock) heat += heat_of_change(law, suction, motion, old, own, step, 1.0);
    force = step.force;
    shift = step.shift;
    rate -= 0.5 * dt * step.kick;
    const double now = d > 0.0 ? (state.force - law.spring(d)) * rate : 0.0;
    heat += 0.5 * dt * (power + now);
    power = now;
  }
  return 0.5 * rate * rate + law.energy(d) - suction * std::max(0.0, d) + heat;
}

/// Largest error of that sum over the energy of the impact, for makes at 20 places within a time step.
template <class Law>
double energy_error(const Law &law, double suction, double duration, double steps) {
  double worst = 0.0;
  for (int n = 0; n < 20; ++n) {
    const double sum =
        energy_after(law, suction, false, duration / steps, (n + 0.5) / 20.0, static_cast<int>(3.3 * steps));
    worst = std::max(worst, std::fabs(2.0 * sum - 1.0));
  }
  return worst;
}

// With a dashpot, both where the ball leaves and where it sticks.
TEST(Suction, BelongsToTheEnergyBalance) {
  for (const Transition transition : {Transition::A, Transition::B})
    for (const double D : {0.05, 0.3, 0.8})
      for (const double share : {0.05, 0.3, 1.0}) {
        const auto expect_closed = [&](const auto &law, double largest_force, double duration, double most) {
          const double suction = share * largest_force;
          const double coarse = energy_error(law, suction, duration, 23.0);
          const double fine = energy_error(law, suction, duration, 92.0);
          EXPECT_LT(coarse, most) << D << ' ' << share;
          EXPECT_LT(fine, std::max(coarse / 8.0, 1e-7)) << D << ' ' << share;
        };
        expect_closed(LinearLaw(1e5, 2.0 * D * std::sqrt(1e5), transition), std::sqrt(1e5),
                      M_PI / std::sqrt(1e5), 3e-4);
        const double d = std::pow(1.25 / 1e7, 0.4); // the largest overlap
        expect_closed(HertzLaw(1e7, 2.0 * D * std::sqrt(1.25e7), transition), 1e7 * d * std::sqrt(d),
                      2.9433 * d, 4e-3); // of a ball that sticks and swings
      }
}

// Suction is conservative: without a dashpot the ball leaves as fast as it came, with both schemes.
TEST(Suction, HoldsNoBallBackWithoutADashpot) {
  for (const Transition transition : {Transition::A, Transition::B})
    for (const double speed : {0.02, 0.1, 1.0})
      for (int onset = 0; onset < 20; ++onset) {
        const double dt = M_PI / (w0 * 200.0);
        const Flight start{-(onset + 0.5) / 20.0 * dt * speed, speed};
        const LinearLaw law(k, 0.0, transition);
        const double suction = 0.3 * std::sqrt(k * m);
        const Flight end = second_order(law, suction, 0.0, start, dt, 1000);
        EXPECT_LT(end.d, 0.0) << speed << ' ' << onset;
        EXPECT_NEAR(end.rate, -speed, 2e-3 * std::max(speed, 0.1)) << speed << ' ' << onset;
        const Flight in_stock = stock(law, suction, 0.0, start, dt, 1000);
        if (speed == 1.0) {
          EXPECT_NEAR(in_stock.rate, -speed, 1e-2) << onset; // of first order: a slower one may stick
        }
      }
}

// 300 bounces of a ball under its weight: the energy of the flight is that of the beginning.
TEST(Suction, KeepsTheEnergyOfABouncingBall) {
  const double dt = M_PI / (w0 * 100.0), weight = 9.81 * m, suction = 0.1 * std::sqrt(k * m);
  verlet::SecondOrderBall<LinearLaw> ball(m, 0.001, 0.0, dt,
                                          {{0.0, 1.0, {k, 0.0, Transition::B}, {}, suction}}, -weight);
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

/// A pair that sticks: overlap and its rate after 10^6 steps, with a dashpot (it has come to rest) or without
/// (it still swings about the place of rest). \param place of rest, m
template <class Law>
void expect_sticking(const Law &damped, const Law &undamped, double suction, double place) {
  const double dt = 0.1 / w0;
  const Flight rest = second_order(damped, suction, 0.0, {1.5 * place, 0.0}, dt, 1000000);
  EXPECT_NEAR(rest.d, place, 1e-12 * place);
  EXPECT_NEAR(rest.rate, 0.0, 1e-12 * w0 * place);
  const Flight rest_of_stock = stock(damped, suction, 0.0, {1.5 * place, 0.0}, dt, 1000000);
  EXPECT_NEAR(rest_of_stock.d, place, 1e-12 * place);
  const auto energy = [&](const Flight &now) {
    return 0.5 * m * now.rate * now.rate + undamped.energy(now.d) - suction * now.d;
  };
  const Flight begin{1.2 * place, 0.0};
  for (const auto &now : {second_order(undamped, suction, 0.0, begin, dt, 1000000),
                          stock(undamped, suction, 0.0, begin, dt, 1000000)})
    EXPECT_NEAR(energy(now), energy(begin), 1e-2 * (energy(begin) - energy({place, 0.0})));
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

// After an impact with a strong dashpot the ball sticks on the line of unloading, k2 (d - d_p) = F_a.
TEST(Suction, ActsOverThePlasticOverlap) {
  const double k2 = 3.0 * k, suction = 0.5 * std::sqrt(k * m), dt = 0.02 / w0;
  YieldLaw law(k, k2, coefficient(0.5), Transition::B, 0.0);
  verlet::SecondOrderBall<YieldLaw> ball(m, 0.3 * dt, -1.0, dt, {{0.0, 1.0, law, {}, suction}});
  double largest = 0.0;
  for (int n = 0; n < 100000; ++n) {
    ball.step();
    largest = std::max(largest, -ball.x);
  }
  EXPECT_NEAR(-ball.x, largest - (k * largest - suction) / k2, 1e-9 * largest);
  EXPECT_NEAR(ball.v, 0.0, 1e-9);
}

// Without a dashpot, at 1 m/s: the ball comes to rest at the overlap d_max, with k d_max^2/2 - F_a d_max =
// m/2. Unloading gives back (k d_max)^2/(2 k2), and separation takes F_a d_max; if that is more, the ball
// sticks.
TEST(Suction, TakesItsPartOfWhatAYieldedContactGivesBack) {
  const double k2 = 3.0 * k, dt = M_PI / (w0 * 800.0);
  for (const Transition transition : {Transition::A, Transition::B})
    for (const double share : {0.0, 0.05, 0.1, 0.3}) {
      const double suction = share * std::sqrt(k * m);
      const double d_max = (suction + std::sqrt(suction * suction + k * m)) / k;
      const double back = 0.5 * k * k * d_max * d_max / k2 - suction * d_max;
      verlet::SecondOrderBall<YieldLaw> ball(m, 0.3 * dt, -1.0, dt,
                                             {{0.0, 1.0, {k, k2, 0.0, transition, 0.0}, {}, suction}});
      double largest = 0.0;
      for (int n = 0; n < 4000; ++n) {
        ball.step();
        largest = std::max(largest, -ball.x);
      }
      EXPECT_NEAR(largest, d_max, 1e-4 * d_max) << share;
      if (back > 0.0) {
        EXPECT_NEAR(ball.v, std::sqrt(2.0 * back / m), 2e-3) << share;
      } else {
        EXPECT_LT(ball.x, 0.0) << share;
      }
    }
}

TEST(Suction, IsTheForceThatPullsABallOff) {
  const double suction = 1e4, dt = 0.1 / w0;
  for (const double share : {0.99, 1.01}) {
    const double place = (1.0 - share) * suction / k;
    const Flight end = second_order(LinearLaw(k, coefficient(0.3), Transition::B), suction, -share * suction,
                                    {std::fabs(place), 0.0}, dt, 20000);
    if (share < 1.0) {
      EXPECT_NEAR(end.d, place, 1e-9 * suction / k);
    } else {
      EXPECT_LT(end.d, -100.0 * suction / k);
    }
  }
}

} // namespace
