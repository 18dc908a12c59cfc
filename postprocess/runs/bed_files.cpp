#include "runs/bed_files.h"

#include "support/csv.h"

namespace drumlin::post {

BedHistory read_bed_history(const std::filesystem::path &file) {
  const Table table = read_table(file);
  BedHistory bed;
  bed.coordination = table.numbers("coordination");
  bed.void_ratio = table.numbers("void_ratio");
  bed.kinetic = table.numbers("kinetic");
  bed.potential = table.numbers("potential");
  bed.elastic = table.numbers("elastic");
  bed.dissipated = table.numbers("dissipated");
  bed.work_excitation = table.numbers("work_excitation");
  bed.F_floor = table.numbers("F_floor");
  bed.F_sides = table.numbers("F_sides");
  bed.F_thrust = table.numbers("F_thrust");
  return bed;
}

} // namespace drumlin::post
