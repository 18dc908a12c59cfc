// Runs of one chain in LIGGGHTS and in LAMMPS, compared with each other. They should differ by rounding
// errors only.
#pragma once

#include "report/chain/measures.h"
#include "report/chain/tables.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace drumlin::post {

/// Largest relative difference at which two engines count as equal but for rounding.
constexpr double engines_agree_to = 1e-9;

/// Pairs of chain runs in different engines with the same parameters: indices into ReportResults::runs.
std::vector<std::pair<std::size_t, std::size_t>> engine_pairs(const ReportResults &results);

/// A row for each pair: the largest difference of each column over the column's largest value, and the
/// largest difference of event times. No rows if there is no pair.
PageTable engine_table(const ReportResults &results);

} // namespace drumlin::post
