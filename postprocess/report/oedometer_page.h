// The report's page on runs of the oedometer: modulus and settlement over stress.
#pragma once

#include "report/element_tests.h"

#include <filesystem>
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

/// Title of the page.
constexpr const char *oedometer_title = "Oedometer tests of soil";

/// Reads the runs in folders, at least one, for their page. Throws std::runtime_error for a file that cannot be read.
PageWriter read_oedometer_page(const std::vector<std::filesystem::path> &folders);

} // namespace drumlin::post
