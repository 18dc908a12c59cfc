#include "studies/fidelity/results.h"

#include "studies/study.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace drumlin::post {

BedValues bed_values(const Table &cycles, double width) {
  const auto begin =
      static_cast<std::ptrdiff_t>((cycles.rows() + 1) / 2); // the first row is the start, no cycle
  const auto mean = [&](const char *column) {
    const std::vector<double> all = cycles.numbers(column);
    return std::accumulate(all.begin() + begin, all.end(), 0.0) /
           static_cast<double>(all.end() - (all.begin() + begin));
  };
  const std::vector<double> sunk = cycles.numbers("settlement");
  const double per_cycle =
      (sunk.back() - *(sunk.begin() + begin - 1)) / static_cast<double>(sunk.end() - (sunk.begin() + begin));
  return {mean("a_drum_max"), mean("F_contact_max") / width, per_cycle, mean("contact_share"),
          std::numeric_limits<double>::quiet_NaN()};
}

const CsvSchema<FidelityRun> &fidelity_runs() {
  const auto value = [](const char *name, BedQuantity quantity, int digits = all_digits) {
    return csv_column_of<FidelityRun, double>(
        name, [q = static_cast<std::size_t>(quantity)](auto &run) -> auto & { return run.values[q]; },
        digits);
  };
  constexpr int digits =
      9; // significant digits. A column with a number of digits writes a missing value (NaN) as an empty cell.
  static const CsvSchema<FidelityRun> schema(
      {csv_column("variant", &FidelityRun::variant), csv_column("seed", &FidelityRun::seed),
       value("a_drum_max_m_s2", BedQuantity::acceleration), value("F_contact_max_N", BedQuantity::force),
       value("settlement_m_per_cycle", BedQuantity::settlement), value("contact_share", BedQuantity::contact),
       csv_column("cpu_s", &FidelityRun::cpu_s), csv_column("balls", &FidelityRun::balls),
       value("k_N_m_per_m", BedQuantity::stiffness, digits)},
      2);
  return schema;
}

std::string bed_quantity_name(BedQuantity quantity) {
  switch (quantity) {
  case BedQuantity::acceleration:
    return "drum acceleration (m/s2)";
  case BedQuantity::force:
    return "contact force (N/m)";
  case BedQuantity::settlement:
    return "settlement (m/cycle)";
  case BedQuantity::contact:
    return "contact share (-)";
  case BedQuantity::stiffness:
    return "stiffness (N/m per m)";
  }
  throw std::logic_error("a quantity without a name");
}

std::vector<FidelityRun> read_fidelity_runs(const std::filesystem::path &file) {
  std::vector<FidelityRun> runs = read_points(file, fidelity_runs());
  for (const FidelityRun &run : runs)
    for (const BedQuantity quantity : bed_quantities)
      if (quantity != BedQuantity::stiffness &&
          !std::isfinite(run.values[static_cast<std::size_t>(quantity)]))
        throw std::runtime_error(fmt::format("{}: {} of seed {} has no finite {}", file.string(), run.variant,
                                             run.seed, bed_quantity_name(quantity)));
  return runs;
}

std::optional<Effect> effect_of(const std::vector<FidelityRun> &runs, const BedComparison &compared) {
  Effect effect{compared, 0, {}, {}, 0.0};
  std::array<std::vector<double>, bed_quantities.size()> differences, bases;
  std::vector<double> ratios;
  for (const FidelityRun &one : runs)
    for (const FidelityRun &other : runs) {
      if (one.variant != compared.variant || other.variant != compared.base || one.seed != other.seed)
        continue;
      for (std::size_t q = 0; q < bed_quantities.size(); ++q) {
        if (!std::isfinite(one.values[q] - other.values[q])) continue;
        differences[q].push_back(one.values[q] - other.values[q]);
        bases[q].push_back(other.values[q]);
      }
      ratios.push_back(one.cpu_s / other.cpu_s);
    }
  if (ratios.empty()) return std::nullopt;
  effect.seeds = static_cast<int>(ratios.size());
  effect.cost = median(ratios);
  for (std::size_t q = 0; q < bed_quantities.size(); ++q) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    if (differences[q].empty()) {
      effect.change[q] = effect.difference[q] = {none, none};
      continue;
    }
    const MeanInterval &difference = effect.difference[q] = mean_interval(differences[q]);
    const double scale = std::fabs(mean_interval(bases[q]).mean);
    effect.change[q] = {difference.mean / scale, difference.half_width / scale};
  }
  return effect;
}

} // namespace drumlin::post
