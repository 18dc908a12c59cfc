// The runs of the accuracy study: the chain and single impacts at many step sizes, each compared with its
// reference solution.
#pragma once

#include "chain/direct_solver.h"
#include "chain/parameters.h"
#include "engine/deck_run.h"

#include <string>

namespace drumlin::post {

/// What the chain's runs have in common.
constexpr int accuracy_cycles = 30;  ///< of each run
constexpr int accuracy_window = 5;   ///< the last cycles, over which errors count
constexpr int accuracy_samples = 50; ///< rows per cycle

/// The errors of a run of the chain; NaN where they were not measured.
struct ChainErrors {
  double velocity;       ///< relative RMS of the drum's velocity over the window
  double force;          ///< of the peak contact force over the window, relative
  double acceleration;   ///< of the largest magnitude of the drum's acceleration over the window, relative
  long events;           ///< makes and breaks in the run
  long events_reference; ///< in the reference solution
  double event_time_s;   ///< largest error of the time of an event; NaN if the events do not match one by one
  double energy;         ///< energy error of the run over the work of the exciter, >= 0
  double loop_s;         ///< time of the cycles, by the engine's clock
  double wall_s;         ///< time of the whole process, with finding the equilibrium
};

/// The reference solution to which the runs of a chain are compared, by the direct solver.
DirectResult accuracy_reference(const ChainParameters &parameters, const SolverProgress &progress = {});

/// Runs in.chain. \param stepping "second" or "stock"
ChainErrors measure_chain(const ChainParameters &parameters, const std::string &stepping, int steps_per_cycle,
                          const DirectResult &reference);

/// Runs a case of Table 1 by the engine's own contact law: velocity error and times only.
ChainErrors measure_engine_law(const std::string &case_name, int steps_per_cycle,
                               const DirectResult &reference);

/// Errors of the restitution over the phases of the onset, absolute.
struct ImpactErrors {
  double worst;
  double rms;
};
ImpactErrors measure_impacts(Transition transition, double damping_ratio, const std::string &stepping,
                             double steps_per_contact, int phases);
/// The same of a run of study/in.impacts, at this speed, m/s.
ImpactErrors impact_errors(const DeckRun &run, int phases, Transition transition, double damping_ratio,
                           double speed);

} // namespace drumlin::post
