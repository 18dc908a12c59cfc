// Parts of a page: XHTML5 without scripts that needs no network.
#pragma once

#include "pages/figure.h"
#include "pages/table.h"

#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

/// Text with &, <, >, " and ' replaced. Control characters are left out, and bytes that are not UTF-8 become
/// U+FFFD.
std::string html_escaped(const std::string &text);

/// The text whose html_escaped() is `html`.
std::string html_unescaped(const std::string &html);

/// A line of the contents list.
struct PageLink {
  std::string href; ///< "#id" of a section, or a file relative to the page
  std::string text; ///< plain text
};

/// A whole page: head with the styles that all pages of this project share, title, a line with date and
/// version (plain text), a contents list that stays in view on wide screens (empty: none), then `body` as the
/// page's main part.
std::string html_page(const std::string &title, const std::string &made,
                      const std::vector<PageLink> &contents, const std::string &body);

/// The verdict of a page's opening paragraph, which decides its mark.
enum class Verdict { none, good, bad };

/// A sentence or a few of the opening paragraph, plain text.
struct Sentence {
  std::string text;
  std::string lead = {}; ///< words in bold before it, which say what it is about; may be empty
};

/// The opening of a page: sentences as one paragraph, to the left of the drawing of the scene.
/// \param scene drawing_html()
std::string answer_html(const std::vector<Sentence> &sentences, Verdict verdict, const std::string &scene);

/// Figures side by side, each linked to the whole figure.
std::string key_figures_html(const std::vector<KeyFigure> &figures);

/// A table with its title, how many of its rows are good, its notes and a link to data/NAME.csv.
std::string table_html(const PageTable &table);

/// A figure with its caption and links to figures/NAME.svg, .png, .gp and data/NAME.csv.
std::string figure_html(const PageFigure &figure);

/// The figures of a section in order, then those left out and why. Empty if the plan has none of either.
std::string section_html(const FigurePlan &plan, const std::string &section);

/// A heading, then the commands of the runs, each with the name of its run.
std::string commands_html(const std::vector<std::pair<std::string, std::string>> &commands);

} // namespace drumlin::post
