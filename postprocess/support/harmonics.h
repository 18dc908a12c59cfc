// Amplitudes of the drum's acceleration at multiples of the excitation frequency, and the compaction meter
// values from them: one place for these formulas.
//
// A harmonic is a complex amplitude a_n = 2/T times the integral of a(t) exp(-i n omega t) over a time T, so
// that a(t) = |a_n| cos(n omega t + arg a_n) has the amplitude |a_n|.
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <vector>

namespace drumlin::post {

/// Multiples of the excitation frequency whose amplitudes meter values are made of.
constexpr std::array<double, 6> meter_orders = {0.5, 1.0, 1.5, 2.0, 2.5, 3.0};
constexpr std::size_t half_order = 0;
constexpr std::size_t basic_order = 1;
constexpr std::size_t double_order = 3;
/// Amplitudes of the drum's acceleration by meter_orders [m/s2].
using MeterAmplitudes = std::array<double, meter_orders.size()>;

/// A meter value: a constant times one sum of amplitudes over another. 1 for the orders that count.
struct MeterFormula {
  double constant = 0.0;
  MeterAmplitudes above{};
  MeterAmplitudes below{};
  double operator()(const MeterAmplitudes &amplitudes) const;
};

/// The constant of RMV; sources differ, some have 300.
constexpr double usual_rmv_constant = 100.0;

/// CMV = 300 A_2 / A_1 (-): Advances in Civil Engineering 2011, 783836, a review of such meters.
constexpr MeterFormula compaction_meter = {300.0, {0, 0, 0, 1, 0, 0}, {0, 1, 0, 0, 0, 0}};
/// RMV = `constant` A_0.5 / A_1 (-), of an even number of cycles.
constexpr MeterFormula resonance_meter(double constant = usual_rmv_constant) {
  return {constant, {1, 0, 0, 0, 0, 0}, {0, 1, 0, 0, 0, 0}};
}
/// CCV = 100 (A_0.5 + A_1.5 + A_2 + A_2.5 + A_3) / (A_0.5 + A_1) (-), of an even number of cycles: as NCHRP
/// Report 676 (Transportation Research Board 2010) is quoted; its own text could not be read.
constexpr MeterFormula compaction_control = {100.0, {1, 0, 1, 1, 1, 1}, {1, 1, 0, 0, 0, 0}};

/// Amplitudes of drum acceleration (m/s2) at 1, 2 and 1/2 times the excitation frequency.
struct HarmonicAmplitudes {
  double fundamental = 0.0;
  double second = 0.0;
  double half = 0.0;
};

/// CMV and RMV of these.
double compaction_meter_value(const HarmonicAmplitudes &amplitudes);
double resonance_meter_value(const HarmonicAmplitudes &amplitudes);

/// Amplitude over `count` cycles from `first` on of a signal whose harmonics over each single cycle are
/// given. Of a harmonic of half order `count` must be even.
double amplitude_over(const std::vector<std::complex<double>> &cycles, std::size_t first, std::size_t count);

} // namespace drumlin::post
