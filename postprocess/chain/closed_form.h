// The chain soil - drum - frame solved in closed form. Between two makes or breaks of contact (events) the
// chain is linear with a sinusoidal force, so that its state follows from the exponential of a constant
// matrix. The power series of the exponential is summed over intervals of time (pieces) so short that its
// remainder is below the rounding error. In each piece the motion is thus a polynomial in time. Its Bernstein
// coefficients are bounds of a polynomial, so that no event is overlooked, however short a contact is. Since
// eigenvectors are not needed, repeated eigenvalues (critical damping) are no special case. The direct solver
// (chain/direct_solver) integrates the same equations numerically and is the independent reference; options
// and results have its form.
#pragma once

#include "chain/direct_solver.h"
#include "chain/parameters.h"
#include "runs/chain_files.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <limits>

namespace drumlin::post {

/// x_drum [m], v_drum [m/s], x_frame [m], v_frame [m/s]; origins as in chain.csv.
using ChainState = Eigen::Vector4d;

/// Whether drum and soil are in contact. `flight`: no overlap. `clamped`: overlap without force, which exists
/// under B only, where the law would give tension: d > 0 and k d + c d' <= 0.
enum class ContactPhase { contact, flight, clamped };

/// Upper limit of the number of terms of a power series.
constexpr std::size_t most_terms = 33;
/// A piece is so long that the norm of the matrix times the length, its reach, is at most this: the series
/// then has no cancellation that costs a digit.
constexpr double most_reach = 3.5;
/// The number of terms after which those of a series of this reach are below 1e-18 of its sum.
std::size_t terms_of_series(double reach);

/// The motion over one piece as a polynomial in s = (t - begin) / length, 0 <= s <= end: state(s) = sum of
/// coefficient[n] s^n.
struct MotionPiece {
  std::array<std::array<double, 4>, most_terms> coefficient; ///< of x_drum, v_drum, x_frame, v_frame
  std::size_t terms = 0;
  ContactPhase phase = ContactPhase::contact;
  double begin = 0.0;  ///< since the start of the cycle [s]
  double length = 0.0; ///< time from s = 0 to s = 1 [s]
  double end = 1.0;    ///< value of s at which the piece ends, 0 to 1: less than 1 if an event ends it

  /// The state at s.
  ChainState state(double s) const;
  /// The drum's acceleration at s [m/s2].
  double drum_acceleration(double s) const;
};

/// The linear dynamics of one phase, y' = A y + forces.
class PhaseDynamics {
public:
  PhaseDynamics() = default;
  /// \param k, c of the contact, both zero without one
  PhaseDynamics(const ChainParameters &parameters, double k, double c);

  /// The longest allowed piece [s], `since` seconds after the phase began: short until a fast, heavily damped
  /// part of the motion has decayed, then as long as the slower rest of the motion permits.
  double longest_piece(double since = std::numeric_limits<double>::infinity()) const;
  /// The motion from the state `from` over `length`, with the excitation from the phase omega t of `sine` and
  /// `cosine`.
  void expand(MotionPiece &piece, const ChainState &from, double length, double sine, double cosine) const;
  /// exp(A time) applied to a small difference of two motions, for a time no longer than longest_piece()
  /// after the fast part has decayed.
  ChainState carry(const ChainState &difference, double time) const;

private:
  using Rows = std::array<std::array<double, 4>, 4>;

