#pragma once
// fix bond/spring: a bonded spring-dashpot between two balls. See plugin/doc/fix_bond_spring.md.

#include "engine.h"
#include "contact/contact_observer.h"
#include "physics/bond_law.h"

#include <optional>

namespace LAMMPS_NS {

/// Spring k and dashpot c along the line of two balls, given by tag; tension positive. The two balls'
/// positions and velocities are shared over all ranks, so any distance and decomposition will do.
class FixBondSpring : public drumlin::engine::GhostFix {
public:
  FixBondSpring(LAMMPS *, int, char **);

  int setmask() override;
  void init() override;
  void setup_pre_neighbor() override;
  void pre_neighbor() override;
  void setup(int) override;
  void post_force(int) override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  /// Energy in the spring, J.
  double compute_scalar() override { return acted_.stored; }
  /// 0: stretch, m; 1: its rate as the force saw it, m/s; 2: force that acted in this step, N, tension
  /// positive; 3: power of the dashpot, W; 4: 1 while whole.
  double compute_vector(int) override;

  /// Force and power at the positions and velocities of now; collective.
  drumlin::physics::BondForce evaluate();
  /// Distance of now over the length without force, m; collective.
  double stretch() { return current_length_ ? 0.0 : share_state().distance - bond_.length; }

private:
  struct State {
    double distance;
    double rate;                     // with the velocities of now: half-step ones while forces are computed
    double rate_before;              // with the velocities at the begin of the step
    double inverse_masses;           // sum of both balls
    double damping_over_mass;        // sum of c/m over the links of both balls
    std::array<double, 3> direction; // from i to j
  };
  drumlin::physics::BondForce under(double tension) const;
  drumlin::physics::LinkModes modes(double mass) const;
  State share_state();
  double predicted_rate() const;
  void pull(double tension);
  void tally(double tension);
  void take_note(const drumlin::physics::BondForce &acting);
  void find_balls();

  static constexpr std::array<double, 2> sign_{1.0, -1.0}; // tension pulls i towards j and j towards i
  std::array<int, 2> tags_{};
  std::array<int, 2> local_{-1, -1}; // indices of owned balls, -1 for those of other ranks
  drumlin::physics::Bond bond_;
  bool current_length_ = true; // the length is the distance at the first set-up
  bool whole_ = true;
  class FixStepping *stepping_ = nullptr; // none under stock stepping
  bool echoed_ = false;
  State state_{};
  drumlin::ContactObservers observers_;
  drumlin::physics::BondForce acted_{};
};

} // namespace LAMMPS_NS
