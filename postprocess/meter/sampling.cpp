#include "meter/sampling.h"

#include "support/units.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drumlin::post {

namespace {

constexpr double sure = 3.0; // standard deviations

/// The value that a quarter of the values does not reach.
double lower_quartile(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 4);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}
constexpr double quartile_of_normal = 0.3186; // of the size of a normal variable, in standard deviations

/// Sizes of the differences of an order of a sequence.
std::vector<double> differences(std::vector<double> values, int order) {
  for (int i = 0; i < order; ++i) {
    for (std::size_t j = 0; j + 1 < values.size(); ++j)
      values[j] = values[j + 1] - values[j];
    values.pop_back();
  }
  for (double &value : values)
    value = std::abs(value);
  return values;
}

/// Standard deviation of white noise from the lower quartile of differences that hardly contain the signal.
double noise_of(const std::vector<double> &signal) {
  constexpr int order = 6;
  constexpr double sum_of_squares = 924.0; // of the binomial coefficients
  if (signal.size() <= 2 * order) return 0.0;
  return lower_quartile(differences(signal, order)) / quartile_of_normal / std::sqrt(sum_of_squares);
}

/// The jump between two places next to each other, or with one between them: both sides are continued as
/// straight lines to a place between them, `share` of the way.
double jump_at(const std::vector<double> &a, std::size_t before, std::size_t after, double share) {
  const double way = share * static_cast<double>(after - before);
  const double rest = static_cast<double>(after - before) - way;
  return a[after] - rest * (a[after + 1] - a[after]) - a[before] - way * (a[before] - a[before - 1]);
}

} // namespace

SignalFaults faults_of(const Record &record, HarmonicSource source) {
  const bool velocity = source == HarmonicSource::velocity;
  SignalFaults faults;
  faults.noise = noise_of(velocity ? record.v_drum : record.a_drum);
  std::vector<double> a = velocity ? record.v_drum : record.a_drum;
  if (velocity) {
    for (std::size_t i = 0; i + 1 < a.size(); ++i)
      a[i] = (a[i + 1] - a[i]) / record.interval;
    a.pop_back();
  }
  // The mean acceleration of the interval with the jump lies between those before and after it. A jump shows
  // in `alone` intervals to either side, too.
  const std::size_t alone = velocity ? 2 : 1;
  const auto jump = [&](std::size_t i, double share) {
    return jump_at(a, velocity ? i - 1 : i, i + 1, share);
  };
  std::vector<double> &size = faults.differences;
  size.assign(record.size() - 1, 0.0);
  for (std::size_t i = alone; i + 2 < a.size(); ++i)
    size[i] = std::abs(jump(i, 0.5));
  constexpr double standard_deviations = 5.0;
  const double of_noise = velocity ? std::sqrt(28.0) / record.interval : std::sqrt(5.0); // from the weights
  const double least = std::max(standard_deviations * of_noise * faults.noise,
                                1e-9 * *std::max_element(size.begin(), size.end()));
  for (std::size_t i = alone; i + 2 < a.size(); ++i) {
    if (!(size[i] > least)) continue;
    const auto from = size.begin() + static_cast<std::ptrdiff_t>(i - alone);
    const auto to = size.begin() + static_cast<std::ptrdiff_t>(std::min(size.size(), i + alone + 1));
    if (std::max_element(from, to) != size.begin() + static_cast<std::ptrdiff_t>(i)) continue;
    // The differences of a jump change their sign within two intervals. Those of a curve do not, if a cycle
    // has enough samples.
    constexpr double opposite = 0.15, enough = 30.0;
    const double sign = jump(i, 0.5) > 0.0 ? 1.0 : -1.0;
    bool curve = record.period() > enough * record.interval;
    for (std::size_t near = i < alone + 2 ? alone : i - 2; near <= i + 2 && near + 2 < a.size(); ++near)
      curve = curve && sign * jump(near, 0.5) > -opposite * size[i];
    if (curve) continue;
    const double side = velocity ? 0.25 : 0.0; // the ends of interval i
    faults.jumps.push_back({record.time[i] + 0.5 * record.interval,
                            std::max({size[i], std::abs(jump(i, side)), std::abs(jump(i, 1.0 - side))})});
  }
  return faults;
}

