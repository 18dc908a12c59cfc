#include "runs/element_rows.h"

#include <fmt/format.h>

#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// Columns of a test's CSV file, and the members of Row that take their numbers.
template <class Row>
using RowColumns = std::vector<std::pair<const char *, double Row::*>>;

/// The rows of a table. Throws std::runtime_error with file, line and column for a column that is missing or
/// a number that is not finite.
template <class Row>
std::vector<Row> rows_of(const Table &table, const RowColumns<Row> &columns) {
  std::vector<Row> rows(table.rows());
  for (const auto &[name, number] : columns) {
    const std::vector<double> values = table.numbers(name);
    for (std::size_t n = 0; n < rows.size(); ++n)
      rows[n].*number = values[n];
  }
  return rows;
}

} // namespace

Table read_element_table(const std::filesystem::path &file) {
  Table table = read_table(file, CutRows::forget);
  if (table.rows() < 2)
    throw std::runtime_error(fmt::format("{}: {} rows; allowed are 2 or more", file.string(), table.rows()));
  return table;
}

std::vector<OedometerRow> read_oedometer(const fs::path &file) {
  const Table table = read_element_table(file);
  std::vector<OedometerRow> rows =
      rows_of<OedometerRow>(table, {{"stress_kPa", &OedometerRow::stress},
                                    {"settlement_mm", &OedometerRow::settlement},
                                    {"strain", &OedometerRow::strain},
                                    {"void_ratio", &OedometerRow::void_ratio},
                                    {"inertial_number", &OedometerRow::inertial_number},
                                    {"energy_error", &OedometerRow::energy_error}});
  const std::vector<std::string> moduli = table.text("modulus_MPa");
  rows.front().modulus = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t n = 1; n < rows.size(); ++n)
    rows[n].modulus = csv_number(file, table.line(n), "modulus_MPa", moduli[n]);
  return rows;
}

std::vector<DensityRow> read_density(const fs::path &file) {
  const Table table = read_element_table(file);
  std::vector<DensityRow> rows =
      rows_of<DensityRow>(table, {{"share", &DensityRow::share},
                                  {"friction", &DensityRow::friction},
                                  {"rolling", &DensityRow::rolling},
                                  {"void_ratio", &DensityRow::void_ratio},
                                  {"solid_fraction", &DensityRow::solid_fraction},
                                  {"relative_density", &DensityRow::relative_density},
                                  {"compaction", &DensityRow::compaction},
                                  {"coordination", &DensityRow::coordination}});
  if (table.has("made")) {
    const std::vector<std::string> made = table.text("made");
    for (std::size_t n = 0; n < rows.size(); ++n)
      rows[n].made = made[n];
  }
  return rows;
}

std::vector<CompressionRow> read_compression(const fs::path &file) {
  const Table table = read_element_table(file);
  std::vector<CompressionRow> rows =
      rows_of<CompressionRow>(table, {{"strain", &CompressionRow::strain},
                                      {"axial_stress_kPa", &CompressionRow::axial_stress},
                                      {"side_stress_kPa", &CompressionRow::side_stress},
                                      {"volumetric_strain", &CompressionRow::volumetric_strain},
                                      {"void_ratio", &CompressionRow::void_ratio},
                                      {"coordination", &CompressionRow::coordination},
                                      {"inertial_number", &CompressionRow::inertial_number},
                                      {"energy_error", &CompressionRow::energy_error}});
  if (table.has("front_stress_kPa")) {
    const std::vector<double> front = table.numbers("front_stress_kPa");
    for (std::size_t n = 0; n < rows.size(); ++n)
      rows[n].side_stress = 0.5 * (rows[n].side_stress + front[n]);
  }
  for (std::size_t n = 0; n < rows.size(); ++n)
    if (rows[n].side_stress <= 0.0 || rows[n].axial_stress <= 0.0 ||
        (n > 0 && rows[n].strain <= rows[n - 1].strain))
      throw std::runtime_error(fmt::format(
          "{}, line {}: strain {:g} at {:g} and {:g} kPa; allowed are strains that grow, at stresses above 0",
          file.string(), table.line(n), rows[n].strain, rows[n].axial_stress, rows[n].side_stress));
  return rows;
}

