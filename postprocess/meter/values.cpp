#include "meter/values.h"

#include "support/units.h"

#include <boost/math/tools/toms748_solve.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace drumlin::post {

const std::array<const char *, mode_count> mode_names = {"continuous contact", "partial uplift",
                                                         "double jump", "irregular", "same in each cycle"};

namespace {

using Cycles = std::vector<MeterCycle>;

/// Mean over the window of what every cycle of it has.
std::optional<double> mean_of(const Cycles &cycles, const MeterWindow &window, std::size_t count,
                              std::optional<double> MeterCycle::*value) {
  double sum = 0.0;
  for (std::size_t i = window.first; i < window.first + count; ++i) {
    if (!(cycles[i].*value)) return std::nullopt;
    sum += *(cycles[i].*value);
  }
  return sum / static_cast<double>(count);
}

std::optional<std::complex<double>> mean_of(const Cycles &cycles, const MeterWindow &window,
                                            std::size_t count,
                                            std::optional<std::complex<double>> MeterCycle::*value) {
  std::complex<double> sum;
  for (std::size_t i = window.first; i < window.first + count; ++i) {
    if (!(cycles[i].*value)) return std::nullopt;
    sum += *(cycles[i].*value);
  }
  return sum / static_cast<double>(count);
}

/// Relative difference of the harmonics of order 1 and 2 between cycles that are `apart` from one another.
double difference(const Cycles &cycles, const MeterWindow &window, std::size_t count, std::size_t apart) {
  double differences = 0.0;
  double sizes = 0.0;
  for (std::size_t i = window.first; i + apart < window.first + count; ++i)
    for (const std::size_t order : {basic_order, double_order}) {
      differences += std::norm(cycles[i + apart].acceleration[order] - cycles[i].acceleration[order]);
      sizes += std::norm(cycles[i].acceleration[order]);
    }
  return sizes > 0.0 ? std::sqrt(differences / sizes) : 0.0;
}

constexpr double rounding = 1e-9;

OperatingMode mode_of(const Cycles &cycles, const MeterWindow &window, std::size_t count, double same) {
  if (window.contact_share && *window.contact_share > 1.0 - rounding)
    return OperatingMode::continuous_contact;
  if (difference(cycles, window, count, 1) <= same)
    return window.contact_share ? OperatingMode::partial_uplift : OperatingMode::same_each_cycle;
  return difference(cycles, window, count, 2) <= same ? OperatingMode::double_jump : OperatingMode::irregular;
}

void take_amplitudes(const MeterRecord &record, const MeterOptions &options, std::size_t count,
                     MeterWindow &window) {
  SampledCycles sampled;
  sampled.source = record.source;
  sampled.omega = record.omega;
  sampled.interval = record.interval;
  sampled.cycles = static_cast<int>(count);
  sampled.noise = record.noise;
  for (std::size_t i = window.first; i < window.first + count; ++i) {
    const MeterCycle &cycle = record.cycles[i];
    for (std::size_t j = 0; j < meter_orders.size(); ++j)
      sampled.harmonics[j] += cycle.acceleration[j] / static_cast<double>(count);
    sampled.jumps.insert(sampled.jumps.end(), cycle.jumps.begin(), cycle.jumps.end());
  }
  sampled.end_jumps = record.cycles[window.first + count - 1].end_jump +
                      (window.first > 0 ? record.cycles[window.first - 1].end_jump : 0.0);
  for (std::size_t j = 0; j < meter_orders.size(); ++j)
    window.amplitude[j] = std::abs(sampled.harmonics[j]);
  if (!(window.amplitude[basic_order] > 0.0)) return;
  const MeterFormula rmv = resonance_meter(options.rmv_constant);
  window.cmv = compaction_meter(window.amplitude);
  window.rmv = rmv(window.amplitude);
  if (record.source == HarmonicSource::every_step) return;
  window.ccv = compaction_control(window.amplitude);
  // A filter hides the jumps, but not what sampling has done before.
  if (record.filtered) {
    window.cmv_bound = window.rmv_bound = window.ccv_bound = std::numeric_limits<double>::infinity();
    return;
  }
  window.cmv_bound = sampling_bound(compaction_meter, sampled);
  window.rmv_bound = sampling_bound(rmv, sampled);
  window.ccv_bound = sampling_bound(compaction_control, sampled);
}

/// Stiffness and damping at the excitation frequency.
void take_stiffness(const MeterRecord &record, std::size_t count, MeterWindow &window) {
  std::complex<double> a;
  for (std::size_t i = window.first; i < window.first + count; ++i)
    a += record.cycles[i].acceleration[basic_order] / static_cast<double>(count);
  const double squared = record.omega * record.omega;
  window.displacement = std::abs(a) / squared;
  const std::optional<std::complex<double>> excitation =
      mean_of(record.cycles, window, count, &MeterCycle::excitation);
  if (!record.m2 || !excitation || std::abs(a) == 0.0) return;
  const std::complex<double> x = -a / squared;
  const std::complex<double> from_drum = *record.m2 * a + *excitation; // soil force without that of the frame
  // No soil has a negative stiffness or damping: then force or phase are not those of the record.
  if (const double k_B = -(from_drum / x).real(); k_B > 0.0) window.k_B = k_B;
  const std::optional<std::complex<double>> frame = mean_of(record.cycles, window, count, &MeterCycle::frame);
  if (!record.m3 || !frame) return;
  const std::complex<double> stiffness = -(from_drum + *record.m3 * *frame) / x;
  if (!(stiffness.real() > 0.0 && stiffness.imag() >= 0.0)) return;
  window.k_1 = stiffness.real();
  window.c_1 = stiffness.imag() / record.omega;
}

void take_modulus(const MeterRecord &record, const MeterOptions &options, std::size_t count,
                  MeterWindow &window) {
  if (!options.drum_radius || !options.drum_width) return;
  const Cycles &cycles = record.cycles;
  const LineContact contact = {*options.drum_radius, *options.drum_width, options.poisson};
  // The force on the whole drum.
  const double slices = record.thickness ? *options.drum_width / *record.thickness : 1.0;
  if (std::isnan(slices)) return;
  double sum = 0.0;
  int found = 0;
  for (std::size_t i = window.first; i < window.first + count; ++i) {
    if (!cycles[i].low_force || !cycles[i].deflection) continue;
    if (const auto modulus =
            lundberg_modulus(slices * *cycles[i].low_force, *cycles[i].deflection, contact)) {
      sum += *modulus;
      ++found;
    }
  }
  if (found > 0) window.E_vib = sum / found;
}

} // namespace

