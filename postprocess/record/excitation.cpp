#include "record/excitation.h"

#include "chain/contact_phases.h"
#include "chain/linear_algebra.h"
#include "record/both_ends.h"
#include "record/stretches.h"
#include "support/csv.h"
#include "support/units.h"
#include "support/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numeric>
#include <string>

namespace drumlin::post {

namespace {

/// Power of a signal at a frequency, up to a constant factor.
double power_at(const std::vector<double> &signal, double interval, double omega) {
  const std::complex<double> turn = std::polar(1.0, -omega * interval);
  std::complex<double> wave = 1.0, sum = 0.0;
  for (const double value : signal) {
    sum += value * wave;
    wave *= turn;
  }
  return std::norm(sum);
}

/// Means of neighbours, so that at least `per_cycle` samples remain in a cycle; the interval grows.
std::vector<double> thinned(const std::vector<double> &signal, double &interval, double period,
                            int per_cycle) {
  const auto together = static_cast<std::size_t>(std::max(1.0, std::floor(period / interval / per_cycle)));
  std::vector<double> means;
  for (std::size_t i = 0; i + together <= signal.size(); i += together)
    means.push_back(std::accumulate(signal.begin() + static_cast<std::ptrdiff_t>(i),
                                    signal.begin() + static_cast<std::ptrdiff_t>(i + together), 0.0) /
                    static_cast<double>(together));
  interval *= static_cast<double>(together);
  return means;
}

/// The frequency of the strongest line within the range; nothing if it lies at an end of it.
std::optional<double> strongest_line(const std::vector<double> &signal, double interval, double nominal) {
  constexpr int per_cycle = 16;
  double step = interval;
  std::vector<double> values = thinned(signal, step, 2.0 * pi / nominal, per_cycle);
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) { // without its mean, fading in and out (Hann)
    const double angle = 2.0 * pi * (static_cast<double>(i) + 0.5) / static_cast<double>(values.size());
    values[i] = (values[i] - mean) * (1.0 - std::cos(angle));
  }
  const double length = step * static_cast<double>(values.size());
  const double spacing = 2.0 * pi / length / 4.0;
  const auto half = static_cast<int>(std::ceil(frequency_range * nominal / spacing));
  int best = -half;
  double most = -1.0;
  for (int i = -half; i <= half; ++i) {
    const double power = power_at(values, step, nominal + i * spacing);
    if (power <= most) continue;
    most = power;
    best = i;
  }
  if (std::abs(best) == half) return std::nullopt;
  // The top of a parabola through the logarithms of three powers.
  const double center = nominal + best * spacing;
  const double before = std::log(power_at(values, step, center - spacing));
  const double after = std::log(power_at(values, step, center + spacing));
  const double curvature = before + after - 2.0 * std::log(most);
  return curvature < 0.0 ? center + 0.5 * spacing * (before - after) / curvature : center;
}

/// Multiples of half the frequency that are fitted.
int orders_below(double interval, double omega) {
  constexpr int most = 12;
  constexpr double share = 0.9; // of half the sampling rate
  return std::min(most, static_cast<int>(share * pi / interval / (0.5 * omega)));
}

} // namespace

std::optional<MeanInterval> frequency_of(const std::vector<double> &signal, double interval, double nominal) {
  // In a short record lines are wider than the range.
  constexpr double few_cycles = 12.0;
  const bool is_short = interval * static_cast<double>(signal.size()) * nominal < few_cycles * 2.0 * pi;
  const std::optional<double> line = is_short ? nominal : strongest_line(signal, interval, nominal);
  if (!line) return std::nullopt;
  double omega = *line;
  const int orders = orders_below(interval, omega);
  const Eigen::Index unknowns = 2 + 2 * orders; // constant, waves, and last the frequency
  const double middle = 0.5 * interval * static_cast<double>(signal.size() - 1);
  Eigen::VectorXd waves = Eigen::VectorXd::Zero(unknowns); // without the last
  Eigen::MatrixXd normal;
  std::vector<double> scores; // of the frequency, cycle by cycle, without what the waves take
  double information = 0.0;
  constexpr int most_rounds = 8;
  for (int round = 0; round < most_rounds; ++round) {
    normal = Eigen::MatrixXd::Zero(unknowns, unknowns);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns);
    std::vector<Eigen::VectorXd> of_cycle; // gradients
    Eigen::VectorXd row(unknowns);
    for (std::size_t i = 0; i < signal.size(); ++i) {
      const double t = interval * static_cast<double>(i) - middle;
      const std::complex<double> half = std::polar(1.0, 0.5 * omega * t);
      std::complex<double> wave = 1.0;
      double value = waves[0], slope = 0.0;
      row[0] = 1.0;
      for (int n = 1; n <= orders; ++n) {
        wave *= half;
        const Eigen::Index at = 2 * n - 1;
        row[at] = wave.real();
        row[at + 1] = wave.imag();
        value += waves[at] * wave.real() + waves[at + 1] * wave.imag();
        slope += 0.5 * n * t * (waves[at + 1] * wave.real() - waves[at] * wave.imag());
      }
      row[unknowns - 1] = slope;
      normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
      right += row * (signal[i] - value);
      const auto cycle = static_cast<std::size_t>((t + middle) * omega / (2.0 * pi));
      if (of_cycle.size() <= cycle) of_cycle.resize(cycle + 1, Eigen::VectorXd::Zero(unknowns));
      of_cycle[cycle] += row * (signal[i] - value);
    }
    normal = normal.selfadjointView<Eigen::Lower>();
    const bool first = round == 0; // the waves alone, by which the frequency has a slope
    const Eigen::Index fitted = unknowns - (first ? 1 : 0);
    const SymmetricSystem solver(normal.topLeftCorner(fitted, fitted));
    const Eigen::VectorXd change = solver.solution(right.head(fitted));
    waves.head(unknowns - 1) += change.head(unknowns - 1);
    if (first) continue;
    const double step = change[unknowns - 1];
    omega += step;
    if (!(std::fabs(omega - nominal) < frequency_range * nominal)) return std::nullopt;
    const Eigen::VectorXd direction = solver.solution(Eigen::VectorXd::Unit(unknowns, unknowns - 1));
    information = direction[unknowns - 1];
    scores.clear();
    for (const Eigen::VectorXd &gradient : of_cycle)
      scores.push_back(direction.dot(gradient));
    constexpr double converged = 1e-12;
    if (std::fabs(step) < converged * omega) break;
  }
  if (!(information > 0.0)) return std::nullopt;
  const double squares = std::inner_product(scores.begin(), scores.end(), scores.begin(), 0.0);
  const auto cycles = static_cast<double>(scores.size());
  return MeanInterval{omega, t_factor(std::max(1.0, cycles - 2.0)) *
                                 std::sqrt(squares * cycles / std::max(1.0, cycles - 2.0))};
}

