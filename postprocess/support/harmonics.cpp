#include "support/harmonics.h"

#include <numeric>

namespace drumlin::post {

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
