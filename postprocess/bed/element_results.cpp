#include "bed/element_results.h"

#include "support/units.h"
#include "support/statistics.h"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>

namespace drumlin::post {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
/// Strains at which a soil no longer dilates; a run that was asked for 0.1 or 0.2 may end just before.
constexpr double critical_strain_of_compression = 0.0999, critical_strain_of_shear = 0.1999;
constexpr double settlement_of_failure = 0.1; // over the width of the plate

/// Means of the stresses over the rows whose strain is within an interval.
Failure mean_stresses(const std::vector<CompressionRow> &rows, double from, double to) {
  return {mean_between(rows, &CompressionRow::strain, from, to, &CompressionRow::axial_stress),
          mean_between(rows, &CompressionRow::strain, from, to, &CompressionRow::side_stress)};
}

/// sin psi = -(change of volumetric strain)/(twice the change of axial strain - that of volumetric strain),
/// in degrees: in the plane and, after Schanz and Vermeer (1996), in a triaxial test.
double dilatancy_angle(const std::vector<CompressionRow> &rows, double from, double to) {
  const CompressionRow *first = nullptr, *last = nullptr;
  for (const CompressionRow &row : rows) {
    if (row.strain < from || row.strain > to) continue;
    if (first == nullptr) first = &row;
    last = &row;
  }
  if (first == last) return std::numeric_limits<double>::quiet_NaN();
  const double axial = last->strain - first->strain;
  const double volume = last->volumetric_strain - first->volumetric_strain;
  return degrees_per_radian * std::asin(-volume / (2.0 * axial - volume));
}

/// E50, MPa, of a peak. The stresses of a row are means since the row before and belong to the strain
/// halfway.
double secant_modulus(const std::vector<CompressionRow> &rows, const Failure &peak) {
  const double half = peak.half_difference();
  double strain = 0.0, difference = 0.0;
  for (std::size_t n = 1; n < rows.size(); ++n) {
    const double next_strain = 0.5 * (rows[n - 1].strain + rows[n].strain);
    const double next = rows[n].axial_stress - rows[n].side_stress;
    if (next >= half)
      return 1e-3 * half / (strain + (half - difference) / (next - difference) * (next_strain - strain));
    strain = next_strain;
    difference = next;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// Mean ratio and dilatancy between two strains, `around` being the interval of the latter.
ShearFailure failure_between(const std::vector<ShearRow> &rows, double from, double to, double around) {
  ShearFailure failure;
  failure.ratio = mean_between(rows, &ShearRow::strain, from, to, &ShearRow::shear_stress) /
                  mean_between(rows, &ShearRow::strain, from, to, &ShearRow::normal_stress);
  const double first = number_at(rows, &ShearRow::strain, from - around, &ShearRow::volumetric_strain);
  const double last = number_at(rows, &ShearRow::strain, to + around, &ShearRow::volumetric_strain);
  failure.dilatancy = degrees_per_radian * std::atan((first - last) / (to - from + 2 * around));
  return failure;
}

/// Slope of stress over settlement, kPa/mm = MN/m3, of the chord of the parabola s = a0 + a1 p + a2 p^2
/// through the rows between 0.3 and 0.7 of `most`: s changes by (0.7 - 0.3) most (a1 + a2 (0.7 + 0.3) most).
/// NaN for less than three rows.
double subgrade_reaction(const std::vector<PlateRow> &rows, double most) {
  if (rows.size() < 3) return none;
  const auto count = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd powers(count, 3);
  Eigen::VectorXd settlement(count);
  for (Eigen::Index n = 0; n < count; ++n) {
    const PlateRow &row = rows[static_cast<std::size_t>(n)];
    const double part = row.stress / most;
    powers.row(n) << 1.0, part, part * part;
    settlement(n) = row.settlement;
  }
  const Eigen::VectorXd a = powers.colPivHouseholderQr().solve(settlement);
  return most / (a(1) + a(2));
}

/// Stress at which the settlement reaches a value, linear between rows; NaN if it does not.
double stress_at(const std::vector<PlateRow> &rows, double settlement) {
  for (std::size_t n = 1; n < rows.size(); ++n) {
    const PlateRow &a = rows[n - 1], &b = rows[n];
    if (b.settlement >= settlement)
      return a.stress + (settlement - a.settlement) / (b.settlement - a.settlement) * (b.stress - a.stress);
  }
  return none;
}

/// The share of the weight that the floor does not carry is mu times the normal force on the walls.
double janssen_argument(double wall_share, double wall_friction) {
  const double carried = wall_friction * wall_share;
  if (carried <= 0.0 || carried >= 1.0) return none;
  double low = 0.0, high = 1.0;
  while (1.0 - janssen(high) < carried)
    high *= 2.0;
  for (int n = 0; n < 200; ++n) {
    const double middle = 0.5 * (low + high);
    (1.0 - janssen(middle) < carried ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

} // namespace

double Failure::angle() const { return degrees_per_radian * std::asin((axial - side) / (axial + side)); }

Strength strength_of(const std::vector<CompressionRow> &rows) {
  const double end = rows.back().strain;
  Strength strength;
  strength.peak = mean_stresses(rows, 0.0, 0.0);
  for (const CompressionRow &row : rows) {
    if (row.strain > end / 3.0) break;
    const Failure here = mean_stresses(rows, row.strain - end / 60.0, row.strain + end / 60.0);
    if (here.angle() <= strength.peak.angle()) continue;
    strength.peak = here;
    strength.strain = row.strain;
  }
  strength.secant_modulus = secant_modulus(rows, strength.peak);
  strength.dilatancy = dilatancy_angle(rows, strength.strain - end / 30.0, strength.strain + end / 30.0);
  strength.critical = mean_stresses(rows, end / 1.5, end);
  strength.is_critical = end >= critical_strain_of_compression;
  return strength;
}

MohrCoulomb fit_mohr_coulomb(const std::vector<Failure> &failures) {
  // The scatter of the angles is the same at all stresses: the relative difference is a line over 1/(half
  // sum).
  std::vector<double> inverse_sums, ratios;
  for (const Failure &failure : failures) {
    inverse_sums.push_back(1.0 / failure.half_sum());
    ratios.push_back(failure.half_difference() / failure.half_sum());
  }
  const LineFit line = fit_line(inverse_sums, ratios);
  const auto angle = [](double sine) { return degrees_per_radian * std::asin(std::clamp(sine, -1.0, 1.0)); };
  const auto [sine, half_width] = line.intercept;
  const double cosine = std::cos(angle(sine) / degrees_per_radian);
  return {angle(sine), angle(sine - half_width), angle(sine + half_width), line.slope.mean / cosine,
          line.slope.half_width / cosine};
}

double ShearFailure::angle() const { return degrees_per_radian * std::atan(ratio); }

double ShearFailure::davis_angle() const {
  const double psi = dilatancy / degrees_per_radian;
  return degrees_per_radian * std::asin(ratio / (std::cos(psi) + ratio * std::sin(psi)));
}

ShearStrength shear_strength_of(const std::vector<ShearRow> &rows) {
  const double end = rows.back().strain;
  ShearStrength strength;
  for (const ShearRow &row : rows) {
    if (row.strain > end / 3.0) break;
    const ShearFailure here =
        failure_between(rows, row.strain - end / 60.0, row.strain + end / 60.0, end / 30.0);
    if (here.ratio <= strength.peak.ratio) continue;
    strength.peak = here;
    strength.strain = row.strain;
  }
  strength.critical = failure_between(rows, end / 1.5, end, 0.0);
  strength.is_critical = end >= critical_strain_of_shear;
  return strength;
}

PlateResult plate_result(const std::vector<PlateRow> &rows, double width) {
  std::vector<PlateRow> first, second;
  double most = 0.0;
  for (const PlateRow &row : rows) {
    if (row.is(PlatePhase::seating) || row.is(PlatePhase::first_loading)) {
      first.push_back(row);
      most = std::max(most, row.stress);
    }
    if (row.is(PlatePhase::unloading)) second = {row}; // the last one is where the second loading begins
    if (row.is(PlatePhase::second_loading)) second.push_back(row);
  }
  constexpr double of_diameter = 0.75; // strain modulus over subgrade reaction times diameter
  PlateResult result;
  result.first_reaction = subgrade_reaction(first, most);
  result.second_reaction = subgrade_reaction(second, most);
  result.first_modulus = of_diameter * width * result.first_reaction;
  result.second_modulus = of_diameter * width * result.second_reaction;
  result.bearing_capacity = stress_at(first, 1e3 * settlement_of_failure * width);
  return result;
}

double ActiveState::angle() const {
  return degrees_per_radian * std::asin((1 - coefficient) / (1 + coefficient));
}

ActiveState active_state(const std::vector<OwnWeightRow> &rows, const RestingSoil &soil) {
  const std::size_t window = std::max<std::size_t>(1, rows.size() / 30);
  ActiveState state;
  state.coefficient = std::numeric_limits<double>::infinity();
  for (std::size_t first = 1; first + window <= rows.size(); ++first) {
    double force = 0.0;
    for (std::size_t n = first; n < first + window; ++n)
      force += 0.5 * (rows[n].left_force + rows[n].side_force) / static_cast<double>(window);
    if (force / soil.hydrostatic_force() >= state.coefficient) continue;
    state = {force / soil.hydrostatic_force(), rows[first + window / 2].displacement};
  }
  return state;
}

double janssen(double x) { return x == 0.0 ? 1.0 : -std::expm1(-x) / x; }

SiloState silo_state(const std::vector<OwnWeightRow> &rows, const RestingSoil &soil, double wall_friction) {
  double floor = 0.0, normal = 0.0, friction = 0.0, count = 0.0;
  for (std::size_t n = rows.size() / 2; n < rows.size(); ++n) {
    floor += rows[n].floor_force;
    normal += rows[n].left_force + rows[n].side_force;
    friction += rows[n].left_friction + rows[n].side_friction;
    count += 1.0;
  }
  SiloState state{floor / count / soil.weight, normal / count / soil.weight, friction / normal, none};
  const double slenderness = soil.height / soil.width;
  state.coefficient = wall_friction == 0.0 ? state.wall_share / slenderness // the limit of small friction
                                           : janssen_argument(state.wall_share, wall_friction) /
                                                 (2 * wall_friction * slenderness);
  return state;
}

Slope slope_of(const std::vector<SurfacePoint> &surface, double diameter, bool touches_wall) {
  double highest = 0.0;
  for (const SurfacePoint &point : surface)
    highest = std::max(highest, point.height);
  const double from = touches_wall ? 0.0 : diameter, to = touches_wall ? highest : 0.85 * highest;
  Slope slope;
  std::vector<double> x, height;
  for (const SurfacePoint &point : surface) {
    if (point.height <= 0.0 || point.height < from || point.height > to) continue;
    x.push_back(point.x);
    height.push_back(point.height);
  }
  slope.angle = slope.half_width = slope.intercept = none;
  if (x.size() < 3 || x.front() == x.back()) return slope;
  const LineFit line = fit_line(x, height);
  // Points on one ball are not independent: a diameter of the slope counts as one point.
  const double points_per_ball =
      std::max(1.0, diameter * static_cast<double>(x.size() - 1) / (x.back() - x.front()));
  slope.from = x.front();
  slope.to = x.back();
  slope.intercept = line.intercept.mean;
  slope.angle = -degrees_per_radian * std::atan(line.slope.mean);
  slope.half_width = degrees_per_radian * line.slope.half_width * std::sqrt(points_per_ball) /
                     (1 + line.slope.mean * line.slope.mean);
  return slope;
}

} // namespace drumlin::post