std::vector<MeterWindow> meter_windows(const MeterRecord &record, const MeterOptions &options) {
  const auto count = static_cast<std::size_t>(options.window);
  const std::size_t total = record.cycles.size();
  if (total < count)
    throw std::runtime_error(refusal("the window", fmt::format("{} cycles", count),
                                     fmt::format("at most the {} whole cycles of the record", total)));
  const double period = 2.0 * pi / record.omega;
  std::vector<MeterWindow> windows(total / count);
  for (std::size_t i = 0; i < windows.size(); ++i) {
    MeterWindow &window = windows[i];
    window.first = total % count + i * count;
    window.begin = record.cycles[window.first].begin;
    window.end = window.begin + period * static_cast<double>(count);
    if (record.vibrates) take_amplitudes(record, options, count, window);
    window.contact_share = mean_of(record.cycles, window, count, &MeterCycle::contact_share);
    // A drum that just keeps contact and one that just loses it have the same force within its errors: less
    // than 2 % of the largest one for 9 % of the cycle, half as much again with errors.
    constexpr double touching = 0.14;
    if (record.computed_force && window.contact_share &&
        *window.contact_share<1.0 - rounding && * window.contact_share> 1.0 - touching &&
        difference(record.cycles, window, count, 1) <= options.same)
      window.contact_share.reset();
    if (const auto energy = mean_of(record.cycles, window, count, &MeterCycle::energy))
      window.energy = 2.0 * *energy;
    if (mean_of(record.cycles, window, count, &MeterCycle::peak_force)) {
      window.peak_force = 0.0;
      for (std::size_t cycle = window.first; cycle < window.first + count; ++cycle)
        window.peak_force = std::max(*window.peak_force, *record.cycles[cycle].peak_force);
    }
    if (record.vibrates) take_stiffness(record, count, window);
    if (record.vibrates) take_modulus(record, options, count, window);
    window.mode = mode_of(record.cycles, window, count, options.same);
  }
  return windows;
}

namespace {

/// Deflection for u = (1 - nu^2)/E F/L [m].
double deflection_of(double u, const LineContact &contact) {
  const double width = std::sqrt(16.0 / pi * contact.radius * u);
  return u * 2.0 / pi * (1.8864 + std::log(contact.length / width));
}

double compliance(double force, const LineContact &contact) {
  return (1.0 - contact.poisson * contact.poisson) * force / contact.length;
}

} // namespace

double lundberg_deflection(double force, double modulus, const LineContact &contact) {
  return deflection_of(compliance(force, contact) / modulus, contact);
}

std::optional<double> lundberg_modulus(double force, double deflection, const LineContact &contact) {
  if (!(force > 0.0) || !(deflection > 0.0)) return std::nullopt;
  // The deflection grows with u as long as the contact is longer than wide.
  const double most = pi * contact.length * contact.length / (16.0 * contact.radius);
  if (deflection > deflection_of(most, contact)) return std::nullopt;
  // The root is sought in the logarithm of u, from one where the deflection is too small to one where it is
  // not.
  const auto excess = [&](double log_u) {
    return std::log(deflection_of(std::exp(log_u), contact) / deflection);
  };
  double low = std::log(std::min(most, deflection)) - 1.0;
  while (excess(low) > 0.0)
    low -= 1.0;
  std::uintmax_t steps = 200;
  const auto bracket = boost::math::tools::toms748_solve(
      excess, low, std::log(most), boost::math::tools::eps_tolerance<double>(50), steps);
  return compliance(force, contact) / std::exp(0.5 * (bracket.first + bracket.second));
}

} // namespace drumlin::post
