// The figures of bed runs: histories, loops, settlement, energies, forces of the walls, and pictures of the
// bed from the run's dumps.
#pragma once

#include <string>
#include <vector>

#include "report/bed/measures.h"
#include "report/chain/figures.h"

namespace drumlin::post {

/// Id of the page's section that shows a group; groups count from 0.
std::string bed_section(std::size_t group);

/// All figures of the groups, numbered from 1. Reads the dumps of the runs: std::runtime_error for a dump
/// that cannot be read.
FigurePlan plan_bed_figures(const std::vector<BedGroup> &groups);

} // namespace drumlin::post
