// The report's pages on biaxial and triaxial tests: mobilised friction and volume over strain, friction angles over side stresses.
#pragma once

#include "report/element_tests.h"

#include <filesystem>
#include <vector>

namespace drumlin::post {

/// A row of biaxial.csv or triaxial.csv. Strains are positive in compression; stresses are means since the row before, kPa.
struct CompressionRow {
  double strain = 0.0; ///< axial
  double axial_stress = 0.0;
  double side_stress = 0.0; ///< mean over the side platens
  double volumetric_strain = 0.0;
  double void_ratio = 0.0;
  double coordination = 0.0;
  double inertial_number = 0.0;
  double energy_error = 0.0;
};

/// Reads biaxial.csv or triaxial.csv. Throws std::runtime_error with file, line and column, or for less than two rows.
std::vector<CompressionRow> read_compression(const std::filesystem::path &file);

/// A pair of stresses, kPa, at which a sample fails.
struct Failure {
  double axial, side;
  double half_sum() const { return 0.5 * (axial + side); }
  double half_difference() const { return 0.5 * (axial - side); }
  /// Mobilised friction angle, degrees: sin phi = (axial - side)/(axial + side).
  double angle() const;
};

/// What a test measures.
struct Strength {
  Failure peak;        ///< the largest ratio within the first third of the strain, of means over a thirtieth
  double strain = 0.0; ///< at the peak
  /// E50, MPa: half of the peak's axial minus side stress over the strain at which it is reached.
  double secant_modulus = 0.0;
  double dilatancy = 0.0;  ///< angle, degrees, over a fifteenth of the strain around the peak
  Failure critical;        ///< means over the last third of the strain
  bool is_critical = true; ///< whether the strain reached 0.1, so that `critical` means something
};

/// \param rows at least two
Strength strength_of(const std::vector<CompressionRow> &rows);

/// The line half difference = cohesion cos phi + half sum sin phi through failures (Mohr and Coulomb).
struct MohrCoulomb {
  double angle, lowest_angle, highest_angle; ///< degrees; the last two: 95 % confidence interval
  double cohesion, half_width;               ///< kPa; half of the 95 % confidence interval
};

/// Least squares of the ratio of half difference and half sum. Throws std::invalid_argument unless there are two side stresses and three failures or more.
MohrCoulomb fit_mohr_coulomb(const std::vector<Failure> &failures);

/// Titles of the pages.
constexpr const char *biaxial_title = "Biaxial tests of soil";
constexpr const char *triaxial_title = "Triaxial tests of soil";

/// Reads the runs in folders, at least one, for their page. Throws std::runtime_error for a file that cannot be read.
PageWriter read_biaxial_page(const std::vector<std::filesystem::path> &folders);
PageWriter read_triaxial_page(const std::vector<std::filesystem::path> &folders);

} // namespace drumlin::post
