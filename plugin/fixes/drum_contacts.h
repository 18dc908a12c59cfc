#pragma once
// The contacts of the drum with balls that belong neither to the drum nor to the frame: their force, heat and
// stored energy.

#include "engine.h"
#include "contact/contact_source.h"
#include "physics/bodies/tilting_body.h"

#include <array>
#include <vector>

namespace drumlin {

/// Sums over the contacts of the drum.
struct DrumContactSums {
  double force = 0.0;       ///< N, on the drum along the axis, friction included
  double dissipated = 0.0;  ///< W, of the normal dashpots
  double missed_heat = 0.0; ///< J, of these dashpots in the last step, see ContactObserver::see_heat()
  double stored = 0.0;      ///< J, in the normal springs
  bool in_contact = false;  ///< whether a contact exerts a force
  // Of a drum that tilts; a contact in its middle counts half to each side.
  double left = 0.0, right = 0.0; ///< N, along the axis
  double moment = 0.0;            ///< N m, about its centre of mass
};

/// The pairs of the neighbour list that may become such contacts, with their coefficients.
class DrumContacts {
public:
  explicit DrumContacts(engine::LAMMPS *lmp) : lmp_(lmp) {}

  /// Reads the pairs from the neighbour list of the contact law. To be called after each build of that list.
  /// \param drum, frame bits of the groups; frame 0: there is no frame
  void list_pairs(const ContactSource &source, int drum, int frame);

  /// Takes the heat of a contact, J, if it is one of the drum's: see ContactObserver::see_heat().
  void add_heat(int i, int j, double heat);

  /// Sums with the present positions and velocities. Ghosts must have the velocities of their owners.
  /// Collective.
  /// \param axis unit vector that points upwards \param axes of a drum that tilts, nullptr: it does not
  /// \param centre of mass of this drum along its axle, m \param middle m, distance from it within which a
  /// contact is in the middle
  DrumContactSums sums(const std::array<double, 3> &axis, const physics::TiltAxes *axes = nullptr,
                       double centre = 0.0, double middle = 0.0);

private:
  struct Pair {
    int i, j;
    double sign; // 1: ball i belongs to the drum; -1: ball j does
    PairLaw law;
    TangentialSpring spring; // of the tangential model
    const double *memory;    // of the contact; nullptr: its law has none
  };

  template <class Law>
  void add(std::array<double, 5> &sums, const Pair &pair, const Law &law,
           const std::array<double, 3> &axis) const;
  double place_on_axle(int ball, const physics::TiltAxes &axes, double centre) const;

  /// 1: ball i alone belongs to the drum, -1: ball j alone does, and the other one is not of the roller; 0:
  /// neither.
  double sign(int i, int j) const;

  engine::LAMMPS *lmp_;
  int drum_ = 0, roller_ = 0; // bits of the groups
  double missed_heat_ = 0.0;  // J, since the last call of sums()
  const ContactSource *source_ = nullptr;
  std::vector<Pair> pairs_;
};

} // namespace drumlin
