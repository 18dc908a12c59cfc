#pragma once
// The fix behind the keyword `stepping second`, added by the pair style: it provides the velocities and the
// damping of the step before to the contact law, and applies the parts of contact forces that act in one half
// of a step only.

#include "contact/contact_observer.h"
#include "contact/contact_source.h"
#include "contact/fix_between_runs.h"
#include "engine.h"
#include "physics/scheme/advance.h"
#include "physics/laws/friction_law.h"
#include "physics/laws/rolling_law.h"

#include <cstdint>
#include <deque>
#include <functional>
#include <utility>

namespace LAMMPS_NS {

/// Stores for each ball, ghosts included, its velocity at the beginning of the step and the sum of sqrt(c)/m
/// over its contacts in the last step (see CoupledDashpot). Solves for coupled contacts when all forces of a
/// step are known. In a step in which a contact begins or ends, the closing half kick needs another force
/// than the next opening half kick: the fix changes the forces between the two, at the end of the step, and
/// applies position corrections.
///
/// It writes nothing to restart files. A run that continues gets from FixBetweenRuns what the step before has
/// left; what else it needs the set-up computes from positions, velocities and contact history.
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
  void open_step() override;
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
  /// In a set-up: whether any contact continues from the step before it.
  bool any_continues() const { return in_setup_ && between_->any_continues(); }
  /// In a set-up, of a contact of balls i and j (j < 0: a wall): whether its stored force is that of the step
  /// before.
  bool continues(int i, int j) const { return between_->continues(i) && (j < 0 || between_->continues(j)); }
  /// In a set-up: see FixBetweenRuns::load().
  void load(int i, int j, double newton) {
    between_->load(i, newton);
    if (j >= 0) between_->load(j, newton);
  }
  /// Whether this rank computes the force on ball i of a contact: true for an owned ball, and with newton on,
  /// where one rank alone computes the contact, also for a ghost, whose force is sent to its owner. False for
  /// a wall (i = -1).
  bool takes(int i) const { return i >= 0 && (i < atom->nlocal || force->newton_pair); }
  double dt() const { return dt_; }                             ///< s
  const double *velocity_before(int i) const { return row(i); } ///< v(t), m/s, owned balls and ghosts
  /// Rows of four numbers, one for each ball, of which the first three are velocity_before().
  const double *rows() const { return velocity_[0]; }
  /// Announces that the force on owned ball i changes in this step by a known amount, N (an excitation): 2 v+
  /// - velocity_before(i) is then the velocity with the changed force. To be called after the integration
  /// (post_integrate) and before the values of ghosts are updated (pre_force).
  void foresee(int i, const std::array<double, 3> &change) {
    for (std::size_t a = 0; a < 3; ++a)
      if (!is_driven(i, a)) velocity_[i][a] -= 0.5 * update->dt * change[a] / atom->rmass[i];
  }
  /// Announces that a fix prescribes the velocity of owned ball i along an axis in this step: the present one
  /// is the mean of the step. \param before m/s: twice the present one less it is that of the end of the
  /// step. To be called within the integration, after open_step().
  void prescribe(int i, int axis, double before) { velocity_[i][axis] = before; }
  /// Sum over this rank's balls of a group of the forces, N, that act in the next drift only: part of the
  /// forces on balls from the end of a step until the integration of the next.
  std::array<double, 3> position_corrections(int bits) const {
    std::array<double, 3> total{};
    for (const Later &item : shifts_)
      if (atom->mask[item.i] & bits) total = drumlin::physics::sum(total, 1.0, item.shift);
    return total;
  }
  /// Calls `treat` with the index of each of this rank's balls that has such a force, and the force.
  template <class Treat>
  void for_each_shift(const Treat &treat) const {
    for (const Later &item : shifts_)
      treat(item.i, item.shift);
  }
  /// Whether there are balls whose motion, in one direction at least, does not depend on the forces on them:
  /// those of fix move and fix drum/travel, and those that no fix integrates. For this scheme they have
  /// infinite mass in these directions.
  bool any_moved() const { return any_moved_; }
  /// Effective mass, kg, with which a contact changes the velocities of its balls: `m_eff` of the contact law
  /// unless one of them is moved. Infinite if both are. \param j below 0: a wall \param normal unit vector
  double moving_mass(int i, int j, const std::array<double, 3> &normal, double m_eff) const {
    return is_moved(i) || (j >= 0 && is_moved(j)) ? moving_mass_of_moved(i, j, normal) : m_eff;
  }
  /// Whether a component of the velocity of ball i does not depend on the forces on it. Known when forces are
  /// computed.
  bool is_driven(int i, std::size_t component) const { return is_moved(i) && is_unchanged(i, component); }
  /// Sum of sqrt(c)/m over the contacts of ball i (owned or ghost) in the last step, sqrt(N s/m)/kg; 0 if it
  /// was not computed, since no contact could need coupling: see expect_contacts().
  double damping_over_mass(int i) const { return counted_ ? row(i)[sum] : 0.0; }
  /// Whether those sums were computed.
  bool counted() const { return counted_; }
  /// Whether the contacts of this step have to call add_damping().
  bool counting() const { return counting_; }
  /// Adds the damping coefficient c, N s/m, of a contact to the sum of ball i that the next step uses. With
  /// newton off the sum of a ghost is discarded: its owner computes the contact, too.
  void add_damping(int i, double c) { damping_[static_cast<std::size_t>(i)] += std::sqrt(c); }
  /// These sums, one for each ball, for inner loops.
  double *damping() { return damping_.data(); }
  /// Announces a link on owned ball i that is not a contact (a bond), with its k, N/m, and c, N s/m. To be
  /// called before each build of the neighbour list (pre_neighbor), which discards earlier announcements.
  void expect(int i, double k, double c) { expected_.push_back({i, k, c}); }
  /// Forces, N, that are added after the closing half kick of this step to a ball i with takes(i): `rest`,
  /// and `torque`, N m, act in the next opening half kick; `shift` acts in the next drift only
  /// (StepResult::shift).
  void add_after_kick(int i, const std::array<double, 3> &rest, const std::array<double, 3> &shift,
                      const std::array<double, 3> &torque = {}) {
    later_.push_back({i, rest, shift, torque});
  }
  /// Number of calls of add_after_kick() in this step, and the sum of `rest`, N, of those from the number
  /// `first` on, which are those of one contact with a wall.
  std::size_t announced() const { return later_.size(); }
  std::array<double, 3> rest_since(std::size_t first) const {
    std::array<double, 3> total{};
    for (; first < later_.size(); ++first)
      total = drumlin::physics::sum(total, 1.0, later_[first].rest);
    return total;
  }

