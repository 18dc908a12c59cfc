#include "pages/table.h"

#include "support/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace drumlin::post {

PageTable::PageTable(std::string table_name, std::string table_title, const std::string &columns,
                     std::size_t columns_of_words)
    : name(std::move(table_name)), title(std::move(table_title)), text_columns(columns_of_words) {
  const std::string between = " | ";
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + between.size()) {
    end = columns.find(between, begin);
    header.push_back(columns.substr(begin, end - begin));
  }
}

void PageTable::add(std::vector<std::string> row, RowState state) {
  rows.push_back(std::move(row));
  states.push_back(state);
}

std::size_t PageTable::count(RowState state) const {
  return static_cast<std::size_t>(std::count(states.begin(), states.end(), state));
}

std::string table_csv(const PageTable &table) {
  std::string text;
  const auto line = [&text](const std::vector<std::string> &cells) {
    for (std::size_t i = 0; i < cells.size(); ++i)
      text += (i == 0 ? "" : ",") + csv_cell(cells[i] == no_value ? "" : cells[i]);
    text += '\n';
  };
  line(table.header);
  for (const std::vector<std::string> &row : table.rows)
    line(row);
  return text;
}

PageTable acceptance_table(const std::vector<Acceptance> &criteria) {
  PageTable table("acceptance", "Acceptance criteria", "acceptance criterion | measured | holds", 2);
  table.verdict = "holds";
  table.criterion = "criteria hold";
  for (const Acceptance &one : criteria)
    table.add({one.criterion, one.measured, one.holds ? "yes" : "no"},
              one.holds ? RowState::agrees : RowState::differs);
  return table;
}

std::string acceptance_words(const std::vector<Acceptance> &criteria) {
  if (criteria.empty()) return "No acceptance criterion can be judged by these runs.";
  const auto held =
      std::count_if(criteria.begin(), criteria.end(), [](const Acceptance &one) { return one.holds; });
  std::string words = fmt::format("{} of {} acceptance criteria hold.", held, criteria.size());
  const char *separator = " Not met: ";
  for (const Acceptance &one : criteria) {
    if (one.holds) continue;
    words += fmt::format("{}{} (measured {})", separator, one.criterion, one.measured);
    separator = "; ";
  }
  return words + (words.back() == '.' ? "" : ".");
}

} // namespace drumlin::post
