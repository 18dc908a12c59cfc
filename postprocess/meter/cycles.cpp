#include "meter/cycles.h"

#include "chain/analysis.h"
#include "runs/chain_files.h"
#include "support/csv.h"
#include "support/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace drumlin::post {

namespace {

constexpr double usual_gravity = 9.81;
constexpr double computed_contact = 0.02; // of the largest force: less counts as no contact

/// A part of an interval between two samples that lies within one cycle.
struct Part {
  std::size_t row;   // the interval begins with this sample
  std::size_t cycle; // counted from 0
  double from, to;   // shares of the interval
};

/// Calls `take` for each part of the record's whole cycles.
template <class Take>
void for_each_part(const Record &record, std::size_t cycles, const Take &take) {
  const double h = record.interval;
  const double period = record.period();
  const double rounding = 1e-6 * h;
  for (std::size_t row = 0; row + 1 < record.size(); ++row) {
    const double begin = h * static_cast<double>(row);
    const auto cycle = static_cast<std::size_t>((begin + rounding) / period);
    const double border = static_cast<double>(cycle + 1) * period;
    const bool divided = border < begin + h - rounding;
    const double share = divided ? std::max(0.0, (border - begin) / h) : 1.0;
    if (cycle < cycles) take(Part{row, cycle, 0.0, share});
    if (divided && cycle + 1 < cycles) take(Part{row, cycle + 1, share, 1.0});
  }
}

/// A signal's value at a share of the interval that begins with `row`.
double at(const std::vector<double> &values, std::size_t row, double share) {
  return values[row] + share * (values[row + 1] - values[row]);
}

std::complex<double> turn(double angle) { return {std::cos(angle), -std::sin(angle)}; }

/// A cubic through the four samples around an interval, two to either side where the record has them.
class Cubic {
public:
  Cubic(std::size_t row, std::size_t size) : base_(std::clamp<std::size_t>(row, 1, size - 3) - 1) {
    shift_ = static_cast<double>(row) - static_cast<double>(base_);
  }
  /// Its value at a share of the interval.
  template <class Value>
  Value at(const std::vector<Value> &values, double share) const {
    const double x = share + shift_;
    return (-(x - 1.0) * (x - 2.0) * (x - 3.0) / 6.0) * values[base_] +
           (x * (x - 2.0) * (x - 3.0) / 2.0) * values[base_ + 1] +
           (-x * (x - 1.0) * (x - 3.0) / 2.0) * values[base_ + 2] +
           (x * (x - 1.0) * (x - 2.0) / 6.0) * values[base_ + 3];
  }
  /// Its mean between two shares: Simpson's rule is exact for cubics.
  template <class Value>
  Value mean(const std::vector<Value> &values, double from, double to) const {
    return (at(values, from) + 4.0 * at(values, 0.5 * (from + to)) + at(values, to)) / 6.0;
  }

private:
  std::size_t base_;
  double shift_ = 0.0;
};

/// Calls `take` with each cycle's mean of a signal times exp(-i frequency t). Full intervals add up to the
/// trapezoidal rule, but for the ends of the record.
template <class Take>
void for_each_mean(const Record &record, const std::vector<double> &values, double frequency,
                   std::size_t cycles, const Take &take) {
  std::vector<std::complex<double>> turned(values.size());
  for (std::size_t row = 0; row < values.size(); ++row)
    turned[row] = values[row] * turn(frequency * record.time[row]);
  const double share = record.interval / record.period();
  std::vector<std::complex<double>> means(cycles);
  for_each_part(record, cycles, [&](const Part &part) {
    means[part.cycle] +=
        (part.to - part.from) * share * Cubic(part.row, turned.size()).mean(turned, part.from, part.to);
  });
  for (std::size_t i = 0; i < cycles; ++i)
    take(i, means[i]);
}

/// Harmonics of the acceleration by parts from those of the velocity: the integral of a exp(-i w t) is the
/// change of v exp(-i w t) plus i w times the integral of v exp(-i w t).
void add_from_velocity(const Record &record, std::vector<MeterCycle> &cycles) {
  const std::vector<double> &v = record.v_drum;
  const double scale = 2.0 / record.period();
  for_each_part(record, cycles.size(), [&](const Part &part) {
    const Cubic cubic(part.row, v.size());
    const double from = cubic.at(v, part.from);
    const double to = cubic.at(v, part.to);
    MeterCycle &cycle = cycles[part.cycle];
    for (std::size_t j = 0; j < meter_orders.size(); ++j) {
      const double frequency = meter_orders[j] * *record.omega;
      const double time = record.time[part.row];
      cycle.acceleration[j] += scale * (to * turn(frequency * (time + part.to * record.interval)) -
                                        from * turn(frequency * (time + part.from * record.interval)));
    }
  });
  for (std::size_t j = 0; j < meter_orders.size(); ++j) {
    const double frequency = meter_orders[j] * *record.omega;
    for_each_mean(record, v, frequency, cycles.size(), [&](std::size_t i, std::complex<double> mean) {
      cycles[i].acceleration[j] += 2.0 * std::complex<double>(0.0, frequency) * mean;
    });
  }
}

void add_from_acceleration(const Record &record, std::vector<MeterCycle> &cycles) {
  for (std::size_t j = 0; j < meter_orders.size(); ++j)
    for_each_mean(record, record.a_drum, meter_orders[j] * *record.omega, cycles.size(),
                  [&](std::size_t i, std::complex<double> mean) { cycles[i].acceleration[j] = 2.0 * mean; });
}

/// Jumps of the drum's acceleration, by cycles, and those at their ends.
void add_faults(const Record &record, const SignalFaults &faults, std::vector<MeterCycle> &cycles) {
  for (const AccelerationJump &jump : faults.jumps) {
    const double cycle = (jump.time - record.time.front()) / record.period();
    if (cycle < static_cast<double>(cycles.size()))
      cycles[static_cast<std::size_t>(cycle)].jumps.push_back(jump);
  }
  constexpr double rounding = 1e-6;
  constexpr std::ptrdiff_t reach = 3; // intervals, whose samples the cubic and the jump use
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    const double place = static_cast<double>(i + 1) * record.period() / record.interval;
    if (std::abs(place - std::round(place)) < rounding) continue;
    const auto row = static_cast<std::ptrdiff_t>(place);
    const auto last = static_cast<std::ptrdiff_t>(faults.differences.size());
    for (std::ptrdiff_t at = std::max<std::ptrdiff_t>(0, row - reach); at < std::min(last, row + reach); ++at)
      cycles[i].end_jump = std::max(cycles[i].end_jump, faults.differences[static_cast<std::size_t>(at)]);
  }
}