namespace {

/// The contact force of a record but for the exciter's, and the times from the middle of the record.
struct Forces {
  std::vector<double> without; ///< [N]
  std::vector<double> time;    ///< [s]
  double Fw = 0.0;             ///< [N]
  std::vector<double> wander;  ///< of the exciter's angle [rad]

  std::vector<double> share; ///< of the exciter's force [-]

  double angle(double omega, std::size_t i) const { return omega * time[i] + wander[i]; }
};

/// The exciter's force Fw (a sin(omega t) + b cos(omega t)) [N].
struct Exciter {
  double omega, a, b;
};

double force_at(const Forces &forces, const Exciter &exciter, std::size_t i) {
  const double angle = forces.angle(exciter.omega, i);
  return forces.without[i] +
         forces.Fw * forces.share[i] * (exciter.a * std::sin(angle) + exciter.b * std::cos(angle));
}

/// Samples from `first` to before `end`.
struct Flight {
  std::size_t first, end;
  std::size_t size() const { return end - first; }
};

std::size_t samples_of(const std::vector<Flight> &flights) {
  return std::accumulate(flights.begin(), flights.end(), std::size_t{0},
                         [](std::size_t sum, const Flight &flight) { return sum + flight.size(); });
}

/// The runs of at least `least` samples for whose forces `holds` is true.
template <class Holds>
std::vector<Flight> runs_of(const std::vector<double> &force, std::size_t least, const Holds &holds) {
  std::vector<Flight> runs;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= force.size(); ++i) {
    if (i < force.size() && holds(force[i])) continue;
    if (i - begin >= least) runs.push_back({begin, i});
    begin = i + 1;
  }
  return runs;
}

std::vector<double> all_forces(const Forces &forces, const Exciter &exciter) {
  std::vector<double> force(forces.without.size());
  for (std::size_t i = 0; i < force.size(); ++i)
    force[i] = force_at(forces, exciter, i);
  return force;
}

/// Of phases two degrees apart, that with which the most samples are in runs of a force within `band`, with
/// `ratio` times the exciter's force.
Exciter best_phase(const Forces &forces, double omega, double ratio, double band, std::size_t least) {
  std::vector<double> sine(forces.time.size()), cosine(sine), force(sine);
  for (std::size_t i = 0; i < sine.size(); ++i) {
    sine[i] = forces.Fw * forces.share[i] * std::sin(forces.angle(omega, i));
    cosine[i] = forces.Fw * forces.share[i] * std::cos(forces.angle(omega, i));
  }
  constexpr int steps = 180;
  Exciter best{omega, ratio, 0.0};
  std::size_t most = 0;
  for (int step = 0; step < steps; ++step) {
    const double phase = 2.0 * pi * step / steps;
    const double a = ratio * std::cos(phase), b = ratio * std::sin(phase);
    for (std::size_t i = 0; i < force.size(); ++i)
      force[i] = forces.without[i] + a * sine[i] + b * cosine[i];
    const std::size_t samples =
        samples_of(runs_of(force, least, [band](double f) { return std::fabs(f) <= band; }));
    if (samples <= most) continue;
    most = samples;
    best = {omega, a, b};
  }
  return best;
}

/// One step of least squares over flights: unknown are a, b and omega. Fills the fit but for its
/// share; the root mean square of the force that is left [N] comes back.
double fit_flights(const Forces &forces, const std::vector<Flight> &flights, Exciter &exciter,
                   FlightFit &fit) {
  constexpr Eigen::Index unknowns = 3;
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  std::vector<Eigen::Vector3d> scores;
  double left = 0.0;
  const double unit = std::max(std::fabs(forces.time.back()), std::fabs(forces.time.front())); // of 1 / omega
  for (const Flight &flight : flights) {
    scores.emplace_back(Eigen::Vector3d::Zero());
    for (std::size_t i = flight.first; i < flight.end; ++i) {
      const double angle = forces.angle(exciter.omega, i), sine = forces.share[i] * std::sin(angle),
                   cosine = forces.share[i] * std::cos(angle);
      const Eigen::Vector3d row(sine, cosine,
                                forces.time[i] / unit * (exciter.a * cosine - exciter.b * sine));
      const double off = force_at(forces, exciter, i) / forces.Fw;
      square += row * row.transpose();
      scores.back() += row * off;
      left += off * off;
    }
  }
  const Eigen::Matrix3d inverse = SymmetricSystem(square).inverse();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d &score : scores)
    sum += score;
  const Eigen::Vector3d change = -inverse * sum;
  exciter.a += change[0];
  exciter.b += change[1];
  exciter.omega += change[2] / unit;
  const auto count = static_cast<double>(scores.size());
  const double freedom = std::max(1.0, count - static_cast<double>(unknowns));
  const auto half_width = [&](const Eigen::Vector3d &direction) {
    const Eigen::Vector3d of_score = inverse * direction;
    double squares = 0.0;
    for (const Eigen::Vector3d &score : scores)
      squares += std::pow(of_score.dot(score), 2);
    return t_factor(freedom) * std::sqrt(squares * count / freedom);
  };
  const double size = std::hypot(exciter.a, exciter.b);
  fit.flights = flights.size();
  fit.ratio = {size, half_width({exciter.a / size, exciter.b / size, 0.0})};
  fit.phase = {std::atan2(exciter.b, exciter.a),
               half_width({-exciter.b / (size * size), exciter.a / (size * size), 0.0})};
  fit.omega = {exciter.omega, half_width(Eigen::Vector3d::UnitZ()) / unit};
  return forces.Fw * std::sqrt(left / static_cast<double>(samples_of(flights)));
}

