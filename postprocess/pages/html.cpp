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
body { margin: 2rem auto; max-width: 68rem; padding: 0 1.5rem; background: #fff; color: #1a1a1a;
       font: 1rem/1.5 "DejaVu Sans", "Liberation Sans", Helvetica, Arial, sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.25; margin: 0 0 0.3rem; }
h2 { font-size: 1.25rem; margin: 2.6rem 0 0.8rem; padding-top: 0.6rem; border-top: 1px solid #bbb; }
h3 { font-size: 1rem; margin: 1.8rem 0 0.5rem; }
a { color: #00538a; }
p, li { max-width: 46rem; }
.made { color: #555; font-size: 0.9rem; margin-top: 0; }
nav { font-size: 0.84rem; line-height: 1.35; }
nav ol { display: flex; flex-wrap: wrap; gap: 0.2rem 1.1rem; list-style: none;
         margin: 0.4rem 0 1rem; padding: 0; }
.answer { display: flex; flex-wrap: wrap; gap: 1rem 2rem; align-items: flex-start; }
.answer > div { flex: 1 1 26rem; }
.answer > .scene { flex: 0 0 21rem; margin: 0; }
.verdict { font-size: 1.06rem; border-left: 4px solid #888; padding-left: 0.9rem; margin: 0; }
.verdict.good { border-left-color: #0072b2; }
.verdict.bad { border-left-color: #d55e00; }
.scene svg { width: 100%; height: auto; }
.scene img { width: 100%; height: auto; border: 1px solid #e2e2e2; }
.key { display: grid; grid-template-columns: repeat(auto-fill, minmax(22rem, 1fr)); gap: 0 1.5rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 0.82rem; line-height: 1.35;
        font-variant-numeric: tabular-nums; }
th, td { padding: 0.25rem 0.6rem; text-align: right; vertical-align: top; border-bottom: 1px solid #e2e2e2; }
th { border-bottom: 1px solid #555; vertical-align: bottom; font-weight: 600; }
th.word, td.word { text-align: left; }
td.word { white-space: nowrap; }
td.long { white-space: normal; min-width: 14rem; }
tr.agrees td.word:first-child { background: #e6f1f8; }
tr.differs td { background: #fdebdc; }
tr.differs td:first-child { font-weight: 700; }
tr.next td { border-top: 2px solid #aaa; }
.tally { margin: 0 0 0.5rem; font-size: 0.9rem; }
.tally b { padding: 0.1rem 0.5rem; background: #e6f1f8; }
.tally.bad b { background: #fdebdc; }
.notes { font-size: 0.84rem; color: #444; margin: 0.5rem 0; }
.notes p { margin: 0.2rem 0; max-width: 60rem; }
figure { margin: 1.6rem 0; }
figure img { width: 100%; height: auto; border: 1px solid #e2e2e2; }
figcaption { font-size: 0.88rem; max-width: 58rem; }
.links { font-size: 0.84rem; white-space: nowrap; }
code { font: 0.82rem/1.4 "DejaVu Sans Mono", "Liberation Mono", monospace; overflow-wrap: anywhere; }
code span { display: inline-block; max-width: 100%; }
dl.commands { display: grid; grid-template-columns: max-content 1fr; gap: 0.15rem 1.2rem;
              font-size: 0.84rem; }
dl.commands dd { margin: 0; }
.absent { color: #444; font-style: italic; }
@media screen and (min-width: 80rem) {
  body { max-width: 86rem; }
  .columns { display: grid; grid-template-columns: 14rem minmax(0, 1fr); gap: 0 2.5rem; }
  nav { position: sticky; top: 0; align-self: start; max-height: 100vh; overflow-y: auto; padding: 1rem 0; }
  nav ol { display: block; margin: 0; }
  nav li { padding: 0.22rem 0; }
}
@media print {
  body { margin: 0; max-width: none; padding: 0; font-size: 9.5pt; }
  nav { display: none; }
  figure, tr, .answer { break-inside: avoid; }
  h2, h3, h2 + p, .tally { break-after: avoid; }
  .answer { flex-wrap: nowrap; }
  .answer > div { flex: 1 1 0; }
  .answer > .scene { flex: 0 0 62mm; }
  .key { grid-template-columns: 1fr 1fr; }
  .wide { overflow: visible; }
  table { font-size: 6pt; }
  th, td { padding: 0.2rem 0.18rem; }
  td.long { min-width: 0; }
  tr td, .tally b { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  figure img { max-height: 105mm; object-fit: contain; }
  code, dl.commands { font-size: 6.5pt; }
  .notes, .links, figcaption { font-size: 8pt; }
  a { color: inherit; text-decoration: none; }
}
@page { size: A4 portrait; margin: 12mm; }
)";

constexpr const char *check_mark = "✓";
constexpr const char *cross = "✗";

/// A command line as HTML that a browser wraps between words, never at a hyphen within a word.
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
  std::string s = "<h3 id=\"commands\">Commands</h3>\n<dl class=\"commands\">\n";
  for (const auto &[name, command] : commands)
    s += fmt::format("<dt>{}</dt><dd><code>{}</code></dd>\n", html_escaped(name), words_html(command));
  return s + "</dl>\n";
}

std::string section_html(const FigurePlan &plan, const std::string &section) {
  std::string s;
  for (const PageFigure &figure : plan.figures)
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

std::string html_page(const std::string &title, const std::string &made,
                      const std::vector<PageLink> &contents, const std::string &body) {
  std::string s = "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n"
                  "<meta charset=\"utf-8\" />\n"
                  "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\" />\n";
  s += fmt::format("<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n<header>\n<h1>{0}</h1>\n"
                   "<p class=\"made\">{2}</p>\n</header>\n",
                   html_escaped(title), style, html_escaped(made));
  if (contents.empty()) return s + "<main>\n" + body + "</main>\n</body>\n</html>\n";
  s += "<div class=\"columns\">\n<nav aria-label=\"Contents\">\n<ol>\n";
  for (const PageLink &link : contents)
    s += fmt::format("<li><a href=\"{}\">{}</a></li>\n", html_escaped(link.href), html_escaped(link.text));
  return s + "</ol>\n</nav>\n<main>\n" + body + "</main>\n</div>\n</body>\n</html>\n";
}

std::string answer_html(const std::vector<Sentence> &sentences, Verdict verdict, const std::string &scene) {
  const char *kind = verdict == Verdict::good ? " good" : verdict == Verdict::bad ? " bad" : "";
  const char *mark = verdict == Verdict::good ? check_mark : verdict == Verdict::bad ? cross : "";
  std::string s =
      fmt::format("<section id=\"answer\" class=\"answer\">\n<div><p class=\"verdict{}\">{}", kind, mark);
  bool first = true;
  for (const Sentence &sentence : sentences) {
    if (!sentence.lead.empty()) // a line of its own for each subject
      s += fmt::format("{} <strong>{}</strong>", first ? "" : "<br />", html_escaped(sentence.lead));
    s += " " + html_escaped(sentence.text);
    first = false;
  }
  return s + "</p></div>\n" + scene + "</section>\n";
}

std::string key_figures_html(const std::vector<KeyFigure> &figures) {
  if (figures.empty()) return {};
  std::string s = "<div class=\"key\">\n";
  for (const KeyFigure &key : figures) {
    const Figure &figure = key.figure;
    s += fmt::format(
        "<figure>\n<a href=\"{0}\"><img src=\"figures/{1}{2}\" alt=\"{3}\" width=\"{4}\" "
        "height=\"{5}\" /></a>\n<figcaption>{3} (<a href=\"{0}\">{6}</a>)</figcaption>\n</figure>\n",
        html_escaped(key.href), figure.name, shown_ending(figure), html_escaped(key.caption),
        figure_width(figure), figure_height(figure), html_escaped(key.link));
  }
  return s + "</div>\n";
}

namespace {

/// A table as the page shows it: the columns in their order, which of them are words, and the verdict of each
/// row.
class ShownTable {
public:
  explicit ShownTable(const PageTable &table)
      : table_(table), judged_(table.count(RowState::plain) < table.rows.size()) {
    const std::size_t columns = table.shown_columns == 0 ? table.header.size() : table.shown_columns;
    for (std::size_t c = 0; c < columns; ++c) {
      if (is_verdict(c)) continue; // it is the first column
      bool any = false;            // a column that is empty throughout is left out
      for (const std::vector<std::string> &row : table.rows)
        any = any || (!row[c].empty() && (row[c] != no_value || c < table.text_columns));
      if (any) columns_.push_back(c);
    }
    for (std::size_t r = 1; r < table.rows.size(); ++r)
      grouped_ = grouped_ || table.rows[r][0] == table.rows[r - 1][0];
  }

  std::string html() const {
    std::string s = "<div class=\"wide\"><table>\n<thead><tr>";
    if (has_verdicts())
      s += fmt::format("<th class=\"word\" scope=\"col\">{}</th>",
                       html_escaped(table_.verdict.empty() ? "good" : table_.verdict));
    for (const std::size_t c : columns_)
      s += fmt::format("<th{} scope=\"col\">{}</th>", is_word(c) ? " class=\"word\"" : "",
                       html_escaped(table_.header[c]));
    s += "</tr></thead>\n<tbody>\n";
    for (std::size_t r = 0; r < table_.rows.size(); ++r)
      s += row_html(r);
    return s + "</tbody></table></div>\n";
  }

  /// "120 of 120 agree" with a mark; empty if no row is judged.
  std::string tally() const {
    if (!judged_) return {};
    const std::size_t good = table_.count(RowState::agrees);
    const std::size_t all = good + table_.count(RowState::differs);
    return fmt::format("<p class=\"tally{}\"><b>{} {} of {}</b>{}</p>\n", good == all ? "" : " bad",
                       good == all ? check_mark : cross, good, all,
                       table_.criterion.empty() ? "" : " " + html_escaped(table_.criterion));
  }

private:
  bool has_verdicts() const { return judged_ || !table_.verdict.empty(); }
  bool is_verdict(std::size_t column) const { return table_.header[column] == table_.verdict; }

  /// Whether a column has words, which are left-aligned: the first `text_columns` columns, and those of a
  /// name that always has words.
  bool is_word(std::size_t column) const {
    const std::string &name = table_.header[column];
    return column < table_.text_columns || name == "remark" || name == "engine" || name == "plugin" ||
           name == "integrated over" || name == "command";
  }

  std::string verdict_html(std::size_t row) const {
    const RowState state = table_.states[row];
    const std::string mark = state == RowState::agrees    ? std::string(check_mark) + " "
                             : state == RowState::differs ? std::string(cross) + " "
                                                          : "";
    std::string words = state == RowState::agrees ? "yes" : state == RowState::differs ? "no" : no_value;
    for (std::size_t c = 0; c < table_.header.size(); ++c)
      if (is_verdict(c)) words = table_.rows[row][c];
    return fmt::format("<td class=\"word\">{}{}</td>", mark, html_escaped(words));
  }

  std::string row_html(std::size_t r) const {
    const RowState state = table_.states[r];
    std::string classes = state == RowState::agrees ? "agrees" : state == RowState::differs ? "differs" : "";
    // A rule between the runs, if a run has several rows.
    if (grouped_ && r > 0 && table_.rows[r][0] != table_.rows[r - 1][0])
      classes += classes.empty() ? "next" : " next";
    std::string s = classes.empty() ? "<tr>" : fmt::format("<tr class=\"{}\">", classes);
    if (has_verdicts()) s += verdict_html(r);
    constexpr std::size_t long_text = 44; // letters: such a cell may break into lines
    for (const std::size_t c : columns_) {
      const std::string &cell = table_.rows[r][c];
      s += fmt::format("<td{}>{}</td>",
                       !is_word(c)               ? ""
                       : cell.size() > long_text ? " class=\"word long\""
                                                 : " class=\"word\"",
                       html_escaped(cell));
    }
    return s + "</tr>\n";
  }

  const PageTable &table_;
  bool judged_;
  bool grouped_ = false;
  std::vector<std::size_t> columns_;
};

} // namespace

std::string table_html(const PageTable &table) {
  std::string s = fmt::format("<h3 id=\"table-{}\">{}</h3>\n", table.name, html_escaped(table.title));
  if (!table.rows.empty()) {
    const ShownTable shown(table);
    s += shown.tally() + shown.html();
  }
  s += "<div class=\"notes\">";
  for (const std::string &note : table.notes)
    s += fmt::format("<p>{}</p>", html_escaped(note));
  if (!table.rows.empty())
    s += fmt::format("<p class=\"links\"><a href=\"data/{}.csv\">CSV of this table</a></p>", table.name);
  return s + "</div>\n";
}

std::string figure_html(const PageFigure &figure) {
  const std::string &name = figure.figure.name;
  const std::string ending = shown_ending(figure.figure);
  return fmt::format(
      "<figure id=\"{0}\">\n<a href=\"figures/{0}{6}\"><img src=\"figures/{0}{6}\" alt=\"{1}\" "
      "width=\"{4}\" height=\"{5}\" /></a>\n"
      "<figcaption><strong>{2}.</strong> {3} <span class=\"links\">[<a href=\"data/{0}.csv\">CSV</a>, "
      "<a href=\"figures/{0}.png\">PNG</a>, {7}<a href=\"figures/{0}.gp\">gnuplot "
      "script</a>]</span></figcaption>\n</figure>\n",
      name, html_escaped(figure.figure.title), html_escaped(figure.label), html_escaped(figure.caption),
      figure_width(figure.figure), figure_height(figure.figure), ending,
      ending == ".png"
          ? ""
          : fmt::format("<a href=\"figures/{}{}\">{}</a>, ", name, ending, ending == ".gif" ? "GIF" : "SVG"));
}

} // namespace drumlin::post