/// Order 1 of a signal, for each cycle; nothing for a signal that the record does not have.
void add_first_order(const Record &record, const std::vector<double> &values,
                     std::optional<std::complex<double>> MeterCycle::*into, std::vector<MeterCycle> &cycles) {
  if (values.empty()) return;
  for_each_mean(record, values, *record.omega, cycles.size(),
                [&](std::size_t i, std::complex<double> mean) { cycles[i].*into = 2.0 * mean; });
}

/// Share of contact, largest force, energy and what Lundberg's formula needs, from samples.
class ContactSums {
public:
  ContactSums(const Record &record, const std::vector<double> &force, bool computed,
              std::vector<MeterCycle> &cycles)
      : record_(record), force_(force), cycles_(cycles) {
    touching_ = computed ? computed_contact * *std::max_element(force.begin(), force.end()) : 0.0;
    const auto transition = record.parameters.find("transition");
    pulls_ = transition != record.parameters.end() && transition->second == "A";
    for (MeterCycle &cycle : cycles_) {
      cycle.contact_share = 0.0;
      cycle.peak_force = 0.0;
      if (!record.v_drum.empty()) cycle.energy = 0.0;
    }
  }
  void add() {
    for_each_part(record_, cycles_.size(), [this](const Part &part) { add(part); });
    if (!record_.x_drum.empty()) add_deflections();
  }

private:
  bool touches(std::size_t row) const { return (pulls_ ? std::abs(force_[row]) : force_[row]) > touching_; }

