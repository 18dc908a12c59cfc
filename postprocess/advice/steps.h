// How many steps per cycle a chain needs for an error: the measured curves of the accuracy study, scaled to
// chains that were not measured.
//
// The scaling: with the resolution h = dt max(w0, omega), w0 = sqrt(k/m2), a scheme of order p has the error
//   error = C S h^p,
// S the sensitivity of the chain: how much a relative change of its parameters grows up to the cycles in
// which the error counts. An error of the scheme acts like such a change, so that two chains with the same S
// and h have about the same error, and a chain in which disturbances decay slowly has a larger one. C is the
// largest of the measured curves of the same transition and stepping, and differs between them with damping,
// contact share and chance: the margin covers that.
#pragma once

#include "chain/exact_solution.h"
#include "chain/parameters.h"
#include "experiment/exact_quantities.h"
#include "support/statistics.h"
#include "support/csv_schema.h"

#include <functional>
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

/// One row of scaling.csv: a chain with random parameters, run with the number of steps that advise() gives.
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

/// Whose error: the first relative RMS over the last 5 of 30 cycles, the others of the peak in these cycles.
enum class ErrorMeasure { velocity, force, acceleration };

struct AdviceRequest {
  ChainParameters parameters;
  std::string stepping = "second"; ///< second or stock
  ErrorMeasure measure = ErrorMeasure::velocity;
  double error = 1e-3; ///< relative, > 0
};

struct StepAdvice {
  int steps_per_cycle = 0;       ///< a multiple of advised_multiple
  std::string from;              ///< case whose curve decided
  bool measured = false;         ///< the chain is that case itself, within the measured steps
  double sensitivity = 0.0;      ///< S of the chain; 0 if it was not asked for, the chain being measured
  double critical_steps = 0.0;   ///< steps per cycle at the stability limit, contact closed
  double seconds_per_step = 0.0; ///< where the curves were measured
};

/// Safety factor on the steps of a scaled curve.
constexpr double scaling_margin = 2.0;
/// Safety factor on the steps at the stability limit.
constexpr double stability_margin = 2.0;
/// The default samples per cycle of in.chain.
constexpr int advised_multiple = 200;
/// Above this sensitivity disturbances do not decay within a run: no time step gives the chain's motion,
/// though it may give its averages.
constexpr double most_sensitive = 1e5;

/// S: the relative RMS change of the drum's velocity over the last 5 of 30 cycles per relative change of k, D
/// and m2, root of the sum of squares, of exact solutions.
/// \param progress called with the share of the work that is done, 0 to 1
double sensitivity(const ChainParameters &parameters, const SolverProgress &progress = {});

/// The lowest omega, rad/s, with which sensitivity() of a chain takes no more than minutes.
double slowest_excitation(const ChainParameters &parameters);

/// Steps per cycle at the longest stable step of the chain with the contact closed: 4 M - 2 dt C - dt^2 K
/// ceases to be positive definite; with second-order stepping, which solves for the dashpots, without C.
double critical_steps(const ChainParameters &parameters, const std::string &stepping);

/// \param points of an accuracy study
/// \param sensitivity_of called in place of sensitivity(), e.g. to store its results or to print its progress
/// Throws UsageError if no number of steps can be advised: no curve, too sensitive, or more steps than the
/// engine can count.
StepAdvice advise(const AdviceRequest &request, const std::vector<ChainPoint> &points,
                  const std::function<double(const ChainParameters &)> &sensitivity_of = {});

/// Which of sqrt(k/m2), omega and D of a chain are outside of the range in which the scaling was tested;
/// empty if none is, or if it was not tested.
std::string outside_of_tests(const ChainParameters &parameters, const std::vector<ScalingPoint> &points);

/// One sentence on the errors measured in runs with the advised steps.
std::string scaling_summary(const std::vector<ScalingPoint> &points);

} // namespace drumlin::post
