#pragma once
/// The excitation force of the drum, Fe = Fw sin(w t) of Eq. (1) of Wang, Sha and Hu (2018), and what real
/// exciters add: the force of an eccentric mass, proportional to w^2; a ramp of the amplitude; a sweep of the
/// frequency; a force that rotates with its mass.
///
/// Times t are in s, on any clock. Positive Fe points along gravity: in Eq. (1), where x is positive upwards,
/// it has a minus sign.

#include "physics/parameter_checks.h"

#include <array>
#include <cmath>
#include <string>

namespace drumlin::physics {

/// Parameters of an exciter. The force starts at `start`; its amplitude grows linearly to the full one within
/// `ramp`; its frequency changes linearly from `angular_frequency` to `sweep_frequency` within
/// `sweep_duration`, counted from `start`, and then stays constant.
struct Excitation {
  bool eccentric = false;         ///< the amplitude is me re w(t)^2 instead of `amplitude`
  double amplitude = 0.0;         ///< Fw, N, finite and >= 0; not used if eccentric
  double eccentric_mass = 0.0;    ///< me, kg, finite and > 0; used if eccentric
  double eccentric_radius = 0.0;  ///< re, m, finite and > 0; used if eccentric
  double angular_frequency = 0.0; ///< w, rad/s, finite and >= 0 (0: run up from rest by a sweep)
  double phase = 0.0;             ///< phase at `start`, rad, finite
  double start = 0.0;             ///< s, finite
  double ramp = 0.0;              ///< s, finite and >= 0; 0: full amplitude at once
  double sweep_frequency = 0.0;   ///< w2, rad/s, finite and >= 0; used if sweep_duration > 0
  double sweep_duration = 0.0;    ///< s, finite and >= 0; 0: no sweep
  bool rotating = false;          ///< the force turns with its mass instead of keeping its direction

  /// Empty if every value that is used is allowed, else what is wrong: name, value, what is allowed.
  [[nodiscard]] std::string invalid() const {
    using detail::Allowed;
    using detail::violation;
    std::string text;
    if (eccentric) {
      text = violation("eccentric mass", eccentric_mass, "kg", Allowed::positive);
      if (text.empty()) text = violation("eccentric radius", eccentric_radius, "m", Allowed::positive);
    } else {
      text = violation("amplitude", amplitude, "N", Allowed::not_negative);
    }
    if (text.empty())
      text = violation("angular frequency", angular_frequency, "rad/s", Allowed::not_negative);
    if (text.empty()) text = violation("phase", phase, "rad", Allowed::finite);
    if (text.empty()) text = violation("start", start, "s", Allowed::finite);
    if (text.empty()) text = violation("ramp", ramp, "s", Allowed::not_negative);
    if (text.empty()) text = violation("sweep duration", sweep_duration, "s", Allowed::not_negative);
    if (text.empty() && sweep_duration > 0.0)
      text = violation("sweep frequency", sweep_frequency, "rad/s", Allowed::not_negative);
    return text;
  }
};

/// Angular frequency w(t), rad/s: w, changing linearly to w2 during the sweep, w2 after it.
[[nodiscard]] inline double excitation_frequency(const Excitation &e, double t) {
  const double since = t - e.start;
  if (e.sweep_duration <= 0.0 || since <= 0.0) return e.angular_frequency;
  if (since >= e.sweep_duration) return e.sweep_frequency;
  return e.angular_frequency + (e.sweep_frequency - e.angular_frequency) * (since / e.sweep_duration);
}

/// Phase, rad: `phase` plus the integral of w(t) from `start`. The phase and its slope are continuous, so a
/// sweep neither starts nor ends with a jump of the force. (sin(w(t) t) would not be a sweep from w to w2:
/// its frequency is d(w t)/dt = w + w' t, which ends at w2 + (w2 - w).)
[[nodiscard]] inline double excitation_phase(const Excitation &e, double t) {
  const double since = t - e.start;
  if (e.sweep_duration <= 0.0 || since <= 0.0) return e.phase + e.angular_frequency * since;
  const double change = e.sweep_frequency - e.angular_frequency;
  if (since >= e.sweep_duration) // during the sweep the mean frequency was w2 - change / 2
    return e.phase + e.sweep_frequency * since - 0.5 * change * e.sweep_duration;
  return e.phase + (e.angular_frequency + 0.5 * change * (since / e.sweep_duration)) * since;
}

/// Amplitude, N, >= 0: Fw, or me re w(t)^2 for an eccentric mass; grows linearly from 0 during the ramp; 0
/// before `start`. Without a ramp it has its full value from `start` on.
[[nodiscard]] inline double excitation_amplitude(const Excitation &e, double t) {
  const double since = t - e.start;
  if (since < 0.0) return 0.0;
  const double w = excitation_frequency(e, t);
  const double full = e.eccentric ? e.eccentric_mass * e.eccentric_radius * w * w : e.amplitude;
  return since < e.ramp ? full * (since / e.ramp) : full;
}

/// Exciting force Fe, N, along the direction of the exciter, positive along gravity: amplitude times
/// sin(phase). Of a rotating force it is the component along the direction.
[[nodiscard]] inline double excitation_force(const Excitation &e, double t) {
  return excitation_amplitude(e, t) * std::sin(excitation_phase(e, t));
}

/// The force's components, N: {along the direction n, along axis x n}, where the axis is the exciter's unit
/// axis of rotation. Directed: {A sin, 0}. Rotating: {A sin, A cos}, of constant magnitude A. The second
/// component turns into the first: seen along the axis (from its tip), the force turns clockwise.
[[nodiscard]] inline std::array<double, 2> excitation_components(const Excitation &e, double t) {
  const double amplitude = excitation_amplitude(e, t);
  const double phase = excitation_phase(e, t);
  return {amplitude * std::sin(phase), e.rotating ? amplitude * std::cos(phase) : 0.0};
}

} // namespace drumlin::physics
