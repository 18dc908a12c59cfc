#include "runs/bed_files.h"

#include "support/csv.h"

#include <array>
#include <optional>
#include <string>

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

DriveHistory read_drive_history(const std::filesystem::path &file) {
  struct Column {
    const char *name;
    std::vector<double> DriveHistory::*values;
    std::size_t place;
  };
  std::array<Column, 7> columns = {{{"time", &DriveHistory::time, 0},
                                    {"s", &DriveHistory::s, 0},
                                    {"pass", &DriveHistory::pass, 0},
                                    {"traction", &DriveHistory::traction, 0},
                                    {"work_excitation", &DriveHistory::work_excitation, 0},
                                    {"work_traction", &DriveHistory::work_traction, 0},
                                    {"work_torque", &DriveHistory::work_torque, 0}}};
  CsvRows rows(file, CutRows::last);
  for (Column &column : columns) {
    const std::optional<std::size_t> place = rows.find(column.name);
    if (!place) rows.missing(column.name);
    column.place = *place;
  }
  DriveHistory history;
  std::vector<std::string> cells;
  while (rows.next(cells))
    for (const Column &column : columns)
      (history.*column.values).push_back(csv_number(file, rows.line(), column.name, cells[column.place]));
  return history;
}

} // namespace drumlin::post
