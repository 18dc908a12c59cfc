// The report's first page: the answer, then chains and single impacts in full, with links to the pages on
// beds, drums with two ends and studies.
#pragma once

#include "report/content.h"

#include "pages/drawing.h"
#include "pages/html.h"
#include "report/answer.h"

#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

/// A page of the report: an opening, then numbered sections. The links at its top lead to them.
class ReportPage {
public:
  ReportPage(std::vector<PageLink> links, std::string opening);

  /// A section with its content, HTML.
  void section(const std::string &id, const std::string &title, const std::string &content);
  void link(PageLink link) { links_.push_back(std::move(link)); }
  std::string html(const std::string &title, const ReportVersions &versions) const;

private:
  std::vector<PageLink> links_;
  std::string body_;
  int number_ = 0;
};

/// A page beside the first one, which it links: it opens with its answer, a drawing of the model and key
/// figures.
ReportPage page_beside(const Answer &answer, Drawing drawing, const std::vector<KeyFigure> &keys);

/// The end of a page: the command of each run, and the programs and versions that made the page. \param
/// programs a sentence such as that of report_programs()
template <class Result>
std::string commands_and_versions(const std::vector<Result> &results, const std::string &programs) {
  std::vector<std::pair<std::string, std::string>> commands;
  commands.reserve(results.size());
  for (const Result &result : results)
    commands.emplace_back(result.run.name, result.run.text("command"));
  return (commands.empty() ? "" : commands_html(commands)) + "<h3 id=\"versions\">Versions</h3>\n<p>" +
         html_escaped(programs) + "</p>\n";
}
/// "Report by drumlin VERSION; figures by gnuplot VERSION."
std::string report_programs(const ReportVersions &versions);

/// The page. Figures are expected at figures/NAME.svg and .png, data at data/NAME.csv, the pages on beds and
/// on drums with two ends at bed.html and ends.html in the same folder. Sections for which there is no
/// content are left out.
std::string report_page(const ReportContent &content);

} // namespace drumlin::post
