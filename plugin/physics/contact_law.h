#pragma once
/// The linear contact of the paper, Eq. (2), with its two transition conditions, A of Eqs. (3)-(5) and
/// B of Eqs. (6)-(9), and the base class of all contact laws.
///
/// Sign convention: the overlap d = x1 - x2 is positive while the surfaces overlap, its rate d' is positive
/// while they approach, and the force Fc is positive in compression (it pushes the balls apart). SI units.
///
/// A NaN in an argument gives a NaN, never a number, so that an error in the state of a run stays visible.

#include "physics/parameter_checks.h"

#include <cmath>
#include <string>

namespace drumlin::physics {

/// When a contact ends.
/// A: at d = 0, where it began; just before, the dashpot pulls, Eq. (5).
/// B: when the force has fallen to zero, at d = -c d'/k > 0, Eqs. (6)-(7); the contact never pulls.
enum class Transition { A, B };

/// The meaning of a damping value: the dashpot coefficient c in N s/m, or the damping ratio D of Eq. (10).
enum class Damping { coefficient, ratio };

/// The two parts of the power Fc d' that the balls do on a contact, W.
struct ContactPower {
  double dissipated; ///< heat in the dashpot, never negative
  double stored;     ///< rate of the energy in the spring, of either sign
};

/// Force, energy and power of a contact under a transition condition, for any law whose force is
///   Fc = E(d) + C(d) d'  for d > 0, else 0.
/// `Law` derives from ContactLaw<Law> and has these functions of the overlap d > 0, in m:
///   spring(d)     E, N, 0 at d = 0
///   dashpot(d)    C, N s/m, >= 0
///   stiffness(d)  dE/dd, N/m
///   secant(d)     E/d, N/m
///   stored(d)     energy in the spring, J, the integral of E
/// and these further members, which LinearLaw below and HertzLaw (hertz_contact.h) explain:
///   spring_change(), begins_with_jump, first_weight()   for the second-order scheme, contact_step.h
///   is_linear    whether E is proportional to d and C constant: the times of events then have a closed form,
///                event_location.h
///   exponent     of d in E: LIGGGHTS asks each of its contact models for it
///   dashpot_exponent   of d in C
/// The force of LinearLaw jumps when a contact begins, that of HertzLaw begins at 0.
template <class Law>
class ContactLaw {
public:
  /// Force, N, of spring and dashpot together, whatever the transition condition; d > 0 in m, d' in m/s.
  [[nodiscard]] double spring_and_dashpot(double overlap, double rate) const {
    return self().spring(overlap) + self().dashpot(overlap) * rate;
  }

  /// A force, N, of spring and dashpot under the transition condition: unchanged under A; under B a tension
  /// becomes 0 (no-tension limit). Only this function, acts() and power() apply the condition.
  [[nodiscard]] double limited(double force) const {
    return transition_ == Transition::B && force < 0.0 ? 0.0 : force;
  }

  /// Contact force Fc, N, positive in compression, Eq. (2). overlap d in m, rate d' in m/s, positive while
  /// approaching. B is a limit on the force without history: while the balls overlap, a force that has fallen
  /// to 0 may grow again. Read literally, Eqs. (8)-(9) let a broken contact be made again only at d = 0; a
  /// drum that reverses its motion before the gap opens would then fall through the soil.
  [[nodiscard]] double force(double overlap, double rate) const {
    return overlap <= 0.0 ? 0.0 : limited(spring_and_dashpot(overlap, rate));
  }

  /// Whether the contact exists under its transition condition: d > 0, and under B also a force > 0. Makes
  /// and breaks are the instants at which this changes.
  [[nodiscard]] bool acts(double overlap, double rate) const {
    return overlap > 0.0 && (transition_ == Transition::A || spring_and_dashpot(overlap, rate) > 0.0);
  }

  /// Whether the contact force is a tension just before the contact ends, so that the force jumps there.
  [[nodiscard]] bool ends_in_tension() const { return transition_ == Transition::A; }

  /// Energy in the contact's spring, J; 0 for d <= 0.
  [[nodiscard]] double energy(double overlap) const { return overlap <= 0.0 ? 0.0 : self().stored(overlap); }

  /// Splits Fc d' into spring and dashpot: stored = E d', dissipated = (Fc - E) d', both 0 for d <= 0.
  /// dissipated is C d'^2 where the no-tension limit does not act. Where it acts (B, Fc = 0 and E < -C d'),
  /// the spring relaxes against the dashpot, and its energy turns into heat at the rate -E d' > 0, which is
  /// less than C d'^2. The integral of stored over time is the change of energy(), through makes, breaks and
  /// the limit, since d and with it the energy are continuous: the energy balance holds for each contact.
  [[nodiscard]] ContactPower power(double overlap, double rate) const {
    if (overlap <= 0.0) return {0.0, 0.0};
    const double stored = self().spring(overlap) * rate;
    const bool clamped = transition_ == Transition::B && spring_and_dashpot(overlap, rate) < 0.0;
    return {clamped ? -stored : self().dashpot(overlap) * rate * rate, stored};
  }

  [[nodiscard]] Transition transition() const { return transition_; }

protected:
  explicit ContactLaw(Transition transition) : transition_(transition) {}
  ~ContactLaw() = default;
  ContactLaw(const ContactLaw &) = default;
  ContactLaw &operator=(const ContactLaw &) = default;

private:
  [[nodiscard]] const Law &self() const { return static_cast<const Law &>(*this); }

