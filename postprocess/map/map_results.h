// What `drumlin map` can make. Each function computes one kind of map or sweep, writes tables, figures and
// page into a folder, and prints a summary. Points in tables of an earlier call are read, not computed again.
#pragma once

#include "chain/parameters.h"
#include "map/ends.h"
#include "map/regime_map.h"
#include "meter/values.h"

#include <filesystem>
#include <optional>
#include <string>

namespace drumlin::post {

struct MapTask {
  MapGrid grid;
  std::string roller;              ///< a sentence on the roller of a file; empty: none
  std::optional<MapAxis> sweep;    ///< of sweeps
  std::optional<LineContact> drum; ///< of a course
  int identify = 10;               ///< of a course: every so many-th point
  int threads = 1;
  std::optional<EndsFamily> ends; ///< a drum with two ends
  std::filesystem::path out;
};

/// The file of the settings, which the pages link.
constexpr const char *map_record_name = "parameters.csv";

/// The motions over both axes of the grid.
void write_regime_map(const MapTask &task);
/// What the meter shows along the first axis.
void write_course(const MapTask &task);
/// The motion followed along an axis up and down.
void write_sweep(const MapTask &task);
/// The same maps and sweeps of a drum with two ends.
void write_ends_map(const MapTask &task);
void write_ends_sweep(const MapTask &task);

/// A roller of the study on soil with D of case II; width and diameter of its drum [m] if its file has them.
struct SoilMachine {
  ChainParameters chain;
  std::optional<double> width, diameter;
};
/// \param roller case of Table 1, or MACHINE-SETTING of a file in inputs/rollers
SoilMachine soil_machine(const std::string &roller);

/// Makes the records that the folder does not have yet, and writes there
///   records.csv  meter values, regime and identified stiffness of each point
///   index.html   tables and figures
/// \param quick few points, to see that it works
void run_meter_study(const std::filesystem::path &out, bool quick);

} // namespace drumlin::post
