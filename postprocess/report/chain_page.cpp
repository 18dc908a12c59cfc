#include "report/chain_page.h"

#include "report/engine_comparison.h"
#include "support/text.h"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
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
    {"summary", "Summary", ""},
    {"impact", "Single impact",
     "A mass hits the fixed ball once, without gravity: the paper's Fig. 3, and how much of the speed comes "
     "back."},
    {"steady", "Steady drum acceleration, cases I to IV",
     "The paper's Figs. 4 to 7, where the parameters are the paper's. Condition A dashed, condition B solid, "
     "direct solution as markers."},
    {"direct", "Runs against the direct solution",
     "The paper's Fig. 8, and what cannot be seen in it. The direct solution integrates the same equations "
     "between "
     "located events, without any engine."},
    {"engines", "Engine against engine", "The same chains in LIGGGHTS and in LAMMPS."},
    {"loops", "Orbits and force-displacement loops",
     "Beyond the paper: the same steady states, seen without time."},
    {"events", "Contact events", ""},
    {"reference", "Reference values",
     "Every value of the reference table, the compaction meter values, and the paper's words."},
    {"energy", "Energy", "Where the work of the exciter goes."},
    {"roller", "Contact force as a roller measures it",
     "A roller cannot see the contact law. What it can measure is motion: Fc = m2 a2 + m3 a3 + (m2 + m3) g + "
     "Fe, here with accelerations by differences of the positions that the engine integrated, must equal the "
     "force of the law."},
    {"bed", "Roller on a bed of balls", ""},
    {"studies", "Studies",
     "What steps, laws and options cost and what they bring, each on a page of its own."},
};

/// Whether a section has anything to do with the given runs: those of beds only have a page of their own.
bool belongs(const std::string &section, const ReportResults &results, const std::vector<std::string> &beds) {
  if (section == "bed") return !beds.empty();
  if (section == "engines") return !engine_pairs(results).empty();
  return beds.empty() || !results.runs.empty() || section == "summary" || section == "studies";
}

std::string beds_html(const std::vector<std::string> &beds) {
  std::string s = "<p><a href=\"bed.html\">Figures of these runs</a> are on a page of their own: ";
  for (std::size_t i = 0; i < beds.size(); ++i)
    s += (i == 0 ? "" : ", ") + html_escaped(beds[i]);
  return s + ".</p>\n";
}

std::string summary_html(const ReportResults &results) {
  const CheckCount count = count_checks(results);
  std::size_t chains = 0;
  std::size_t impacts = 0;
  for (const RunResult &result : results.runs) {
    if (result.run.kind == RunKind::chain) ++chains;
    if (result.run.kind == RunKind::impact) ++impacts;
  }
  std::string s = fmt::format(
      "<p>{} run folders were read: {} of the chain soil – drum – frame, {} of a single impact{}.</p>\n",
      results.runs.size(), chains, impacts,
      chains + impacts < results.runs.size()
          ? fmt::format(", {} without usable parameters", results.runs.size() - chains - impacts)
          : "");
  if (count.all + count.not_judged == 0)
    return s + "<p class=\"verdict\">No run is at the parameters of a case with reference values, so none "
               "was judged.</p>\n";
  if (count.all > 0)
    s +=
        fmt::format("<p class=\"verdict{}\"><strong>{} of {} checks against reference values agree</strong>, "
                    "{} of them to every digit given.</p>\n",
                    count.agree == count.all ? "" : " bad", count.agree, count.all, count.same_digits);
  if (count.not_judged > 0)
    s += fmt::format("<p class=\"verdict\"><strong>{} values are not judged</strong>: the reference values "
                     "need steady states, of runs with {} cycles or more. <a href=\"#table-runs\">The table "
                     "of runs</a> names the command that makes such a run.</p>\n",
                     count.not_judged, long_run_cycles);
  if (count.all == 0) return s;
  // Which stepping the checks were made with says most about why some differ.
  std::map<std::string, std::pair<std::size_t, std::size_t>> by_stepping;
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    const Run &run = results.runs[i].run;
    const CheckCount own = count_checks(results, i);
    if (own.all == 0) continue;
    auto &[agree, all] = by_stepping[run.direct ? "exact" : run.text("stepping")];
    agree += own.agree;
    all += own.all;
  }
  s += "<p>By stepping of the runs:";
  const char *separator = " ";
  for (const auto &[stepping, sum] : by_stepping) {
    s += fmt::format("{}{} {} of {}", separator, html_escaped(stepping), sum.first, sum.second);
    separator = "; ";
  }
  s += ". What differs is marked in <a href=\"#reference\">the table of reference values</a>, beside what "
       "the direct "
       "solution gives.</p>\n";
  return s;
}

std::string versions_html(const ReportResults &results, const ReportVersions &versions) {
  std::vector<std::pair<std::string, std::string>> commands;
  commands.reserve(results.runs.size());
  for (const RunResult &result : results.runs)
    commands.emplace_back(result.run.name, result.run.text("command"));
  return commands_html(commands) + "<p>" +
         html_escaped(fmt::format("Report by drumlin {}; direct solution by {}; figures by {}.",
                                  versions.drumlin, versions.direct_solver, versions.gnuplot)) +
         "</p>\n";
}

} // namespace

std::string made_line(const ReportVersions &versions) {
  return fmt::format("Made on {} by drumlin {}.", versions.made_at, versions.drumlin);
}

std::string report_page(const ReportResults &results, const std::vector<ReportTable> &tables,
                        const FigurePlan &plan, const std::vector<std::string> &beds,
                        const std::vector<StudyLink> &studies, const ReportVersions &versions) {
  std::string s;
  s += "<nav>\n<ol>\n";
  for (const Section &section : sections)
    if (belongs(section.id, results, beds))
      s += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", section.id, html_escaped(section.title));
  s += "</ol>\n</nav>\n<main>\n";
  int number = 0;
  for (const Section &section : sections) {
    const std::string id = section.id;
    if (!belongs(id, results, beds)) continue;
    s += fmt::format("<section id=\"{}\">\n<h2>{}. {}</h2>\n", id, ++number, html_escaped(section.title));
    if (section.words[0] != '\0') s += fmt::format("<p>{}</p>\n", html_escaped(section.words));
    if (id == "summary")
      s +=
          belongs("direct", results, beds)
              ? summary_html(results)
              : fmt::format("<p>{} run folders were read, of a roller on a bed of balls.</p>\n", beds.size());
    if (id == "bed") s += beds_html(beds);
    const std::string figures = section_html(plan, id);
    s += figures;
    bool any = id == "summary" || id == "bed" || !figures.empty();
    for (const ReportTable &table : tables)
      if (table.section == id) {
        s += table_html(table);
        any = true;
      }
    if (id == "studies" && !studies.empty()) {
      s += "<ul>\n";
      for (const StudyLink &study : studies)
        s += fmt::format("<li><a href=\"{}\">{}</a></li>\n", html_escaped(study.place),
                         html_escaped(study.title));
      s += "</ul>\n";
      any = true;
    }
    if (!any) s += "<p class=\"absent\">The given runs have nothing to show here.</p>\n";
    if (id == "summary" && belongs("direct", results, beds)) s += versions_html(results, versions);
    s += "</section>\n";
  }
  return html_page("Roller on soil: report of the runs", made_line(versions), s + "</main>\n");
}

} // namespace drumlin::post
