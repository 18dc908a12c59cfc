#pragma once
// State of a bed of soil balls at one instant: energies and their losses, contacts, walls, void ratio.

#include "contact/contact_observer.h"

#include <array>
#include <vector>

namespace drumlin {

/// Sums over all contacts of a step, roller's included.
struct ContactSums {
  double normal_heat = 0.0; ///< W, of the normal dashpots as they acted; what condition B keeps back included
  double tangential_power =
      0.0; ///< W that friction and rolling take from the balls: heat, and what their springs store
  double normal_stored = 0.0;     ///< J
  double tangential_stored = 0.0; ///< J, in tangential springs
  double contacts = 0.0;          ///< between soil balls, or of one with anything else
  double coordination = 0.0;      ///< ends of contacts on soil balls
  double overlap = 0.0;           ///< sum of overlaps over the smaller radius, contacts of soil balls
  double floor_force = 0.0;       ///< N, on the balls along the axis, by walls across the axis
  double side_force = 0.0;        ///< N, on the balls along the axis, by walls along the axis
  double side_thrust = 0.0;       ///< N, sum of the normal forces of walls along the axis
};

/// Sums over all balls.
struct BallSums {
  double kinetic = 0.0;     ///< J, rotation included
  double height = 0.0;      ///< kg m, mass times coordinate along the axis
  double soil_height = 0.0; ///< the same of the soil
  double soil_mass = 0.0;   ///< kg
  double soil_balls = 0.0;
  double solid = 0.0; ///< m3 (m2 in two dimensions) of soil in the window
};

class BedState {
public:
  explicit BedState(engine::LAMMPS *lmp, int soil_groupbit) : lmp_(lmp), soil_(soil_groupbit) {}

  /// Before the forces of a step are computed.
  void clear() { records_.clear(); }
  void add(const ContactRecord &record) { records_.push_back(record); }

  /// Sums over the contacts of the step with the velocities of now, which ghosts must have too. Collective.
  ContactSums contacts(const std::array<double, 3> &axis) const;
  /// Sums over the balls, `solid` up to `window_top` (m, along the axis). Collective.
  BallSums balls(const std::array<double, 3> &axis, double window_top) const;
  /// Void ratio of the soil between the floor of the box and `window_top`, across the whole box.
  double void_ratio(const std::array<double, 3> &axis, double window_top, double solid) const;

private:
  static std::size_t upright(const std::array<double, 3> &axis);

  engine::LAMMPS *lmp_;
  int soil_;
  std::vector<ContactRecord> records_;
};

} // namespace drumlin
