// Which samples of a record were taken while drum and soil were in contact.
#pragma once

#include <cstddef>
#include <vector>

namespace drumlin::post {

/// What the equations of motion say about the contact force at equal intervals of time.
///
/// The sum of the equations of motion of drum and frame (2, 3) has no bond force:
///     F_c = m2 a2 + m3 a3 + (m2 + m3) g + F_e,   F_e = Fw sin(omega t + phase)
/// The phase is known only within an error delta, with which F_e becomes F_e cos(delta) + Q sin(delta).
struct DrumSignals {
  double dt = 0.0;                ///< time from one sample to the next [s]
  double per_cycle = 0.0;         ///< samples per cycle of the excitation, 6 or more [-]
  std::vector<double> a_drum;     ///< upwards [m/s2]
  std::vector<double> force;      ///< F_c with delta = 0, positive in compression [N]
  std::vector<double> excitation; ///< F_e with delta = 0, positive if it pushes the drum down [N]
  std::vector<double> quadrature; ///< Q = Fw cos(omega t + phase) [N]
  std::vector<double> x_drum;     ///< upwards, 0 where drum and soil just touch [m]; empty: not measured
  std::vector<double> v_drum;     ///< upwards [m/s]; empty: not measured

  std::size_t size() const { return a_drum.size(); }
  /// F_c with an error of the phase of `delta` [rad].
  double force_at(std::size_t sample, double delta) const;
};

/// Consecutive samples from `first` to before `end`.
struct SampleRun {
  std::size_t first = 0;
  std::size_t end = 0;
  std::size_t size() const { return end - first; }
};

/// State of a sample. `unclear`: the force is too small to tell contact from flight; not used.
enum class SampleState { contact, flight, unclear };

/// Standard deviation of the part of a signal that changes from sample to sample at random [unit of the
/// signal]: the median of absolute third differences, which are small for a smooth signal and few at jumps. 0
/// for fewer than 8 samples.
double noise_level(const std::vector<double> &signal);

/// Limit below which each sample's force may be noise [N]: four times its standard deviation, a thousandth of
/// the largest force, and the change of the excitation force by a phase error of `within` [rad].
std::vector<double> force_limits(const DrumSignals &signals, double delta, double within);

/// The least number of samples of a contact that is used: two of them determine where the drum was and how
/// fast, so that two are left.
constexpr std::size_t least_contact = 4;

/// Runs of at least `least_contact` samples whose force exceeds the limits and a share of the largest force.
std::vector<SampleRun> loaded_runs(const DrumSignals &signals, const std::vector<double> &limits,
                                   double share);

/// The first and the second integral over time of the samples of a run, zero at its first, by cubic
/// interpolation (error of the fourth order in dt); by the trapezoidal rule if it has fewer than 4 samples.
struct Integrals {
  std::vector<double> once;  ///< of an acceleration [m/s]
  std::vector<double> twice; ///< [m]
};
Integrals integrals(const std::vector<double> &signal, const SampleRun &run, double dt);

} // namespace drumlin::post
