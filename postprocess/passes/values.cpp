#include "passes/values.h"

#include "bed/relative_density.h"
#include "identify/identified_record.h"
#include "support/units.h"
#include "support/csv.h"
#include "support/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

namespace {

/// Mean of the values that there are; NaN if there is none.
double mean_of(const std::vector<double> &values) {
  double sum = 0.0, count = 0.0;
  for (const double value : values)
    if (std::isfinite(value)) {
      sum += value;
      count += 1.0;
    }
  return count > 0.0 ? sum / count : not_a_number;
}

/// Standard deviation of the values that there are; NaN of less than two.
double scatter_of(const std::vector<double> &values) {
  const double mean = mean_of(values);
  double squares = 0.0, count = 0.0;
  for (const double value : values)
    if (std::isfinite(value)) {
      squares += (value - mean) * (value - mean);
      count += 1.0;
    }
  return count > 1.0 ? std::sqrt(squares / (count - 1.0)) : not_a_number;
}

/// The rows of the record in which a pass is on the measured part, as a record.
Record part_of(const Record &all, const DrivenPass &pass) {
  Record part = all;
  part.cycles_file.clear(); // its cycles are those of the whole record
  keep_samples(part, pass.enters, pass.leaves + 1);
  return part;
}

/// Measures one run.
class Measurement {
public:
  Measurement(const Drive &drive, const PassesOptions &options) : drive_(drive), options_(options) {}

  PassesResult result() {
    result_.folder = drive_.folder;
    result_.parameters = drive_.record.parameters;
    result_.measured = drive_.measured;
    result_.spots = drive_.spots;
    result_.speed = drive_.speed;
    result_.frequency = 1.0 / drive_.record.period();
    result_.cell = options_.cell;
    result_.flat = drive_.flat;
    result_.notes = drive_.notes;
    divide_way();
    read_meters();
    packings_ = noted_packings(drive_.record.parameters);
    const double spacing = options_.spacing.value_or(usual_spacing(drive_));
    try {
      result_.lines = lines_over(drive_, spacing);
    } catch (const std::invalid_argument &allowed) {
      throw std::invalid_argument(refusal("--spacing", spacing, allowed.what()));
    }
    for (std::size_t n = 0; n < drive_.states.size(); ++n) {
      add_soil(n);
      if (n > 0) add_meter(n);
      add_depth(n);
    }
    choose_animated();
    return std::move(result_);
  }

private:
  void divide_way() {
    const double length = drive_.measured.length();
    const double least = least_cycles * drive_.speed / result_.frequency;
    if (options_.cell > length * (1.0 + 1e-9) || options_.cell < least * (1.0 - 1e-9))
      throw std::invalid_argument(
          refusal("--cell", options_.cell,
                  fmt::format("a number from {:.4g}, {} cycles of the excitation, to {:.4g}, the measured "
                              "part of the way [m]",
                              least, least_cycles, length)));
    const auto count = static_cast<int>(std::floor(length / options_.cell + 1e-9));
    for (int i = 0; i < count; ++i)
      parts_.push_back(
          {drive_.measured.from + i * options_.cell, drive_.measured.from + (i + 1) * options_.cell});
  }

  void read_meters() {
    Record record = drive_.record;
    sums_ = meter_cycles(record);
    record.cycles_file.clear();
    samples_ = meter_cycles(record);
    result_.source = sums_.source;
    if (!sums_.vibrates)
      result_.notes.emplace_back("The exciter is off (Fw is 0): there are no meter values, no k and no D.");
  }

