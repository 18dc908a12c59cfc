// What element tests of soil measure, from their rows: strength in compression and shear, moduli of a plate
// load test, soil under its own weight.
#pragma once

#include "runs/element_rows.h"

#include <cstddef>
#include <vector>

namespace drumlin::post {

/// A number y of the rows where the number x, which increases from row to row, is `at`: linear between rows.
/// rows: at least two.
template <class Row>
double number_at(const std::vector<Row> &rows, double Row::*x, double at, double Row::*y) {
  std::size_t n = 1;
  while (n + 1 < rows.size() && rows[n].*x < at)
    ++n;
  const Row &a = rows[n - 1], &b = rows[n];
  return a.*y + (at - a.*x) / (b.*x - a.*x) * (b.*y - a.*y);
}

/// Mean of a number y over the rows whose number x lies between two bounds; NaN if there is no such row.
template <class Row>
double mean_between(const std::vector<Row> &rows, double Row::*x, double from, double to, double Row::*y) {
  double sum = 0.0, count = 0.0;
  for (const Row &row : rows) {
    if (row.*x < from || row.*x > to) continue;
    sum += row.*y;
    count += 1.0;
  }
  return sum / count;
}

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

/// Least squares of the ratio of half difference and half sum. Throws std::invalid_argument unless there are
/// two side stresses and three failures or more.
MohrCoulomb fit_mohr_coulomb(const std::vector<Failure> &failures);

/// Ratio of shear and normal stress, with the dilatancy at the same strain.
struct ShearFailure {
  double ratio = 0.0;
  double dilatancy =
      0.0; ///< angle psi, degrees: tan psi = -(change of volumetric strain)/(change of shear strain)
  /// Angle whose tangent is the ratio, degrees: friction on the plane along which the platen moves.
  double angle() const;
  /// Friction angle of the soil, degrees, if the directions of stress and strain increment agree, so that
  /// this plane is not the one of largest obliquity (Davis 1968): sin phi = ratio/(cos psi + ratio sin psi).
  /// For psi = 0 it is sin phi = ratio. NaN if no angle has this sine.
  double davis_angle() const;
};

/// What a test measures.
struct ShearStrength {
  ShearFailure peak;   ///< the largest ratio within the first third of the strain, of means over a thirtieth
  double strain = 0.0; ///< at the peak
  ShearFailure critical; ///< means over the last third of the strain
  /// Whether the test went to a shear strain of 20 %, where a dense soil no longer dilates; the critical
  /// values of shorter tests mean nothing.
  bool is_critical = false;
};

/// \param rows at least two
ShearStrength shear_strength_of(const std::vector<ShearRow> &rows);

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

/// Evaluates a test. A parabola is fitted to the settlement over the stress of each loading, its first row
/// (at the seating stress) included; the modulus of subgrade reaction is the slope of the chord of the
/// parabola between 0.3 and 0.7 of the largest stress of the first loading, and the strain modulus 0.75 times
/// the width of the plate times this modulus: DIN 18134, with the width of a strip for the diameter of the
/// plate.
/// \param width of the plate, m, > 0
PlateResult plate_result(const std::vector<PlateRow> &rows, double width);

/// The soil between the walls before the test.
struct RestingSoil {
  double weight = 0.0; ///< N per metre of thickness
  double width = 0.0;  ///< m, between the walls
  double height = 0.0; ///< m, twice that of the centre of mass

  /// Force on a wall if the horizontal stress is that of a liquid with the soil's weight, gamma height^2/2,
  /// N/m.
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

/// Janssen's stress on the floor over weight/width: (1 - exp(-x))/x with x = 2 mu K height/width, 1 for x =
/// 0.
double janssen(double x);

/// Soil in a silo after its floor moved down: means over the second half of the rows.
struct SiloState {
  double floor_share = 0.0;    ///< force on the floor over the weight
  double wall_share = 0.0;     ///< normal force on both walls over the weight
  double friction_ratio = 0.0; ///< friction over normal force on both walls
  /// Horizontal over vertical stress at the walls by Janssen's theory: that of the normal force on the walls,
  /// from which the force on the floor is not used. NaN if no coefficient gives this force.
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
/// Least squares through the points from `diameter` to 85 % of the highest point, or, if the soil still
/// touches the wall, through all that are above the floor. NaN for less than three points.
Slope slope_of(const std::vector<SurfacePoint> &surface, double diameter, bool touches_wall);

} // namespace drumlin::post
