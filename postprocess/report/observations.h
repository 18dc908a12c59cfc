// The page of observations: what others have seen rollers do, beside what the model says.
#pragma once

#include "pages/table.h"

#include <filesystem>
#include <vector>

namespace drumlin::post {

/// The file by which a folder of observations is recognised: a row for each, with the columns `observed`,
/// `figure and interval` (of the model), `verdict`, `remark`, `source`, `read` (what of the source was read),
/// `scene` and `command`.
constexpr const char *observations_file = "observations.csv";

/// Title of the page.
constexpr const char *observations_title = "What rollers have been observed to do, and what the model says";

/// The rows of the files, those first in which model and observation differ; rows of one verdict keep their
/// order. Throws std::runtime_error for a file that cannot be read or has no rows, and for a verdict other
/// than "differs", "differs in part", "agrees" and "not modelled".
PageTable read_observations(const std::vector<std::filesystem::path> &files);

/// Writes the page of a table of observations into a folder. Throws std::runtime_error.
void write_observations_page(const std::filesystem::path &folder, const PageTable &observations);

} // namespace drumlin::post