  Transition transition_;
};

/// The linear law of one contact: Fc = k d + c d', Eq. (2).
class LinearLaw : public ContactLaw<LinearLaw> {
public:
  /// \param k stiffness, N/m \param c damping coefficient, N s/m
  LinearLaw(double k, double c, Transition transition) : ContactLaw(transition), k_(k), c_(c) {}

  [[nodiscard]] double spring(double overlap) const { return k_ * overlap; }
  [[nodiscard]] double dashpot(double) const { return c_; }
  [[nodiscard]] double stiffness(double) const { return k_; }
  [[nodiscard]] double secant(double) const { return k_; }
  [[nodiscard]] double stored(double overlap) const { return 0.5 * k_ * overlap * overlap; }
  /// Change, N, of spring() during a time dt, s, in which the overlap grew at a constant rate, m/s, and which
  /// ends at the overlap d, m (the first argument; not needed by this law).
  [[nodiscard]] double spring_change(double, double rate, double dt) const { return k_ * dt * rate; }

  /// Whether spring and dashpot are linear in overlap and rate.
  static constexpr bool is_linear = true;
  /// The spring force is proportional to the overlap to this power.
  static constexpr double exponent = 1.0;
  /// The dashpot coefficient is proportional to the overlap to this power.
  static constexpr double dashpot_exponent = 0.0;
  /// Whether the force jumps at the beginning of a contact: here from 0 to c d'.
  static constexpr bool begins_with_jump = true;
  /// Weight of the dashpot's first force in the closing half kick of the step in which the contact begins. In
  /// the step in which the overlap ends, its last force has the weight first_weight(share) - 1.
  /// \param share part of the step, 0 to 1, in which the force acted
  [[nodiscard]] static double first_weight(double share) { return 2.0 * share; }

private:
  double k_, c_;
};

/// Effective mass, kg, of the relative motion of two balls: m_eff = mi mj / (mi + mj).
/// A fixed partner has an infinite mass, and m_eff is then the other ball's mass (m2 in Eq. (10)).
/// Valid for masses > 0 of which at most one is infinite.
[[nodiscard]] inline double effective_mass(double mi, double mj) {
  const double lighter = mi < mj ? mi : mj;
  const double heavier = mi < mj ? mj : mi;
  const double sum = lighter + heavier;
  return std::isinf(sum) ? lighter : lighter * (heavier / sum);
}

/// Effective radius R, m, of the contact of balls with the radii a and b, m, both > 0: a b / (a + b). Against a plane it is
/// the radius of the ball.
[[nodiscard]] inline double effective_radius(double a, double b) { return a * b / (a + b); }

/// Parameters of the linear law for a pair of types; law() gives the law for balls of given masses.
struct LinearContact {
  using Law = LinearLaw;
  /// What decks call the law, behind `model` (LIGGGHTS) or `pair_style gran/` (LAMMPS).
  static constexpr const char *name = "hooke/transition";
  /// Whether law() and tangential() need the effective radius.
  static constexpr bool depends_on_radius = false;
  /// Whether tangential() depends on the overlap. A contact then also stores it: see kept_spring().
  static constexpr bool tangential_varies = false;

  double stiffness = 0.0;                      ///< k, N/m, finite and > 0
  double damping = 0.0;                        ///< c in N s/m or D without dimension, finite and >= 0
  Damping damping_kind = Damping::coefficient; ///< which of the two `damping` is
  Transition transition = Transition::B;       ///< B, the condition that the paper recommends
  double tangential_stiffness = 0.0;           ///< kt, N/m, of the spring of friction, finite and >= 0

  /// Empty if every value is allowed, else what is wrong: name, value, what is allowed.
  [[nodiscard]] std::string invalid() const {
    std::string text = detail::violation("stiffness", stiffness, "N/m", detail::Allowed::positive);
    if (!text.empty()) return text;
    return damping_kind == Damping::ratio
               ? detail::violation("damping ratio", damping, "", detail::Allowed::not_negative)
               : detail::violation("damping coefficient", damping, "N s/m", detail::Allowed::not_negative);
  }

  /// Dashpot coefficient c, N s/m: c = 2 D sqrt(m_eff k), Eq. (10), or the coefficient itself if that was
  /// given. m_eff in kg, > 0; see effective_mass().
  [[nodiscard]] double damping_coefficient(double m_eff) const {
    if (damping_kind == Damping::coefficient) return damping;
    return 2.0 * damping * std::sqrt(m_eff * stiffness);
  }

  /// The law of a contact of effective mass m_eff, kg, > 0. The effective radius is not needed.
  [[nodiscard]] LinearLaw law(double m_eff, double = 0.0) const {
    return {stiffness, damping_coefficient(m_eff), transition};
  }
  /// Stiffness kt, N/m, of the spring of friction. Overlap and effective radius are not needed.
  [[nodiscard]] double tangential(double, double) const { return tangential_stiffness; }
  /// The law, without transition condition, of which secant() and dashpot() are known at an overlap.
  [[nodiscard]] static LinearLaw of_secant(double k, double c, double) { return {k, c, Transition::A}; }
};

} // namespace drumlin::physics
