/// The Hertz law: its definitions, and whole impacts with the second-order scheme against the closed form of
/// e, which is that of the linear law with the same D, and against CVODE; oblique ones against CVODE; its
/// tangential and its rolling spring, whose stiffness follows the overlap.

#include "physics/scheme/event_location.h"
#include "physics/laws/friction_law.h"
#include "physics/laws/hertz_contact.h"
#include "physics/laws/linear_contact.h"
#include "physics/laws/restitution.h"
#include "physics/laws/rolling_law.h"
#include "tests/plugin/physics/contact_friction.h"
#include "tests/plugin/physics/velocity_verlet.h"
#include "tests/support/ode.h"

#include <boost/math/special_functions/zeta.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <tuple>

namespace {

using namespace drumlin::physics;

constexpr double k = 1e8, m = 2000.0, radius = 0.04;
constexpr double E_eff = 0.75 * k / 0.2; // of 4/3 E* sqrt(R) = k

/// Duration, s, of an undamped impact: 2.94 d_max / v, d_max from 2/5 k d^(5/2) = m v^2 / 2.
double duration(double speed) { return 2.94 / speed * std::pow(1.25 * m * speed * speed / k, 0.4); }

HertzLaw law_of(Transition transition, double D) {
  return HertzContact{E_eff, 1.0, D, Damping::ratio, transition}.law(m, radius);
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

/// The power of the overlap to which a spring force is proportional, from its forces at d and 2 d.
template <class Law>
double measured_exponent(const Law &law) {
  constexpr double d = 1e-4; // m
  return std::log2(law.spring(2.0 * d) / law.spring(d));
}

// LIGGGHTS asks each contact model for this power.
TEST(SpringExponent, IsThatOfTheForce) {
  EXPECT_NEAR(HertzLaw::exponent, measured_exponent(law_of(Transition::B, 0.3)), 1e-12);
  EXPECT_NEAR(LinearLaw::exponent, measured_exponent(LinearLaw(1e8, 1e5, Transition::B)), 1e-12);
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
  const double order = std::log(coarse / fine) / std::log(16.0);
  std::ostringstream figures;
  figures << coarse << ", " << fine << ", order " << order;
  RecordProperty("errors", figures.str());
  EXPECT_GT(order, 1.9) << coarse << " " << fine;
}

TEST_P(HertzImpact, SchemeErrsAlikeAtAnySpeed) {
  for (const double speed : {0.01, 100.0})
    EXPECT_NEAR(worst_error(transition, D, speed, 50), worst_error(transition, D, 1.0, 50), 1e-9) << speed;
}

INSTANTIATE_TEST_SUITE_P(, HertzImpact,
                         testing::Values(std::tuple(Transition::A, 0.1), std::tuple(Transition::A, 0.3),
                                         std::tuple(Transition::A, 0.5), std::tuple(Transition::A, 0.8),
                                         std::tuple(Transition::B, 0.1), std::tuple(Transition::B, 0.3),
                                         std::tuple(Transition::B, 0.5), std::tuple(Transition::B, 1.0),
                                         std::tuple(Transition::B, 2.0), std::tuple(Transition::B, 5.0),
                                         std::tuple(Transition::B, 10.0)),
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
    EXPECT_NEAR(law.slope(d), slope, 1e-7 * slope);
    EXPECT_NEAR((law.energy(d + h) - law.energy(d - h)) / (2.0 * h), law.spring(d), 1e-7 * law.spring(d));
    EXPECT_DOUBLE_EQ(law.spring_change(d, h, 1.0), law.spring(d) - law.spring(d - h));
  }
}

// Johnson, Contact Mechanics (1985), Eqs. (4.22) to (4.24) and (7.43): a steel ball of 10 mm radius on one of
// 20 mm.
TEST(HertzLaw, HasTheStiffnessOfTwoSpheres) {
  HertzContact contact;
  contact.set_moduli(210e9, 0.3, 70e9, 0.33);
  const double E = 1.0 / ((1.0 - 0.09) / 210e9 + (1.0 - 0.33 * 0.33) / 70e9), R = 0.02 / 3.0, d = 5e-6;
  const double a = std::sqrt(R * d); // radius of the area of contact
  const HertzLaw law = contact.law(1.0, R);
  EXPECT_NEAR(law.spring(d), 4.0 * E * a * a * a / (3.0 * R), 1e-12 * law.spring(d));
  EXPECT_NEAR(law.slope(d), 2.0 * E * a, 1e-12 * law.slope(d));
  const double G1 = 210e9 / 2.6, G2 = 70e9 / 2.66;
  const double tangential = 8.0 * a / ((2.0 - 0.3) / G1 + (2.0 - 0.33) / G2);
  EXPECT_NEAR(contact.tangential(d, R), tangential, 1e-12 * tangential);
  EXPECT_GT(contact.tangential(0.0, R), 0.0);
}

/// The slip velocity behind an oblique impact without sliding, by the scheme: transition B, ct = share times
/// the normal dashpot. \param m_t mass of the slip, kg
double slip_after(double share, double m_t, double D, double speed, double dt) {
  const HertzContact contact{E_eff, 0.4 * E_eff, D, Damping::ratio, Transition::B};
  const HertzLaw law = contact.law(m, radius);
  verlet::SecondOrderBall<HertzLaw> ball(m, 0.0, -speed, dt, {{0.0, 1.0, law}});
  verlet::ContactFriction<HertzContact> friction(contact, 1e9, radius);
  double slip = 0.5 * speed, force = 0.0;
  for (bool touched = false; !touched || ball.x < 0.0;) {
    const double before = ball.x, half_slip = slip + 0.5 * dt * force / m_t;
    const double largest = ball.step();
    touched = true;
    const double overlap = -ball.x, rate = -(ball.x - before) / dt;
    if (overlap <= 0.0 || largest == 0.0) break;
    force = friction
                .step({overlap, rate, rate, dt}, largest, share * law.dashpot(overlap), {0.0, 0.0, 1.0},
                      {half_slip, 0.0, 0.0})
                .force[0];
    slip = half_slip + 0.5 * dt * force / m_t;
  }
  return slip;
}

/// The same by CVODE: overlap, rate, slip, spring force.
double slip_by_cvode(double share, double m_t, double D, double speed) {
  const double c = 2.0 * D * std::sqrt(1.25 * k * m);
  const auto normal = [c](const oracle::State &y) {
    const double d = std::fmax(0.0, y[0]);
    return k * std::pow(d, 1.5) + c * std::pow(d, 0.25) * y[1];
  };
  oracle::Ode impact(
      [&](double, const oracle::State &y, oracle::State &f) {
        const double d = std::fmax(1e-9, y[0]);
        const double kt = 8.0 * 0.4 * E_eff * std::sqrt(radius * d);
        f[0] = y[1];
        f[1] = -normal(y) / m;
        f[2] = -(y[3] + share * c * std::pow(d, 0.25) * y[2]) / m_t;
        f[3] =
            kt * y[2] + (y[1] < 0.0 ? 0.5 * y[3] * y[1] / d : 0.0); // unloading: kt shrinks, the length stays
      },
      0.0, {0.0, speed, 0.5 * speed, 0.0}, {1e-3 * speed, speed, speed, k * std::pow(1e-3, 1.5)});
  impact.advance(1e-3 * duration(speed));
  impact.advance(100.0 * duration(speed), {[](double, const oracle::State &y) { return y[1]; }});
  if (impact.advance(100.0 * duration(speed),
                     {[&](double, const oracle::State &y) { return normal(y) / k; }}) < 0)
    return NAN;
  return impact.state()[2];
}

// Without dashpots the order is less than 2, since kt begins with the root of time. With them friction that
// does not slide ends in a jump, whose instant has an error of first order.
TEST(HertzObliqueImpact, SticksAsTheDifferentialEquations) {
  constexpr double m_t = 2.0 / 7.0 * m, speed = 1.0;
  for (const double D : {0.0, 0.3}) {
    const double share = D > 0.0 ? 0.5 : 0.0;
    const double exact = slip_by_cvode(share, m_t, D, speed);
    const auto error = [&](int steps) {
      double worst = 0.0;
      for (const double factor : {1.0, 1.013, 1.031, 1.047})
        worst = std::fmax(
            worst, std::fabs(slip_after(share, m_t, D, speed, factor * duration(speed) / steps) - exact));
      return worst;
    };
    const double coarse = error(200), fine = error(1600);
    EXPECT_LT(fine, D > 0.0 ? 2e-3 : 1e-4) << D;
    EXPECT_GT(std::log(coarse / fine) / std::log(8.0), D > 0.0 ? 0.8 : 1.1)
        << D << ": " << coarse << " " << fine;
  }
}

/// A spring of a contact whose stiffness follows the overlap, in the steps of the scheme: that of friction
/// without a limit or, if `rolls`, that of rolling resistance.
class VaryingSpring {
public:
  VaryingSpring(const HertzContact &contact, bool rolls, double dt)
      : contact_(contact), rolls_(rolls), dt_(dt) {}

