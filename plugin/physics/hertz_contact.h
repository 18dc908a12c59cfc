#pragma once
/// Hertz contact of spheres with a dashpot that fits it (Tsuji, Tanaka and Ishida 1992, Powder Technology 71,
/// 239-250):
///   Fc = k d^(3/2) + c d^(1/4) d'.
/// y = d^(5/4) obeys the linear law in the speed u = d':  5/4 u du/dy = -(k y + c u) / m.  With D = c / (2
/// sqrt(5/4 k m)) the restitution is therefore that of the linear law with the same D, under A and B and at
/// any impact speed.

#include "physics/contact_law.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace drumlin::physics {

namespace detail {

/// Hurwitz zeta function, the sum of (n + a)^(-s) over n >= 0 continued to s < 1: Euler-Maclaurin from the
/// sixth term on. For -1 < s < 0 and 1 <= a <= 2 it has 10 digits.
[[nodiscard]] inline double hurwitz_zeta(double s, double a) {
  double sum = 0.0;
  constexpr int terms = 6;
  for (int n = 0; n < terms; ++n)
    sum += std::pow(a + n, -s);
  const double x = a + terms;
  const double power = std::pow(x, -s);
  return sum +
         power * (x / (s - 1.0) + 0.5 + s / (12.0 * x) - s * (s + 1.0) * (s + 2.0) / (720.0 * x * x * x) +
                  s * (s + 1.0) * (s + 2.0) * (s + 3.0) * (s + 4.0) / (30240.0 * x * x * x * x * x));
}

} // namespace detail

/// The Hertz law of one contact.
class HertzLaw : public ContactLaw<HertzLaw> {
public:
  /// \param k stiffness, N/m^(3/2) \param c damping coefficient, N s/m^(5/4)
  HertzLaw(double k, double c, Transition transition) : ContactLaw(transition), k_(k), c_(c) {}

  [[nodiscard]] double spring(double overlap) const { return k_ * overlap * std::sqrt(overlap); }
  [[nodiscard]] double dashpot(double overlap) const { return c_ * std::sqrt(std::sqrt(overlap)); }
  [[nodiscard]] double stiffness(double overlap) const { return 1.5 * k_ * std::sqrt(overlap); }
  [[nodiscard]] double stored(double overlap) const {
    return 0.4 * k_ * overlap * overlap * std::sqrt(overlap);
  }
  [[nodiscard]] double spring_change(double overlap, double rate, double dt) const {
    return spring(overlap) - spring(std::max(0.0, overlap - dt * rate));
  }

  /// The force begins with 0, but not smoothly: with the time since the make to the power 1/4.
  static constexpr bool begins_with_jump = false;
  /// What a sum over steps of dt makes of an integral of t^(1/4) from a time inside a step on: by the
  /// Euler-Maclaurin formula the sum misses it by dt zeta(-1/4, share) times the force at dt. The first
  /// force, at share dt, gets a weight in the closing half kick that makes up for it.
  [[nodiscard]] static double first_weight(double share) {
    const double at_least = std::max(share, 1e-12); // the force is 0 at 0, the weight infinite
    return -2.0 * detail::hurwitz_zeta(-0.25, 1.0 + share) / std::sqrt(std::sqrt(at_least)) - 1.0;
  }

private:
  double k_, c_;
};

/// Parameters of one kind of Hertz contact, for balls of any masses.
struct HertzContact {
  using Law = HertzLaw;

  double stiffness = 0.0;                      ///< k, N/m^(3/2), finite and > 0
  double damping = 0.0;                        ///< c in N s/m^(5/4) or D without dimension, finite and >= 0
  Damping damping_kind = Damping::coefficient; ///< which of the two `damping` is
  Transition transition = Transition::B;

  /// Empty if every value is allowed, else what is wrong: name, value, what is allowed.
  [[nodiscard]] std::string invalid() const {
    std::string text = detail::violation("stiffness", stiffness, "N/m^1.5", detail::Allowed::positive);
    if (!text.empty()) return text;
    return damping_kind == Damping::ratio
               ? detail::violation("damping ratio", damping, "", detail::Allowed::not_negative)
               : detail::violation("damping coefficient", damping, "N s/m^1.25",
                                   detail::Allowed::not_negative);
  }

  /// c, N s/m^(5/4): 2 D sqrt(5/4 k m_eff), or the coefficient itself if that was given. m_eff in kg, > 0.
  [[nodiscard]] double damping_coefficient(double m_eff) const {
    if (damping_kind == Damping::coefficient) return damping;
    return 2.0 * damping * std::sqrt(1.25 * stiffness * m_eff);
  }

  [[nodiscard]] HertzLaw of_mass(double m_eff) const {
    return {stiffness, damping_coefficient(m_eff), transition};
  }
};

} // namespace drumlin::physics
