#include "passes/values.h"

#include "bed/relative_density.h"
#include "identify/identified_record.h"
#include "support/constants.h"
#include "support/range.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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

} // namespace drumlin::post
