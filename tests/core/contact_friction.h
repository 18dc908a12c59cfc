#pragma once
/// Friction of one contact, step by step, for tests of whole impacts: as compute_tangential_stiffness() and
/// compute_friction() do it for a block of contacts.
#include "tests/support/prelude.h"
#include "physics/scheme/advance.h"
#include "physics/laws/friction_law.h"

namespace verlet {

/// The tangential force of a contact: a spring and a dashpot in parallel, in series with a slider that slips
/// at mu Fn.
/// \tparam Contact parameters of the normal law
template <class Contact>
class ContactFriction {
public:
  /// \param coefficient mu \param r_eff effective radius, m
  ContactFriction(const Contact &contact, double coefficient, double r_eff,
                  drumlin::physics::Cap cap = drumlin::physics::Cap::coulomb)
      : contact_(contact), coefficient_(coefficient), r_eff_(r_eff), cap_(cap) {}

  /// \param normal_force N \param ct tangential dashpot, N s/m \param slip m/s
  drumlin::physics::FrictionStep step(const drumlin::physics::StepMotion &motion, double normal_force,
                                      double ct, const drumlin::physics::Vec3 &normal,
                                      const drumlin::physics::Vec3 &slip) {
    using namespace drumlin::physics;
    const double kt =
        contact_.tangential(overlap_of_spring(motion.overlap, motion.rate_half, motion.dt), r_eff_);
    spring_ = scaled(kept_spring(stiffness_, kt), spring_);
    stiffness_ = kt;
    friction_ = {kt, ct, coefficient_, cap_};
    const bool begins = !touched_ && cap_ == Cap::coulomb;
    const double time = begins ? time_in_contact(motion.overlap, motion.rate_half, motion.dt) : motion.dt;
    const FrictionStep now = friction_step(friction_, normal_force, normal, slip, spring_, time);
    spring_ = now.spring;
    touched_ = true;
    return now;
  }

  /// Friction in the closing half kick, N, from that of the end of the step. \param push of the normal law
  [[nodiscard]] drumlin::physics::Vec3 closing(const drumlin::physics::StepResult &push,
                                               const drumlin::physics::FrictionStep &now) const {
    if (!push.begins) return now.force;
    return closing_friction(friction_, push.force, push.kick, push.weight, {now.force, now.spring});
  }

  /// The contact has ended.
  void end() {
    spring_ = {};
    stiffness_ = 0.0;
    touched_ = false;
  }

private:
  const Contact contact_;
  const double coefficient_, r_eff_;
  const drumlin::physics::Cap cap_;
  double stiffness_ = 0.0;
  bool touched_ = false;
  drumlin::physics::Friction friction_;
  drumlin::physics::Vec3 spring_{};
};

} // namespace verlet
