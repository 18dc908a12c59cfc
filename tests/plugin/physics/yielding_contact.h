#pragma once
/// A law that remembers, for tests of what the core does with its memory: it is loaded along k1 d, and from
/// the largest overlap that it has had, D, unloaded and loaded again along k2 (d - (1 - k1/k2) D) >= 0
/// (Walton and Braun 1986, J. Rheol. 30, 949-980), with a linear dashpot.

#include "physics/laws/linear_contact.h"

#include <algorithm>

namespace yielding {

using namespace drumlin::physics;

class YieldingLaw : public ContactLaw<YieldingLaw> {
public:
  YieldingLaw(double k1, double k2, double c, Transition transition, double largest)
      : ContactLaw(transition), k1_(k1), k2_(k2), c_(c), largest_(largest) {}

  double spring(double d) const { return d >= largest_ ? k1_ * d : std::max(0.0, unloading(d)); }
  double dashpot(double) const { return c_; }
  double slope(double d) const { return d >= largest_ ? k1_ : unloading(d) > 0.0 ? k2_ : 0.0; }
  double stiffest(double) const { return k2_; }
  double stored(double d) const { return 0.5 * spring(d) * spring(d) / k2_; }
  double elastic(double d) const { return d >= largest_ ? k1_ / k2_ * spring(d) : spring(d); }
  double spring_change(double d, double rate, double dt) const {
    return spring(d) - spring(std::max(0.0, d - dt * rate));
  }
  double memory() const { return largest_; }
  void remember(double d) { largest_ = std::max(largest_, d); }

  static constexpr bool is_linear = false;
  static constexpr double exponent = 1.0;
  static constexpr double dashpot_exponent = 0.0;
  static constexpr bool begins_with_jump = true;
  static double first_weight(double share) { return 2.0 * share; }

private:
  double unloading(double d) const { return k1_ * largest_ - k2_ * (largest_ - d); }

  double k1_, k2_, c_, largest_;
};

struct YieldingContact {
  using Law = YieldingLaw;
  static constexpr bool depends_on_radius = false;
  static constexpr bool tangential_varies = false;
  static constexpr bool remembers = true;

  double stiffness = 0.0, unloading_stiffness = 0.0, damping = 0.0;
  Damping damping_kind = Damping::coefficient;
  Transition transition = Transition::B;
  double tangential_stiffness = 0.0;

  YieldingLaw law(double m_eff, double, double memory) const {
    const double c =
        damping_kind == Damping::coefficient ? damping : 2.0 * damping * std::sqrt(m_eff * stiffness);
    return {stiffness, unloading_stiffness, c, transition, memory};
  }
  double tangential(double, double) const { return tangential_stiffness; }
};

} // namespace yielding