/// Makes the forces of samples infinite in which a moment acts: then one end of the drum is not in flight.
/// Whether the record tells it.
bool forbid_moments(const Record &record, Forces &forces) {
  if (!record.ends || !(record.ends->sensor > 0.0) || record.a_frame.empty()) return false;
  const TwoEnds &ends = *record.ends;
  const std::vector<double> drum = drum_tilt(record), frame = frame_tilt(record);
  std::vector<double> moment(record.size());
  for (std::size_t i = 0; i < moment.size(); ++i)
    moment[i] = ends.drum_inertia * drum[i] + ends.frame_inertia * frame[i];
  constexpr double wide = 0.03; // of Fw at a contact
  const double arm = std::fabs(ends.contacts[0].y);
  const double most =
      (wide * arm + std::fabs(ends.exciter)) * forces.Fw + 3.0 * noise_level(moment); // the exciter's, too
  for (std::size_t i = 0; i < moment.size(); ++i)
    if (std::fabs(moment[i]) > most) forces.without[i] = std::numeric_limits<double>::infinity();
  return true;
}

/// Whether the force is flat in flights: where contact is not lost, a wrong phase of the exciter leaves a
/// force that touches zero in a bow, of as much as the weight in half a cycle.
/// \param turn the exciter's angle from sample to sample [rad]
bool are_flat(const std::vector<Flight> &flights, const std::vector<double> &force, double weight,
              double turn) {
  std::vector<std::array<double, 2>> parts; // of each flight: bow times that of the weight, its square
  std::array<double, 2> sums{};
  for (const Flight &flight : flights) {
    const auto size = static_cast<double>(flight.size());
    const double of_weight = 0.5 * weight * std::pow(0.5 * size * turn, 2);
    std::array<double, 2> part{};
    for (std::size_t i = flight.first; i < flight.end; ++i) {
      const double u = (2.0 * static_cast<double>(i - flight.first) + 1.0) / size - 1.0;
      const double bow = of_weight * (u * u - (1.0 - 1.0 / (size * size)) / 3.0); // has no mean
      part[0] += bow * force[i];
      part[1] += bow * bow;
    }
    parts.push_back(part);
    sums[0] += part[0];
    sums[1] += part[1];
  }
  const double bow = sums[0] / sums[1];
  double squares = 0.0;
  for (const auto &[product, square] : parts)
    squares += std::pow(product - bow * square, 2);
  constexpr double most = 0.5, errors = 2.0;
  return bow + errors * std::sqrt(squares) / sums[1] < most;
}

} // namespace

std::optional<FlightFit> flights_of(const Record &record, double ratio) {
  if (record.a_drum.empty() || !record.omega || !record.Fw || !record.m2 || !record.m3) return std::nullopt;
  constexpr double usual_gravity = 9.81;
  const double weight = (*record.m2 + *record.m3) * record.g.value_or(usual_gravity);
  const double middle = 0.5 * (record.time.front() + record.time.back());
  Forces forces;
  forces.Fw = *record.Fw;
  for (std::size_t i = 0; i < record.size(); ++i) {
    forces.without.push_back(weight + *record.m2 * record.a_drum[i] +
                             (record.a_frame.empty() ? 0.0 : *record.m3 * record.a_frame[i]));
    forces.time.push_back(record.time[i] - middle);
    forces.share.push_back(record.force_share(i));
    forces.wander.push_back(record.wander.empty() ? 0.0 : record.wander[i]);
  }
  const double per_cycle = record.period() / record.interval;
  constexpr double shortest = 0.05, longest = 3.0; // cycles
  const auto least = std::max<std::size_t>(5, static_cast<std::size_t>(shortest * per_cycle));
  const double noise = noise_level(forces.without);
  if (record.two_sided() && !forbid_moments(record, forces)) return std::nullopt;
  constexpr double narrow = 0.001;                        // of Fw
  const double wide = record.logger_filter ? 0.06 : 0.03; // a filter makes landings swing
  const double widest = wide * forces.Fw + 4.0 * noise;
  double width = widest;
  Exciter exciter = best_phase(forces, *record.omega, ratio, width, least);
  FlightFit fit;
  std::vector<double> force = all_forces(forces, exciter);
  // The flights anew with a narrower band each time, as wide as the force that is left in them.
  std::vector<Flight> flights;
  constexpr int rounds = 12;
  for (int round = 0; round < rounds; ++round) {
    flights = runs_of(force, least, [width](double f) { return std::fabs(f) <= width; });
    const auto too_long = [per_cycle](const Flight &flight) {
      return static_cast<double>(flight.size()) > longest * per_cycle;
    };
    flights.erase(std::remove_if(flights.begin(), flights.end(), too_long), flights.end());
    constexpr double rarest = 0.3; // flights in a cycle
    if (static_cast<double>(flights.size()) < std::max(6.0, rarest * record.cycles())) return std::nullopt;
    for (Flight &flight : flights) { // a contact may have begun or ended between two samples
      ++flight.first;
      --flight.end;
    }
    fit.left = fit_flights(forces, flights, exciter, fit);
    fit.share = static_cast<double>(samples_of(flights)) / static_cast<double>(record.size());
    force = all_forces(forces, exciter);
    width = std::clamp(4.0 * fit.left, narrow * forces.Fw, widest);
  }
  // One flight in a cycle at most, after which the soil presses.
  const std::vector<Flight> others = runs_of(force, 2, [width](double f) { return std::fabs(f) > width; });
  std::size_t followed = 0, lands = 0;
  for (const Flight &flight : flights) {
    const auto next = std::find_if(others.begin(), others.end(),
                                   [&flight](const Flight &other) { return other.first >= flight.end; });
    if (next == others.end()) continue;
    ++followed;
    lands += force[next->first] > 0.0 ? 1 : 0;
  }
  constexpr double most_often = 1.1, most_of_them = 0.9, most_share = 0.93, most_off = 0.6;
  if (!are_flat(flights, force, weight, exciter.omega * record.interval) || fit.share > most_share ||
      std::fabs(fit.ratio.mean - 1.0) > most_off ||
      static_cast<double>(flights.size()) > most_often * record.cycles() + 1.0 ||
      static_cast<double>(lands) < most_of_them * static_cast<double>(followed))
    return std::nullopt;
  fit.phase.mean = std::remainder(fit.phase.mean - fit.omega.mean * middle, 2.0 * pi);
  return fit;
}