namespace {

/// Largest mean of sign_c B(s + c step), c = 0 to count - 1, for any s, with B periodic: how much of the
/// error of a jump remains in the mean over cycles. \param alternate sign_c = (-1)^c, else 1
double remaining(int count, double step, bool alternate, bool velocity) {
  struct Place {
    double share, sign;
  };
  std::vector<Place> places(static_cast<std::size_t>(count));
  for (int c = 0; c < count; ++c) {
    constexpr double rounding = 1e-9;
    double share = std::fmod(step * c, 1.0);
    if (share > 1.0 - rounding) share = 0.0;
    places[static_cast<std::size_t>(c)] = {share, alternate && c % 2 != 0 ? -1.0 : 1.0};
  }
  std::sort(places.begin(), places.end(), [](const Place &a, const Place &b) { return a.share > b.share; });
  double all = 0.0, first = 0.0, second = 0.0; // sums of sign, sign share, sign share^2
  for (const Place &place : places) {
    all += place.sign;
    first += place.sign * place.share;
    second += place.sign * place.share * place.share;
  }
  double most = 0.0;
  const auto take = [&] {
    most = std::max(most, std::abs(velocity ? second - first + all / 6.0 : first - 0.5 * all));
  };
  const auto move = [&](double by) {
    second += 2.0 * by * first + by * by * all;
    first += by * all;
  };
  double moved = 0.0;
  for (const Place &place : places) { // s grows until the share of one place after the other reaches 1
    const double by = 1.0 - place.share - moved;
    take();
    move(0.5 * by);
    take();
    move(0.5 * by);
    take();
    moved += by;
    first -= place.sign;
    second -= place.sign;
  }
  return most / count;
}

/// Whether the jumps return after some periods: those of at least a quarter of the largest one's size, nine
/// tenths of them.
bool returns(const std::vector<AccelerationJump> &jumps, double after, double interval) {
  double largest = 0.0;
  for (const AccelerationJump &jump : jumps)
    largest = std::max(largest, jump.size);
  std::size_t asked = 0, found = 0, next = 0;
  for (const AccelerationJump &jump : jumps) {
    const double time = jump.time + after;
    if (jump.size < 0.25 * largest || time > jumps.back().time + 1.1 * interval) continue;
    ++asked;
    while (next < jumps.size() && jumps[next].time < time - 1.1 * interval)
      ++next;
    if (next < jumps.size() && jumps[next].time < time + 1.1 * interval) ++found;
  }
  return asked > 0 && 10 * found >= 9 * asked;
}

bool is_whole(std::size_t order) { return order % 2 == 1; }

using Harmonics = std::array<std::complex<double>, meter_orders.size()>;

/// The error of each harmonic for B = 1 by a jump at a share s of its interval.
Harmonics error_of(const AccelerationJump &jump, double s, const SampledCycles &cycles) {
  const double time = 2.0 * pi / cycles.omega * cycles.cycles;
  Harmonics errors;
  for (std::size_t j = 0; j < errors.size(); ++j) {
    const double w = meter_orders[j] * cycles.omega;
    const double turn = w * (jump.time + (s - 0.5) * cycles.interval);
    const double curved = cycles.source == HarmonicSource::velocity ? 0.5 * w * cycles.interval : 1.0;
    const std::complex<double> direction = cycles.source == HarmonicSource::velocity
                                               ? std::complex<double>(-std::sin(turn), -std::cos(turn))
                                               : std::complex<double>(std::cos(turn), -std::sin(turn));
    errors[j] = 2.0 / time * jump.size * cycles.interval * curved * direction;
  }
  return errors;
}

} // namespace

