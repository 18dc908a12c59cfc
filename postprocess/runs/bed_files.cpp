#include "runs/bed_files.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>

namespace drumlin::post {

BedHistory read_bed_history(const std::filesystem::path &file, std::size_t rows, CutRows cut) {
  const Table table = read_table(file, cut);
  const auto numbers = [&](const char *column) {
    std::vector<double> values = table.numbers(column);
    values.resize(std::min(values.size(), rows));
    return values;
  };
  BedHistory bed;
  bed.coordination = numbers("coordination");
  bed.void_ratio = numbers("void_ratio");
  bed.kinetic = numbers("kinetic");
  bed.potential = numbers("potential");
  bed.elastic = numbers("elastic");
  bed.dissipated = numbers("dissipated");
  bed.work_excitation = numbers("work_excitation");
  bed.F_floor = numbers("F_floor");
  bed.F_sides = numbers("F_sides");
  bed.F_thrust = numbers("F_thrust");
  return bed;
}

DriveHistory read_drive_history(const std::filesystem::path &file, std::size_t most_rows) {
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
  while (history.size() < most_rows && rows.next(cells))
    for (const Column &column : columns)
      (history.*column.values).push_back(csv_number(file, rows.line(), column.name, cells[column.place]));
  return history;
}

} // namespace drumlin::post
