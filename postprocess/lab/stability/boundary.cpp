#include "lab/stability/boundary.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <stdexcept>

namespace drumlin::post {

double StabilityBoundary::middle() const { return std::sqrt(stable * unstable); }
double StabilityBoundary::relative_width() const { return unstable / stable - 1.0; }

StabilityBoundary find_stability_boundary(const StabilityTrials &trials, double low, double high, int count,
                                          double width) {
  StabilityBoundary boundary;
  boundary.stable = low;
  boundary.unstable = high;
  while (boundary.relative_width() > width) {
    const double first = boundary.stable;
    const double ratio = boundary.unstable / first;
    const std::vector<bool> stable = trials(first, boundary.unstable, count);
    const auto turn = std::find(stable.begin(), stable.end(), false);
    if (turn == stable.begin())
      throw std::runtime_error(fmt::format("unstable at the lowest value tried, {:g}", first));
    if (turn == stable.end()) {
      boundary.stable = boundary.unstable;
      boundary.unstable = std::numeric_limits<double>::infinity();
      return boundary;
    }
    const auto value = [&](auto place) {
      return first *
             std::pow(ratio, static_cast<double>(place - stable.begin()) / static_cast<double>(count - 1));
    };
    boundary.single = boundary.single && std::find(turn, stable.end(), true) == stable.end();
    boundary.stable = value(turn - 1);
    boundary.unstable = value(turn);
  }
  return boundary;
}

double stock_stability_limit(int contacts, double D) {
  // The positive root of n s^2 + 4 n D s = 4 without cancellation.
  const double n = contacts;
  return 2.0 / (n * (D + std::sqrt(D * D + 1.0 / n)));
}

double spring_stability_limit(int contacts) { return stock_stability_limit(contacts, 0.0); }

} // namespace drumlin::post
