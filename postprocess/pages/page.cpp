#include "pages/page.h"

#include "pages/gnuplot.h"
#include "pages/html.h"
#include "support/files.h"

#include <ctime>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace drumlin::post {

namespace fs = std::filesystem;

StudyPage::StudyPage(fs::path out, std::string title) : out_(std::move(out)), title_(std::move(title)) {}

void StudyPage::section(const std::string &title) {
  body_ += fmt::format("{}<section>\n<h2>{}</h2>\n", in_section_ ? "</section>\n" : "", html_escaped(title));
  in_section_ = true;
}

void StudyPage::paragraph(const std::string &text) {
  body_ += fmt::format("<p>{}</p>\n", html_escaped(text));
}

void StudyPage::table(ReportTable table) {
  if (table.shown_columns == 0) table.shown_columns = table.header.size();
  body_ += table_html(table);
  tables_.push_back(std::move(table));
}

void StudyPage::figure(const PlannedFigure &figure) {
  body_ += figure_html(figure);
  figures_.push_back(figure);
}

void StudyPage::write() const {
  const fs::path gnuplot = find_gnuplot();
  fs::create_directories(out_ / "figures");
  fs::create_directories(out_ / "data");
  std::vector<FileText> files;
  for (const ReportTable &table : tables_)
    if (!table.rows.empty()) files.emplace_back(out_ / "data" / (table.name + ".csv"), table_csv(table));
  for (const PlannedFigure &figure : figures_)
    files.emplace_back(out_ / "data" / (figure.figure.name + ".csv"), figure.csv);
  write_files(files);
  for (const PlannedFigure &figure : figures_)
    render(gnuplot, out_ / "figures", figure.figure);
  const std::string made = fmt::format("Made on {:%Y-%m-%d %H:%M} UTC by drumlin {}.",
                                       fmt::gmtime(std::time(nullptr)), DRUMLIN_VERSION);
  write_files({{out_ / "index.html",
                html_page(title_, made,
                          fmt::format("<main>\n{}{}</main>\n", body_, in_section_ ? "</section>\n" : ""))}});
}

} // namespace drumlin::post
