#pragma once
/// A contact that yields (Walton and Braun 1986, J. Rheol. 30, 949-980). First loading goes along k1 d. Below
/// the largest overlap of the contact so far, d_max, it is unloaded and loaded again along
///   k2 (d - d_p) >= 0,   d_p = (1 - k1/k2) d_max,   k2 >= k1.
/// At the plastic overlap d_p the spring force is zero; below it the spring does not pull. A linear dashpot
/// acts in parallel.
///
/// A contact forgets d_max when the balls separate, because the engines keep no history of pairs that are
/// apart. The page pair_gran_yield_transition compares that with a lasting memory: contacts that open in
/// every cycle yield in every cycle, which dissipates up to 3.6 times the energy; a column of balls settles
/// less, and not without end under either rule. In a bed settlement and stiffness agree within the scatter of
/// beds, and the work of a cycle differs by 2 to 12 %.
///
/// The dashpot acts at every overlap d > 0, also below d_p. If it ended at d_p, the force would jump there,
/// and an impact would be integrated with an error of first instead of second order (measured). Under A the
/// contact therefore pulls until d = 0, and a strong dashpot stops the ball at an overlap between 0 and d_p.
///
/// The damping ratio D refers to k2, because a contact under load vibrates along k2.

#include "physics/laws/contact_law.h"
#include "physics/laws/law_parameters.h"
#include "physics/laws/linear_contact.h"
#include "physics/laws/restitution.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace drumlin::physics {

/// The law of one contact in a time step, made with d_max at the beginning of the step.
class YieldLaw : public ContactLaw<YieldLaw> {
public:
  /// \param k1, k2 stiffnesses of first loading and of unloading, N/m, k2 >= k1 > 0 \param c damping
  /// coefficient, N s/m \param largest overlap so far, m; 0 for a contact that begins
  YieldLaw(double k1, double k2, double c, Transition transition, double largest)
      : ContactLaw(transition), k1_(k1), k2_(k2), c_(c), largest_(largest) {}

  // At d = d_max the line of first loading counts, so that the force has the same bits before and after
  // remember().
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
  /// Work of first loading up to d_max that unloading does not give back.
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

/// Coefficient of restitution e of the first impact of two balls without gravity; it does not depend on the
/// speed. In units of m_eff, k2 and the speed of impact, with q = k1/k2 and the damping ratio b:
///   loading   takes the time t1 to rest at d_max = exp(-b t1) / sqrt(q);
///   unloading starts there, at the distance q d_max from d_p; after t2 the force of spring and dashpot is 0.
/// Both times are quarters of a damped vibration: t = atan2(w, b) / w, with w = sqrt(q - b^2) for t1 and
/// sqrt(1 - b^2) for t2. B: the contact ends after t2, e = sqrt(q) exp(-b (t1 + t2)). A: it goes on to d_p,
/// and from there to d = 0 the dashpot acts alone and takes 2 b d_p of the speed.
[[nodiscard]] inline double restitution_of_yield(Transition transition, double damping_ratio,
                                                 double stiffness_ratio) {
  constexpr double pi = 3.14159265358979323846;
  const double b = damping_ratio, q = 1.0 / stiffness_ratio;
  /// A quarter of a damped vibration on a spring k: angle, rad, and angular frequency w.
  struct Quarter {
    double angle, w;
    [[nodiscard]] double time() const { return angle / w; }
  };
  const auto quarter = [b](double k) -> Quarter {
    const double root = std::sqrt(k), squared = (root - b) * (root + b), w = std::sqrt(std::fabs(squared));
    if (w < 1e-8 * root) return {1.0, b}; // critical damping: the time is 1 / b
    return {squared > 0.0 ? std::atan2(w, b) : std::log((b + w) / root), w};
  };
  const double deepest = std::exp(-b * quarter(q).time()) / std::sqrt(q);
  const Quarter back = quarter(1.0);
  if (transition == Transition::B) return q * deepest * std::exp(-b * back.time());
  if (b >= 1.0) return 0.0; // the overlap does not come down to d_p in finite time
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

  /// Of an impact without dashpot; no dashpot makes it larger.
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

  /// The law of a contact of effective mass m_eff > 0, kg, with the largest overlap so far, m.
  [[nodiscard]] YieldLaw law(double m_eff, double, double largest) const {
    return {stiffness, unloading_stiffness(), damping_coefficient(m_eff), transition, largest};
  }
  [[nodiscard]] double tangential(double, double) const { return tangential_stiffness; }
};

} // namespace drumlin::physics
