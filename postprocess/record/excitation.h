// What a record of the drum's acceleration tells of the exciter: its frequency, and, where the drum flies,
// its phase and force.
#pragma once

#include "record/record.h"
#include "support/statistics.h"

#include <Eigen/Core>

#include <array>
#include <optional>
#include <vector>

namespace drumlin::post {

/// Share of the nominal frequency within which frequency_of() looks for the true one, to either side.
constexpr double frequency_range = 0.06;

/// Share by which data of a machine may be off that are said to be exact.
constexpr double machine_agreement = 0.1;

/// Frequency of a signal [rad/s] with its 95 % confidence interval: its multiples from one half to six (below
/// half the sampling rate) are fitted to the whole signal by least squares, together with a constant.
/// Residuals of one cycle may be correlated in any way, those of different cycles count as independent.
/// Nothing if the signal has no line near the nominal frequency.
/// \param interval between samples [s]
/// \param nominal [rad/s]; at least four cycles and eight samples per cycle
std::optional<MeanInterval> frequency_of(const std::vector<double> &signal, double interval, double nominal);

/// What the flights of the drum tell. In flight no contact force acts, so that
///     m2 (a2 + g) + m3 (a3 + g) + ratio Fw sin(omega t + phase) = 0.
/// The three unknowns are fitted to all flights, with 95 % confidence intervals for errors that are
/// independent from flight to flight. Sensors have no offset here: over many cycles the soil carries the
/// weight, so that the mean of each acceleration, which is removed, is all that an offset can be.
struct FlightFit {
  MeanInterval omega{}; ///< [rad/s]
  MeanInterval phase{}; ///< at time 0, from -pi to pi; its interval is that in the middle of the record [rad]
  MeanInterval ratio{}; ///< amplitude of the exciter's force over Fw [-]
  double share = 0.0;   ///< of the samples that are in flight [-]
  std::size_t flights = 0; ///< number
  double left = 0.0;       ///< RMS of the force in flight [N]
};

/// Finds the flights, of `ratio` times the given force of the exciter to some 5 %, of a record whose omega,
/// Fw, m2 and m3 are known, omega to a tenth of a cycle over the record. Of all phases of the exciter that
/// one counts with which the most samples are in parts without force. Where both ends of the drum were
/// measured, these are parts in which no moment acts either. Nothing if flights are too few to tell, or if no
/// contacts with a force above zero stand between them.
std::optional<FlightFit> flights_of(const Record &record, double ratio = 1.0);

/// Computes the acceleration of the frame of a measured record that has none from that of the drum, through
/// the bond: the frame is a mass on a spring and a dashpot whose foot moves with the drum. What swings freely
/// at the start has died away. Needs omega, m3 and the bond.
void compute_frame(Record &record);

/// The accelerations of a mass, of its height and its tilt, on a bond whose foot has the accelerations
/// `foot`, sample by sample. \param foot the tilt's may be empty: 0 \param spring a row for each, over its
/// mass or inertia \param dashpot the same
std::array<std::vector<double>, 2> through_bond(const Record &record,
                                                const std::array<std::vector<double>, 2> &foot,
                                                const Eigen::Matrix2d &spring,
                                                const Eigen::Matrix2d &dashpot);

/// Refuses a record of which no flights and no pulses tell the exciter's phase if the phase of the drum's
/// motion wanders by more than a steady frequency explains; std::runtime_error of one line.
void refuse_drift(const Record &record);

/// Refuses a record with a doubt: for whoever does not know that the whole motion follows it to its noise.
void refuse_doubtful(const Record &record);

/// Takes the exciter's frequency, and if the drum flies its phase, from a measured record whose nominal
/// frequency is given; removes offsets of accelerations; notes what was found. A record of a run, or with a
/// measured F_excitation, stays as it is. std::runtime_error of one line: no line near the nominal frequency;
/// a phase that flights contradict; accelerations whose sign is turned.
/// What only seems to contradict the record becomes its doubt.
void settle_excitation(Record &record, const RecordOptions &options);

} // namespace drumlin::post
