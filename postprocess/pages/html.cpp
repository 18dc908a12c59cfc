#include "pages/html.h"

#include "support/text.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

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

} // namespace

std::string commands_html(const std::vector<std::pair<std::string, std::string>> &commands) {
  std::string s = "<h3 id=\"commands\">Commands and versions</h3>\n<dl class=\"commands\">\n";
  for (const auto &[name, command] : commands)
    s += fmt::format("<dt>{}</dt><dd><code>{}</code></dd>\n", html_escaped(name), words_html(command));
  return s + "</dl>\n";
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

} // namespace drumlin::post