  void add_soil(std::size_t n) {
    const DumpedBed &state = drive_.states[n];
    const auto up = std::count_if(state.balls.begin(), state.balls.end(), [&](const Ball &ball) {
      return is_soil(ball.type) && !state.lies[static_cast<std::size_t>(&ball - state.balls.data())];
    });
    if (up > 0)
      result_.notes.push_back(fmt::format("Balls of soil that lie on no other soil {}, and do not count: {}.",
                                          n == 0 ? "before the first pass" : fmt::format("after pass {}", n),
                                          up));
    const LayerTops tops = layer_tops(drive_, state, result_.lines);
    result_.surfaces.push_back(tops.back());
    PassValues values;
    values.pass = static_cast<int>(n);
    values.energy_exciter = values.energy_traction = values.traction = not_a_number;
    values.cmv = values.cmv_scatter = values.rmv = values.ccv = values.k_B = values.E_vib = not_a_number;
    values.contact_share = values.peak_force = not_a_number;
    values.k = values.k_half_width = values.D = values.D_half_width = not_a_number;
    values.soil = soil_on(drive_, state, result_.lines, tops, drive_.measured);
    const SoilLayers &first = n == 0 ? values.soil : result_.passes.front().soil;
    values.settlement = first.surface - values.soil.surface;
    values.compaction = compaction_of(first, values.soil);
    values.heave =
        heave_of(result_.surfaces.front(), tops.back(), result_.lines, drive_.measured, options_.cell);
    std::vector<double> settlements;
    std::vector<SoilLayers> cells;
    std::vector<std::vector<double>> solid(values.soil.thickness.size());
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      WayCell cell;
      cell.pass = values.pass;
      cell.part = parts_[i];
      cell.after = soil_on(drive_, state, result_.lines, tops, parts_[i]);
      cell.before = n == 0 ? cell.after : result_.cells[(n - 1) * parts_.size() + i].after;
      const SoilLayers &start = n == 0 ? cell.after : result_.cells[i].after;
      cells.push_back(cell.after);
      settlements.push_back(start.surface - cell.after.surface);
      for (std::size_t layer = 0; layer < solid.size(); ++layer)
        solid[layer].push_back(cell.after.solid_fraction[layer]);
      result_.cells.push_back(std::move(cell));
    }
    take_inside(values.soil, cells);
    values.settlement_scatter = scatter_of(settlements);
    for (std::size_t layer = 0; layer < solid.size(); ++layer) {
      values.solid_scatter.push_back(scatter_of(solid[layer]));
      const bool known = packings_.size() == solid.size();
      const double phi = values.soil.inner_solid_fraction(layer);
      values.relative_density.push_back(known ? packings_[layer].relative_density(phi) : not_a_number);
      values.degree.push_back(known ? packings_[layer].compaction(phi) : not_a_number);
    }
    result_.passes.push_back(std::move(values));
  }

  /// A column of the history where a pass has a place, linear between rows.
  double at_place(const DrivenPass &pass, double place, const std::vector<double> &values) const {
    const std::vector<double> &s = drive_.history.s;
    const bool forth = s[pass.leaves] > s[pass.enters];
    const auto beyond = [&](std::size_t row) { return forth ? s[row] >= place : s[row] <= place; };
    std::size_t row = pass.enters;
    while (row <= pass.leaves && !beyond(row))
      ++row;
    const double width = s[row] - s[row - 1]; // the pass begins and ends outside of the measured part
    const double share = width != 0.0 ? (place - s[row - 1]) / width : 1.0;
    return values[row - 1] + share * (values[row] - values[row - 1]);
  }

  /// Work per metre driven on a part of the way.
  double per_metre(const DrivenPass &pass, const WayPart &part, const std::vector<double> &work) const {
    const double change = at_place(pass, part.to, work) - at_place(pass, part.from, work);
    const bool forth = drive_.history.s[pass.leaves] > drive_.history.s[pass.enters];
    return (forth ? change : -change) / part.length();
  }

  /// First cycle of each of the record that lies on a part of the way in a pass, and their number.
  std::pair<std::size_t, std::size_t> cycles_on(const DrivenPass &pass, const WayPart &part) const {
    const double period = drive_.record.period();
    std::size_t first = 0, count = 0;
    for (std::size_t i = 0; i < sums_.cycles.size(); ++i) {
      const double middle = sums_.cycles[i].begin + 0.5 * period;
      const double row = std::round((middle - drive_.history.time.front()) / drive_.record.interval);
      if (row < static_cast<double>(pass.enters) || row > static_cast<double>(pass.leaves)) continue;
      if (!part.holds(drive_.history.s[static_cast<std::size_t>(row)])) continue;
      if (count == 0) first = i;
      ++count;
    }
    return {first, count / 2 * 2};
  }

