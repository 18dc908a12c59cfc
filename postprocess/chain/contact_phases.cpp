#include "chain/contact_phases.h"

#include "support/statistics.h"

#include <algorithm>
#include <cmath>

namespace drumlin::post {

double DrumSignals::force_at(std::size_t sample, double delta) const {
  return force[sample] + excitation[sample] * (std::cos(delta) - 1.0) + quadrature[sample] * std::sin(delta);
}

double noise_level(const std::vector<double> &signal) {
  constexpr std::size_t least = 8;
  if (signal.size() < least) return 0.0;
  std::vector<double> sizes;
  sizes.reserve(signal.size() - 3);
  for (std::size_t i = 3; i < signal.size(); ++i)
    sizes.push_back(std::fabs(signal[i] - 3.0 * signal[i - 1] + 3.0 * signal[i - 2] - signal[i - 3]));
  // A third difference of white noise has 1 + 9 + 9 + 1 times its variance; the median of the absolute value
  // of a normal variable is 0.6745 standard deviations.
  constexpr double of_median = 0.6744897501960817;
  return median(std::move(sizes)) / (of_median * std::sqrt(20.0));
}

std::vector<double> force_limits(const DrumSignals &signals, double delta, double within) {
  double peak = 0.0;
  for (std::size_t i = 0; i < signals.size(); ++i)
    peak = std::max(peak, std::fabs(signals.force_at(i, delta)));
  const double noise = 4.0 * noise_level(signals.force) + 1e-3 * peak;
  std::vector<double> limits(signals.size());
  for (std::size_t i = 0; i < limits.size(); ++i)
    limits[i] = noise + within * std::fabs(signals.quadrature[i]);
  return limits;
}

std::vector<SampleRun> loaded_runs(const DrumSignals &signals, const std::vector<double> &limits,
                                   double share) {
  double least = 0.0;
  for (const double force : signals.force)
    least = std::max(least, share * std::fabs(force));
  std::vector<SampleRun> runs;
  std::size_t first = 0;
  for (std::size_t i = 0; i <= signals.size(); ++i) {
    if (i < signals.size() && std::fabs(signals.force[i]) > std::max(limits[i], least)) continue;
    if (i - first >= least_contact) runs.push_back({first, i});
    first = i + 1;
  }
  return runs;
}

namespace {

// Integral of values[i] over time, zero at the first: over each interval that of the cubic through the four
// nearest values.
std::vector<double> integral(const std::vector<double> &values, double dt) {
  const std::size_t n = values.size();
  std::vector<double> sum(n, 0.0);
  const auto at = [&](std::size_t i) { return values[i]; };
  for (std::size_t i = 1; i < n; ++i) {
    double mean = 0.5 * (at(i - 1) + at(i));
    if (n >= 4) {
      if (i == 1)
        mean = (9.0 * at(0) + 19.0 * at(1) - 5.0 * at(2) + at(3)) / 24.0;
      else if (i == n - 1)
        mean = (9.0 * at(i) + 19.0 * at(i - 1) - 5.0 * at(i - 2) + at(i - 3)) / 24.0;
      else
        mean = (13.0 * (at(i - 1) + at(i)) - at(i - 2) - at(i + 1)) / 24.0;
    }
    sum[i] = sum[i - 1] + dt * mean;
  }
  return sum;
}

} // namespace

Integrals integrals(const std::vector<double> &signal, const SampleRun &run, double dt) {
  const auto begin = signal.begin() + static_cast<std::ptrdiff_t>(run.first);
  Integrals result;
  result.once = integral({begin, begin + static_cast<std::ptrdiff_t>(run.size())}, dt);
  result.twice = integral(result.once, dt);
  return result;
}

} // namespace drumlin::post
