// `drumlin report`: makes a folder with pages, figures and data from run folders: index.html, bed.html for
// runs on beds, ends.html for runs of a drum that tilts.
#pragma once

#include "report/chain/tables.h"
#include "report/content.h"
#include "support/progress.h"

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// Input and place of a report.
struct ReportOptions {
  std::vector<std::filesystem::path> folders; ///< run and study folders or parents of them
  std::filesystem::path out = "report";       ///< replaced as a whole if it is an earlier report
  std::string version = "unknown";            ///< of this program, printed in the report
  ProgressSink progress;                      ///< is called with a line for each piece of work; may be empty
};

/// Result of a report.
struct ReportOutcome {
  std::filesystem::path page; ///< index.html
  CheckCount checks;
  std::vector<std::string> judging_commands; ///< that repeat runs which are too short to be judged, each once
  std::vector<LeftOut> left_out;             ///< runs that were cut, and what cannot be read
};

/// Makes the report in a temporary folder next to `out` and moves it there when it is complete. Throws
/// UsageError for folders or files that cannot be used, std::runtime_error for other failures; an earlier
/// report then stays as it was.
ReportOutcome write_report(const ReportOptions &options);

/// The text of report.json.
std::string summary_json(const ReportContent &content);

} // namespace drumlin::post
