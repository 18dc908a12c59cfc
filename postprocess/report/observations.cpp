#include "report/observations.h"

#include "pages/page.h"
#include "support/csv.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace drumlin::post {

namespace {

struct KindOfVerdict {
  std::string_view word;
  RowState state;
  const char *heading; ///< of the sentence that counts its rows
};

/// In the order of the page.
constexpr std::array<KindOfVerdict, 4> kinds = {
    {{"differs", RowState::differs, "differs from"},
     {"differs in part", RowState::differs, "differs in part from"},
     {"agrees", RowState::agrees, "agrees with"},
     {"not modelled", RowState::plain, "leaves out"}}};

enum Column { observed, figure, verdict, remark, source, read, scene, command, columns };

constexpr const char *header =
    "observed | figure and interval | verdict | remark | source | read | scene | command";

/// The rows of a table with a verdict.
std::vector<const std::vector<std::string> *> rows_with(const PageTable &table, std::string_view word) {
  std::vector<const std::vector<std::string> *> rows;
  for (const std::vector<std::string> &row : table.rows)
    if (row[verdict] == word) rows.push_back(&row);
  return rows;
}

} // namespace

PageTable read_observations(const std::vector<std::filesystem::path> &files) {
  PageTable all("observations", "Observations", header, columns);
  all.verdict = all.header[verdict];
  all.criterion = "observations agree with what the model does";
  std::array<std::vector<std::vector<std::string>>, kinds.size()> sorted;
  for (const std::filesystem::path &file : files) {
    const Table table = read_table(file);
    if (table.rows() == 0) csv_fault(file, 0, "", "no observation; allowed are 1 or more rows");
    std::vector<std::vector<std::string>> cells;
    for (const std::string &name : all.header)
      cells.push_back(table.text(name));
    for (std::size_t r = 0; r < table.rows(); ++r) {
      std::size_t kind = 0;
      while (kind < kinds.size() && kinds.at(kind).word != cells[verdict][r])
        ++kind;
      if (kind == kinds.size())
        csv_refusal(file, table.line(r), all.verdict, cells[verdict][r],
                    "differs, differs in part, agrees or not modelled");
      std::vector<std::string> &row = sorted.at(kind).emplace_back();
      for (const std::vector<std::string> &column : cells)
        row.push_back(column[r]);
    }
  }
  for (std::size_t kind = 0; kind < kinds.size(); ++kind)
    for (std::vector<std::string> &row : sorted.at(kind))
      all.add(std::move(row), kinds.at(kind).state);
  return all;
}

void write_observations_page(const std::filesystem::path &folder, const PageTable &observations) {
  Page page(folder, observations_title, std::nullopt);
  for (const KindOfVerdict &kind : kinds) {
    const auto rows = rows_with(observations, kind.word);
    if (rows.empty()) continue;
    std::string sentence = fmt::format("The model {} {} of {} observations", kind.heading, rows.size(),
                                       observations.rows.size());
    if (kind.state == RowState::differs)
      for (std::size_t n = 0; n < rows.size(); ++n)
        sentence += fmt::format("{}{} ({})", n == 0 ? ": " : "; ", (*rows[n])[observed], (*rows[n])[remark]);
    page.answer(sentence + ".");
  }
  page.section("Observation, figure and verdict");
  page.table(observations);
  page.section("How far this goes");
  page.paragraph(
      "Trends are compared, not values: of most sources only the abstract could be read, no number "
      "of a source was a target, and nothing was adjusted to agree. A figure before a bracket is a "
      "median and the bracket the range over chains, or a mean and its 95 % confidence interval "
      "over seeds of the soil. Nothing here was compared with a measured record of a roller.");
  page.write();
}

} // namespace drumlin::post
