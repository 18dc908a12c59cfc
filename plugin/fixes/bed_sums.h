#pragma once
// Sums over the contacts and balls of a bed at one time: energies, heat, forces of the walls, coordination,
// void ratio.

#include "contact/contact_observer.h"

#include <array>
#include <vector>

namespace drumlin {

/// Sums over all contacts of a step, those of the roller and the walls included.
struct ContactSums {
  double normal_heat =
      0.0; ///< W, of the normal dashpots; under B with the spring energy lost while the force is 0
  double yield_heat = 0.0; ///< J, heat of contacts that yielded in this step
  double tangential_power =
      0.0; ///< W, taken from the balls by friction and rolling: heat and energy of their springs
  double missed_heat = 0.0;       ///< J, of the normal dashpots in this step, see ContactObserver::see_heat()
  double missed_work = 0.0;       ///< J, the same of friction
  double normal_stored = 0.0;     ///< J, in normal springs
  double tangential_stored = 0.0; ///< J, in tangential springs
  double contacts = 0.0;          ///< number of contacts with at least one soil ball
  double coordination = 0.0;      ///< number of contacts of a soil ball, summed over the soil balls
  double overlap = 0.0;           ///< sum of overlap over smaller radius, of the contacts with soil balls
  double floor_force = 0.0; ///< N, force along the axis on the balls by walls whose normal is along the axis
  double side_force = 0.0;  ///< N, force along the axis on the balls by the other walls: their friction
  double side_thrust = 0.0; ///< N, sum of the normal forces of these other walls

  /// Adds the force of a boundary on balls, N: to that of the floor if its normal is along the axis, else to
  /// those of the sides. \param outward unit vector that points out of the bed
  void add_wall(const std::array<double, 3> &axis, const std::array<double, 3> &outward,
                const std::array<double, 3> &force);
};

/// Sums over all balls.
struct BallSums {
  double kinetic = 0.0;     ///< J, rotation included
  double height = 0.0;      ///< kg m, sum of mass times coordinate along the axis
  double soil_height = 0.0; ///< kg m, the same sum over the soil balls
  double soil_mass = 0.0;   ///< kg
  double soil_balls = 0.0;  ///< number of soil balls
  double solid = 0.0;       ///< m3 (m2 in two dimensions) of soil balls below a given height
};

/// Sums over the contacts of a step, which are added one by one, and over balls. `axis` is everywhere the
/// unit vector that points upwards.
class BedSums {
public:
  /// \param soil_groupbit bit of the group of the soil balls
  explicit BedSums(engine::LAMMPS *lmp, int soil_groupbit) : lmp_(lmp), soil_(soil_groupbit) {}

  /// Discards the recorded contacts; to be called before the forces of a step are computed.
  void clear();
  void add(const ContactRecord &record) { records_.push_back(record); }
  /// What ContactObserver::see_heat() receives.
  void add_heat(int i, int j, double normal, double tangential);

  /// Sums over the recorded contacts with the present velocities. The copies of balls that belong to another
  /// process (ghosts) must have the velocities of the original balls. To be called on all processes.
  ContactSums contacts(const std::array<double, 3> &axis) const;
  /// Sums over the balls. To be called on all processes. \param window_top height, m along the axis, below
  /// which `solid` is counted
  BallSums balls(const std::array<double, 3> &axis, double window_top) const;
  /// Void ratio of the soil between the lower bound of the box and `window_top`, over the whole cross-section
  /// of the box; 0 without soil.
  /// \param solid BallSums::solid for this window
  double void_ratio(const std::array<double, 3> &axis, double window_top, double solid) const;

private:
  double weight(int i, int j) const;
  static std::size_t vertical_component(const std::array<double, 3> &axis);

  engine::LAMMPS *lmp_;
  int soil_;
  std::vector<ContactRecord> records_;
  double missed_heat_ = 0.0, missed_work_ = 0.0; // J
};

} // namespace drumlin
