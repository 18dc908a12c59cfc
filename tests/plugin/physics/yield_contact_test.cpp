/// The law that yields: its definitions, loop and heat; whole impacts with the second-order scheme and the
/// engines' own against the closed form of e and CVODE; a ball that hammers on a partner, with contacts that
/// open in every cycle, against CVODE.

#include "physics/laws/linear_contact.h"
#include "physics/laws/yield_contact.h"
#include "tests/plugin/physics/velocity_verlet.h"
#include "tests/support/ode.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

namespace {

using namespace drumlin::physics;

constexpr double k1 = 1e7, m = 2.0, pi = 3.14159265358979323846;

YieldContact contact_of(Transition transition, double D, double ratio) {
  return {k1, ratio, D, Damping::ratio, transition, 0.0};
}

TEST(YieldLaw, IsItsFormula) {
  const double k2 = 3e7, c = 1e3, largest = 1e-3, plastic = largest * 2.0 / 3.0;
  const YieldLaw a(k1, k2, c, Transition::A, largest), b(k1, k2, c, Transition::B, largest);
  for (const double rate : {-1.0, 0.0, 0.3})
    for (const double d : {1e-5, 0.5 * plastic, 0.99 * plastic, 8e-4, 1e-3, 1.2e-3}) {
      const double spring = d >= largest ? k1 * d : d > plastic ? k2 * (d - plastic) : 0.0;
      EXPECT_NEAR(a.force(d, rate), spring + c * rate, 1e-12 * k1 * d) << d; // also below the plastic overlap
      EXPECT_EQ(b.force(d, rate), std::max(0.0, a.force(d, rate)));
      EXPECT_NEAR(a.energy(d), 0.5 * spring * spring / k2, 1e-12 * k1 * d * d);
      EXPECT_EQ(a.stiffest(d), k2);
      EXPECT_EQ(a.slope(d), d >= largest ? k1 : d > plastic ? k2 : 0.0);
    }
  EXPECT_EQ(a.force(0.0, -1.0), 0.0);
  EXPECT_TRUE(std::isnan(a.force(std::numeric_limits<double>::quiet_NaN(), 0.0)));
}

TEST(YieldLaw, IsTheLinearLawWhereUnloadingIsNotStiffer) {
  const YieldContact yields{k1, 1.0, 0.3, Damping::ratio, Transition::B, 0.0};
  const LinearContact linear{k1, 0.3, Damping::ratio, Transition::B};
  for (const double largest : {0.0, 1e-3})
    for (const double d : {1e-5, 5e-4, 1e-3, 2e-3})
      for (const double rate : {-0.4, 0.7}) {
        const YieldLaw law = yields.law(m, 0.0, largest);
        EXPECT_NEAR(law.force(d, rate), linear.law(m).force(d, rate), 1e-12 * k1 * d);
        EXPECT_NEAR(law.power(d, rate).dissipated, linear.law(m).power(d, rate).dissipated, 1e-10 * k1 * d);
      }
}

// At the overlap at the end of a step, remember() changes no bit of the force.
TEST(YieldLaw, HasTheSameBitsWithWhatItRemembersAtTheEndOfItsStep) {
  for (const double largest : {0.0, 3e-4, 1e-3, 2e-3})
    for (const double d : {1e-5, 7.1e-4, 1e-3, 1.3e-3}) {
      const YieldLaw before(1e7, 3e7, 1e3, Transition::A, largest);
      YieldLaw after = before;
      for (int n = 0; n < 2; ++n) { // a set-up computes a step again
        after.remember(d);
        EXPECT_EQ(after.memory(), std::max(largest, d));
        EXPECT_EQ(after.force(d, 0.3), before.force(d, 0.3));
        EXPECT_EQ(after.energy(d), before.energy(d));
        EXPECT_EQ(after.power(d, 0.3).stored, before.power(d, 0.3).stored);
        EXPECT_EQ(after.yielded(d), before.yielded(d));
      }
    }
}

// Along any path the work is the stored energy and the heat; without a dashpot all heat is that of yielding.
TEST(YieldLaw, StoresThePartOfItsWorkThatItGivesBack) {
  YieldLaw law(1e7, 3e7, 0.0, Transition::B, 0.0);
  double work = 0.0, heat = 0.0, before = 0.0;
  constexpr int steps = 400000;
  constexpr double dt = 1.0 / steps;
  for (int n = 1; n <= steps; ++n) {
    const double t = n * dt, d = 1e-3 * (std::sin(11.0 * t) + 1.2 * t), rate = (d - before) / dt;
    const double middle = 0.5 * (d + before);
    if (middle > 0.0) {
      const ContactPower power = law.power(middle, rate);
      EXPECT_GE(power.dissipated, 0.0);
      work += dt * law.force(middle, rate) * rate;
      heat += dt * power.dissipated;
    }
    law.remember(d);
    before = d;
  }
  EXPECT_GT(heat, 1.0);
  EXPECT_NEAR(work, law.energy(before) + heat, 1e-5 * work); // of first order in dt in steps across a kink
  EXPECT_NEAR(heat, law.yielded(before), 1e-5 * work);
}

/// Moves the overlap and returns the work on the spring, J, by the midpoint rule.
double work_of(YieldLaw &law, double from, double to) {
  constexpr int steps = 30000;
  const double change = (to - from) / steps;
  double work = 0.0;
  for (int n = 0; n < steps; ++n) {
    work += law.spring(from + (n + 0.5) * change) * change;
    law.remember(from + (n + 1) * change);
  }
  return work;
}

// A cycle from 0 to the overlap d_max and back turns (1 - k1/k2) k1 d_max^2 / 2 into heat. The same cycle
// again turns none, and a cycle to a larger overlap the difference. The plastic overlap is (1 - k1/k2) d_max.
TEST(YieldLaw, LoopHasTheHeatAndThePlasticOverlapOfTheClosedForms) {
  for (const double ratio : {1.5, 4.0, 20.0}) {
    YieldLaw law = contact_of(Transition::B, 0.0, ratio).law(m, 0.0, 0.0);
    const double q = 1.0 / ratio, d_max = 1e-3, loop = 0.5 * (1.0 - q) * k1 * d_max * d_max,
                 size = 0.5 * k1 * d_max * d_max;
    const double there = work_of(law, 0.0, d_max);
    EXPECT_NEAR(there, size, 1e-7 * size);
    EXPECT_NEAR(law.energy(d_max), q * size, 1e-12 * size);
    EXPECT_NEAR(-work_of(law, d_max, 0.0), law.energy(d_max), 1e-7 * size) << "what unloading gives back";
    EXPECT_NEAR(law.yielded(0.5 * d_max), loop, 1e-12 * size);
    EXPECT_NEAR(work_of(law, 0.0, d_max) + work_of(law, d_max, 0.0), 0.0, 1e-7 * size);
    EXPECT_NEAR(work_of(law, 0.0, 2.0 * d_max) + work_of(law, 2.0 * d_max, 0.0), 3.0 * loop, 1e-6 * size);
    const double plastic = (1.0 - q) * 2.0 * d_max;
    EXPECT_EQ(law.spring(0.999999 * plastic), 0.0);
    EXPECT_GT(law.spring(1.000001 * plastic), 0.0);
  }
}

/// An impact by CVODE, from its differential equations: k1 until the balls are at rest, then k2, and under A
/// the dashpot alone below the plastic overlap. \returns e
double by_cvode(Transition transition, double D, double ratio, double speed) {
  const double k2 = ratio * k1, c = 2.0 * D * std::sqrt(m * k2), time = pi * std::sqrt(m / k1);
  double k = k1, free = 0.0; // the spring is k (d - free)
  oracle::Ode impact(
      [&](double, const oracle::State &y, oracle::State &f) {
        f[0] = y[1];
        f[1] = -(k * (y[0] - free) + c * y[1]) / m;
      },
      0.0, {0.0, speed}, {speed * std::sqrt(m / k1), speed});
  impact.advance(1e4 * time, {[](double, const oracle::State &y) { return y[1]; }});
  const double largest = impact.state()[0];
  k = k2;
  free = (1.0 - 1.0 / ratio) * largest;
  impact.restart(impact.state());
  const oracle::Event end =
      transition == Transition::A
          ? oracle::Event([&](double, const oracle::State &y) { return y[0] - free; })
          : oracle::Event([&](double, const oracle::State &y) { return k2 * (y[0] - free) + c * y[1]; });
  if (impact.advance(1e4 * time, {end}) < 0) return 0.0;
  if (transition == Transition::B || free == 0.0) return -impact.state()[1] / speed;
  k = 0.0;
  impact.restart(impact.state());
  if (impact.advance(20.0 * time, {[](double, const oracle::State &y) { return y[0]; }}) < 0) return 0.0;
  return -impact.state()[1] / speed;
}

using Case = std::tuple<Transition, double, double>;

std::string name_of(const testing::TestParamInfo<Case> &row) {
  const auto &[transition, D, ratio] = row.param;
  return std::string(transition == Transition::A ? "A" : "B") + "_D" +
         std::to_string(std::lround(100.0 * D)) + "_ratio" + std::to_string(std::lround(10.0 * ratio));
}

class YieldImpact : public testing::TestWithParam<Case> {
protected:
  Transition transition = std::get<0>(GetParam());
  double D = std::get<1>(GetParam()), ratio = std::get<2>(GetParam());
  double exact = restitution_of_yield(transition, D, ratio);