  MeterWindow window_of(const MeterRecord &record, std::size_t first, std::size_t count) const {
    MeterRecord part = record;
    const auto begin = record.cycles.begin() + static_cast<std::ptrdiff_t>(first);
    part.cycles = std::vector<MeterCycle>(begin, begin + static_cast<std::ptrdiff_t>(count));
    MeterOptions options = options_.meter;
    options.window = static_cast<int>(count);
    return meter_windows(part, options).front();
  }

  void add_meter(std::size_t n) {
    const DrivenPass &pass = drive_.passes[n - 1];
    const DriveHistory &history = drive_.history;
    PassValues &values = result_.passes[n];
    std::vector<double> traction_work = history.work_traction;
    for (std::size_t row = 0; row < traction_work.size(); ++row)
      traction_work[row] += history.work_torque[row];
    values.energy_exciter = per_metre(pass, drive_.measured, history.work_excitation);
    values.energy_traction = per_metre(pass, drive_.measured, traction_work);
    const bool forth = history.s[pass.leaves] > history.s[pass.enters];
    double sum = 0.0;
    for (std::size_t row = pass.enters; row <= pass.leaves; ++row)
      sum += forth ? history.traction[row] : -history.traction[row];
    values.traction = sum / static_cast<double>(pass.leaves - pass.enters + 1);

    struct Mean {
      double PassValues::*into;
      std::optional<double> MeterWindow::*from;
    };
    constexpr std::array<Mean, 6> means = {{{&PassValues::cmv, &MeterWindow::cmv},
                                            {&PassValues::rmv, &MeterWindow::rmv},
                                            {&PassValues::k_B, &MeterWindow::k_B},
                                            {&PassValues::E_vib, &MeterWindow::E_vib},
                                            {&PassValues::contact_share, &MeterWindow::contact_share},
                                            {&PassValues::peak_force, &MeterWindow::peak_force}}};
    std::array<std::vector<double>, means.size()> found;
    std::vector<double> ccv;
    std::array<int, mode_count> modes{};
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      WayCell &cell = result_.cells[n * parts_.size() + i];
      cell.energy_exciter = per_metre(pass, cell.part, history.work_excitation);
      cell.energy_traction = per_metre(pass, cell.part, traction_work);
      const auto [first, count] = cycles_on(pass, cell.part);
      if (count < least_cycles) continue;
      cell.cycles = static_cast<int>(count);
      cell.meter = window_of(sums_, first, count);
      if (first + count <= samples_.cycles.size()) cell.ccv = window_of(samples_, first, count).ccv;
      for (std::size_t m = 0; m < means.size(); ++m)
        found[m].push_back((cell.meter.*means[m].from).value_or(not_a_number));
      ccv.push_back(cell.ccv.value_or(not_a_number));
      if (sums_.vibrates) ++modes[static_cast<std::size_t>(cell.meter.mode)];
    }
    for (std::size_t m = 0; m < means.size(); ++m)
      values.*means[m].into = mean_of(found[m]);
    values.cmv_scatter = scatter_of(found[0]);
    values.ccv = mean_of(ccv);
    const auto most = std::max_element(modes.begin(), modes.end());
    if (*most > 0) values.mode = mode_names[static_cast<std::size_t>(most - modes.begin())];
    if (sums_.vibrates) identify_pass(pass, values);
  }

  void identify_pass(const DrivenPass &pass, PassValues &values) {
    try {
      const IdentifiedRecord found = identify_record(part_of(drive_.record, pass), {});
      if (const std::optional<std::string> why = contradiction(found)) throw std::runtime_error(*why);
      values.k = found.whole.law.k.mean;
      values.k_half_width = found.whole.law.k.half_width;
      values.D = found.whole.law.D.mean;
      values.D_half_width = found.whole.law.D.half_width;
    } catch (const std::runtime_error &fault) {
      result_.notes.push_back(
          fmt::format("k and D of pass {} are not identified: {}.", values.pass, fault.what()));
    }
  }

  void add_depth(std::size_t n) {
    std::vector<DumpedBed> loaded;
    if (n > 0)
      for (const long step : drive_.passes[n - 1].passing)
        loaded.push_back(read_dumped_bed(drive_.folder, step));
    for (const DepthRow &row :
         depth_profile(drive_, drive_.states[n], loaded, result_.passes[n].soil.surface, options_.cell))
      result_.depth.push_back({static_cast<int>(n), row, loaded.size()});
  }

  /// The first pass with dumps enough for an animation; of more than most of them some are left out.
  void choose_animated() {
    constexpr std::size_t least = 5, most = 40;
    for (std::size_t n = 0; n < drive_.passes.size() && result_.animated.pass == 0; ++n) {
      const std::vector<long> &dumps = drive_.passes[n].dumps;
      if (dumps.size() < least) continue;
      result_.animated.pass = static_cast<int>(n) + 1;
      const std::size_t every = (dumps.size() + most - 1) / most;
      for (std::size_t i = 0; i < dumps.size(); i += every) {
        const double time = static_cast<double>(dumps[i]) * drive_.timestep;
        const double row = std::round((time - drive_.history.time.front()) / drive_.record.interval);
        result_.animated.steps.push_back(dumps[i]);
        result_.animated.times.push_back(time);
        result_.animated.places.push_back(drive_.history.s[static_cast<std::size_t>(
            std::clamp(row, 0.0, static_cast<double>(drive_.history.size() - 1)))]);
      }
    }
  }

  const Drive &drive_;
  const PassesOptions &options_;
  PassesResult result_;
  std::vector<WayPart> parts_;
  MeterRecord sums_, samples_;
  std::vector<LayerPackings> packings_;
};

} // namespace

