// The chain soil - drum - frame as a System of chain/exact_motion.h: one contact on soil that is constant, or
// changes in steps. A mode that decays very fast is split off, so that its pieces need not be short.
#pragma once

#include "chain/exact_motion.h"
#include "chain/parameters.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

namespace drumlin::post {

/// x_drum [m], v_drum [m/s], x_frame [m], v_frame [m/s]; origins as in chain.csv.
using ChainState = Eigen::Vector4d;

/// The motion over one piece as a polynomial in s = (t - begin) / length, 0 <= s <= end: state(s) = sum of
/// coefficient[n] s^n.
struct MotionPiece {
  std::array<std::array<double, 4>, most_terms> coefficient; ///< of x_drum, v_drum, x_frame, v_frame
  std::size_t terms = 0;
  double begin = 0.0;  ///< since the start of the cycle [s]
  double length = 0.0; ///< time from s = 0 to s = 1 [s]
  double end = 1.0;    ///< value of s at which the piece ends, 0 to 1: less than 1 if an event ends it

  /// The state at s.
  ChainState state(double s) const;
  /// The drum's acceleration at s [m/s2].
  double drum_acceleration(double s) const;
  double drum_velocity(std::size_t n) const { return coefficient[n][1]; } ///< times s^n
};

/// The linear dynamics of one phase, y' = A y + forces.
class PhaseDynamics {
public:
  PhaseDynamics() = default;
  /// \param k, c of the contact, both zero without one
  PhaseDynamics(const ChainParameters &parameters, double k, double c);

  /// The longest allowed piece [s], `since` seconds after the phase began. While a heavily damped part of the
  /// motion still decays pieces must be short; later the slower rest of the motion sets their length.
  double longest_piece(double since = std::numeric_limits<double>::infinity()) const;
  /// The motion from the state `from` over `length`, with the excitation from the phase omega t of `sine` and
  /// `cosine`.
  void expand(MotionPiece &piece, const ChainState &from, double length, double sine, double cosine) const;
  /// exp(A time) applied to a small difference of two motions, for a time no longer than longest_piece()
  /// after the fast part has decayed.
  ChainState carry(const ChainState &difference, double time) const;
  /// k z + c z' of the contact over a piece.
  void law(const MotionPiece &piece, std::array<double, most_terms> &values) const;

private:
  using Rows = std::array<std::array<double, 4>, 4>;

  double k_ = 0.0, c_ = 0.0;                         // of the contact, if it acts
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

/// The chain.
class OneContact {
public:
  using State = ChainState;
  using Piece = MotionPiece;
  using Dynamics = PhaseDynamics;
  static constexpr std::size_t most_contacts = 1;
  static constexpr bool soil_may_change = false;

  /// std::invalid_argument for parameters that cannot be used.
  explicit OneContact(const ChainParameters &parameters);

  const ChainParameters &chain() const { return parameters_; }
  static std::size_t contacts() { return 1; }
  AxleLink link(std::size_t /*contact*/, double /*time*/) const { return {0.0, parameters_.k, c_}; }
  static double height(const State &state, const AxleLink & /*link*/) { return state[0]; }
  static double rise(const State &state, const AxleLink & /*link*/) { return state[1]; }
  static void level(State &state) { state[0] = 0.0; }
  static double just_after_event(double /*rounding*/) { return 0.0; }
  State at_rest() const;
  static State falling(double speed) { return {0.0, -speed, 0.0, -speed}; }

  class Soil {
  public:
    explicit Soil(const OneContact &chain) : chain_(chain) {}
    const PhaseDynamics &at(std::uint32_t acting, double /*time*/) const {
      return acting != 0 ? chain_.touching_ : chain_.apart_;
    }
    void height(const MotionPiece &piece, std::size_t /*contact*/, double sign,
                std::array<double, most_terms> &values) const {
      for (std::size_t n = 0; n < piece.terms; ++n)
        values[n] = sign * piece.coefficient[n][0];
    }
    void law(const MotionPiece &piece, std::size_t /*contact*/, double sign,
             std::array<double, most_terms> &values) const {
      const double k = sign * chain_.parameters_.k, c = sign * chain_.c_;
      for (std::size_t n = 0; n < piece.terms; ++n)
        values[n] = k * piece.coefficient[n][0] + c * piece.coefficient[n][1];
    }

  private:
    const OneContact &chain_;
  };

  const WaySection *section() const { return section_ ? &*section_ : nullptr; }
  /// std::invalid_argument for a section whose soil changes linearly.
  void drive_over(const WaySection &section);

  /// k d + c d', also where no such force acts [N].
  double law(const State &state) const { return -(parameters_.k * state[0] + c_ * state[1]); }
  /// The contact's force if it acts [N].
  double force(const State &state) const {
    return parameters_.transition == Transition::B ? std::max(0.0, law(state)) : law(state);
  }
  /// A row of a history, but for its time and place.
  void record(ChainHistory &history, const PhaseDynamics &dynamics, std::uint32_t acting, const State &state,
              double sine, double time, double since) const;

private:
  ChainParameters parameters_;
  double c_ = 0.0;
  PhaseDynamics touching_;
  PhaseDynamics apart_;
  std::optional<WaySection> section_;
};

using ChainMotion = MotionOf<OneContact>;
using MotionObserver = ObserverOf<OneContact>;

/// Solves one chain.
class ChainSolver : public SolverOf<OneContact> {
public:
  explicit ChainSolver(const ChainParameters &parameters) : SolverOf(OneContact(parameters)) {}
  const ChainParameters &parameters() const { return system_.chain(); }
};

extern template class SolverOf<OneContact>;

} // namespace drumlin::post
