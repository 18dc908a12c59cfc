// Stretches of a record in which the exciter keeps one frequency, force and phase; samples that the range of
// a sensor has cut.
#pragma once

#include "record/record.h"

#include <cstddef>
#include <vector>

namespace drumlin::post {

/// Samples from `first` to before `end`.
struct Stretch {
  std::size_t first, end;
  double omega; ///< mean angular frequency of the line there [rad/s]
};

/// Cuts a signal of the drum, or the exciter's force, where the line of the exciter stands still, begins,
/// fades, or changes its size, phase or frequency within a second or so. Slow changes, as of soil along the
/// way, and a motion that repeats every second cycle or never do not cut. What lasts less than 11 cycles is
/// left out, unless it is all of the signal; nothing comes back if the signal has no line of the exciter.
/// \param interval between samples [s]
/// \param nominal angular frequency of the exciter [rad/s], true to some per cent
std::vector<Stretch> stretches_of(const std::vector<double> &signal, double interval, double nominal);

/// Share of the values that are at a limit of the sensor, at the highest of them or at the lowest. Where a
/// signal turns, values lie close together, too, but not this close: within a narrow range at its end there
/// are about three times as many as in the next one. Noise behind the limit, and steps of the sensor, are
/// allowed for.
struct AtLimit {
  double high = 0.0, low = 0.0;
};
AtLimit share_at_limit(const std::vector<double> &values);

/// Refuses a measured record with an acceleration that stands still or is at the limit of its sensor;
/// std::runtime_error of one line.
void check_sensors(const Record &record);

} // namespace drumlin::post
