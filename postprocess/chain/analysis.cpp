#include "chain/analysis.h"

#include "support/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

namespace drumlin::post {

namespace {

/// Row r with time[r] <= t < time[r + 1], clamped to the first and last interval.
std::size_t interval_of(const std::vector<double> &time, double t) {
  const auto upper = std::upper_bound(time.begin(), time.end(), t);
  const auto index = static_cast<std::size_t>(std::distance(time.begin(), upper));
  return std::clamp<std::size_t>(index, 1, time.size() - 1) - 1;
}

/// Cubic Hermite value between rows r and r + 1.
double hermite(const std::vector<double> &time, const std::vector<double> &value,
               const std::vector<double> &slope, std::size_t r, double t) {
  const double h = time[r + 1] - time[r];
  if (h <= 0.0) return value[r];
  const double s = (t - time[r]) / h;
  const double s2 = s * s;
  const double s3 = s2 * s;
  return value[r] * (2 * s3 - 3 * s2 + 1) + value[r + 1] * (3 * s2 - 2 * s3) +
         h * (slope[r] * (s3 - 2 * s2 + s) + slope[r + 1] * (s3 - s2));
}

double linear(const std::vector<double> &time, const std::vector<double> &value, std::size_t r, double t) {
  const double h = time[r + 1] - time[r];
  if (h <= 0.0) return value[r];
  const double s = (t - time[r]) / h;
  return value[r] + s * (value[r + 1] - value[r]);
}

double change(const std::vector<double> &column) { return column.back() - column.front(); }

void include(Extremes &extremes, double value) {
  extremes.min = std::min(extremes.min, value);
  extremes.max = std::max(extremes.max, value);
}

Extremes nothing_yet() {
  return {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
}

/// Integrals of (a0 + a1 (t - t0)) cos(w t) and sin(w t) from t0 to t1.
std::array<double, 2> segment_integrals(double t0, double t1, double v0, double v1, double w) {
  const double h = t1 - t0;
  const double slope = (v1 - v0) / h;
  const double c0 = std::cos(w * t0);
  const double s0 = std::sin(w * t0);
  const double c1 = std::cos(w * t1);
  const double s1 = std::sin(w * t1);
  return {(v1 * s1 - v0 * s0) / w + slope * (c1 - c0) / (w * w),
          (-v1 * c1 + v0 * c0) / w + slope * (s1 - s0) / (w * w)};
}

} // namespace

int complete_cycles(double last_time, double period) {
  const double cycles = std::floor(last_time / period + 1.0e-6);
  return static_cast<int>(std::clamp(cycles, 0.0, 1.0e9)); // else it would not fit into an int
}

TimeWindow last_cycles_window(int complete, int count, double period) {
  const int first = std::max(0, complete - count);
  return {first * period, complete * period};
}

double relative_rms(const std::vector<double> &values, const std::vector<double> &reference,
                    std::size_t first, std::size_t last) {
  double difference = 0.0;
  double norm = 0.0;
  for (std::size_t i = first; i < last; ++i) {
    const double d = values[i] - reference[i];
    difference += d * d;
    norm += reference[i] * reference[i];
  }
  return first < last && norm > 0.0 ? std::sqrt(difference / norm) : not_a_number;
}

std::vector<ContactEvent> events_in(const std::vector<ContactEvent> &events, TimeWindow window) {
  std::vector<ContactEvent> inside;
  std::copy_if(
      events.begin(), events.end(), std::back_inserter(inside),
      [&window](const ContactEvent &event) { return event.time >= window.begin && event.time < window.end; });
  return inside;
}

double contact_share(const std::vector<ContactEvent> &events, TimeWindow window, bool initially) {
  if (window.end <= window.begin) return not_a_number;
  // The state at the start of the window.
  bool touching = initially;
  bool known = false;
  for (const ContactEvent &event : events) {
    if (event.time <= window.begin) {
      touching = event.make;
      known = true;
    } else {
      if (!known) touching = !event.make;
      break;
    }
  }
  double since = window.begin;
  double total = 0.0;
  for (const ContactEvent &event : events) {
    if (event.time <= window.begin || event.time >= window.end) continue;
    if (touching) total += event.time - since;
    touching = event.make;
    since = event.time;
  }
  if (touching) total += window.end - since;
  return total / (window.end - window.begin);
}

HarmonicAmplitudes harmonic_amplitudes(const std::vector<double> &time, const std::vector<double> &value,
                                       double omega, TimeWindow window) {
  const std::array<double, 3> order{1.0, 2.0, 0.5};
  std::array<double, 3> cosine{};
  std::array<double, 3> sine{};
  for (std::size_t i = 0; i + 1 < time.size(); ++i) {
    const double t0 = std::max(time[i], window.begin);
    const double t1 = std::min(time[i + 1], window.end);
    if (t1 <= t0) continue;
    const double v0 = linear(time, value, i, t0);
    const double v1 = linear(time, value, i, t1);
    for (std::size_t n = 0; n < order.size(); ++n) {
      const auto [c, s] = segment_integrals(t0, t1, v0, v1, order[n] * omega);
      cosine[n] += c;
      sine[n] += s;
    }
  }
  const double factor = 2.0 / (window.end - window.begin);
  const auto amplitude = [&](std::size_t n) { return factor * std::hypot(cosine[n], sine[n]); };
  return {amplitude(0), amplitude(1), amplitude(2)};
}

CycleHarmonics cycle_harmonics(const CycleColumns &cycles) {
  CycleHarmonics harmonics;
  for (const char *name : {"a1_cos", "a1_sin", "a2_cos", "a2_sin", "ah_cos", "ah_sin"})
    if (!cycles.has(name)) return harmonics;
  const auto take = [&cycles](const char *cosine, const char *sine) {
    std::vector<std::complex<double>> values;
    for (std::size_t i = 0; i < cycles.rows; ++i)
      values.emplace_back(cycles.at(cosine)[i], -cycles.at(sine)[i]);
    return values;
  };
  harmonics.fundamental = take("a1_cos", "a1_sin");
  harmonics.second = take("a2_cos", "a2_sin");
  harmonics.half = take("ah_cos", "ah_sin");
  return harmonics;
}

std::optional<HarmonicAmplitudes> harmonic_amplitudes(const CycleColumns &cycles, std::size_t count) {
  const CycleHarmonics harmonics = cycle_harmonics(cycles);
  count = std::min(count, harmonics.fundamental.size()) / 2 * 2;
  if (count == 0) return std::nullopt;
  const std::size_t first = cycles.rows - count;
  return HarmonicAmplitudes{amplitude_over(harmonics.fundamental, first, count),
                            amplitude_over(harmonics.second, first, count),
                            amplitude_over(harmonics.half, first, count)};
}

EventAcceleration acceleration_at(const ContactEvent &event, const ChainHistory &history,
                                  const ChainParameters &parameters) {
  const ChainParameters &p = parameters;
  const double force_before = event.make ? 0.0 : event.force;
  const double force_after = event.make ? event.force : 0.0;
  const std::size_t r = interval_of(history.time, event.time);
  double rest = 0.0;
  if (history.has_frame()) {
    const double x2 = -event.overlap;
    const double v2 = -event.overlap_rate;
    const double x3 = hermite(history.time, history.x_frame, history.v_frame, r, event.time);
    const double v3 = hermite(history.time, history.v_frame, history.a_frame, r, event.time);
    rest = -p.m2 * p.g + p.c23 * (v3 - v2) + p.k23 * (x3 - x2) - p.Fw * std::sin(p.omega * event.time);
  } else {
    const auto at_row = [&](std::size_t i) { return p.m2 * history.a_drum[i] - history.F_contact[i]; };
    const double h = history.time[r + 1] - history.time[r];
    const double s = h > 0.0 ? (event.time - history.time[r]) / h : 0.0;
    rest = at_row(r) + s * (at_row(r + 1) - at_row(r));
  }
  return {(rest + force_before) / p.m2, (rest + force_after) / p.m2};
}

EventSeries with_events(const ChainHistory &history, const std::vector<ContactEvent> &events,
                        const ChainParameters &parameters, TimeWindow window) {
  EventSeries out;
  const auto row = [&out](double t, double overlap, double velocity, double force, double acceleration,
                          bool event) {
    out.time.push_back(t);
    out.overlap.push_back(overlap);
    out.velocity.push_back(velocity);
    out.force.push_back(force);
    out.acceleration.push_back(acceleration);
    out.event.push_back(event ? 1 : 0);
  };
  if (history.size() < 2) return out;
  // Rows outside of the window by a rounding error belong to it: the time of the row at a cycle's end is
  // rounded.
  const double slack = 1.0e-6 * (window.end - window.begin);
  auto next = events.begin();
  while (next != events.end() && next->time < window.begin)
    ++next;
  // A row at exactly the time of an event is placed before or after the jump, depending on which force is
  // nearer to its own.
  const auto comes_before = [&](std::size_t i) {
    const double jump_from = next->make ? 0.0 : next->force;
    const double jump_to = next->make ? next->force : 0.0;
    return std::abs(history.F_contact[i] - jump_from) <= std::abs(history.F_contact[i] - jump_to);
  };
  const auto put_events_until = [&](std::size_t i) {
    const double t = history.time[i];
    for (; next != events.end() && next->time <= t && next->time < window.end; ++next) {
      if (next->time == t && comes_before(i)) return;
      const EventAcceleration a = acceleration_at(*next, history, parameters);
      const double before = next->make ? 0.0 : next->force;
      const double after = next->make ? next->force : 0.0;
      row(next->time, next->overlap, -next->overlap_rate, before, a.before, true);
      row(next->time, next->overlap, -next->overlap_rate, after, a.after, true);
    }
  };
  for (std::size_t i = 0; i < history.size(); ++i) {
    const double t = history.time[i];
    if (t < window.begin - slack || t > window.end + slack) continue;
    put_events_until(i);
    row(t, -history.x_drum[i], history.v_drum[i], history.F_contact[i], history.a_drum[i], false);
  }
  return out;
}

SteadyExtremes steady_extremes(const ChainHistory &history, const std::vector<ContactEvent> &events,
                               const std::optional<CycleColumns> &cycles, const ChainParameters &parameters,
                               TimeWindow window, std::size_t count) {
  SteadyExtremes out{nothing_yet(), nothing_yet(), false};
  const bool every_step = cycles && cycles->rows > 0 && cycles->has("a_drum_min") &&
                          cycles->has("a_drum_max") && cycles->has("F_contact_min") &&
                          cycles->has("F_contact_max");
  if (every_step) {
    out.every_step = true;
    for (std::size_t i = cycles->rows - std::min(count, cycles->rows); i < cycles->rows; ++i) {
      include(out.acceleration, cycles->at("a_drum_min")[i]);
      include(out.acceleration, cycles->at("a_drum_max")[i]);
      include(out.force, cycles->at("F_contact_min")[i]);
      include(out.force, cycles->at("F_contact_max")[i]);
    }
  }
  const EventSeries series = with_events(history, events, parameters, window);
  for (std::size_t i = 0; i < series.time.size(); ++i) {
    if (every_step && series.event[i] == 0) continue;
    include(out.acceleration, series.acceleration[i]);
    include(out.force, series.force[i]);
  }
  return out;
}

EventMatch match_events(const std::vector<ContactEvent> &run, const std::vector<ContactEvent> &reference) {
  const auto later = [](const std::vector<ContactEvent> &events) {
    std::vector<ContactEvent> out;
    std::copy_if(events.begin(), events.end(), std::back_inserter(out),
                 [](const ContactEvent &event) { return event.time > 0.0; });
    return out;
  };
  const std::vector<ContactEvent> a = later(run);
  const std::vector<ContactEvent> b = later(reference);
  EventMatch match;
  match.run_count = a.size();
  match.reference_count = b.size();
  for (std::size_t i = 0; i < std::min(a.size(), b.size()) && a[i].make == b[i].make; ++i) {
    ++match.matched;
    const double difference = std::abs(a[i].time - b[i].time);
    if (difference > match.largest_difference) {
      match.largest_difference = difference;
      match.at_time = b[i].time;
    }
  }
  return match;
}

double EnergyBalance::energy_error() const {
  return work_excitation - dissipated_contact - dissipated_bond - change_kinetic - change_potential -
         change_stored_contact - change_stored_bond;
}

double EnergyBalance::energy_error_percent() const {
  return 100.0 * energy_error() / std::abs(work_excitation);
}

std::optional<EnergyBalance> energy_balance(const CycleColumns &cycles, std::string &missing) {
  missing.clear();
  for (const char *name : {"work_excitation", "dissipated_contact", "dissipated_bond", "kinetic", "potential",
                           "stored_contact", "stored_bond"})
    if (!cycles.has(name)) missing += (missing.empty() ? "columns " : ", ") + std::string(name);
  if (!missing.empty()) return std::nullopt;
  if (cycles.rows < 2) {
    missing = "a second cycle";
    return std::nullopt;
  }
  EnergyBalance balance;
  balance.first_cycle = 1;
  balance.last_cycle = static_cast<double>(cycles.rows);
  if (cycles.has("cycle")) {
    balance.first_cycle = cycles.at("cycle").front();
    balance.last_cycle = cycles.at("cycle").back();
  }
  balance.work_excitation = change(cycles.at("work_excitation"));
  balance.dissipated_contact = change(cycles.at("dissipated_contact"));
  balance.dissipated_bond = change(cycles.at("dissipated_bond"));
  balance.change_kinetic = change(cycles.at("kinetic"));
  balance.change_potential = change(cycles.at("potential"));
  balance.change_stored_contact = change(cycles.at("stored_contact"));
  balance.change_stored_bond = change(cycles.at("stored_bond"));
  return balance;
}

std::optional<RollerForce> roller_force(const ChainHistory &history, const std::vector<ContactEvent> &events,
                                        const ChainParameters &parameters) {
  constexpr std::size_t reach = 2; // rows on either side
  if (!history.has_frame() || history.size() < 2 * reach + 1) return std::nullopt;
  const ChainParameters &p = parameters;
  const std::vector<double> &t = history.time;
  const std::size_t size = history.size();
  const double h = (t.back() - t.front()) / static_cast<double>(size - 1);
  for (std::size_t i = 0; i < size; ++i)
    if (!(std::abs(t[i] - t.front() - static_cast<double>(i) * h) < 1.0e-3 * h)) return std::nullopt;
  const auto second_difference = [h](const std::vector<double> &x, std::size_t i) {
    return (16.0 * (x[i - 1] + x[i + 1]) - x[i - 2] - x[i + 2] - 30.0 * x[i]) / (12.0 * h * h);
  };
  RollerForce out;
  out.force.assign(size, not_a_number);
  auto next = events.begin();
  for (std::size_t i = 0; i < size; ++i)
    out.largest_force = std::max(out.largest_force, std::abs(history.F_contact[i]));
  for (std::size_t i = reach; i + reach < size; ++i) {
    while (next != events.end() && next->time < t[i - reach] - 1.0e-3 * h)
      ++next;
    bool smooth = next == events.end() || next->time > t[i + reach] + 1.0e-3 * h;
    for (std::size_t j = i - reach; j < i + reach; ++j)
      smooth = smooth && (history.F_contact[j] != 0.0) == (history.F_contact[j + 1] != 0.0);
    if (!smooth) continue;
    const double force = p.m2 * second_difference(history.x_drum, i) +
                         p.m3 * second_difference(history.x_frame, i) + (p.m2 + p.m3) * p.g +
                         history.F_excitation[i];
    out.force[i] = force;
    ++out.rows;
    const double difference = std::abs(force - history.F_contact[i]);
    if (difference > out.largest_difference) {
      out.largest_difference = difference;
      out.at_time = t[i];
    }
  }
  return out;
}

ImpactState impact_state(const ImpactParameters &parameters, double time) {
  const double w0 = std::sqrt(parameters.stiffness / parameters.mass);
  const double D = parameters.damping_ratio;
  const double c = 2.0 * D * std::sqrt(parameters.mass * parameters.stiffness);
  const double b = D * w0;
  const double v = parameters.speed;
  ImpactState state;
  if (std::abs(D - 1.0) < 1.0e-9) {
    const double decay = std::exp(-w0 * time);
    state.overlap = v * time * decay;
    state.rate = v * (1.0 - w0 * time) * decay;
  } else if (D < 1.0) {
    const double w = w0 * std::sqrt(1.0 - D * D);
    const double decay = std::exp(-b * time);
    state.overlap = v / w * decay * std::sin(w * time);
    state.rate = v * decay * (std::cos(w * time) - b / w * std::sin(w * time));
  } else {
    // Two decaying exponentials, written so that nothing overflows at late times.
    const double s = w0 * std::sqrt(D * D - 1.0);
    const double slow = std::exp(-(b - s) * time);
    const double fast = std::exp(-(b + s) * time);
    state.overlap = v / (2.0 * s) * (slow - fast);
    state.rate = v / (2.0 * s) * ((b + s) * fast - (b - s) * slow);
  }
  state.force = parameters.stiffness * state.overlap + c * state.rate;
  return state;
}

double impact_duration(const ImpactParameters &parameters) {
  const double w0 = std::sqrt(parameters.stiffness / parameters.mass);
  const double D = parameters.damping_ratio;
  if (parameters.transition == Transition::A)
    return D < 1.0 ? pi / (w0 * std::sqrt(1.0 - D * D)) : std::numeric_limits<double>::infinity();
  // B: k d + c d' = 0 first.
  if (std::abs(D - 1.0) < 1.0e-9) return 2.0 / w0;
  if (D < 1.0) {
    const double w = std::sqrt(1.0 - D * D);
    return std::atan2(2.0 * D * w, 2.0 * D * D - 1.0) / (w * w0);
  }
  const double s = std::sqrt(D * D - 1.0);
  return std::atanh(2.0 * D * s / (2.0 * D * D - 1.0)) / (s * w0);
}

std::optional<ImpactMeasure> measure_impact(const ChainHistory &history,
                                            const std::vector<ContactEvent> &events) {
  if (history.size() < 2 || history.v_drum.front() >= 0.0) return std::nullopt;
  ImpactMeasure measure;
  measure.speed_in = -history.v_drum.front();
  measure.speed_out = history.v_drum.back();
  // Without gravity the ball approaches at constant speed, so that this is also the time of the make in
  // events.csv.
  measure.make_time = history.time.front() + history.x_drum.front() / measure.speed_in;
  for (const ContactEvent &event : events)
    if (event.make) {
      measure.make_time = event.time;
      break;
    }
  for (const ContactEvent &event : events)
    if (!event.make) measure.break_time = event.time;
  measure.hits =
      std::any_of(events.begin(), events.end(), [](const ContactEvent &event) { return event.make; }) ||
      std::any_of(history.F_contact.begin(), history.F_contact.end(), [](double F) { return F != 0.0; });
  measure.ended = history.F_contact.back() == 0.0 && measure.speed_out > 0.0;
  return measure;
}

double closed_form_restitution(const std::string &transition, double damping_ratio) {
  const double D = damping_ratio;
  // Time in units of 1/w0: d'' + 2 D d' + d = 0, d(0) = 0, d'(0) = 1.
  if (transition == "A") {
    if (D >= 1.0) return 0.0;
    return std::exp(-pi * D / std::sqrt(1.0 - D * D));
  }
  // B ends where d'' = 0, that is 2 D d' + d = 0; by then d' = -e.
  if (D == 0.0) return 1.0;
  const double tiny = 1.0e-9;
  if (std::abs(D - 1.0) < tiny) return std::exp(-2.0); // d = t exp(-t), d'' = 0 at t = 2
  if (D < 1.0) {
    const double w = std::sqrt(1.0 - D * D);
    // d'' = 0: tan(w t) = 2 D w / (2 D^2 - 1) = first positive root; atan2 covers both branches.
    const double angle = std::atan2(2.0 * D * w, 2.0 * D * D - 1.0);
    const double t = angle / w;
    return std::exp(-D * t) * (D / w * std::sin(angle) - std::cos(angle));
  }
  const double s = std::sqrt(D * D - 1.0);
  const double t = std::atanh(2.0 * D * s / (2.0 * D * D - 1.0)) / s;
  return std::exp(-D * t) * (D / s * std::sinh(s * t) - std::cosh(s * t));
}

} // namespace drumlin::post
