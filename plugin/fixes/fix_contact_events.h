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
/// It is no ContactObserver, for three reasons. State: under `stepping stock` without friction a contact keeps nothing from one
/// step to the next, so that the loop over contacts cannot tell that one has begun. Accuracy: the time of a make is found from
/// the overlap and its rate at the step before, and that of a break from those at the step after, when the balls do not touch. An
/// observer receives only balls that touch. If it took their velocities of half a step before instead, the time of a make would be
/// wrong by up to a dt^2 / (8 v), with the relative acceleration a and speed v: 1.5e-8 s in the chain of case II. Cost: an observer
/// receives the contacts of all balls in every step. In the bed of inputs/study/in.cost_bed, with 2500 discs, fix contact/energy,
/// which is an observer, makes a time step 1.8 times as long in LIGGGHTS and 1.6 times in LAMMPS. This fix, used for the contacts of
/// one ball, makes it less than 2 % longer.
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
