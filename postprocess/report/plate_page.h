// The report's page on plate load tests: settlement over stress, modulus of subgrade reaction, strain moduli, bearing capacity.
#pragma once

#include "report/element_tests.h"

#include <filesystem>
#include <vector>

namespace drumlin::post {

/// Parts of a plate load test, as in the column `phase` of plate.csv.
enum class PlatePhase { seating = 0, first_loading = 1, unloading = 2, second_loading = 3 };

/// A row of plate.csv: the bed at rest under a stress of the plate.
struct PlateRow {
  double phase = 0.0;           ///< a PlatePhase
  double stress = 0.0;          ///< kPa
  double settlement = 0.0;      ///< mm, since the seating stress
  double inertial_number = 0.0; ///< -
  double energy_error = 0.0;    ///< -

  bool is(PlatePhase which) const { return phase == static_cast<int>(which); }
};

/// Reads plate.csv. Throws std::runtime_error with file, line and column, for less than two rows, and for a phase
/// that is none.
std::vector<PlateRow> read_plate(const std::filesystem::path &file);

/// What a plate load test says of the soil; NaN for what it was not loaded far enough for.
struct PlateResult {
  double first_reaction = 0.0;  ///< modulus of subgrade reaction in the first loading, MPa/m = MN/m3
  double second_reaction = 0.0; ///< in the second loading
  double first_modulus = 0.0;   ///< strain modulus E_v1, MPa
  double second_modulus = 0.0;  ///< E_v2, MPa
  double bearing_capacity =
      0.0; ///< kPa, at which the settlement is a tenth of the plate's width in the first loading

  double ratio() const { return second_modulus / first_modulus; } ///< E_v2/E_v1
};

/// Evaluates a test. A parabola is fitted to the settlement over the stress of each loading, its first row (at the
/// seating stress) included; the modulus of subgrade reaction is the slope of the chord of the parabola between 0.3 and
/// 0.7 of the largest stress of the first loading, and the strain modulus 0.75 times the width of the plate times this
/// modulus: DIN 18134, with the width of a strip for the diameter of the plate.
/// \param width of the plate, m, > 0
PlateResult plate_result(const std::vector<PlateRow> &rows, double width);

/// Title of the page.
constexpr const char *plate_title = "Plate load tests";

/// Reads the runs in folders, at least one, for their page. Throws std::runtime_error for a file that cannot be read.
PageWriter read_plate_page(const std::vector<std::filesystem::path> &folders);

} // namespace drumlin::post
