#include "meter/both_ends.h"

#include "record/both_ends.h"

#include <fmt/format.h>

#include <algorithm>

namespace drumlin::post {

std::optional<BothEnds> both_ends(const Record &record, const MeterOptions &options, const WayRange &range) {
  if (!record.two_sided()) return std::nullopt;
  const auto windows = [&](const Record &one) {
    MeterRecord cycles = meter_cycles(one);
    if (range.given()) keep_cycles(cycles, one, rows_on(one, range));
    return meter_windows(cycles, options);
  };
  BothEnds ends;
  Record one = record;
  one.cycles_file.clear();
  for (const auto values : {&Record::x_drum, &Record::v_drum, &Record::F_contact})
    (one.*values).clear();
  const std::array<const std::vector<double> *, 2> sensors = {&record.a_left, &record.a_right};
  for (std::size_t end = 0; end < sensors.size(); ++end) {
    one.a_drum = *sensors[end];
    ends.at_end[end] = windows(one);
  }
  ends.missing = missing_for_halves(record);
  if (!ends.missing.empty()) return ends;
  // The force of the soil in the place of the exciter's, on a drum without mass.
  const auto halves = half_signals(record);
  one.m2 = one.m3 = 0.0;
  one.a_frame.assign(record.size(), 0.0);
  const std::array<const std::vector<double> *, 2> forces = {&record.F_left, &record.F_right};
  for (std::size_t half = 0; half < halves.size(); ++half) {
    one.F_contact = *forces[half]; // of a run: it says when the half is in contact
    one.a_drum = halves[half].acceleration;
    one.F_excitation = halves[half].force;
    ends.halves[half] = windows(one);
  }
  return ends;
}

std::vector<std::string> answer_lines(const BothEnds &ends, const MeterWindow &middle) {
  const auto in_MN = [](const std::optional<double> &k) {
    return k ? fmt::format("{:.4g}", 1e-6 * *k) : std::string("-");
  };
  const MeterWindow &left = ends.at_end[0].back(), &right = ends.at_end[1].back();
  std::vector<std::string> lines;
  if (left.k_1 && right.k_1)
    lines.push_back(
        fmt::format("A meter at the left end shows k_1 = {} MN/m, one in the middle {} MN/m, one "
                    "at the right end {} MN/m: one end forth, the other one back if the roller turns round.",
                    in_MN(left.k_1), in_MN(middle.k_1), in_MN(right.k_1)));
  if (!ends.missing.empty()) {
    lines.push_back("The stiffness of each half needs more: " + ends.missing);
    return lines;
  }
  const MeterWindow &of_left = ends.halves[0].back(), &of_right = ends.halves[1].back();
  if (!of_left.k_1 || !of_right.k_1) return lines;
  const auto unbroken = [](const MeterWindow &w) { return w.mode == OperatingMode::continuous_contact; };
  lines.push_back(
      fmt::format("Both together: {} MN/m below the left half, {} MN/m below the right one, ratio "
                  "{:.4g}, {} MN/m in all{}.",
                  in_MN(of_left.k_1), in_MN(of_right.k_1), *of_left.k_1 / *of_right.k_1,
                  in_MN(*of_left.k_1 + *of_right.k_1),
                  unbroken(of_left) && unbroken(of_right)
                      ? ""
                      : "; apparent, since contact is lost: 'drumlin identify' follows that"));
  return lines;
}

} // namespace drumlin::post
