// `drumlin report`: the report from the command line.
#pragma once

#include "support/usage_error.h"

namespace drumlin::post {

/// Adds `report DIR... [--out report]`, which reads run folders and writes a folder with index.html.
void add_report_command(CLI::App &app, Session &session);

} // namespace drumlin::post
