// The folder of a report: whether it may be replaced, and how a new report takes its place.
#pragma once

#include <filesystem>
#include <string>

#include "report/run_folder.h"
#include "support/files.h"

namespace drumlin::post {

/// Every report has this file, and only folders with it are replaced.
constexpr const char *summary_file = "report.json";

/// The report's folder as an absolute path without a trailing slash; its parent is made. Throws UsageError if
/// it may not be replaced: it is no earlier report, or holds one of the folders that the report is made from.
std::filesystem::path checked_place(const std::filesystem::path &out, const ReportFolders &folders);

/// A report that is being written, in a hidden folder beside its place. The constructor first removes what a
/// killed process left there, and puts an earlier report back if the process was killed while it replaced
/// that report.
class Draft {
public:
  explicit Draft(const std::filesystem::path &place);
  const std::filesystem::path &folder() const { return folder_.path(); }

  /// Moves the draft to its place. If that fails, an earlier report comes back and std::runtime_error says
  /// why.
  void publish();

private:
  std::string prefix(const char *what) const;
  std::string prefix_after_rescue() const;

  std::filesystem::path place_;
  TemporaryFolder folder_;
};

} // namespace drumlin::post
