#pragma once
// Rolling resistance of one contact, shared by the pair styles and fix wall/gran/transition.

#include "contact/contact_settings.h"
#include "contact/fix_stepping.h"
#include "physics/laws/rolling_law.h"

namespace drumlin {

/// The rotation of a contact in one step.
struct RollingMotion {
  physics::Vec3 normal; ///< from j to i
  physics::Vec3 spin;   ///< rad/s, of ball i relative to ball j or to a wall at rest
  double radius;        ///< effective radius of the contact, m
};

/// Computes the torque on ball i, N m, of which ball j gets the opposite, and updates the spring.
/// \param kt tangential stiffness in this step, N/m
/// \param spring of the contact, three numbers of its history
/// \param time for which the spring is stretched, s, see time_of_spring(); 0 in the set-up of a run
/// \param rubbing see ContactForces::rubbing()
template <class Parameters>
inline physics::Vec3 rolling_torque(const ContactCoefficients<Parameters> &coefficients,
                                    const RollingMotion &motion, double kt, double normal_force,
                                    double *spring, double time, LAMMPS_NS::FixStepping::Rubbing *rubbing) {
  const physics::Rolling rolling = coefficients.rolling_resistance(kt, motion.radius);
  const physics::RollingStep step = physics::rolling_step(rolling, normal_force, motion.normal, motion.spin,
                                                          {spring[0], spring[1], spring[2]}, time);
  if (rubbing != nullptr) {
    rubbing->rolling = rolling;
    rubbing->roll = step.torque;
    rubbing->rolling_spring = spring;
  }
  if (time > 0.0)
    for (std::size_t a = 0; a < 3; ++a)
      spring[a] = step.spring[a];
  return step.torque;
}

} // namespace drumlin
