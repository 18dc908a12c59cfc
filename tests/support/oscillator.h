#pragma once
/// Closed form of the damped oscillator m x'' + c x' + k x = 0 by its two complex roots (any damping but the
/// critical one). Shares no code with the core.
#include "tests/support/prelude.h"

namespace oracle {

struct Motion {
  double x, v, a;
};

struct Oscillator {
  double m, k, c;

  /// Motion at time t from x(0) = x0, x'(0) = v0.
  [[nodiscard]] Motion at(double t, double x0, double v0) const {
    const std::complex<double> half = c / (2.0 * m);
    const std::complex<double> root = std::sqrt(half * half - k / m);
    const std::complex<double> s1 = -half + root;
    const std::complex<double> s2 = -half - root;
    const std::complex<double> p = (v0 - s2 * x0) / (s1 - s2) * std::exp(s1 * t);
    const std::complex<double> q = (s1 * x0 - v0) / (s1 - s2) * std::exp(s2 * t);
    return {(p + q).real(), (s1 * p + s2 * q).real(), (s1 * s1 * p + s2 * s2 * q).real()};
  }
};

} // namespace oracle
