// What a sampled record does not say of the drum's acceleration: when between two samples it jumps, as it
// does when the drum lands.
//
// A sum over samples takes a jump of height J, at a share s of the interval h, as if it were in the middle of
// the interval. After Euler and Maclaurin the integral of a(t) exp(-i w t) is off by
//     samples of acceleration (trapezoidal rule)   J h B_1(s),            B_1(s) = s - 1/2
//     changes of velocity                          J h (w h / 2) B_2(s),  B_2(s) = s^2 - s + 1/6
// times a phase that is known. s is not known, but in a periodic motion it goes on by the same share from
// cycle to cycle, so that one unknown number remains.
#pragma once

#include "record/record.h"
#include "support/statistics.h"

#include <complex>
#include <cstddef>
#include <vector>

namespace drumlin::post {

/// What the harmonics of the drum's acceleration are computed from.
enum class HarmonicSource {
  every_step,  ///< sums over every time step, of cycles.csv: orders 0.5, 1 and 2 only
  velocity,    ///< changes of velocity between samples, which contain the whole impulse of a make
  acceleration ///< samples of acceleration, of which a make's jump may lie anywhere between two
};

/// A jump of the drum's acceleration between two samples.
struct AccelerationJump {
  double time = 0.0; ///< half-way between them [s]
  double size = 0.0; ///< [m/s2]
};

/// Where a record's signal is not smooth.
struct SignalFaults {
  std::vector<AccelerationJump> jumps; ///< in the order of time
  std::vector<double> differences; ///< of each interval: its jump, or what curvature and noise make [m/s2]
  double noise = 0.0; ///< standard deviation of white noise of the samples [m/s2, of velocities m/s]
};

/// Jumps are third differences of the acceleration, five times as large as noise and curvature make them.
SignalFaults faults_of(const Record &record, HarmonicSource source);

/// What the error of harmonics over some cycles depends on.
struct SampledCycles {
  HarmonicSource source = HarmonicSource::acceleration;
  double omega = 0.0;                  ///< [rad/s]
  double interval = 0.0;               ///< between samples [s]
  int cycles = 0;                      ///< even
  std::vector<AccelerationJump> jumps; ///< in these cycles
  double end_jumps = 0.0;              ///< largest differences at the ends of the cycles, summed [m/s2]
  double noise = 0.0;                  ///< as in SignalFaults
  std::array<std::complex<double>, meter_orders.size()> harmonics{}; ///< [m/s2]
};

/// How far a meter value may be off by the sampling and by noise. Jumps that return every cycle or every
/// second one: the largest error for any s. Other jumps: three standard deviations, s being any value between
/// 0 and 1. Noise: three standard deviations. May be infinite.
double sampling_bound(const MeterFormula &formula, const SampledCycles &cycles);

} // namespace drumlin::post
