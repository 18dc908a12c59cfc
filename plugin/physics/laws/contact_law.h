#pragma once
/// The base class of all contact laws, and their two transition conditions: A of Eqs. (3)-(5) and B of Eqs.
/// (6)-(9) of the paper.
///
/// Sign convention: the overlap d = x1 - x2 is positive while the surfaces overlap, its rate d' is positive
/// while they approach, and the force Fc is positive in compression (it pushes the balls apart). SI units.
///
/// A NaN in an argument gives a NaN, never a number, so that an error in the state of a run stays visible.

#include <cmath>

namespace drumlin::physics {

/// When a contact ends. A: at d = 0, where it began; just before, the dashpot pulls, Eq. (5). B: when the
/// force has fallen to zero, at d = -c d'/k > 0, Eqs. (6)-(7); the contact never pulls.
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
///   slope(d)      dE/dd, N/m
///   stored(d)     energy in the spring, J, that the contact can give back
/// and these further members, which LinearLaw (linear_contact.h) and HertzLaw (hertz_contact.h) explain (a
/// law that remembers is YieldLaw, yield_contact.h):
///   spring_change(), begins_with_jump, first_weight()   for the second-order scheme, advance.h
///   is_linear    whether E is proportional to d and C constant: the times of events then have a closed form,
///                event_location.h
///   exponent     of d in E: LIGGGHTS asks each of its contact models for it
///   dashpot_exponent   of d in C
/// The force of LinearLaw jumps when a contact begins, that of HertzLaw begins at 0.
///
/// A law may remember a number of each contact, such as its largest overlap. It is made for a contact and a
/// time step with the number at the beginning of the step, so that all functions of d are pure: they hold for
/// the overlaps within the step. remember() takes up the overlap at the end of the step; memory() is then the
/// number of the next step, with which the law must have the same bits at this overlap, and taking the
/// overlap up again must change nothing. Such a law also has the functions below whose defaults do not fit
/// it; its parameters have `remembers`.
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

  /// What the contact remembers; 0 at its beginning.
  [[nodiscard]] double memory() const { return 0.0; }
  /// Takes up the overlap d, m, at the end of a step.
  void remember(double) {}
  /// d stored / dd, N: the part of E that stores energy. The work of the rest turns into heat.
  [[nodiscard]] double elastic(double overlap) const { return self().spring(overlap); }
  /// What the spring has turned into heat since the contact began, J: its work is stored() and this.
  [[nodiscard]] double yielded(double) const { return 0.0; }
  /// The greatest dE/dd, N/m, that the contact can have at this overlap, whether it is loaded or unloaded:
  /// for the limits of the time step.
  [[nodiscard]] double stiffest(double overlap) const { return self().slope(overlap); }

  /// Energy in the contact's spring, J; 0 for d <= 0.
  [[nodiscard]] double energy(double overlap) const { return overlap <= 0.0 ? 0.0 : self().stored(overlap); }

  /// Splits Fc d' into what the contact stores and heat: stored = E d', dissipated = (Fc - E) d', both 0 for
  /// d <= 0, for a law with elastic() = E. dissipated is C d'^2 where the no-tension limit does not act.
  /// Where it acts (B, Fc = 0 and E < -C d'), the spring relaxes against the dashpot, and its energy turns
  /// into heat at the rate -E d' > 0, which is less than C d'^2. The integral of stored over time is the
  /// change of energy(), through makes, breaks and the limit, since d and with it the energy are continuous:
  /// the energy balance holds for each contact.
  [[nodiscard]] ContactPower power(double overlap, double rate) const {
    if (overlap <= 0.0) return {0.0, 0.0};
    const double elastic = self().elastic(overlap), stored = elastic * rate;
    const bool clamped = transition_ == Transition::B && spring_and_dashpot(overlap, rate) < 0.0;
    const double plastic = (self().spring(overlap) - elastic) * rate;
    return {clamped ? -stored : plastic + self().dashpot(overlap) * rate * rate, stored};
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

/// Effective mass, kg, of the relative motion of two balls: m_eff = mi mj / (mi + mj). A fixed partner has an
/// infinite mass, and m_eff is then the other ball's mass (m2 in Eq. (10)). Valid for masses > 0 of which at
/// most one is infinite.
[[nodiscard]] inline double effective_mass(double mi, double mj) {
  const double lighter = mi < mj ? mi : mj;
  const double heavier = mi < mj ? mj : mi;
  const double sum = lighter + heavier;
  return std::isinf(sum) ? lighter : lighter * (heavier / sum);
}

/// Effective radius R, m, of the contact of balls with the radii a and b, m, both > 0: a b / (a + b). Against
/// a plane it is the radius of the ball.
[[nodiscard]] inline double effective_radius(double a, double b) { return a * b / (a + b); }

} // namespace drumlin::physics
