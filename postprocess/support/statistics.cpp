#include "support/statistics.h"

#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
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

MeanInterval mean_interval(const std::vector<double> &values) {
  if (values.empty()) throw std::invalid_argument("a mean of no values");
  const auto n = static_cast<double>(values.size());
  double mean = 0.0;
  for (const double value : values)
    mean += value / n;
  double squares = 0.0;
  for (const double value : values)
    squares += (value - mean) * (value - mean);
  if (values.size() < 2) return {mean, std::numeric_limits<double>::infinity()};
  return {mean, t_factor(n - 1.0) * std::sqrt(squares / (n * (n - 1.0)))};
}

} // namespace drumlin::post
