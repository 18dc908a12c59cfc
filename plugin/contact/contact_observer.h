#pragma once
// The interface by which fixes observe contacts and bonds: energy balance, guard, dumps and event log use it.
// Observers are fixes, so that each engine instance has its own.

#include "physics/laws/laws.h"
#include "engine.h"
#include "physics/scheme/event_location.h"
#include "physics/scheme/stability_limit.h"
#include "physics/vec3.h"

#include <array>
#include <vector>

namespace drumlin {

/// What changes in a contact when its final normal force is known: see FixStepping::Coupled.
struct FrictionChange {
  physics::Vec3 force{};                ///< N, of the tangential force on ball i
  physics::Vec3 torque_i{}, torque_j{}; ///< N m
};

/// One contact of two balls, or of a ball and a wall, in one step. Stiffnesses, damping coefficients and
/// energies are those of the contact law; the values that act on the balls are `share` times as large.
struct ContactRecord {
  int i, j;                            ///< indices of the balls; j < 0: a wall
  std::array<double, 3> normal;        ///< from j to i
  std::array<double, 3> wall_velocity; ///< m/s, of a wall's surface at the contact; 0 between balls
  double overlap;                      ///< m
  double radius;                       ///< of the smaller ball, m
  double share;                        ///< 1; less where triangles of a mesh share the force of one contact
  double suction;                      ///< N, constant attraction
  double spring_force;                 ///< N, of the normal spring, less suction
  double spring_energy;                ///< J, in the normal spring, less suction times overlap
  double yield_heat;                   ///< J, heat of yielding in this step
  double normal_stiffness;             ///< N/m
  double normal_dashpot;       ///< N s/m; 0 under `stepping second`, where it does not limit the time step
  double tangential_stiffness; ///< N/m; 0 without a tangential spring
  double tangential_dashpot;   ///< N s/m; 0 without a tangential dashpot
  double rolling_stiffness;    ///< N m; 0 without a rolling spring
  double normal_force;         ///< N, of spring and dashpot, positive when it pushes
  const double *final_force;   ///< where the final normal force is stored once all forces of the step are
                               ///< known (`stepping second`); nullptr: normal_force is final
  const double *spring;        ///< tangential spring, m, three components; nullptr: none
  std::array<double, 3> tangential_force;   ///< on ball i, N
  std::array<double, 3> torque_i, torque_j; ///< N m
  const FrictionChange *change; ///< what is added to these three once all forces of the step are known;
                                ///< nullptr: nothing

  // To be called when all forces of the step are known:
  /// N, with suction, positive when it pushes.
  double final_normal_force() const {
    return share * ((final_force != nullptr ? *final_force : normal_force) - suction);
  }
  physics::Vec3 final_tangential_force() const {
    return change != nullptr ? physics::sum(tangential_force, 1.0, change->force) : tangential_force;
  }
  physics::Vec3 final_torque_i() const {
    return change != nullptr ? physics::sum(torque_i, 1.0, change->torque_i) : torque_i;
  }
  physics::Vec3 final_torque_j() const {
    return change != nullptr ? physics::sum(torque_j, 1.0, change->torque_j) : torque_j;
  }
};

/// The overlap of two balls, and its rate, at the beginning and at the end of a time step. The balls need not
/// touch: a negative overlap is the gap between them.
struct PairStep {
  int tag_i, tag_j; ///< IDs of the balls, the lower first
  const AnyLaw &law;
  double suction;                      ///< N, which the law does not contain
  double dt;                           ///< s, length of the step
  physics::OverlapState before, after; ///< at the beginning and the end of the step
};

/// Base class of a fix that observes contacts. Between observe(true) and observe(false) it receives each
/// contact and each bond of every time step. FixPairObserver is the base class of fixes that follow chosen
/// pairs of balls.
class ContactObserver {
public:
  ContactObserver() = default;
  ContactObserver(const ContactObserver &) = delete;
  ContactObserver &operator=(const ContactObserver &) = delete;

  /// Receives a contact whose forces this rank has computed. With newton off both ranks receive a contact
  /// between balls of different ranks.
  virtual void see_contact(const ContactRecord &) {}
  /// Receives a bond, once for each of its balls that this rank owns. \param partner ID of the other ball
  virtual void see_bond(int /*ball*/, int /*partner*/, const physics::LinkModes &) {}
  /// Whether see_heat() is called.
  virtual bool takes_heat() const { return false; }
  /// Receives heat, J, that the trapezoidal rule over the powers of the contacts misses in a step, under
  /// `stepping second`: of the normal dashpot, and of friction. Called in every step while forces are
  /// computed, on the ranks that see_contact() is called on, whether observe(true) has been called or not.
  virtual void see_heat(int /*i*/, int /*j*/, double /*normal*/, double /*tangential*/) {}
  /// Receives a pair of balls at the end of a time step. Only FixPairObserver calls it, in every step,
  /// whether observe(true) has been called or not.
  virtual void see_pair(const PairStep &) {}

  bool observing() const { return observing_; }

protected:
  ~ContactObserver() = default;
  void observe(bool on) { observing_ = on; }

private:
  bool observing_ = false;
};

/// The observers of an engine instance, for a pair style, wall or bond that reports to them. Most scenes have
/// none and most steps are not observed: any() lets a contact skip its report at the cost of a comparison.
class ContactObservers {
public:
  /// Looks up the observers among the fixes. To be called in the initialization of each run.
  void find(LAMMPS_NS::Modify &modify) {
    all_.clear();
    takes_heat_ = false;
    for (LAMMPS_NS::Fix *fix : engine::fixes(&modify))
      if (auto *observer = dynamic_cast<ContactObserver *>(fix)) {
        all_.push_back(observer);
        takes_heat_ |= observer->takes_heat();
      }
  }

  bool any() const {
    for (const ContactObserver *observer : all_)
      if (observer->observing()) return true;
    return false;
  }

  void tell(const ContactRecord &record) const {
    for (ContactObserver *observer : all_)
      if (observer->observing()) observer->see_contact(record);
  }
  bool take_heat() const { return takes_heat_; }
  void tell_heat(int i, int j, double normal, double tangential) const {
    for (ContactObserver *observer : all_)
      if (observer->takes_heat()) observer->see_heat(i, j, normal, tangential);
  }
  void tell_bond(int ball, int partner, const physics::LinkModes &modes) const {
    for (ContactObserver *observer : all_)
      if (observer->observing()) observer->see_bond(ball, partner, modes);
  }

private:
  std::vector<ContactObserver *> all_;
  bool takes_heat_ = false; // whether any of them does
};

} // namespace drumlin
