// The page of the speed study.
#pragma once

#include <array>
#include <filesystem>
#include <string>

namespace drumlin::post {

/// Laws that are compared in one engine, as runs.csv names them: the engine's own, and the plugin's with
/// stock and with second stepping.
struct EngineLaws {
  const char *own, *stock, *second;
  double allowed_stock, allowed_second; ///< time over that of the engine's law, in three dimensions
  std::array<const char *, 3> all() const { return {own, stock, second}; }
};
constexpr std::array<EngineLaws, 2> engine_laws = {
    {{"engine law", "stock", "second", 0.95, 1.05},
     {"LAMMPS's law", "LAMMPS stock", "LAMMPS second", 0.85, 1.00}}};

/// The beds of the study, as runs.csv names them.
struct SpeedScenes {
  std::string plane, cell, copies;
};

/// index.html with its tables and figure in the study's folder, from its runs.csv.
void write_speed_page(const std::filesystem::path &out, const SpeedScenes &scenes);

} // namespace drumlin::post
