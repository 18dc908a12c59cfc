// Whether a calibration finds parameters that are known: beds with these parameters are measured, then calibrated to.
#pragma once

#include "calibration/calibration.h"

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// The bed of one seed with the known parameters, and what the calibration to its values finds.
struct RecoveredBed {
  int seed = 0;
  std::vector<double> values;               ///< of the targets
  std::vector<ParameterEstimate> estimates; ///< in the order of the task's parameters

  /// Whether the interval of a parameter holds a value.
  bool holds(std::size_t parameter, double known) const;
};

/// The file of the beds with known parameters in the folder of a recovery.
constexpr const char *recovered_name = "records.csv";

/// Measures the targets at `known` on `beds` beds of the seeds that follow those of the task, and calibrates to the values of each
/// bed. The calibrations share their evaluations, so that those after the first take a few runs only. Their intervals contain the
/// scatter of a single bed (target_beds = 1); values of the task's targets are not used. Writes records.csv and evaluations.csv in
/// `out`, which exists, and continues an interrupted recovery. Throws std::runtime_error if a bed cannot be measured, and as calibrate().
std::vector<RecoveredBed> recover(CalibrationTask task, const std::vector<double> &known, int beds,
                                  const CalibrationEffort &effort, const std::filesystem::path &out,
                                  const MeasureSeed &measure);

/// How many intervals hold the known value, a sentence for each parameter.
std::vector<std::string> recovery_answer(const CalibrationTask &task, const std::vector<double> &known,
                                         const std::vector<RecoveredBed> &found);

/// Writes the page with table and figure into the folder. \param beds what was measured on, in words
void write_recovery_page(const std::filesystem::path &out, const std::string &beds,
                         const CalibrationTask &task, const std::vector<double> &known,
                         const std::vector<RecoveredBed> &found);

} // namespace drumlin::post
