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

#include "advice/step_errors.h"
#include "chain/exact_solution.h"
#include "chain/parameters.h"

#include <functional>
#include <string>
#include <vector>

namespace drumlin::post {

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
