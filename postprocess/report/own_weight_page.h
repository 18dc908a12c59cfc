// The report's pages on tests of soil under its own weight: angle of repose, a silo whose floor moves down, a wall that moves outward.
#pragma once

#include "report/element_tests.h"

#include <filesystem>
#include <vector>

namespace drumlin::post {

/// A row of repose.csv, silo.csv or wall.csv. Forces of the soil on the plates, N per metre of thickness, means since the
/// row before: outward on the walls, friction and force on the floor downward.
struct OwnWeightRow {
  double displacement = 0.0; ///< of the plate that moves, mm
  double left_force = 0.0, left_friction = 0.0;
  double side_force = 0.0, side_friction = 0.0; ///< of the right wall
  double floor_force = 0.0;
  double inertial_number = 0.0;
  double energy_error = 0.0;
};

/// Reads the CSV file of a test. Throws std::runtime_error with file, line and column, for less than two rows, or for
/// displacements that do not grow.
std::vector<OwnWeightRow> read_own_weight(const std::filesystem::path &file);

/// The soil between the walls before the test.
struct RestingSoil {
  double weight = 0.0; ///< N per metre of thickness
  double width = 0.0;  ///< m, between the walls
  double height = 0.0; ///< m, twice that of the centre of mass

  /// Force on a wall if the horizontal stress is that of a liquid with the soil's weight, gamma height^2/2, N/m.
  double hydrostatic_force() const { return 0.5 * weight / width * height; }
};

/// The state of failure of soil behind a smooth wall.
struct ActiveState {
  double coefficient = 0.0;  ///< force on the wall over the hydrostatic one, mean of both walls: K_a
  double displacement = 0.0; ///< of the wall, mm
  /// The friction angle of Rankine's theory, degrees: K_a = (1 - sin phi)/(1 + sin phi).
  double angle() const;
};
/// The smallest force on the walls, mean over a thirtieth of the rows. rows: at least two.
ActiveState active_state(const std::vector<OwnWeightRow> &rows, const RestingSoil &soil);

/// Janssen's stress on the floor over weight/width: (1 - exp(-x))/x with x = 2 mu K height/width, 1 for x = 0.
double janssen(double x);

/// Soil in a silo after its floor moved down: means over the second half of the rows.
struct SiloState {
  double floor_share = 0.0;    ///< force on the floor over the weight
  double wall_share = 0.0;     ///< normal force on both walls over the weight
  double friction_ratio = 0.0; ///< friction over normal force on both walls
  /// Horizontal over vertical stress at the walls by Janssen's theory: that of the normal force on the walls, from which
  /// the force on the floor is not used. NaN if no coefficient gives this force.
  double coefficient = 0.0;
};
/// \param wall_friction coefficient of friction of the walls, >= 0
SiloState silo_state(const std::vector<OwnWeightRow> &rows, const RestingSoil &soil, double wall_friction);

/// A point of a surface, m.
struct SurfacePoint {
  double x = 0.0, height = 0.0;
};
/// A line through a slope.
struct Slope {
  double angle = 0.0;      ///< degrees, positive if the surface falls with x
  double half_width = 0.0; ///< of its 95 % confidence interval, degrees; points of one ball count once
  double from = 0.0, to = 0.0;
  double intercept = 0.0; ///< m, height of the line at x = 0
  bool free = false;      ///< whether the slope ends on the floor before the wall
};
/// Least squares through the points from `diameter` to 85 % of the highest point, or, if the soil still touches the wall, through
/// all that are above the floor. NaN for less than three points.
Slope slope_of(const std::vector<SurfacePoint> &surface, double diameter, bool touches_wall);

/// Titles of the pages.
constexpr const char *repose_title = "Angle of repose";
constexpr const char *silo_title = "Soil in a silo";
constexpr const char *wall_title = "Soil behind a wall that moves outward";

/// Read the runs in folders, at least one, for their page. Throw std::runtime_error for a file that cannot be read.
PageWriter read_repose_page(const std::vector<std::filesystem::path> &folders);
PageWriter read_silo_page(const std::vector<std::filesystem::path> &folders);
PageWriter read_wall_page(const std::vector<std::filesystem::path> &folders);

} // namespace drumlin::post
