// What each cycle of a record contributes to the meter values: harmonics, contact, force, energy.
#pragma once

#include "meter/sampling.h"
#include "record/record.h"
#include "support/statistics.h"

#include <array>
#include <complex>
#include <optional>
#include <vector>

namespace drumlin::post {

/// One cycle of the excitation. What the record does not give has no value.
struct MeterCycle {
  double begin = 0.0; ///< [s]
  /// Harmonics of the drum's acceleration over this cycle, by meter_orders, phases counted from time 0 [m/s2]
  std::array<std::complex<double>, meter_orders.size()> acceleration{};
  std::vector<AccelerationJump> jumps; ///< of the drum's acceleration between its samples
  double end_jump = 0.0; ///< largest of SignalFaults::differences where the cycle ends between two samples
  std::optional<std::complex<double>> frame;      ///< order 1 of the frame's acceleration [m/s2]
  std::optional<std::complex<double>> excitation; ///< order 1 of F_e, positive down [N]
  std::optional<double> contact_share;            ///< share of the cycle with a contact force above zero [-]
  std::optional<double> peak_force;               ///< largest contact force [N]
  std::optional<double> energy;                   ///< given to the soil, -integral of F dx [J]
  std::optional<double> low_force;                ///< contact force at the drum's lowest position [N]
  std::optional<double> deflection;               ///< of the soil there, see meter_cycles() [m]
};

/// The cycles of a record, in order, and what they come from.
struct MeterRecord {
  HarmonicSource source = HarmonicSource::acceleration;
  double omega = 0.0;    ///< [rad/s]
  double interval = 0.0; ///< between samples [s]; 0 without samples
  double noise = 0.0;    ///< of the samples, as in SignalFaults
  bool filtered = false; ///< the samples have passed a filter; the harmonics are free of it
  bool vibrates = true;  ///< whether the exciter is on (Fw is not 0); without it there are no meter values
  bool computed_force = false; ///< the contact force is not recorded but computed from the accelerations
  /// Width of drum and soil whose forces the record has [m]: 1 of a bed in two dimensions, the thickness of
  /// one in three; none: the whole drum's. NaN: not known.
  std::optional<double> thickness;
  std::optional<double> m2; ///< mass of the drum [kg]
  std::optional<double> m3; ///< mass of the frame [kg]
  std::vector<MeterCycle> cycles;
};

/// The force of the soil on the drum [N]: the record's F_contact; else, if accelerations of drum and frame,
/// masses and excitation are known, m2 (a2 + g) + m3 (a3 + g) + F_e, which follows from the equations of
/// motion; else empty.
std::vector<double> soil_force(const Record &record);

/// The whole cycles of a record, counted from its first sample.
/// - Harmonics: from the sums of `record.cycles_file` if it has them; else from v_drum, else from a_drum.
/// Errors
///   (std::runtime_error) if the record has none of these, or fewer than four cycles.
/// - Contact: force above zero; of a computed force, above 2 % of its largest value. Of a run under
/// transition A, whose contact may pull, the same of the size of the force.
/// - Energy: of a chain from the energies of `record.cycles_file`, else by the trapezoidal rule from force
/// and v_drum.
/// - Deflection: the drum's lowest position below that at which the contact of that cycle began. With a known
///   origin contact begins at x_drum = 0; else it is the mean of the samples before and after this instant,
///   and a cycle in which contact does not begin has no value.
MeterRecord meter_cycles(const Record &record);

/// A line of a spectrum.
struct SpectrumLine {
  double frequency = 0.0; ///< [Hz]
  double amplitude = 0.0; ///< [m/s2]
};

/// Amplitudes of the drum's acceleration between two times, which are whole cycles apart [s], up to six times
/// the excitation frequency, from v_drum or else a_drum; empty for a record without samples of these.
std::vector<SpectrumLine> spectrum(const Record &record, double begin, double end);

} // namespace drumlin::post
