#include "report/bed/measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "report/chain/measures.h"
#include "support/units.h"

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// Mean over the rows of a window, both ends included.
double mean(const std::vector<double> &time, const std::vector<double> &value, TimeWindow window) {
  double sum = 0.0;
  double rows = 0.0;
  for (std::size_t i = 0; i < time.size(); ++i)
    if (time[i] >= window.begin && time[i] <= window.end) {
      sum += value[i];
      rows += 1.0;
    }
  return sum / rows;
}

/// Number of cycles at the end that count as steady; even if there are two or more.
int steady_part(int cycles) {
  if (cycles < 2) return cycles;
  return std::min(steady_cycles, (cycles / 2 + 1) / 2 * 2);
}

BedMeasures measure(const Run &run, const BedHistory &bed) {
  const std::vector<double> &time = run.history.time;
  const CycleColumns &cycles = *run.cycles;
  const double period = run.chain.period();
  BedMeasures m;
  m.cycles = std::min(run.complete, static_cast<int>(cycles.rows) - 1); // row 0 is the start
  m.depth_percent = 50.0 * run.number("drum_depth").value_or(not_a_number) /
                    run.number("r2").value_or(not_a_number); // runs of earlier versions note neither
  m.coordination_start = bed.coordination.front();
  m.void_ratio_start = bed.void_ratio.front();
  m.imbalance_percent = 100.0 * energy_imbalance(bed).back() / std::abs(bed.work_excitation.back());
  if (m.cycles < 1) {
    m.coordination_end = m.void_ratio_end = not_a_number;
    return m;
  }
  m.steady_count = steady_part(m.cycles);
  m.steady = last_cycles_window(m.cycles, m.steady_count, period);
  const auto count = static_cast<std::size_t>(m.steady_count);
  // Without events: those of a bed are of single balls, but the force on the drum is the sum over all balls.
  m.extremes = steady_extremes(run.history, {}, run.cycles, run.chain, m.steady, count);
  m.amplitudes = harmonic_amplitudes(cycles, count);
  for (std::size_t i = cycles.rows - count; i < cycles.rows; ++i)
    m.contact_share += cycles.at("contact_share")[i] / m.steady_count;
  const std::vector<double> &settlement = cycles.at("settlement");
  m.settlement = settlement.back();
  m.settlement_per_cycle = (settlement.back() - settlement[cycles.rows - 1 - count]) / m.steady_count;
  const double slack = 1.0e-6 * period;
  TimeWindow last = last_cycles_window(m.cycles, 1, period);
  last = {last.begin - slack, last.end + slack};
  m.coordination_end = mean(time, bed.coordination, last);
  m.void_ratio_end = mean(time, bed.void_ratio, last);
  return m;
}

/// Whether two runs have equal parameters apart from transition, restart file, what depends on the seed of
/// the bed, number of cycles and how they were run.
bool alike(const Run &a, const Run &b) {
  const auto told = [](const Run &run) {
    std::map<std::string, std::string> parameters = run.parameters;
    for (const char *name :
         {"transition", "start", "cycles", "drum_depth", "engine", "plugin", "ranks", "command", "out",
          "ended", "d50", "C_u", "layer_tops", "timestep", "dt", "steps_per_cycle"})
      parameters.erase(name);
    return parameters;
  };
  return told(a) == told(b);
}

} // namespace

std::vector<double> energy_imbalance(const BedHistory &bed) {
  std::vector<double> imbalance(bed.kinetic.size());
  for (std::size_t i = 0; i < imbalance.size(); ++i)
    imbalance[i] =
        bed.kinetic[i] + bed.potential[i] + bed.elastic[i] + bed.dissipated[i] - bed.work_excitation[i];
  const double first = imbalance.empty() ? 0.0 : imbalance.front();
  for (double &value : imbalance)
    value -= first;
  return imbalance;
}

