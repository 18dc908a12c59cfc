// The CSV files of element tests of soil, one type of rows for each. Readers throw std::runtime_error with
// file, line and column, and for less than two rows.
#pragma once

#include "support/csv.h"

#include <filesystem>
#include <vector>

namespace drumlin::post {

/// A table of a test: at least two rows.
Table read_element_table(const std::filesystem::path &file);

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

/// A row of density.csv, a packing: the loosest one in the first row, the densest in the second.
struct DensityRow {
  double share = 0.0; ///< of the soil's friction and rolling friction
  double friction = 0.0;
  double rolling = 0.0;
  double void_ratio = 0.0;
  double solid_fraction = 0.0;
  double relative_density = 0.0;
  double compaction = 0.0;
  double coordination = 0.0;
  std::string made; ///< poured, shaken or frictionless; empty in runs without a shaken packing
};

/// Reads density.csv. Throws std::runtime_error with file, line and column, or for less than two rows.
std::vector<DensityRow> read_density(const std::filesystem::path &file);

/// A row of biaxial.csv or triaxial.csv. Strains are positive in compression; stresses are means since the
/// row before, kPa.
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

/// Reads biaxial.csv or triaxial.csv. Throws std::runtime_error with file, line and column, or for less than
/// two rows.
std::vector<CompressionRow> read_compression(const std::filesystem::path &file);

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

/// A row of loops.csv: a cycle of a shear test to and fro.
struct LoopRow {
  double cycle = 0.0;                 ///< from 1
  double amplitude = 0.0;             ///< of the shear strain, half of the range
  double secant_modulus = 0.0;        ///< MPa
  double damping_ratio = 0.0;         ///< from the area of the loop
  double damping_ratio_of_heat = 0.0; ///< from what the contacts dissipate
  double volumetric_strain = 0.0;     ///< positive in compression
  double void_ratio = 0.0;
};

/// Reads loops.csv. Throws std::runtime_error with file, line and column, or if it has no rows.
std::vector<LoopRow> read_loops(const std::filesystem::path &file);

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

/// Reads plate.csv. Throws std::runtime_error with file, line and column, for less than two rows, and for a
/// phase that is none.
std::vector<PlateRow> read_plate(const std::filesystem::path &file);

/// A row of repose.csv, silo.csv or wall.csv. Forces of the soil on the plates, N per metre of thickness,
/// means since the row before: outward on the walls, friction and force on the floor downward.
struct OwnWeightRow {
  double displacement = 0.0; ///< of the plate that moves, mm
  double left_force = 0.0, left_friction = 0.0;
  double side_force = 0.0, side_friction = 0.0; ///< of the right wall
  double floor_force = 0.0;
  double inertial_number = 0.0;
  double energy_error = 0.0;
};

/// Reads the CSV file of a test. Throws std::runtime_error with file, line and column, for less than two
/// rows, or for displacements that do not grow.
std::vector<OwnWeightRow> read_own_weight(const std::filesystem::path &file);

} // namespace drumlin::post