  void add(const Part &part) {
    MeterCycle &cycle = cycles_[part.cycle];
    const double length = (part.to - part.from) * record_.interval;
    const double ends = (touches(part.row) ? 0.5 : 0.0) + (touches(part.row + 1) ? 0.5 : 0.0);
    *cycle.contact_share += ends * length / record_.period();
    cycle.peak_force =
        std::max({*cycle.peak_force, at(force_, part.row, part.from), at(force_, part.row, part.to)});
    if (!cycle.energy) return;
    const auto power = [&](double share) {
      return -at(force_, part.row, share) * at(record_.v_drum, part.row, share);
    };
    *cycle.energy += 0.5 * length * (power(part.from) + power(part.to));
  }

  void add_deflections() {
    const std::vector<double> &x = record_.x_drum;
    std::vector<std::optional<std::size_t>> lowest(cycles_.size());
    for_each_part(record_, cycles_.size(), [&](const Part &part) {
      if (part.from == 0.0 && (!lowest[part.cycle] || x[part.row] < x[*lowest[part.cycle]]))
        lowest[part.cycle] = part.row;
    });
    for (std::size_t i = 0; i < cycles_.size(); ++i) {
      if (!lowest[i] || !touches(*lowest[i])) continue;
      std::size_t begin = *lowest[i];
      const auto least = static_cast<std::size_t>(
          std::max(0.0, static_cast<double>(begin) - record_.period() / record_.interval));
      while (begin > least && touches(begin))
        --begin;
      const bool begins = !touches(begin);
      if (!begins && !record_.known_origin) continue;
      const double zero = record_.known_origin ? 0.0 : 0.5 * (x[begin] + x[begin + 1]);
      cycles_[i].deflection = zero - x[*lowest[i]];
      cycles_[i].low_force = force_[*lowest[i]];
    }
  }

  const Record &record_;
  const std::vector<double> &force_;
  std::vector<MeterCycle> &cycles_;
  double touching_ = 0.0;
  bool pulls_ = false; // a run under A: in contact the force may be a tension, without contact it is 0
};

/// A table of cycles without its first row, cycle 0, which has the energies at the start.
struct StepSums {
  CycleColumns columns;
  CycleHarmonics harmonics;
  std::size_t first = 0;
  std::size_t cycles() const {
    return harmonics.fundamental.size() - std::min(first, harmonics.fundamental.size());
  }
};

StepSums read_sums(const Record &record) {
  StepSums sums;
  if (record.cycles_file.empty()) return sums;
  sums.columns = read_cycle_columns(record.cycles_file);
  sums.harmonics = cycle_harmonics(sums.columns);
  if (sums.columns.has("cycle") && sums.columns.rows > 0 && sums.columns.at("cycle").front() == 0.0)
    sums.first = 1;
  return sums;
}

/// Replaces what samples gave by the sums over every step.
void take_sums(const StepSums &sums, double period, std::vector<MeterCycle> &cycles) {
  const CycleColumns &columns = sums.columns;
  const bool bed = columns.has("settlement");
  const bool energies = !bed && columns.has("dissipated_contact") && columns.has("stored_contact");
  const auto given = [&](std::size_t row) {
    return columns.at("dissipated_contact")[row] + columns.at("stored_contact")[row];
  };
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    const std::size_t row = i + sums.first;
    MeterCycle &cycle = cycles[i];
    if (columns.has("time")) cycle.begin = columns.at("time")[row] - period;
    if (std::abs(cycle.begin) < 1e-9 * period) cycle.begin = 0.0; // the difference of two rounded times
    cycle.acceleration = {};
    cycle.acceleration[half_order] = sums.harmonics.half[row];
    cycle.acceleration[basic_order] = sums.harmonics.fundamental[row];
    cycle.acceleration[double_order] = sums.harmonics.second[row];
    if (columns.has("contact_share")) cycle.contact_share = columns.at("contact_share")[row];
    if (columns.has("F_contact_max")) cycle.peak_force = columns.at("F_contact_max")[row];
    if (energies && row > 0) cycle.energy = given(row) - given(row - 1);
  }
}

