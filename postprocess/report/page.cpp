#include "report/page.h"

#include "pages/drawing.h"
#include "report/answer.h"
#include "report/chain/engine_comparison.h"

#include "support/text.h"

#include <utility>

#include <fmt/format.h>

namespace drumlin::post {

namespace {

struct Section {
  const char *id;
  const char *title;
  const char *words;
};

constexpr Section sections[] = {
    {"steady", "Drum acceleration, cases I to IV",
     "Figs. 4 to 7 of the paper, where the parameters are those of the paper. Condition A dashed, condition "
     "B (no-tension limit) solid, reference solution as markers."},
    {"reference", "Reference values",
     "Every measured value that has a reference value, the compaction meter values, and what the paper "
     "states in words."},
    {"direct", "Error against the reference solution",
     "The reference solution is the exact solution of the same chain, without an engine. Tables call it the "
     "direct solution. Fig. 8 is that of the paper."},
    {"engines", "LIGGGHTS against LAMMPS", "The same chains in both engines."},
    {"impact", "Single impact",
     "A mass hits a fixed ball once, without gravity (Fig. 3 of the paper). The restitution is the rebound "
     "speed over the impact speed."},
    {"loops", "Phase portraits and force loops",
     "The same runs as in Figs. 4 to 7, in other coordinates. The paper has no such figures."},
    {"events", "Makes and breaks of contact", ""},
    {"energy", "Energy balance", "Where the work of the exciter goes."},
    {"roller", "Contact force from measured motion",
     "A roller cannot measure the contact force itself, but motion: the equation of motion gives Fc = m2 a2 "
     "+ m3 a3 + (m2 + m3) g + Fe. Here the accelerations are differences of the positions in chain.csv, and "
     "the result must equal the force of the contact law."},
    {"bed", "Roller on a bed of balls", ""},
    {"ends", "A drum with two ends", ""},
    {"studies", "Studies",
     "What time steps, laws and options cost and what they bring, each on its own page."},
    {"runs", "Runs, commands and versions", ""},
};

/// Whether a section has a subject in this report: runs on beds and of drums with two ends have
/// their own pages, and the last section is always there.
bool belongs(const std::string &section, const ReportContent &content) {
  if (section == "bed") return !content.beds.empty();
  if (section == "engines") return !engine_pairs(content.results).empty();
  if (section == "ends") return !content.ends.empty();
  if (section == "studies") return !content.studies.empty() || (content.beds.empty() && content.ends.empty());
  return !content.results.runs.empty() || section == "runs";
}

Drawing scene_of(const ReportContent &content) {
  if (!content.results.runs.empty()) return Drawing::chain;
  return !content.beds.empty() ? Drawing::bed : !content.ends.empty() ? Drawing::two_ends : Drawing::chain;
}

/// Pictures of studies that have one, which link their pages.
std::string pictures_html(const std::vector<StudyLink> &studies) {
  std::string s;
  for (const StudyLink &study : studies)
    if (!study.picture.empty())
      s += fmt::format("<figure>\n<a href=\"{0}\"><img src=\"{1}\" alt=\"{2}\" /></a>\n<figcaption><a "
                       "href=\"{0}\">{2}</a></figcaption>\n</figure>\n",
                       html_escaped(study.place), html_escaped(study.picture), html_escaped(study.title));
  return s;
}

std::string opening_html(const ReportContent &content) {
  Answer answer = chain_answer(content.results);
  answer.add(bed_answer(content.groups));
  answer.add(ends_answer(content.ends));
  if (const std::size_t studies = content.studies.size(); studies > 0)
    answer.sentences.push_back(
        {fmt::format("{} {}.", studies,
                     studies == 1 ? "study has a page of its own" : "studies have pages of their own"),
         "Studies."});
  if (const std::size_t others = content.left_out.size(); others > 0)
    answer.sentences.push_back(
        {fmt::format("{} left out, and not judged: the last section says why.",
                     others == 1 ? "One folder is" : fmt::format("{} folders are", others)),
         "Left out."});
  return answer_html(answer.sentences, answer.verdict, drawing_html(scene_of(content))) +
         key_figures_html(content.keys) + pictures_html(content.studies);
}

/// Names runs that have a page of their own.
template <class Result>
std::string runs_html(const std::vector<Result> &results, const char *page) {
  std::string s = fmt::format(
      "<p><a href=\"{}\">Figures and commands of these runs</a> are on a page of their own: ", page);
  for (std::size_t i = 0; i < results.size(); ++i)
    s += (i == 0 ? "" : ", ") + html_escaped(results[i].run.name);
  return s + ".</p>\n";
}

std::string studies_html(const std::vector<StudyLink> &studies) {
  if (studies.empty()) return {};
  std::string s = "<ul>\n";
  for (const StudyLink &study : studies)
    s +=
        fmt::format("<li><a href=\"{}\">{}</a></li>\n", html_escaped(study.place), html_escaped(study.title));
  return s + "</ul>\n";
}

/// Folders that are not part of the report, and why.
std::string left_out_html(const std::vector<LeftOut> &folders) {
  if (folders.empty()) return {};
  std::string s = "<h3 id=\"left_out\">Left out</h3>\n<ul>\n";
  for (const LeftOut &folder : folders)
    s += fmt::format("<li><code>{}</code>: {}</li>\n", html_escaped(valid_utf8(folder.folder.string())),
                     html_escaped(folder.why));
  return s + "</ul>\n";
}

std::string contents_of(const Section &section, const ReportContent &content) {
  const std::string id = section.id;
  std::string s;
  if (id == "bed") s += runs_html(content.beds, "bed.html");
  if (id == "ends") s += runs_html(content.ends, "ends.html");
  s += section_html(content.figures, id);
  for (const PageTable &table : content.tables)
    if (table.section == id) s += table_html(table);
  if (id == "studies") s += studies_html(content.studies);
  if (id == "runs")
    s += left_out_html(content.left_out) +
         commands_and_versions(content.results.runs,
                               fmt::format("Report by drumlin {}; figures by {}.", content.versions.drumlin,
                                           content.versions.gnuplot));
  return s.empty() ? "<p class=\"absent\">The given runs have nothing for this section.</p>\n" : s;
}

} // namespace

ReportPage::ReportPage(std::vector<PageLink> links, std::string opening)
    : links_(std::move(links)), body_(std::move(opening)) {}

void ReportPage::section(const std::string &id, const std::string &title, const std::string &content) {
  const std::string numbered = fmt::format("{}. {}", ++number_, title);
  links_.push_back({"#" + id, numbered});
  body_ +=
      fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", id, html_escaped(numbered), content);
}

std::string ReportPage::html(const std::string &title, const ReportVersions &versions) const {
  return html_page(title, fmt::format("Made on {} by drumlin {}.", versions.made_at, versions.drumlin),
                   links_, body_);
}

ReportPage page_beside(const Answer &answer, Drawing drawing, const std::vector<KeyFigure> &keys) {
  return {{{"index.html", "Report of the runs"}, {"#answer", "Answer"}},
          answer_html(answer.sentences, answer.verdict, drawing_html(drawing)) + key_figures_html(keys)};
}

std::string report_programs(const ReportVersions &versions) {
  return fmt::format("Report by drumlin {}; figures by {}.", versions.drumlin, versions.gnuplot);
}

std::string report_page(const ReportContent &content) {
  ReportPage page({{"#answer", "Answer"}}, opening_html(content));
  for (const Section &section : sections) {
    if (!belongs(section.id, content)) continue;
    const std::string words =
        section.words[0] != '\0' ? fmt::format("<p>{}</p>\n", html_escaped(section.words)) : "";
    page.section(section.id, section.title, words + contents_of(section, content));
  }
  if (!content.beds.empty()) page.link({"bed.html", "Page on the beds"});
  if (!content.ends.empty()) page.link({"ends.html", "Page on two ends"});
  return page.html("Roller on soil: report of the runs", content.versions);
}

} // namespace drumlin::post
