#include "advice/step_errors.h"

#include <algorithm>
#include <stdexcept>

namespace drumlin::post {

ExactSolution accuracy_reference(const ChainParameters &parameters, const SolverProgress &progress) {
  ExactOptions options;
  options.cycles = accuracy_cycles;
  options.samples_per_cycle = accuracy_samples;
  return solve_chain(parameters, options, progress);
}

namespace {

/// The column "transition" of the member that `of(row)` refers to.
template <class Row, class Of>
CsvColumn<Row> transition_column(Of of) {
  return {"transition", [of](const Row &row) { return transition_name(of(row)); },
          [of](Row &row, const std::string &cell) {
            if (cell != "A" && cell != "B") throw std::invalid_argument("A, B");
            of(row) = transition_from_name(cell);
          }};
}

} // namespace

const CsvSchema<ChainPoint> &chain_points() {
  const auto error = [](const char *name, double ChainErrors::*value) {
    return csv_column(name, &ChainPoint::errors, value);
  };
  static const CsvSchema<ChainPoint> schema(
      {csv_column("case", &ChainPoint::chain_case),
       transition_column<ChainPoint>([](auto &row) -> auto & { return row.transition; }),
       csv_column("stepping", &ChainPoint::stepping),
       csv_column("steps_per_cycle", &ChainPoint::steps_per_cycle),
       error("velocity_error", &ChainErrors::velocity), error("force_error", &ChainErrors::force),
       error("acceleration_error", &ChainErrors::acceleration), error("loop_s", &ChainErrors::loop_s)},
      4);
  return schema;
}

const CsvSchema<ScalingPoint> &scaling_points() {
  const auto parameter = [](const char *name, double ChainParameters::*value) {
    return csv_column(name, &ScalingPoint::parameters, value);
  };
  static const CsvSchema<ScalingPoint> schema(
      {csv_column("stepping", &ScalingPoint::stepping), csv_column("target_error", &ScalingPoint::target),
       transition_column<ScalingPoint>([](auto &row) -> auto & { return row.parameters.transition; }),
       parameter("k_N_per_m", &ChainParameters::k), parameter("D", &ChainParameters::D),
       parameter("omega_rad_per_s", &ChainParameters::omega), parameter("Fw_N", &ChainParameters::Fw),
       parameter("m2_kg", &ChainParameters::m2), parameter("m3_kg", &ChainParameters::m3),
       parameter("k23_N_per_m", &ChainParameters::k23), parameter("c23_N_s_per_m", &ChainParameters::c23),
       parameter("g_m_per_s2", &ChainParameters::g),
       csv_column("steps_per_cycle", &ScalingPoint::steps_per_cycle),
       csv_column("velocity_error", &ScalingPoint::error)},
      4);
  return schema;
}

std::vector<ErrorPoint> chain_curve(const std::vector<ChainPoint> &points, const std::string &chain_case,
                                    Transition transition, const std::string &stepping,
                                    double ChainErrors::*error) {
  std::vector<ErrorPoint> curve;
  for (const ChainPoint &point : points)
    if (point.chain_case == chain_case && point.transition == transition && point.stepping == stepping)
      curve.push_back({static_cast<double>(point.steps_per_cycle), point.errors.*error});
  std::sort(curve.begin(), curve.end(),
            [](const ErrorPoint &a, const ErrorPoint &b) { return a.steps < b.steps; });
  return curve;
}

} // namespace drumlin::post
