// A roller that drives: its place along the way as a function of time, and k and D of the soil there. They
// depend on the place alone, not on the overlap. Where k grows along the way, the drive of the roller
// therefore does work on the contact spring: the integral of k'(s) d^2 / 2 over the distance.
#pragma once

#include "files/way.h"

#include <string>
#include <vector>

namespace drumlin::post {

/// A stretch of time in which k and D of the contact, and k of each half of the drum, are linear in time.
struct WaySection {
  double begin = 0.0, end = 0.0;  ///< since the start of the excitation [s]
  double k = 0.0, k_rate = 0.0;   ///< at its start [N/m], and per time [N/(m s)]
  double D = 0.0, D_rate = 0.0;   ///< at its start [-], and per time [1/s]
  double s = 0.0, velocity = 0.0; ///< place at its start [m]; negative on the way back [m/s]
  int pass = 1;                   ///< counted from 1
  /// Part of k below the end of the drum that is the left one on the way forth: at its start [N/m], and per
  /// time [N/(m s)].
  double k_left = 0.0, k_left_rate = 0.0;

  bool constant() const { return k_rate == 0.0 && D_rate == 0.0 && k_left_rate == 0.0; }
  double place(double time) const { return s + velocity * (time - begin); }
  /// The part of this section that the roller passes after `time`.
  WaySection from(double time) const;
};

/// How a roller comes back: in reverse, so that each end of the drum keeps its side of the way, or turned
/// round, so that the ends change sides.
enum class WayBack { in_reverse, turned_round };

/// The sections of `passes` over the whole way at a constant speed [m/s]: forth, and back with the next, and
/// so on; it turns without delay. In the order of time, without gaps.
std::vector<WaySection> drive(const Way &way, double speed, int passes, WayBack back = WayBack::in_reverse);

/// Soil whose stiffness is a random field along the way: log-normal, ln k with the correlation
/// exp(-distance / length).
struct RandomSoil {
  double mean = 0.0;        ///< of k [N/m]
  double variation = 0.0;   ///< coefficient of variation of k, standard deviation over mean [-]
  double correlation = 0.0; ///< length of correlation [m]
  double D = 0.0;           ///< damping ratio, everywhere the same [-]
  double ratio = 1.0;       ///< of k below the left half of the drum over that below the right one [-]
  double from = 0.0, to = 0.0, step = 0.0; ///< places of the rows [m]; the last one is `to`
  unsigned seed = 1;
};

/// The rows of one realization; the same on every machine but for rounding.
Way random_way(const RandomSoil &soil);

/// The text of a way's file.
std::string way_text(const Way &way);

} // namespace drumlin::post
