// How an error falls with the number of steps: pure functions over the points that a study measured.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace drumlin::post {

/// The error at a number of steps (per cycle, or per contact).
struct ErrorPoint {
  double steps = 0.0;
  double error = 0.0; ///< relative, >= 0; not finite: the run gave none
};

/// error ~ steps^-order, by least squares of the logarithms.
struct FittedOrder {
  double order = 0.0;
  double scatter = 0.0; ///< root mean square distance of the points from the line, decades
  double from = 0.0;    ///< fewest steps among the points
  double to = 0.0;      ///< most
};

/// Fit over the points from a number of steps on: coarser steps need not be in the asymptotic range. Nothing
/// if fewer than three points with errors that are finite and above 0 remain.
std::optional<FittedOrder> fitted_order(const std::vector<ErrorPoint> &points, double from);

/// Where the finer half of the points begins, on a logarithmic scale. Points in order of steps, not empty.
double finer_half(const std::vector<ErrorPoint> &points);

/// The smallest measured number of steps from which on every larger one keeps to the error. Nothing if the
/// largest does not. Points in order of steps.
std::optional<double> steps_needed(const std::vector<ErrorPoint> &points, double error);

/// Largest error at each number of steps and beyond it: a bound that never grows with the number of steps.
/// Points that have no error count as infinite.
std::vector<ErrorPoint> envelope(std::vector<ErrorPoint> points);

/// Steps at which the envelope reaches an error, between its points and beyond its ends by power laws; beyond
/// the ends with the given order. error > 0. Nothing without points of finite error.
std::optional<double> steps_for(const std::vector<ErrorPoint> &points, double error, double order);

} // namespace drumlin::post
