#include "map/engine_points.h"

#include "runs/chain_files.h"
#include "engine/deck_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace drumlin::post {

namespace {

// The digits of a whole number, mirrored behind the point: 1, 2, 3, ... fill the interval from 0 to 1 evenly.
double mirrored_digits(std::size_t number, std::size_t base) {
  double value = 0.0;
  double place = 1.0;
  for (; number > 0; number /= base) {
    place /= static_cast<double>(base);
    value += place * static_cast<double>(number % base);
  }
  return value;
}

// Largest distance of a state from the one `period` cycles before, over judged_cycles states of which the
// last is states[end].
double repetition(const std::vector<ChainState> &states, std::size_t end, std::size_t period,
                  const ChainState &scale) {
  double most = 0.0;
  for (std::size_t i = end + 1 - judged_cycles; i <= end; ++i)
    most = std::max(most, (states[i] - states[i - period]).cwiseQuotient(scale).norm());
  return most;
}

} // namespace

CsvSchema<EnginePoint> engine_point_columns(const MapGrid &grid) {
  return CsvSchema<EnginePoint>(
      {csv_column(grid.x.label(), &EnginePoint::x), csv_column(grid.y.label(), &EnginePoint::y),
       csv_column("regime_exact", &EnginePoint::exact), csv_column("regime_engine", &EnginePoint::engine),
       csv_column("peak_force_exact [N]", &EnginePoint::exact_peak),
       csv_column("peak_force_engine [N]", &EnginePoint::engine_peak),
       csv_column("difference_of_peak_force [-]", &EnginePoint::difference),
       csv_column("steps_per_cycle", &EnginePoint::steps)},
      2);
}

std::vector<std::size_t> spread_points(const MapGrid &grid, std::size_t count) {
  const auto columns = static_cast<std::size_t>(grid.x.count);
  const auto rows = static_cast<std::size_t>(grid.y.count);
  std::vector<bool> taken(grid.size());
  std::vector<std::size_t> points;
  count = std::min(count, grid.size());
  for (std::size_t i = 1; points.size() < count; ++i) {
    const auto column = static_cast<std::size_t>(mirrored_digits(i, 2) * static_cast<double>(columns));
    const auto row = static_cast<std::size_t>(mirrored_digits(i, 3) * static_cast<double>(rows));
    const std::size_t point = std::min(row, rows - 1) * columns + std::min(column, columns - 1);
    if (taken[point]) continue;
    taken[point] = true;
    points.push_back(point);
  }
  return points;
}

int engine_steps(const ChainParameters &p) {
  constexpr double least = 2000.0;
  constexpr double largest_phase = 0.02; // of the contact's oscillation per step, rad
  const double steps = std::ceil(p.period() * std::sqrt(p.k / p.m2) / largest_phase);
  return static_cast<int>(std::clamp(steps, least, 1e8));
}

Regime regime_of_run(const std::vector<ChainState> &states, bool in_contact, const ChainState &scale) {
  if (in_contact) return Regime::continuous_contact;
  if (states.size() < 2 * judged_cycles + longest_period) return Regime::undecided;
  constexpr double same = 1e-4;
  constexpr double near = 0.02;
  const std::size_t last = states.size() - 1;
  bool approaches = false;
  for (std::size_t period = 1; period <= longest_period; ++period) {
    const double now = repetition(states, last, period, scale);
    if (now < same)
      return period == 1 ? Regime::partial_uplift : period == 2 ? Regime::period_2 : Regime::higher_period;
    approaches =
        approaches || (now < near && now < 0.9 * repetition(states, last - judged_cycles, period, scale));
  }
  return approaches ? Regime::undecided : Regime::aperiodic;
}

EnginePoint run_engine_point(const MapGrid &grid, std::size_t point, const RegimePoint &exact,
                             Engine engine) {
  const ChainParameters p = grid.at(grid.x_of(point), grid.y_of(point));
  EnginePoint result;
  result.x = grid.x_of(point);
  result.y = grid.y_of(point);
  result.steps = engine_steps(p);
  Variables variables;
  for (const auto &[name, value] : parameter_values(p))
    variables.emplace_back(name, value);
  variables.insert(variables.end(), {{"cycles", fmt::format("{}", grid.cycles)},
                                     {"steps_per_cycle", fmt::format("{}", result.steps)},
                                     {"samples_per_cycle", "1"}});
  const DeckRun run(engine == Engine::lammps ? "chain/in.chain.lammps" : "chain/in.chain", variables);
  run.must_succeed();

  const ChainHistory history = read_chain(run.file("chain.csv"));
  std::vector<ChainState> states;
  for (std::size_t i = 0; i < history.size(); ++i)
    states.emplace_back(history.x_drum[i], history.v_drum[i], history.x_frame[i], history.v_frame[i]);
  const std::vector<ContactEvent> events = read_events(run.file("events.csv"));
  const double judged_from = (grid.cycles - static_cast<double>(judged_cycles)) * p.period();
  const bool in_contact = events.empty() || (events.back().make && events.back().time < judged_from);
  constexpr std::size_t peak_cycles = 64;
  const CycleColumns cycles = read_cycle_columns(run.file("cycles.csv"));
  const std::vector<double> &peaks = cycles.at("F_contact_max");
  for (std::size_t i = cycles.rows - std::min(peak_cycles, cycles.rows); i < cycles.rows; ++i)
    result.engine_peak = std::max(result.engine_peak, peaks[i]);
  result.exact = regime_names[static_cast<std::size_t>(exact.regime)];
  result.engine = regime_names[static_cast<std::size_t>(regime_of_run(states, in_contact, state_scale(p)))];
  result.exact_peak = exact.meter.peak_force;
  if (result.exact_peak > 0.0) result.difference = result.engine_peak / result.exact_peak - 1.0;
  return result;
}

} // namespace drumlin::post
