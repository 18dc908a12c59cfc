// Stiffness and damping of the soil from the whole motion of drum and frame.
//
// A fit of single contacts has to find position and velocity of the drum anew in each of them. Here the
// equations of motion of drum, frame, bond and soil follow the record from contact to contact, through its
// flights, so that few unknowns are left: k, c, stiffness and damping of the bond, the exciter's phase and
// frequency, offset and slow drift of each sensor, and the state at the start of each stretch of cycles.
// Stretches are joined as long as one motion follows them; where errors grow from cycle to cycle, as in
// aperiodic motion, they stay short. Between events the motion is linear, and its exact solution and the
// derivatives of that are used; least squares by Gauss, Newton, Levenberg and Marquardt.
#pragma once

#include "identify/identification.h"
#include "record/excitation.h"
#include "record/record.h"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace drumlin::post {

/// A contact. Intervals: 95 %.
struct ContactFit {
  MeanInterval k{};         ///< [N/m]
  MeanInterval c{};         ///< [N s/m]
  double correlation = 0.0; ///< of the errors of k and c [-]
};

/// What the whole motion tells. Intervals: 95 %.
struct MotionFit {
  std::vector<ContactFit> contacts; ///< the one below the drum, or those below its left and its right half
  double k_together = 0.0;          ///< correlation of the errors of k of both halves [-]
  MeanInterval omega{};             ///< [rad/s]
  MeanInterval phase{};             ///< of the exciter at time 0 [rad]
  MeanInterval force{};             ///< of the exciter over that which is said [-]
  bool pulls = false;               ///< condition A fits better
  double tension = 0.0;             ///< the largest one, or that of condition A [N]
  bool pull_is_clear = false;       ///< the other condition fits worse by more than noise explains
  double bond_stiffness = 0.0;      ///< between drum and frame [N/m]
  double bond_damping = 0.0;        ///< [N s/m]
  double residual = 0.0;            ///< RMS of the drum's acceleration [m/s2]
  /// What is left is noise; if not, the soil, the frame or the machine is another than in the equations.
  bool is_noise = false;
  double cost = 0.0;   ///< twice the logarithm of one over the likelihood
  double cycles = 0.0; ///< of the longest stretch that one motion follows
  /// Whether that is long enough for its noise to say all of the error: a start each cycle or two follows
  /// wrong data of the machine, too.
  bool is_long() const { return cycles >= 3.0; }
  bool any_force = false; ///< nothing followed the record to its noise with the force that is said
  /// Share of the drum's acceleration that a right soil, frame and machine may leave.
  static constexpr double close = 0.05;
  /// Whether one motion follows the record, with about the force that is said. \param left of the drum's
  /// acceleration [-]
  bool follows(double left) const {
    return (is_noise || (is_long() && left < close)) && std::fabs(force.mean - 1.0) < machine_agreement;
  }
};

/// What is known besides the record.
struct MotionSetting {
  /// Half the width within which the record's phase at time 0 is known [rad]; not given: the record tells it.
  std::optional<double> phase_within;
  /// Half the width within which the exciter's force over that which is said is known [-].
  double force_within = 0.0;
  double force = 1.0; ///< of the exciter over that which is said, from which the fit starts [-]
  /// Also from a softer and a harder soil, and with another force, if nothing follows the record to its
  /// noise.
  bool search = true;
};

/// Follows a measured record of accelerations of drum and frame from what single contacts say; nothing if the
/// equations of motion do not follow it to its noise, which a soil of another kind, a frame that does more
/// than move up and down, or wrong data of the machine may cause.
std::optional<MotionFit> fit_motion(const Record &record, const Identification &start,
                                    const MotionSetting &setting);

/// What the contact below a half of the drum says by itself.
struct HalfStart {
  Identification contact;
  std::vector<double> acceleration; ///< of the drum at the contact [m/s2]
};

/// The same of a record of both ends of a drum that tilts with its frame, on a contact below each half.
std::optional<MotionFit> fit_motion(const Record &record, const std::array<HalfStart, 2> &halves,
                                    const MotionSetting &setting);

} // namespace drumlin::post
