// The folder of a report: whether it may be replaced.
#pragma once

#include <filesystem>

#include "report/run_folder.h"

namespace drumlin::post {

/// Every report has this file, and only folders with it are replaced.
constexpr const char *summary_file = "report.json";

/// The report's folder as an absolute path without a trailing slash; its parent is made. Throws UsageError if
/// it may not be replaced: it is no earlier report, or holds one of the folders that the report is made from.
std::filesystem::path checked_place(const std::filesystem::path &out, const ReportFolders &folders);

} // namespace drumlin::post
