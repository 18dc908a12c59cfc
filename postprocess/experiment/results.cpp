#include "experiment/results.h"

#include "support/resumed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace drumlin::post {

namespace {

/// Values of a comparison's scenes and of those that they are compared with; of pairs those with the same
/// index have the same seed.
struct Samples {
  std::vector<double> values, bases;
};

template <class Values>
Samples samples_of(const Comparison &compared, const Values &values_of) {
  Samples samples;
  for (const auto &[scene, base] : compared.pairs) {
    const std::map<int, double> &values = values_of(scene), &bases = values_of(base);
    for (const auto &[seed, value] : values)
      if (!compared.paired || bases.count(seed) > 0) samples.values.push_back(value);
    for (const auto &[seed, value] : bases)
      if (!compared.paired || values.count(seed) > 0) samples.bases.push_back(value);
  }
  return samples;
}

std::vector<double> differences(const Samples &samples) {
  std::vector<double> found;
  for (std::size_t i = 0; i < samples.values.size(); ++i)
    found.push_back(samples.values[i] - samples.bases[i]);
  return found;
}

double cost_ratio(const Comparison &compared, const Samples &costs) {
  if (costs.values.empty() || costs.bases.empty()) return std::numeric_limits<double>::quiet_NaN();
  if (!compared.paired) return median(costs.values) / median(costs.bases);
  std::vector<double> ratios;
  for (std::size_t i = 0; i < costs.values.size(); ++i)
    ratios.push_back(costs.values[i] / costs.bases[i]);
  return median(ratios);
}

/// The unit in which a page shows numbers up to `largest`, and the factor to it.
std::pair<std::string, double> shown_unit_of(const std::string &unit, double largest) {
  if (unit == "m" && largest < 1.0) return {"mm", 1e3};
  if (unit.find_first_of("NJPW") != 0 || largest < 1e3) return {unit, 1.0};
  return largest < 1e6 ? std::pair("k" + unit, 1e-3) : std::pair("M" + unit, 1e-6);
}

/// The value of a key, empty if there is none.
template <class Map, class Key>
const typename Map::mapped_type &found_in(const Map &map, const Key &key) {
  static const typename Map::mapped_type none;
  const auto found = map.find(key);
  return found == map.end() ? none : found->second;
}

} // namespace

const CsvSchema<Result> &result_rows() {
  constexpr int digits_of_cost = 9;
  static const CsvSchema<Result> schema(
      {csv_column("scene", &Result::scene),
       csv_column("seed", &Result::seed),
       csv_column("quantity", &Result::quantity),
       csv_column("unit", &Result::unit),
       {"value",
        [](const Result &row) { return std::isfinite(row.value) ? number_text(row.value) : std::string(); },
        [](Result &row, const std::string &cell) { row.value = csv_value<double>(cell); }},
       csv_column("cost [s]", &Result::cost, digits_of_cost)},
      3);
  return schema;
}

Results::Results(const std::vector<Result> &rows) {
  for (const Result &row : rows) {
    if (std::find(scenes_.begin(), scenes_.end(), row.scene) == scenes_.end()) scenes_.push_back(row.scene);
    if (std::isfinite(row.value)) values_[row.scene][row.quantity][row.seed] = row.value;
    if (std::isfinite(row.cost)) costs_[row.scene].emplace(row.seed, row.cost);
  }
}

const std::map<int, double> &Results::values(const std::string &scene, const std::string &quantity) const {
  return found_in(found_in(values_, scene), quantity);
}

const std::map<int, double> &Results::costs(const std::string &scene) const {
  return found_in(costs_, scene);
}

Results read_results(const std::filesystem::path &folder, const Plan &plan) {
  const std::filesystem::path file = folder / results_name;
  const std::vector<Result> rows = read_points(file, result_rows());
  for (const Result &row : rows)
    for (const Quantity &quantity : plan.quantities)
      if (row.quantity == quantity.name && row.unit != quantity.unit)
        csv_refusal(file, 0, "unit", row.unit, fmt::format("{}, that of {}", quantity.unit, quantity.name));
  return Results(rows);
}