namespace {

/// The mean of the first `count` values, which fade in and out (Hann): neither a period of several cycles nor
/// the ends of the window change it much.
double mean_of(const std::vector<double> &values, std::size_t count) {
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i)
    sum +=
        values[i] * (1.0 - std::cos(2.0 * pi * (static_cast<double>(i) + 0.5) / static_cast<double>(count)));
  return sum / static_cast<double>(count);
}

void shift(std::vector<double> &values, double by) {
  for (double &value : values)
    value += by;
}

/// The first of the drum's signals that the record has: its frequency is the exciter's.
const std::vector<double> &drum_signal(const Record &record) {
  return !record.a_drum.empty()   ? record.a_drum
         : !record.v_drum.empty() ? record.v_drum
         : !record.x_drum.empty() ? record.x_drum
                                  : record.F_contact;
}

void take_frequency(Record &record) {
  const std::vector<double> &signal = drum_signal(record);
  if (signal.empty()) return;
  const double said = *record.omega / (2.0 * pi);
  const std::optional<MeanInterval> found = frequency_of(signal, record.interval, *record.omega);
  if (!found)
    csv_fault(record.file, 0, {},
              refusal("the frequency", fmt::format("{:.6g}", said),
                      fmt::format("that of the record to {:g} % [Hz]; the drum's signal has no line there",
                                  100.0 * frequency_range)));
  // The exciter's line is the strongest, but for a second harmonic of a hard landing.
  for (const double factor : {0.5, 2.0, 3.0})
    if (const double other = factor * found->mean; other * record.interval < 0.9 * pi) {
      constexpr double stronger = 2.5; // amplitudes
      if (power_at(signal, record.interval, other) >
          stronger * stronger * power_at(signal, record.interval, found->mean))
        csv_fault(
            record.file, 0, {},
            refusal("the frequency", fmt::format("{:.6g}", said),
                    fmt::format("that of the strongest line [Hz]; at {:.6g} Hz there is a far stronger one",
                                other / (2.0 * pi))));
    }
  record.omega = found->mean;
  record.notes.push_back(fmt::format("the record has {:.8g} +- {:.2g} Hz, {:.6g} Hz was said",
                                     found->mean / (2.0 * pi), found->half_width / (2.0 * pi), said));
}

/// Accelerations have no mean over many cycles; what there is belongs to the sensor.
void remove_offset(Record &record, std::vector<double> Record::*values, const char *name) {
  if ((record.*values).empty()) return;
  const auto cycles = std::floor(record.cycles() + 1e-6);
  const auto count =
      std::min(record.size(), static_cast<std::size_t>(cycles * record.period() / record.interval));
  const double mean = mean_of(record.*values, count);
  shift(record.*values, -mean);
  constexpr double told = 0.1; // m/s2
  if (std::fabs(mean) < told) return;
  constexpr double gravity = 9.80665;
  const bool of_gravity = std::fabs(std::fabs(mean) - gravity) < 0.1 * gravity;
  record.notes.push_back(fmt::format("{} has a mean of {:.4g} m/s2, which is removed{}", name, mean,
                                     of_gravity ? ": the sensor shows gravity" : ""));
}

/// Times at which a signal rises through the middle of its range, between samples; it has to fall below a
/// quarter of the range before the next one [s].
std::vector<double> rises_of(const Record &record) {
  const auto [least, most] = std::minmax_element(record.pulse.begin(), record.pulse.end());
  if (*least == *most)
    csv_fault(record.file, 0, {}, refusal("pulse", *least, "a signal that rises once in each revolution"));
  const double middle = 0.5 * (*least + *most), low = *least + 0.25 * (*most - *least);
  std::vector<double> times;
  bool armed = false;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (record.pulse[i] <= low) armed = true;
    if (!armed || record.pulse[i] < middle || i == 0) continue;
    armed = false;
    const double before = record.pulse[i - 1], share = (middle - before) / (record.pulse[i] - before);
    times.push_back(record.time[i - 1] + std::clamp(share, 0.0, 1.0) * record.interval);
  }
  return times;
}

/// Whether most edges have no sample on their slope, so that their place between two samples is not known.
bool edges_are_sharp(const Record &record) {
  const auto [least, most] = std::minmax_element(record.pulse.begin(), record.pulse.end());
  const double low = *least + 0.1 * (*most - *least), high = *most - 0.1 * (*most - *least);
  const auto between = std::count_if(record.pulse.begin(), record.pulse.end(),
                                     [low, high](double value) { return value > low && value < high; });
  return static_cast<double>(between) < record.cycles();
}

/// The angle of the drum's motion at the record's frequency, without a constant, at some times, from four
/// cycles around each [rad].
std::vector<double> drum_angles(const Record &record, const std::vector<double> &times) {
  const std::vector<double> &signal = drum_signal(record);
  const double half = 2.0 * record.period();
  std::vector<double> angles; // minus omega t, one a cycle
  double middle = record.time.front() + half;
  for (; middle + half <= record.time.back() + record.interval || angles.size() < 2;
       middle += record.period()) {
    const auto first = static_cast<std::size_t>((middle - half - record.time.front()) / record.interval);
    std::complex<double> sum;
    for (std::size_t i = first; i < record.size() && record.time[i] < middle + half; ++i)
      sum += signal[i] * std::polar(1.0 + std::cos(pi * (record.time[i] - middle) / half),
                                    -*record.omega * record.time[i]);
    const double before = angles.empty() ? 0.0 : angles.back();
    angles.push_back(before + std::remainder(std::arg(sum) - before, 2.0 * pi));
  }
  std::vector<double> result;
  for (const double time : times) { // the first and last two cycles as those beside them
    const double at = (time - record.time.front() - half) / record.period();
    const auto before =
        static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(angles.size()) - 1.5));
    const double share = at - static_cast<double>(before);
    result.push_back(*record.omega * time + (1.0 - share) * angles[before] + share * angles[before + 1]);
  }
  return result;
}

