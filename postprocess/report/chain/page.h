// The report's first page: the answer, then chains and single impacts in full, with links to the pages on
// beds, drums with two ends and studies.
#pragma once

#include "report/content.h"

#include <string>

namespace drumlin::post {

/// "Made on ... by drumlin ...".
std::string made_line(const ReportVersions &versions);

/// The page. Figures are expected at figures/NAME.svg and .png, data at data/NAME.csv, the pages on beds and
/// on drums with two ends at bed.html and ends.html in the same folder. Sections for which there is no
/// content are left out.
std::string report_page(const ReportContent &content);

} // namespace drumlin::post
