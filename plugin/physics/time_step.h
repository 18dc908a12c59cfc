#pragma once
/// How long a step may be with the engines' stock stepping: velocity Verlet whose dashpot sees the velocity
/// of the half step, v(t - dt/2), together with the positions at t.
///
/// With masses M, dampings C and stiffnesses K (symmetric matrices) that stepping is
///   M (x(t+dt) - 2 x(t) + x(t-dt)) + dt C (x(t) - x(t-dt)) + dt^2 K x(t) = 0.
/// x(t) = y z^(t/dt) turns it into M (z-1)^2 + dt C (z-1) + dt^2 K z applied to y. Multiplied by y from the
/// left it is a scalar quadratic in z, none of whose roots leaves the unit circle if its value at z = -1 is
/// positive:
///   4 M - 2 dt C - dt^2 K   positive definite.
/// This is necessary too: where the matrix has a negative eigenvalue, one eigenvalue of the polynomial
/// changes its sign between z = -1 and z = -infinity, so that there is a root z < -1. A contact that is open
/// takes its term away: no combination of open and closed contacts has a shorter limit than all of them
/// closed.

#include "physics/contact_law.h"

#include <cmath>
#include <limits>

namespace drumlin::physics {

/// Angular frequency w0 = sqrt(k/m), rad/s, of a mass m (kg) on a spring k (N/m).
[[nodiscard]] inline double angular_frequency(double k, double m) { return std::sqrt(k / m); }

/// Damping ratio D = c / (2 sqrt(k m)), Eq. (10); k > 0 in N/m, c in N s/m, m the effective mass in kg.
[[nodiscard]] inline double damping_ratio(double k, double c, double m) {
  return c / (2.0 * std::sqrt(k * m));
}

/// Longest stable step, s, of one contact: (2/w0) (sqrt(1 + D^2) - D). k >= 0, c >= 0, m_eff > 0.
/// Written as the positive root of k dt^2 / 4 + c dt / 2 = m_eff without cancellation, so that it keeps its
/// digits for any D, and gives 2 m/c for k = 0 and infinity for k = c = 0.
[[nodiscard]] inline double critical_step_stock(double k, double c, double m_eff) {
  return 4.0 * m_eff / (c + std::hypot(c, 2.0 * std::sqrt(k) * std::sqrt(m_eff)));
}

/// One spring and dashpot that a ball hangs on, contact or bond.
struct Link {
  double stiffness;                                              ///< k, N/m, >= 0
  double damping;                                                ///< c, N s/m, >= 0
  double partner_mass = std::numeric_limits<double>::infinity(); ///< kg, > 0; infinite: a fixed partner
};

/// A step, s, that is safe for a ball with several links, a range of Link: the root of
///   sum over links of (2 dt c + dt^2 k) / m_eff = 4,   m_eff from the ball's mass and the partner's.
/// If dt is at most the smallest of these values over all balls that move, the whole system is stable. For
/// by Cauchy-Schwarz (yi - yj)^2 <= (mi yi^2 + mj yj^2) / m_eff, so that a link takes no more than its share
/// from the 4 mi yi^2 and 4 mj yj^2 of its two balls, and 4 M - 2 dt C - dt^2 K stays positive. It is exact
/// for a ball between fixed partners in one line (sum k, sum c) and for a free pair, and close for a long row
/// of like balls. In two and three dimensions it counts every link as if all pointed the same way: safe, and
/// shorter than need be. Tangential springs and rotation are not in it.
/// mass in kg, > 0 and finite. Without links: infinity.
template <typename Links>
[[nodiscard]] double critical_step_stock(double mass, const Links &links) {
  double k_over_m = 0.0;
  double c_over_m = 0.0;
  for (const Link &link : links) {
    const double m_eff = effective_mass(mass, link.partner_mass);
    k_over_m += link.stiffness / m_eff;
    c_over_m += link.damping / m_eff;
  }
  return critical_step_stock(k_over_m, c_over_m, 1.0);
}

/// Steps within one undamped contact of duration pi/w0: pi / (w0 dt). k in N/m, m the effective mass in kg,
/// dt in s.
[[nodiscard]] inline double steps_per_contact(double k, double m, double dt) {
  return 3.14159265358979323846 / (angular_frequency(k, m) * dt);
}

} // namespace drumlin::physics
