// Runs of the chain in an engine at points of a map, and how far they agree with the closed-form solution
// there.
#pragma once

#include "engine/engine_command.h"
#include "map/regime_map.h"
#include "support/csv_schema.h"

#include <cstddef>
#include <string>
#include <vector>

namespace drumlin::post {

/// What a run in an engine comes to, beside the closed-form solution of the same point.
struct EnginePoint {
  double x = 0.0, y = 0.0;  ///< values of the two axes
  std::string exact;        ///< regime by the closed-form solution, as in regime_names
  std::string engine;       ///< regime of the run
  double exact_peak = 0.0;  ///< largest contact force of the motion reached [N]
  double engine_peak = 0.0; ///< the same of the run [N]
  double difference = 0.0;  ///< engine_peak over exact_peak minus 1 [-]; 0 if neither has a force
  int steps = 0;            ///< time steps of the run per cycle of the excitation

  bool same_regime() const { return exact == engine; }
};

/// The columns of a file of such points; the first two, with the names and units of the axes, name a row.
CsvSchema<EnginePoint> engine_point_columns(const MapGrid &grid);

/// The numbers of `count` points of a map, spread evenly over it: those next to the first points of
/// Halton's sequence of bases 2 and 3, each point once. More points begin with the same ones. All points,
/// in that order, if the map has no more than `count`.
std::vector<std::size_t> spread_points(const MapGrid &grid, std::size_t count);

/// Time steps per cycle of a run: 2000, or as many as make sqrt(k/m2) times the step no larger than 0.02.
int engine_steps(const ChainParameters &parameters);

/// The most time steps of one run, which take about ten seconds.
constexpr double most_engine_steps = 2e7;

/// Cycles at the end of a run from which its regime is taken.
constexpr std::size_t judged_cycles = 16;

/// The regime of a run. It is continuous contact if no contact was made or broken in the judged cycles;
/// else the period is the smallest number of cycles, up to longest_period, after which the state at the
/// start of each of the judged cycles had been the same within 1e-4 of state_scale(). Without a period
/// the motion counts as undecided if it still approaches one or has fewer than 48 cycles, else as
/// aperiodic.
/// \param states at the starts of all cycles and at the end
/// \param in_contact whether no contact was made or broken in the judged cycles
Regime regime_of_run(const std::vector<ChainState> &states, bool in_contact, const ChainState &scale);

/// Runs the chain of a point in an engine for as many cycles as the map has, from static equilibrium, and
/// compares it. Peak forces are those of the last 64 cycles, or of all if there are fewer.
/// std::runtime_error with the engine's message if the run fails.
EnginePoint run_engine_point(const MapGrid &grid, std::size_t point, const RegimePoint &exact, Engine engine);

} // namespace drumlin::post
