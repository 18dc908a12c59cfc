#pragma once
// Base of fixes that observe chosen pairs of balls, touching or not, at the beginning and the end of each time
// step.

#include "contact/contact_observer.h"
#include "contact/contact_source.h"
#include "engine.h"

#include <map>
#include <utility>
#include <vector>

namespace LAMMPS_NS {

/// A contact observer that receives pairs by see_pair(). It keeps their overlaps and rates from the end of one
/// step to the end of the next, also while balls change ranks and the neighbour list is built anew.
///
/// see_contact() is called for touching balls only, while forces are computed; the velocities of the balls are
/// then those of half a step earlier. To locate a make or break within a step, the states before and after it
/// are needed, of which one has no contact, with the velocities that belong to the positions. These are known
/// at the end of a step.
///
/// see_pair() costs only the pairs that selects() chooses; see_contact() is called for every contact of every
/// ball. In inputs/study/in.cost_bed with 2500 discs, fix contact/energy, which receives all contacts, makes a
/// time step 1.8 times as long in LIGGGHTS and 1.6 times as long in LAMMPS; fix contact/events makes it less
/// than 2 % longer if it records the contacts of one ball.
class FixPairObserver : public drumlin::engine::GhostFix, public drumlin::ContactObserver {
public:
  FixPairObserver(LAMMPS *lammps, int narg, char **arg) : GhostFix(lammps, narg, arg) { comm_forward = 3; }

  /// The functions of a fix that this class needs; those of the derived class are added to them.
  int setmask() override;
  /// Ends the run with an error if the deck has a pair style without a contact law of the plugin.
  void init() override;
  void setup(int) override;
  void pre_exchange() override;
  void pre_neighbor() override;
  /// Calls see_pair() for each pair on this rank.
  void end_of_step() override;
  void pack_ghosts(int, const int *, double *) override;
  void unpack_ghosts(int, int, double *) override;

protected:
  /// Whether the pair of balls i and j (owned or ghosts) is observed. Called when the neighbour list is built,
  /// once for each pair on one of the ranks.
  virtual bool selects(int i, int j) const = 0;

private:
  using Tags = std::pair<int, int>; // lower first
  struct Pair {
    int i, j;
    Tags tags;
    drumlin::AnyLaw law;
    drumlin::physics::OverlapState state; // at the end of the last step
  };

  void list_pairs();

  const drumlin::ContactSource *source_ = nullptr;
  std::vector<Pair> pairs_;
  std::map<Tags, drumlin::physics::OverlapState>
      states_;                 // of all ranks' pairs, while the neighbour list is built
  bool pairs_outdated_ = true; // the neighbour list was built since list_pairs()
};

} // namespace LAMMPS_NS
