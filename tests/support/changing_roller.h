// A roller whose exciter and soil change while it is recorded, by Runge-Kutta of fourth order with a fixed
// step: it shares no code with the solvers of the tools.
#pragma once

#include "tests/support/prelude.h"

namespace drumlin::test {

/// A roller of 12 t; numbers of exciter and soil are functions of time [s].
struct ChangingRoller {
  using OfTime = std::function<double(double)>;
  double m2 = 3955.0, m3 = 3713.0, k23 = 3.1e6, c23 = 31e3, g = 9.81;
  OfTime frequency = [](double) { return 31.0; }; ///< [Hz]
  OfTime me_re = [](double) { return 7.38; };     ///< [kg m]; 0: the exciter is off
  OfTime jump = [](double) { return 0.0; };       ///< of the exciter's phase [rad]
  OfTime k = [](double) { return 40e6; };         ///< of the soil [N/m]
  double D = 0.2;                                 ///< damping ratio for the first k
  bool pulls = false;                             ///< condition A
};

/// What its sensors see, after a second of running in.
struct SeenMotion {
  double interval;
  std::vector<double> time, a_drum, a_frame;
};

inline SeenMotion seen_motion(const ChangingRoller &r, double rate, double length, double noise,
                              unsigned seed) {
  using State = std::array<double, 5>; // x2, v2, x3, v3, angle of the exciter
  const double c = 2.0 * r.D * std::sqrt(r.m2 * r.k(0.0)), two_pi = 2.0 * std::acos(-1.0);
  const auto slope = [&](double t, const State &s) {
    const double omega = two_pi * r.frequency(t), k = r.k(t);
    double soil = s[0] < 0.0 ? -k * s[0] - c * s[1] : 0.0;
    if (!r.pulls && soil < 0.0) soil = 0.0;
    const double bond = r.c23 * (s[3] - s[1]) + r.k23 * (s[2] - s[0]);
    const double exciter = r.me_re(t) * omega * omega * std::sin(s[4] + r.jump(t));
    return State{s[1], -r.g + (soil + bond - exciter) / r.m2, s[3], -r.g - bond / r.m3, omega};
  };
  const auto moved = [](State s, const State &by, double h) {
    for (std::size_t i = 0; i < s.size(); ++i)
      s[i] += h * by[i];
    return s;
  };
  const int inner = static_cast<int>(std::ceil(2e4 / rate));
  const double h = 1.0 / rate / inner, rest = -(r.m2 + r.m3) * r.g / r.k(0.0);
  State s{rest, 0.0, rest - r.m3 * r.g / r.k23, 0.0, 0.0};
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, noise);
  SeenMotion seen{1.0 / rate, {}, {}, {}};
  const auto before = static_cast<long>(rate), samples = static_cast<long>(length * rate);
  for (long i = -before; i < samples; ++i) {
    const double at = static_cast<double>(i) / rate;
    if (i >= 0) {
      const State now = slope(at, s);
      seen.time.push_back(at);
      seen.a_drum.push_back(now[1] + (noise > 0.0 ? normal(random) : 0.0));
      seen.a_frame.push_back(now[3] + (noise > 0.0 ? normal(random) : 0.0));
    }
    for (int j = 0; j < inner; ++j) {
      const double t = at + j * h;
      const State k1 = slope(t, s), k2 = slope(t + 0.5 * h, moved(s, k1, 0.5 * h)),
                  k3 = slope(t + 0.5 * h, moved(s, k2, 0.5 * h)), k4 = slope(t + h, moved(s, k3, h));
      for (std::size_t n = 0; n < s.size(); ++n)
        s[n] += h / 6.0 * (k1[n] + 2.0 * k2[n] + 2.0 * k3[n] + k4[n]);
    }
  }
  return seen;
}

} // namespace drumlin::test
