// `drumlin report`: the report from the command line.
#pragma once

#include "support/usage_error.h"

#include <string>
#include <vector>

namespace drumlin::post {

/// The options as given.
struct ReportArguments {
  std::vector<std::string> folders; ///< run folders, studies, or parents of either
  std::string out = "report";       ///< folder for the report
};

/// Writes the report and prints its progress, the number of checks that agree and its first page. Throws UsageError for folders and files
/// that cannot be used; an earlier report then stays as it was.
void print_report(const ReportArguments &arguments);

/// Adds `report DIR... [--out report]`, which reads run folders and writes a folder with index.html.
void add_report_command(CLI::App &app, Session &session);

} // namespace drumlin::post