double sampling_bound(const MeterFormula &formula, const SampledCycles &cycles) {
  const bool velocity = cycles.source == HarmonicSource::velocity;
  const double per_cycle = 2.0 * pi / cycles.omega / cycles.interval;
  const double step = per_cycle - std::floor(per_cycle + 1e-9);
  const int period = returns(cycles.jumps, 2.0 * pi / cycles.omega, cycles.interval)   ? 1
                     : returns(cycles.jumps, 4.0 * pi / cycles.omega, cycles.interval) ? 2
                                                                                       : 0;
  // The largest share of B = 1 that remains in whole and half orders.
  std::array<double, 2> remains{};
  for (const bool half : {false, true})
    remains[half ? 1 : 0] =
        period == 0 ? (velocity ? std::sqrt(1.0 / 180.0) : std::sqrt(1.0 / 12.0))
                    : remaining(cycles.cycles / period, period * step, half && period == 1, velocity);

  MeterAmplitudes amplitude{};
  for (std::size_t j = 0; j < amplitude.size(); ++j)
    amplitude[j] = std::abs(cycles.harmonics[j]);
  // What noise and jumps do to each amplitude alone.
  const double samples = per_cycle * cycles.cycles;
  MeterAmplitudes noise{}, off{}, border{};
  // The largest error of an end of the cycles that lies between two samples, next to a jump of height 1, with
  // Cubic's rule: of its integral, and of a velocity [intervals].
  const double next_to = velocity ? 0.15 : 0.55;
  for (std::size_t j = 0; j < border.size(); ++j)
    border[j] = next_to * cycles.end_jumps * cycles.interval * cycles.omega / (pi * cycles.cycles);
  for (std::size_t j = 0; j < noise.size(); ++j) {
    const double each = cycles.noise * std::sqrt(2.0 / samples);
    const double ends = std::sqrt(2.0) * cycles.noise * cycles.omega / (pi * cycles.cycles);
    noise[j] = velocity ? std::hypot(each * meter_orders[j] * cycles.omega, ends) : each;
  }
  std::vector<std::array<Harmonics, 2>> errors; // B is largest at the ends of an interval
  for (const AccelerationJump &jump : cycles.jumps)
    errors.push_back({error_of(jump, 0.0, cycles), error_of(jump, 1.0, cycles)});
  for (std::size_t j = 0; j < off.size(); ++j) {
    double sum = 0.0, squares = 0.0;
    for (const auto &ends : errors) {
      sum += std::abs(ends[0][j]);
      squares += std::norm(ends[0][j]);
    }
    off[j] = remains[is_whole(j) ? 0 : 1] * (period > 0 ? sum : sure * std::sqrt(squares)) + border[j];
    // Cycles that differ a little: as much of a half order may be missing as the shift of their jumps makes.
    if (period == 1 && !is_whole(j))
      border[j] += amplitude[j] * (velocity ? 0.5 * meter_orders[j] * cycles.omega * cycles.interval : 1.0);
  }

  // The value's derivative by each amplitude.
  double above = 0.0, below = 0.0, below_off = 0.0;
  for (std::size_t j = 0; j < amplitude.size(); ++j) {
    above += formula.above[j] * amplitude[j];
    below += formula.below[j] * amplitude[j];
    below_off += formula.below[j] * (off[j] + sure * noise[j]);
  }
  if (!(below > below_off)) return std::numeric_limits<double>::infinity();
  const double value = formula.constant * above / below;
  MeterAmplitudes slope{};
  for (std::size_t j = 0; j < slope.size(); ++j)
    slope[j] = (formula.constant * formula.above[j] - value * formula.below[j]) / (below - below_off);

  double sum = 0.0, squares = 0.0, noisy = 0.0, bordering = 0.0;
  for (const auto &ends : errors) {
    std::array<double, 2> largest{};
    for (const Harmonics &error : ends) {
      std::array<double, 2> part{}, any{};
      for (std::size_t j = 0; j < slope.size(); ++j) {
        const std::size_t kind = is_whole(j) ? 0 : 1;
        // An amplitude that is hardly larger than its error may grow whatever the direction of the error.
        constexpr double clear = 3.0;
        if (amplitude[j] > clear * off[j])
          part[kind] += slope[j] * (error[j] * std::conj(cycles.harmonics[j])).real() / amplitude[j];
        else
          any[kind] += std::abs(slope[j]) * std::abs(error[j]);
      }
      for (std::size_t kind = 0; kind < largest.size(); ++kind)
        largest[kind] = std::max(largest[kind], std::abs(part[kind]) + any[kind]);
    }
    for (std::size_t kind = 0; kind < largest.size(); ++kind) {
      sum += remains[kind] * largest[kind];
      squares += std::pow(remains[kind] * largest[kind], 2);
    }
  }
  for (std::size_t j = 0; j < slope.size(); ++j) {
    bordering += std::abs(slope[j]) * border[j];
    // Noise makes an amplitude of its own size only larger, and several of them all together.
    if (amplitude[j] > sure * noise[j])
      noisy += std::pow(slope[j] * noise[j], 2);
    else
      bordering += sure * std::abs(slope[j]) * noise[j];
  }
  constexpr double rounding = 1e-9;
  return (period > 0 ? sum : sure * std::sqrt(squares)) + sure * std::sqrt(noisy) + bordering +
         rounding * formula.constant;
}

} // namespace drumlin::post
