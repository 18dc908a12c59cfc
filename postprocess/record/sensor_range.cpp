#include "record/sensor_range.h"

#include "support/csv.h"
#include "support/range.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace drumlin::post {

namespace {

/// The number of values from `low` to `high` among sorted ones.
std::size_t count_of(const std::vector<double> &sorted, double low, double high) {
  return static_cast<std::size_t>(std::upper_bound(sorted.begin(), sorted.end(), high) -
                                  std::lower_bound(sorted.begin(), sorted.end(), low));
}

/// Runs of consecutive values from `low` to `high`.
struct Runs {
  double mean = 0.0;    ///< number of values
  bool regular = false; ///< nine of ten begin as far behind the one before: samples repeat with each cycle
};

Runs runs_of(const std::vector<double> &values, double low, double high) {
  std::size_t inside = 0, last = 0;
  std::map<std::size_t, std::size_t> distances;
  std::size_t runs = 0, most = 0;
  bool before = false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool now = values[i] >= low && values[i] <= high;
    inside += now ? 1 : 0;
    if (now && !before) {
      if (runs++ > 0) most = std::max(most, ++distances[i - last]);
      last = i;
    }
    before = now;
  }
  constexpr double nine_of_ten = 0.9;
  return {static_cast<double>(inside) / static_cast<double>(std::max<std::size_t>(runs, 1)),
          static_cast<double>(most) >= nine_of_ten * static_cast<double>(runs)};
}

/// The largest step of which two differences are multiples, to a millionth of the range: few different
/// values, as of a record that repeats with its samples, are further apart than a sensor's step.
double common_step(double one, double other, double range) {
  const double rounding = 1e-6 * range;
  while (other > rounding) {
    double rest = std::fmod(one, other);
    if (other - rest < rounding) rest = 0.0;
    one = other;
    other = rest;
  }
  return one;
}

/// Share of the values that are at the highest of them.
double share_at_top(const std::vector<double> &values) {
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const double top = sorted.back(), range = top - sorted.front();
  double step = range; // of the sensor
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i] - sorted[i - 1] > 1e-9 * range) step = common_step(step, sorted[i] - sorted[i - 1], range);
  constexpr double narrowest = 4096.0, widest = 16.0, steps = 2.5;
  constexpr double usual = 7.0;       // times as many as in a range inside, which no smooth signal has
  constexpr double rare = 0.01;       // of the values
  constexpr double inside = 3.0;      // ranges inside that are compared
  constexpr int cells = 12, most = 9; // of these ranges, and how many have values in a record of all phases
  constexpr double in_a_row = 2.5;    // or the values stay there,
  constexpr double far = 8.0, hardly = 6.0; // with hardly any in this many ranges below
  const auto all = static_cast<double>(values.size());
  double share = 0.0;
  for (double width = range / narrowest; width <= range / widest; width *= 2.0) {
    if (width < steps * step) continue;
    // Noise spreads the values about the limit: the range of the most of them.
    std::size_t here = 0;
    double high = top;
    for (const double below : {0.0, 0.25, 0.5, 0.75, 1.0})
      if (const std::size_t count = count_of(sorted, top - (1.0 + below) * width, top - below * width);
          count > here) {
        here = count;
        high = top - below * width;
      }
    const double low = high - width, cell = inside * width / cells;
    const auto next =
        static_cast<double>(count_of(sorted, low - inside * width, std::nextafter(low, low - 1.0)));
    if (static_cast<double>(here) < rare * all || static_cast<double>(here) * inside < usual * next) continue;
    int filled = 0;
    for (int n = 0; n < cells; ++n)
      filled +=
          count_of(sorted, low - (n + 1) * cell, std::nextafter(low - n * cell, low - range)) > 0 ? 1 : 0;
    // A record whose samples repeat with each cycle has few values anywhere: at a limit they stay, and leave
    // it by far more than where a signal turns.
    const Runs runs = runs_of(values, low, high);
    const auto beyond =
        static_cast<double>(count_of(sorted, low - far * width, std::nextafter(low, low - 1.0)));
    if ((filled < most || runs.regular) &&
        (runs.mean < in_a_row || hardly * beyond > static_cast<double>(here)))
      continue;
    share = std::max(share, static_cast<double>(count_of(sorted, low, top)) / all);
  }
  return share;
}

} // namespace

AtLimit share_at_limit(const std::vector<double> &values) {
  std::vector<double> turned;
  turned.reserve(values.size());
  for (const double value : values)
    turned.push_back(-value);
  return {share_at_top(values), share_at_top(turned)};
}

void check_sensors(const Record &record) {
  if (record.of_run) return;
  for (const auto &[name, values] :
       {std::pair{"a_drum", &record.a_drum}, std::pair{"a_frame", &record.a_frame},
        std::pair{"a_left", &record.a_left}, std::pair{"a_right", &record.a_right}}) {
    if (values->empty()) continue;
    const auto [least, most] = std::minmax_element(values->begin(), values->end());
    if (*least == *most)
      csv_fault(record.file, 0, {},
                refusal(name, *least, "values that change; this is the same in every row"));
    const AtLimit at = share_at_limit(*values);
    if (at.high + at.low > 0.0)
      csv_fault(
          record.file, 0, {},
          refusal(name,
                  fmt::format(
                      "{:.6g} to {:.6g} m/s2, with {:.2g} % of its samples at the one end and {:.2g} % at "
                      "the other",
                      *least, *most, 100.0 * at.low, 100.0 * at.high),
                  "a signal within the range of its sensor, which this one reaches"));
  }
}

} // namespace drumlin::post
