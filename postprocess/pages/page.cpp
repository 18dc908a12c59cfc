#include "pages/page.h"

#include "pages/gnuplot.h"
#include "support/files.h"

#include <ctime>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace drumlin::post {

namespace fs = std::filesystem;

Page::Page(fs::path out, std::string title, std::optional<Drawing> drawing)
    : out_(std::move(out)), title_(std::move(title)), drawing_(drawing) {}

void Page::answer(const std::vector<Acceptance> &criteria) {
  if (criteria.empty()) return;
  answer_.push_back({acceptance_words(criteria), "Acceptance."});
  judged_ = true;
  for (const Acceptance &one : criteria)
    good_ = good_ && one.holds;
}

void Page::section(const std::string &title) {
  body_ += sections_.empty() ? "" : "</section>\n";
  sections_.push_back(title);
  body_ +=
      fmt::format("<section id=\"section-{0}\">\n<h2>{0}. {1}</h2>\n", sections_.size(), html_escaped(title));
}

void Page::paragraph(const std::string &text) { body_ += fmt::format("<p>{}</p>\n", html_escaped(text)); }

void Page::table(PageTable table) {
  body_ += table_html(table);
  tables_.push_back(std::move(table));
}

void Page::figure(const PageFigure &figure) {
  body_ += figure_html(figure);
  figures_.push_back(figure);
}

void Page::write() const {
  const fs::path gnuplot = find_gnuplot();
  fs::create_directories(out_ / "figures");
  fs::create_directories(out_ / "data");
  std::vector<FileText> files;
  for (const PageTable &table : tables_)
    if (!table.rows.empty()) files.emplace_back(out_ / "data" / (table.name + ".csv"), table_csv(table));
  for (const PageFigure &figure : figures_)
    files.emplace_back(out_ / "data" / (figure.figure.name + ".csv"), figure.csv);
  write_files(files);
  for (const PageFigure &figure : figures_)
    render(gnuplot, out_ / "figures", figure.figure);
  for (const KeyFigure &key : key_figures(figures_))
    render(gnuplot, out_ / "figures", key.figure);
  write_files({{out_ / "index.html", html()}});
}

std::string Page::html() const {
  std::vector<PageLink> contents = {{"#answer", "Answer"}};
  for (std::size_t i = 0; i < sections_.size(); ++i)
    contents.push_back({fmt::format("#section-{}", i + 1), fmt::format("{}. {}", i + 1, sections_[i])});
  const Verdict verdict = !judged_ ? Verdict::none : good_ ? Verdict::good : Verdict::bad;
  const std::string made = fmt::format("Made on {:%Y-%m-%d %H:%M} UTC by drumlin {}.",
                                       fmt::gmtime(std::time(nullptr)), DRUMLIN_VERSION);
  return html_page(title_, made, contents,
                   answer_html(answer_, verdict, drawing_ ? drawing_html(*drawing_) : "") +
                       key_figures_html(key_figures(figures_)) + body_ +
                       (sections_.empty() ? "" : "</section>\n"));
}

} // namespace drumlin::post
