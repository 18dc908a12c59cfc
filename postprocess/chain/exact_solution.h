// The exact solution of the chain soil - drum - frame and of a drum with two ends: their differential
// equations solved without an engine, in closed form from one make or break of a contact (event) to the next.
// Runs of an engine are compared with it.
#pragma once

#include "chain/driven_way.h"
#include "chain/parameters.h"
#include "runs/chain_files.h"

#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace drumlin::post {

/// Length of the solution, its start and its rows.
struct ExactOptions {
  double cycles = 30.0;        ///< cycles of the excitation, from t = 0
  int samples_per_cycle = 200; ///< rows of the history per cycle; the first is at t = 0
  /// If positive: start at x_drum = 0 moving down at this speed [m/s], the frame with it and the bond
  /// unstretched (a roller that falls onto the soil), instead of at static equilibrium.
  double impact_speed = 0.0;
  /// Where a roller drives: the soil it meets, from t = 0 to the end at least; k and D of the chain are then
  /// without effect. Empty: it stands.
  std::vector<WaySection> way;

  /// Empty if usable; else one line that names the option, its value and what is allowed.
  std::string invalid() const;

  // The solution ends at a point of a grid that divides each sample into at least 2000 parts of a cycle, so
  // that a number of cycles that rounding makes slightly too small has its last row.
  long points_per_sample() const { return (2000 + samples_per_cycle - 1) / samples_per_cycle; }
  long points_per_cycle() const { return samples_per_cycle * points_per_sample(); }
  long last_point() const { return std::llround(cycles * static_cast<double>(points_per_cycle())); }

  static constexpr std::size_t most_events = 5'000'000; ///< of a solution: a quarter of a gigabyte
  static constexpr double most_pieces = 2e7;            ///< of a solution: no more than a minute
  static const Range cycles_range, impact_speed_range;
  static constexpr int most_samples = 1'000'000; ///< per cycle
};

/// Called from time to time with the share of the solution that is done, from 0 to 1.
using SolverProgress = std::function<void(double)>;

struct ExactSolution {
  ChainHistory history;             ///< samples at i period / samples_per_cycle
  std::vector<ContactEvent> events; ///< id_i 1 is the soil, id_j 2 the drum
  std::vector<CycleSummary> cycles; ///< one for each complete cycle
  long pieces = 0;                  ///< of the motion: the computing effort
};

/// The largest number of cycles of a chain, one that does not drive, that can be solved within minutes. The
/// solution is computed in pieces that must be short beside the fastest vibration and decay of the machine,
/// so that a machine much faster than its exciter has few cycles. One decay, the fastest, does not count:
/// that of a heavily damped contact or bond has a closed form.
double most_cycles(const ChainParameters &parameters);

/// Empty if the options have no more cycles than can be solved within minutes; else one line that names their
/// number and how many are allowed.
std::string too_much_work(const ChainParameters &parameters, const ExactOptions &options);

/// Solves the chain. Starts from static equilibrium
///     x2 = -(m2 + m3) g / k,  x3 = x2 - m3 g / k23,  v2 = v3 = 0
/// or as an impact. A contact that begins at t = 0 with d = 0 (impact, or excitation without gravity) has an
/// event, a make, at t = 0; a contact that already overlaps at t = 0 has none. Throws std::invalid_argument
/// for parameters or options that cannot be used.
ExactSolution solve_chain(const ChainParameters &parameters, const ExactOptions &options,
                          const SolverProgress &progress = {});
/// Whole cycles from static equilibrium.
/// \param lead cycles before the first sample, in which the motion settles
ExactSolution solve_chain(const ChainParameters &parameters, int cycles, int samples_per_cycle, int lead = 0);

} // namespace drumlin::post
