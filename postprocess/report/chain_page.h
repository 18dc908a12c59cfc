// The report's page: one XHTML5 file without scripts that needs no network.
#pragma once

#include <string>
#include <utility>
#include <vector>

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

/// Text with &, <, >, " and ' replaced, control characters left out, and what is not UTF-8 replaced by U+FFFD.
std::string html_escaped(const std::string &text);

/// The text that html_escaped() would give as `html`.
std::string html_unescaped(const std::string &html);

/// A whole page: head with the styles of all pages of this project, title, a line on how it was made (plain text, may be
/// empty), then `body` as it stands.
std::string html_page(const std::string &title, const std::string &made, const std::string &body);

/// A table with its title, its notes and a link to data/NAME.csv.
std::string table_html(const ReportTable &table);

/// A figure with its caption and links to figures/NAME.svg, .png, .gp and data/NAME.csv.
std::string figure_html(const PlannedFigure &figure);

/// The figures of a section in order, then those left out and why. Empty if the plan has none of either.
std::string section_html(const FigurePlan &plan, const std::string &section);

/// A heading, then the commands of runs, each with the name of its run.
std::string commands_html(const std::vector<std::pair<std::string, std::string>> &commands);

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
