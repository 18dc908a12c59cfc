#include "chain/reference_values.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace drumlin::post {

namespace {

const char *const steady_source = "reference, steady states (two independent solvers)";
const char *const meter_source = "reference, roller practice (finely sampled exact solutions)";
const char *const impact_source = "reference, single impact";

/// One unit of the last digit given.
double last_digit(int decimals) { return std::pow(10.0, -decimals); }

/// For accelerations and forces: one unit of the last digit, or this share of the value. The table's states
/// were still settling: the converged direct solution lies up to 1.0e-4 of the value from it (II B, force at
/// make).
constexpr double settling_share = 2.0e-4;
double settling(double value, int decimals) {
  return std::max(last_digit(decimals), settling_share * std::abs(value));
}

ReferenceValue acceleration(const char *name, const char *transition, ReferenceQuantity quantity,
                            double value, int decimals) {
  return {name, transition, quantity,     value, value, decimals, settling(value, decimals),
          1.0,  "m/s²",     steady_source};
}

ReferenceValue force(const char *name, const char *transition, ReferenceQuantity quantity, double kilonewton,
                     int decimals) {
  return {name,   transition, quantity,     kilonewton, kilonewton, decimals, settling(kilonewton, decimals),
          1.0e-3, "kN",       steady_source};
}

/// Under condition B there is no tension: the value must be exactly zero.
ReferenceValue no_tension(const char *name) {
  return {name, "B", ReferenceQuantity::contact_force_min, 0.0, 0.0, 2, 0.0, 1.0e-3, "kN", steady_source};
}

ReferenceValue overlap(const char *name, const char *transition, double millimetre) {
  return {name,          transition, ReferenceQuantity::overlap_at_break,
          millimetre,    millimetre, 3,
          last_digit(3), 1.0e3,      "mm",
          steady_source};
}

ReferenceValue share(const char *name, const char *transition, double value, int decimals) {
  // "1" stands for contact all the time: exact.
  const double tolerance = decimals == 0 ? 0.0 : last_digit(decimals);
  return {name, transition,   ReferenceQuantity::contact_share, value, value, decimals, tolerance, 1.0,
          "",   steady_source};
}

ReferenceValue none(const char *name, const char *transition, ReferenceQuantity quantity) {
  return {name, transition, quantity, 0.0, 0.0, 0, 0.0, 1.0, "", steady_source};
}

ReferenceValue meter(const char *name, double low, double high) {
  return {name, "B",         ReferenceQuantity::compaction_meter_value, low, high, 1, last_digit(1), 1.0,
          "",   meter_source};
}

/// The table itself: longer than other functions, since it has a line for each value and nothing else.
std::vector<ReferenceValue> make_values() {
  using Q = ReferenceQuantity;
  std::vector<ReferenceValue> values;
  const auto add = [&values](ReferenceValue value) { values.push_back(std::move(value)); };
  for (const char *transition : {"A", "B"}) {
    add(acceleration("I", transition, Q::drum_acceleration_min, -31.795, 3));
    add(acceleration("I", transition, Q::drum_acceleration_max, 31.795, 3));
    add(force("I", transition, Q::contact_force_min, 2.20, 2));
    add(force("I", transition, Q::contact_force_max, 56.66, 2));
    add(share("I", transition, 1.0, 0));
    add(none("I", transition, Q::breaks_per_cycle));
    add(none("I", transition, Q::makes_per_cycle));
  }
  add(acceleration("II", "A", Q::drum_acceleration_min, -43.759, 3));
  add(acceleration("II", "A", Q::drum_acceleration_max, 96.698, 3));
  add(force("II", "A", Q::contact_force_min, -66.25, 2));
  add(force("II", "A", Q::contact_force_max, 241.39, 2));
  add(share("II", "A", 0.322, 3));
  add(force("II", "A", Q::force_at_break, -66.25, 2));
  add(force("II", "A", Q::force_at_make, 235.08, 2));

  add(acceleration("II", "B", Q::drum_acceleration_min, -44.471, 3));
  add(acceleration("II", "B", Q::drum_acceleration_max, 111.681, 3));
  add(no_tension("II"));
  add(force("II", "B", Q::contact_force_max, 247.29, 2));
  add(share("II", "B", 0.202, 3));
  add(overlap("II", "B", 0.860));
  add(force("II", "B", Q::force_at_make, 245.67, 2));
  add(meter("II", 155.9, 156.0));

  add(acceleration("III", "A", Q::drum_acceleration_min, -43.634, 3));
  add(acceleration("III", "A", Q::drum_acceleration_max, 37.732, 3));
  add(force("III", "A", Q::contact_force_min, -43.22, 2));
  add(force("III", "A", Q::contact_force_max, 110.72, 2));
  add(share("III", "A", 0.616, 3));
  add(force("III", "A", Q::force_at_break, -43.22, 2));
  add(force("III", "A", Q::force_at_make, 77.62, 2));

  add(acceleration("III", "B", Q::drum_acceleration_min, -43.947, 3));
  add(acceleration("III", "B", Q::drum_acceleration_max, 44.427, 3));
  add(no_tension("III"));
  add(force("III", "B", Q::contact_force_max, 113.08, 2));
  add(share("III", "B", 0.385, 3));
  add(overlap("III", "B", 0.488));
  add(force("III", "B", Q::force_at_make, 97.39, 2));
  add(meter("III", 105.7, 105.7));

  add(acceleration("IV", "A", Q::drum_acceleration_min, -8.201, 3));
  add(acceleration("IV", "A", Q::drum_acceleration_max, 8.201, 3));
  add(force("IV", "A", Q::contact_force_min, -30.37, 2));
  add(force("IV", "A", Q::contact_force_max, 89.23, 2));
  add(share("IV", "A", 1.0, 0));
  add(none("IV", "A", Q::breaks_per_cycle));
  add(none("IV", "A", Q::makes_per_cycle));

  add(acceleration("IV", "B", Q::drum_acceleration_min, -43.551, 3));
  add(acceleration("IV", "B", Q::drum_acceleration_max, 128.96, 2));
  add(no_tension("IV"));
  add(force("IV", "B", Q::contact_force_max, 341.1, 1));
  add(share("IV", "B", 0.326, 3));
  add(overlap("IV", "B", 0.296));
  add(force("IV", "B", Q::force_at_make, 341.1, 1));
  add(meter("IV", 247.0, 247.3));
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
  switch (quantity) {
  case ReferenceQuantity::drum_acceleration_min:
    return "drum acceleration, min";
  case ReferenceQuantity::drum_acceleration_max:
    return "drum acceleration, max";
  case ReferenceQuantity::contact_force_min:
    return "contact force, min";
  case ReferenceQuantity::contact_force_max:
    return "contact force, max";
  case ReferenceQuantity::contact_share:
    return "share of time in contact";
  case ReferenceQuantity::force_at_break:
    return "contact force at break";
  case ReferenceQuantity::overlap_at_break:
    return "overlap at break";
  case ReferenceQuantity::force_at_make:
    return "contact force at make";
  case ReferenceQuantity::breaks_per_cycle:
    return "breaks per cycle";
  case ReferenceQuantity::makes_per_cycle:
    return "makes per cycle";
  case ReferenceQuantity::compaction_meter_value:
    return "meter value CMV";
  }
  return "unknown";
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
