#pragma once
/// A contact that yields (Walton and Braun 1986, J. Rheol. 30, 949-980): its spring is loaded along k1 d, and
/// from the largest overlap D that the contact has had, unloaded and loaded again along
///   k2 (d - dp) >= 0,   dp = (1 - k1/k2) D,   k2 >= k1,
/// with a linear dashpot. At the plastic overlap dp the spring is free of force, and below it never pulls.
///
/// A contact forgets D when its overlap ends: the engines keep no history of pairs that are apart. Measured
/// against a memory that lasts (the page pair_gran_yield_transition has the figures): where contacts open in
/// every cycle they yield in every cycle, which costs up to twice the energy or more, but a column sinks
/// less, since the plastic overlap goes with the memory; neither sinks without end. In a bed work, settlement
/// and stiffness are the same within the scatter of beds.
///
/// The dashpot acts at every overlap d > 0, below dp too. A dashpot that ended at dp would let the force jump
/// there, and the order of whole impacts would fall from 2 to 1.0 (measured). Under A it therefore pulls
/// until d = 0, and a strong one stops the ball inside dp.
///
/// D, the damping ratio, is that of a vibration along k2: a contact that carries a load vibrates along k2.

#include "physics/laws/contact_law.h"
#include "physics/laws/law_parameters.h"
#include "physics/laws/linear_contact.h"
#include "physics/laws/restitution.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace drumlin::physics {

/// The law of one contact that yields, in a step that it has begun with a largest overlap.
class YieldLaw : public ContactLaw<YieldLaw> {
public:
  /// \param k1, k2 stiffnesses of first loading and of unloading, N/m, k2 >= k1 > 0 \param c damping
  /// coefficient, N s/m \param largest overlap so far, m; 0 for a contact that begins
  YieldLaw(double k1, double k2, double c, Transition transition, double largest)
      : ContactLaw(transition), k1_(k1), k2_(k2), c_(c), largest_(largest) {}

  // At the largest overlap the contact is loaded: with the memory that it has before and after it has reached
  // it the force has the same bits.
  [[nodiscard]] double spring(double overlap) const {
    const double unloading = k1_ * largest_ - k2_ * (largest_ - overlap);
    const double pushing = unloading < 0.0 ? 0.0 : unloading;
    return overlap >= largest_ ? k1_ * overlap : pushing;
  }
  [[nodiscard]] double dashpot(double) const { return c_; }
  [[nodiscard]] double slope(double overlap) const {
    return overlap >= largest_ ? k1_ : spring(overlap) > 0.0 ? k2_ : 0.0;
  }
  [[nodiscard]] double stiffest(double) const { return k2_; }
  /// What unloading gives back.
  [[nodiscard]] double stored(double overlap) const {
    const double force = spring(overlap);
    return 0.5 * force * force / k2_;
  }
  [[nodiscard]] double elastic(double overlap) const {
    return overlap >= largest_ ? k1_ / k2_ * spring(overlap) : spring(overlap);
  }
  /// The area between the line of loading and that of unloading.
  [[nodiscard]] double yielded(double overlap) const {
    const double most = std::max(largest_, overlap);
    return 0.5 * k1_ * (1.0 - k1_ / k2_) * most * most;
  }
  [[nodiscard]] double spring_change(double overlap, double rate, double dt) const {
    return spring(overlap) - spring(std::max(0.0, overlap - dt * rate));
  }

  [[nodiscard]] double memory() const { return largest_; }
  void remember(double overlap) { largest_ = std::max(largest_, overlap); }

  static constexpr bool is_linear = false;
  static constexpr double exponent = 1.0;
  static constexpr double dashpot_exponent = 0.0;
  // A contact begins and ends as one of the linear law.
  static constexpr bool begins_with_jump = LinearLaw::begins_with_jump;
  [[nodiscard]] static double first_weight(double share) { return LinearLaw::first_weight(share); }

private:
  double k1_, k2_, c_, largest_;
};

