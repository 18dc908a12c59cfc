#include "passes/meter_map.h"

#include "passes/values.h"
#include "support/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

namespace {

constexpr std::array<CellMeter, 7> meters = {
    {{"CMV", "-", [](const WayCell &cell) { return cell.meter.cmv; }},
     {"RMV", "-", [](const WayCell &cell) { return cell.meter.rmv; }},
     {"CCV", "-", [](const WayCell &cell) { return cell.ccv; }},
     {"k_B", "N/m", [](const WayCell &cell) { return cell.meter.k_B; }},
     {"E_vib", "Pa", [](const WayCell &cell) { return cell.meter.E_vib; }},
     {"contact_share", "-", [](const WayCell &cell) { return cell.meter.contact_share; }},
     {"peak_force", "N", [](const WayCell &cell) { return cell.meter.peak_force; }}}};

PassCells row_of(int pass, const std::vector<MapValue> &values, const AcceptanceRule &rule) {
  PassCells row;
  row.pass = pass;
  row.cells = values.size();
  const auto count = static_cast<double>(values.size());
  for (const MapValue &one : values)
    row.mean += one.value / count;
  double squares = 0.0, above = 0.0;
  for (const MapValue &one : values) {
    squares += (one.value - row.mean) * (one.value - row.mean);
    if (rule.target && one.value >= *rule.target) above += 1.0;
  }
  row.deviation = values.size() > 1 ? std::sqrt(squares / (count - 1.0)) : NAN;
  if (rule.target) row.coverage = above / count;
  return row;
}

/// The relative change of the mean over the cells that two passes have both.
std::optional<double> gain_between(const std::vector<MapValue> &before, const std::vector<MapValue> &after) {
  double first = 0.0, second = 0.0;
  auto earlier = before.begin();
  for (const MapValue &one : after) {
    while (earlier != before.end() && earlier->place < one.place)
      ++earlier;
    if (earlier == before.end()) break;
    if (earlier->place != one.place) continue;
    first += earlier->value;
    second += one.value;
  }
  return first > 0.0 ? std::optional(second / first - 1.0) : std::nullopt;
}

} // namespace

std::string MeterMap::unit_words() const { return unit == "-" ? "" : " " + unit; }

std::vector<MapValue> MeterMap::of_pass(int pass) const {
  const auto range = std::equal_range(values.begin(), values.end(), MapValue{pass, 0, 0.0},
                                      [](const MapValue &a, const MapValue &b) { return a.pass < b.pass; });
  return {range.first, range.second};
}

std::vector<MapValue> MeterMap::last() const {
  std::vector<MapValue> found(places.size(), MapValue{0, 0, 0.0});
  for (const MapValue &one : values) // later passes stand behind earlier ones
    found[one.place] = one;
  found.erase(std::remove_if(found.begin(), found.end(), [](const MapValue &one) { return one.pass == 0; }),
              found.end());
  return found;
}

const CellMeter &cell_meter(const std::string &name) {
  std::string names;
  for (const CellMeter &meter : meters) {
    if (name == meter.name) return meter;
    names += (names.empty() ? "" : ", ") + std::string(meter.name);
  }
  throw std::invalid_argument(names);
}

MeterMap meter_map(const std::vector<PassesResult> &results, const CellMeter &meter) {
  MeterMap map;
  map.meter = meter.name;
  map.unit = meter.unit;
  map.cell = results.front().cell;
  const auto same_spots = [&](const PassesResult &result) {
    const std::vector<WayPart> &first = results.front().spots;
    return std::equal(first.begin(), first.end(), result.spots.begin(), result.spots.end(),
                      [](const WayPart &a, const WayPart &b) { return a.from == b.from && a.to == b.to; });
  };
  if (std::all_of(results.begin(), results.end(), same_spots)) map.spots = results.front().spots;
  for (std::size_t run = 0; run < results.size(); ++run) {
    const PassesResult &result = results[run];
    const std::size_t first = map.places.size(), count = result.cells.size() / result.passes.size();
    for (std::size_t i = 0; i < count; ++i)
      map.places.push_back({run, 0.5 * (result.cells[i].part.from + result.cells[i].part.to)});
    for (std::size_t i = count; count > 0 && i < result.cells.size(); ++i)
      if (const std::optional<double> value = meter.value(result.cells[i]);
          result.cells[i].cycles > 0 && value && std::isfinite(*value))
        map.values.push_back({result.cells[i].pass, first + i % count, *value});
  }
  std::sort(map.values.begin(), map.values.end(), [](const MapValue &a, const MapValue &b) {
    return std::pair(a.pass, a.place) < std::pair(b.pass, b.place);
  });
  return map;
}

