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
class FixStepping : public drumlin::engine::GhostFix {
public:
  FixStepping(LAMMPS *, int, char **);
  ~FixStepping() override;

  /// The helper of this engine instance, or nullptr under stock stepping.
  static FixStepping *find(LAMMPS *lmp);
  /// The helper of this engine instance, made if there is none.
  static FixStepping *provide(LAMMPS *lmp);
  /// To be called when the pair style has another stepping or goes: find() then finds none. The fix stays at its place among the others,
  /// without a part in the run, until provide() asks for it again.
  static void dismiss(LAMMPS *lmp);

  int setmask() override;
  void init() override;
  void setup_pre_exchange() override;
  void setup_pre_force(int) override;
  void post_integrate() override;
  void pre_exchange() override;
  void pre_force(int) override;
  void close_forces() override;
  void end_of_step() override;
  void grow_arrays(int) override;
  void copy_arrays(int, int, int) override;
  void set_arrays(int) override;
  int pack_exchange(int, double *) override;
  int unpack_exchange(int, double *) override;
  void pack_ghosts(int, const int *, double *) override;
  void unpack_ghosts(int, int, double *) override;
  void pack_gathered(int, int, double *) override;
  void join_gathered(int, const int *, const double *) override;
  double memory_usage() override;

  bool in_setup() const { return in_setup_; } ///< velocities belong to the time of the positions
  /// Whether this is a step, in which no dashpot is heavy and none has to be counted.
  bool light() const { return light_; }
  /// Whether this rank takes note of forces on ball i: an owned one, or with newton on, where no other rank meets the contact, a ghost
  /// on behalf of its owner; false for a wall's -1.
  bool takes(int i) const { return i >= 0 && (i < atom->nlocal || force->newton_pair); }
  double dt() const { return dt_; }                             ///< s
  const double *velocity_before(int i) const { return row(i); } ///< v(t), m/s, owned balls and ghosts
  /// Takes note, after the integration and before the ghosts hear of it, that a force on owned ball i is known to change in
  /// this step: 2 v+ - velocity_before is then the velocity with the new force.
  void foresee(int i, const std::array<double, 3> &change) {
    for (std::size_t a = 0; a < 3; ++a)
      velocity_[i][a] -= 0.5 * update->dt * change[a] / atom->rmass[i];
  }
  /// Sum of c/m in the last step, 1/s, of owned balls and ghosts; 0 if none could be heavy: see expect_contacts().
  double damping_over_mass(int i) const { return counted_ ? row(i)[sum] : 0.0; }
  /// Whether the contacts of this step are to be counted with add_damping().
  bool counting() const { return counting_; }
  /// Counts the c, N s/m, of a contact of ball i for the next step; with newton off what a ghost gets is forgotten.
  void add_damping(int i, double c) { damping_[static_cast<std::size_t>(i)] += c; }
  /// Announces, before each search for neighbours (pre_neighbor), a link on owned ball i that is no contact.
  void expect(int i, double k, double c) { expected_.push_back({i, k, c}); }
  /// Forces after the closing half kick of this step on a ball that takes() them: `rest` stays for the next opening half kick,
  /// `shift` acts in the next drift only.
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
  const double *predicted_velocity(int i) const { return velocity_[i]; }
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
    bool joins; ///< the balls of its group
  };
  struct Expected {
    int i;
    double k, c;
  };
  /// Of a row: what ghosts need, and the place of the sum of c/m behind the velocity. Side by side, the inner loop meets both at once.
  static constexpr int shared = 4, sum = 3;
  /// Rows follow one another: this spares the inner loop a pointer per ball.
  double *row(int i) const { return velocity_[0] + static_cast<std::ptrdiff_t>(i) * shared; }
  void expect_contacts();
  void gather(std::size_t numbers);
  void solve_coupled();
  void send_later();
  void merge_later();
  void constrain(bool any) const;

  bool in_use_ = true;
  bool in_setup_ = false;
  bool light_ = false;
  bool counting_ = false; // whether the contacts of this step are counted
  bool counted_ = false;  // whether those of the last were
  double dt_ = 0.0;
  double expected_dt_ = 0.0;       // that counting_ was chosen for
  std::vector<Expected> expected_; // links that are no contacts
  // Of each ball:
  double **velocity_ = nullptr;      // v(t), at the end of a step v*, m/s; sum of c/m in the last step, 1/s
  std::vector<double> inverse_mass_; // as its contacts feel it, 1/kg; below 0: not known yet
  std::vector<double> damping_;      // sum of c in this step, N s/m
  std::vector<double> gathered_;     // what ghosts have for their owners, comm_reverse numbers each
  std::vector<Coupled> coupled_;     // of this step
  std::vector<std::function<void()>> coupled_links_;
  std::vector<Later> later_;            // of this step
  std::vector<Later> shifts_;           // in the opening half kick, not yet taken back
  std::vector<Constraint> constraints_; // they act again on forces that were put back
};

} // namespace LAMMPS_NS
