// Amplitudes of the drum's acceleration at multiples of the excitation frequency, and the compaction meter
// values from them: one place for these formulas.
//
// A harmonic is a complex amplitude a_n = 2/T times the integral of a(t) exp(-i n omega t) over a time T, so
// that a(t) = |a_n| cos(n omega t + arg a_n) has the amplitude |a_n|.
#pragma once

#include <complex>
#include <cstddef>
#include <vector>

namespace drumlin::post {

/// Amplitudes of drum acceleration (m/s2) at 1, 2 and 1/2 times the excitation frequency.
struct HarmonicAmplitudes {
  double fundamental = 0.0;
  double second = 0.0;
  double half = 0.0;
};

/// Compaction meter value CMV = 300 A_2 / A_1 (-): Advances in Civil Engineering 2011, 783836, a review of
/// such meters.
double compaction_meter_value(const HarmonicAmplitudes &amplitudes);

/// The constant of RMV; sources differ, some have 300.
constexpr double usual_rmv_constant = 100.0;

/// Resonance meter value RMV = `constant` A_0.5 / A_1 (-), of an even number of cycles.
double resonance_meter_value(const HarmonicAmplitudes &amplitudes, double constant = usual_rmv_constant);

/// Amplitude over `count` cycles from `first` on of a signal whose harmonics over each single cycle are
/// given. Of a harmonic of half order `count` must be even.
double amplitude_over(const std::vector<std::complex<double>> &cycles, std::size_t first, std::size_t count);

} // namespace drumlin::post
