#include "record/stretches.h"

#include "support/units.h"
#include "support/csv.h"
#include "support/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <map>
#include <utility>

namespace drumlin::post {

namespace {

/// The line of the exciter in overlapping windows of four nominal cycles, each a cycle after the one before.
struct Line {
  std::vector<double> size;  ///< logarithm of its amplitude
  std::vector<double> phase; ///< against the nominal frequency, without jumps [rad]
  std::vector<double> share; ///< of the signal's variance
};
constexpr double window = 4.0; // cycles; with Hann's weights lines of half the frequency do not disturb

Line line_of(const std::vector<double> &signal, double interval, double nominal) {
  Line line;
  const double cycle = 2.0 * pi / nominal / interval; // samples
  constexpr double fewest = 2.0;
  for (std::size_t n = 0;
       cycle >= fewest && (static_cast<double>(n) + window) * cycle <= static_cast<double>(signal.size());
       ++n) {
    const double begin = static_cast<double>(n) * cycle, end = begin + window * cycle;
    double weights = 0.0, mean = 0.0, squares = 0.0;
    std::complex<double> wave, of_weights;
    for (auto i = static_cast<std::size_t>(std::ceil(begin)); static_cast<double>(i) < end; ++i) {
      const double at = static_cast<double>(i), value = signal[i],
                   weight = 1.0 - std::cos(2.0 * pi * (at - begin) / (window * cycle));
      const std::complex<double> turn = std::polar(weight, -2.0 * pi * at / cycle);
      weights += weight;
      mean += weight * value;
      squares += weight * value * value;
      wave += value * turn;
      of_weights += turn;
    }
    mean /= weights;
    wave = 2.0 / weights * (wave - mean * of_weights);
    const double before = line.phase.empty() ? 0.0 : line.phase.back();
    line.size.push_back(std::log(std::max(std::abs(wave), 1e-300)));
    line.phase.push_back(before + std::remainder(std::arg(wave) - before, 2.0 * pi));
    line.share.push_back(0.5 * std::norm(wave) / std::max(squares / weights - mean * mean, 1e-300));
  }
  return line;
}

/// Windows from `first` to before `end`.
struct Windows {
  std::size_t first, end;
  std::size_t size() const { return end - first; }
};

/// The runs of windows for which `holds` is true.
template <class Holds>
std::vector<Windows> runs_of(const Windows &all, const Holds &holds) {
  std::vector<Windows> runs;
  for (std::size_t n = all.first; n < all.end; ++n) {
    if (!holds(n)) continue;
    if (runs.empty() || runs.back().end != n) runs.push_back({n, n});
    runs.back().end = n + 1;
  }
  return runs;
}

/// Size, phase at a place and frequency of the line in some windows.
struct State {
  double size, phase, slope;
};
State state_of(const Line &line, const Windows &some, double place) {
  const std::vector<double> sizes(line.size.begin() + static_cast<std::ptrdiff_t>(some.first),
                                  line.size.begin() + static_cast<std::ptrdiff_t>(some.end));
  const auto count = static_cast<double>(some.size());
  const double middle = static_cast<double>(some.first) + 0.5 * (count - 1.0);
  double mean = 0.0, products = 0.0;
  for (std::size_t n = some.first; n < some.end; ++n) {
    mean += line.phase[n] / count;
    products += (static_cast<double>(n) - middle) * line.phase[n];
  }
  const double slope = 12.0 * products / (count * (count * count - 1.0));
  return {median(sizes), mean + slope * (place - middle), slope};
}

using Change = std::array<double, 3>; // of size, phase and frequency
Change change(const State &a, const State &b) {
  return {std::fabs(a.size - b.size), std::fabs(a.phase - b.phase), std::fabs(a.slope - b.slope)};
}

/// The changes that count: the least, or more in a record that is uneasy all the time, as an aperiodic one.
Change limits_of(const std::vector<Change> &changes, const Change &least, double share) {
  constexpr double of_usual = 7.0;
  Change limits = least;
  for (std::size_t i = 0; i < limits.size() && !changes.empty(); ++i) {
    std::vector<double> all;
    all.reserve(changes.size());
    for (const Change &one : changes)
      all.push_back(one[i]);
    limits[i] = std::max(limits[i], of_usual * quantile(all, share));
  }
  return limits;
}

/// How windows before each window are compared with those after it.
struct Comparison {
  std::size_t block;   ///< windows on each side
  std::size_t between; ///< windows left out on each side, which may contain the change
  Change least;        ///< that counts
  double share;        ///< of the changes that are usual in the record
};
constexpr std::size_t least_block = 5;                        // windows at an end of a run
constexpr Comparison abrupt = {8, 2, {0.25, 0.6, 0.08}, 0.6}; // 28 %, 34 degrees, 1.3 %
constexpr Comparison slow = {24, 4, {0.06, 0.35, 0.02}, 0.3};

/// The parts of runs without a change of the line.
std::vector<Windows> parts_of(const Line &line, const std::vector<Windows> &runs, const Comparison &how) {
  std::vector<Change> changes, found(line.size.size());
  for (const Windows &run : runs)
    for (std::size_t n = run.first + how.between + least_block; n + how.between + least_block <= run.end;
         ++n) {
      const Windows before = {std::max(run.first + how.between + how.block, n) - how.between - how.block,
                              n - how.between},
                    after = {n + how.between, std::min(run.end, n + how.between + how.block)};
      const auto place = static_cast<double>(n);
      changes.push_back(found[n] = change(state_of(line, before, place), state_of(line, after, place)));
    }
  const Change limits = limits_of(changes, how.least, how.share);
  const auto above = [&](std::size_t n, double share) {
    return found[n][0] > share * limits[0] || found[n][1] > share * limits[1] ||
           found[n][2] > share * limits[2];
  };
  // A change begins and ends where it has half of its least size.
  std::vector<bool> changing(found.size());
  for (const Windows &run : runs)
    for (const Windows &some : runs_of(run, [&](std::size_t n) { return above(n, 0.5); }))
      if (!runs_of(some, [&](std::size_t n) { return above(n, 1.0); }).empty())
        std::fill(changing.begin() + static_cast<std::ptrdiff_t>(some.first),
                  changing.begin() + static_cast<std::ptrdiff_t>(some.end), true);
  std::vector<Windows> parts;
  for (const Windows &run : runs)
    for (const Windows &part : runs_of(run, [&](std::size_t n) { return !changing[n]; }))
      parts.push_back(part);
  return parts;
}

/// Whether size or frequency of the line change by more within a part than soil changes them: the size by
/// little, since a drum on hard soil loses contact.
bool changes_slowly(const Line &line, const Windows &part) {
  constexpr double most_of_size = 0.4, most_of_slope = 0.05;
  std::vector<double> sizes, slopes;
  for (std::size_t n = part.first; n + slow.block <= part.end; n += slow.block / 2) {
    const State state = state_of(line, {n, n + slow.block}, 0.0);
    sizes.push_back(state.size);
    slopes.push_back(state.slope);
  }
  const auto spread = [](const std::vector<double> &values) {
    if (values.empty()) return 0.0;
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return *most - *least;
  };
  return spread(sizes) > most_of_size || spread(slopes) > most_of_slope;
}

} // namespace

std::vector<Stretch> stretches_of(const std::vector<double> &signal, double interval, double nominal) {
  const Line line = line_of(signal, interval, nominal);
  const Windows all = {0, line.size.size()};
  if (all.end == 0) return {{0, signal.size(), nominal}}; // too short, or of too few samples per cycle
  // The exciter is on where its line is a part of the signal, and of the size that it has elsewhere.
  constexpr double most_of_them = 0.95, least_share = 0.1;
  const double least = quantile(line.size, most_of_them) + std::log(0.25);
  const auto is_on = [&](std::size_t n) { return line.size[n] > least && line.share[n] > least_share; };
  std::vector<bool> on(all.end);
  for (std::size_t n = 0; n < all.end; ++n) // or only for a moment not
    on[n] = is_on(n) || (n > 0 && n + 1 < all.end && is_on(n - 1) && is_on(n + 1));
  const std::vector<Windows> runs = runs_of(all, [&](std::size_t n) { return on[n]; });

  std::vector<Windows> steady;
  for (const Windows &part : parts_of(line, runs, abrupt)) {
    const std::vector<Windows> alone = {part};
    for (const Windows &one : changes_slowly(line, part) ? parts_of(line, alone, slow) : alone)
      steady.push_back(one);
  }

  // At an end of a stretch window by window, against those inside.
  const auto against = [&](std::size_t n, const Windows &inside) {
    const auto place = static_cast<double>(n);
    return change({line.size[n], line.phase[n], 0.0}, state_of(line, inside, place));
  };
  constexpr std::size_t block = abrupt.block;
  std::vector<Change> changes;
  for (const Windows &part : steady)
    for (std::size_t n = part.first; n + block < part.end; ++n)
      changes.push_back(against(n, {n + 1, n + 1 + block}));
  const Change at_ends = limits_of(changes, abrupt.least, abrupt.share);
  std::vector<Stretch> stretches;
  for (Windows part : steady) {
    const auto off = [&](std::size_t n, const Windows &inside) {
      const Change one = against(n, inside);
      return one[0] > at_ends[0] || one[1] > at_ends[1];
    };
    while (part.size() > block && off(part.first, {part.first + 1, part.first + 1 + block}))
      ++part.first;
    while (part.size() > block && off(part.end - 1, {part.end - 1 - block, part.end - 1}))
      --part.end;
    if (part.size() < std::min(block, all.end)) continue;
    const double cycle = 2.0 * pi / nominal / interval;
    const auto sample = [cycle](double cycles) {
      return static_cast<std::size_t>(std::ceil(cycles * cycle));
    };
    const double slope = part.size() > 1 ? state_of(line, part, 0.0).slope : 0.0;
    stretches.push_back(
        {part.first == 0 ? 0 : sample(static_cast<double>(part.first) + 0.5 * window),
         part.end == all.end ? signal.size() : sample(static_cast<double>(part.end) - 1.0 + 0.5 * window),
         nominal * (1.0 + slope / (2.0 * pi))});
  }
  return stretches;
}

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
