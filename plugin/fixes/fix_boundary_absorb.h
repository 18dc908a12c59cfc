#pragma once
// fix boundary/absorb: a boundary of balls that absorbs waves. See plugin/doc/fix_boundary_absorb.md.

#include "contact/contact_observer.h"
#include "contact/deck_check.h"
#include "engine.h"
#include "physics/bodies/absorbing_boundary.h"

#include <array>
#include <utility>
#include <vector>

namespace LAMMPS_NS {

/// Connects each ball of the group to its position at the definition of the fix by the springs and dashpots
/// that replace the ground beyond the boundary, and can keep the force that held the ball before as a
/// constant force. Positions and constant forces belong to the balls, move with them between ranks and are
/// restarted.
class FixBoundaryAbsorb : public Fix {
public:
  FixBoundaryAbsorb(LAMMPS *, int, char **);
  ~FixBoundaryAbsorb() override;

  int setmask() override;
  void init() override;
  void setup_pre_neighbor() override;
  void pre_neighbor() override;
  void setup(int) override;
  void initial_integrate(int) override;
  void post_force(int) override;
  void end_of_step() override;
  void grow_arrays(int) override;
  void copy_arrays(int, int, int) override;
  void set_arrays(int) override;
  int pack_exchange(int, double *) override;
  int unpack_exchange(int, double *) override;
  int pack_restart(int, double *) override;
  void unpack_restart(int, int) override;
  int maxsize_restart() override;
  int size_restart(int) override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  double memory_usage() override;
  /// 0: energy in the springs, J; 1: heat of the dashpots since the first set-up, J; 2: work of the constant
  /// forces since the definition of the fix, J; 3 to 5: force on the balls, N; 6: mean displacement along the
  /// normal, m. Collective.
  double compute_vector(int) override;

  /// Energies and forces of the boundary, summed over all its balls, for the balances of a scene.
  struct Totals {
    double stored = 0.0;           ///< J, in the springs
    double heat = 0.0;             ///< J, dissipated by the dashpots since the first run began
    double work = 0.0;             ///< J, of the constant forces since the definition of the fix
    std::array<double, 3> force{}; ///< N, on the balls
  };
  /// At the end of the last step. Collective.
  Totals totals() const;
  /// Unit vector out of the model.
  const std::array<double, 3> &normal() const { return ball_.normal; }

private:
  using Vector = drumlin::physics::Vec3;
  /// What is kept for a ball.
  struct Grounded {
    Vector reference{}; ///< position, m
    Vector constant{};  ///< force, N
    Vector force{};     ///< of springs and dashpots in the last step, N
  };
  static constexpr int exchanged = 9; // numbers of a Grounded, in its order

  void parse(int narg, char **arg);
  void refuse_earlier_integration() const;
  Grounded &grounded(int i) { return balls_[static_cast<std::size_t>(i)]; }
  const Grounded &grounded(int i) const { return balls_[static_cast<std::size_t>(i)]; }
  Vector displacement(int i) const;
  Vector constant_force(int i) const;
  Vector force_of_step(int i);
  void close_coupled();
  void tell_observers();
  void add(int i, const Vector &more);
  void announce();
  double heat_rate() const;
  void echo();

  drumlin::physics::Ground ground_;
  drumlin::physics::GroundedBall ball_; // the links of each ball
  bool keep_static_ = false;            // whether there are constant forces
  bool static_known_ = false;
  bool has_acted_ = false;                // in a step, so that Grounded::force is that of its end,
  std::vector<double> links_;             // with this normal, stiffness and damping
  class FixStepping *stepping_ = nullptr; // nullptr under stock stepping
  drumlin::ContactObservers observers_;
  std::vector<Grounded> balls_; // an entry for each ball of this rank
  std::vector<std::pair<int, drumlin::physics::CoupledGround>> coupled_; // of this step
  double count_ = 0.0;                                                   // number of balls of the group
  double heat_ = 0.0;  // J, dissipated since the first run began, sum over all ranks
  double power_ = 0.0; // W, dissipated at the end of the last step, sum over all ranks
  drumlin::DeckCheck deck_check_;
  double dt_ = 0.0; // s, of the present step: at its end another fix may set that of the next
  bool echoed_ = false;
};

} // namespace LAMMPS_NS
