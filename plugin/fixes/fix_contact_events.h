#pragma once
// fix contact/events: makes and breaks of contact, located within the step. See
// plugin/doc/fix_contact_events.md.

#include "engine.h"
#include "support/clock.h"
#include "contact/contact_source.h"
#include "support/output_file.h"
#include "physics/event_location.h"

#include <map>

namespace LAMMPS_NS {

/// In every step finds the pairs of two types, or of two groups, or of the group, whose contact has begun or ended since the
/// step before, and writes each make and break once, on any number of ranks.
///
/// Other fixes receive the contacts of a time step as a ContactObserver. This fix compares the overlaps of pairs by itself instead:
/// - Under `stepping stock` without friction nothing is stored for a contact from one time step to the next. The loop over contacts
///   therefore does not know whether a contact is new.
/// - The time of a make is computed from the overlap and its rate of change at the time step before the contact, and the time of a
///   break from those at the time step after it. The balls do not touch then, and an observer is called for touching balls only. An
///   observer could use the velocities half a time step earlier. The time of a make would then be wrong by up to a dt^2 / (8 v), with
///   the relative acceleration a and the relative speed v of the balls: 1.5e-8 s in case II of the chain.
/// - An observer is called for every contact of every ball. In inputs/study/in.cost_bed with 2500 discs, the observer
///   fix contact/energy makes a time step 1.8 times as long in LIGGGHTS and 1.6 times as long in LAMMPS. This fix makes it less than
///   2 % longer if it records the contacts of one ball.
class FixContactEvents : public drumlin::engine::GhostFix {
public:
  FixContactEvents(LAMMPS *, int, char **);

  int setmask() override;
  void init() override;
  void setup(int) override;
  void pre_exchange() override;
  void pre_neighbor() override;
  void end_of_step() override;
  void post_run() override;
  void pack_ghosts(int, const int *, double *) override;
  void unpack_ghosts(int, int, double *) override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  /// Number of events written so far.
  double compute_scalar() override;

private:
  using Tags = std::pair<int, int>; // lower first
  struct Pair {
    int i, j;
    Tags tags;
    drumlin::AnyLaw law;
    drumlin::physics::OverlapState state; // at the end of the last step
  };
  struct Event {
    double time;
    int make;
    double overlap, rate, force;
    int tag_i, tag_j;
  };

  bool is_selected(int i, int j) const;
  void list_pairs();
  void refresh_ghost_velocities();
  void write_out();

  std::array<int, 2> types_{0, 0};     // 0: all pairs of the group
  std::array<int, 2> groupbits_{0, 0}; // of keyword between; 0: not given
  drumlin::OutputFile file_;
  const drumlin::ContactSource *source_ = nullptr;
  drumlin::Clock clock_;
  std::vector<Pair> pairs_;
  std::map<Tags, drumlin::physics::OverlapState>
      states_;                 // of all ranks' pairs, while the neighbour list is built
  bool pairs_outdated_ = true; // the neighbour list was built since list_pairs()
  std::vector<Event> pending_; // not yet written
  bigint count_ = 0;
};

} // namespace LAMMPS_NS
