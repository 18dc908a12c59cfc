// The page of the timing study.
#pragma once

#include <array>
#include <filesystem>
#include <string>

namespace drumlin::post {

/// Laws with friction that are compared in one engine, as runs.csv names them: the engine's own, and the
/// plugin's with stock and with second stepping.
struct EngineLaws {
  const char *own, *stock, *second;
  double allowed_stock, allowed_second; ///< time over that of the engine's law, in three dimensions
  std::array<const char *, 3> all() const { return {own, stock, second}; }
};
constexpr std::array<EngineLaws, 2> engine_laws = {
    {{"engine law + friction", "stock + coulomb", "second + coulomb", 0.95, 1.05},
     {"LAMMPS's law", "LAMMPS stock", "LAMMPS second", 0.85, 1.00}}};

/// Beds of growing size, as runs.csv names them.
struct TimedBeds {
  std::string plane, cell, copies;
};

/// Writes tables, figures and index.html from runs.csv in the study's folder.
void write_timing_page(const std::filesystem::path &out, const TimedBeds &beds);

} // namespace drumlin::post
