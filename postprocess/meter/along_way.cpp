#include "meter/along_way.h"

#include "chain/linear_algebra.h"
#include "support/csv.h"
#include "support/units.h"

#include <Eigen/Core>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

namespace {

void need_places(const Record &record) {
  if (record.s.empty())
    csv_fault(record.file, 0, {},
              "has no column s, the place along the way; allowed: chain.csv of a way, bed.csv of in.drive");
}

/// The row at a time, and the place there, linear between rows.
std::size_t row_at(const Record &record, double time) {
  const double row = std::round((time - record.time.front()) / record.interval);
  return static_cast<std::size_t>(std::clamp(row, 0.0, static_cast<double>(record.size() - 1)));
}

double place_at(const Record &record, double time) {
  const double row =
      std::clamp((time - record.time.front()) / record.interval, 0.0, static_cast<double>(record.size() - 1));
  const auto low = std::min(static_cast<std::size_t>(row), record.size() - 2);
  const double share = row - static_cast<double>(low);
  return record.s[low] + share * (record.s[low + 1] - record.s[low]);
}

} // namespace

WayRows rows_on(const Record &record, const WayRange &range) {
  need_places(record);
  const int last = static_cast<int>(record.pass.back());
  WayRows rows;
  rows.pass = range.pass.value_or(last);
  const auto refuse = [&](const char *name, double value, const std::string &allowed) {
    throw std::runtime_error(fmt::format("{}: {}", record.file.string(), refusal(name, value, allowed)));
  };
  double low = INFINITY, high = -INFINITY, step = 0.0;
  std::size_t first = record.size(), end = 0;
  for (std::size_t row = 0; row < record.size(); ++row) {
    if (record.pass[row] != rows.pass) continue;
    if (end == row && row > 0) step = std::max(step, std::abs(record.s[row] - record.s[row - 1]));
    first = std::min(first, row);
    end = row + 1;
    low = std::min(low, record.s[row]);
    high = std::max(high, record.s[row]);
  }
  if (end == 0)
    refuse("the pass", rows.pass, fmt::format("a pass of the record, {:g} to {}", record.pass.front(), last));
  const std::string way =
      fmt::format("a part of the way in pass {}, {:g} to {:g} m, from less to more", rows.pass, low, high);
  const double rounding = 1e-9 * std::max({1.0, std::abs(low), std::abs(high)});
  const double from = range.from.value_or(low), to = range.to.value_or(high);
  // The row in which the roller turns belongs to one of the two passes only.
  if (from < low - step - rounding || from >= high) refuse("the place to begin", from, way);
  if (to > high + step + rounding || to <= from) refuse("the place to end", to, way);
  const auto inside = [&](std::size_t row) {
    return record.s[row] >= from - rounding && record.s[row] <= to + rounding;
  };
  while (first < end && !inside(first))
    ++first;
  while (end > first && !inside(end - 1))
    --end;
  // The roller stands behind a pass: only the first of these rows counts.
  while (end > first + 1 && record.s[end - 1] == record.s[end - 2])
    --end;
  rows.first = first;
  rows.end = end;
  if (end < first + 2) refuse("the place to end", to, way + ", of two rows or more");
  return rows;
}

void keep_cycles(MeterRecord &cycles, const Record &record, const WayRows &rows) {
  const double period = 2.0 * pi / cycles.omega, rounding = 1e-6 * period;
  const double begin = record.time[rows.first], end = record.time[rows.end - 1];
  std::vector<MeterCycle> kept;
  for (const MeterCycle &cycle : cycles.cycles)
    if (cycle.begin >= begin - rounding && cycle.begin + period <= end + rounding) kept.push_back(cycle);
  if (kept.size() < static_cast<std::size_t>(least_cycles))
    csv_fault(record.file, 0, "s",
              refusal("the number of cycles on the part of the way", fmt::format("{}", kept.size()),
                      fmt::format("{} or more", least_cycles)));
  cycles.cycles = std::move(kept);
}

Record part_of(const Record &record, const WayRows &rows) {
  Record part = record;
  part.cycles_file.clear();
  keep_samples(part, rows.first, rows.end);
  if (part.cycles() < least_cycles)
    csv_fault(record.file, 0, "s",
              refusal("the number of cycles on the part of the way", fmt::format("{:.3g}", part.cycles()),
                      fmt::format("{} or more", least_cycles)));
  return part;
}

