#pragma once
/// Friction of one contact, step by step, for tests of whole impacts: as compute_tangential_stiffness() and
/// compute_friction() do it for a block of contacts.

#include "physics/contact_law.h"
#include "physics/friction_law.h"
#include "physics/stepping.h"

namespace verlet {

/// The tangential force of a contact: a spring and a dashpot in parallel, in series with a slider that slips at mu Fn.
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
    const FrictionStep now =
        friction_step({kt, ct, coefficient_, cap_}, normal_force, normal, slip, spring_, motion.dt);
    spring_ = now.spring;
    return now;
  }

  /// The contact has ended.
  void end() {
    spring_ = {};
    stiffness_ = 0.0;
  }

private:
  const Contact contact_;
  const double coefficient_, r_eff_;
  const drumlin::physics::Cap cap_;
  double stiffness_ = 0.0;
  drumlin::physics::Vec3 spring_{};
};

} // namespace verlet
