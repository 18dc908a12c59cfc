// The report's page: one XHTML5 file without scripts that needs no network.
#pragma once

#include <string>
#include <vector>

#include "report_figures.h"
#include "report_results.h"
#include "report_tables.h"

namespace drumlin::post {

/// Programs that the report was made with, for the record.
struct ReportVersions {
  std::string drumlin;
  std::string direct_solver;
  std::string gnuplot;
  std::string made_at; ///< date and time, UTC
};

/// Text with &, <, >, " and ' replaced, and characters that XML forbids left out.
std::string html_escaped(const std::string &text);

/// A whole page: head with the styles of all pages of this project, title, a line on how it was made (plain text, may be
/// empty), then `body` as it stands.
std::string html_page(const std::string &title, const std::string &made, const std::string &body);

/// A table with its title, its notes and a link to data/NAME.csv.
std::string table_html(const ReportTable &table);

/// A figure with its caption and links to figures/NAME.svg, .png, .gp and data/NAME.csv.
std::string figure_html(const PlannedFigure &figure);

/// A study beside the report.
struct StudyLink {
  std::string place; ///< of its index.html, relative to the report's
  std::string title; ///< as it stands in its page, escaped
};

/// The page of the report. Figures are expected at figures/NAME.svg and .png, data at data/NAME.csv beside it.
std::string report_page(const ReportResults &results, const std::vector<ReportTable> &tables,
                        const FigurePlan &plan, const std::vector<StudyLink> &studies,
                        const ReportVersions &versions);

} // namespace drumlin::post
