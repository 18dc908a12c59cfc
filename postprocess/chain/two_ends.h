// A drum and a frame that move vertically and tilt about the way of travel, on contacts along the width of
// the drum, as a System of chain/exact_motion.h. Each contact is made and broken by itself (transition A or
// B, as in chain/parameters.h).
//
//     m2 z2'' = -m2 g + sum F_j + sum B_i - F_e          I2 th2'' = sum y_j F_j + sum y_i B_i - y_e F_e
//     m3 z3'' = -m3 g           - sum B_i                I3 th3'' =             - sum y_i B_i
//     F_j = k_j d_j + c_j d_j' in contact, else 0,       d_j = -(z2 + y_j th2)
//     B_i = k_i e_i + c_i e_i',                          e_i = z3 - z2 + y_i (th3 - th2)
//
// with 2 the drum and 3 the frame, whose centres of mass are at y = 0, y to the right along the axle, z up.
// Where a roller drives over soil that changes linearly along its way, k_j is linear in time, and c_j/k_j a
// power series in it: so is the motion.
#pragma once

#include "chain/driven_way.h"
#include "chain/exact_motion.h"
#include "chain/parameters.h"
#include "files/axle_links.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

using drumlin::AxleLink;
using drumlin::contact_columns;
using drumlin::equal_contacts;
using drumlin::most_contacts;
using drumlin::read_contacts;

/// The machine on its soil, and how it starts.
struct TwoEnds {
  /// Masses, excitation, gravity and transition; its k, D, k23 and c23 have no effect.
  ChainParameters chain;
  double drum_inertia = 0.0;  ///< about the way of travel [kg m2]
  double frame_inertia = 0.0; ///< [kg m2]
  double exciter = 0.0;       ///< place of the exciter's force [m]
  double sensor = 0.0;        ///< distance from the middle at which a_left and a_right are taken [m]
  double tilt = 0.0;          ///< of drum and frame at the start, besides that of equilibrium [rad]
  std::vector<AxleLink> contacts;
  std::vector<AxleLink> bonds;
  /// Where it drives: k and c of the contacts then follow from the halves of k there. Contacts left of the
  /// middle have equal parts of the left half, those right of it of the right one, one in the middle half as
  /// much of either; c is shared as k, and is 2 D sqrt(m2 k) in all.
  std::optional<WaySection> section;

  /// Contacts at a time since the start of the excitation [s].
  std::vector<AxleLink> contacts_at(double time) const;
  /// Empty if it can be solved; else one line that names what cannot be and what is allowed.
  std::string invalid() const;
};

/// The machine without contacts. \param roller how it tilts: what its file does not say is assumed (see
/// assumed_ends()), and so is the width if it has none
TwoEnds two_ends(const ChainParameters &chain, const Roller &roller);
/// The names of what is assumed, as those of a roller file.
std::vector<std::string> assumed_ends(const Roller &roller);
/// The width of the drum [m].
double drum_width(const Roller &roller);

/// Gives contacts left of the middle k and c that are `ratio` times those of contacts right of it, of equal
/// contacts before; a contact in the middle and the sums stay as they are.
void set_ratio(std::vector<AxleLink> &contacts, double ratio);
/// The machine over a section of its way, at its start.
TwoEnds over(TwoEnds machine, const WaySection &section);

/// Positions z_drum [m], z_frame [m], theta_drum [rad], theta_frame [rad], then their velocities.
using TwoEndsState = Eigen::Matrix<double, 8, 1>;
using TwoEndsMatrix = Eigen::Matrix<double, 8, 8>;

/// Sums over springs and dashpots along the axle: of k and k y, of the same of the rate of k, and of c and c
/// y, in N and m. With them z and theta of the drum give a force.
struct AxleSprings {
  Eigen::Vector2d k, k_rate, c;
};

/// The linear dynamics while a certain set of contacts acts.
class ContactSet {
public:
  /// \param acting bit j set: contact j acts
  /// \param time of the contacts, if they change along the way, since the start of the excitation [s]
  ContactSet(const TwoEnds &machine, std::uint32_t acting, double time = 0.0);

  double longest_piece(double /*since*/ = 0.0) const { return std::min(most_reach / rate_, longest_change_); }
  /// Motion over a piece as a polynomial in s: position[n] and velocity[n] times s^n, as MotionPiece has it.
  struct Piece {
    std::array<Eigen::Vector4d, most_terms> position, velocity;
    /// c over k of the contacts while they change.
    std::array<double, most_terms> damping;
    std::size_t terms = 0;
    double begin = 0.0, length = 0.0, end = 1.0; ///< as of MotionPiece
    bool changes = false;                        ///< whether the contacts change over it

    TwoEndsState state(double s) const;
    double drum_velocity(std::size_t n) const { return velocity[n][0]; } ///< times s^n
    /// k z + c z' of contacts, whose k at the start of the piece is given.
    void law(const AxleSprings &springs, std::array<double, most_terms> &values) const;
  };
  void expand(Piece &piece, const TwoEndsState &from, double length, double sine, double cosine) const;
  /// \param since the time of the contacts [s]
  Eigen::Vector4d acceleration(const TwoEndsState &state, double sine, double since = 0.0) const;
  /// exp(A time) applied to small differences of two motions; not where contacts change.
  TwoEndsMatrix carry(const TwoEndsMatrix &differences, double time) const;
  /// k z + c z' of the contacts that act over a piece.
  void law(const Piece &piece, std::array<double, most_terms> &values) const { piece.law(springs_, values); }

private:
  double damping_over_stiffness(double since) const;

