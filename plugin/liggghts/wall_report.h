#pragma once
// What a wall of LIGGGHTS reports of its contacts under `stepping second`: to its mesh (force, torque, stress
// and wear of fix mesh/surface/stress, from which a servo takes its force), and by store_force and
// store_force_contact.

#include "atom.h"
#include "fix_contact_property_atom_wall.h"
#include "fix_mesh_surface.h"
#include "fix_property_atom.h"
#include "fix_wall_gran.h"
#include "modify.h"
#include "tri_mesh.h"
#include "update.h"

#include "contact/fix_stepping.h"
#include "liggghts/pair_source.h"
#include "physics/vec3.h"

#include <array>
#include <string>

namespace drumlin {

/// The engine's wall reports the force with which it computes the closing half kick, as soon as it has
/// computed it. A report is right if its sum over the steps is the momentum that the wall has given. So in
/// the step in which a contact begins or ends it is the mean of that force and of the one in the next opening
/// half kick, and the report of a coupled contact is made when all forces of the step are known. Wear is not
/// linear in the force: a mesh is told of each contact once.
class WallReport {
  using FixWallGran = LAMMPS_NS::FixWallGran;
  using FixMeshSurface = LAMMPS_NS::FixMeshSurface;
  using Data = LIGGGHTS::ContactModels::SurfacesIntersectData;

public:
  /// Where a contact is on a mesh; all nullptr on other walls.
  struct Place {
    FixMeshSurface *fix_mesh;
    LAMMPS_NS::TriMesh *mesh;
    int triangle;
    const double *velocity; ///< m/s, of the wall
  };

  /// To be called when the models of the wall have their history.
  template <class Wall>
  void begin(LAMMPS_NS::LAMMPS &engine, Wall &wall) {
    engine_ = &engine;
    force_place_ = wall.get_history_offset(force_name);
    stepping_ = force_place_ < 0 ? nullptr : LAMMPS_NS::FixStepping::find(&engine);
  }

  /// \param compute computes the contact's force and adds it to the ball; called with the mesh that it is to
  /// report to, nullptr for none
  template <class Compute>
  void of_contact(FixWallGran &wall, Data &contact, const Place &place, Compute &&compute) {
    const bool reports = place.fix_mesh != nullptr || wall.store_force() || wall.store_force_contact();
    if (stepping_ == nullptr || !reports || !wall.computeflag()) return compute(place.fix_mesh);
    const double *const f = engine_->atom->f[contact.i];
    const physics::Vec3 before{f[0], f[1], f[2]};
    const std::size_t announced = stepping_->announced();
    compute(nullptr);
    if (!contact.has_force_update) return;
    const physics::Vec3 rest = physics::scaled(0.5, stepping_->rest_since(announced));
    Told told{contact.i, place, {}, {}, physics::sum({f[0], f[1], f[2]}, -1.0, before)};
    for (std::size_t a = 0; a < 3; ++a) {
      told.to_wall[a] = -contact.delta[a];
      told.velocity[a] = place.velocity[a];
    }
    if (auto *coupled = stepping_->coupled_at(contact.contact_history + force_place_)) {
      coupled->report = [this, &wall, coupled, told](const physics::Vec3 &change) {
        add(wall, told, change, coupled->change.torque_i);
      };
      return;
    }
    add(wall, told, rest, {});
  }

private:
  struct Told {
    int ball;
    Place place;
    physics::Vec3 to_wall;  ///< m, from the centre of the ball to the wall
    physics::Vec3 velocity; ///< m/s, of the wall
    physics::Vec3 force;    ///< N, on the ball, as the engine has reported it
  };

  /// Adds to what the engine has reported of a contact, and tells the mesh.
  void add(FixWallGran &wall, Told told, const physics::Vec3 &force, const physics::Vec3 &torque) const {
    if (wall.store_force()) {
      double *const stored = wall.fix_wallforce()->array_atom[told.ball];
      for (std::size_t a = 0; a < 3; ++a)
        stored[a] += force[a];
    }
    if (wall.store_force_contact() && engine_->update->ntimestep % wall.store_force_contact_every() == 0)
      add_to_stored_contact(wall, told, force, torque);
    if (told.place.fix_mesh == nullptr) return;
    told.force = physics::sum(told.force, 1.0, force);
    told.place.fix_mesh->add_particle_contribution(told.ball, told.force.data(), told.to_wall.data(),
                                                   told.place.triangle, told.velocity.data());
  }

  void add_to_stored_contact(FixWallGran &wall, const Told &told, const physics::Vec3 &force,
                             const physics::Vec3 &torque) const {
    auto *stored = told.place.fix_mesh != nullptr
                       ? told.place.fix_mesh->meshforceContact()
                       : static_cast<LAMMPS_NS::FixContactPropertyAtomWall *>(
                             engine::find_fix(engine_->modify, std::string("contactforces_") + wall.id));
    const int partner = told.place.mesh != nullptr ? told.place.mesh->id(told.place.triangle) : 0;
    double *values = nullptr;
    if (stored == nullptr || !stored->haveContact(told.ball, partner, values) || values == nullptr) return;
    for (std::size_t a = 0; a < 3; ++a) {
      values[a] += force[a];
      values[3 + a] += torque[a];
    }
  }

  LAMMPS_NS::LAMMPS *engine_ = nullptr;
  LAMMPS_NS::FixStepping *stepping_ = nullptr; // none under `stepping stock`
  int force_place_ = -1;                       // of the normal force in the contact history
};

} // namespace drumlin