  /// Friction and rolling resistance of a contact, computed with its normal force at the end of the step (of
  /// a coupled contact: with that of the contact solved for alone). Forces and torques are those of the whole
  /// contact.
  struct Rubbing {
    drumlin::physics::Friction
        friction;                    ///< of `tangential coulomb`; of any friction for a contact that begins
    drumlin::physics::Vec3 rub{};    ///< N, force of friction on ball i
    drumlin::physics::Vec3 slip{};   ///< m/s, of ball i's surface relative to j's; of a contact that begins
    double arm_i = 0.0, arm_j = 0.0; ///< m, from the centre of each ball to the point where friction acts
    double *spring = nullptr;        ///< m, of friction; nullptr: there is no spring
    drumlin::physics::Rolling rolling;
    drumlin::physics::Vec3 roll{};    ///< N m, torque of rolling resistance on ball i
    double *rolling_spring = nullptr; ///< N m; nullptr: there is no rolling resistance
  };

  /// A contact that is solved for together with others when all forces of the step are known: see
  /// CoupledDashpot and coupled_force(). Its friction and rolling resistance are then limited to what their
  /// laws allow with its normal force.
  struct Coupled : Rubbing {
    int i, j; ///< j < 0: a wall
    std::array<double, 3> normal;
    drumlin::physics::CoupledDashpot dashpot; ///< a wall's own velocity is included in at_rest
    double share;                             ///< part of the force that acts: see WallSide::share
    double *force;                            ///< where the force, N, is stored
    drumlin::FrictionChange change;           ///< once the force is known
    /// For a wall that reports its force; empty for others. Called when the force is known, with what that
    /// has changed in the force of the contact on ball i, N.
    std::function<void(const std::array<double, 3> &)> report;
  };
  /// Adds a coupled contact and returns it, for the caller to fill in. (Filling it in place is faster than
  /// copying a finished one.) It stays where it is until the forces of the next step are computed.
  Coupled &couple() { return coupled_.emplace_back(); }
  /// The coupled contact that was added last, if its force is stored there; else nullptr.
  Coupled *coupled_at(const double *stored_force) {
    return !coupled_.empty() && coupled_.back().force == stored_force ? &coupled_.back() : nullptr;
  }

  /// A contact that begins in this step: its friction acts in the closing half kick with another value than
  /// in the next opening one, as its normal force does.
  struct Begun : Rubbing {
    int i, j; ///< j < 0: a wall
    std::array<double, 3> normal;
    double share; ///< as of a coupled contact
    drumlin::physics::StepResult step;
    std::size_t announced; ///< FixStepping::announced() before its calls of add_after_kick()
  };
  /// Announces a contact that begins, for the caller to fill in what Rubbing has.
  Begun &begin() { return begun_.emplace_back(); }
  /// Friction, N, and rolling resistance, N m, on ball i of the share of a contact that acts.
  struct RubbingForces {
    drumlin::physics::Vec3 friction{}, rolling{};
  };
  /// Those of a contact that begins, in the closing half kick. Adds what they lack in the next opening half
  /// kick.
  RubbingForces close_friction(const Begun &contact);

