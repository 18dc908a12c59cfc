#pragma once
/// A roller that drives: where it is at each time, in passes that begin and end with ramps of the speed, with
/// pauses between them; and where the balls of a drum are that is a clump and rolls.

#include "physics/parameter_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace drumlin::physics {

/// Passes over a way. In each the speed grows from 0 within a ramp, stays, and falls to 0 within another; in
/// a ramp it is speed (3 u^2 - 2 u^3), u the elapsed share, so that the acceleration has no jumps. A pause is
/// between two passes. Without ramps the roller has its full speed at once.
struct Travel {
  double from = 0.0, to = 0.0; ///< places where the first pass begins and ends, m
  double speed = 0.0;          ///< m/s
  double ramp = 0.0;           ///< duration of each ramp, s
  double pause = 0.0;          ///< s
  int passes = 1;
  bool one_way = false; ///< every pass leads on in the direction of the first; else they go back and forth

  [[nodiscard]] double length() const { return std::fabs(to - from); }       ///< of a pass, m
  [[nodiscard]] double pass_time() const { return length() / speed + ramp; } ///< duration of a pass, s
  /// Duration of all passes and the pauses between them, s.
  [[nodiscard]] double duration() const { return passes * pass_time() + (passes - 1) * pause; }
  /// Largest distance from the place where the roller stood at first, m.
  [[nodiscard]] double reach() const { return one_way ? passes * length() : length(); }

  /// Empty if every value is allowed, else what is wrong: name, value, what is allowed.
  [[nodiscard]] std::string invalid() const {
    using detail::Allowed;
    using detail::violation;
    std::string text = violation("place from", from, "m", Allowed::finite);
    if (text.empty()) text = violation("place to", to, "m", Allowed::finite);
    if (text.empty()) text = violation("speed", speed, "m/s", Allowed::positive);
    if (text.empty()) text = violation("ramp", ramp, "s", Allowed::not_negative);
    if (text.empty()) text = violation("pause", pause, "s", Allowed::not_negative);
    if (text.empty() && passes < 1)
      text = "passes is '" + std::to_string(passes) + "'; allowed: a whole number from 1";
    if (text.empty() && (!(length() > 0.0) || length() < speed * ramp))
      text = "way is '" + detail::number_text(length()) + " m' long; allowed: more than 0, and at least " +
             detail::number_text(speed * ramp) + " m, which the two ramps take";
    return text;
  }
};

/// The roller at one time.
struct TravelState {
  int pass = 1;          ///< counted from 1; a pause belongs to the pass that has ended
  double place = 0.0;    ///< between `from` and `to`, m
  double distance = 0.0; ///< along the way from where the roller stood at first, m: below 0 if `to` < `from`
  double velocity = 0.0; ///< m/s, positive towards greater places
  double acceleration = 0.0; ///< m/s2, the same
  bool cruises = false;      ///< at its full speed
};

/// The state at a time, s, since the start of the first pass. Where the speed
/// jumps it has its later value, but at the end of the last pass its earlier one.
[[nodiscard]] inline TravelState travel_state(const Travel &travel, double time) {
  const double whole = travel.pass_time(), period = whole + travel.pause;
  const int pass = static_cast<int>(std::min(std::max(std::floor(time / period), 0.0), travel.passes - 1.0));
  const double since = std::max(0.0, time - pass * period), left = whole - since;
  double driven = travel.length(), speed = 0.0, acceleration = 0.0; // since the pass began
  bool cruises = false;
  const auto share = [&](double elapsed) { return elapsed / travel.ramp; };
  const auto way = [&](double u) { return travel.speed * travel.ramp * u * u * u * (1.0 - 0.5 * u); };
  const auto part = [](double u) { return u * u * (3.0 - 2.0 * u); };
  const auto slope = [&](double u) { return travel.speed / travel.ramp * 6.0 * u * (1.0 - u); };
  // Without a pause the next pass begins at once, and the last one has its end: rounding of the times must
  // not let the roller stand between, nor at the end.
  const bool last = pass + 1 == travel.passes;
  constexpr double rounding = 1e-9;
  if (left > 0.0 || (last ? left > -rounding * whole : travel.pause == 0.0)) {
    if (since < travel.ramp) {
      const double u = share(since);
      driven = way(u);
      speed = travel.speed * part(u);
      acceleration = slope(u);
    } else if (travel.ramp > 0.0 && left < travel.ramp) {
      const double u = share(left);
      driven = travel.length() - way(u);
      speed = travel.speed * part(u);
      acceleration = -slope(u);
    } else {
      driven = std::min(travel.length(), travel.speed * (since - 0.5 * travel.ramp));
      speed = travel.speed;
      cruises = true;
    }
  }
  const double sign = travel.to > travel.from ? 1.0 : -1.0;
  const bool back = !travel.one_way && pass % 2 == 1;
  TravelState state;
  state.pass = pass + 1;
  state.place = back ? travel.to - sign * driven : travel.from + sign * driven;
  state.distance = sign * (travel.one_way ? pass * travel.length() + driven
                           : back         ? travel.length() - driven
                                          : driven);
  state.velocity = (back ? -sign : sign) * speed;
  state.acceleration = (back ? -sign : sign) * acceleration;
  state.cruises = cruises;
  return state;
}

/// Mean velocity, m/s, over the time from `begin` to `end`, s, at which the roller is in the states `first`
/// and `last`.
[[nodiscard]] inline double mean_velocity(const Travel &travel, double begin, double end,
                                          const TravelState &first, const TravelState &last) {
  const bool same_pass = first.pass == last.pass;
  if (same_pass && first.cruises && last.cruises) return first.velocity; // without the rounding of the places
  if (travel.ramp > 0.0 && same_pass)                                    // Simpson's rule, exact in a ramp
    return (first.velocity + 4.0 * travel_state(travel, 0.5 * (begin + end)).velocity + last.velocity) / 6.0;
  return (last.distance - first.distance) / (end - begin);
}

/// A place or a velocity in the plane in which a drum rolls.
struct InPlane {
  double along = 0.0; ///< towards greater places of the way
  double up = 0.0;
};

/// A rotation about the axle by an angle, rad, positive where the drum rolls towards greater places.
class Turn {
public:
  explicit Turn(double angle) : cosine_(std::cos(angle)), sine_(std::sin(angle)) {}

  /// The vector after the rotation.
  [[nodiscard]] InPlane operator()(const InPlane &v) const {
    return {cosine_ * v.along + sine_ * v.up, cosine_ * v.up - sine_ * v.along};
  }

private:
  double cosine_, sine_;
};

/// Velocity of a ball relative to the axle, m/s, in a drum that rotates. \param spin angular velocity of the
/// drum, rad/s \param lever from the axle to the ball, m
[[nodiscard]] inline InPlane turning_velocity(double spin, const InPlane &lever) {
  return {spin * lever.up, -spin * lever.along};
}

/// The angular velocity, rad/s, that gives a ball its mean velocity over a time, s, in which the drum turns
/// by an angle, rad: together with the lever in the middle of the time. It is that of the chord.
[[nodiscard]] inline double spin_of_chord(double angle, double time) {
  return 2.0 * std::sin(0.5 * angle) / time;
}

} // namespace drumlin::physics