PassesResult measure_passes(const Drive &drive, const PassesOptions &options) {
  return Measurement(drive, options).result();
}

std::optional<int> passes_until_level(const std::vector<double> &values, double share) {
  const double whole = std::abs(values.back() - values.front());
  if (!(whole > 0.0)) return std::nullopt;
  std::size_t n = values.size() - 1;
  while (n > 0 && std::abs(values[n] - values[n - 1]) < share * whole)
    --n;
  return n + 1 == values.size() ? std::nullopt : std::optional(static_cast<int>(n));
}

MeanInterval gain_along_the_way(const PassesResult &result, std::size_t layer) {
  const std::size_t cells = result.cells.size() / result.passes.size();
  std::vector<double> gains;
  for (std::size_t i = 0; i < cells; ++i)
    gains.push_back(result.cells[result.cells.size() - cells + i].after.solid_fraction[layer] -
                    result.cells[i].after.solid_fraction[layer]);
  return mean_interval(gains);
}

std::string cell_of(double value) { return std::isfinite(value) ? number_text(value) : ""; }
std::string cell_of(std::optional<double> value) { return value ? cell_of(*value) : ""; }

namespace {

/// Depth of a height below the surface before the first pass.
double depth_of(const PassesResult &result, double height) {
  return result.passes.front().soil.surface - height;
}

} // namespace

