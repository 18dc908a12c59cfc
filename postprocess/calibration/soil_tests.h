// Measures the targets of a calibration in runs of the engine.
#pragma once

#include "calibration/evaluations.h"
#include "calibration/task.h"

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace drumlin::post {

class DeckRun;

/// Beds and samples of `case gravel` in the plane, under a roller, under a plate, in a biaxial test: those tests that a task's targets need.
/// For each seed a bed settles once, and the runs at all points start from it. If pour_friction varies, a bed settles for each point.
class SoilTests {
public:
  /// \param out folder of the calibration; the beds are in its folder beds
  SoilTests(CalibrationTask task, std::filesystem::path out);

  /// The values of the targets at a point; std::runtime_error with the engine's reason. Thread-safe.
  std::vector<double> measure(const Evaluation &evaluation, int seed);

  /// The folder of the roller's run at a point, with bed.csv and parameters.csv; made if an earlier call has not kept it. Its parent
  /// is the folder `records` of the calibration.
  std::filesystem::path record(const Evaluation &evaluation, int seed);

private:
  struct Point;
  Point point_of(const Evaluation &evaluation, int seed) const;
  void settle(const Point &point);
  void remove_own_soil(const Point &point) const;
  std::unique_ptr<DeckRun> run_roller(const Point &point) const;
  std::map<std::string, double> roller(const Point &point) const;
  std::map<std::string, double> plate(const Point &point) const;
  std::map<std::string, double> biaxial(const Point &point) const;

  const CalibrationTask task_;
  const std::filesystem::path out_;
  std::mutex mutex_;                   // of the map
  std::map<int, std::mutex> settling_; ///< one for each seed: only one thread lets its bed settle
};

/// Whether a task has targets that a test measures.
bool measures(const CalibrationTask &task, SoilTest test);

/// Text of a file case.NAME for inputs/bed with which the decks make the beds of a point.
/// \param heading comment at its head, lines without '#'
std::string case_text(const CalibrationTask &task, const std::vector<double> &point,
                      const std::vector<std::string> &heading);

} // namespace drumlin::post