std::vector<MeterWindow> windows_of_length(const MeterRecord &cycles, const Record &record, double length,
                                           const MeterOptions &options) {
  need_places(record);
  const double period = 2.0 * pi / cycles.omega, rounding = 1e-6 * length;
  const auto place = [&](std::size_t cycle) { return place_at(record, cycles.cycles[cycle].begin); };
  const auto place_after = [&](std::size_t cycle) {
    return place_at(record, cycles.cycles[cycle].begin + period);
  };
  const auto pass = [&](std::size_t cycle) {
    return record.pass[row_at(record, cycles.cycles[cycle].begin + 0.5 * period)];
  };
  std::vector<MeterWindow> windows;
  double shortest = INFINITY; // that four cycles of these windows drive
  std::size_t first = 0;
  const std::size_t total = cycles.cycles.size();
  while (first < total) {
    std::size_t end = first + 1; // behind the last cycle of the window
    while (end < total && pass(end) == pass(first) &&
           ((end - first) % 2 != 0 || std::abs(place_after(end - 1) - place(first)) < length - rounding))
      ++end;
    const double driven = std::abs(place_after(end - 1) - place(first));
    if ((end - first) % 2 == 0 && driven >= length - rounding) {
      if (end - first < static_cast<std::size_t>(least_cycles)) {
        shortest = std::min(shortest, driven * least_cycles / static_cast<double>(end - first));
      } else {
        MeterRecord part = cycles;
        const auto begin = cycles.cycles.begin();
        part.cycles = std::vector<MeterCycle>(begin + static_cast<std::ptrdiff_t>(first),
                                              begin + static_cast<std::ptrdiff_t>(end));
        MeterOptions own = options;
        own.window = static_cast<int>(end - first);
        windows.push_back(meter_windows(part, own).front());
        windows.back().first = first;
      }
    }
    first = end;
  }
  if (windows.empty() || std::isfinite(shortest))
    throw std::runtime_error(
        refusal("the window", fmt::format("{:g}m", length),
                std::isfinite(shortest)
                    ? fmt::format("{:.3g}m or more, four cycles of the excitation", shortest)
                    : "a length that the roller drives in one pass, in an even number of cycles"));
  return windows;
}

void add_places(std::vector<MeterWindow> &windows, const Record &record) {
  if (record.s.empty()) return;
  for (MeterWindow &window : windows) {
    window.from = place_at(record, window.begin);
    window.to = place_at(record, window.end);
    window.pass = static_cast<int>(record.pass[row_at(record, window.begin)]);
  }
}

std::optional<double> memory_time(const Record &record, double k, double c) {
  const auto bond = [&](const char *name) -> std::optional<double> {
    const auto found = record.parameters.find(name);
    return found == record.parameters.end() ? std::nullopt : any_number_from_text(found->second);
  };
  const std::optional<double> k23 = bond("k23"), c23 = bond("c23");
  if (!record.m2 || !record.m3 || !k23 || !c23 || !(*record.m2 > 0.0) || !(*record.m3 > 0.0))
    return std::nullopt;
  const double m2 = *record.m2, m3 = *record.m3;
  Eigen::Matrix4d state = Eigen::Matrix4d::Zero();
  state(0, 2) = state(1, 3) = 1.0;
  state.row(2) << -(k + *k23) / m2, *k23 / m2, -(c + *c23) / m2, *c23 / m2;
  state.row(3) << *k23 / m3, -*k23 / m3, *c23 / m3, -*c23 / m3;
  if (!state.allFinite()) return std::nullopt;
  const double slowest = -eigenvalues_of(state).real().maxCoeff();
  if (!(slowest > 0.0)) return std::nullopt;
  constexpr double hundredth = 4.60517018598809; // ln 100
  return hundredth / slowest;
}

std::string averaging_words(const Record &record, double begin, double end,
                            const std::optional<std::pair<double, double>> &soil) {
  if (record.s.empty()) return {};
  const double driven = std::abs(place_at(record, end) - place_at(record, begin));
  const double speed = driven / (end - begin);
  if (!(driven > 0.0)) return {};
  std::string text =
      fmt::format("A window averages the soil over {:.3g} m of the way that the roller drives in it, "
                  "at {:.3g} m/s",
                  driven, speed);
  const std::optional<double> memory = soil ? memory_time(record, soil->first, soil->second) : std::nullopt;
  if (memory)
    text +=
        fmt::format(", and over {:.3g} m before it, in which the slowest motion of drum and frame falls to a "
                    "hundredth in unbroken contact",
                    speed * *memory);
  else
    text += "; over which length before it the motion of the roller lasts is not known without stiffness of "
            "the soil, masses and bond";
  return text + ".";
}

} // namespace drumlin::post
