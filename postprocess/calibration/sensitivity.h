// Local sensitivity of the targets to the parameters, which parameters the targets identify, and the
// confidence intervals of the parameters, all from the evaluations near the best one.
#pragma once

#include "calibration/evaluations.h"
#include "support/statistics.h"

#include <string>
#include <vector>

namespace drumlin::post {

/// A parameter as the calibration finds it.
struct ParameterEstimate {
  double value = 0.0; ///< that meets the targets by the linear model around the best point
  double low = 0.0;   ///< 95 % confidence interval over the seeds, which is even in the logarithm
  double high = 0.0;
  std::string unidentified; ///< why the targets do not identify it; empty if they do
};

/// The linear model ln target = a + sum of slope times ln parameter around the best point.
struct Sensitivity {
  std::vector<std::vector<MeanInterval>>
      slopes; ///< [target][parameter], mean over the seeds, 95 % confidence interval
  std::vector<std::vector<double>>
      correlation; ///< of the estimates of two parameters, for equal errors of ln target / tolerance
  std::vector<ParameterEstimate> parameters;
  std::size_t points = 0; ///< evaluations in the fit

  bool identified() const;
};

/// Distance, in ln parameter, of the points at which slopes are measured from the best point, and the largest
/// of those that enter the fit.
constexpr double slope_step = 0.4;
constexpr double fit_reach = 2.5 * slope_step;
/// A correlation above this, or below its negative, is one that cannot be resolved.
constexpr double most_correlation = 0.95;

/// Points around one, along each parameter, for the fit: one step to both sides, within the ranges.
std::vector<std::vector<double>> slope_points(const CalibrationTask &task, const std::vector<double> &centre);

/// Fits the linear model to the evaluations near the best one in which no run failed, by least squares, for
/// each seed separately. A parameter is not identified if the confidence intervals of all its slopes contain
/// zero, or if its estimate is correlated with that of another parameter by more than most_correlation. One
/// seed gives no confidence intervals: then no parameter is identified. Throws std::runtime_error if such
/// evaluations do not determine all coefficients of the model.
Sensitivity sensitivity_at(const CalibrationTask &task, const std::vector<Evaluation> &evaluations,
                           const Evaluation &best);

} // namespace drumlin::post
