// The evaluations of a calibration: points, what was measured there, and their file evaluations.csv.
#pragma once

#include "calibration/task.h"

#include <cstddef>
#include <filesystem>
#include <memory>
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

/// A point, each coordinate from 0 to 1, and the value of the function there.
struct SearchPoint {
  std::vector<double> at;
  double value = 0.0; ///< finite
};

/// dlib's global_function_search, which alternates between an upper bound of the function by its Lipschitz
/// constant (LIPO, Malherbe and Vayatis 2017), to look where nothing is known, and a quadratic model around
/// the best point. Points may be asked for before the values of earlier ones are known.
class PointSearch {
public:
  /// \param dimensions 1 or more
  /// \param noise of the function's values, relative to their range
  /// \param earlier points that are known already
  PointSearch(std::size_t dimensions, double noise, const std::vector<SearchPoint> &earlier);
  ~PointSearch();
  PointSearch(const PointSearch &) = delete;
  PointSearch &operator=(const PointSearch &) = delete;

  /// The point to look at next.
  std::vector<double> next();
  /// Gives the values, all finite, of the points that next() returned since the last call, in their order.
  void give(const std::vector<double> &values);

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace drumlin::post
