// Measures the targets of a calibration in runs of the engine.
#pragma once

#include "calibration/evaluations.h"
#include "calibration/task.h"

#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace drumlin::post {

/// Beds and samples of `case gravel` in the plane, under a roller, under a plate, in a biaxial test: those tests that a task's targets need.
/// For each seed a bed settles once, and the runs at all points start from it. If pour_friction varies, a bed settles for each point.
class SoilTests {
public:
  /// \param out folder of the calibration; the beds are in its folder beds
  SoilTests(CalibrationTask task, std::filesystem::path out);

  /// The values of the targets at a point; std::runtime_error with the engine's reason. Thread-safe.
  std::vector<double> measure(const Evaluation &evaluation, int seed);

private:
  struct Point;
  std::map<std::string, double> roller(const Point &point);
  std::map<std::string, double> plate(const Point &point);
  std::map<std::string, double> biaxial(const Point &point) const;

  const CalibrationTask task_;
  const std::filesystem::path out_;
  std::mutex mutex_;                   // of the map
  std::map<int, std::mutex> settling_; ///< one for each seed: only one thread lets its bed settle
};

/// Text of a file case.NAME for inputs/bed with which the decks make the beds of a point.
/// \param heading comment at its head, lines without '#'
std::string case_text(const CalibrationTask &task, const std::vector<double> &point,
                      const std::vector<std::string> &heading);

} // namespace drumlin::post
