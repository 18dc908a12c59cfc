// Periodic motions of the chain, their stability, and where they change. The state is looked at once per
// cycle of the excitation, at its start. The map from one cycle to the next is linearised exactly: over a
// piece by the exponential of its matrix, at an event by the saltation matrix (PhaseChange::saltation).
//
// Source of the saltation matrix and of Floquet multipliers of motions with events: di Bernardo, Budd,
// Champneys, Kowalczyk, "Piecewise-smooth Dynamical Systems", Springer 2008.
#pragma once

#include "roller/chain_solver.h"

#include <Eigen/Core>

#include <array>
#include <complex>
#include <functional>
#include <optional>
#include <vector>

namespace drumlin::post {

/// What some cycles did to a motion.
struct Passage {
  ChainState end = ChainState::Zero();
  Eigen::Matrix4d jacobian = Eigen::Matrix4d::Identity(); ///< d end / d start; only if asked for
  int makes = 0;
  int breaks = 0;
  double contact_time = 0.0;                       ///< [s]
  ContactPhase last_phase = ContactPhase::contact; ///< at the end
  bool always_contact() const { return breaks == 0 && makes == 0 && last_phase == ContactPhase::contact; }
};

/// Follows the motion that has the state at the start of a cycle for some cycles.
Passage pass(const ChainSolver &solver, const ChainState &state, int cycles, bool with_jacobian = false);

/// Scales of position and velocity, by which states are compared: what the excitation and gravity reach in a
/// radian of a cycle.
ChainState state_scale(const ChainParameters &parameters);

/// A motion that repeats itself after `period` cycles.
struct PeriodicOrbit {
  int period = 1;
  ChainState state = ChainState::Zero();             ///< at the start of a cycle
  Passage passage;                                   ///< over the period, with Jacobian
  std::array<std::complex<double>, 4> multipliers{}; ///< Floquet multipliers, largest modulus first
  double residual = 0.0;                             ///< |end - state| in units of state_scale()
  bool stable() const { return std::abs(multipliers[0]) < 1.0; }
  bool always_contact() const { return passage.always_contact(); }
};

/// Eigenvalues of a monodromy matrix, largest modulus first.
std::array<std::complex<double>, 4> floquet_multipliers(const Eigen::Matrix4d &monodromy);

/// Newton on the map of `period` cycles from a guess. Nothing if it does not converge to a residual of 1e-11,
/// or leaves 1e3 scales.
std::optional<PeriodicOrbit> find_orbit(const ChainSolver &solver, const ChainState &guess, int period);

/// State at the start of a cycle of the linear steady state with unbroken contact, whether or not the contact
/// law lets it be. std::runtime_error for an undamped resonance.
ChainState steady_contact_state(const ChainParameters &parameters);

/// How far that steady state is from losing contact: the least contact force [N] for condition B, k times the
/// least overlap [N] for A. Negative where it cannot be. Closed form: mean minus amplitude.
double contact_margin(const ChainParameters &parameters);

/// An exponential rate with its 95 % confidence interval, per cycle.
struct Exponent {
  double mean = 0.0, low = 0.0, high = 0.0;
};

/// Largest Lyapunov exponent over `cycles` from a motion at the start of a cycle, after `lead` cycles in
/// which the direction turns to that of fastest growth. The interval is that of the mean of 20 blocks
/// (Student's t, 19 degrees of freedom). `state` becomes the last one.
Exponent largest_exponent(const ChainSolver &solver, ChainState &state, int lead, int cycles);

/// Chains that differ in one number.
using ChainFamily = std::function<ChainParameters(double)>;

struct BranchPoint {
  double value = 0.0;
  PeriodicOrbit orbit;
};

/// The orbit that `start` becomes from one value of the number to another, stable or not, in `steps` steps or
/// more where Newton needs shorter ones. Ends early where no orbit is found even with a step of 1e-7 of the
/// range, at a fold for instance.
std::vector<BranchPoint> continue_orbit(const ChainFamily &family, double from, double to, int steps,
                                        const PeriodicOrbit &start);

/// Where an orbit changes.
struct Change {
  double value = 0.0; ///< of the number, to 1e-11 relative
  bool smooth = true; ///< doubling: a multiplier passes -1; false: it jumps over -1, since the orbit meets a
                      ///< boundary of the contact
};

/// Where the steady state with unbroken contact ends between two values, at one of which it lasts and at the
/// other it does not, as the events of the motion itself tell. Nothing if both ends are alike.
std::optional<Change> locate_contact_loss(const ChainFamily &family, double from, double to);

/// Where a multiplier of the orbit that begins as `start` at `from` passes -1. Nothing if the sign of det(J +
/// I) is the same at both ends or the orbit cannot be followed.
std::optional<Change> locate_doubling(const ChainFamily &family, double from, double to,
                                      const PeriodicOrbit &start);

} // namespace drumlin::post