  /// One step that ends at an overlap, m, which has changed at a rate, m/s.
  /// \param moved slip velocity, m/s, or relative angular velocity, rad/s
  /// \returns force, N, or torque, N m, that opposes it
  Vec3 step(double overlap, double rate, const Vec3 &moved, double ct = 0.0, double limit = 1e12) {
    const Vec3 normal{0.0, 0.0, 1.0};
    const double kt = contact_.tangential(overlap_of_spring(overlap, rate, dt_), radius);
    const double kept = rolls_ ? kept_torque(stiffness_, kt) : kept_spring(stiffness_, kt);
    for (double &part : spring_)
      part *= kept;
    stiffness_ = kt;
    const Rolling rolling = rolling_of(kt, limit, radius);
    stored_after_change = 0.5 * dot(spring_, spring_) * (rolls_ ? 1.0 / rolling.stiffness : kt);
    if (rolls_) {
      const RollingStep now = rolling_step(rolling, 1.0, normal, moved, spring_, dt_);
      spring_ = now.spring;
      stored = now.stored;
      return now.torque;
    }
    const FrictionStep now = friction_step({kt, ct, limit, Cap::coulomb}, 1.0, normal, moved, spring_, dt_);
    spring_ = now.spring;
    stored = now.stored;
    return now.force;
  }