/// Gives the harmonics the size that they had before the filter.
void undo_filter(const Record &record, MeterRecord &result) {
  result.filtered = record.low_pass != 0.0 || record.logger_filter;
  if (record.low_pass == 0.0) return;
  const double frequency = 1.0 / record.period();
  MeterAmplitudes gain{};
  for (std::size_t j = 0; j < gain.size(); ++j)
    gain[j] = low_pass_gain(meter_orders[j] * frequency, record.interval, record.low_pass);
  constexpr double least_gain = 0.1;
  if (gain[double_order] < least_gain)
    csv_fault(
        record.file, 0, {},
        refusal("the cut-off frequency", record.low_pass,
                fmt::format("one that leaves a tenth of the second harmonic at {:.4g} Hz", 2.0 * frequency)));
  for (MeterCycle &cycle : result.cycles) {
    for (std::size_t j = 0; j < gain.size(); ++j)
      cycle.acceleration[j] /= gain[j];
    if (cycle.frame) *cycle.frame /= gain[basic_order];
    if (cycle.excitation) *cycle.excitation /= gain[basic_order];
  }
}

/// The excitation of a run without samples: F_e = Fw sin(omega t + phase).
void take_excitation(const Record &record, std::vector<MeterCycle> &cycles) {
  if (!record.time.empty() || !record.Fw || !record.phase) return;
  for (MeterCycle &cycle : cycles)
    cycle.excitation = *record.Fw * std::complex<double>(std::sin(*record.phase), -std::cos(*record.phase));
}

/// The width whose forces a record has, as MeterRecord::thickness. A bed.csv without parameters.csv counts as
/// one in two dimensions.
std::optional<double> thickness_of(const Record &record) {
  const auto dimension = record.parameters.find("dimension");
  if (dimension == record.parameters.end())
    return record.file.filename() == "bed.csv" ? std::optional(1.0) : std::nullopt;
  if (dimension->second == "2") return 1.0;
  const auto thickness = record.parameters.find("thickness");
  const std::optional<double> known =
      thickness == record.parameters.end() ? std::nullopt : any_number_from_text(thickness->second);
  return known && *known > 0.0 ? *known : std::nan("");
}

std::size_t whole_cycles(const Record &record) {
  constexpr double rounding = 1e-6;
  return record.time.empty() ? 0 : static_cast<std::size_t>(record.cycles() + rounding);
}

/// Amplitude at a multiple of the excitation frequency over samples first to last.
double amplitude_at(const Record &record, double order, std::size_t first, std::size_t last) {
  const bool velocity = !record.v_drum.empty();
  const double frequency = order * *record.omega;
  const double half = 0.5 * frequency * record.interval;
  std::complex<double> sum;
  for (std::size_t i = first; i < last; ++i) {
    const double middle = record.time[i] + 0.5 * record.interval;
    sum += velocity ? (record.v_drum[i + 1] - record.v_drum[i]) / record.interval * turn(frequency * middle)
                    : 0.5 * (record.a_drum[i] * turn(frequency * record.time[i]) +
                             record.a_drum[i + 1] * turn(frequency * record.time[i + 1]));
  }
  const double weakened = velocity && half > 0.0 ? half / std::sin(half) : 1.0;
  return 2.0 / static_cast<double>(last - first) * std::abs(sum) * weakened;
}

} // namespace

