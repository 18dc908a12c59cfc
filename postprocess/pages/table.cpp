#include "pages/table.h"

#include "support/csv.h"

#include <algorithm>
#include <utility>

namespace drumlin::post {

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
