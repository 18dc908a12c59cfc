#include "pages/table.h"

#include "support/csv.h"

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

} // namespace drumlin::post
