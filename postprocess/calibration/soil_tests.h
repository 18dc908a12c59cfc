// Measures the targets of a calibration in runs of the engine.
#pragma once

#include "bed/packing.h"
#include "calibration/evaluations.h"
#include "calibration/task.h"

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace drumlin::post {

class DeckRun;

/// Beds and samples of `case gravel` in the plane, under a roller, under a plate, in a biaxial test: those
/// tests that a task's targets need. A bed settles for each point and seed, with the contacts of the point.
class SoilTests {
public:
  /// \param out folder of the calibration; the beds are in its folder beds
  SoilTests(CalibrationTask task, std::filesystem::path out);

  /// The values of the targets at a point; SceneFault with the engine's reason, std::runtime_error for faults
  /// that may pass. Thread-safe.
  std::vector<double> measure(const Evaluation &evaluation, int seed) const;

  /// The folder of the roller's run at a point, with bed.csv and parameters.csv; made if an earlier call has
  /// not kept it. Its parent is the folder `records` of the calibration.
  std::filesystem::path record(const Evaluation &evaluation, int seed) const;

private:
  struct Point;
  Point point_of(const Evaluation &evaluation, int seed) const;
  std::unique_ptr<DeckRun> run_roller(const Point &point) const;
  std::map<std::string, double> roller(const Point &point) const;
  std::map<std::string, double> plate(const Point &point) const;
  std::map<std::string, double> biaxial(const Point &point) const;

  const CalibrationTask task_;
  const std::filesystem::path out_;
};

/// The balls of a bed, and the box in which they settle.
PackingOptions packing_of(const CalibrationTask &task);

/// Whether a task has targets that a test measures.
bool measures(const CalibrationTask &task, SoilTest test);

/// Text of a file case.NAME for inputs/bed with which the decks make the beds of a point.
/// \param heading comment at its head, lines without '#'
std::string case_text(const CalibrationTask &task, const std::vector<double> &point,
                      const std::vector<std::string> &heading);

} // namespace drumlin::post
