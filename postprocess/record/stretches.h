// Stretches of a record in which the exciter keeps one frequency, force and phase.
#pragma once

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

} // namespace drumlin::post
