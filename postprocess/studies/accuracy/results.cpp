#include "studies/accuracy/results.h"

#include "chain/run_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// A measured number: six digits are more than any error has; nothing if there is none.
std::string measured(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : ""; }

struct ErrorColumn {
  const char *name;
  double ChainErrors::*value;
};
constexpr std::array<ErrorColumn, 7> error_columns = {{{"velocity_error", &ChainErrors::velocity},
                                                       {"force_error", &ChainErrors::force},
                                                       {"acceleration_error", &ChainErrors::acceleration},
                                                       {"event_time_error_s", &ChainErrors::event_time_s},
                                                       {"energy_residual", &ChainErrors::energy},
                                                       {"loop_s", &ChainErrors::loop_s},
                                                       {"wall_s", &ChainErrors::wall_s}}};

struct ParameterColumn {
  const char *name;
  double ChainParameters::*value;
};
constexpr std::array<ParameterColumn, 9> parameter_columns = {{{"k_N_per_m", &ChainParameters::k},
                                                               {"D", &ChainParameters::D},
                                                               {"omega_rad_per_s", &ChainParameters::omega},
                                                               {"Fw_N", &ChainParameters::Fw},
                                                               {"m2_kg", &ChainParameters::m2},
                                                               {"m3_kg", &ChainParameters::m3},
                                                               {"k23_N_per_m", &ChainParameters::k23},
                                                               {"c23_N_s_per_m", &ChainParameters::c23},
                                                               {"g_m_per_s2", &ChainParameters::g}}};

template <typename Columns>
std::vector<std::string> header(std::vector<std::string> first, const Columns &columns,
                                const std::vector<std::string> &last) {
  for (const auto &column : columns)
    first.emplace_back(column.name);
  first.insert(first.end(), last.begin(), last.end());
  return first;
}

/// The cells of a file by column, empty ones as NaN.
class Cells {
public:
  explicit Cells(const fs::path &file) : table_(read_table(file)) {}
  std::size_t rows() const { return table_.rows(); }
  std::vector<std::string> text(const std::string &column) const { return table_.text(column); }
  std::vector<double> numbers(const std::string &column) const {
    std::vector<double> values;
    for (const std::string &cell : table_.text(column))
      try {
        values.push_back(cell.empty() ? std::numeric_limits<double>::quiet_NaN() : number_from_text(cell));
      } catch (const std::invalid_argument &error) {
        throw std::runtime_error(
            fmt::format("{}: column {}: {}", table_.file().string(), column, error.what()));
      }
    return values;
  }
  std::vector<Transition> transitions() const {
    std::vector<Transition> values;
    for (const std::string &cell : table_.text("transition"))
      try {
        values.push_back(transition_from_name(cell));
      } catch (const std::invalid_argument &error) {
        throw std::runtime_error(fmt::format("{}: {}", table_.file().string(), error.what()));
      }
    return values;
  }
  std::vector<int> integers(const std::string &column) const {
    const std::vector<long> read = table_.integers(column);
    return {read.begin(), read.end()};
  }

private:
  Table table_;
};

std::vector<ErrorPoint> in_order(std::vector<ErrorPoint> points) {
  std::sort(points.begin(), points.end(),
            [](const ErrorPoint &a, const ErrorPoint &b) { return a.steps < b.steps; });
  return points;
}

} // namespace

const std::vector<std::string> chain_point_columns =
    header({"case", "transition", "stepping", "steps_per_cycle"}, error_columns,
           {"events", "events_truth", "loop_s_per_cycle"});
const std::vector<std::string> impact_point_columns = {
    "transition", "D", "stepping", "steps_per_contact", "worst_restitution_error", "rms_restitution_error"};
const std::vector<std::string> scaling_point_columns =
    header({"set", "stepping", "target_error", "transition"}, parameter_columns,
           {"steps_per_cycle", "velocity_error"});

std::vector<std::string> cells(const ChainPoint &point) {
  std::vector<std::string> row = {point.chain_case, transition_name(point.transition), point.stepping,
                                  std::to_string(point.steps_per_cycle)};
  for (const ErrorColumn &column : error_columns)
    row.push_back(measured(point.errors.*column.value));
  row.insert(row.end(), {std::to_string(point.errors.events), std::to_string(point.errors.events_truth),
                         measured(point.errors.loop_s / accuracy_cycles)});
  return row;
}

std::vector<std::string> cells(const ImpactPoint &point) {
  return {transition_name(point.transition),
          fmt::format("{:g}", point.damping_ratio),
          point.stepping,
          fmt::format("{:g}", point.steps_per_contact),
          measured(point.errors.worst),
          measured(point.errors.rms)};
}

std::vector<std::string> cells(const ScalingPoint &point) {
  std::vector<std::string> row = {std::to_string(point.set), point.stepping,
                                  fmt::format("{:g}", point.target),
                                  transition_name(point.parameters.transition)};
  for (const ParameterColumn &column : parameter_columns)
    row.push_back(number_text(point.parameters.*column.value));
  row.insert(row.end(), {std::to_string(point.steps_per_cycle), measured(point.error)});
  return row;
}

std::vector<ChainPoint> read_chain_points(const fs::path &file) {
  if (!fs::exists(file)) return {};
  const Cells table(file);
  std::vector<ChainPoint> points(table.rows());
  const auto cases = table.text("case"), steppings = table.text("stepping");
  const auto transitions = table.transitions();
  const auto steps = table.integers("steps_per_cycle"), events = table.integers("events"),
             truth = table.integers("events_truth");
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = {cases[i], transitions[i], steppings[i], steps[i], {}};
    points[i].errors.events = events[i];
    points[i].errors.events_truth = truth[i];
  }
  for (const ErrorColumn &column : error_columns) {
    const std::vector<double> values = table.numbers(column.name);
    for (std::size_t i = 0; i < points.size(); ++i)
      points[i].errors.*column.value = values[i];
  }
  return points;
}

std::vector<ImpactPoint> read_impact_points(const fs::path &file) {
  if (!fs::exists(file)) return {};
  const Cells table(file);
  std::vector<ImpactPoint> points;
  const auto steppings = table.text("stepping");
  const auto transitions = table.transitions();
  const auto ratios = table.numbers("D"), steps = table.numbers("steps_per_contact"),
             worst = table.numbers("worst_restitution_error"), rms = table.numbers("rms_restitution_error");
  for (std::size_t i = 0; i < table.rows(); ++i)
    points.push_back({transitions[i], ratios[i], steppings[i], steps[i], {worst[i], rms[i]}});
  return points;
}

std::vector<ScalingPoint> read_scaling_points(const fs::path &file) {
  if (!fs::exists(file)) return {};
  const Cells table(file);
  std::vector<ScalingPoint> points(table.rows());
  const auto sets = table.integers("set"), steps = table.integers("steps_per_cycle");
  const auto steppings = table.text("stepping");
  const auto targets = table.numbers("target_error"), errors = table.numbers("velocity_error");
  const auto transitions = table.transitions();
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = {sets[i], steppings[i], targets[i], {}, steps[i], errors[i]};
    points[i].parameters.transition = transitions[i];
  }
  for (const ParameterColumn &column : parameter_columns) {
    const std::vector<double> values = table.numbers(column.name);
    for (std::size_t i = 0; i < points.size(); ++i)
      points[i].parameters.*column.value = values[i];
  }
  return points;
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
