#pragma once
/// The longest stable time step with the engines' own integration scheme, `stepping stock`: velocity Verlet
/// in which a dashpot acts with the velocity of the middle of the step, v(t - dt/2), and a spring with the
/// positions at t.
///
/// For masses M, dampings C and stiffnesses K (symmetric matrices) this scheme is
///   M (x(t+dt) - 2 x(t) + x(t-dt)) + dt C (x(t) - x(t-dt)) + dt^2 K x(t) = 0.
/// The substitution x(t) = y z^(t/dt) gives M (z-1)^2 + dt C (z-1) + dt^2 K z, applied to y. Multiplied by y
/// from the left this is a scalar quadratic in z. None of its roots is outside the unit circle if its value
/// at z = -1 is positive, that is, if
///   4 M - 2 dt C - dt^2 K   is positive definite.
/// The condition is also necessary: where the matrix has a negative eigenvalue, an eigenvalue of the
/// polynomial changes its sign between z = -1 and z = -infinity, so that there is a root z < -1. An open
/// contact contributes no term: no combination of open and closed contacts has a shorter limit than that in
/// which all are closed.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace drumlin::physics {

/// Angular frequency w0 = sqrt(k/m), rad/s, of a mass m (kg, > 0) on a spring k (N/m, >= 0).
[[nodiscard]] inline double angular_frequency(double k, double m) { return std::sqrt(k / m); }

/// Damping ratio D = c / (2 sqrt(k m)), Eq. (10) of Wang, Sha and Hu (2018).
/// \param k N/m, > 0 \param c N s/m \param m effective mass, kg, > 0
[[nodiscard]] inline double damping_ratio(double k, double c, double m) {
  return c / (2.0 * std::sqrt(k * m));
}

/// Longest stable step, s, of one contact: (2/w0) (sqrt(1 + D^2) - D), written as the positive root of k dt^2
/// / 4 + c dt / 2 = m_eff without cancellation, so that it is accurate for any D. It is 2 m_eff/c for k = 0
/// and infinity for k = c = 0.
/// \param k N/m, >= 0 \param c N s/m, >= 0 \param m_eff kg, > 0
[[nodiscard]] inline double critical_step_stock(double k, double c, double m_eff) {
  return 4.0 * m_eff / (c + std::hypot(c, 2.0 * std::sqrt(k) * std::sqrt(m_eff)));
}

/// The stiffnesses (1/s^2) and dampings (1/s) of a link (a contact or a bond), each divided by the mass that
/// it moves. They are the same for both balls of the link; the burdens say how much of them counts for one of
/// the two.
struct LinkModes {
  std::array<double, 3> normal{}; ///< unit vector along the line of centres
  double normal_spring = 0.0;     ///< k / m_eff
  double normal_dashpot =
      0.0; ///< c / m_eff; 0 with second-order stepping, which solves for this dashpot implicitly
  double tangential_spring = 0.0;  ///< kt / m_t, see tangential_mass()
  double tangential_dashpot = 0.0; ///< ct / m_t
  double rolling_spring = 0.0;     ///< kr (1/Ii + 1/Ij), kr in N m
  double burden =
      1.0; ///< share of the translational terms that counts for this ball, see link_burden(), of 1/m
  double rolling_burden = 1.0; ///< the same for the rolling term, of 1/I
};

/// Share of a link's k / m_eff that counts for one of its two balls: k/mi + k/sqrt(mi mj) for ball i and k/mj
/// + k/sqrt(mi mj) for ball j, over k / m_eff. It is 1 for two equal balls and for a ball on a fixed partner,
/// and small for a heavy ball among light ones. The comment of LoadedBall derives it.
/// \param inverse_own 1/m (or 1/I) of the ball, > 0
/// \param inverse_other the same of its partner, >= 0; 0 if that is fixed
[[nodiscard]] inline double link_burden(double inverse_own, double inverse_other) {
  return (inverse_own + std::sqrt(inverse_own * inverse_other)) / (inverse_own + inverse_other);
}

/// Effective mass m_t, kg, of the tangential relative motion of the surfaces of two balls in contact, which
/// includes their rotation: 1/m_t = 1/mi + ri^2/Ii + 1/mj + rj^2/Ij. For a ball on a fixed partner this is
/// m_t = m / (1 + m r^2 / I).
/// \param inverse_mi, inverse_mj 1/kg, 0 for a fixed ball; one of them > 0
/// \param mass_over_inertia m r^2 / I, the same for both balls: 2.5 for spheres, 2 for discs, 0 for balls
/// that do not rotate
[[nodiscard]] inline double tangential_mass(double inverse_mi, double inverse_mj, double mass_over_inertia) {
  return 1.0 / ((inverse_mi + inverse_mj) * (1.0 + mass_over_inertia));
}

/// A ball with the sums of stiffness and damping over its links, from which its critical time step follows.
///
/// A step dt is stable for the whole system if for every ball that moves the largest eigenvalues of C and K
/// satisfy
///   dt C / 2 + dt^2 K / 4 <= 1,
///     K = sum over links of  b (k/m_eff n n^T + kt/m_t (1 - n n^T)) + b' kr (1/Ii + 1/Ij),   C the same with
///     the dashpots,
/// where b and b' are the burdens. Proof: for any a > 0 the Cauchy-Schwarz inequality divides what a link
/// contributes between its two balls,
///   (n.(yi - yj))^2 <= (1 + a) (n.yi)^2 + (1 + 1/a) (n.yj)^2,
/// and with a = sqrt(mi/mj) these shares are the burdens; the same holds for the rotations in the tangential
/// plane. If each ball's shares are less than its own 4 m y^2 and 4 I q^2, then 4 M - 2 dt C - dt^2 K of the
/// system is positive definite. (With a = mi/mj both balls would get k/m_eff, which is exact for a free pair;
/// but for a ball on many light ones, such as a drum on soil, the limit would be half as long or less.)
///
/// The limit is exact for links of one damping ratio between fixed partners and for a free pair of equal
/// balls. It is close for a row of equal balls. It is too short by up to a few per cent where balls roll and
/// by up to 15 % for a free pair of unequal masses.
///
/// Second-order stepping solves for the normal dashpots (normal_dashpot = 0), so that only the springs limit
/// the step. For packings it is not proved that no damping shortens this limit;
/// tests/core/scheme_test.cpp searches for a counterexample.
class LoadedBall {
public:
  /// Adds a link of the ball.
  void add(const LinkModes &link) {
    add(spring_, link.normal, link.burden * link.normal_spring, link.burden * link.tangential_spring,
        link.rolling_burden * link.rolling_spring);
    add(dashpot_, link.normal, link.burden * link.normal_dashpot, link.burden * link.tangential_dashpot, 0.0);
  }

  /// Adds the links of another sum, of the same ball.
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

  /// Largest eigenvalue of a positive semidefinite matrix, by the trigonometric solution of its
  /// characteristic equation.
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

/// Number of steps in an undamped contact, which lasts pi/w0: pi / (w0 dt).
/// \param k N/m, > 0 \param m effective mass, kg, > 0 \param dt s, > 0
[[nodiscard]] inline double steps_per_contact(double k, double m, double dt) {
  return 3.14159265358979323846 / (angular_frequency(k, m) * dt);
}

} // namespace drumlin::physics
