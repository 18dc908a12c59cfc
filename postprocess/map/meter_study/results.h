// Results of the meter study: the rows of its file records.csv, and where a value turns as k grows.
#pragma once

#include "support/csv_schema.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace drumlin::post {

/// What identification finds in a record.
struct FoundStiffness {
  double k = std::numeric_limits<double>::quiet_NaN();          ///< [N/m]; NaN: no identification
  double half_width = std::numeric_limits<double>::quiet_NaN(); ///< of its 95 % confidence interval [N/m]
};

/// A record of a roller on soil of one stiffness. The first two name it. NaN: the record does not give the
/// value.
struct SoilPoint {
  std::string roller;         ///< case of Table 1, or MACHINE-SETTING of a file in inputs/rollers
  double k = 0.0;             ///< stiffness of the soil [N/m]
  std::string mode;           ///< as in mode_names
  double cmv = 0.0;           ///< [-]
  double rmv = 0.0;           ///< [-]
  double k_B = 0.0;           ///< [N/m]
  double k_1 = 0.0;           ///< [N/m]
  double c_1 = 0.0;           ///< [N s/m]
  double E_vib = 0.0;         ///< [Pa]
  double energy = 0.0;        ///< in two cycles [J]
  double peak_force = 0.0;    ///< [N]
  double contact_share = 0.0; ///< [-]
  FoundStiffness exact;       ///< from the record as it is
  FoundStiffness measured;    ///< from noisy accelerations alone
};

/// The columns of records.csv.
inline const CsvSchema<SoilPoint> &soil_points() {
  constexpr int digits = 9;
  static const CsvSchema<SoilPoint> schema(
      {csv_column("roller", &SoilPoint::roller), csv_column("k [N/m]", &SoilPoint::k),
       csv_column("mode", &SoilPoint::mode), csv_column("CMV [-]", &SoilPoint::cmv, digits),
       csv_column("RMV [-]", &SoilPoint::rmv, digits), csv_column("k_B [N/m]", &SoilPoint::k_B, digits),
       csv_column("k_1 [N/m]", &SoilPoint::k_1, digits), csv_column("c_1 [N s/m]", &SoilPoint::c_1, digits),
       csv_column("E_vib [Pa]", &SoilPoint::E_vib, digits),
       csv_column("energy_two_cycles [J]", &SoilPoint::energy, digits),
       csv_column("peak_force [N]", &SoilPoint::peak_force, digits),
       csv_column("contact_share [-]", &SoilPoint::contact_share, digits),
       csv_column("k_identified [N/m]", &SoilPoint::exact, &FoundStiffness::k, digits),
       csv_column("k_identified_half_width [N/m]", &SoilPoint::exact, &FoundStiffness::half_width, digits),
       csv_column("k_measured [N/m]", &SoilPoint::measured, &FoundStiffness::k, digits),
       csv_column("k_measured_half_width [N/m]", &SoilPoint::measured, &FoundStiffness::half_width, digits)},
      2);
  return schema;
}

/// A roller of the study, and how the page names it.
struct SoilRoller {
  const char *name; ///< as in SoilPoint
  const char *title;
};
constexpr std::array<SoilRoller, 9> soil_rollers = {{{"II", "paper, 20 Hz"},
                                                     {"III", "paper, 40 Hz"},
                                                     {"BW120-63Hz", "BW 120, 63 Hz"},
                                                     {"BW120-67Hz", "BW 120, 67 Hz"},
                                                     {"CA3500-high", "CA3500, high amplitude"},
                                                     {"CA3500-low", "CA3500, low amplitude"},
                                                     {"CA6500-high", "CA6500, high amplitude"},
                                                     {"CA6500-low", "CA6500, low amplitude"},
                                                     {"Axas2020-29Hz", "Axas 2020, 29 Hz"}}};

/// Where a sequence turns: the indices of its maxima and minima, in turn, between its ends. Ups and downs
/// smaller than `least` do not count.
inline std::vector<std::size_t> turning_points(const std::vector<double> &values, double least) {
  std::vector<std::size_t> turns;
  std::size_t low = 0; // lowest and highest value since the last turn
  std::size_t high = 0;
  int direction = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] < values[low]) low = i;
    if (values[i] > values[high]) high = i;
    const bool falls = direction >= 0 && values[high] - values[i] > least;
    const bool rises = direction <= 0 && values[i] - values[low] > least;
    if (!falls && !rises) continue;
    if (direction != 0) turns.push_back(falls ? high : low);
    direction = falls ? -1 : 1;
    low = high = i;
  }
  return turns;
}

/// Writes the figures, the tables and index.html into the study's folder. \param points k growing
void write_soil_page(const std::filesystem::path &out, const std::vector<SoilPoint> &points);

} // namespace drumlin::post
