// Engine against engine: runs of one chain in LIGGGHTS and in LAMMPS, which differ by rounding if all is well.
#pragma once

#include "report/chain_measures.h"
#include "report/chain_tables.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace drumlin::post {

/// Relative difference that rounding leaves between two engines.
constexpr double engines_agree_to = 1e-9;

/// Chain runs of different engines whose parameters are the same: places in ReportResults::runs.
std::vector<std::pair<std::size_t, std::size_t>> engine_pairs(const ReportResults &results);

/// One row for each pair: the largest difference of every column over its largest value, and events. Without rows if there is no pair.
ReportTable engine_table(const ReportResults &results);

} // namespace drumlin::post
