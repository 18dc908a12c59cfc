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

constexpr const char *style = R"(
:root { color-scheme: light; }
body { margin: 2.5rem auto; max-width: 68rem; padding: 0 1.5rem; background: #fff; color: #1a1a1a;
       font: 1rem/1.5 "DejaVu Sans", "Liberation Sans", Helvetica, Arial, sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.25; margin: 0 0 0.3rem; }
h2 { font-size: 1.25rem; margin: 2.8rem 0 0.8rem; padding-top: 0.6rem; border-top: 1px solid #bbb; }
h3 { font-size: 1rem; margin: 1.8rem 0 0.5rem; }
a { color: #00538a; }
p, li { max-width: 46rem; }
.made { color: #555; font-size: 0.9rem; margin-top: 0; }
nav ol { margin: 0.4rem 0 0; padding-left: 1.6rem; }
.verdict { font-size: 1.1rem; border-left: 4px solid #0072b2; padding-left: 0.8rem; }
.verdict.bad { border-left-color: #d55e00; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 0.84rem; line-height: 1.35; font-variant-numeric: tabular-nums; }
th, td { padding: 0.25rem 0.6rem 0.25rem 0; text-align: right; vertical-align: top; border-bottom: 1px solid #e2e2e2; }
th { border-bottom: 1px solid #555; vertical-align: bottom; font-weight: 600; }
th.word, td.word { text-align: left; }
td.verb { text-align: left; }
td.word, td.verb { white-space: nowrap; }
tr.differs td { background: #fdf0e6; }
tr.differs td.verb { font-weight: 700; }
tr.next td { border-top: 2px solid #aaa; }
.notes { font-size: 0.84rem; color: #444; margin: 0.5rem 0; }
.notes p { margin: 0.2rem 0; max-width: 60rem; }
figure { margin: 1.6rem 0; }
figure img { width: 100%; height: auto; border: 1px solid #e2e2e2; }
figcaption { font-size: 0.9rem; max-width: 56rem; }
.links { font-size: 0.84rem; white-space: nowrap; }
code { font: 0.82rem/1.4 "DejaVu Sans Mono", "Liberation Mono", monospace; overflow-wrap: anywhere; }
code span { display: inline-block; max-width: 100%; }
dl.commands { display: grid; grid-template-columns: max-content 1fr; gap: 0.15rem 1.2rem; font-size: 0.84rem; }
dl.commands dd { margin: 0; }
.absent { color: #444; font-style: italic; }
@media print {
  body { margin: 0; max-width: none; padding: 0; font-size: 9.5pt; }
  figure, tr { break-inside: avoid; }
  h2, h3 { break-after: avoid; }
  .wide { overflow: visible; }
  table { font-size: 6pt; }
  th, td { padding-right: 0.35rem; }
  figure img { max-height: 105mm; object-fit: contain; }
  code, dl.commands { font-size: 6.5pt; }
  .notes, .links, figcaption { font-size: 8pt; }
  a { color: inherit; text-decoration: none; }
}
@page { size: A4 portrait; margin: 12mm; }
)";

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

/// A command line that breaks between its words, not at the hyphens in them.
std::string words_html(const std::string &text) {
  std::string out;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    if (end > begin) out += "<span>" + html_escaped(text.substr(begin, end - begin)) + "</span>";
    if (end < text.size()) out += ' ';
    begin = end + 1;
  }
  return out;
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

std::string commands_html(const std::vector<std::pair<std::string, std::string>> &commands) {
  std::string s = "<h3 id=\"commands\">Commands and versions</h3>\n<dl class=\"commands\">\n";
  for (const auto &[name, command] : commands)
    s += fmt::format("<dt>{}</dt><dd><code>{}</code></dd>\n", html_escaped(name), words_html(command));
  return s + "</dl>\n";
}

std::string made_line(const ReportVersions &versions) {
  return fmt::format("Made on {} by drumlin {}.", versions.made_at, versions.drumlin);
}

std::string section_html(const FigurePlan &plan, const std::string &section) {
  std::string s;
  for (const PlannedFigure &figure : plan.figures)
    if (figure.section == section) s += figure_html(figure);
  for (const AbsentFigure &absent : plan.absent)
    if (absent.section == section)
      s += fmt::format("<p class=\"absent\">{} is left out: {}.</p>\n", html_escaped(absent.label),
                       html_escaped(absent.reason));
  return s;
}

std::string html_escaped(const std::string &text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : valid_utf8(text)) {
    switch (c) {
    case '&':
      out += "&amp;";
      break;
    case '<':
      out += "&lt;";
      break;
    case '>':
      out += "&gt;";
      break;
    case '"':
      out += "&quot;";
      break;
    case '\'':
      out += "&#39;";
      break;
    default:
      if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') out += c;
    }
  }
  return out;
}

std::string html_unescaped(const std::string &html) {
  constexpr std::array<std::pair<std::string_view, char>, 5> entities = {
      {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&#39;", '\''}}};
  std::string text;
  for (std::size_t i = 0; i < html.size();) {
    const auto *const entity = std::find_if(entities.begin(), entities.end(), [&](const auto &one) {
      return html.compare(i, one.first.size(), one.first) == 0;
    });
    text += entity == entities.end() ? html[i] : entity->second;
    i += entity == entities.end() ? 1 : entity->first.size();
  }
  return text;
}

std::string html_page(const std::string &title, const std::string &made, const std::string &body) {
  std::string s = "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n"
                  "<meta charset=\"utf-8\" />\n"
                  "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\" />\n";
  s += fmt::format("<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n<header>\n<h1>{0}</h1>\n",
                   html_escaped(title), style);
  if (!made.empty()) s += fmt::format("<p class=\"made\">{}</p>\n", html_escaped(made));
  return s + "</header>\n" + body + "</body>\n</html>\n";
}

std::string table_html(const ReportTable &table) {
  std::string s = fmt::format("<h3 id=\"table-{}\">{}</h3>\n", table.name, html_escaped(table.title));
  const std::size_t columns = table.shown_columns;
  // Columns of words are left-aligned, of which the verdict is one.
  const auto is_word = [&](std::size_t column) {
    const std::string &name = table.header[column];
    return column < table.text_columns || name == "agrees" || name == "remark" || name == "engine" ||
           name == "plugin" || name == "integrated over" || name == "command";
  };
  if (!table.rows.empty()) {
    // Columns that are empty throughout only take room.
    std::vector<bool> shown(columns, false);
    for (const std::vector<std::string> &row : table.rows)
      for (std::size_t c = 0; c < columns; ++c)
        if (!row[c].empty() && (row[c] != "–" || c < table.text_columns)) shown[c] = true;
    // Runs with many rows are set apart.
    bool grouped = false;
    for (std::size_t r = 1; r < table.rows.size(); ++r)
      grouped = grouped || table.rows[r][0] == table.rows[r - 1][0];
    s += "<div class=\"wide\"><table>\n<thead><tr>";
    for (std::size_t c = 0; c < columns; ++c)
      if (shown[c])
        s += fmt::format("<th{} scope=\"col\">{}</th>", is_word(c) ? " class=\"word\"" : "",
                         html_escaped(table.header[c]));
    s += "</tr></thead>\n<tbody>\n";
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      std::string classes = table.states[r] == RowState::differs ? "differs" : "";
      if (grouped && r > 0 && table.rows[r][0] != table.rows[r - 1][0])
        classes += classes.empty() ? "next" : " next";
      s += classes.empty() ? "<tr>" : fmt::format("<tr class=\"{}\">", classes);
      for (std::size_t c = 0; c < columns; ++c) {
        if (!shown[c]) continue;
        const char *cell = table.header[c] == "agrees" ? " class=\"verb\""
                           : is_word(c)                ? " class=\"word\""
                                                       : "";
        s += fmt::format("<td{}>{}</td>", cell, html_escaped(table.rows[r][c]));
      }
      s += "</tr>\n";
    }
    s += "</tbody></table></div>\n";
  }
  s += "<div class=\"notes\">";
  for (const std::string &note : table.notes)
    s += fmt::format("<p>{}</p>", html_escaped(note));
  if (!table.rows.empty())
    s += fmt::format("<p class=\"links\"><a href=\"data/{}.csv\">CSV of this table</a></p>", table.name);
  return s + "</div>\n";
}

std::string figure_html(const PlannedFigure &figure) {
  const std::string &name = figure.figure.name;
  const bool png = figure.figure.only_png;
  return fmt::format(
      "<figure id=\"{0}\">\n<a href=\"figures/{0}.{6}\"><img src=\"figures/{0}.{6}\" alt=\"{1}\" "
      "width=\"{4}\" height=\"{5}\" /></a>\n"
      "<figcaption><strong>{2}.</strong> {3} <span class=\"links\">[<a href=\"data/{0}.csv\">CSV</a>, "
      "<a href=\"figures/{0}.png\">PNG</a>, {7}"
      "<a href=\"figures/{0}.gp\">gnuplot script</a>]</span></figcaption>\n</figure>\n",
      name, html_escaped(figure.figure.title), html_escaped(figure.label), html_escaped(figure.caption),
      figure_width(figure.figure), figure_height(figure.figure), png ? "png" : "svg",
      png ? "" : fmt::format("<a href=\"figures/{}.svg\">SVG</a>, ", name));
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
