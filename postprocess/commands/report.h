// `drumlin report`: the report from the command line.
#pragma once

#include <string>
#include <vector>

namespace drumlin::post {

/// The options as given.
struct ReportArguments {
  std::vector<std::string> folders; ///< run folders, studies, or parents of either
  std::string out = "report";       ///< folder for the report
};

/// Writes the report and prints its progress, the number of checks that agree and its first page. Throws
/// UsageError for folders and files that cannot be used; an earlier report then stays as it was.
void print_report(const ReportArguments &arguments);

} // namespace drumlin::post
