// Where a row of trials turns from stable to unstable.
#pragma once

#include <functional>
#include <vector>

namespace drumlin::post {

/// The last stable and the first unstable value that were tried.
struct StabilityBoundary {
  double stable = 0.0;
  double unstable = 0.0; ///< infinite if all were stable
  /// Whether every value tried above `unstable` was unstable too.
  bool single = true;
  double middle() const;
  /// unstable / stable - 1
  double relative_width() const;
};

/// Tries the values `low * ratio^n` from `low` to `high`, both included, all at once; one answer each, true:
/// stable.
using StabilityTrials = std::function<std::vector<bool>(double low, double high, int count)>;

/// Looks from `low` to `high` for the lowest boundary, by `count` trials in equal ratios and again between
/// the two that enclose it, until its relative width is at most `width`. A stable or unstable interval
/// narrower than the first spacing is not found. 0 < low < high, count > 2, width > 0. std::runtime_error if
/// low is unstable.
StabilityBoundary find_stability_boundary(const StabilityTrials &trials, double low, double high, int count,
                                          double width);

/// Longest stable w0 dt of a ball with `contacts` equal contacts along each direction in which it moves,
/// against fixed partners: where 4 M - 2 dt C - dt^2 K ceases to be positive definite with `stepping stock`,
/// w0 = sqrt(k/m) and D of one contact. contacts > 0, D >= 0.
double stock_stability_limit(int contacts, double D);
/// The same for an undamped ball, 2 / sqrt(contacts): the limit of the second-order scheme at any damping.
double spring_stability_limit(int contacts);

} // namespace drumlin::post
