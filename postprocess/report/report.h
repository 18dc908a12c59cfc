// `drumlin report`: from run folders to a folder with index.html, bed.html if there are runs of beds, figures and data.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/chain_tables.h"
#include "support/progress.h"

namespace drumlin::post {

/// What to report on, and where to.
struct ReportOptions {
  std::vector<std::filesystem::path> folders; ///< run and study folders or parents of them
  std::filesystem::path out = "report";       ///< replaced as a whole if it is an earlier report
  std::string version = "unknown";            ///< of this project, printed in the report
  ProgressSink progress;                      ///< gets one line per piece of work; may be empty
};

/// What came of it.
struct ReportOutcome {
  std::filesystem::path page; ///< index.html
  CheckCount checks;
  std::vector<std::string> judging_commands; ///< of runs that are too short to be judged, each once
};

/// Makes the report in a folder beside `out` and moves it there when it is whole. Throws UsageError for
/// folders or files that cannot be used (an earlier report then stays as it was), std::runtime_error for
/// other failures.
ReportOutcome write_report(const ReportOptions &options);

} // namespace drumlin::post