std::vector<PassCells> cells_of_passes(const MeterMap &map, const AcceptanceRule &rule) {
  if (map.values.empty()) return {};
  std::vector<PassCells> rows;
  std::vector<MapValue> before;
  for (int pass = 1; pass <= map.passes(); ++pass) {
    std::vector<MapValue> values = map.of_pass(pass);
    if (values.empty()) {
      before.clear();
      continue;
    }
    rows.push_back(row_of(pass, values, rule));
    if (!before.empty()) rows.back().gain = gain_between(before, values);
    before = std::move(values);
  }
  const std::optional<double> gain = rows.back().gain;
  rows.push_back(row_of(0, map.last(), rule));
  rows.back().gain = gain;
  return rows;
}

std::optional<int> passes_until_gain(const std::vector<PassCells> &rows, const AcceptanceRule &rule) {
  std::optional<int> level;
  if (rows.empty()) return level;
  for (std::size_t n = rows.size() - 1; n-- > 1;) {
    if (!rows[n].gain || std::abs(*rows[n].gain) >= rule.gain) break;
    level = rows[n - 1].pass;
  }
  return level;
}

std::string acceptance_csv(const MeterMap &map, const std::vector<PassCells> &rows) {
  std::string text = csv_line({"pass", "cells [-]", fmt::format("{} [{}]", map.meter, map.unit),
                               fmt::format("{}_scatter [{}]", map.meter, map.unit),
                               "coefficient_of_variation [-]", "gain [-]", "coverage [-]"});
  for (const PassCells &row : rows)
    text += csv_line({row.pass == 0 ? "last" : std::to_string(row.pass), std::to_string(row.cells),
                      cell_of(row.mean), cell_of(row.deviation), cell_of(row.variation()), cell_of(row.gain),
                      cell_of(row.coverage)});
  return text;
}

std::string answer_of(const MeterMap &map, const std::vector<PassCells> &rows, const AcceptanceRule &rule) {
  if (rows.empty()) return fmt::format("No cell has a value of {}.", map.meter);
  const PassCells &last = rows.back();
  const std::string unit = map.unit_words();
  std::string text = fmt::format("{} of the last pass is {:.4g}{} in the mean of {} cells", map.meter,
                                 last.mean, unit, last.cells);
  if (std::isfinite(last.variation()))
    text += fmt::format(", coefficient of variation {:.0f} %", 100.0 * last.variation());
  if (const std::optional<int> level = passes_until_gain(rows, rule))
    text += fmt::format("; after {} {} the gain of the mean per pass is below {:g} %", *level,
                        *level == 1 ? "pass" : "passes", 100.0 * rule.gain);
  else if (last.gain)
    text += fmt::format("; the last pass still changed the mean by {:+.0f} %", 100.0 * *last.gain);
  if (last.coverage)
    text += fmt::format("; {:.0f} % of the cells are at or above {:g}{}", 100.0 * *last.coverage,
                        *rule.target, unit);
  else
    text += "; without a target (--target) nothing is judged";
  return text + ".";
}

std::vector<std::string> answers_on_spots(const MeterMap &map) {
  std::size_t areas = 0;
  for (const MapPlace &place : map.places)
    areas = std::max(areas, place.area + 1);
  const auto beside = [&](const MapPlace &place) {
    return std::none_of(map.spots.begin(), map.spots.end(), [&](const WayPart &spot) {
      return place.along + 0.5 * map.cell > spot.from && place.along - 0.5 * map.cell < spot.to;
    });
  };
  const auto means = [&](const auto &counts) { // of each area that has such cells
    std::vector<double> sums(areas), numbers(areas), found;
    for (const MapValue &one : map.values)
      if (const MapPlace &place = map.places[one.place]; counts(place)) {
        sums[place.area] += one.value;
        ++numbers[place.area];
      }
    for (std::size_t area = 0; area < areas; ++area)
      if (numbers[area] > 0.0) found.push_back(sums[area] / numbers[area]);
    return found;
  };
  std::vector<std::string> answers;
  const std::string unit = map.unit_words();
  for (const WayPart &spot : map.spots) {
    const std::vector<double> on = means([&](const MapPlace &place) { return spot.holds(place.along); });
    const std::vector<double> off = means(beside);
    if (on.empty() || on.size() != areas || off.size() != areas) continue;
    std::vector<double> differences;
    for (std::size_t area = 0; area < areas; ++area)
      differences.push_back(on[area] - off[area]);
    const MeanInterval difference = mean_interval(differences);
    std::string text = fmt::format(
        "On the spot from {:g} to {:g} m, over all passes, {} is {:.4g}{}, beside it {:.4g}{}: a difference "
        "of {:.3g}",
        spot.from, spot.to, map.meter, mean_interval(on).mean, unit, mean_interval(off).mean, unit,
        difference.mean);
    text += areas == 1 ? " (one bed, which is one sample)"
                       : fmt::format(" ± {:.2g} (95 %, over {} beds{})", difference.half_width, areas,
                                     difference.significant() ? "" : ": not significant");
    answers.push_back(text + ".");
  }
  return answers;
}

} // namespace drumlin::post
