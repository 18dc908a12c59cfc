#include "fixes/roller_tables.h"

namespace drumlin {

std::string history_header(bool with_frame, bool with_bed, bool travels, bool tilts) {
  std::string way = !travels   ? ""
                    : with_bed ? ",s,pass,traction,torque,work_traction,work_torque"
                               : ",s,pass";
  if (tilts) way += ",theta_drum,omega_drum,theta_frame,omega_frame,a_left,a_right,F_left,F_right";
  if (!with_frame) return "time,x_drum,v_drum,a_drum,F_contact,F_excitation" + way;
  const std::string roller =
      "time,x_drum,v_drum,a_drum,x_frame,v_frame,a_frame,F_contact,F_excitation,F_bond";
  return (with_bed ? roller + ",settlement,overlap_ratio,coordination,void_ratio,kinetic,potential,elastic,"
                              "dissipated,work_excitation,F_floor,F_sides,F_thrust"
                   : roller) +
         way;
}

std::vector<double> history_row(const RollerState &state, const CycleSums &cycle, const RollerMasses &masses,
                                bool with_frame, const BedSample *bed) {
  const BodyMotion &drum = state.drum;
  const BodyMotion &frame = state.frame;
  const RollerForces &forces = state.forces;
  if (!with_frame) return {state.time, drum.x, drum.v, drum.a, forces.contact, forces.excitation};
  std::vector<double> row = {state.time,        drum.x,     drum.v,  drum.a,
                             frame.x,           frame.v,    frame.a, forces.contact,
                             forces.excitation, forces.bond};
  if (bed == nullptr) return row;
  const ContactSums &contacts = bed->contacts;
  row.insert(row.end(),
             {cycle.settlement, contacts.contacts > 0.0 ? contacts.overlap / contacts.contacts : 0.0,
              contacts.coordination / bed->balls.soil_balls, bed->void_ratio, bed->balls.kinetic,
              masses.gravity * bed->raised, forces.contact_stored + forces.bond_stored + forces.ground_stored,
              cycle.contact_dissipated + cycle.bond_dissipated + bed->friction_heat + forces.ground_heat +
                  bed->yield_heat,
              cycle.work, contacts.floor_force, contacts.side_force, contacts.side_thrust});
  return row;
}

std::vector<double> tilts_of(const RollerState &state, double sensor) {
  const BodyMotion &drum = state.drum, &frame = state.frame;
  const double more = sensor * drum.acceleration;
  return {drum.tilt,     drum.rate,     frame.tilt,        frame.rate,
          drum.a - more, drum.a + more, state.forces.left, state.forces.right};
}

std::string cycles_header(bool with_bed, bool absorbs, bool yields, bool travels) {
  const std::string work = travels ? ",work_travel" : "";
  std::string columns = "cycle,time,a_drum_min,a_drum_max,F_contact_min,F_contact_max,contact_share,a1_cos,"
                        "a1_sin,a2_cos,a2_sin,ah_cos,ah_sin,work_excitation,dissipated_contact,dissipated_"
                        "bond,kinetic,potential,stored_contact,stored_bond";
  if (!with_bed) return columns + work;
  return columns + ",dissipated_friction,settlement" + (absorbs ? ",stored_ground,dissipated_ground" : "") +
         (yields ? ",dissipated_yield" : "") + work;
}

std::vector<double> cycles_row(const RollerState &state, const CycleSums &cycle, const RollerMasses &masses,
                               const BedSample *bed) {
  const BodyMotion &drum = state.drum;
  const BodyMotion &frame = state.frame;
  const RollerForces &forces = state.forces;
  const double share =
      cycle.steps > 0.0 ? cycle.contact_steps / cycle.steps : (forces.in_contact ? 1.0 : 0.0);
  std::vector<double> row = {cycle.number, state.time,  cycle.a_min, cycle.a_max,
                             cycle.F_min,  cycle.F_max, share};
  row.insert(row.end(), cycle.harmonic.begin(), cycle.harmonic.end());
  const double kinetic = bed != nullptr
                             ? bed->balls.kinetic
                             : 0.5 * (masses.drum * drum.v * drum.v + masses.frame * frame.v * frame.v) +
                                   0.5 * (masses.drum_inertia * drum.rate * drum.rate +
                                          masses.frame_inertia * frame.rate * frame.rate);
  const double potential =
      masses.gravity * (bed != nullptr ? bed->raised : masses.drum * drum.x + masses.frame * frame.x);
  row.insert(row.end(), {cycle.work, cycle.contact_dissipated, cycle.bond_dissipated, kinetic, potential,
                         forces.contact_stored, forces.bond_stored});
  if (bed != nullptr)
    row.insert(row.end(), {bed->friction_heat, cycle.steps > 0.0 ? cycle.sinking / cycle.steps : 0.0});
  if (bed != nullptr && bed->absorbs) row.insert(row.end(), {forces.ground_stored, forces.ground_heat});
  if (bed != nullptr && bed->yields) row.push_back(bed->yield_heat);
  return row;
}

void write_row(FILE *file, const std::vector<double> &row) {
  if (file == nullptr) return;
  for (std::size_t n = 0; n < row.size(); ++n)
    std::fprintf(file, n == 0 ? "%.17g" : ",%.17g", row[n]);
  std::fputc('\n', file);
}

} // namespace drumlin
