#include "support/convergence.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace drumlin::post {

double finer_half(const std::vector<ErrorPoint> &points) {
  return std::sqrt(points.front().steps * points.back().steps);
}

std::optional<FittedOrder> fitted_order(const std::vector<ErrorPoint> &points, double from) {
  std::vector<ErrorPoint> used;
  std::copy_if(points.begin(), points.end(), std::back_inserter(used), [&](const ErrorPoint &point) {
    return point.steps >= from && std::isfinite(point.error) && point.error > 0.0;
  });
  if (used.size() < 3) return std::nullopt;
  const auto count = static_cast<double>(used.size());
  double x_mean = 0.0, y_mean = 0.0;
  for (const ErrorPoint &point : used) {
    x_mean += std::log10(point.steps) / count;
    y_mean += std::log10(point.error) / count;
  }
  double xx = 0.0, xy = 0.0;
  for (const ErrorPoint &point : used) {
    const double x = std::log10(point.steps) - x_mean;
    xx += x * x;
    xy += x * (std::log10(point.error) - y_mean);
  }
  const double slope = xy / xx;
  double residual = 0.0;
  for (const ErrorPoint &point : used) {
    const double line = y_mean + slope * (std::log10(point.steps) - x_mean);
    residual += std::pow(std::log10(point.error) - line, 2) / count;
  }
  return FittedOrder{-slope, std::sqrt(residual), used.front().steps, used.back().steps};
}

std::vector<ErrorPoint> envelope(std::vector<ErrorPoint> points) {
  double largest = 0.0;
  for (auto point = points.rbegin(); point != points.rend(); ++point) {
    largest = std::isfinite(point->error) ? std::max(largest, point->error)
                                          : std::numeric_limits<double>::infinity();
    point->error = largest;
  }
  return points;
}

std::optional<double> steps_needed(const std::vector<ErrorPoint> &points, double error) {
  for (const ErrorPoint &point : envelope(points))
    if (point.error <= error) return point.steps;
  return std::nullopt;
}

std::optional<double> steps_for(const std::vector<ErrorPoint> &points, double error, double order) {
  std::vector<ErrorPoint> known = envelope(points);
  known.erase(std::remove_if(known.begin(), known.end(),
                             [](const ErrorPoint &p) { return !std::isfinite(p.error) || p.error <= 0.0; }),
              known.end());
  if (known.empty()) return std::nullopt;
  const auto beyond = [&](const ErrorPoint &end) {
    return end.steps * std::pow(end.error / error, 1.0 / order);
  };
  if (error >= known.front().error) return beyond(known.front());
  for (std::size_t i = 1; i < known.size(); ++i) {
    const ErrorPoint &low = known[i - 1], &high = known[i];
    if (error < high.error) continue;
    return low.steps *
           std::pow(high.steps / low.steps, std::log(low.error / error) / std::log(low.error / high.error));
  }
  return beyond(known.back());
}

} // namespace drumlin::post
