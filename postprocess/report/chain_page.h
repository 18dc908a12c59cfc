// The report's first page: the answer, then chains and single impacts in full, with links to the pages on
// beds and studies.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "pages/html.h"
#include "report/bed_measures.h"
#include "report/chain_figures.h"
#include "report/chain_measures.h"
#include "report/chain_tables.h"

namespace drumlin::post {

/// Versions of the programs that made the report.
struct ReportVersions {
  std::string drumlin;
  std::string direct_solver;
  std::string gnuplot;
  std::string made_at; ///< date and time, UTC
};

/// "Made on ... by drumlin ...".
std::string made_line(const ReportVersions &versions);

/// A study that is part of the report.
struct StudyLink {
  std::string place; ///< link to its index.html, relative to the report's
  std::string title; ///< plain text
};

/// What a report is made of. With runs on beds only, `results` and `figures` are empty.
struct ReportContent {
  ReportResults results;
  FigurePlan figures;
  std::vector<BedResult> beds;
  std::vector<BedGroup> groups; ///< of `beds`, which must stay where they are
  FigurePlan bed_figures;
  std::vector<KeyFigure> keys;     ///< of the first page: with chains and beds one of each
  std::vector<KeyFigure> bed_keys; ///< of the page on beds
  std::vector<PageTable> bed_tables;
  std::vector<PageTable> tables; ///< all, those of beds included
  std::vector<StudyLink> studies;
  std::vector<LeftOut> left_out; ///< runs that were cut, and what cannot be read
  ReportVersions versions;
};

/// The page. Figures are expected at figures/NAME.svg and .png, data at data/NAME.csv, the page on beds at
/// bed.html in the same folder. Sections for which there is no content are left out.
std::string report_page(const ReportContent &content);

} // namespace drumlin::post
