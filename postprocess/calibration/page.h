// The page of a calibration.
#pragma once

#include "calibration/calibration.h"
#include "identify/lumped_comparison.h"

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// The answer, a line for each parameter, each target, and each parameter that is not identified: for page,
/// terminal and case file.
std::vector<std::string> calibration_answer(const CalibrationTask &task, const Calibration &found);

/// Writes figures, tables and index.html into the folder.
/// \param beds what was measured on, in words
/// \param compared the roller's records at the best evaluation, one for each seed, beside the lumped chain;
/// may be empty
void write_calibration_page(const std::filesystem::path &out, const std::string &beds,
                            const CalibrationTask &task, const Calibration &found,
                            const std::vector<LumpedComparison> &compared);

} // namespace drumlin::post
