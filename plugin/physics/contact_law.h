#pragma once
/// The linear contact of the paper, Eq. (2), with its two transition conditions, A of Eqs. (3)-(5) and
/// B of Eqs. (6)-(9).
///
/// Sign convention: the overlap d = x1 - x2 is positive while the surfaces overlap, its rate d' is positive
/// while they approach, and the force Fc is positive in compression (it pushes the balls apart). SI units.
///
/// No function replaces a NaN by a number: NaN in, NaN out, so that a lost state is seen.

#include "physics/checks.h"

#include <cmath>
#include <string>

namespace drumlin::physics {

/// When a contact ends.
/// A: as it began, at d = 0; the dashpot then still pulls, Eq. (5).
/// B: when the force falls to zero, at d = -c d'/k > 0, Eqs. (6)-(7); the contact never pulls.
enum class Transition { A, B };

/// How a damping value is meant: the dashpot coefficient c in N s/m, or the damping ratio D of Eq. (10).
enum class Damping { coefficient, ratio };

/// Parameters of one kind of contact.
struct LinearContact {
  double stiffness = 0.0;                      ///< k, N/m, finite and > 0
  double damping = 0.0;                        ///< c in N s/m or D without dimension, finite and >= 0
  Damping damping_kind = Damping::coefficient; ///< which of the two `damping` is
  Transition transition = Transition::B;       ///< B, the condition that the paper recommends

  /// Empty if every value is allowed, else what is wrong: name, value, what is allowed.
  [[nodiscard]] std::string invalid() const {
    std::string text = detail::violation("stiffness", stiffness, "N/m", detail::Allowed::positive);
    if (!text.empty()) return text;
    return damping_kind == Damping::ratio
               ? detail::violation("damping ratio", damping, "", detail::Allowed::not_negative)
               : detail::violation("damping coefficient", damping, "N s/m", detail::Allowed::not_negative);
  }
};

/// Mass, kg, that the relative motion of two balls sees: m_eff = mi mj / (mi + mj).
/// A fixed partner is an infinite mass, and m_eff is then the other ball's mass (m2 in Eq. (10)).
/// Valid for masses > 0 of which at most one is infinite.
[[nodiscard]] inline double effective_mass(double mi, double mj) {
  const double lighter = mi < mj ? mi : mj;
  const double heavier = mi < mj ? mj : mi;
  const double sum = lighter + heavier;
  return std::isinf(sum) ? lighter : lighter * (heavier / sum);
}

/// Dashpot coefficient c, N s/m: c = 2 D sqrt(m_eff k), Eq. (10), or the coefficient itself if that was
/// given. m_eff in kg, > 0; see effective_mass().
[[nodiscard]] inline double damping_coefficient(const LinearContact &contact, double m_eff) {
  if (contact.damping_kind == Damping::coefficient) return contact.damping;
  return 2.0 * contact.damping * std::sqrt(m_eff * contact.stiffness);
}

/// Contact force Fc, N, positive in compression, Eq. (2): k d + c d' for d > 0, else 0.
/// k in N/m, c in N s/m, overlap d in m, overlap_rate d' in m/s, positive while approaching.
/// B is a clamp while the balls overlap, Fc = max(0, k d + c d'), and keeps no memory: Eqs. (8)-(9) read as a
/// latch (re-made only through d = 0) would let a drum that turns round before the gap opens fall through
/// the soil.
[[nodiscard]] inline double normal_force(Transition transition, double k, double c, double overlap,
                                         double overlap_rate) {
  if (overlap <= 0.0) return 0.0;
  const double force = k * overlap + c * overlap_rate;
  return transition == Transition::B && force < 0.0 ? 0.0 : force;
}

/// True while the contact carries its law: d > 0, and under B also k d + c d' > 0. Makes and breaks are the
/// instants at which this changes. Arguments as in normal_force().
[[nodiscard]] inline bool in_contact(Transition transition, double k, double c, double overlap,
                                     double overlap_rate) {
  return overlap > 0.0 && (transition == Transition::A || k * overlap + c * overlap_rate > 0.0);
}

/// Energy in the contact's spring, J: k d^2 / 2 for d > 0, else 0.
[[nodiscard]] inline double contact_energy(double k, double overlap) {
  return overlap <= 0.0 ? 0.0 : 0.5 * k * overlap * overlap;
}

/// Where the power Fc d' that the balls give to a contact goes, W.
struct ContactPower {
  double dissipated; ///< heat in the dashpot, never negative
  double stored;     ///< rate of contact_energy(), of either sign
};

/// Splits Fc d' into spring and dashpot: stored = k d d', dissipated = (Fc - k d) d', both 0 for d <= 0.
/// dissipated is c d'^2 where the law is not clamped. Where B clamps, Fc = 0 and k d < -c d', the balls part
/// faster than the soil can follow: spring and dashpot relax against each other, and the spring's energy
/// turns into heat at the rate -k d d' > 0, less than c d'^2. Summed over time with contact_energy() this
/// closes the energy ledger contact by contact, through clamp, make and break: d runs continuously, and so
/// does the energy. Arguments as in normal_force().
[[nodiscard]] inline ContactPower contact_power(Transition transition, double k, double c, double overlap,
                                                double overlap_rate) {
  if (overlap <= 0.0) return {0.0, 0.0};
  const double stored = k * overlap * overlap_rate;
  const bool clamped = transition == Transition::B && k * overlap + c * overlap_rate < 0.0;
  return {clamped ? -stored : c * overlap_rate * overlap_rate, stored};
}

} // namespace drumlin::physics
