// The report's page: one XHTML5 file without scripts that needs no network.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "pages/html.h"
#include "report/chain_figures.h"
#include "report/chain_measures.h"
#include "report/chain_tables.h"

namespace drumlin::post {

/// Programs that the report was made with, for the record.
struct ReportVersions {
  std::string drumlin;
  std::string direct_solver;
  std::string gnuplot;
  std::string made_at; ///< date and time, UTC
};

/// "Made on ... by drumlin ...".
std::string made_line(const ReportVersions &versions);

/// A study beside the report.
struct StudyLink {
  std::string place; ///< link to its index.html, relative to the report's
  std::string title; ///< plain text
};

/// The page of the report. Figures are expected at figures/NAME.svg and .png, data at data/NAME.csv beside it. With bed runs it
/// links their page, bed.html, and without any other runs it has no sections on these.
/// \param beds names of the bed runs
std::string report_page(const ReportResults &results, const std::vector<ReportTable> &tables,
                        const FigurePlan &plan, const std::vector<std::string> &beds,
                        const std::vector<StudyLink> &studies, const ReportVersions &versions);

} // namespace drumlin::post
