#include "support/harmonics.h"

#include <numeric>

namespace drumlin::post {

double compaction_meter_value(const HarmonicAmplitudes &amplitudes) {
  return 300.0 * amplitudes.second / amplitudes.fundamental;
}

double resonance_meter_value(const HarmonicAmplitudes &amplitudes, double constant) {
  return constant * amplitudes.half / amplitudes.fundamental;
}

double amplitude_over(const std::vector<std::complex<double>> &cycles, std::size_t first, std::size_t count) {
  const auto begin = cycles.begin() + static_cast<std::ptrdiff_t>(first);
  const std::complex<double> sum =
      std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(count), std::complex<double>());
  return std::abs(sum) / static_cast<double>(count);
}

} // namespace drumlin::post
