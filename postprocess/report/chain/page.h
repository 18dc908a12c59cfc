// The report's first page: the answer, then chains and single impacts in full, with links to the pages on
// beds, drums with two ends and studies.
#pragma once

#include "report/content.h"

#include "pages/html.h"

#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

/// A page of the report: its opening, then numbered sections, which its list of links names.
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

/// The commands that repeat the runs, and a line on the programs that made the report. \param programs
/// "Report by ..."
template <class Result>
std::string commands_and_versions(const std::vector<Result> &results, const std::string &programs) {
  std::vector<std::pair<std::string, std::string>> commands;
  commands.reserve(results.size());
  for (const Result &result : results)
    commands.emplace_back(result.run.name, result.run.text("command"));
  return (commands.empty() ? "" : commands_html(commands)) + "<h3 id=\"versions\">Versions</h3>\n<p>" +
         html_escaped(programs) + "</p>\n";
}
/// The line of a report that has no reference solutions.
std::string report_programs(const ReportVersions &versions);

/// The page. Figures are expected at figures/NAME.svg and .png, data at data/NAME.csv, the pages on beds and
/// on drums with two ends at bed.html and ends.html in the same folder. Sections for which there is no
/// content are left out.
std::string report_page(const ReportContent &content);

} // namespace drumlin::post
