// The chain solved as ordinary differential equations, without any engine: the truth beside every engine run.
// CVODE integrates the smooth pieces between events; its root finding locates the events; each event restarts
// it.
#pragma once

#include "chain/parameters.h"
#include "chain/run_files.h"

#include <functional>
#include <string>
#include <vector>

namespace drumlin::post {

/// How long to solve, what to record, how exactly.
struct DirectOptions {
  double cycles = 30.0;        ///< cycles of the excitation, from t = 0
  int samples_per_cycle = 200; ///< rows of the history per cycle; the first is at t = 0
  double rtol = 1e-12; ///< relative tolerance of the integrator, 1e-14 to 1e-3; absolute ones follow it
  /// If positive: start at x_drum = 0 moving down at this speed [m/s], the frame with it and the bond
  /// unstretched (a roller in free fall), instead of at static equilibrium.
  double impact_speed = 0.0;

  /// Empty if usable; else one line that names the option, its value and what is allowed.
  std::string invalid() const;

  static const Range cycles_range, rtol_range, impact_speed_range;
  static constexpr int most_samples = 1'000'000; ///< per cycle
};

/// As many cycles of a chain as can be solved within minutes: one that moves very much faster than it is excited needs very many steps
/// per cycle.
double most_cycles(const ChainParameters &parameters);

/// Empty if the options ask for no more cycles than that; else one line that names them and how many are allowed.
std::string too_much_work(const ChainParameters &parameters, const DirectOptions &options);

/// Told now and then which share of the time to solve is done, from 0 to 1.
using SolverProgress = std::function<void(double)>;

/// What the solver cost.
struct DirectCost {
  long steps = 0;    ///< steps of the integrator
  long restarts = 0; ///< smooth pieces, the first included
  bool bdf = false;  ///< whether any piece was stiff and went to BDF instead of Adams
};

struct DirectResult {
  ChainHistory history;             ///< samples at i period / samples_per_cycle
  std::vector<ContactEvent> events; ///< id_i 1 is the soil, id_j 2 the drum
  std::vector<CycleSummary> cycles; ///< one for each complete cycle
  DirectCost cost;
};

/// Solves the chain. Starts from static equilibrium
///     x2 = -(m2 + m3) g / k,  x3 = x2 - m3 g / k23,  v2 = v3 = 0
/// or as an impact. A contact that begins at t = 0 with d = 0 (impact, or excitation without gravity) is
/// logged as made at t = 0; one that overlaps at t = 0 is not. std::invalid_argument for parameters or
/// options that cannot be used, std::runtime_error if the integrator fails.
DirectResult solve_direct(const ChainParameters &parameters, const DirectOptions &options,
                          const SolverProgress &progress = {});

/// Name and version of the integrator, for the record.
std::string direct_solver_name();

} // namespace drumlin::post
