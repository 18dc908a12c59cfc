// Stiffness, damping and the transition condition of the contact between drum and soil, from a record of the
// drum's motion and the contact force that the equations of motion give.
//
// While drum and soil touch, F_c = -k x - c v. Ordinary regression on measured x and v is biased by their
// noise (errors in variables). Here x and v of each contact are therefore the integrals of the measured
// acceleration, whose noise the integration averages out, plus two unknown constants:
//     v = v0 + int a dt,   x = x0 + v0 (t - t0) + int int a dt dt
// k, c, the error of the exciter's phase, and x0, v0 of every contact are found together by weighted least
// squares of three kinds of residuals: of the force, of the measured position, of the measured velocity
// (maximum likelihood for normal noise, weights from the residuals themselves). This is the total least
// squares problem with the kinematics as constraint. Without measured position and velocity the residuals of
// the force alone determine k and c; a drift of the integrated acceleration is part of x0 and v0. x0 and v0
// are eliminated contact by contact (variable projection, Golub and Pereyra 1973).
#pragma once

#include "chain/contact_phases.h"
#include "support/statistics.h"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <vector>

namespace drumlin::post {

/// What is known besides the signals.
struct IdentificationSetting {
  double m2 = 0.0; ///< mass of the drum [kg]
  /// Whether x_drum = 0 is where drum and soil just touch. If not, each contact has an unknown origin, as on
  /// a bed that settles.
  bool known_origin = true;
  /// Largest error of the exciter's phase [rad], 0 to 0.35: equally probable within it. 0: the phase is
  /// exact.
  double phase_within = 0.0;
  /// Largest error of the force besides noise and phase [N]: no smaller tension is told.
  double force_within = 0.0;
  /// Share of the largest force up to which forces are not fitted, unless the law follows them [-], 0 to 0.9.
  double least_force = 0.0;
};

/// k, c and D with 95 % confidence intervals. Each contact, or each cycle of one that lasts longer, is a
/// block; residuals within a block may be correlated in any way, those of different blocks are taken as
/// independent (sandwich estimator). Where the interval from uncorrelated residuals is wider, it counts.
struct LawEstimate {
  MeanInterval k{};           ///< [N/m]
  MeanInterval c{};           ///< [N s/m]
  MeanInterval D{};           ///< c / (2 sqrt(m2 k)) [-]; NaN where k is not positive
  MeanInterval phase{};       ///< error of the phase [rad]
  double r2 = 0.0;            ///< share of the variance of the force in contact that the law explains [-]
  std::size_t blocks = 0;     ///< contacts, or cycles of them
  std::size_t samples = 0;    ///< in contact
  double force_noise = 0.0;   ///< RMS residual of the force [N]
  double contact_share = 0.0; ///< share of the samples in which the law acts [-]
};

/// Whether the contact can pull.
enum class Pull {
  pulls,         ///< tension is measured: transition A
  does_not_pull, ///< contact is lost, and the tension that A would show is not there: transition B
  unknown        ///< contact is not lost, or the tension would be too small or too short to be seen
};

/// One contact, or a cycle of it, with its fitted motion.
struct ContactPiece {
  SampleRun run;
  Integrals integrals;               ///< of the drum's acceleration, from its first sample
  std::vector<std::size_t> flight{}; ///< samples of the flight after it
  double offset = 0.0;               ///< force of the law at its first sample without its dashpot: -k x0 [N]
  double slope = 0.0;                ///< unknown part of the velocity, v0 [m/s]
  double position = 0.0;             ///< x0 [m]; NaN if no position is measured
};

/// What a record says.
struct Identification {
  LawEstimate law;
  Pull pull = Pull::unknown;
  double tension = 0.0; ///< largest tension that was measured, or that A would show [N]
  std::vector<SampleState> states;
  std::vector<ContactPiece> pieces;
  std::vector<double> fitted; ///< force of the law [N]; NaN where it was not fitted
  std::vector<double> force;  ///< of the equations of motion, with the fitted phase [N]
  std::vector<double> x, v;   ///< fitted motion in contact [m, m/s]; NaN elsewhere
};

/// Throws std::runtime_error with one line if the record has no contact of 4 samples, or if it does not
/// determine k and c. `progress` is called with the share of the work that is done.
Identification identify(const DrumSignals &signals, const IdentificationSetting &setting,
                        const std::function<void(double)> &progress = {});

/// The law of the pieces that begin in a window, with the states that identify() found. The same errors.
LawEstimate identify_window(const DrumSignals &signals, const IdentificationSetting &setting,
                            const Identification &whole, const SampleRun &window);

} // namespace drumlin::post
