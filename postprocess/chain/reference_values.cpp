#include "chain/reference_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace drumlin::post {

namespace {

const char *const steady_source = "reference, steady states (two independent solvers)";
const char *const meter_source = "reference, roller practice (finely sampled exact solutions)";
const char *const impact_source = "reference, single impact";

/// For accelerations and forces the tolerance is one unit of the last digit, or this share of the value. The
/// table's states were still settling: the converged direct solution lies up to 1.0e-4 of the value from it
/// (II B, force at make).
constexpr double settling_share = 2.0e-4;

using Q = ReferenceQuantity;

/// A line of the table: a value, or the ends of its range, in the unit of the table, and the digits given
/// after the point.
struct Row {
  Q quantity;
  double value;
  int decimals;
  double high = value;
};

/// What is exact: no tension under condition B, contact all the time, and no events.
bool is_exact(const Row &row) {
  return row.decimals == 0 || (row.quantity == Q::contact_force_min && row.value == 0.0);
}

ReferenceValue reference_value(const char *name, const char *transition, const Row &row) {
  const double digit = std::pow(10.0, -row.decimals);
  const double settling = std::max(digit, settling_share * std::abs(row.value));
  const auto value = [&](double tolerance, double scale, const char *unit,
                         const char *source = steady_source) {
    return ReferenceValue{
        name,  transition, row.quantity, row.value, row.high, row.decimals, is_exact(row) ? 0.0 : tolerance,
        scale, unit,       source};
  };
  switch (row.quantity) {
  case Q::drum_acceleration_min:
  case Q::drum_acceleration_max:
    return value(settling, 1.0, "m/s²");
  case Q::contact_force_min:
  case Q::contact_force_max:
  case Q::force_at_break:
  case Q::force_at_make:
    return value(settling, 1.0e-3, "kN");
  case Q::overlap_at_break:
    return value(digit, 1.0e3, "mm");
  case Q::compaction_meter_value:
    return value(digit, 1.0, "", meter_source);
  default:
    return value(digit, 1.0, "");
  }
}

/// The steady states of a case.
struct SteadyState {
  const char *name, *transitions; ///< one letter for each transition that has this state
  std::vector<Row> rows;
};

std::vector<ReferenceValue> make_values() {
  const std::vector<SteadyState> states = {
      {"I",
       "AB",
       {{Q::drum_acceleration_min, -31.795, 3},
        {Q::drum_acceleration_max, 31.795, 3},
        {Q::contact_force_min, 2.20, 2},
        {Q::contact_force_max, 56.66, 2},
        {Q::contact_share, 1.0, 0},
        {Q::breaks_per_cycle, 0.0, 0},
        {Q::makes_per_cycle, 0.0, 0}}},
      {"II",
       "A",
       {{Q::drum_acceleration_min, -43.759, 3},
        {Q::drum_acceleration_max, 96.698, 3},
        {Q::contact_force_min, -66.25, 2},
        {Q::contact_force_max, 241.39, 2},
        {Q::contact_share, 0.322, 3},
        {Q::force_at_break, -66.25, 2},
        {Q::force_at_make, 235.08, 2}}},
      {"II",
       "B",
       {{Q::drum_acceleration_min, -44.471, 3},
        {Q::drum_acceleration_max, 111.681, 3},
        {Q::contact_force_min, 0.0, 2},
        {Q::contact_force_max, 247.29, 2},
        {Q::contact_share, 0.202, 3},
        {Q::overlap_at_break, 0.860, 3},
        {Q::force_at_make, 245.67, 2},
        {Q::compaction_meter_value, 155.9, 1, 156.0}}},
      {"III",
       "A",
       {{Q::drum_acceleration_min, -43.634, 3},
        {Q::drum_acceleration_max, 37.732, 3},
        {Q::contact_force_min, -43.22, 2},
        {Q::contact_force_max, 110.72, 2},
        {Q::contact_share, 0.616, 3},
        {Q::force_at_break, -43.22, 2},
        {Q::force_at_make, 77.62, 2}}},
      {"III",
       "B",
       {{Q::drum_acceleration_min, -43.947, 3},
        {Q::drum_acceleration_max, 44.427, 3},
        {Q::contact_force_min, 0.0, 2},
        {Q::contact_force_max, 113.08, 2},
        {Q::contact_share, 0.385, 3},
        {Q::overlap_at_break, 0.488, 3},
        {Q::force_at_make, 97.39, 2},
        {Q::compaction_meter_value, 105.7, 1, 105.7}}},
      {"IV",
       "A",
       {{Q::drum_acceleration_min, -8.201, 3},
        {Q::drum_acceleration_max, 8.201, 3},
        {Q::contact_force_min, -30.37, 2},
        {Q::contact_force_max, 89.23, 2},
        {Q::contact_share, 1.0, 0},
        {Q::breaks_per_cycle, 0.0, 0},
        {Q::makes_per_cycle, 0.0, 0}}},
      {"IV",
       "B",
       {{Q::drum_acceleration_min, -43.551, 3},
        {Q::drum_acceleration_max, 128.96, 2},
        {Q::contact_force_min, 0.0, 2},
        {Q::contact_force_max, 341.1, 1},
        {Q::contact_share, 0.326, 3},
        {Q::overlap_at_break, 0.296, 3},
        {Q::force_at_make, 341.1, 1},
        {Q::compaction_meter_value, 247.0, 1, 247.3}}},
  };
  std::vector<ReferenceValue> values;
  for (const SteadyState &state : states)
    for (const char transition : std::string_view(state.transitions))
      for (const Row &row : state.rows)
        values.push_back(reference_value(state.name, transition == 'A' ? "A" : "B", row));
  return values;
}

/// Steps per cycle of the columns of the error table.
constexpr std::array<int, 6> error_steps{200, 400, 800, 1600, 3200, 6400};
struct ErrorRow {
  const char *case_name;
  std::array<double, 6> error;
};
constexpr std::array<ErrorRow, 4> error_rows{{{"I", {6.3e-5, 1.6e-5, 3.9e-6, 9.9e-7, 2.5e-7, 6.2e-8}},
                                              {"II", {1.0e-3, 2.8e-4, 5.3e-5, 6.5e-6, 2.2e-6, 6.6e-7}},
                                              {"III", {1.3e-4, 3.4e-5, 8.5e-6, 2.1e-6, 5.2e-7, 1.4e-7}},
                                              {"IV", {3.8e-4, 3.6e-4, 8.5e-5, 1.6e-5, 3.8e-6, 5.2e-7}}}};
constexpr ErrorRow stock_row{"II", {1.8e-2, 1.4e-2, 4.4e-3, 3.5e-3, 1.1e-3, 7.5e-4}};

std::optional<double> error_in_row(const ErrorRow &row, int steps_per_cycle) {
  for (std::size_t i = 0; i < error_steps.size(); ++i)
    if (error_steps[i] == steps_per_cycle) return row.error[i];
  return std::nullopt;
}

} // namespace