std::vector<ShearRow> read_shear(const fs::path &file) {
  const Table table = read_element_table(file);
  std::vector<ShearRow> rows = rows_of<ShearRow>(table, {{"shear_strain", &ShearRow::strain},
                                                         {"shear_stress_kPa", &ShearRow::shear_stress},
                                                         {"normal_stress_kPa", &ShearRow::normal_stress},
                                                         {"volumetric_strain", &ShearRow::volumetric_strain},
                                                         {"void_ratio", &ShearRow::void_ratio},
                                                         {"inertial_number", &ShearRow::inertial_number},
                                                         {"energy_error", &ShearRow::energy_error}});
  for (std::size_t n = 0; n < rows.size(); ++n)
    if (rows[n].normal_stress <= 0.0 || (n > 0 && rows[n].strain <= rows[n - 1].strain))
      throw std::runtime_error(fmt::format("{}, line {}: strain {:g} at a normal stress of {:g} kPa; allowed "
                                           "are strains that grow, at normal stresses above 0",
                                           file.string(), table.line(n), rows[n].strain,
                                           rows[n].normal_stress));
  return rows;
}

std::vector<LoopRow> read_loops(const fs::path &file) {
  const Table table = read_table(file, CutRows::forget);
  if (table.rows() == 0)
    throw std::runtime_error(fmt::format("{}: 0 rows; allowed are 1 or more", file.string()));
  return rows_of<LoopRow>(table, {{"cycle", &LoopRow::cycle},
                                  {"amplitude", &LoopRow::amplitude},
                                  {"secant_modulus_MPa", &LoopRow::secant_modulus},
                                  {"damping_ratio", &LoopRow::damping_ratio},
                                  {"damping_ratio_of_heat", &LoopRow::damping_ratio_of_heat},
                                  {"volumetric_strain", &LoopRow::volumetric_strain},
                                  {"void_ratio", &LoopRow::void_ratio}});
}

std::vector<PlateRow> read_plate(const fs::path &file) {
  const Table table = read_element_table(file);
  std::vector<PlateRow> rows = rows_of<PlateRow>(table, {{"phase", &PlateRow::phase},
                                                         {"stress_kPa", &PlateRow::stress},
                                                         {"settlement_mm", &PlateRow::settlement},
                                                         {"inertial_number", &PlateRow::inertial_number},
                                                         {"energy_error", &PlateRow::energy_error}});
  for (std::size_t n = 0; n < rows.size(); ++n)
    if (rows[n].phase != 0.0 && rows[n].phase != 1.0 && rows[n].phase != 2.0 && rows[n].phase != 3.0)
      throw std::runtime_error(fmt::format("{}, line {}: column 'phase' is '{:g}'; allowed: 0, 1, 2 or 3",
                                           file.string(), table.line(n), rows[n].phase));
  return rows;
}

std::vector<OwnWeightRow> read_own_weight(const fs::path &file) {
  const Table table = read_element_table(file);
  std::vector<OwnWeightRow> rows =
      rows_of<OwnWeightRow>(table, {{"displacement_mm", &OwnWeightRow::displacement},
                                    {"left_force_N", &OwnWeightRow::left_force},
                                    {"left_friction_N", &OwnWeightRow::left_friction},
                                    {"side_force_N", &OwnWeightRow::side_force},
                                    {"side_friction_N", &OwnWeightRow::side_friction},
                                    {"floor_force_N", &OwnWeightRow::floor_force},
                                    {"inertial_number", &OwnWeightRow::inertial_number},
                                    {"energy_error", &OwnWeightRow::energy_error}});
  for (std::size_t n = 1; n < rows.size(); ++n)
    if (rows[n].displacement <= rows[n - 1].displacement)
      throw std::runtime_error(
          fmt::format("{}, line {}: column 'displacement_mm' is '{:g}'; allowed: more than in the row before",
                      file.string(), table.line(n), rows[n].displacement));
  return rows;
}

} // namespace drumlin::post