/// Takes frequency and phase from pulses, and how the angle wanders about a constant frequency. Pulses stand
/// at one angle of the drum's motion, to as much as most of them scatter; others are none.
void take_pulses(Record &record, const RecordOptions &options) {
  const std::vector<double> rises = rises_of(record), of_drum = drum_angles(record, rises);
  const double period = record.period();
  constexpr double close = 20.0 * degree, of_normal = 1.4826;
  double center = 0.0;
  std::vector<double> most;
  for (const double angle : of_drum) {
    std::vector<double> near;
    for (const double other : of_drum)
      if (const double off = std::remainder(other - angle, 2.0 * pi); std::fabs(off) < close)
        near.push_back(off);
    if (near.size() <= most.size()) continue;
    const double middle = median(near);
    center = angle + middle;
    for (double &off : near)
      off = std::fabs(off - middle);
    most = near;
  }
  const double farthest = most.empty() ? 0.0 : std::max(3.0 * degree, 5.0 * of_normal * median(most));
  std::vector<double> times, angles, angles_of_drum;
  std::size_t doubled = 0;
  double turns = -1.0;
  for (std::size_t i = 0; i < rises.size(); ++i) {
    const double turn = std::round((of_drum[i] - center) / (2.0 * pi));
    if (std::fabs(of_drum[i] - center - 2.0 * pi * turn) > farthest || (!times.empty() && turn <= turns)) {
      ++doubled;
      continue;
    }
    turns = turn;
    times.push_back(rises[i]);
    angles.push_back(2.0 * pi * turn + options.pulse_angle);
    angles_of_drum.push_back(of_drum[i]);
  }
  const std::size_t missing =
      times.empty() ? 0
                    : static_cast<std::size_t>(std::lround((angles.back() - angles.front()) / (2.0 * pi))) +
                          1 - times.size();
  constexpr double most_missing = 0.5;
  const double expected = std::floor(record.cycles());
  if (static_cast<double>(times.size()) < std::max(4.0, most_missing * expected) ||
      static_cast<double>(doubled) > most_missing * static_cast<double>(times.size()))
    csv_fault(record.file, 0, {},
              refusal("the number of pulses", fmt::format("{}", rises.size()),
                      fmt::format("one per revolution, about {:.0f} at {:.6g} Hz", expected, 1.0 / period)));
  // The mean line through all, and what is left of it, as the mean of neighbours.
  const LineFit line = fit_line(times, angles);
  const double off = line.slope.mean / *record.omega - 1.0;
  if (std::fabs(off) > frequency_range)
    csv_fault(record.file, 0, {},
              refusal("the frequency", fmt::format("{:.6g}", 1.0 / period),
                      fmt::format("that of the pulses to {:g} % [Hz]; they have {:.6g} Hz",
                                  100.0 * frequency_range, line.slope.mean / (2.0 * pi))));
  std::vector<double> left(times.size());
  for (std::size_t i = 0; i < times.size(); ++i)
    left[i] = angles[i] - line.intercept.mean - line.slope.mean * times[i];
  std::vector<double> steps; // from pulse to pulse: sampling and noise of the pulses alone
  for (std::size_t i = 2; i < left.size(); ++i)
    steps.push_back(std::fabs(left[i] - 2.0 * left[i - 1] + left[i - 2]));
  constexpr double of_median = 0.6744897501960817 * 2.449489742783178; // of a second difference
  const double scatter = steps.empty() ? 0.0 : median(steps) / of_median;
  const double wanders = rms(left);
  record.omega = line.slope.mean;
  record.phase = std::remainder(line.intercept.mean, 2.0 * pi);
  // An edge between two samples is known to their distance: an error which comes back where a revolution
  // takes nearly a whole number of samples, and which stays where all edges stand at one place between them.
  std::size_t crossings = 1;
  for (std::size_t i = 1; i < left.size(); ++i)
    crossings += (left[i] > 0.0) != (left[i - 1] > 0.0) ? 1 : 0;
  const double uneven = edges_are_sharp(record)
                            ? std::max(0.0, 0.5 * *record.omega * record.interval - std::sqrt(3.0) * wanders)
                            : 0.0;
  // Where on its slope an edge counts is known to some 2 % of the time between samples.
  const double edge = std::hypot(0.02 * *record.omega * record.interval, uneven);
  record.phase_within = std::hypot(2.0 * wanders / std::sqrt(static_cast<double>(crossings)), edge);
  constexpr double told = 0.3 * degree;
  // The drum's motion follows an angle that wanders.
  const LineFit motion = fit_line(times, angles_of_drum);
  std::vector<double> of_motion(times.size());
  for (std::size_t i = 0; i < times.size(); ++i)
    of_motion[i] = angles_of_drum[i] - motion.intercept.mean - motion.slope.mean * times[i];
  const bool drifts =
      wanders > std::max(told, 2.0 * scatter) && times.size() > 8 && rms(of_motion) > 0.5 * wanders;
  if (drifts) {
    constexpr double neighbours = 8.0; // pulses to either side, with less weight the farther they are
    record.phase_within = std::hypot(2.0 * scatter / std::sqrt(neighbours), edge);
    std::size_t first = 0;
    for (std::size_t i = 0; i < record.size(); ++i) {
      const double t = record.time[i], reach = neighbours * period;
      while (first + 1 < times.size() && times[first] < t - 2.0 * reach)
        ++first;
      Eigen::Matrix3d square = 1e-9 * Eigen::Matrix3d::Identity();
      Eigen::Vector3d right = Eigen::Vector3d::Zero();
      const std::size_t begin = std::min(first, times.size() - std::min<std::size_t>(4, times.size()));
      for (std::size_t n = begin; n < times.size() && (times[n] < t + 2.0 * reach || n < begin + 4); ++n) {
        const double u = (times[n] - t) / reach, weight = std::exp(-u * u);
        const Eigen::Vector3d row(1.0, u, u * u);
        square += weight * row * row.transpose();
        right += weight * left[n] * row;
      }
      record.wander.push_back(SymmetricSystem(square).solution(right)[0]);
    }
  }
  record.notes.push_back(fmt::format(
      "{} pulses, {} missing, {} too many, give {:.8g} +- {:.2g} Hz and a phase of {:.3f} +- {:.2g} "
      "degrees{}",
      rises.size(), missing, doubled, line.slope.mean / (2.0 * pi), line.slope.half_width / (2.0 * pi),
      *record.phase / degree, record.phase_within / degree,
      drifts ? fmt::format("; the angle wanders by {:.3g} degrees (RMS), which is followed", wanders / degree)
             : std::string()));
}

