// Parts of a page: XHTML5 without scripts that needs no network.
#pragma once

#include "pages/figure.h"
#include "pages/table.h"

#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

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

} // namespace drumlin::post
