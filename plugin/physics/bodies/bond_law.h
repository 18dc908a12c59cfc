#pragma once
/// The bond between drum and frame, of Eq. (1) of Wang, Sha and Hu (2018): a spring k23 and a dashpot c23 in
/// parallel, which carry tension as well as compression.

#include "physics/parameter_checks.h"

#include <cmath>
#include <limits>
#include <string>

namespace drumlin::physics {

/// Parameters of a bond.
struct Bond {
  double stiffness = 0.0;                                    ///< k23, N/m, finite and > 0
  double damping = 0.0;                                      ///< c23, N s/m, finite and >= 0
  double length = 0.0;                                       ///< distance without force, m, finite and >= 0
  double strength = std::numeric_limits<double>::infinity(); ///< N, > 0; infinite: never breaks

  /// Empty if every value is allowed, else what is wrong: name, value, what is allowed.
  [[nodiscard]] std::string invalid() const {
    using detail::Allowed;
    using detail::violation;
    std::string text = violation("stiffness", stiffness, "N/m", Allowed::positive);
    if (text.empty()) text = violation("damping", damping, "N s/m", Allowed::not_negative);
    if (text.empty()) text = violation("length", length, "m", Allowed::not_negative);
    if (text.empty()) text = violation("strength", strength, "N", Allowed::positive_or_infinite);
    return text;
  }
};

/// Force, energy and power of a bond at one instant.
struct BondForce {
  double force;          ///< N, positive in tension (it pulls the two balls together)
  double stored;         ///< energy in the spring, J, k e^2 / 2
  double dissipated;     ///< power turned into heat by the dashpot, W, c e'^2, never negative
  bool breaks;           ///< |force| is above the strength; `force` is that of the bond if it did not break
  double released = 0.0; ///< J, energy of a spring that has broken in this step: heat from then on
};

/// Force of a bond, F = k e + c e' with the stretch e = distance - length: the bond terms of Eq. (1), where e
/// = x3 - x2 and +F acts on the drum. The power F e' of the balls on the bond is d(stored)/dt + dissipated.
/// Broken bonds are the caller's concern: it must not call this function for them.
/// \param distance of the two centres, m, >= 0
/// \param distance_rate m/s, positive while the distance grows
[[nodiscard]] inline BondForce bond_force(const Bond &bond, double distance, double distance_rate) {
  const double stretch = distance - bond.length;
  const double force = bond.stiffness * stretch + bond.damping * distance_rate;
  return {force, 0.5 * bond.stiffness * stretch * stretch, bond.damping * distance_rate * distance_rate,
          std::fabs(force) > bond.strength};
}

} // namespace drumlin::physics