/// Restitution e, from 0 to 1, of the first impact of two balls without gravity, at any speed. In units of m
/// and k2 the spring is k1/k2 = q. The ball is loaded until it is at rest at D = exp(-b t1) / sqrt(q), b =
/// damping_ratio, and then pushed back from the distance q D to dp. The time of a quarter of a damped
/// vibration from rest to a force of spring and dashpot of zero is that from the impact to rest, so that
/// under B e = sqrt(q) exp(-b (t1 + t2)). Under A the dashpot acts alone on the way from dp to 0.
[[nodiscard]] inline double restitution_of_yield(Transition transition, double damping_ratio,
                                                 double stiffness_ratio) {
  constexpr double pi = 3.14159265358979323846;
  const double b = damping_ratio, q = 1.0 / stiffness_ratio;
  /// Angle and frequency of that quarter, for a spring k.
  struct Quarter {
    double angle, w;
    [[nodiscard]] double time() const { return angle / w; }
  };
  const auto quarter = [b](double k) -> Quarter {
    const double root = std::sqrt(k), squared = (root - b) * (root + b), w = std::sqrt(std::fabs(squared));
    if (w < 1e-8 * root) return {1.0, b}; // the limit, in which the time is 1 / b
    return {squared > 0.0 ? std::atan2(w, b) : std::log((b + w) / root), w};
  };
  const double deepest = std::exp(-b * quarter(q).time()) / std::sqrt(q);
  const Quarter back = quarter(1.0);
  if (transition == Transition::B) return q * deepest * std::exp(-b * back.time());
  if (b >= 1.0) return 0.0; // the spring never comes free
  const double at_plastic = q * deepest * std::exp(-b * (pi - back.angle) / back.w);
  return std::max(0.0, at_plastic - 2.0 * b * (1.0 - q) * deepest);
}

/// Parameters of the law for a pair of types; law() gives the law for balls of given masses.
struct YieldContact {
  using Law = YieldLaw;
  static constexpr const char *name = "yield/transition";
  static constexpr bool depends_on_radius = false;
  static constexpr bool tangential_varies = false;
  static constexpr bool remembers = true;

  double stiffness = 0.0;                      ///< k1, N/m, of first loading
  double stiffness_ratio = 1.0;                ///< k2/k1, >= 1; with 1 a contact does not yield
  double damping = 0.0;                        ///< c in N s/m or D without dimension, finite and >= 0
  Damping damping_kind = Damping::coefficient; ///< which of the two `damping` is
  Transition transition = Transition::B;
  double tangential_stiffness = 0.0; ///< kt, N/m, of the spring of friction

  static constexpr std::array<LawParameter<YieldContact>, 3> parameters() {
    return {
        {{&YieldContact::stiffness, "normal stiffness of first loading", "N/m", Range::positive, "kn", "k1"},
         {&YieldContact::stiffness_ratio, "stiffness of unloading over that of first loading", "", Range{1.0},
          "stiffnessRatio", "k2/k1"},
         {&YieldContact::tangential_stiffness, "tangential stiffness", "N/m", Range::non_negative, "kt", "kt",
          true}}};
  }
  static constexpr std::array<MaterialParameter, 0> material() { return {}; }
  /// That of the linear law with k1: a deck that lets its contacts yield keeps its friction.
  void set_defaults() { tangential_stiffness = 2.0 / 7.0 * stiffness; }

  /// Without a dashpot, sqrt(k1/k2): more cannot be had.
  [[nodiscard]] double largest_restitution() const { return 1.0 / std::sqrt(stiffness_ratio); }
  void set_restitution(double e) {
    damping = damping_ratio_by_bisection(
        [this](double D) { return restitution_of_yield(transition, D, stiffness_ratio); }, e);
    damping_kind = Damping::ratio;
  }

  /// Stiffness k2 of unloading, N/m.
  [[nodiscard]] double unloading_stiffness() const { return stiffness_ratio * stiffness; }
  /// Dashpot coefficient c, N s/m: c = 2 D sqrt(m_eff k2), or the coefficient itself if that was given.
  [[nodiscard]] double damping_coefficient(double m_eff) const {
    if (damping_kind == Damping::coefficient) return damping;
    return 2.0 * damping * std::sqrt(m_eff * unloading_stiffness());
  }

  /// The law of a contact of effective mass m_eff, kg, > 0, that has had a largest overlap, m.
  [[nodiscard]] YieldLaw law(double m_eff, double, double largest) const {
    return {stiffness, unloading_stiffness(), damping_coefficient(m_eff), transition, largest};
  }
  [[nodiscard]] double tangential(double, double) const { return tangential_stiffness; }
};

} // namespace drumlin::physics
