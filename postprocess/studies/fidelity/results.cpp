#include "studies/fidelity/results.h"

#include "studies/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace drumlin::post {

namespace {

/// Student's t that a share of 0.95 does not leave to either side, by degrees of freedom (any table of it); beyond the
/// table the last one, which is on the safe side.
double student_t_95(std::size_t freedom) {
  constexpr std::array t = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228};
  return t.at(std::min(freedom, t.size()) - 1);
}

} // namespace

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
  return {mean("a_drum_max"), mean("F_contact_max") / width, per_cycle, mean("contact_share")};
}

const std::vector<std::string> fidelity_run_columns = {
    "variant",       "seed", "a_drum_max_m_s2", "F_contact_max_N", "settlement_m_per_cycle",
    "contact_share", "cpu_s"};

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
  row.push_back(number_text(run.cpu_s));
  return row;
}

std::vector<FidelityRun> read_fidelity_runs(const std::filesystem::path &file) {
  const StudyResults rows(file, fidelity_run_columns, fidelity_run_keys);
  std::vector<FidelityRun> runs;
  for (const StudyResults::Row &row : rows.rows()) {
    FidelityRun run{row[0], static_cast<int>(rows.number(row, "seed")), {}, rows.number(row, "cpu_s")};
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

bool MeanError::beyond_scatter() const { return std::fabs(mean) > half_width; }

bool MeanError::within(double bound) const { return std::fabs(mean) + half_width <= bound; }

MeanError mean_error(const std::vector<double> &values) {
  if (values.empty()) throw std::invalid_argument("a mean of no values");
  const auto n = static_cast<double>(values.size());
  double mean = 0.0;
  for (const double value : values)
    mean += value / n;
  double squares = 0.0;
  for (const double value : values)
    squares += (value - mean) * (value - mean);
  if (values.size() < 2) return {mean, std::numeric_limits<double>::infinity()};
  return {mean, student_t_95(values.size() - 1) * std::sqrt(squares / (n * (n - 1.0)))};
}

std::optional<Effect> effect_of(const std::vector<FidelityRun> &runs, const BedComparison &compared) {
  Effect effect{compared, 0, {}, 0.0};
  std::array<std::vector<double>, bed_quantities.size()> differences, bases;
  std::vector<double> ratios;
  for (const FidelityRun &one : runs)
    for (const FidelityRun &other : runs) {
      if (one.variant != compared.variant || other.variant != compared.base || one.seed != other.seed)
        continue;
      for (std::size_t q = 0; q < bed_quantities.size(); ++q) {
        differences[q].push_back(one.values[q] - other.values[q]);
        bases[q].push_back(other.values[q]);
      }
      ratios.push_back(one.cpu_s / other.cpu_s);
    }
  if (ratios.empty()) return std::nullopt;
  effect.seeds = static_cast<int>(ratios.size());
  effect.cost = median(ratios);
  for (std::size_t q = 0; q < bed_quantities.size(); ++q) {
    const MeanError difference = mean_error(differences[q]);
    const double scale = std::fabs(mean_error(bases[q]).mean);
    effect.change[q] = {difference.mean / scale, difference.half_width / scale};
  }
  return effect;
}

} // namespace drumlin::post
