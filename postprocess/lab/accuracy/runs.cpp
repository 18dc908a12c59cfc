#include "lab/accuracy/runs.h"

#include "chain/analysis.h"
#include "engine/deck_run.h"
#include "runs/chain_files.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

namespace drumlin::post {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

double velocity_error(const std::vector<double> &v_drum, const ExactSolution &reference) {
  const std::size_t rows = static_cast<std::size_t>(accuracy_cycles) * accuracy_samples;
  if (v_drum.size() != rows + 1 || reference.history.size() != rows + 1)
    throw std::logic_error("a run with another number of rows than its reference solution");
  return relative_rms(v_drum, reference.history.v_drum, rows - accuracy_window * accuracy_samples, rows + 1);
}

/// Largest magnitudes over the window.
struct Peaks {
  double force;
  double acceleration;
};

Peaks peaks_of(const ExactSolution &reference) {
  Peaks peaks{0.0, 0.0};
  for (std::size_t i = reference.cycles.size() - accuracy_window; i < reference.cycles.size(); ++i) {
    const CycleSummary &cycle = reference.cycles[i];
    peaks.force = std::max(peaks.force, cycle.F_contact_max);
    peaks.acceleration =
        std::max({peaks.acceleration, std::fabs(cycle.a_drum_min), std::fabs(cycle.a_drum_max)});
  }
  return peaks;
}

} // namespace

ChainErrors measure_chain(const ChainParameters &parameters, const std::string &stepping, int steps_per_cycle,
                          const ExactSolution &reference) {
  const ChainParameters &p = parameters;
  Variables variables = parameter_values(p);
  variables.insert(variables.end(), {{"stepping", stepping},
                                     {"cycles", std::to_string(accuracy_cycles)},
                                     {"steps_per_cycle", std::to_string(steps_per_cycle)},
                                     {"samples_per_cycle", std::to_string(accuracy_samples)},
                                     {"settle_limit", "2000000000"}});
  const DeckRun run("chain/in.chain", variables);
  run.must_succeed();
  const ChainHistory history = read_chain(run.file("chain.csv"));
  const std::vector<ContactEvent> events = read_events(run.file("events.csv"));
  const CycleColumns cycles = read_cycle_columns(run.file("cycles.csv"));

  ChainErrors errors{};
  errors.velocity = velocity_error(history.v_drum, reference);
  const SteadyExtremes extremes =
      steady_extremes(history, events, cycles, p,
                      last_cycles_window(accuracy_cycles, accuracy_window, p.period()), accuracy_window);
  const Peaks exact = peaks_of(reference);
  errors.force = std::fabs(extremes.force.max / exact.force - 1.0);
  errors.acceleration =
      std::fabs(std::max(std::fabs(extremes.acceleration.min), std::fabs(extremes.acceleration.max)) /
                    exact.acceleration -
                1.0);
  const EventMatch match = match_events(events, reference.events);
  errors.events = static_cast<long>(match.run_count);
  errors.events_reference = static_cast<long>(match.reference_count);
  errors.event_time_s = match.run_count == match.reference_count && match.matched == match.reference_count
                            ? match.largest_difference
                            : none;
  std::string missing;
  const std::optional<EnergyBalance> balance = energy_balance(cycles, missing);
  errors.energy = balance ? std::fabs(balance->energy_error() / balance->work_excitation) : none;
  errors.loop_s = run.loop_seconds();
  errors.wall_s = run.wall_seconds();
  return errors;
}

ChainErrors measure_engine_law(const std::string &case_name, int steps_per_cycle,
                               const ExactSolution &reference) {
  const DeckRun run("study/in.reference", {{"case", case_name},
                                           {"cycles", std::to_string(accuracy_cycles)},
                                           {"steps_per_cycle", std::to_string(steps_per_cycle)},
                                           {"samples_per_cycle", std::to_string(accuracy_samples)}});
  run.must_succeed();
  // The deck writes at the end of a step: the row of time 0, where the drum rests, is not in its file.
  std::vector<double> v_drum = read_table(run.file("velocity.csv")).numbers("v_drum");
  v_drum.insert(v_drum.begin(), 0.0);
  return {velocity_error(v_drum, reference),
          none,
          none,
          0,
          0,
          none,
          none,
          run.loop_seconds(),
          run.wall_seconds()};
}

ReboundErrors measure_impacts(Transition transition, double damping_ratio, const std::string &stepping,
                              double steps_per_contact, int phases) {
  const DeckRun run("study/in.impacts", {{"transition", transition_name(transition)},
                                         {"D", number_text(damping_ratio)},
                                         {"stepping", stepping},
                                         {"steps_per_contact", number_text(steps_per_contact)},
                                         {"phases", std::to_string(phases)}});
  return rebound_errors(run.must_succeed().file(""));
}

} // namespace drumlin::post
