// The report's page on runs of the oedometer: modulus and settlement over stress.
#pragma once

#include "report/run_folder.h"

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// A row of oedometer.csv: the sample at rest under a stress.
struct OedometerRow {
  double stress = 0.0;          ///< kPa
  double settlement = 0.0;      ///< mm, since the seating stress
  double strain = 0.0;          ///< -
  double void_ratio = 0.0;      ///< -
  double modulus = 0.0;         ///< MPa, from the row before to this one; NaN in the first row
  double inertial_number = 0.0; ///< -
  double energy_error = 0.0;    ///< -
};

/// Reads oedometer.csv. Throws std::runtime_error with file, line and column, or for less than two rows.
std::vector<OedometerRow> read_oedometer(const std::filesystem::path &file);

/// A run of the oedometer.
struct OedometerRun {
  Run run; ///< only folder, name and parameters
  std::vector<OedometerRow> rows;
};

/// Reads the folders and names the runs. Throws std::runtime_error for a file that cannot be read.
std::vector<OedometerRun> read_oedometer_runs(const std::vector<std::filesystem::path> &folders);

/// Title of the page.
constexpr const char *oedometer_title = "Oedometer tests of soil";

/// Writes the page into a folder: index.html, figures and data. Throws std::runtime_error.
/// \param runs at least one
void write_oedometer_page(const std::vector<OedometerRun> &runs, const std::filesystem::path &out);

} // namespace drumlin::post