  Eigen::Matrix4d stiffness_, damping_; ///< per mass: acceleration = -stiffness x - damping v + ...
  Eigen::Vector4d gravity_, push_;      ///< accelerations; of gravity what the springs do not carry at rest
  Eigen::Vector4d rest_;                ///< positions at rest: from there small motions keep their digits
  AxleSprings springs_;
  double omega_ = 0.0;
  double rate_ = 0.0; ///< bound of the norm of A in scaled coordinates [1/s]
  // Contacts that change: damping_ is then that of the bonds alone.
  bool changes_ = false;
  Eigen::Matrix4d contacts_, contacts_rate_; ///< stiffness of the contacts per mass, and its rate
  WaySection section_;                       ///< from the time of the contacts on
  double m2_ = 0.0;                          ///< of c = 2 D sqrt(m2 k) [kg]
  double longest_change_ = std::numeric_limits<double>::infinity(); ///< [s]
};

/// One machine on its soil.
class ManyContacts {
public:
  using State = TwoEndsState;
  using Piece = ContactSet::Piece;
  using Dynamics = ContactSet;
  static constexpr std::size_t most_contacts = post::most_contacts;
  static constexpr bool soil_may_change = true;

  /// std::invalid_argument for a machine that cannot be solved.
  explicit ManyContacts(TwoEnds machine);

  const TwoEnds &machine() const { return machine_; }
  const ChainParameters &chain() const { return machine_.chain; }
  std::size_t contacts() const { return machine_.contacts.size(); }
  /// \param time since the start of the excitation [s]
  AxleLink link(std::size_t contact, double time) const {
    return soil_changes() ? machine_.contacts_at(time)[contact] : machine_.contacts[contact];
  }
  /// z and z' of the drum, positive up.
  static double height(const State &state, const AxleLink &link) { return state[0] + link.y * state[2]; }
  static double rise(const State &state, const AxleLink &link) { return state[4] + link.y * state[6]; }
  static void level(State & /*state*/) {} // no coordinate of it is the height of one contact
  /// An event of another contact may follow at once, where the function is already below its rounding.
  static double just_after_event(double value) { return std::min(0.0, value); }
  /// With the machine's tilt.
  State at_rest() const;
  static State falling(double speed);

  class Soil {
  public:
    explicit Soil(const ManyContacts &system) : system_(system), contacts_(system.machine_.contacts) {}
    const ContactSet &at(std::uint32_t acting, double time);
    void height(const Piece &piece, std::size_t contact, double sign,
                std::array<double, most_terms> &values) const;
    void law(const Piece &piece, std::size_t contact, double sign,
             std::array<double, most_terms> &values) const;

  private:
    const ManyContacts &system_;
    std::vector<AxleLink> contacts_;
    std::optional<ContactSet> of_now_; ///< where the soil changes
  };

  const WaySection *section() const { return machine_.section ? &*machine_.section : nullptr; }
  void drive_over(const WaySection &section);
  /// A row of a history with the columns of both ends, but for its time and place.
  void record(ChainHistory &history, const ContactSet &set, std::uint32_t acting, const State &state,
              double sine, double time, double since) const;

private:
  bool soil_changes() const { return machine_.section && !machine_.section->constant(); }

  TwoEnds machine_;
  AxleMoments bond_k_, bond_c_;
  mutable std::map<std::uint32_t, ContactSet> sets_; ///< made when they are met
};

using TwoEndsMotion = MotionOf<ManyContacts>;
using TwoEndsObserver = ObserverOf<ManyContacts>;

/// Solves one machine.
class TwoEndsSolver : public SolverOf<ManyContacts> {
public:
  explicit TwoEndsSolver(TwoEnds machine) : SolverOf(ManyContacts(std::move(machine))) {}
  const TwoEnds &machine() const { return system_.machine(); }
  /// The matrix that maps small differences of two motions through the next cycle, which the motion goes.
  TwoEndsMatrix monodromy(TwoEndsMotion &motion) const;
};

extern template class SolverOf<ManyContacts>;

/// Whether the last cycles repeat, and how small differences of two motions grow.
struct TwoEndsOrbit {
  int cycles = 0; ///< after which the motion repeats to 1e-6 of its amplitude, at most 8; 0: it does not
  /// Modulus of the largest Floquet multiplier; of a motion that does not repeat the growth per cycle, mean
  /// of up to the last 100.
  double largest = 0.0;
  double of_tilt = -1.0; ///< the same of tilting alone; negative where it is coupled with bounce
};

struct TwoEndsResult : ExactSolution {
  TwoEndsOrbit orbit;
};

/// Empty if the solution takes no more than a minute; else one line that names the number of cycles.
std::string too_much_work(const TwoEnds &machine, const ExactOptions &options);

/// The history with the columns of both ends; in its events the id of contact j, counted from 1, is 1 + j. A
/// roller that drives over options.way has no orbit. Throws std::invalid_argument if it cannot be solved.
TwoEndsResult solve_two_ends(const TwoEnds &machine, const ExactOptions &options,
                             const SolverProgress &progress = {});

} // namespace drumlin::post