std::vector<PassColumn> pass_columns(std::size_t layers) {
  std::vector<PassColumn> columns;
  const auto add = [&](const std::string &header, double PassValues::*value) {
    columns.push_back({header, [value](const PassValues &pass) { return pass.*value; }});
  };
  const auto add_layer = [&](const char *name, const char *unit, auto value) {
    for (std::size_t layer = 0; layer < layers; ++layer)
      columns.push_back({fmt::format("{}_{} [{}]", name, layer + 1, unit),
                         [value, layer](const PassValues &pass) { return value(pass)[layer]; }});
  };
  add("settlement [m]", &PassValues::settlement);
  add("settlement_scatter [m]", &PassValues::settlement_scatter);
  add("compaction [m]", &PassValues::compaction);
  columns.push_back({"pushed [m]", [](const PassValues &pass) { return pass.pushed(); }});
  add("heave [m]", &PassValues::heave);
  add_layer(
      "thickness", "m", [](const PassValues &pass) -> const auto & { return pass.soil.thickness; });
  add_layer(
      "solid_fraction", "-", [](const PassValues &pass) -> const auto & { return pass.soil.solid_fraction; });
  add_layer(
      "solid_fraction_scatter", "-",
      [](const PassValues &pass) -> const auto & { return pass.solid_scatter; });
  for (std::size_t layer = 0; layer < layers; ++layer)
    columns.push_back({fmt::format("inner_solid_fraction_{} [-]", layer + 1),
                       [layer](const PassValues &pass) { return pass.soil.inner_solid_fraction(layer); }});
  add_layer(
      "relative_density", "-", [](const PassValues &pass) -> const auto & { return pass.relative_density; });
  add_layer(
      "degree_of_compaction", "-", [](const PassValues &pass) -> const auto & { return pass.degree; });
  add("energy_exciter [J/m]", &PassValues::energy_exciter);
  add("energy_traction [J/m]", &PassValues::energy_traction);
  add("traction [N]", &PassValues::traction);
  add("CMV [-]", &PassValues::cmv);
  add("CMV_scatter [-]", &PassValues::cmv_scatter);
  add("RMV [-]", &PassValues::rmv);
  add("CCV [-]", &PassValues::ccv);
  add("k_B [N/m]", &PassValues::k_B);
  add("E_vib [Pa]", &PassValues::E_vib);
  add("k [N/m]", &PassValues::k);
  add("k_half_width [N/m]", &PassValues::k_half_width);
  add("D [-]", &PassValues::D);
  add("D_half_width [-]", &PassValues::D_half_width);
  add("contact_share [-]", &PassValues::contact_share);
  add("peak_force [N]", &PassValues::peak_force);
  return columns;
}

std::size_t most_passes(const std::vector<PassesResult> &results) {
  std::size_t most = 0;
  for (const PassesResult &result : results)
    most = std::max(most, result.passes.size() - 1);
  return most;
}

std::vector<double> values_after(const std::vector<PassesResult> &results, std::size_t pass,
                                 const std::function<double(const PassValues &)> &value) {
  std::vector<double> values;
  for (const PassesResult &result : results)
    if (pass < result.passes.size())
      if (const double one = value(result.passes[pass]); std::isfinite(one)) values.push_back(one);
  return values;
}

std::string mode_in(const std::vector<PassesResult> &results, std::size_t pass) {
  std::map<std::string, int> counts;
  for (const PassesResult &result : results)
    if (pass < result.passes.size()) ++counts[result.passes[pass].mode];
  const auto most = std::max_element(counts.begin(), counts.end(),
                                     [](const auto &a, const auto &b) { return a.second < b.second; });
  return most == counts.end() ? "" : most->first;
}

std::string passes_csv(const std::vector<PassesResult> &results) {
  const std::vector<PassColumn> columns = pass_columns(results.front().layers());
  std::vector<std::string> header = {"pass", "runs"};
  for (const PassColumn &column : columns) {
    header.push_back(column.header);
    const std::size_t unit = column.header.find(" [");
    header.push_back(column.header.substr(0, unit) + "_interval" + column.header.substr(unit));
  }
  header.emplace_back("mode");
  std::string text = csv_line(header);
  for (std::size_t pass = 0; pass <= most_passes(results); ++pass) {
    const auto runs = std::count_if(results.begin(), results.end(), [pass](const PassesResult &result) {
      return pass < result.passes.size();
    });
    std::vector<std::string> cells = {std::to_string(pass), std::to_string(runs)};
    for (const PassColumn &column : columns) {
      const std::vector<double> values = values_after(results, pass, column.value);
      const MeanInterval mean = values.empty() ? MeanInterval{NAN, NAN} : mean_interval(values);
      cells.push_back(cell_of(mean.mean));
      cells.push_back(cell_of(mean.half_width));
    }
    cells.push_back(mode_in(results, pass));
    text += csv_line(cells);
  }
  return text;
}