  /// Whether an observer takes heat.
  bool counts_heat() const { return observers_.take_heat(); }
  /// Passes heat that the trapezoidal rule misses in a step to the observers.
  void tell_heat(int i, int j, double normal, double tangential) const {
    observers_.tell_heat(i, j, normal, tangential);
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
    std::array<double, 3> rest, shift, torque;
  };
  /// A fix that takes forces away (setforce, freeze, ...), and its sum of the forces taken away, which is
  /// restored when the fix acts a second time in a step; nullptr if it has no such sum.
  struct Constraint {
    Fix *fix;
    double *reaction;
    bool joins; ///< whether it distributes forces among the balls of its group (aveforce, clump)
    /// Force on a clump that this rank's balls contribute, N, its output; nullptr for other fixes. A later
    /// fix may have taken it away from the balls (a platen that is moved by setforce), so that it is not
    /// their sum.
    double *body_force;
    std::array<double, 3> held; ///< N, the sum over this rank's balls of a clump before forces are added
  };
  struct Expected {
    int i;
    double k, c;
  };
  /// Layout of a row of velocity_: its length, all of which ghosts need, and the index of the sum of
  /// sqrt(c)/m behind the three velocities. Both lie side by side in memory since the inner loop reads both.
  static constexpr int shared = 4, sum = 3;
  /// The row of ball i. Rows are contiguous in memory, so that the inner loop need not read a pointer per
  /// ball.
  double *row(int i) const { return velocity_[0] + static_cast<std::ptrdiff_t>(i) * shared; }
  void expect_contacts();
  void add_travelling(Fix &fix);
  void look_for_moved();
  void follow_moved();
  /// Whether the motion of ball i (owned or ghost) does not depend on the forces on it, in one direction at
  /// least.
  bool is_moved(int i) const {
    return any_moved_ &&
           ((atom->mask[i] & (moved_bits_ | travelling_bits_)) != 0 || (atom->mask[i] & free_bits_) == 0);
  }
  /// Whether the forces of the opening half step have not changed this component of the velocity of ball i,
  /// or a fix prescribes it.
  bool is_unchanged(int i, std::size_t a) const {
    return velocity_[i][a] == atom->v[i][a] || (atom->mask[i] & prescribed_bits_[a]) != 0;
  }
  bool is_unchanged(int i) const { return is_unchanged(i, 0) && is_unchanged(i, 1) && is_unchanged(i, 2); }
  double moving_mass_of_moved(int i, int j, const std::array<double, 3> &normal) const;
  void take_masses();
  void gather(std::size_t numbers);
  void solve_coupled();
  void limit_friction(Coupled &contact, double normal_force);
  void add_torque(int i, const std::array<double, 3> &torque);
  void send_later();
  void add_to_announced(std::size_t place, int i, const std::array<double, 3> &rest,
                        const std::array<double, 3> &torque);
  void merge_later();
  std::array<double, 3> force_on(const Fix &fix) const;
  void hold_body_forces();
  void constrain(bool any);

  bool in_use_ = true;
  bool in_setup_ = false;
  bool counting_ = false; // whether the contacts of this step are counted
  bool counted_ = false;  // whether those of the last were
  bool any_moved_ = false;
  int moved_bits_ = 0;      // groups of the fixes that move balls otherwise than by the forces on them
  int travelling_bits_ = 0; // groups of the fixes that prescribe the velocity along an axis,
  std::array<int, 3> prescribed_bits_{}; // and the same for each axis
  int free_bits_ = 0;          // groups of those that integrate, and of frozen balls, whose contacts know it
  bool relative_ = false;      // whether rows of owned balls hold v+ - v(t) in place of v(t)
  std::uint64_t masses_ = 0;   // sum of the bits of the masses of owned balls: changes when a mass does
  bool mass_differs_ = false;  // whether one of this rank's has changed since the step before,
  bool masses_change_ = false; // or one of any rank's
  const drumlin::ContactSource *source_ = nullptr; // since the set-up of the run
  FixBetweenRuns *between_ = nullptr;
  double dt_ = 0.0;
  double told_dt_ = 0.0;     // time step of which the engine has told its fixes
  bool varies_ = false;      // whether a fix may change it, or the coefficients of contacts, within the run
  double expected_dt_ = 0.0; // time step for which counting_ was decided
  std::vector<Expected> expected_; // links that are not contacts
  // One entry per ball:
  double **velocity_ = nullptr;      // v(t), at the end of a step v*, m/s; sum of sqrt(c)/m in the last step
  std::vector<double> inverse_mass_; // 1/ContactSource::mass(), 1/kg, of owned balls
  std::vector<double> damping_;      // sum of sqrt(c) in this step
  std::vector<double> gathered_;     // sums of ghosts to be sent to owners, comm_reverse each
  std::deque<Coupled> coupled_;      // of this step
  std::deque<Begun> begun_;          // the same
  drumlin::ContactObservers observers_;
  std::vector<std::function<void()>> coupled_links_;
  std::vector<Later> later_;  // of this step
  std::vector<Later> merged_; // and order_: memory of merge_later()
  std::vector<std::pair<int, std::size_t>> order_;
  std::vector<Later> shifts_;           // in the next opening half kick, to be taken back after it
  std::vector<Constraint> constraints_; // act again after the forces have been changed
};

} // namespace LAMMPS_NS
