#pragma once
// When, within a step, a contact is made or broken.
//
// A step advances the positions as x(t+s) = x(t) + v(t) s + q s^2 with x(t+dt) given, so the overlap between
// two steps is the parabola through d(t), d'(t) and d(t+dt): exact for the positions that the scheme
// computes, and of third order in dt for the exact motion. Events at which spring and dashpot balance
// (condition B) are located by linear interpolation of the sum of their forces if the law is linear, else by
// bisection on the parabola.

#include "physics/laws/contact_law.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace drumlin::physics {

/// Overlap d (m, positive when overlapping) and its rate d' (m/s, positive when it grows) at one instant.
struct OverlapState {
  double overlap;
  double rate;
};

/// A make or break of contact.
struct ContactTransition {
  bool make;
  double since;   ///< s after the start of the step, 0 to dt
  double overlap; ///< m, at the event
  double rate;    ///< m/s, at the event
  double force; ///< N: just after a make; just before a break under A (tensile, Eq. 5); 0 at a break under B
                ///< (Eq. 6); with suction also minus that
};

namespace detail {

/// First root in [0, dt] of d0 + r s + q s^2, which changes sign there upward (d0 <= 0) or downward (d0 >=
/// 0).
inline double first_crossing(double d0, double r, double q, double dt) {
  if (d0 > 0.0) return first_crossing(-d0, -r, -q, dt);
  const double root = std::sqrt(std::max(0.0, r * r - 4.0 * q * d0));
  const double s = r >= 0.0 ? (r + root > 0.0 ? -2.0 * d0 / (r + root) : 0.0) : (root - r) / (2.0 * q);
  return std::clamp(s, 0.0, dt);
}

/// Time in [0, dt] at which spring and dashpot of a law balance, on the parabola d0 + r s + q s^2. No contact
/// counts as no force. \param was whether the force is positive at 0; it is not at dt, or the other way round
template <class Law>
double balance(const Law &law, double dt, double d0, double r, double q, bool was) {
  double low = 0.0, high = dt;
  for (int n = 0; n < 60; ++n) {
    const double middle = 0.5 * (low + high);
    const double overlap = d0 + (r + q * middle) * middle;
    const bool pushes = overlap > 0.0 && law.spring_and_dashpot(overlap, r + 2.0 * q * middle) > 0.0;
    (pushes == was ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

} // namespace detail

/// The event between two consecutive steps, if the contact changed.
/// \param before, after states at the two steps; whether there is contact in each follows from the law A
/// second event within the same step is not found: steps are far shorter than a contact.
/// \param suction N; a contact with suction acts as long as the balls overlap, under B, too
template <class Law>
[[nodiscard]] inline std::optional<ContactTransition>
locate_transition(const Law &law, double dt, const OverlapState &before, const OverlapState &after,
                  double suction = 0.0) {
  const bool was = suction > 0.0 ? before.overlap > 0.0 : law.acts(before.overlap, before.rate);
  const bool is = suction > 0.0 ? after.overlap > 0.0 : law.acts(after.overlap, after.rate);
  if (was == is) return std::nullopt;

  const double q = (after.overlap - before.overlap - before.rate * dt) / (dt * dt);
  const bool through_gap = is ? before.overlap <= 0.0 : suction > 0.0 || law.ends_in_tension();
  ContactTransition event{is, 0.0, 0.0, 0.0, 0.0};
  if (through_gap) { // d = 0
    event.since = detail::first_crossing(before.overlap, before.rate, q, dt);
    event.rate = before.rate + 2.0 * q * event.since;
    event.force = law.dashpot(0.0) * event.rate;
    if (suction > 0.0) event.force = law.limited(event.force) - suction;
  } else if constexpr (!Law::is_linear) { // spring and dashpot balance
    event.since = detail::balance(law, dt, before.overlap, before.rate, q, was);
    event.overlap = std::max(0.0, before.overlap + (before.rate + q * event.since) * event.since);
    event.rate = before.rate + 2.0 * q * event.since;
  } else {
    const double sum_before = law.spring_and_dashpot(before.overlap, before.rate);
    const double sum_after = law.spring_and_dashpot(after.overlap, after.rate);
    event.since = std::clamp(dt * sum_before / (sum_before - sum_after), 0.0, dt);
    event.overlap = before.overlap + (before.rate + q * event.since) * event.since;
    const double c = law.dashpot(event.overlap);
    event.rate = c > 0.0 ? -law.spring(event.overlap) / c : before.rate + 2.0 * q * event.since;
  }
  return event;
}

} // namespace drumlin::physics
