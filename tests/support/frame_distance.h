// How far the balls of two runs are apart.
#pragma once

#include "tests/support/engine_runs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace drumlin::test {

/// Largest distance of two states in position, m, over the frames; infinite if they have other steps or
/// balls.
inline double distance(const std::vector<Frame> &a, const std::vector<Frame> &b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double largest = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    if (a[n].step != b[n].step || a[n].balls.size() != b[n].balls.size())
      return std::numeric_limits<double>::infinity();
    for (const auto &[id, ball] : a[n].balls)
      for (std::size_t axis = 0; axis < 3; ++axis)
        largest = std::max(largest, std::fabs(ball.x[axis] - b[n].balls.at(id).x[axis]));
  }
  return largest;
}

} // namespace drumlin::test
