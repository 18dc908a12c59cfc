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

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

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

/// What a link, a contact or a bond, is to one of its two balls: stiffnesses (1/s^2) and dampings (1/s) over the masses that
/// feel them, the same for both, and how much of them falls on this ball.
struct LinkModes {
  std::array<double, 3> normal{};  ///< unit vector along the line of centres
  double normal_spring = 0.0;      ///< k / m_eff
  double normal_dashpot = 0.0;     ///< c / m_eff; 0 if the stepping solves for this dashpot
  double tangential_spring = 0.0;  ///< kt / m_t, see tangential_mass()
  double tangential_dashpot = 0.0; ///< ct / m_t
  double rolling_spring = 0.0;     ///< kr (1/Ii + 1/Ij), kr in N m
  double burden = 1.0;             ///< how much of this falls on the ball at hand, see link_burden(): of 1/m
  double rolling_burden = 1.0;     ///< the same of 1/I
};

/// What a link takes from one of its balls, as a multiple of k / m_eff, when ball i takes k/mi + k/sqrt(mi mj) and ball j
/// k/mj + k/sqrt(mi mj). 1 for like balls and a fixed partner, small for a heavy ball among light ones.
/// Arguments: 1/m (or 1/I) of the ball at hand, > 0, and of its partner, >= 0.
[[nodiscard]] inline double link_burden(double inverse_own, double inverse_other) {
  return (inverse_own + std::sqrt(inverse_own * inverse_other)) / (inverse_own + inverse_other);
}

/// Mass m_t, kg, that the sliding of two balls in contact sees, rotation included: 1/m_t = 1/mi + ri^2/Ii + 1/mj + rj^2/Ij.
/// (kt / m_t is kt (1 + m r^2 / I) / m for a ball on a fixed partner.) Arguments: 1/mi, 1/mj in 1/kg and mi ri^2 / Ii, the
/// same for both balls: 2.5 for spheres, 2 for discs; 0 for balls that do not turn.
[[nodiscard]] inline double tangential_mass(double inverse_mi, double inverse_mj, double mass_over_inertia) {
  return 1.0 / ((inverse_mi + inverse_mj) * (1.0 + mass_over_inertia));
}

/// A ball and the sum of what its links do to it.
///
/// The step dt is safe if for every ball that moves the largest eigenvalues of C and K have  dt C / 2 + dt^2 K / 4 <= 1,  with
///   K = sum over links of  b (k/m_eff n n^T + kt/m_t (1 - n n^T)) + b' kr (1/Ii + 1/Ij),   C likewise with the dashpots,
/// b and b' the burdens. For by Cauchy-Schwarz a link takes no more than its share from the 4 m y^2 and 4 I q^2 of its two balls,
///   (n.(yi - yj))^2 <= (1 + a) (n.yi)^2 + (1 + 1/a) (n.yj)^2   for any a > 0, here a = sqrt(mi/mj),
/// and with the rotations in the tangential plane likewise, so that 4 M - 2 dt C - dt^2 K of the whole system stays positive. (With
/// a = mi/mj both balls would take k/m_eff: exact for a free pair, but a ball on many light ones, a drum on soil, or a coarse grain
/// among fine ones, would seem to need steps half as long and shorter.) It is exact for links of one damping ratio between fixed
/// partners and for a free pair of like balls, close for a row of like balls, and shorter than need be by up to a few per cent
/// where balls roll and by up to 15 % for a free pair of unlike masses.
///
/// Second-order stepping solves for the normal dashpots (normal_dashpot = 0): the springs alone limit it. That no damping
/// shortens the step then is not proved for a packing; tests/plugin/physics/time_step_test.cpp searches for a counterexample.
class LoadedBall {
public:
  void add(const LinkModes &link) {
    add(spring_, link.normal, link.burden * link.normal_spring, link.burden * link.tangential_spring,
        link.rolling_burden * link.rolling_spring);
    add(dashpot_, link.normal, link.burden * link.normal_dashpot, link.burden * link.tangential_dashpot, 0.0);
  }

  /// Further links of the same ball.
  void add(const LoadedBall &links) {
    for (std::size_t a = 0; a < spring_.size(); ++a) {
      spring_[a] += links.spring_[a];
      dashpot_[a] += links.dashpot_[a];
    }
  }

  /// Critical step, s; infinity without links.
  [[nodiscard]] double critical_step() const {
    return critical_step_stock(largest_eigenvalue(spring_), largest_eigenvalue(dashpot_), 1.0);
  }

private:
  using Symmetric = std::array<double, 6>; // xx, yy, zz, xy, xz, yz

  static void add(Symmetric &sum, const std::array<double, 3> &n, double along, double across, double all) {
    const double rest = along - across;
    for (std::size_t a = 0; a < 3; ++a)
      sum[a] += rest * n[a] * n[a] + across + all;
    sum[3] += rest * n[0] * n[1];
    sum[4] += rest * n[0] * n[2];
    sum[5] += rest * n[1] * n[2];
  }

  /// Of a positive semidefinite matrix, by the trigonometric solution of its characteristic equation.
  static double largest_eigenvalue(const Symmetric &a) {
    const double mean = (a[0] + a[1] + a[2]) / 3.0;
    const double x = a[0] - mean, y = a[1] - mean, z = a[2] - mean;
    const double size =
        std::sqrt((x * x + y * y + z * z + 2.0 * (a[3] * a[3] + a[4] * a[4] + a[5] * a[5])) / 6.0);
    if (!(size > 0.0)) return mean;
    const double determinant =
        x * (y * z - a[5] * a[5]) - a[3] * (a[3] * z - a[5] * a[4]) + a[4] * (a[3] * a[5] - y * a[4]);
    const double cosine = std::min(1.0, std::max(-1.0, determinant / (2.0 * size * size * size)));
    return mean + 2.0 * size * std::cos(std::acos(cosine) / 3.0);
  }

  Symmetric spring_{};
  Symmetric dashpot_{};
};

/// Steps within one undamped contact of duration pi/w0: pi / (w0 dt). k in N/m, m the effective mass in kg,
/// dt in s.
[[nodiscard]] inline double steps_per_contact(double k, double m, double dt) {
  return 3.14159265358979323846 / (angular_frequency(k, m) * dt);
}

} // namespace drumlin::physics
