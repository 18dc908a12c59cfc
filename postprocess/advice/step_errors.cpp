#include "advice/step_errors.h"

#include <algorithm>
#include <utility>

namespace drumlin::post {

ExactSolution accuracy_reference(const ChainParameters &parameters, const SolverProgress &progress) {
  ExactOptions options;
  options.cycles = accuracy_cycles;
  options.samples_per_cycle = accuracy_samples;
  return solve_chain(parameters, options, progress);
}

std::vector<ErrorPoint> in_order(std::vector<ErrorPoint> points) {
  std::sort(points.begin(), points.end(),
            [](const ErrorPoint &a, const ErrorPoint &b) { return a.steps < b.steps; });
  return points;
}

const CsvSchema<ChainPoint> &chain_points() {
  const auto error = [](const char *name, double ChainErrors::*value) {
    return csv_column(name, &ChainPoint::errors, value, error_digits);
  };
  static const CsvSchema<ChainPoint> schema(
      {csv_column("case", &ChainPoint::chain_case),
       transition_column<ChainPoint>([](auto &row) -> auto & { return row.transition; }),
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
        [](const ChainPoint &point) { return csv_text(point.errors.loop_s / accuracy_cycles, error_digits); },
        {}}},
      4);
  return schema;
}

const CsvSchema<ScalingPoint> &scaling_points() {
  const auto parameter = [](const char *name, double ChainParameters::*value) {
    return csv_column(name, &ScalingPoint::parameters, value);
  };
  static const CsvSchema<ScalingPoint> schema(
      {csv_column("set", &ScalingPoint::set), csv_column("stepping", &ScalingPoint::stepping),
       csv_column("target_error", &ScalingPoint::target, error_digits),
       transition_column<ScalingPoint>([](auto &row) -> auto & { return row.parameters.transition; }),
       parameter("k_N_per_m", &ChainParameters::k), parameter("D", &ChainParameters::D),
       parameter("omega_rad_per_s", &ChainParameters::omega), parameter("Fw_N", &ChainParameters::Fw),
       parameter("m2_kg", &ChainParameters::m2), parameter("m3_kg", &ChainParameters::m3),
       parameter("k23_N_per_m", &ChainParameters::k23), parameter("c23_N_s_per_m", &ChainParameters::c23),
       parameter("g_m_per_s2", &ChainParameters::g),
       csv_column("steps_per_cycle", &ScalingPoint::steps_per_cycle),
       csv_column("velocity_error", &ScalingPoint::error, error_digits)},
      3);
  return schema;
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

} // namespace drumlin::post
