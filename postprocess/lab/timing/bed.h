// The settled beds that the study of time runs on, and the laws that it compares there:
// inputs/study/in.cost_bed.
#pragma once

#include "engine/engine_run.h"

#include <filesystem>
#include <string>

namespace drumlin::post {

/// A bed on a lattice, settled; or copies of it, side by side.
struct TimedBed {
  int columns, layers, rows; ///< one layer: a bed in the plane
  int settling;              ///< steps that settle it
  int copies_x = 1;
  int copies_y = 1;

  int balls() const { return columns * layers * rows * copies_x * copies_y; } ///< number of balls that move
  std::string name() const;
  Variables sides() const; ///< deck variables of all runs on it
};

/// The bed's data file in a folder; it is made if no earlier call has finished it.
std::filesystem::path settled(const TimedBed &bed, const std::filesystem::path &folder);

/// Words of the pair style: of the engine's own law, and of the plugin's with the same dashpot coefficient
/// for every pair of balls.
std::string engine_law(const std::string &models);
std::string plugin_law(const std::string &models, const std::string &stepping);

} // namespace drumlin::post
