// What `drumlin map` can make. Each function computes one kind of map or sweep, writes tables, figures and
// page into a folder, and prints a summary. Points in tables of an earlier call are read, not computed again.
#pragma once

#include "map/ends_map.h"
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

} // namespace drumlin::post
