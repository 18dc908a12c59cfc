// The report's page on runs of the roller on a bed of balls: bed.html beside index.html.
#pragma once

#include <string>
#include <vector>

#include "report/bed_measures.h"
#include "report/chain_figures.h"
#include "report/chain_page.h"
#include "report/chain_tables.h"

namespace drumlin::post {

/// The numbers of all bed runs, one row each: the roller's motion, and what becomes of the bed.
std::vector<ReportTable> bed_tables(const std::vector<BedResult> &beds);

/// The page. Figures and data are expected where report_page() expects them.
std::string bed_page(const std::vector<BedResult> &beds, const std::vector<BedGroup> &groups,
                     const std::vector<ReportTable> &tables, const FigurePlan &plan,
                     const ReportVersions &versions);

} // namespace drumlin::post
