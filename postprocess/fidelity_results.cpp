#include "fidelity_results.h"

#include "chain_csv.h"
#include "study.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>

namespace drumlin::post {

const std::vector<std::string> fidelity_run_columns = {
    "variant",       "seed",  "a_drum_max_m_s2", "F_contact_max_N", "settlement_m_per_cycle",
    "contact_share", "wall_s"};

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
  }
  throw std::logic_error("a quantity without a name");
}

std::vector<std::string> cells(const FidelityRun &run) {
  std::vector<std::string> row = {run.variant, std::to_string(run.seed)};
  for (const double value : run.values)
    row.push_back(number_text(value));
  row.push_back(number_text(run.wall_s));
  return row;
}

std::vector<FidelityRun> read_fidelity_runs(const std::filesystem::path &file) {
  const StudyResults rows(file, fidelity_run_columns, fidelity_run_keys);
  std::vector<FidelityRun> runs;
  for (const StudyResults::Row &row : rows.rows()) {
    FidelityRun run{row[0], static_cast<int>(rows.number(row, "seed")), {}, rows.number(row, "wall_s")};
    for (std::size_t q = 0; q < bed_quantities.size(); ++q) {
      run.values[q] = rows.number(row, fidelity_run_columns[fidelity_run_keys + q]);
      if (!std::isfinite(run.values[q]))
        throw std::runtime_error(fmt::format("{}: {} of seed {} has no number in {}", file.string(),
                                             run.variant, run.seed,
                                             fidelity_run_columns[fidelity_run_keys + q]));
    }
    runs.push_back(run);
  }
  return runs;
}

bool MeanError::beyond_scatter() const { return std::fabs(mean) > two_errors; }

MeanError mean_error(const std::vector<double> &values) {
  if (values.empty()) throw std::invalid_argument("a mean of no values");
  const auto n = static_cast<double>(values.size());
  double mean = 0.0;
  for (const double value : values)
    mean += value / n;
  double squares = 0.0;
  for (const double value : values)
    squares += (value - mean) * (value - mean);
  return {mean, values.size() < 2 ? std::numeric_limits<double>::infinity()
                                  : 2.0 * std::sqrt(squares / (n * (n - 1.0)))};
}

Effect effect_of(const std::vector<FidelityRun> &runs, const std::string &variant, const std::string &base) {
  Effect effect{variant, base, 0, {}, 0.0};
  std::array<std::vector<double>, bed_quantities.size()> differences, bases;
  std::vector<double> ratios;
  for (const FidelityRun &one : runs)
    for (const FidelityRun &other : runs) {
      if (one.variant != variant || other.variant != base || one.seed != other.seed) continue;
      for (std::size_t q = 0; q < bed_quantities.size(); ++q) {
        differences[q].push_back(one.values[q] - other.values[q]);
        bases[q].push_back(other.values[q]);
      }
      ratios.push_back(one.wall_s / other.wall_s);
    }
  if (ratios.empty()) throw std::invalid_argument(fmt::format("{} and {} share no seed", variant, base));
  effect.seeds = static_cast<int>(ratios.size());
  effect.wall_ratio = median(ratios);
  for (std::size_t q = 0; q < bed_quantities.size(); ++q) {
    const MeanError difference = mean_error(differences[q]);
    const double scale = std::fabs(mean_error(bases[q]).mean);
    effect.change[q] = {difference.mean / scale, difference.two_errors / scale};
  }
  return effect;
}

} // namespace drumlin::post
