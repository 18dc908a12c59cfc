#pragma once
/// Restitution e of an impact without gravity, and the damping ratio D that gives it, in closed form: of the
/// linear law, and of every law that a change of variable makes linear (hertz_contact.h). The usual formula
/// holds under A. Under B the relation is another: since the contact never pulls, the restitution is higher.

#include "physics/laws/contact_law.h"

#include <cmath>

namespace drumlin::physics {

/// e, from 0 to 1, of the damping ratio D >= 0. With b = D w0 and w^2 = w0^2 - b^2 the impact is d = v/w
/// exp(-bt) sin wt (sinh for D > 1). A ends at wt = pi, B at the first root of w0^2 d + 2 b d' = 0, which is
/// tan wt = 2 b w / (2 b^2 - w0^2): there d' = -v exp(-bt). Under A the contact does not end for D >= 1, and
/// e is 0.
[[nodiscard]] inline double restitution(Transition transition, double damping_ratio) {
  constexpr double pi = 3.14159265358979323846;
  const double b = damping_ratio; // in units of w0
  const double squared = (1.0 - b) * (1.0 + b);
  if (transition == Transition::A) return b < 1.0 ? std::exp(-b * pi / std::sqrt(squared)) : 0.0;
  const double w = std::sqrt(std::fabs(squared));
  const double cosine = 2.0 * b * b - 1.0;
  if (w < 1e-8) return std::exp(-2.0); // the limit for D = 1: tan wt = 2 w, t = 2
  // For D > 1: wt = atanh(2 b w / (2 b^2 - 1)) = 2 ln(b + w), without a difference of large numbers.
  const double angle = b < 1.0 ? std::atan2(2.0 * b * w, cosine) : 2.0 * std::log(b + w);
  return std::exp(-b * angle / w);
}

/// D of a restitution e > 0, by bisection: `restitution_of` falls with D, from at least e.
template <class RestitutionOf>
[[nodiscard]] double damping_ratio_by_bisection(const RestitutionOf &restitution_of, double e) {
  double low = 0.0, high = 1.0;
  while (restitution_of(high) > e && high < 1e150)
    high *= 2.0;
  for (int n = 0; n < 200 && low < high; ++n) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (restitution_of(middle) > e ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// D of a restitution e, 0 < e <= 1. Under A in closed form; under B by bisection, as e falls with D. B's e
/// stays above 1 / (4 D^2) for large D, so that any e > 0 has a D; D for e = 1e-6 is 500.
[[nodiscard]] inline double damping_ratio_of_restitution(Transition transition, double e) {
  constexpr double pi = 3.14159265358979323846;
  if (transition == Transition::A) {
    const double loss = -std::log(e);
    return loss / std::hypot(pi, loss);
  }
  if (e >= 1.0) return 0.0;
  return damping_ratio_by_bisection([transition](double D) { return restitution(transition, D); }, e);
}

} // namespace drumlin::physics
