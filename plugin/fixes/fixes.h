#pragma once
// The fixes that the plugin adds to decks. Each has a page of its name in plugin/doc.

#include "fixes/fix_bond_spring.h"
#include "fixes/fix_boundary_absorb.h"
#include "fixes/fix_clump.h"
#include "fixes/fix_contact_energy.h"
#include "fixes/fix_contact_events.h"
#include "fixes/fix_contact_local.h"
#include "fixes/fix_contact_way.h"
#include "fixes/fix_drum_excite.h"
#include "fixes/fix_drum_travel.h"
#include "fixes/fix_guard.h"
#include "fixes/fix_roller_history.h"

namespace drumlin {

/// A fix as a type.
template <class Fix>
struct FixType {
  using type = Fix;
};

/// Calls add(FixType, name, description) for each fix: the list from which both engines register them.
template <class Add>
void for_each_fix(Add &&add) {
  add(FixType<LAMMPS_NS::FixDrumExcite>(), "drum/excite", "harmonic excitation of a drum");
  add(FixType<LAMMPS_NS::FixDrumTravel>(), "drum/travel", "a roller that drives");
  add(FixType<LAMMPS_NS::FixBondSpring>(), "bond/spring", "bonded spring-dashpot");
  add(FixType<LAMMPS_NS::FixBoundaryAbsorb>(), "boundary/absorb", "boundary of balls that absorbs waves");
  add(FixType<LAMMPS_NS::FixClump>(), "clump", "rigid body that translates and may tilt");
  add(FixType<LAMMPS_NS::FixContactEvents>(), "contact/events", "makes and breaks of contact");
  add(FixType<LAMMPS_NS::FixContactLocal>(), "contact/local", "contacts and their forces for dump local");
  add(FixType<LAMMPS_NS::FixContactEnergy>(), "contact/energy", "energies of balls and contacts, and heat");
  add(FixType<LAMMPS_NS::FixContactWay>(), "contact/way", "soil that changes along a way");
  add(FixType<LAMMPS_NS::FixRollerHistory>(), "roller/history", "motion and forces of drum and frame");
  add(FixType<LAMMPS_NS::FixGuard>(), "guard", "checks of time step, overlaps and finite numbers");
}

} // namespace drumlin
