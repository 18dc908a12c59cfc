#pragma once
// fix bond/spring: a bonded spring-dashpot between two balls. See plugin/doc/fix_bond_spring.md.

#include "contact/deck_check.h"
#include "contact/fix_between_runs.h"
#include "engine.h"
#include "contact/contact_observer.h"
#include "fixes/fix_clump.h"
#include "physics/bodies/bond_law.h"

#include <optional>

namespace LAMMPS_NS {

/// Spring and dashpot in parallel along the line of centres of two balls, which are given by their IDs. All
/// ranks know the positions and velocities of the two balls, so that these may be at any distance and on any
/// ranks.
class FixBondSpring : public drumlin::engine::GhostFix {
public:
  FixBondSpring(LAMMPS *, int, char **);

  void added() override;
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
  /// 0: stretch, m; 1: its rate with which the force was computed, m/s; 2: force that acted in this step, N,
  /// positive in tension; 3: power of the dashpot, W; 4: 1 while the bond is not broken.
  double compute_vector(int) override;

  /// Force and power at the present positions and velocities; zero when the bond is broken. Collective.
  drumlin::physics::BondForce evaluate();
  /// Place of ball i along a direction, without the jumps at periodic boundaries, m. Collective.
  double place(const std::array<double, 3> &direction) const;
  /// Present distance less the length without force, m; 0 before the length is known. Collective.
  double stretch() { return current_length_ ? 0.0 : gather_state().distance - bond_.length; }

private:
  struct State {
    double distance;
    double rate; // with the present velocities: those of the middle of the step while forces are computed
    double rate_before;                      // with the velocities at the beginning of the step
    std::array<double, 2> inverse_mass;      // of each ball along the bond; 0 if forces do not move it there
    double inverse_masses;                   // their sum
    double damping_over_mass;                // FixStepping::damping_over_mass() of both balls
    std::array<double, 3> direction;         // from i to j
    std::array<double, 3> velocity_of_image; // of the image of j that is nearest to i, relative to j
  };
  drumlin::physics::BondForce bond_under(double tension) const;
  drumlin::physics::LinkModes modes(std::size_t ball) const;
  State gather_state();
  double predicted_rate() const;
  void post_force_second_order();
  void apply(double tension);
  void tally(double tension);
  void store(const drumlin::physics::BondForce &acting);
  void find_balls();

  static constexpr std::array<double, 2> sign_{1.0, -1.0}; // tension pulls i towards j and j towards i
  std::array<int, 2> tags_{};
  std::array<int, 2> local_{-1, -1}; // indices of the balls; -1 if another rank owns the ball
  drumlin::physics::Bond bond_;
  bool current_length_ = true; // the length is the distance at the first set-up
  bool whole_ = true;
  int numbering_ = 0;                     // FixBetweenRuns::numbering() when the deck gave the IDs
  class FixStepping *stepping_ = nullptr; // nullptr under stock stepping
  Clumps clumps_;                         // since the initialization of the run
  drumlin::DeckCheck deck_check_;
  bool echoed_ = false;
  bool has_acted_ = false; // in a step, so that acted_ is the force at its end
  bool continues_ = false; // whether the run continues from that step, under second-order stepping
  State state_{};
  drumlin::ContactObservers observers_;
  drumlin::physics::BondForce acted_{};
};

} // namespace LAMMPS_NS
