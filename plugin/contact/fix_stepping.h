#pragma once
// The fix behind the keyword `stepping second`, added by the pair style: it provides the velocities and the
// damping of the step before to the contact law, and applies the parts of contact forces that act in one half
// of a step only.

#include "contact/contact_observer.h"
#include "engine.h"
#include "physics/friction_law.h"
#include "physics/rolling_law.h"
#include "physics/stepping.h"

#include <deque>
#include <functional>

namespace LAMMPS_NS {

/// Stores for each ball, ghosts included, its velocity at the beginning of the step and the sum of c/m over
/// its contacts in the last step. Solves for coupled contacts when all forces of a step are known. In a step
/// in which a contact begins or ends, the closing half kick needs another force than the next opening half
/// kick: the fix changes the forces between the two, at the end of the step, and applies position
/// corrections.
///
/// It writes nothing to restart files: the set-up of a restarted run computes these values from positions,
/// velocities and contact history.
class FixStepping : public drumlin::engine::GhostFix {
public:
  FixStepping(LAMMPS *, int, char **);
  ~FixStepping() override;

  /// The fix of this engine instance; nullptr under `stepping stock`.
  static FixStepping *find(LAMMPS *lmp);
  /// The fix of this engine instance, which is added if there is none.
  static FixStepping *provide(LAMMPS *lmp);
  /// To be called when the pair style changes to `stepping stock` or is deleted: find() then returns nullptr.
  /// The fix keeps its place in the list of fixes and does nothing until provide() is called again.
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
  /// Called when a fix changes the time step within a run.
  void reset_dt() override;
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

  /// Whether forces are computed for the set-up of a run: velocities then belong to the time of the
  /// positions.
  bool in_setup() const { return in_setup_; }
  /// True in a step in which no contact can need coupling, since all damping is light: the sums of c/m are
  /// then neither known nor needed.
  bool light() const { return light_; }
  /// Whether this rank computes the force on ball i of a contact: true for an owned ball, and with newton on,
  /// where one rank alone computes the contact, also for a ghost, whose force is sent to its owner. False for
  /// a wall (i = -1).
  bool takes(int i) const { return i >= 0 && (i < atom->nlocal || force->newton_pair); }
  double dt() const { return dt_; }                             ///< s
  const double *velocity_before(int i) const { return row(i); } ///< v(t), m/s, owned balls and ghosts
  /// Rows of four numbers, one for each ball, of which the first three are velocity_before().
  const double *rows() const { return velocity_[0]; }
  /// Announces that the force on owned ball i changes in this step by a known amount, N (an excitation):
  /// 2 v+ - velocity_before(i) is then the velocity with the changed force. To be called after the
  /// integration (post_integrate) and before the values of ghosts are updated (pre_force).
  void foresee(int i, const std::array<double, 3> &change) {
    for (std::size_t a = 0; a < 3; ++a)
      velocity_[i][a] -= 0.5 * update->dt * change[a] / atom->rmass[i];
  }
  /// Sum of c/m over the contacts of ball i (owned or ghost) in the last step, 1/s; 0 if it was not computed,
  /// since no contact could need coupling: see expect_contacts().
  double damping_over_mass(int i) const { return counted_ ? row(i)[sum] : 0.0; }
  /// Whether those sums were computed.
  bool counted() const { return counted_; }
  /// Whether the contacts of this step have to call add_damping().
  bool counting() const { return counting_; }
  /// Adds the damping coefficient c, N s/m, of a contact to the sum of ball i that the next step uses. With
  /// newton off the sum of a ghost is discarded: its owner computes the contact, too.
  void add_damping(int i, double c) { damping_[static_cast<std::size_t>(i)] += c; }
  /// These sums, one for each ball, for inner loops.
  double *damping() { return damping_.data(); }
  /// Announces a link on owned ball i that is not a contact (a bond), with its k, N/m, and c, N s/m. To be
  /// called before each build of the neighbour list (pre_neighbor), which discards earlier announcements.
  void expect(int i, double k, double c) { expected_.push_back({i, k, c}); }
  /// Forces, N, that are added after the closing half kick of this step to a ball i with takes(i): `rest`
  /// acts in the next opening half kick; `shift` acts in the next drift only (StepResult::shift).
  void add_after_kick(int i, const std::array<double, 3> &rest, const std::array<double, 3> &shift) {
    later_.push_back({i, rest, shift});
  }

  /// A contact that is solved for together with others when all forces of the step are known: see
  /// CoupledDashpot and coupled_force().
  struct Coupled {
    int i, j; ///< j < 0: a wall
    std::array<double, 3> normal;
    drumlin::physics::CoupledDashpot dashpot; ///< a wall's own velocity is included in at_rest
    double share;                             ///< part of the force that acts: see StepContact::share
    double *force;                            ///< where the force, N, is stored