void turn(std::vector<double> &values) {
  for (double &value : values)
    value = -value;
}

[[noreturn]] void refuse_sign(const Record &record, const std::string &columns, const char *why) {
  csv_fault(record.file, 0, {},
            refusal("the sign of " + columns, "as given",
                    fmt::format("the other one, with which {}: a '-' before the unit of --column", why)));
}

/// Refuses accelerations whose sign is turned: of one end of the drum, with which the frame does not move as
/// the bond makes it; of the drum, whose exciter would take energy from it; of the frame, whose bond would
/// have a negative stiffness.
void check_signs(const Record &record) {
  const auto wave = [&record](const std::vector<double> &values) { // at the exciter's frequency
    std::complex<double> sum;
    for (std::size_t i = 0; i < values.size(); ++i)
      sum += values[i] *
             std::polar(1.0 - std::cos(2.0 * pi * (static_cast<double>(i) + 0.5) /
                                       static_cast<double>(values.size())),
                        -*record.omega * record.time[i] - (record.wander.empty() ? 0.0 : record.wander[i]));
    return sum / static_cast<double>(values.size());
  };
  if (record.a_drum.empty() || record.low_pass > 0.0) return;
  const bool has_frame = !record.a_frame.empty() && !record.frame_computed && record.m3;
  std::complex<double> drum = wave(record.a_drum), frame = has_frame ? wave(record.a_frame) : 0.0;
  // Stiffness and damping of a bond through which the drum moves the frame so: m3 omega^2 r / (r - 1), where
  // r is the frame's motion over that of the drum.
  const auto bond = [&](const std::complex<double> &of_drum) {
    return *record.m3 * *record.omega * *record.omega * frame / (frame - of_drum);
  };
  constexpr double seen = 5.0, clear = 0.14, different = 0.7, same = 0.4; // errors; sines; logarithms
  const double error =
      has_frame ? noise_level(record.a_frame) / std::sqrt(static_cast<double>(record.size())) : 0.0;
  const bool frame_moves =
      has_frame && std::abs(frame) > seen * error && std::abs(frame) > 0.01 * std::abs(drum);
  bool one_end = false;
  if (record.two_sided() && frame_moves && record.bond) {
    const std::complex<double> known(record.bond->stiffness, *record.omega * record.bond->damping);
    const auto off = [&](const std::complex<double> &of_drum) {
      return std::abs(std::log(bond(of_drum) / known));
    };
    const std::complex<double> apart = 0.5 * (wave(record.a_right) - wave(record.a_left));
    one_end = off(drum) > different && off(-drum) > different && std::min(off(apart), off(-apart)) < same;
    if (one_end) drum = apart;
  }
  const auto frame_turned = [&](const std::complex<double> &of_drum) {
    return frame_moves && bond(of_drum).real() < 0.0 && bond(-of_drum).real() > 0.0;
  };
  double side = frame_turned(drum) && one_end ? -1.0 : 1.0; // of the drum
  if (record.phase) {
    const double taken = (drum * std::polar(1.0, -*record.phase)).real() / std::abs(drum);
    if (std::fabs(taken) > clear) side = taken > 0.0 ? -1.0 : 1.0;
    if (side < 0.0 && !one_end && !frame_turned(drum)) { // flights tell whether it is the phase
      Record other = record;
      turn(other.a_drum);
      turn(other.a_frame);
      const std::optional<FlightFit> given = flights_of(record), turned = flights_of(other);
      if (given && (!turned || given->left < turned->left)) side = 1.0;
    }
  } else if (frame_turned(drum) && !one_end) { // flights tell which of both it is
    Record of_frame = record, of_drum = record;
    turn(of_frame.a_frame);
    turn(of_drum.a_drum);
    const std::optional<FlightFit> with_frame = flights_of(of_frame), with_drum = flights_of(of_drum);
    if (!with_frame && !with_drum)
      refuse_sign(record, "a_frame or a_drum", "the bond moves the frame with the drum");
    if (!with_frame || (with_drum && with_drum->left < with_frame->left)) side = -1.0;
  }
  std::string columns;
  if (one_end)
    columns = side > 0.0 ? "a_left" : "a_right";
  else if (side < 0.0)
    columns = record.two_sided() ? "a_left and a_right" : "a_drum";
  if (frame_turned(side * drum)) columns += (columns.empty() ? "" : " and ") + std::string("a_frame");
  if (!columns.empty())
    refuse_sign(record, columns,
                side < 0.0 && !one_end
                    ? "the exciter drives the drum (unless the phase is off by half a turn)"
                    : "the bond moves the frame with the drum");
}

/// Refuses accelerations of drum and frame with which the drum does not fly, if it does with both turned.
void check_turned(Record record) {
  if (record.two_sided()) return; // whose phase has to be known
  turn(record.a_drum);
  turn(record.a_frame);
  if (flights_of(record))
    refuse_sign(record, record.frame_computed || record.a_frame.empty() ? "a_drum" : "a_drum and a_frame",
                "the drum flies");
}