std::string quantity_name(ReferenceQuantity quantity) {
  constexpr std::array<const char *, 11> names = {
      "drum acceleration, min",   "drum acceleration, max", "contact force, min", "contact force, max",
      "share of time in contact", "contact force at break", "overlap at break",   "contact force at make",
      "breaks per cycle",         "makes per cycle",        "meter value CMV"};
  return names.at(static_cast<std::size_t>(quantity));
}

const std::vector<ReferenceValue> &reference_values() {
  static const std::vector<ReferenceValue> values = make_values();
  return values;
}

const std::vector<ReferenceRestitution> &reference_restitutions() {
  static const std::vector<ReferenceRestitution> values{
      {"A", 0.2, 0.526621, 1.0e-4, impact_source}, {"A", 0.5, 0.163034, 1.0e-4, impact_source},
      {"A", 0.8, 0.015165, 1.0e-4, impact_source}, {"B", 0.2, 0.571740, 1.0e-4, impact_source},
      {"B", 0.5, 0.298436, 1.0e-4, impact_source}, {"B", 0.8, 0.179783, 1.0e-4, impact_source},
      {"B", 2.0, 0.047769, 1.0e-4, impact_source}};
  return values;
}

std::optional<double> reference_velocity_error(const std::string &case_name, int steps_per_cycle) {
  for (const ErrorRow &row : error_rows)
    if (case_name == row.case_name) return error_in_row(row, steps_per_cycle);
  return std::nullopt;
}

std::optional<double> reference_stock_velocity_error(const std::string &case_name, int steps_per_cycle) {
  if (case_name != stock_row.case_name) return std::nullopt;
  return error_in_row(stock_row, steps_per_cycle);
}

double closed_form_restitution(const std::string &transition, double damping_ratio) {
  const double D = damping_ratio;
  const double pi = std::acos(-1.0);
  // Time in units of 1/w0: d'' + 2 D d' + d = 0, d(0) = 0, d'(0) = 1.
  if (transition == "A") {
    if (D >= 1.0) return 0.0;
    return std::exp(-pi * D / std::sqrt(1.0 - D * D));
  }
  // B ends where d'' = 0, that is 2 D d' + d = 0; by then d' = -e.
  if (D == 0.0) return 1.0;
  const double tiny = 1.0e-9;
  if (std::abs(D - 1.0) < tiny) return std::exp(-2.0); // d = t exp(-t), d'' = 0 at t = 2
  if (D < 1.0) {
    const double w = std::sqrt(1.0 - D * D);
    // d'' = 0: tan(w t) = 2 D w / (2 D^2 - 1) = first positive root; atan2 covers both branches.
    const double angle = std::atan2(2.0 * D * w, 2.0 * D * D - 1.0);
    const double t = angle / w;
    return std::exp(-D * t) * (D / w * std::sin(angle) - std::cos(angle));
  }
  const double s = std::sqrt(D * D - 1.0);
  const double t = std::atanh(2.0 * D * s / (2.0 * D * D - 1.0)) / s;
  return std::exp(-D * t) * (D / s * std::sinh(s * t) - std::cosh(s * t));
}

} // namespace drumlin::post
