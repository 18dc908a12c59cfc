// The evaluations of a calibration: points, what was measured there, and their file evaluations.csv.
#pragma once

#include "calibration/task.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// Results of the bed of one seed at a point.
struct SeedResult {
  int seed = 0;
  std::vector<double> values; ///< in the order of the task's targets, above zero; empty if a run failed
  std::string failure;        ///< why
};

/// Which part of the calibration asked for a point.
enum class Stage { search, slopes, estimate };
std::string stage_name(Stage stage);

/// A point and its results.
struct Evaluation {
  int number = 0; ///< from 1
  Stage stage = Stage::search;
  std::vector<double> point; ///< values of the parameters that vary, in the task's order
  std::vector<SeedResult> seeds;

  /// Whether all seeds of the task are there.
  bool finished(const CalibrationTask &task) const;
  /// Whether it is finished and no seed failed.
  bool good(const CalibrationTask &task) const;
  /// Why it failed: the first seed's reason; empty if none failed.
  std::string failure() const;
  /// Geometric mean of a target's values over the seeds. \pre good
  double mean(std::size_t target) const;
  /// Sum over the targets of (ln(mean / wanted value) / tolerance)^2. \pre good
  double objective(const CalibrationTask &task) const;
};

/// The good evaluation of the smallest objective; nullptr if there is none.
const Evaluation *best_of(const CalibrationTask &task, const std::vector<Evaluation> &evaluations);

/// Coordinates of a point from 0 (low) to 1 (high), in the logarithm, and back, rounded to six digits.
std::vector<double> unit_point(const CalibrationTask &task, const std::vector<double> &point);
std::vector<double> point_at(const CalibrationTask &task, const std::vector<double> &unit);

/// The header of evaluations.csv, whose first `evaluation_keys` columns name a row, and its rows.
constexpr std::size_t evaluation_keys = 2;
std::vector<std::string> evaluation_header(const CalibrationTask &task);
std::vector<std::string> evaluation_row(const Evaluation &evaluation, const SeedResult &result,
                                        std::size_t targets);
/// Reads evaluations.csv, rows that were cut short left out. std::runtime_error for a cell that cannot be
/// understood.
std::vector<Evaluation> read_evaluations(const CalibrationTask &task, const std::filesystem::path &file);

} // namespace drumlin::post