/// The refusal of an exciter's force that is `ratio` times smaller than that with which the drum flies.
std::string force_fault(const Record &record, double ratio) {
  return refusal("the exciter's force", fmt::format("{:.6g} N", *record.Fw),
                 fmt::format("within {:g} % of {:.4g} N, with which no force would act on the drum while it "
                             "flies; to be checked: eccentric moment or force, masses of drum and frame, "
                             "signs and units",
                             100.0 * machine_agreement, ratio * *record.Fw));
}

/// Doubts a force of the exciter with which the drum does not fly, if it seems to with another one.
void check_force(Record &record) {
  constexpr double near = 10.0 * degree; // the known phase
  for (const double ratio : {0.9, 1.1, 0.8, 1.2, 0.7, 1.35, 0.6, 1.5}) {
    const std::optional<FlightFit> fit = flights_of(record, ratio);
    if (!fit || std::fabs(fit->ratio.mean - 1.0) < machine_agreement) continue;
    if (record.phase && std::fabs(std::remainder(fit->phase.mean - *record.phase, 2.0 * pi)) > near) continue;
    record.doubt = force_fault(record, fit->ratio.mean);
    return;
  }
}

/// By how much the phase of the drum's motion wanders over the record (RMS) [degrees]; 0 if it is too short.
double wander_of(const Record &record) {
  const std::vector<double> &signal = drum_signal(record);
  constexpr std::size_t windows = 12;
  const double cycles = std::floor(record.cycles() / windows);
  if (!record.pulse.empty() || signal.empty() || cycles < 2.0) return 0.0;
  const auto length = static_cast<std::size_t>(cycles * record.period() / record.interval);
  std::vector<double> times, phases;
  for (std::size_t w = 0; w < windows; ++w) {
    std::complex<double> sum;
    for (std::size_t i = w * length; i < (w + 1) * length; ++i)
      sum += signal[i] * std::polar(1.0, -*record.omega * record.time[i]);
    const double before = phases.empty() ? 0.0 : phases.back();
    phases.push_back(before + std::remainder(std::arg(sum) - before, 2.0 * pi));
    times.push_back(record.time[w * length]);
  }
  const LineFit line = fit_line(times, phases);
  double squares = 0.0;
  for (std::size_t w = 0; w < windows; ++w)
    squares += std::pow(phases[w] - line.intercept.mean - line.slope.mean * times[w], 2);
  return std::sqrt(squares / static_cast<double>(windows)) / degree;
}

} // namespace

namespace {

/// The refusal of a record whose phase wanders by so many degrees; empty if it may be taken.
std::string drift_fault(double wander) {
  constexpr double most = 6.0; // degrees
  if (wander <= most) return {};
  return refusal(
      "the phase of the drum's motion", fmt::format("wandering by {:.3g} degrees over the record", wander),
      fmt::format("up to {:g} degrees where no flights of the drum tell one phase of the exciter; a shorter "
                  "part of the record may have one frequency, and pulses once per revolution (--column "
                  "pulse) follow one that drifts",
                  most));
}

} // namespace

void refuse_drift(const Record &record) {
  if (const std::string fault = drift_fault(wander_of(record)); !fault.empty())
    csv_fault(record.file, 0, {}, fault);
}

void refuse_doubtful(const Record &record) {
  if (!record.doubt.empty()) csv_fault(record.file, 0, {}, record.doubt);
}

namespace {

/// Doubts a frequency that varies so much that a given phase may not describe the record.
void check_drift(Record &record) {
  if (!record.phase) return;   // the whole motion may tell it
  constexpr double told = 0.3; // degrees
  const double wander = wander_of(record);
  if (record.doubt.empty()) record.doubt = drift_fault(wander);
  if (wander > told) {
    record.phase_within = 2.0 * wander * degree;
    record.notes.push_back(fmt::format("the phase of the drum's motion wanders by {:.2g} degrees over the "
                                       "record; that of the exciter counts as known to {:.2g} degrees",
                                       wander, 2.0 * wander));
  }
}

/// Restores what the logger's filter has taken; std::runtime_error if it has taken too much.
void undo_logger_filter(Record &record, const LoggerFilter &filter) {
  constexpr double harmonics = 3.0;
  const double needed = harmonics * *record.omega / (2.0 * pi),
               whole = restored_up_to(filter, record.interval);
  if (whole < needed)
    csv_fault(record.file, 0, {},
              refusal("the logger's filter", fmt::format("{:g} Hz of order {}", filter.corner, filter.order),
                      fmt::format("one that lets the record be restored up to {:.4g} Hz, three times the "
                                  "frequency; here it is {:.4g} Hz",
                                  needed, whole)));
  record.logger_filter = filter;
  record.logged_drum = record.a_drum;
  record.logged_frame = record.a_frame;
  for (const auto values :
       {&Record::x_drum, &Record::v_drum, &Record::a_drum, &Record::x_frame, &Record::v_frame,
        &Record::a_frame, &Record::F_contact, &Record::a_left, &Record::a_right})
    record.*values = restored(record.*values, record.interval, filter);
  record.notes.push_back(
      fmt::format("what the logger's filter has taken is given back up to {:.4g} Hz", whole));
}

void take_flights(Record &record, const RecordOptions &options) {
  if (record.two_sided() && record.phase) { // the whole motion tells more
    check_drift(record);
    return;
  }
  std::optional<FlightFit> fit = flights_of(record);
  // Behind a filter that smooths too much the motion from contact to contact has to tell the phase.
  if (record.logger_filter && (!fit || std::fabs(fit->ratio.mean - 1.0) > machine_agreement)) {
    check_drift(record);
    return;
  }
  if (fit && options.me_re) { // the force that belongs to the frequency of the flights
    record.omega = fit->omega.mean;
    record.Fw = *options.me_re * *record.omega * *record.omega;
    fit = flights_of(record);
  }
  if (!fit) {
    if (!record.phase) check_turned(record);
    check_force(record);
    check_drift(record);
    return;
  }
  if (std::fabs(fit->ratio.mean - 1.0) > machine_agreement + fit->ratio.half_width) {
    record.doubt = force_fault(record, fit->ratio.mean);
    check_drift(record);
    return;
  }
  const std::optional<double> said = record.phase;
  record.notes.push_back(fmt::format(
      "{} flights, {:.1f} % of the time, give {:.8g} +- {:.2g} Hz, a phase of {:.3f} +- {:.2g} degrees and "
      "an exciter's force {:.4f} +- {:.2g} times that given",
      fit->flights, 100.0 * fit->share, fit->omega.mean / (2.0 * pi), fit->omega.half_width / (2.0 * pi),
      fit->phase.mean / degree, fit->phase.half_width / degree, fit->ratio.mean, fit->ratio.half_width));
  if (said) {
    constexpr double most = 20.0; // degrees
    const double off = std::remainder(fit->phase.mean - *said, 2.0 * pi) / degree;
    if (std::fabs(off) > most + fit->phase.half_width / degree)
      csv_fault(record.file, 0, {},
                refusal("the phase", fmt::format("{:.4g} degrees", *said / degree),
                        fmt::format("{:.4g} +- {:.2g} degrees, as the flights of the drum tell, or no phase",
                                    fit->phase.mean / degree, fit->phase.half_width / degree)));
  }
  record.omega = fit->omega.mean;
  record.phase = fit->phase.mean;
  record.phase_half_width = fit->phase.half_width;
}

} // namespace

