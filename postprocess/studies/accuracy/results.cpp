#include "studies/accuracy/results.h"

#include "chain/run_files.h"
#include "studies/study.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace drumlin::post {

namespace {

/// Six digits are more than any measured error has.
constexpr int measured = 6;

/// The column "transition" of the member that `of(row)` refers to.
template <class Row, class Of>
CsvColumn<Row> transition_column(Of of) {
  return {"transition", [of](const Row &row) { return transition_name(of(row)); },
          [of](Row &row, const std::string &cell) {
            if (cell != "A" && cell != "B") throw std::invalid_argument("A, B");
            of(row) = transition_from_name(cell);
          }};
}

constexpr auto own_transition = [](auto &row) -> auto & { return row.transition; };

std::vector<ErrorPoint> in_order(std::vector<ErrorPoint> points) {
  std::sort(points.begin(), points.end(),
            [](const ErrorPoint &a, const ErrorPoint &b) { return a.steps < b.steps; });
  return points;
}

} // namespace

const CsvSchema<ChainPoint> &chain_points() {
  const auto error = [](const char *name, double ChainErrors::*value) {
    return csv_column(name, &ChainPoint::errors, value, measured);
  };
  static const CsvSchema<ChainPoint> schema(
      {csv_column("case", &ChainPoint::chain_case),
       transition_column<ChainPoint>(own_transition),
       csv_column("stepping", &ChainPoint::stepping),
       csv_column("steps_per_cycle", &ChainPoint::steps_per_cycle),
       error("velocity_error", &ChainErrors::velocity),
       error("force_error", &ChainErrors::force),
       error("acceleration_error", &ChainErrors::acceleration),
       error("event_time_error_s", &ChainErrors::event_time_s),
       error("energy_residual", &ChainErrors::energy),
       error("loop_s", &ChainErrors::loop_s),
       error("wall_s", &ChainErrors::wall_s),
       csv_column("events", &ChainPoint::errors, &ChainErrors::events),
       csv_column("events_truth", &ChainPoint::errors, &ChainErrors::events_reference),
       {"loop_s_per_cycle",
        [](const ChainPoint &point) { return csv_text(point.errors.loop_s / accuracy_cycles, measured); },
        {}}},
      4);
  return schema;
}

const CsvSchema<ImpactPoint> &impact_points() {
  static const CsvSchema<ImpactPoint> schema(
      {transition_column<ImpactPoint>(own_transition), csv_column("D", &ImpactPoint::damping_ratio, measured),
       csv_column("stepping", &ImpactPoint::stepping),
       csv_column("steps_per_contact", &ImpactPoint::steps_per_contact, measured),
       csv_column("worst_restitution_error", &ImpactPoint::errors, &ImpactErrors::worst, measured),
       csv_column("rms_restitution_error", &ImpactPoint::errors, &ImpactErrors::rms, measured)},
      4);
  return schema;
}

const CsvSchema<ScalingPoint> &scaling_points() {
  const auto parameter = [](const char *name, double ChainParameters::*value) {
    return csv_column(name, &ScalingPoint::parameters, value);
  };
  static const CsvSchema<ScalingPoint> schema(
      {csv_column("set", &ScalingPoint::set), csv_column("stepping", &ScalingPoint::stepping),
       csv_column("target_error", &ScalingPoint::target, measured),
       transition_column<ScalingPoint>([](auto &row) -> auto & { return row.parameters.transition; }),
       parameter("k_N_per_m", &ChainParameters::k), parameter("D", &ChainParameters::D),
       parameter("omega_rad_per_s", &ChainParameters::omega), parameter("Fw_N", &ChainParameters::Fw),
       parameter("m2_kg", &ChainParameters::m2), parameter("m3_kg", &ChainParameters::m3),
       parameter("k23_N_per_m", &ChainParameters::k23), parameter("c23_N_s_per_m", &ChainParameters::c23),
       parameter("g_m_per_s2", &ChainParameters::g),
       csv_column("steps_per_cycle", &ScalingPoint::steps_per_cycle),
       csv_column("velocity_error", &ScalingPoint::error, measured)},
      3);
  return schema;
}

std::vector<std::string> larger_errors(const std::vector<ChainPoint> &points,
                                       const std::vector<ChainPoint> &known, bool complete) {
  static const std::pair<const char *, double ChainErrors::*> errors[] = {
      {"velocity_error", &ChainErrors::velocity},
      {"force_error", &ChainErrors::force},
      {"acceleration_error", &ChainErrors::acceleration},
      {"event_time_error_s", &ChainErrors::event_time_s},
      {"energy_residual", &ChainErrors::energy}};
  std::vector<std::string> larger;
  const auto report = [&](const ChainPoint &point, const std::string &words) {
    larger.push_back(fmt::format("{} {}, {}, {} steps per cycle: {}", point.chain_case,
                                 transition_name(point.transition), point.stepping, point.steps_per_cycle,
                                 words));
  };
  for (const ChainPoint &point : points) {
    const ChainPoint *before = find_point(known, chain_points(), point);
    if (before == nullptr) {
      report(point, "not known");
      continue;
    }
    for (const auto &[name, error] : errors) {
      const double was = before->errors.*error, is = point.errors.*error;
      if (std::isfinite(was) && !(is <= allowed_growth * was)) // NaN, too
        report(point, fmt::format("{} {:g}, known {:g}", name, is, was));
    }
  }
  for (const ChainPoint &point : known)
    if (complete && find_point(points, chain_points(), point) == nullptr) report(point, "not measured");
  return larger;
}

std::vector<ErrorPoint> chain_curve(const std::vector<ChainPoint> &points, const std::string &chain_case,
                                    Transition transition, const std::string &stepping,
                                    double ChainErrors::*error) {
  std::vector<ErrorPoint> curve;
  for (const ChainPoint &point : points)
    if (point.chain_case == chain_case && point.transition == transition && point.stepping == stepping)
      curve.push_back({static_cast<double>(point.steps_per_cycle), point.errors.*error});
  return in_order(std::move(curve));
}

std::vector<ErrorPoint> impact_curve(const std::vector<ImpactPoint> &points, Transition transition,
                                     double damping_ratio, const std::string &stepping,
                                     double ImpactErrors::*error) {
  std::vector<ErrorPoint> curve;
  for (const ImpactPoint &point : points)
    if (point.transition == transition && point.damping_ratio == damping_ratio && point.stepping == stepping)
      curve.push_back({point.steps_per_contact, point.errors.*error});
  return in_order(std::move(curve));
}

} // namespace drumlin::post
