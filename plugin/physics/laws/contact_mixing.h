#pragma once
/// Contacts of two different materials, computed from the contacts of each material with itself.

#include <algorithm>

namespace drumlin::physics {

/// What a linear contact of two balls of one material has.
struct ContactValues {
  double stiffness = 0.0;     ///< k, N/m, > 0
  double damping_ratio = 0.0; ///< D, >= 0
  double friction = 0.0;      ///< mu, >= 0
  double rolling = 0.0;       ///< coefficient of rolling friction, >= 0
  double suction = 0.0;       ///< F_a, N, >= 0
};

/// Contact of a ball of one material and a ball of another, in either order.
///
/// Stiffness: each ball is a spring of twice the stiffness that a contact of two such balls has, and the
/// springs of two balls act in series, 1/k = 1/(2 k_a) + 1/(2 k_b). Friction and rolling friction: those of
/// the smoother material, which slides or rolls first, and suction that of the drier one. (The first two are
/// the rules of the linear model of PFC: Itasca, PFC documentation, Linear Model, "Property inheritance".)
/// Damping ratio: the mean. The contact of two balls of one material is that of the material, to rounding.
[[nodiscard]] inline ContactValues mixed(const ContactValues &a, const ContactValues &b) {
  return {2.0 / (1.0 / a.stiffness + 1.0 / b.stiffness), 0.5 * (a.damping_ratio + b.damping_ratio),
          std::min(a.friction, b.friction), std::min(a.rolling, b.rolling), std::min(a.suction, b.suction)};
}

} // namespace drumlin::physics