std::array<std::vector<double>, 2> through_bond(const Record &record,
                                                const std::array<std::vector<double>, 2> &foot,
                                                const Eigen::Matrix2d &spring,
                                                const Eigen::Matrix2d &dashpot) {
  // The extension of the bond without its static part, and its rate. The foot's acceleration is linear
  // between samples; one step of Runge and Kutta for each.
  struct Extension {
    Eigen::Vector2d w, rate;
  };
  const auto rate = [&spring, &dashpot](const Extension &e, const Eigen::Vector2d &a) {
    return Extension{e.rate, a - spring * e.w - dashpot * e.rate};
  };
  const auto moved = [](const Extension &e, const Extension &by, double h) {
    return Extension{e.w + h * by.w, e.rate + h * by.rate};
  };
  const double h = record.interval;
  const auto step = [&](const Extension &e, const Eigen::Vector2d &from, const Eigen::Vector2d &to) {
    const Eigen::Vector2d middle = 0.5 * (from + to);
    const Extension k1 = rate(e, from), k2 = rate(moved(e, k1, 0.5 * h), middle),
                    k3 = rate(moved(e, k2, 0.5 * h), middle), k4 = rate(moved(e, k3, h), to);
    return Extension{e.w + h / 6.0 * (k1.w + 2.0 * k2.w + 2.0 * k3.w + k4.w),
                     e.rate + h / 6.0 * (k1.rate + 2.0 * k2.rate + 2.0 * k3.rate + k4.rate)};
  };
  const auto at = [&foot](std::size_t i) {
    return Eigen::Vector2d(foot[0][i], foot[1].empty() ? 0.0 : foot[1][i]);
  };
  // The first cycles several times, after which it moves as if it had always done so.
  constexpr double pairs = 30.0;
  constexpr int repeats = 8;
  const double cycles = 2.0 * std::min(pairs, std::floor(0.5 * record.cycles()));
  const auto first =
      std::min(record.size() - 1, static_cast<std::size_t>(std::lround(cycles * record.period() / h)));
  Extension e{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  for (int n = 0; n < repeats; ++n)
    for (std::size_t i = 0; i < first; ++i)
      e = step(e, at(i), at(i + 1));
  std::array<std::vector<double>, 2> mass;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const Eigen::Vector2d a = spring * e.w + dashpot * e.rate;
    for (std::size_t part = 0; part < mass.size(); ++part)
      mass[part].push_back(a[static_cast<Eigen::Index>(part)]);
    if (i + 1 < record.size()) e = step(e, at(i), at(i + 1));
  }
  return mass;
}

void compute_frame(Record &record) {
  if (record.pieces.empty() || record.a_drum.empty() || !record.a_frame.empty() || !record.omega ||
      !record.m3 || !record.bond)
    return;
  Eigen::Matrix2d spring = Eigen::Matrix2d::Zero(), dashpot = Eigen::Matrix2d::Zero();
  spring(0, 0) = record.bond->stiffness / *record.m3;
  dashpot(0, 0) = record.bond->damping / *record.m3;
  record.a_frame = through_bond(record, {record.a_drum, {}}, spring, dashpot)[0];
  record.frame_computed = true;
  record.notes.push_back(
      fmt::format("no acceleration of the frame: it is computed from that of the drum through the bond of "
                  "{:.4g} MN/m and {:.4g} kN s/m, known to {:.2g} %",
                  record.bond->stiffness / 1e6, record.bond->damping / 1e3, 100.0 * record.bond->tolerance));
}

void settle_excitation(Record &record, const RecordOptions &options) {
  check_sensors(record);
  if (record.excitation_read) compute_frame(record);
  if (record.time.empty() || !options.omega || record.excitation_read || record.pieces.empty()) return;
  if (record.pulse.empty())
    take_frequency(record);
  else
    take_pulses(record, options);
  if (options.logger_filter) undo_logger_filter(record, *options.logger_filter);
  if (options.corner)
    for (std::vector<double> *values : {&record.a_drum, &record.a_frame, &record.logged_drum,
                                        &record.logged_frame, &record.a_left, &record.a_right})
      if (!values->empty())
        *values = without_high_pass(*values, record.interval, *options.corner, *record.omega);
  remove_offset(record, &Record::a_drum, "a_drum");
  remove_offset(record, &Record::a_frame, "a_frame");
  remove_offset(record, &Record::a_left, "a_left");
  remove_offset(record, &Record::a_right, "a_right");
  compute_frame(record);
  if (options.me_re) record.Fw = *options.me_re * *record.omega * *record.omega;
  check_signs(record);
  take_flights(record, options);
  compute_excitation(record);
}

} // namespace drumlin::post