  double stored = 0.0;              ///< energy in the spring after the step, J
  double stored_after_change = 0.0; ///< the same after the change of the stiffness, before the motion

private:
  const HertzContact contact_;
  const bool rolls_;
  const double dt_;
  double stiffness_ = 0.0;
  Vec3 spring_{};
};

/// A slip that oscillates on the tangential spring of a contact whose overlap oscillates, too, by the steps
/// of the scheme, or by CVODE if dt is 0; if `rolls`, a rotation on the rolling spring, times the radius. The
/// inertia is the mass of the slip times the radius squared, so that the equations of both are the same.
/// \param ct dashpot of the slip, N s/m
double slip_of_lasting_contact(double ct, double dt, bool rolls = false) {
  const HertzContact contact{E_eff, 0.4 * E_eff, 0.0, Damping::ratio, Transition::B};
  constexpr double depth = 1e-3, swing = 0.3, m_t = 2.0 / 7.0 * m;
  const double kt0 = contact.tangential(depth, radius), w = 1.3 * std::sqrt(kt0 / m_t), end = 10.0 / w;
  const auto overlap = [&](double t) { return depth * (1.0 + swing * std::sin(w * t)); };
  if (dt == 0.0) {
    const auto rate = [&](double t) { return depth * swing * w * std::cos(w * t); };
    oracle::Ode motion(
        [&](double t, const oracle::State &y, oracle::State &f) {
          const double d = overlap(t);
          f[0] = -(y[1] + ct * y[0]) / m_t;
          f[1] = contact.tangential(d, radius) * y[0] + (rate(t) < 0.0 ? 0.5 * y[1] * rate(t) / d : 0.0);
        },
        0.0, {1e-3, 0.0}, {1e-3, 1e-3 * kt0 / w});
    for (int turn = 0; (turn + 0.5) * M_PI < 10.0; ++turn) // where the overlap begins to shrink or to grow
      motion.advance((turn + 0.5) * M_PI / w);
    motion.advance(end);
    return motion.state()[0];
  }
  const long steps = std::lround(end / dt);
  const double lever = rolls ? radius : 1.0;
  VaryingSpring spring(contact, rolls, dt);
  double slip = 1e-3, force = 0.0;
  for (long n = 1; n <= steps; ++n) {
    const double half_slip = slip + 0.5 * dt * force / m_t, now = static_cast<double>(n) * dt;
    const double rate = (overlap(now) - overlap(now - dt)) / dt;
    force = spring.step(overlap(now), rate, {half_slip / lever, 0.0, 0.0}, ct)[0] / lever;
    slip = half_slip + 0.5 * dt * force / m_t;
  }
  return slip;
}

// Only the tangential dashpot, which acts with the slip of the middle of the step, is of first order there.
TEST(HertzTangentialSpring, IsOfSecondOrderInALastingContact) {
  const double w = 1.3 * std::sqrt(8.0 * 0.4 * E_eff * std::sqrt(radius * 1e-3) / (2.0 / 7.0 * m));
  for (const double share : {0.0, 0.1}) {
    const double ct = share * m * w, exact = slip_of_lasting_contact(ct, 0.0);
    const auto error = [&](int steps) {
      return std::fabs(slip_of_lasting_contact(ct, 10.0 / w / steps) - exact);
    };
    const double coarse = error(400), fine = error(3200);
    EXPECT_LT(fine, 1e-3 * 5e-3) << share;
    EXPECT_NEAR(std::log(coarse / fine) / std::log(8.0), share > 0.0 ? 1.0 : 2.0, 0.1)
        << share << ": " << coarse << " " << fine;
  }
}

TEST(HertzRollingSpring, IsOfSecondOrderInALastingContact) {
  const double w = 1.3 * std::sqrt(8.0 * 0.4 * E_eff * std::sqrt(radius * 1e-3) / (2.0 / 7.0 * m));
  const double exact = slip_of_lasting_contact(0.0, 0.0);
  const auto error = [&](int steps) {
    return std::fabs(slip_of_lasting_contact(0.0, 10.0 / w / steps, true) - exact);
  };
  const double coarse = error(400), fine = error(3200);
  EXPECT_LT(fine, 1e-3 * 5e-3);
  EXPECT_NEAR(std::log(coarse / fine) / std::log(8.0), 2.0, 0.1) << coarse << " " << fine;
}

// Loaded from 1 to 4 mm while it turns at w, T = w kr(d)/d' integrated over d; then unloaded to 1 mm without
// turning, which halves kr and, at the same angle, T.
TEST(HertzRollingSpring, KeepsItsTorqueWhileItIsLoadedAndItsAngleWhileItIsUnloaded) {
  const HertzContact contact{E_eff, 0.4 * E_eff, 0.0, Damping::ratio, Transition::B};
  constexpr double w = 0.2, speed = 1.0, thin = 1e-3, deep = 4e-3;
  const double exact = w / speed * 8.0 * 0.4 * E_eff * std::sqrt(radius) * radius * radius * 2.0 / 3.0 *
                       (std::pow(deep, 1.5) - std::pow(thin, 1.5));
  const auto torque = [&](int steps) {
    const double dt = (deep - thin) / speed / steps;
    VaryingSpring spring(contact, true, dt);
    double loaded = 0.0, unloaded = 0.0;
    for (int n = 1; n <= steps; ++n)
      loaded = -spring.step(thin + n * dt * speed, speed, {w, 0.0, 0.0})[0];
    for (int n = 1; n <= steps; ++n)
      unloaded = -spring.step(deep - n * dt * speed, -speed, {0.0, 0.0, 0.0})[0];
    // The last step of loading had the stiffness of its middle.
    EXPECT_NEAR(unloaded, std::sqrt(thin / (deep - 0.5 * dt * speed)) * loaded, 1e-12 * loaded);
    return loaded;
  };
  const double coarse = torque(100) - exact, fine = torque(400) - exact;
  EXPECT_LT(std::fabs(fine), 1e-6 * exact);
  EXPECT_NEAR(coarse / fine, 16.0, 0.5);
}

/// Whatever path overlap and rotation or slip take, the work done on the spring and its slider is at least
/// the energy in it. \param most of rotation about x and y or of slip \param limit of the force or torque at
/// an overlap, in the runs with an even number; the others have none that is reached
template <class Limit>
void expect_no_energy_from(bool rolls, unsigned seed, const Vec3 &most, const Limit &limit) {
  const HertzContact contact{E_eff, 0.4 * E_eff, 0.0, Damping::coefficient, Transition::B};
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double dt = 1e-4;
  for (int run = 0; run < 200; ++run) {
    VaryingSpring spring(contact, rolls, dt);
    double stored = 0.0, overlap = 1e-3;
    for (int n = 0; n < 500; ++n) {
      const double rate = 4.0 * unit(random);
      overlap = std::fmax(1e-6, overlap + dt * rate);
      const Vec3 motion{most[0] * unit(random), most[1] * unit(random), most[2] * unit(random)};
      const Vec3 load =
          spring.step(overlap, rate, motion, 0.0, run % 2 == 0 ? limit(contact, overlap) : 1e12);
      ASSERT_LE(spring.stored_after_change, stored * (1.0 + 1e-12));
      const double work = -dt * dot(load, motion);
      ASSERT_LE(spring.stored - stored, work + 1e-12 * (std::fabs(work) + stored));
      stored = spring.stored;
    }
  }
}

TEST(HertzRollingSpring, CannotCreateEnergy) {
  expect_no_energy_from(true, 11, {20.0, 20.0, 1.0}, [](const HertzContact &, double) { return 3e4; });
}

TEST(HertzTangentialSpring, CannotCreateEnergy) {
  expect_no_energy_from(false, 7, {1.0, 1.0, 0.0}, [](const HertzContact &contact, double overlap) {
    return 0.3 * contact.law(m, radius).spring(overlap);
  });
}

// A break under B lies where the force is 0 on the path of the step, a make where the overlap is 0.
TEST(HertzEvents, AreLocatedWithinTheStep) {
  const HertzLaw law = law_of(Transition::B, 0.3);
  const OverlapState before{4e-3, -0.2};
  const double dt = 0.016;
  const OverlapState after{before.overlap + dt * before.rate, before.rate}; // free flight
  const auto event = locate_transition(law, dt, before, after);
  ASSERT_TRUE(event.has_value());
  EXPECT_FALSE(event->make);
  EXPECT_NEAR(event->overlap, before.overlap + event->since * before.rate, 1e-15);
  EXPECT_NEAR(law.spring_and_dashpot(event->overlap, event->rate), 0.0, 1e-6 * law.spring(before.overlap));
  const auto make = locate_transition(law, dt, {-1e-3, 0.2}, {2.2e-3, 0.2});
  ASSERT_TRUE(make.has_value());
  EXPECT_NEAR(make->since, 5e-3, 1e-15);
  EXPECT_EQ(make->force, 0.0);
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
