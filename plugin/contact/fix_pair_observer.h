#pragma once
// Base class of fixes that follow chosen pairs of balls from time step to time step, whether they touch or
// not.

#include "contact/contact_observer.h"
#include "contact/contact_source.h"
#include "engine.h"

#include <map>
#include <utility>
#include <vector>

namespace LAMMPS_NS {

/// Stores the overlap of each chosen pair and its rate at the end of a time step, and passes them to
/// see_pair() at the end of the next one, together with the new values. The values are kept when balls move
/// to other ranks and when the neighbour list is built again.
///
/// The time at which a contact begins or ends is found from the overlap and its rate at the beginning and at
/// the end of a time step. ContactObserver::see_contact() does not give these values, for two reasons. It is
/// called for touching balls only, but before a contact begins and after it has ended the balls do not touch.
/// And it is called while forces are computed, when velocity Verlet has only the velocities of half a step
/// earlier.
///
/// The computing time grows with the number of chosen pairs, not with the number of contacts in the bed.
class FixPairObserver : public drumlin::engine::GhostFix, public drumlin::ContactObserver {
public:
  FixPairObserver(LAMMPS *lammps, int narg, char **arg) : GhostFix(lammps, narg, arg) { comm_forward = 3; }

  /// Tells the engine at which points of a time step it must call this fix. A derived class that needs
  /// further calls overrides this function and adds them to the value that is returned here.
  int setmask() override;
  /// Stops the engine with an error message if the pair style is not one of this plugin.
  void init() override;
  void setup(int) override;
  void post_integrate() override;
  void pre_exchange() override;
  void pre_neighbor() override;
  /// Passes the chosen pairs to see_pair(). Of several ranks one passes a pair.
  void end_of_step() override;
  void pack_ghosts(int, const int *, double *) override;
  void unpack_ghosts(int, int, double *) override;

protected:
  /// Whether the balls i and j (indices of owned balls or ghosts) are a chosen pair. Called for all
  /// neighbours after the neighbour list has been built.
  virtual bool selects(int i, int j) const = 0;

private:
  using Tags = std::pair<int, int>; // lower first
  /// At the end of the last step.
  struct State {
    drumlin::physics::OverlapState overlap;
    double memory; // what the contact remembers for its law
  };
  struct Pair {
    int i, j;
    Tags tags;
    const double *memory; // of the contact; nullptr: its law has none
    drumlin::PairLaw law; // of the present step, with what the contact remembered at its beginning
    State state;
  };

  void list_pairs();

  const drumlin::ContactSource *source_ = nullptr;
  double dt_ = 0.0; // s, of the present step; at the end of a step another fix may have set that of the next
  std::vector<Pair> pairs_;
  std::map<Tags, State> states_; // of the pairs of all ranks, until the next list_pairs()
  bool pairs_outdated_ = true;   // whether the neighbour list has been built since list_pairs()
};

} // namespace LAMMPS_NS
