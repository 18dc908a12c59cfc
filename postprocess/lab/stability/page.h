// The page of the stability study.
#pragma once

#include "lab/stability/map.h"

#include <filesystem>
#include <vector>

namespace drumlin::post {

/// Writes the figure, the tables and index.html into the study's folder.
void write_stability_page(const std::filesystem::path &out, const std::vector<MapPoint> &map);

} // namespace drumlin::post
