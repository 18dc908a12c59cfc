#pragma once
// fix guard: stops a run whose numbers have gone bad or soon will. See plugin/doc/fix_guard.md.

#include "engine.h"
#include "contact/contact_observer.h"
#include "contact/contact_source.h"

#include <limits>
#include <string>

namespace LAMMPS_NS {

/// Ends the run on all ranks, in one line, when a position, velocity or force of the group is no longer
/// finite, when the time step is beyond the critical one of the contacts and bonds that exist, or when an
/// overlap is too large to mean anything.
class FixGuard : public drumlin::engine::GhostFix, public drumlin::ContactObserver {
public:
  FixGuard(LAMMPS *, int, char **);

  int setmask() override;
  void setup_pre_force(int) override;
  void setup(int) override;
  void initial_integrate(int) override;
  void pre_force(int) override;
  void end_of_step() override;
  void pack_gathered(int, int, double *) override;
  void join_gathered(int, const int *, const double *) override;
  /// Critical step at the last look, s; infinite without links.
  double compute_scalar() override { return critical_.value; }
  /// 0: pi/(w0 dt) of the fastest link; 1: largest overlap, as a share of the smaller radius.
  double compute_vector(int) override;
  void see_contact(const drumlin::ContactRecord &) override;
  void see_bond(int ball, int partner, const drumlin::physics::LinkModes &modes) override {
    see(ball, partner, modes, 0.0);
  }

private:
  /// An extreme over all balls and where it is.
  struct Finding {
    double value, ball, partner; // IDs; partner 0: a wall
  };
  /// What a ball's links do to it; numbers throughout, for other ranks.
  struct Ball {
    drumlin::physics::LoadedBall loads;
    double fastest = 0.0;                                      // largest k/m_eff of its links, 1/s^2
    double shortest = std::numeric_limits<double>::infinity(); // critical step of a link alone, s
    double overlap = 0.0;                                      // largest share
    double fastest_partner = 0.0;                              // IDs
    double shortest_partner = 0.0;
    double overlap_partner = 0.0;

    void join(const Ball &other);
  };

  void see(int i, int partner, const drumlin::physics::LinkModes &modes, double overlap);
  void begin_look();
  void end_look();
  void check_numbers();
  void judge(bigint step) const;
  double steps_per_contact() const;
  void tell_at_set_up();

  bigint every_ = 1;     // steps between looks at the numbers
  bigint links_ = 100;   // and at the links
  double step_ = 1.0;    // largest allowed share of the critical step
  double overlap_ = 0.5; // and of the smaller radius
  bool watch_ = true;    // off: the fix is there and costs nothing
  bool at_set_up_ = false;
  std::vector<Ball> balls_;
  Finding critical_{}, fastest_{}, deepest_{};
  std::string told_;
  const drumlin::ContactSource *source_ = nullptr; // of the masses that contacts feel
};

} // namespace LAMMPS_NS
