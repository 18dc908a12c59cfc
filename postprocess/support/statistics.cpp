#include "support/statistics.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

// Boost.Math has quantiles of distributions, not of samples.
double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

double rms(const std::vector<double> &values) {
  const double squares = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
  return values.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(values.size()));
}

Spread spread(const std::vector<double> &values) {
  return {median(values), quantile(values, 0.25), quantile(values, 0.75)};
}

bool MeanInterval::significant() const { return std::fabs(mean) > half_width; }

bool MeanInterval::within(double bound) const { return std::fabs(mean) + half_width <= bound; }

double t_factor(double freedom) {
  constexpr double upper_tail = 0.025; // as much as the lower one
  return boost::math::quantile(
      boost::math::complement(boost::math::students_t_distribution<double>(freedom), upper_tail));
}

double half_width_of_sum(const Variance &one, const Variance &other) {
  const double variance = one.value + other.value;
  if (!(one.freedom > 0.0 && other.freedom > 0.0)) return std::numeric_limits<double>::infinity();
  if (!(variance > 0.0)) return 0.0;
  const double freedom =
      variance * variance / (one.value * one.value / one.freedom + other.value * other.value / other.freedom);
  return t_factor(freedom) * std::sqrt(variance);
}

MeanError mean_error(const std::vector<double> &values) {
  if (values.empty()) throw std::invalid_argument("a mean of no values");
  const auto n = static_cast<double>(values.size());
  double mean = 0.0;
  for (const double value : values)
    mean += value / n;
  double squares = 0.0;
  for (const double value : values)
    squares += (value - mean) * (value - mean);
  return {mean, {squares / (n * (n - 1.0)), n - 1.0}};
}

ScatterInterval scatter_interval(const std::vector<double> &values) {
  const MeanError error = mean_error(values);
  const double freedom = error.variance.freedom;
  if (!(freedom > 0.0)) return {0.0, 0.0, std::numeric_limits<double>::infinity()};
  const double estimate = std::sqrt(error.variance.value * static_cast<double>(values.size()));
  constexpr double tail = 0.025; // on each side
  const boost::math::chi_squared_distribution<double> distribution(freedom);
  const double highest = boost::math::quantile(boost::math::complement(distribution, tail)),
               lowest = boost::math::quantile(distribution, tail);
  return {estimate, estimate * std::sqrt(freedom / highest), estimate * std::sqrt(freedom / lowest)};
}

MeanInterval mean_interval(const std::vector<double> &values) {
  const auto [mean, variance] = mean_error(values);
  if (!(variance.freedom > 0.0)) return {mean, std::numeric_limits<double>::infinity()};
  return {mean, t_factor(variance.freedom) * std::sqrt(variance.value)};
}

MeanInterval mean_difference(const std::vector<double> &values, const std::vector<double> &others) {
  const MeanError one = mean_error(values), other = mean_error(others);
  return {one.mean - other.mean, half_width_of_sum(one.variance, other.variance)};
}

LineFit fit_line(const std::vector<double> &x, const std::vector<double> &y) {
  if (x.size() != y.size() || x.size() < 3)
    throw std::invalid_argument("a line through less than three points");
  const auto n = static_cast<double>(x.size());
  const double mean_x = mean_interval(x).mean, mean_y = mean_interval(y).mean;
  double xx = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  if (!(xx > 0.0)) throw std::invalid_argument("a line through points above each other");
  const double slope = xy / xx, intercept = mean_y - slope * mean_x;
  double squares = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
    squares += std::pow(y[i] - intercept - slope * x[i], 2);
  const double half = t_factor(n - 2.0) * std::sqrt(squares / (n - 2.0));
  return {{slope, half / std::sqrt(xx)}, {intercept, half * std::sqrt(1.0 / n + mean_x * mean_x / xx)}};
}

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

double MeterFormula::operator()(const MeterAmplitudes &amplitudes) const {
  return constant * std::inner_product(above.begin(), above.end(), amplitudes.begin(), 0.0) /
         std::inner_product(below.begin(), below.end(), amplitudes.begin(), 0.0);
}

namespace {

MeterAmplitudes by_orders(const HarmonicAmplitudes &amplitudes) {
  MeterAmplitudes all{};
  all[half_order] = amplitudes.half;
  all[basic_order] = amplitudes.fundamental;
  all[double_order] = amplitudes.second;
  return all;
}

} // namespace

double compaction_meter_value(const HarmonicAmplitudes &amplitudes) {
  return compaction_meter(by_orders(amplitudes));
}

double resonance_meter_value(const HarmonicAmplitudes &amplitudes) {
  return resonance_meter()(by_orders(amplitudes));
}

double amplitude_over(const std::vector<std::complex<double>> &cycles, std::size_t first, std::size_t count) {
  const auto begin = cycles.begin() + static_cast<std::ptrdiff_t>(first);
  const std::complex<double> sum =
      std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(count), std::complex<double>());
  return std::abs(sum) / static_cast<double>(count);
}

} // namespace drumlin::post
