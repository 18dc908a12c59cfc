// report.json: the numbers of a report for programs.
#pragma once

#include <string>

#include "report/content.h"

namespace drumlin::post {

/// The text of report.json.
std::string summary_json(const ReportContent &content);

} // namespace drumlin::post
