#pragma once
// fix guard: ends a run in which a number is not finite, the time step is unstable or an overlap is too
// large. See plugin/doc/fix_guard.md.

#include "engine.h"
#include "contact/contact_observer.h"
#include "contact/contact_source.h"
#include "contact/deck_check.h"

#include <limits>
#include <string>

namespace LAMMPS_NS {

/// Ends the run on all ranks, with one line, when a position, velocity or force of a ball of the group is not
/// finite, when the time step is longer than an allowed fraction of the critical step of the present contacts
/// and bonds, or when an overlap is larger than an allowed share of the smaller radius. A link is a contact
/// or a bond.
class FixGuard : public drumlin::engine::GhostFix, public drumlin::ContactObserver {
public:
  FixGuard(LAMMPS *, int, char **);

  int setmask() override;
  void init() override;
  void setup_pre_force(int) override;
  void setup(int) override;
  void initial_integrate(int) override;
  void setup_pre_neighbor() override;
  void pre_exchange() override;
  void pre_neighbor() override;
  void pre_force(int) override;
  void end_of_step() override;
  void pack_gathered(int, int, double *) override;
  void join_gathered(int, const int *, const double *) override;
  /// Critical step at the last check of the links, s; infinite if there was none.
  double compute_scalar() override { return critical_.value; }
  /// 0: pi/(w0 dt), w0^2 = k/m_eff, of the link with the largest w0; 1: largest overlap, as a share of the
  /// smaller radius.
  double compute_vector(int) override;
  void see_contact(const drumlin::ContactRecord &) override;
  void see_bond(int ball, int partner, const drumlin::physics::LinkModes &modes) override {
    see(ball, partner, modes, 0.0);
  }

private:
  /// The smallest or largest value of a quantity over all balls of all ranks, with the IDs of the ball and of
  /// its partner in the link; partner 0: a wall.
  struct Extreme {
    double value, ball, partner;
  };
  /// Sums and extremes over the links of a ball. All members are doubles, since the struct is sent to other
  /// ranks as an array of doubles.
  struct Ball {
    drumlin::physics::LoadedBall loads;
    double fastest = 0.0; // largest k/m_eff of its links, 1/s^2
    double shortest =
        std::numeric_limits<double>::infinity(); // shortest critical step of one of its links alone, s
    double overlap = 0.0;                        // largest overlap over the smaller radius
    double fastest_partner = 0.0;                // IDs of the partners in these links
    double shortest_partner = 0.0;
    double overlap_partner = 0.0;

    void join(const Ball &other);
  };

  /// A ball when the neighbour list was built.
  struct Listed {
    double tag;              // ID
    std::array<double, 3> x; // m
    double radius;           // m
  };

  void check_lists() const;
  void see(int i, int partner, const drumlin::physics::LinkModes &modes, double overlap);
  void begin_links();
  void end_links();
  void check_numbers();
  void check_limits(bigint step) const;
  double steps_per_contact() const;
  void log_at_setup();

  bool on_ = true;              // off: no check
  bigint every_ = 1;            // steps between checks of the numbers
  bigint links_ = 100;          // steps between checks of contacts and bonds
  double step_ = 1.0;           // largest allowed time step over the critical step
  double overlap_ = 0.5;        // largest allowed overlap over the smaller radius
  double links_dt_ = 0.0;       // time step at the last check of contacts and bonds, s
  bool links_of_setup_ = false; // whether the links of the set-up are still to be checked
  int frozen_ = 0;              // bits of the groups of fixes freeze
  std::vector<Listed> listed_;  // of this rank
  std::vector<Ball> balls_;     // of this rank, ghosts included with newton on
  Extreme critical_{}, fastest_{}, deepest_{};
  std::string logged_; // the last line of log_at_setup()
  drumlin::DeckCheck deck_check_;
  const drumlin::ContactSource *source_ = nullptr; // gives the effective masses of contacts
};

} // namespace LAMMPS_NS