namespace {

std::string passes_csv(const PassesResult &result) {
  const std::vector<PassColumn> columns = pass_columns(result.layers());
  std::vector<std::string> header = {"pass"};
  for (const PassColumn &column : columns)
    header.push_back(column.header);
  header.emplace_back("mode");
  std::string text = csv_line(header);
  for (const PassValues &pass : result.passes) {
    std::vector<std::string> cells = {std::to_string(pass.pass)};
    for (const PassColumn &column : columns)
      cells.push_back(cell_of(column.value(pass)));
    cells.push_back(pass.mode);
    text += csv_line(cells);
  }
  return text;
}

std::string way_csv(const PassesResult &result) {
  std::vector<std::string> header = {"pass", "s [m]", "cycles [-]", "surface_before [m]",
                                     "surface_after [m]"};
  for (std::size_t layer = 0; layer < result.layers(); ++layer)
    header.push_back(fmt::format("solid_fraction_{} [-]", layer + 1));
  header.insert(header.end(), {"CMV [-]", "RMV [-]", "CCV [-]", "contact_share [-]", "peak_force [N]",
                               "energy_exciter [J/m]", "energy_traction [J/m]", "mode"});
  std::string text = csv_line(header);
  for (const WayCell &cell : result.cells) {
    if (cell.pass == 0) continue;
    std::vector<std::string> cells = {
        std::to_string(cell.pass), number_text(0.5 * (cell.part.from + cell.part.to)),
        std::to_string(cell.cycles), cell_of(cell.before.surface), cell_of(cell.after.surface)};
    for (const double phi : cell.after.solid_fraction)
      cells.push_back(cell_of(phi));
    const MeterWindow &meter = cell.meter;
    for (const std::optional<double> &value :
         {meter.cmv, meter.rmv, cell.ccv, meter.contact_share, meter.peak_force})
      cells.push_back(cell_of(value));
    cells.push_back(cell_of(cell.energy_exciter));
    cells.push_back(cell_of(cell.energy_traction));
    cells.emplace_back(cell.cycles > 0 && meter.cmv ? mode_names[static_cast<std::size_t>(meter.mode)] : "");
    text += csv_line(cells);
  }
  return text;
}

std::string surface_csv(const PassesResult &result) {
  std::vector<std::string> header = {"s [m]", "before [m]"};
  for (std::size_t pass = 1; pass < result.surfaces.size(); ++pass)
    header.push_back(fmt::format("pass_{} [m]", pass));
  std::string text = csv_line(header);
  for (std::size_t line = 0; line < result.lines.count; ++line) {
    std::vector<std::string> cells = {number_text(result.lines.at(line))};
    for (const std::vector<double> &heights : result.surfaces)
      cells.push_back(cell_of(heights[line]));
    text += csv_line(cells);
  }
  return text;
}

std::string depth_csv(const PassesResult &result) {
  std::string text =
      csv_line({"pass", "height [m]", "depth [m]", "solid_fraction [-]", "coordination [-]",
                "vertical_stress [Pa]", "largest_vertical_stress [Pa]", "horizontal_stress [Pa]",
                "largest_horizontal_stress [Pa]", "stress_of", "stress_dumps"});
  for (const auto &[pass, row, passing] : result.depth)
    text += csv_line({std::to_string(pass), number_text(row.height), cell_of(depth_of(result, row.height)),
                      cell_of(row.solid_fraction), cell_of(row.coordination), cell_of(row.vertical),
                      cell_of(row.largest_vertical), cell_of(row.horizontal), cell_of(row.largest_horizontal),
                      passing > 0    ? "passing drum"
                      : row.vertical ? "standing roller"
                                     : "",
                      row.vertical ? std::to_string(std::max<std::size_t>(1, passing)) : ""});
  return text;
}

} // namespace

std::vector<FileText> pass_tables(const std::filesystem::path &folder, const PassesResult &result) {
  return {{folder / "passes.csv", passes_csv(result)},
          {folder / "way.csv", way_csv(result)},
          {folder / "surface.csv", surface_csv(result)},
          {folder / "depth.csv", depth_csv(result)}};
}

} // namespace drumlin::post
