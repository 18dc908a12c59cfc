// The page of the speed study.
#pragma once

#include <filesystem>
#include <string>

namespace drumlin::post {

/// How runs.csv names the engine's own law.
constexpr const char *engine_law_name = "engine law";

/// The scenes that the page speaks of, as runs.csv names them.
struct SpeedScenes {
  std::string plane, cell, copies;
};

/// index.html with its tables and figure in the study's folder, from its runs.csv.
void write_speed_page(const std::filesystem::path &out, const SpeedScenes &scenes);

} // namespace drumlin::post