  Rows full_{};                                      // A
  Rows slow_{};                                      // A without its fast mode
  std::array<double, 4> fast_right_{}, fast_left_{}; // eigenvectors of the fast mode, left * right = 1
  double fast_ = 0.0;      // its eigenvalue [1/s], negative; 0: no mode is split off
  double full_rate_ = 0.0; // bound of A's norm in scaled coordinates [1/s]
  double slow_rate_ = 0.0; // the same of what remains
  double omega_ = 0.0;
  double push_ = 0.0;    // -Fw / m2
  double gravity_ = 0.0; // -g, or 0 where positions count from rest
  // Positions at rest of a phase with contact: counted from there, small motions keep their digits.
  double rest_drum_ = 0.0, rest_frame_ = 0.0;
};

/// Present state of a motion.
struct ChainMotion {
  ChainState state = ChainState::Zero();
  ContactPhase phase = ContactPhase::contact;
  long cycle = 0;     ///< number of completed cycles
  double time = 0.0;  ///< since the start of the cycle [s]
  double since = 0.0; ///< since the phase began [s]
  int boundary = -1;  ///< index of the event condition that the last event left at zero; -1: none
};

/// The event that a contact is made or broken, or that an overlap without force ends, and its effect on the
/// small difference to a neighbouring motion (saltation).
struct PhaseChange {
  ContactPhase from = ContactPhase::contact;
  ContactPhase to = ContactPhase::contact;
  double time = 0.0;                     ///< since the start of the cycle [s]
  ChainState state = ChainState::Zero(); ///< positions and velocities do not jump
  double force = 0.0;                    ///< contact force just after a make or just before a break [N]
  /// The saltation matrix maps a small difference of two motions before the event to that after it. It is the
  /// unit matrix except for this entry, d v_drum / d x_drum [1/s]: -c/m2 where the force jumps from 0 to c d'
  /// at a make, +c/m2 where it jumps from c d' to 0 at A's break, 0 at all others. With f the right-hand side
  /// before and after, and x_drum = 0 the boundary, it is (f_after - f_before) / v_drum in the row of v_drum;
  /// condition B's break, its re-make at zero force, and the end of an overlap without force do not make f
  /// jump, so that the entry is 0 there.
  double saltation = 0.0;
  bool make() const { return to == ContactPhase::contact; }
  bool broken() const { return from == ContactPhase::contact; }
};

/// Receives each piece and each change of phase, in the order of time.
class MotionObserver {
public:
  virtual ~MotionObserver() = default;
  virtual void piece(const MotionPiece &piece, const PhaseDynamics &dynamics) = 0;
  virtual void change(const PhaseChange &change) = 0;
};

/// Solves one chain.
class ChainSolver {
public:
  /// std::invalid_argument for parameters that cannot be used.
  explicit ChainSolver(const ChainParameters &parameters);

  const ChainParameters &parameters() const { return parameters_; }
  /// Static equilibrium at t = 0 or an impact, as the direct solver starts. A contact that then begins at
  /// d = 0 is in phase `contact`.
  ChainMotion start(double impact_speed = 0.0) const;
  /// A motion at the start of a cycle: the phase follows from the state.
  ChainMotion start_at(const ChainState &state) const;
  /// k d + c d', also where no such force acts [N].
  double law(const ChainState &state) const { return -(parameters_.k * state[0] + c_ * state[1]); }
  /// Contact force in a phase [N].
  double force(ContactPhase phase, const ChainState &state) const;
  /// Continues the motion to the end of the cycle. Throws std::runtime_error if it has more than 100,000
  /// changes of phase in it.
  void finish_cycle(ChainMotion &motion, MotionObserver *observer = nullptr) const;
  /// The same to a time within the cycle [s].
  void go_to(double time, ChainMotion &motion, MotionObserver *observer = nullptr) const;
  /// Takes over a motion at a step of the soil, from the solver of the soil before. Under B the contact ends
  /// if the new k and D make its force a tension, and begins if they make it a compression.
  void take_over(const ChainSolver &before, ChainMotion &motion, MotionObserver *observer = nullptr) const;

private:
  struct Exit {
    int index = -1;
    double share = 2.0;
  };
  Exit first_exit(const MotionPiece &piece, int boundary) const;
  PhaseChange leave(ChainMotion &motion, int exit) const;

  ChainParameters parameters_;
  double c_ = 0.0;
  PhaseDynamics touching_;
  PhaseDynamics apart_;
};

/// Solves the chain as solve_direct() does; `rtol` has no effect.
DirectResult solve_closed_form(const ChainParameters &parameters, const DirectOptions &options,
                               const SolverProgress &progress = {});
/// Whole cycles from static equilibrium.
/// \param lead cycles before the first sample, in which the motion settles
DirectResult solve_closed_form(const ChainParameters &parameters, int cycles, int samples_per_cycle,
                               int lead = 0);

/// Whether the closed form has the solution within seconds: not where k or D change linearly along the way of
/// a roller that drives. It splits off one fast decay: if contact and bond both decay very fast, its pieces
/// become as short as the slower of the two.
bool closed_form_suffices(const ChainParameters &parameters, const DirectOptions &options);

/// The first s in [0, 1] where a polynomial that is not positive at s = 0 becomes positive; 2 if it does not.
/// Coefficients of s^0, s^1, ..., at most `most_terms`. No crossing is missed: an interval is discarded only
/// if the Bernstein coefficients show that the polynomial is not positive in it, or if it is shorter than
/// 1e-13.
double first_upcrossing(const double *coefficients, std::size_t terms);

/// The largest value of a polynomial for s in [0, 1], or `known` if that is larger.
double largest_value(const double *coefficients, std::size_t terms, double known);

/// Widens `min` to `max` by the values of a polynomial of `terms` terms over 0 <= s <= 1, whose coefficients
/// change their sign.
void widen(std::array<double, most_terms> &coefficients, std::size_t terms, double &min, double &max);

} // namespace drumlin::post
