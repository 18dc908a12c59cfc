#pragma once
/// The linear contact of the paper, Eq. (2).

#include "physics/laws/contact_law.h"
#include "physics/laws/law_parameters.h"
#include "physics/laws/restitution.h"

#include <array>
#include <cmath>

namespace drumlin::physics {

/// The linear law of one contact: Fc = k d + c d', Eq. (2).
class LinearLaw : public ContactLaw<LinearLaw> {
public:
  /// \param k stiffness, N/m \param c damping coefficient, N s/m
  LinearLaw(double k, double c, Transition transition) : ContactLaw(transition), k_(k), c_(c) {}

  [[nodiscard]] double spring(double overlap) const { return k_ * overlap; }
  [[nodiscard]] double dashpot(double) const { return c_; }
  [[nodiscard]] double slope(double) const { return k_; }
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

/// Parameters of the linear law for a pair of types; law() gives the law for balls of given masses.
struct LinearContact {
  using Law = LinearLaw;
  /// What decks call the law, behind `model` (LIGGGHTS) or `pair_style gran/` (LAMMPS).
  static constexpr const char *name = "hooke/transition";
  /// Whether law() and tangential() need the effective radius.
  static constexpr bool depends_on_radius = false;
  /// Whether tangential() depends on the overlap. A contact then also stores it: see kept_spring().
  static constexpr bool tangential_varies = false;
  /// Whether a contact remembers a number for its law: see ContactLaw.
  static constexpr bool remembers = false;

  double stiffness = 0.0;                      ///< k, N/m
  double damping = 0.0;                        ///< c in N s/m or D without dimension, finite and >= 0
  Damping damping_kind = Damping::coefficient; ///< which of the two `damping` is
  Transition transition = Transition::B;       ///< B, the condition that the paper recommends
  double tangential_stiffness = 0.0;           ///< kt, N/m, of the spring of friction

  static constexpr std::array<LawParameter<LinearContact>, 2> parameters() {
    return {{{&LinearContact::stiffness, "normal stiffness", "N/m", Range::positive, "kn", "k"},
             {&LinearContact::tangential_stiffness, "tangential stiffness", "N/m", Range::non_negative, "kt",
              "kt", true}}};
  }
  /// What a deck may give instead of those that have no LIGGGHTS property.
  static constexpr std::array<MaterialParameter, 0> material() { return {}; }
  /// Sets the parameters that a deck may leave out, from the others.
  void set_defaults() { tangential_stiffness = 2.0 / 7.0 * stiffness; }
  /// The restitution of an impact without dashpot.
  [[nodiscard]] static double largest_restitution() { return 1.0; }
  /// Sets the damping to that of a restitution e, > 0 and <= 1, of an impact without gravity.
  void set_restitution(double e) {
    damping = damping_ratio_of_restitution(transition, e);
    damping_kind = Damping::ratio;
  }

  /// Dashpot coefficient c, N s/m: c = 2 D sqrt(m_eff k), Eq. (10), or the coefficient itself if that was
  /// given. m_eff in kg, > 0; see effective_mass().
  [[nodiscard]] double damping_coefficient(double m_eff) const {
    if (damping_kind == Damping::coefficient) return damping;
    return 2.0 * damping * std::sqrt(m_eff * stiffness);
  }

  /// The law of a contact of effective mass m_eff, kg, > 0. Effective radius and memory are not needed.
  [[nodiscard]] LinearLaw law(double m_eff, double = 0.0, double = 0.0) const {
    return {stiffness, damping_coefficient(m_eff), transition};
  }
  /// Stiffness kt, N/m, of the spring of friction. Overlap and effective radius are not needed.
  [[nodiscard]] double tangential(double, double) const { return tangential_stiffness; }
};

} // namespace drumlin::physics
