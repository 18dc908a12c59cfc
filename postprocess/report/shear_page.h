// The report's page on simple shear tests: mobilised friction and volume over shear strain, friction angles over the seeds.
#pragma once

#include "report/element_tests.h"

#include <filesystem>
#include <vector>

namespace drumlin::post {

/// A row of shear.csv. Stresses are means since the row before, kPa.
struct ShearRow {
  double strain = 0.0; ///< displacement of the platen over the height
  double shear_stress = 0.0;
  double normal_stress = 0.0;
  double volumetric_strain = 0.0; ///< positive in compression
  double void_ratio = 0.0;
  double inertial_number = 0.0;
  double energy_error = 0.0;
};

/// Reads shear.csv. Throws std::runtime_error with file, line and column, or for less than two rows.
std::vector<ShearRow> read_shear(const std::filesystem::path &file);

/// Ratio of shear and normal stress, with the dilatancy at the same strain.
struct ShearFailure {
  double ratio = 0.0;
  double dilatancy =
      0.0; ///< angle psi, degrees: tan psi = -(change of volumetric strain)/(change of shear strain)
  /// Angle whose tangent is the ratio, degrees: friction on the plane along which the platen moves.
  double angle() const;
  /// Friction angle of the soil, degrees, if the directions of stress and strain increment agree, so that this plane is
  /// not the one of largest obliquity (Davis 1968): sin phi = ratio/(cos psi + ratio sin psi). For psi = 0 it is
  /// sin phi = ratio. NaN if no angle has this sine.
  double davis_angle() const;
};

/// What a test measures.
struct ShearStrength {
  ShearFailure peak;   ///< the largest ratio within the first third of the strain, of means over a thirtieth
  double strain = 0.0; ///< at the peak
  ShearFailure critical; ///< means over the last third of the strain
  /// Whether the test went to a shear strain of 20 %, where a dense soil no longer dilates; the critical values of
  /// shorter tests mean nothing.
  bool is_critical = false;
};

/// \param rows at least two
ShearStrength shear_strength_of(const std::vector<ShearRow> &rows);

/// Title of the page.
constexpr const char *shear_title = "Simple shear tests of soil";

/// Reads the runs in folders, at least one, for their page. Throws std::runtime_error for a file that cannot be read.
PageWriter read_shear_page(const std::vector<std::filesystem::path> &folders);

} // namespace drumlin::post
