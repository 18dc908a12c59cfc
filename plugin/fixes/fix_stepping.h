#pragma once
// The helper of second-order stepping, made by the pair style: what the contact law needs to know of the step before.

#include "engine.h"
#include "physics/stepping.h"

#include <functional>

namespace LAMMPS_NS {

/// Keeps for each ball its velocity at the begin of the step and the sum c/m over its contacts, on ghosts too, and hands
/// the forces of a step in which contact was made back to their physical value before the next step starts.
///
/// Nothing of it is restart state: both follow from the positions and velocities at set-up.
class FixStepping : public Fix {
public:
  FixStepping(LAMMPS *, int, char **);
  ~FixStepping() override;

  /// The helper of this engine instance, or nullptr under stock stepping.
  static FixStepping *find(LAMMPS *lmp);
  /// The helper of this engine instance, made if there is none.
  static FixStepping *provide(LAMMPS *lmp);

  int setmask() override;
  void init() override;
  void setup_pre_force(int) override;
  void post_integrate() override;
  void pre_force(int) override;
  void pre_final_integrate() override;
  void end_of_step() override;
  void grow_arrays(int) override;
  void copy_arrays(int, int, int) override;
  void set_arrays(int) override;
  int pack_exchange(int, double *) override;
  int unpack_exchange(int, double *) override;
  int pack_comm(int, int *, double *, int, int *) override;
  void unpack_comm(int, int, double *) override;
  double memory_usage() override;

  double dt() const { return update->dt; }
  const double *velocity_before(int i) const { return row(i); } ///< v(t), m/s, owned balls and ghosts
  /// Takes note, after the integration and before the ghosts hear of it, that a force on owned ball i is known to change in
  /// this step: 2 v+ - velocity_before is then the velocity with the new force.
  void foresee(int i, const std::array<double, 3> &change) {
    for (std::size_t a = 0; a < 3; ++a)
      state_[i][a] -= 0.5 * update->dt * change[a] / atom->rmass[i];
  }
  double damping_over_mass(int i) const { return row(i)[3]; } ///< sum of c/m, 1/s, owned balls and ghosts

  /// Counts a contact's c, N s/m, on owned ball i for the next step.
  /// \param mass gives the mass of the ball as its contacts feel it, kg, infinite if it is fixed; asked for once in a run
  template <class Mass>
  void add_damping(int i, double c, const Mass &mass) {
    double *ball = row(i);
    ball[4] += c;
    if (ball[5] < 0.0) ball[5] = 1.0 / mass();
  }
  /// Forces on an owned ball after the closing half kick of this step: `rest` stays for the next opening half kick, `shift`
  /// acts in the next drift only.
  void add_after_kick(int i, const std::array<double, 3> &rest, const std::array<double, 3> &shift) {
    later_.push_back({i, rest, shift});
  }

  /// A contact that is solved for together with the others, when all forces of the step are known: see coupled_force().
  struct Coupled {
    int i, j; ///< j < 0: a wall
    std::array<double, 3> normal;
    drumlin::physics::CoupledDashpot dashpot; ///< sees the rate of a resting wall
    double share;                             ///< of the force that acts, 1 but for a mesh
    double *force;                            ///< takes the force, N
  };
  /// A contact to be filled in, in its place: copying it as a whole would wait for its parts to be written.
  Coupled &couple() { return coupled_.emplace_back(); }
  /// The same for a link whose balls may be on any ranks: `close` is called on all ranks, when v* is known, and adds to the forces.
  void couple(const std::function<void()> &close) { coupled_links_.push_back(close); }
  /// v*, m/s, of an owned ball: in `close` only.
  const double *predicted_velocity(int i) const { return state_[i]; }
  /// Adds to the force on an owned ball what came too late for the constraints, and to what they say they took.
  void add_force(int i, double factor, const std::array<double, 3> &vector);

private:
  struct Later {
    int i;
    std::array<double, 3> rest, shift;
  };
  /// A fix that takes forces away, and its own sum of what it took; nullptr if it has none that acting again would spoil.
  struct Constraint {
    Fix *fix;
    double *reaction;
  };
  static constexpr int columns = 6;
  /// Rows follow one another: this spares the inner loop a pointer per ball.
  double *row(int i) const { return state_[0] + static_cast<std::ptrdiff_t>(i) * columns; }
  void merge_later();
  void constrain(bool any) const;

  double **state_ =
      nullptr; // per ball: v(t), at the end of a step v* (3), sum of c/m of the last step; sum of c of this step, and 1/m
  std::vector<Coupled> coupled_; // of this step
  std::vector<std::function<void()>> coupled_links_;
  std::vector<Later> later_;            // of this step
  std::vector<Later> shifts_;           // in the opening half kick, not yet taken back
  std::vector<Constraint> constraints_; // they act again on forces that were put back
};

} // namespace LAMMPS_NS
