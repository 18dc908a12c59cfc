#pragma once
// Motion and forces of drum and frame at one time.

namespace drumlin {

/// Motion of a body along the axis, which points upwards.
struct BodyMotion {
  double x = 0.0; ///< m
  double v = 0.0; ///< m/s
  double a = 0.0; ///< m/s2
  // Of a body that tilts; the tilt is positive if the right end is higher.
  double tilt = 0.0;         ///< rad
  double rate = 0.0;         ///< rad/s
  double acceleration = 0.0; ///< of the tilt of the drum, rad/s2
};

/// Forces on the drum, N, with the powers and energies that belong to them.
struct RollerForces {
  double contact = 0.0;            ///< N, along the axis, positive in compression
  double excitation = 0.0;         ///< N, positive along the direction of fix drum/excite
  double bond = 0.0;               ///< N, positive in tension
  double contact_dissipated = 0.0; ///< W
  double contact_missed = 0.0;     ///< J, heat of this step, see ContactObserver::see_heat()
  double contact_stored = 0.0;     ///< J
  double bond_dissipated = 0.0;    ///< W
  double bond_released = 0.0;      ///< J, of bonds that have broken in this step
  double bond_stored = 0.0;        ///< J
  double excitation_power = 0.0;   ///< W, of the excitation on the drum
  double tangential_power = 0.0;   ///< W, taken from the balls by friction and rolling; of a bed only
  double tangential_missed = 0.0;  ///< J, the same of friction; of a bed only
  double ground_stored = 0.0; ///< J, springs of absorbing boundaries less the work of their constant forces
  double ground_heat =
      0.0; ///< J, dissipated by the dashpots of absorbing boundaries since their first run began
  double left = 0.0, right = 0.0; ///< N, of `contact`, on the halves of a drum that tilts
  bool in_contact = false;        ///< whether the soil exerts a force on the drum
};

/// Drum, frame and forces at one time.
struct RollerState {
  double time = 0.0; ///< s
  BodyMotion drum, frame;
  RollerForces forces;
};

} // namespace drumlin