    /// Friction and rolling resistance, computed with the force of the contact solved for alone. When the force
    /// is known they are limited to what their laws allow with it. Forces and torques are those of the whole
    /// contact, of which `share` acts.
    drumlin::physics::Friction friction; ///< of `tangential coulomb`
    drumlin::physics::Vec3 rub{};        ///< N, force of friction on ball i
    double arm_i = 0.0, arm_j = 0.0;     ///< m, from the centre of each ball to the point where friction acts
    double *spring = nullptr;            ///< m, of friction; nullptr: there is no friction that is limited
    drumlin::physics::Rolling rolling;
    drumlin::physics::Vec3 roll{};    ///< N m, torque of rolling resistance on ball i
    double *rolling_spring = nullptr; ///< N m; nullptr: there is no rolling resistance
    double dt = 0.0;                  ///< s, time step
    drumlin::FrictionChange change;   ///< once the force is known
  };
  /// Adds a coupled contact and returns it, for the caller to fill in. (Filling it in place is faster than
  /// copying a finished one.) It stays where it is until the forces of the next step are computed.
  Coupled &couple() { return coupled_.emplace_back(); }
  /// The coupled contact that was added last, if its force is stored there; else nullptr.
  Coupled *coupled_at(const double *stored_force) {
    return !coupled_.empty() && coupled_.back().force == stored_force ? &coupled_.back() : nullptr;
  }
  /// The same for a link that is not a contact and whose balls may be on different ranks: `close` is called
  /// when v* is known, and adds the force of the link by add_force(). All ranks must call couple(), since
  /// `close` may communicate.
  void couple(const std::function<void()> &close) { coupled_links_.push_back(close); }
  /// v*, m/s, of an owned ball; valid while `close` is called.
  const double *predicted_velocity(int i) const { return velocity_[i]; }
  /// Adds factor * vector, N, to the force on owned ball i after the constraint fixes have acted, and to the
  /// total force that these fixes report as taken away (`f_ID`), since they take this force away, too.
  void add_force(int i, double factor, const std::array<double, 3> &vector);

private:
  struct Later {
    int i;
    std::array<double, 3> rest, shift;
  };
  /// A fix that takes forces away (setforce, freeze, ...), and its sum of the forces taken away, which is
  /// restored when the fix acts a second time in a step; nullptr if it has no such sum.
  struct Constraint {
    Fix *fix;
    double *reaction;
    bool joins; ///< whether it distributes forces among the balls of its group (aveforce, clump)
    /// Force on a clump that this rank's balls contribute, N, its output; nullptr for other fixes. A later fix may
    /// have taken it away from the balls (a platen that is moved by setforce), so that it is not their sum.
    double *body_force;
    std::array<double, 3> held; ///< N, the sum over this rank's balls of a clump before forces are added
  };
  struct Expected {
    int i;
    double k, c;
  };
  /// Layout of a row of velocity_: its length, all of which ghosts need, and the index of the sum of c/m
  /// behind the three velocities. Both lie side by side in memory since the inner loop reads both.
  static constexpr int shared = 4, sum = 3;
  /// The row of ball i. Rows are contiguous in memory, so that the inner loop need not read a pointer per
  /// ball.
  double *row(int i) const { return velocity_[0] + static_cast<std::ptrdiff_t>(i) * shared; }
  void expect_contacts();
  void gather(std::size_t numbers);
  void solve_coupled();
  void limit_friction(Coupled &contact, double normal_force);
  void add_torque(int i, const std::array<double, 3> &torque);
  void send_later();
  void merge_later();
  std::array<double, 3> force_on(const Fix &fix) const;
  void hold_body_forces();
  void constrain(bool any);

  bool in_use_ = true;
  bool in_setup_ = false;
  bool light_ = false;
  bool counting_ = false; // whether the contacts of this step are counted
  bool counted_ = false;  // whether those of the last were
  double dt_ = 0.0;
  double told_dt_ = 0.0;           // time step of which the engine has told its fixes
  bool dt_varies_ = false;         // whether a fix may change it within the run
  double expected_dt_ = 0.0;       // time step for which counting_ was decided
  std::vector<Expected> expected_; // links that are not contacts
  // One entry per ball:
  double **velocity_ = nullptr;      // v(t), at the end of a step v*, m/s; sum of c/m in the last step, 1/s
  std::vector<double> inverse_mass_; // 1/ContactSource::mass(), 1/kg; below 0: not known yet
  std::vector<double> damping_;      // sum of c in this step, N s/m
  std::vector<double> gathered_;     // sums of ghosts to be sent to owners, comm_reverse each
  std::deque<Coupled> coupled_;      // of this step
  std::vector<std::function<void()>> coupled_links_;
  std::vector<Later> later_;            // of this step
  std::vector<Later> shifts_;           // in the next opening half kick, to be taken back after it
  std::vector<Constraint> constraints_; // act again after the forces have been changed
};

} // namespace LAMMPS_NS