std::vector<SpectrumLine> spectrum(const Record &record, double begin, double end) {
  if (record.time.empty() || (record.v_drum.empty() && record.a_drum.empty())) return {};
  const auto row = [&record](double time) {
    const double place = std::round((time - record.time.front()) / record.interval);
    return std::min(record.size() - 1, static_cast<std::size_t>(std::max(0.0, place)));
  };
  const std::size_t first = row(begin);
  const std::size_t last = row(end);
  const auto cycles = static_cast<int>(std::lround((end - begin) / record.period()));
  constexpr int most_lines = 40; // per multiple of the excitation frequency
  constexpr int highest = 6;
  const int step = (cycles + most_lines - 1) / most_lines;
  const double samples = record.period() / record.interval;
  std::vector<SpectrumLine> lines;
  for (int k = step; k < highest * cycles && k < 0.4 * samples * cycles; k += step) {
    const double order = static_cast<double>(k) / cycles;
    lines.push_back({order / record.period(), amplitude_at(record, order, first, last)});
  }
  return lines;
}

std::vector<double> soil_force(const Record &record) {
  if (!record.F_contact.empty()) return record.F_contact;
  if (record.a_drum.empty() || record.a_frame.empty() || record.F_excitation.empty() || !record.m2 ||
      !record.m3)
    return {};
  const double g = record.g.value_or(usual_gravity);
  std::vector<double> force(record.size());
  for (std::size_t i = 0; i < force.size(); ++i)
    force[i] =
        *record.m2 * (record.a_drum[i] + g) + *record.m3 * (record.a_frame[i] + g) + record.F_excitation[i];
  return force;
}

MeterRecord meter_cycles(const Record &record) {
  MeterRecord result;
  const double period = record.period();
  result.omega = *record.omega;
  result.thickness = thickness_of(record);
  result.m2 = record.m2;
  result.m3 = record.m3;
  result.vibrates = record.Fw.value_or(1.0) != 0.0;
  const StepSums sums = read_sums(record);
  const bool summed = sums.cycles() > 0;
  const std::size_t count = summed && record.time.empty() ? sums.cycles()
                            : summed                      ? std::min(sums.cycles(), whole_cycles(record))
                                                          : whole_cycles(record);
  if (count < least_cycles)
    csv_fault(record.file, 0, {},
              refusal("the number of whole cycles", fmt::format("{}", count),
                      fmt::format("{} or more", least_cycles)));
  result.cycles.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    result.cycles[i].begin =
        (record.time.empty() ? 0.0 : record.time.front()) + period * static_cast<double>(i);
  result.source = summed                   ? HarmonicSource::every_step
                  : !record.v_drum.empty() ? HarmonicSource::velocity
                                           : HarmonicSource::acceleration;
  if (result.source == HarmonicSource::velocity)
    add_from_velocity(record, result.cycles);
  else if (!summed && record.a_drum.empty())
    csv_fault(record.file, 0, {}, "has neither v_drum nor a_drum; allowed: a record with one of them");
  else if (!summed)
    add_from_acceleration(record, result.cycles);
  add_first_order(record, record.a_frame, &MeterCycle::frame, result.cycles);
  add_first_order(record, record.F_excitation, &MeterCycle::excitation, result.cycles);
  if (!summed) {
    result.interval = record.interval;
    const SignalFaults faults = faults_of(record, result.source);
    result.noise = faults.noise;
    add_faults(record, faults, result.cycles);
    undo_filter(record, result);
  }
  const std::vector<double> force = soil_force(record);
  result.computed_force = record.F_contact.empty() && !force.empty();
  if (!force.empty()) ContactSums(record, force, result.computed_force, result.cycles).add();
  if (summed) take_sums(sums, period, result.cycles);
  take_excitation(record, result.cycles);
  return result;
}

} // namespace drumlin::post
