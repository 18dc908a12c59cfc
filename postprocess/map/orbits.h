// Periodic motions (orbits) of the chain, their stability, and the parameters at which they lose it. The
// Poincare map takes the state at the start of a cycle of the excitation to that at the start of the next. It
// is linearised exactly: over a piece (MotionPiece) by the matrix exponential, at an event by the saltation
// matrix (ContactChange::jump).
//
// Source of the saltation matrix and of Floquet multipliers of motions with events: di Bernardo, Budd,
// Champneys, Kowalczyk, "Piecewise-smooth Dynamical Systems", Springer 2008.
#pragma once

#include "chain/one_contact.h"
#include "map/orbit_search.h"

#include <Eigen/Core>

#include <array>
#include <complex>
#include <functional>
#include <optional>
#include <vector>

namespace drumlin::post {

/// Result of following a motion over some cycles.
struct Passage {
  ChainState end = ChainState::Zero();
  Eigen::Matrix4d jacobian = Eigen::Matrix4d::Identity(); ///< d end / d start; only if asked for
  int makes = 0;
  int breaks = 0;
  double contact_time = 0.0;                       ///< [s]
  ContactPhase last_phase = ContactPhase::contact; ///< at the end
  bool always_contact() const { return breaks == 0 && makes == 0 && last_phase == ContactPhase::contact; }
};

/// Follows the motion from `state` at the start of a cycle over `cycles` cycles.
Passage pass(const ChainSolver &solver, const ChainState &state, int cycles, bool with_jacobian = false);

/// Scales of position and velocity by which differences of states are divided: those that the forces of
/// excitation and gravity cause within 1/omega, the time of one radian of the cycle.
ChainState state_scale(const ChainParameters &parameters);

/// The chain as a System of map/orbit_search.h.
struct ChainCycles {
  using State = ChainState;
  using Matrix = Eigen::Matrix4d;
  using Passage = post::Passage;
  using Motion = ChainMotion;
  const ChainSolver &solver;

  Passage pass(const ChainState &state, int cycles, bool with_jacobian) const {
    return post::pass(solver, state, cycles, with_jacobian);
  }
  ChainState scale() const { return state_scale(solver.parameters()); }
  ChainMotion start_at(const ChainState &state) const { return solver.start_at(state); }
  void advance(ChainMotion &motion, ChainState *tangent) const;
};

/// A motion of the chain that repeats itself.
struct PeriodicOrbit : OrbitOf<ChainCycles> {
  bool always_contact() const { return passage.always_contact(); }
};

/// Solves for an orbit by Newton's method, from a guess. No value if the residual does not become less than
/// 1e-11, or if the state exceeds 1e3 times state_scale().
std::optional<PeriodicOrbit> find_orbit(const ChainSolver &solver, const ChainState &guess, int period);

/// State at the start of a cycle of the linear steady state with unbroken contact, even if the contact law
/// would break the contact. Throws std::runtime_error for an undamped resonance.
ChainState steady_contact_state(const ChainParameters &parameters);

/// How far that steady state is from losing contact: the least contact force [N] for condition B, k times the
/// least overlap [N] for A. Negative if the contact is lost. Closed form: mean minus amplitude.
double contact_margin(const ChainParameters &parameters);

/// exponent_of() of the chain.
Exponent largest_exponent(const ChainSolver &solver, ChainState &state, int lead, int cycles);

/// The parameters of the chain as a function of the one that is varied.
using ChainFamily = std::function<ChainParameters(double)>;

struct BranchPoint {
  double value = 0.0;
  PeriodicOrbit orbit;
};

/// continued_orbit() of the chain.
std::vector<BranchPoint> continue_orbit(const ChainFamily &family, double from, double to, int steps,
                                        const PeriodicOrbit &start);

/// The value between `from` and `to` at which the steady state with unbroken contact begins or ends, decided
/// by whether the computed motion has a break. No value if the contact is unbroken at both or at neither.
std::optional<OrbitChange> locate_contact_loss(const ChainFamily &family, double from, double to);

/// located_doubling() of the chain.
std::optional<OrbitChange> locate_doubling(const ChainFamily &family, double from, double to,
                                           const PeriodicOrbit &start);

} // namespace drumlin::post
