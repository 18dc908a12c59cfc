#include "chain/exact_solution.h"

#include "chain/one_contact.h"
#include "chain/two_ends.h"
#include "support/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace drumlin::post {

const Range ExactOptions::cycles_range = {0.0, 25000.0, "", false, true};
const Range ExactOptions::impact_speed_range = {1e-12, 1e6, "m/s", true};

std::string ExactOptions::invalid() const {
  if (!cycles_range.holds(cycles)) return refusal("cycles", cycles, cycles_range.words());
  if (samples_per_cycle < 1 || samples_per_cycle > most_samples)
    return refusal("samples-per-cycle", samples_per_cycle,
                   fmt::format("a whole number from 1 to {}", most_samples));
  constexpr double most_rows = 5e6; // some 2 GB of memory while they are written
  if (cycles * samples_per_cycle > most_rows)
    return refusal("cycles", cycles,
                   fmt::format("with {} samples per cycle at most {:g}", samples_per_cycle,
                               most_rows / samples_per_cycle));
  if (!impact_speed_range.holds(impact_speed))
    return refusal("impact-speed", impact_speed, impact_speed_range.words());
  return {};
}

namespace {

/// Pieces in which a cycle of a chain that does not drive is computed, see most_cycles().
double pieces_per_cycle(const ChainParameters &parameters) {
  const double longest =
      std::min(PhaseDynamics(parameters, parameters.k, parameters.damping()).longest_piece(),
               PhaseDynamics(parameters, 0.0, 0.0).longest_piece());
  return parameters.period() / longest + 1.0;
}

bool soil_changes(const ExactOptions &options) {
  return std::any_of(options.way.begin(), options.way.end(),
                     [](const WaySection &section) { return !section.constant(); });
}

/// The same chain as a drum on one contact in its middle, on which soil may change linearly.
TwoEnds in_the_middle(const ChainParameters &parameters) {
  TwoEnds machine;
  machine.chain = parameters;
  machine.drum_inertia = machine.frame_inertia = 1.0; // it does not tilt
  machine.contacts = equal_contacts(1, 1.0, parameters.k, parameters.damping());
  machine.bonds = {{0.0, parameters.k23, parameters.c23}};
  return machine;
}

} // namespace

std::string too_many_pieces(const ExactOptions &options, double per_cycle, double most) {
  if (std::ceil(options.cycles) * per_cycle <= most) return {};
  return refusal(
      "cycles", options.cycles,
      fmt::format("at most {:.3g} of this machine and soil, whose fastest motion needs {:.3g} steps "
                  "per cycle",
                  most / per_cycle, per_cycle));
}

double most_cycles(const ChainParameters &parameters) {
  return ExactOptions::most_pieces / pieces_per_cycle(parameters);
}

std::string too_much_work(const ChainParameters &parameters, const ExactOptions &options) {
  if (soil_changes(options)) return too_much_work(in_the_middle(parameters), options);
  double pieces = options.way.empty() ? pieces_per_cycle(parameters) : 0.0;
  for (const WaySection &section : options.way) {
    ChainParameters there = parameters;
    there.k = section.k;
    there.D = section.D;
    pieces = std::max(pieces, pieces_per_cycle(there));
  }
  return too_many_pieces(options, pieces);
}

ExactSolution solve_chain(const ChainParameters &parameters, const ExactOptions &options,
                          const SolverProgress &progress) {
  if (const std::string fault = options.invalid(); !fault.empty()) throw std::invalid_argument(fault);
  if (soil_changes(options)) {
    ExactSolution solution = solve_two_ends(in_the_middle(parameters), options, progress);
    for (const HistoryColumn &column : history_columns)
      if (column.group == ColumnGroup::ends) (solution.history.*column.values).clear();
    return solution;
  }
  OneContact chain(parameters);
  if (!options.way.empty()) chain.drive_over(options.way.front());
  SolverOf<OneContact> solver(chain);
  return solved(solver, options, 0, progress);
}

ExactSolution solve_chain(const ChainParameters &parameters, int cycles, int samples_per_cycle, int lead) {
  ExactOptions options;
  options.cycles = lead + cycles;
  options.samples_per_cycle = samples_per_cycle;
  SolverOf<OneContact> solver{OneContact(parameters)};
  return solved(solver, options, lead, {});
}

} // namespace drumlin::post
