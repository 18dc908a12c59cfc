#include "pages/table.h"

#include "support/csv.h"

#include <utility>

namespace drumlin::post {

void ReportTable::add(std::vector<std::string> row, RowState state) {
  rows.push_back(std::move(row));
  states.push_back(state);
}

std::string table_csv(const ReportTable &table) {
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