std::string table_text(const PlanTable &table, const Plan &plan, const Results &results) {
  constexpr int digits = 6; // more than errors have
  std::vector<std::string> header;
  for (const PlanTable::Column &column : table.columns)
    header.push_back(column.header);
  std::string text = csv_line(header);
  for (const std::string &name : results.scenes()) {
    const std::vector<std::string> key = Plan::key_in(table, plan.scene(name));
    if (key.empty()) continue;
    std::vector<std::string> cells;
    auto next = key.begin();
    for (const PlanTable::Column &column : table.columns) {
      if (!column.is_quantity) {
        cells.push_back(*next++);
        continue;
      }
      const std::vector<double> values = numbers(results.values(name, column.name));
      cells.push_back(values.empty() ? "" : number_text(mean_interval(values).mean, digits));
    }
    text += csv_line(cells);
  }
  return text;
}

std::vector<double> numbers(const std::map<int, double> &by_seed) {
  std::vector<double> all;
  all.reserve(by_seed.size());
  for (const auto &[seed, value] : by_seed)
    all.push_back(value);
  return all;
}

std::optional<Change> change_of(const Results &results, const Comparison &compared,
                                const std::string &quantity) {
  const Samples samples = samples_of(
      compared, [&](const std::string &scene) -> const auto & { return results.values(scene, quantity); });
  if (samples.values.empty() || samples.bases.empty()) return std::nullopt;
  Change change{};
  change.difference =
      compared.paired ? mean_interval(differences(samples)) : mean_difference(samples.values, samples.bases);
  const double scale = std::fabs(mean_interval(samples.bases).mean);
  change.relative = {change.difference.mean / scale, change.difference.half_width / scale};
  return change;
}

std::vector<Quantity> as_shown(std::vector<Quantity> quantities, const Results &results) {
  for (Quantity &quantity : quantities) {
    double least = 0.0, most = 0.0, largest_mean = 0.0;
    for (const std::string &scene : results.scenes()) {
      const std::vector<double> values = numbers(results.values(scene, quantity.name));
      if (values.empty()) continue;
      const auto [low, high] = std::minmax_element(values.begin(), values.end());
      least = std::min(least, *low);
      most = std::max(most, *high);
      largest_mean = std::max(largest_mean, std::fabs(mean_interval(values).mean));
    }
    if (quantity.shown_unit == quantity.unit)
      std::tie(quantity.shown_unit, quantity.scale) = shown_unit_of(quantity.unit, std::max(most, -least));
    if (!quantity.absolute && least < 0.0 && most > 0.0) {
      quantity.absolute = true;
      quantity.tolerance *= largest_mean;
    }
  }
  return quantities;
}

std::vector<Effect> effects_of(const Plan &plan, const Results &results) {
  std::vector<Effect> effects;
  for (const Comparison &compared : plan.comparisons) {
    Effect effect;
    effect.compared = &compared;
    effect.cost = cost_ratio(compared, samples_of(
                                           compared, [&](const std::string &scene) -> const auto & {
                                             return results.costs(scene);
                                           }));
    bool any = false;
    for (const Quantity &quantity : plan.quantities) {
      const auto values_of = [&](const std::string &scene) -> const auto & {
        return results.values(scene, quantity.name);
      };
      effect.seeds = std::max(effect.seeds, samples_of(compared, values_of).values.size());
      std::optional<Change> change = change_of(results, compared, quantity.name);
      any = any || change;
      if (change && !std::isfinite(change->shown(quantity).mean)) change.reset(); // of a mean of zero
      effect.changes.push_back(change);
    }
    if (any) effects.push_back(effect);
  }
  return effects;
}

std::vector<Judged> judged(const Plan &plan, const Results &results) {
  const auto mean_of = [&results](const std::string &scene, const std::string &quantity) {
    const std::vector<double> values = numbers(results.values(scene, quantity));
    return values.empty() ? std::numeric_limits<double>::quiet_NaN() : mean_interval(values).mean;
  };
  std::vector<Judged> all;
  for (const Scene &scene : plan.scenes) {
    const auto &known = results.scenes();
    if (std::find(known.begin(), known.end(), scene.name) == known.end()) continue;
    for (const Expected &expected : scene.expected) {
      Judged one{&scene, &expected, mean_of(scene.name, expected.quantity)};
      const double scale = expected.scale_of.empty()
                               ? expected.scale
                               : std::fabs(mean_of(expected.scale_of, expected.quantity));
      one.error = std::fabs(one.found - expected.value) / scale;
      if (!scene.twin.empty())
        one.difference = std::fabs(one.found - mean_of(scene.twin, expected.quantity)) / scale;
      one.holds = one.error <= expected.tolerance && one.difference <= plan.between_engines;
      all.push_back(one);
    }
  }
  return all;
}

} // namespace drumlin::post