  /// Largest error of e over 40 phases of the make in its step, with `stepping second`.
  double worst_error(int steps) const {
    const double dt = pi * std::sqrt(m / k1) / steps;
    double worst = 0.0;
    for (int n = 0; n < 40; ++n) {
      const double gap = (n + 0.5) / 40.0 * dt;
      verlet::SecondOrderBall<YieldLaw> ball(m, gap, -1.0, dt,
                                             {{0.0, 1.0, contact_of(transition, D, ratio).law(m, 0.0, 0.0)}});
      for (int step = 0; step < 20 * steps && (step < 3 || ball.x <= gap); ++step)
        ball.step();
      ball.step();
      worst = std::fmax(worst, std::fabs(ball.v - exact));
    }
    return worst;
  }
};

TEST_P(YieldImpact, ClosedFormAndCvodeAgreeAtAnySpeed) {
  if (D == 0.0) {
    EXPECT_NEAR(exact, 1.0 / std::sqrt(ratio), 1e-14);
  }
  for (const double speed : {0.01, 1.0, 30.0})
    EXPECT_NEAR(by_cvode(transition, D, ratio, speed), exact, 2e-7) << speed;
}

TEST_P(YieldImpact, SchemeConvergesWithTheSquareOfTheStep) {
  const double coarse = worst_error(100), fine = worst_error(1600);
  EXPECT_LT(coarse, 5e-3);
  EXPECT_LT(fine, 2e-5);
  RecordProperty("errors", std::to_string(coarse) + ", " + std::to_string(fine));
  EXPECT_GT(std::log(coarse / fine) / std::log(16.0), 1.8) << coarse << " " << fine;
}

INSTANTIATE_TEST_SUITE_P(, YieldImpact,
                         testing::Values(Case{Transition::A, 0.0, 1.5}, Case{Transition::A, 0.0, 4.0},
                                         Case{Transition::A, 0.05, 1.5}, Case{Transition::A, 0.05, 4.0},
                                         Case{Transition::A, 0.3, 1.5}, Case{Transition::B, 0.0, 1.5},
                                         Case{Transition::B, 0.0, 4.0}, Case{Transition::B, 0.05, 4.0},
                                         Case{Transition::B, 0.3, 1.0}, Case{Transition::B, 0.3, 1.5},
                                         Case{Transition::B, 0.3, 4.0}, Case{Transition::B, 1.0, 3.0},
                                         Case{Transition::B, 2.0, 3.0}),
                         name_of);

// Under A a strong dashpot stops the ball before the overlap is zero: the speed falls exponentially, and the
// closed form gives e = 0.
TEST(YieldRestitution, IsNoneWhereADashpotStopsTheBallInsideThePlasticOverlap) {
  EXPECT_EQ(restitution_of_yield(Transition::A, 0.3, 4.0), 0.0);
  EXPECT_EQ(by_cvode(Transition::A, 0.3, 4.0, 1.0), 0.0);
  EXPECT_EQ(restitution_of_yield(Transition::A, 1.0, 1.0), 0.0);
}

TEST(YieldRestitution, IsThatOfTheLinearLawWhereUnloadingIsNotStiffer) {
  for (const Transition transition : {Transition::A, Transition::B})
    for (const double D : {0.0, 0.1, 0.7, 1.0, 3.0})
      EXPECT_NEAR(restitution_of_yield(transition, D, 1.0), restitution(transition, D), 1e-12) << D;
}

TEST(YieldRestitution, GivesTheDampingThatHasIt) {
  for (const Transition transition : {Transition::A, Transition::B})
    for (const double ratio : {1.0, 2.0, 9.0})
      for (const double share : {0.05, 0.4, 0.9, 1.0}) {
        YieldContact contact{k1, ratio, 0.0, Damping::ratio, transition, 0.0};
        const double e = share * contact.largest_restitution();
        contact.set_restitution(e);
        EXPECT_NEAR(restitution_of_yield(transition, contact.damping, ratio), e, 1e-12) << ratio << ' ' << e;
      }
}

// A ball under a weight and a force that changes as a sine hammers on a partner: the contact opens in every
// cycle, forgets, and yields anew.
namespace hammer {

constexpr double weight = 20.0, amplitude = 60.0, frequency = 2.0 * pi * 40.0;
double force(double t) { return -weight - amplitude * std::sin(frequency * t); }

struct End {
  double x, v, heat; ///< m, m/s; J, of yielding
  int makes;
};

End by_cvode(double D, double ratio, double end) {
  constexpr double k = 1e5;
  const double k2 = ratio * k, c = 2.0 * D * std::sqrt(m * k2);
  enum { apart, loading, elastic, loose } mode = apart;
  double largest = 0.0, heat = 0.0;
  const auto plastic = [&] { return (1.0 - 1.0 / ratio) * largest; };
  const auto push = [&](const oracle::State &y) {
    const double d = -y[0], rate = -y[1];
    return mode == loading   ? k * d + c * rate
           : mode == elastic ? std::fmax(0.0, k2 * (d - plastic()) + c * rate)
           : mode == loose   ? std::fmax(0.0, c * rate)
                             : 0.0;
  };
  oracle::Ode ball(
      [&](double t, const oracle::State &y, oracle::State &f) {
        f[0] = y[1];
        f[1] = (force(t) + push(y)) / m;
      },
      0.0, {1e-4, 0.0}, {1e-4, 0.1});
  const std::vector<oracle::Event> events{
      [](double, const oracle::State &y) { return y[0]; },
      [](double, const oracle::State &y) { return y[1]; },
      [&](double, const oracle::State &y) { return -y[0] - largest; },
      [&](double, const oracle::State &y) { return -y[0] - plastic(); },
      [&](double, const oracle::State &y) { return k2 * (-y[0] - plastic()) - c * y[1]; }};
  int makes = 0;
  while (ball.time() < end) {
    if (ball.advance(end, events) < 0) break;
    const double d = -ball.state()[0], rate = -ball.state()[1], tiny = 1e-9;
    if (mode == apart) {
      if (std::fabs(d) < tiny && rate > 0.0) {
        mode = loading;
        largest = 0.0;
        ++makes;
      }
    } else if (std::fabs(d) < tiny && rate < 0.0) {
      mode = apart;
    } else if (mode == loading) {
      if (std::fabs(rate) < 1e-7) {
        largest = d;
        mode = elastic;
        heat += 0.5 * k * (1.0 - 1.0 / ratio) * d * d;
      }
    } else if (std::fabs(d - largest) < tiny && rate > 1e-7) {
      heat -= 0.5 * k * (1.0 - 1.0 / ratio) * largest * largest;
      mode = loading;
    } else if (std::fabs(d - plastic()) < tiny) {
      mode = rate > 0.0 ? elastic : loose;
    }
    ball.restart(ball.state());
  }
  return {ball.state()[0], ball.state()[1], heat, makes};
}

End by_scheme(double D, double ratio, double end, int steps) {
  const double dt = end / steps;
  const YieldLaw fresh = YieldContact{1e5, ratio, D, Damping::ratio, Transition::B, 0.0}.law(m, 0.0, 0.0);
  verlet::SecondOrderBall<YieldLaw> ball(m, 1e-4, 0.0, dt, {{0.0, 1.0, fresh}}, force(0.0));
  YieldLaw law = fresh;
  double heat = 0.0;
  int makes = 0;
  for (int n = 1; n <= steps; ++n) {
    const bool was = ball.x < 0.0;
    ball.constant = force(n * dt);
    ball.step();
    makes += !was && ball.x < 0.0 ? 1 : 0;
    const double before = law.yielded(0.0);
    if (ball.x < 0.0) {
      law.remember(-ball.x);
      heat += law.yielded(0.0) - before;
    } else
      law = fresh;
  }
  return {ball.x, ball.v, heat, makes};
}

} // namespace hammer

TEST(YieldHammer, FollowsCvodeWithSecondOrderWithAndWithoutDashpot) {
  for (const double D : {0.0, 0.1, 0.3}) {
    constexpr double end = 0.4;
    const hammer::End exact = hammer::by_cvode(D, 3.0, end);
    EXPECT_GE(exact.makes, 4) << "the contact opens and yields anew";
    EXPECT_GT(exact.heat, 1e-3);
    const auto errors = [&](int steps) {
      const hammer::End found = hammer::by_scheme(D, 3.0, end, steps);
      EXPECT_EQ(found.makes, exact.makes);
      return std::array<double, 3>{std::fabs(found.x - exact.x), std::fabs(found.v - exact.v),
                                   std::fabs(found.heat - exact.heat)};
    };
    // Means over steps of nearly one length: the error of one run depends on where makes are in their steps.
    std::array<double, 3> coarse{}, fine{};
    constexpr int runs = 40;
    for (int n = 0; n < runs; ++n) {
      const std::array<double, 3> large = errors(4000 + 13 * n), small = errors(64000 + 208 * n);
      for (std::size_t a = 0; a < 3; ++a) {
        coarse[a] += large[a] / runs;
        fine[a] += small[a] / runs;
      }
    }
    EXPECT_LT(fine[0], 2e-7) << D; // m
    EXPECT_LT(fine[2], 1e-5 * exact.heat) << D;
    for (std::size_t a = 0; a < 3; ++a)
      EXPECT_GT(std::log(coarse[a] / fine[a]) / std::log(16.0), 1.85)
          << "D " << D << ", quantity " << a << ": " << coarse[a] << " " << fine[a];
  }
}

// A ball that stands on a contact that has yielded, under a force that changes, neither sinks nor gains.
TEST(YieldRest, NeitherCreepsNorGainsEnergyInAMillionSteps) {
  const YieldLaw law = contact_of(Transition::B, 0.0, 3.0).law(m, 0.0, 0.0);
  const double w = std::sqrt(3.0 * k1 / m), dt = 0.1 / w, weight = 20.0, deep = weight / k1;
  verlet::SecondOrderBall<YieldLaw> ball(m, 0.0, 0.0, dt, {{0.0, 1.0, law}}, -weight);
  for (int n = 0; n < 1000; ++n) // it falls to twice that and then vibrates along k2
    ball.step();
  double lowest = 0.0, highest = -1.0, early_lowest = 0.0, early_highest = -1.0;
  for (int n = 0; n < 1000000; ++n) {
    ball.step();
    lowest = std::fmin(lowest, ball.x);
    highest = std::fmax(highest, ball.x);
    if (n > 1000) continue;
    early_lowest = std::fmin(early_lowest, ball.x);
    early_highest = std::fmax(early_highest, ball.x);
  }
  EXPECT_NEAR(lowest, early_lowest, 5e-3 * deep);
  EXPECT_NEAR(highest, early_highest, 5e-3 * deep);
}

} // namespace
