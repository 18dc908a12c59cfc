// The errors of runs of the chain over their time steps: what `drumlin advise` reads of chain.csv and
// scaling.csv, tables of inputs/study/accuracy/plan. Errors are relative, without unit. A number that was not
// measured is an empty cell, NaN here.
#pragma once

#include "chain/exact_solution.h"
#include "chain/parameters.h"
#include "experiment/exact_quantities.h"
#include "support/convergence.h"
#include "support/csv_schema.h"

#include <string>
#include <vector>

namespace drumlin::post {

/// What the chain's runs have in common.
constexpr int accuracy_cycles = 30;                  ///< of each run
constexpr int accuracy_window = steady_error_cycles; ///< the last cycles, over which errors count
constexpr int accuracy_samples = 50;                 ///< rows per cycle

/// The errors of a run of the chain; NaN where they were not measured.
struct ChainErrors {
  double velocity;     ///< relative RMS of the drum's velocity over the window
  double force;        ///< of the peak contact force over the window, relative
  double acceleration; ///< of the largest magnitude of the drum's acceleration over the window, relative
  double loop_s;       ///< wall time of the cycles as the engine prints it (loop time) [s]
};

/// The exact solution to which the runs of a chain are compared.
ExactSolution accuracy_reference(const ChainParameters &parameters, const SolverProgress &progress = {});

/// One row of chain.csv. The first four name the point.
struct ChainPoint {
  std::string chain_case; ///< I to IV
  Transition transition = Transition::B;
  std::string stepping; ///< second, stock or reference (the engine's own law)
  int steps_per_cycle = 0;
  ChainErrors errors{};
};

/// One row of scaling.csv: a chain with random parameters, run with the number of steps that `drumlin advise`
/// gives for it.
struct ScalingPoint {
  std::string stepping; ///< second or stock
  double target = 0.0;  ///< error that was asked for
  ChainParameters parameters;
  int steps_per_cycle = 0; ///< advised
  double error = 0.0;      ///< found: relative RMS of the drum's velocity
};

/// The columns of the files, of which the first name the point, and there may be more.
const CsvSchema<ChainPoint> &chain_points();
const CsvSchema<ScalingPoint> &scaling_points();

/// The errors of one kind over the steps per cycle, in order of steps.
std::vector<ErrorPoint> chain_curve(const std::vector<ChainPoint> &points, const std::string &chain_case,
                                    Transition transition, const std::string &stepping,
                                    double ChainErrors::*error);

} // namespace drumlin::post
