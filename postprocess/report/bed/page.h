// The report's page on runs of the roller on a bed of balls: bed.html, next to index.html.
#pragma once

#include <string>
#include <vector>

#include "report/bed/measures.h"
#include "report/content.h"

namespace drumlin::post {

/// The numbers of all bed runs, a row each: the motion of the roller, and the state of the bed.
std::vector<PageTable> bed_tables(const std::vector<BedResult> &beds);

/// The page. Figures and data are expected where report_page() expects them.
std::string bed_page(const ReportContent &content);

} // namespace drumlin::post
