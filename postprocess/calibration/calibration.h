// A calibration: evaluations of points until the targets are met, their sensitivity, and the answer.
#pragma once

#include "calibration/evaluations.h"
#include "calibration/sensitivity.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace drumlin::post {

/// Measures the targets at a point on the bed of a seed: as many values as the task has targets. Throws
/// SceneFault with the reason if the point and the bed do not allow it, any other exception if something
/// fails that need not fail again. Called from several threads.
using MeasureSeed = std::function<std::vector<double>(const Evaluation &evaluation, int seed)>;

/// How many evaluations and runs at a time the search may use.
struct CalibrationEffort {
  int evaluations = 40; ///< of the search; those for slopes and estimate are made in addition
  int jobs = 1;         ///< beds measured at the same time
  /// Points that the search asks for before it knows their values. It decides which points these are.
  int at_once = 1;
};

/// A calibration's results.
struct Calibration {
  std::vector<Evaluation> evaluations;
  Evaluation best; ///< of the smallest objective
  Sensitivity sensitivity;
};

/// Whether each parameter of the best evaluation is within its confidence interval.
bool best_is_within(const Calibration &found);

/// The parameters that a calibration gives: those of the best evaluation, which have been measured, if they
/// are within their confidence intervals, else those at which the targets are met by the slopes. Throws
/// UsageError for --vary if these are outside of the ranges.
std::vector<double> found_point(const CalibrationTask &task, const Calibration &found);

/// The file of the evaluations in the folder of a calibration.
constexpr const char *evaluations_name = "evaluations.csv";

/// Calibrates, in three stages: the search over all ranges; the points of slope_points() around its best; and
/// the point at which the linear model of sensitivity_at() meets the targets, if all parameters are
/// identified. Every evaluation uses the same seeds. An evaluation of which a seed fails by its scene counts
/// in the search as the worst of those that did not; any other failure ends the calibration. Results are
/// written to evaluations.csv in `out`, which exists, one row for each seed when it is known. Rows that are
/// there are not measured again: the search is repeated with their values, so that a continued calibration
/// finds what one without an interruption finds. If the rows are of another search, with more or other points
/// at once, it says so and searches on from them. Prints progress. Throws std::runtime_error if the first
/// evaluations all fail, or if too few around the best succeed.
Calibration calibrate(const CalibrationTask &task, const CalibrationEffort &effort,
                      const std::filesystem::path &out, const MeasureSeed &measure);

} // namespace drumlin::post
