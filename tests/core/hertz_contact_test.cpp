/// The Hertz law: its definitions; its tangential and its rolling spring, whose stiffness follows the
/// overlap. Whole impacts are in law_impact_test and oblique_impact_test.

#include "physics/laws/friction_law.h"
#include "physics/laws/hertz_contact.h"
#include "physics/laws/rolling_law.h"
#include "tests/support/ode.h"

#include <boost/math/special_functions/zeta.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace drumlin::physics;

constexpr double k = 1e8, m = 2000.0, radius = 0.04;
constexpr double E_eff = 0.75 * k / 0.2; // of 4/3 E* sqrt(R) = k

TEST(HertzLaw, IsItsFormula) {
  for (const double d : {1e-8, 1e-4, 1e-2})
    for (const double rate : {-1.0, 0.0, 0.3}) {
      const double force = k * std::pow(d, 1.5) + 3e5 * std::pow(d, 0.25) * rate;
      EXPECT_NEAR(HertzLaw(k, 3e5, Transition::A).force(d, rate), force, 1e-12 * std::fabs(force));
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
