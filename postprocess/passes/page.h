// The page on what passes leave: the compaction curve, surface and meter along the way, profiles over depth.
#pragma once

#include "passes/map_figures.h"
#include "passes/values.h"

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// In one sentence: by how much the passes compact the lift, the uppermost layer, to which degree, after how
/// many of them the gain falls below 5 % of the whole, how much of the settlement is compaction, and how sure
/// that is. Several runs are beds of different seeds. \pre not empty, of equal layers
std::string answer_of(const std::vector<PassesResult> &results);

/// Writes the page index.html with plots and their data into a folder that exists. Of several runs it has
/// means with 95 % intervals, and the cells of all are judged together; surface, map, profile and animation
/// are those of the first.
void write_passes_page(const std::filesystem::path &folder, const std::vector<PassesResult> &results,
                       const JudgedMap &judged);

} // namespace drumlin::post