BedResult analyse_bed(Run run) {
  const fs::path cycles_file = run.folder / "cycles.csv";
  if (!run.cycles) throw std::runtime_error(fmt::format("{}: is missing", cycles_file.string()));
  for (const char *name : {"contact_share", "settlement"})
    if (!run.cycles->has(name))
      throw std::runtime_error(fmt::format("{}: column '{}' is missing", cycles_file.string(), name));
  if (run.cycles->rows == 0) throw std::runtime_error(fmt::format("{}: has no rows", cycles_file.string()));
  BedResult result;
  result.bed = read_bed_history(run.folder / "bed.csv", run.history.size(), run.cut_rows());
  result.measures = measure(run, result.bed);
  result.run = std::move(run);
  return result;
}

bool drives(const fs::path &folder) {
  try {
    const std::map<std::string, std::string> parameters = read_parameters(folder / "parameters.csv");
    const auto deck = parameters.find("deck");
    return deck != parameters.end() && deck->second == "drive";
  } catch (const std::runtime_error &) { // a file that no deck has written
    return false;
  }
}

bool per_metre(const Run &run) { return run.text("dimension", "2") != "3"; }

const char *per_metre_words(const Run &run, const char *words) { return per_metre(run) ? words : ""; }

std::string two_digits(double value) {
  if (value == 0.0 || !std::isfinite(value)) return fmt::format("{}", value);
  const int exponent = static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-12));
  const double unit = std::pow(10.0, exponent - 1);
  return fmt::format("{:.{}f}", std::round(value / unit) * unit, std::max(0, 1 - exponent));
}

std::string BedScatter::words() {
  return fmt::format(
      "One bed is one sample: beds that differ in their seed alone scatter by {:.0f} % in the largest "
      "force and acceleration, by {:.0f} % in the share of contact and by {:.1f} mm in the settlement "
      "of a cycle (standard deviations over five beds of case gravel in two dimensions, "
      "inputs/study/fidelity/findings.md).",
      100.0 * force, 100.0 * contact_share, 1e3 * settlement);
}

std::vector<const BedResult *> BedGroup::under(Transition transition) const {
  std::vector<const BedResult *> found;
  for (const BedResult *run : runs)
    if (run->run.transition() == transition) found.push_back(run);
  return found;
}

std::vector<Transition> BedGroup::conditions() const {
  std::vector<Transition> found;
  for (const Transition transition : {Transition::B, Transition::A})
    if (!under(transition).empty()) found.push_back(transition);
  return found;
}

namespace {

/// Whether a run is one of another seed than all runs of a group under its condition.
bool of_another_seed(const BedGroup &group, const BedResult &bed) {
  const std::vector<const BedResult *> others = group.under(bed.run.transition());
  return std::all_of(others.begin(), others.end(), [&bed](const BedResult *other) {
    return other->run.text("start") != bed.run.text("start") && other->run.text("d50") != bed.run.text("d50");
  });
}

} // namespace

std::vector<BedGroup> group_beds(const std::vector<BedResult> &beds) {
  std::vector<BedGroup> groups;
  std::vector<bool> placed(beds.size(), false);
  for (std::size_t i = 0; i < beds.size(); ++i) {
    if (placed[i]) continue;
    placed[i] = true;
    BedGroup group{{&beds[i]}};
    for (const bool same_start : {true, false})
      for (std::size_t j = i + 1; j < beds.size(); ++j) {
        if (placed[j] || !alike(beds[i].run, beds[j].run) || !of_another_seed(group, beds[j])) continue;
        if (same_start && beds[i].run.text("start") != beds[j].run.text("start")) continue;
        placed[j] = true;
        group.runs.push_back(&beds[j]);
      }
    std::stable_sort(group.runs.begin(), group.runs.end(), [](const BedResult *a, const BedResult *b) {
      return a->run.transition() == Transition::B && b->run.transition() == Transition::A;
    });
    groups.push_back(std::move(group));
  }
  return groups;
}

} // namespace drumlin::post
