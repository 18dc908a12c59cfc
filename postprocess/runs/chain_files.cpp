#include "runs/chain_files.h"

#include "support/csv_schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <stdexcept>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// A column of numbers that must be finite.
template <class Row>
CsvColumn<Row> finite(const char *name, double Row::*value) {
  CsvColumn<Row> column = csv_column(name, value);
  column.take = [value](Row &row, const std::string &cell) {
    const std::optional<double> number = any_number_from_text(cell);
    if (!number || !std::isfinite(*number)) throw std::invalid_argument("a finite number");
    row.*value = *number;
  };
  return column;
}

const CsvSchema<ContactEvent> &event_columns() {
  const CsvColumn<ContactEvent> kind = {
      "event", [](const ContactEvent &event) { return std::string(event.make ? "make" : "break"); },
      [](ContactEvent &event, const std::string &cell) {
        if (cell != "make" && cell != "break") throw std::invalid_argument("make, break");
        event.make = cell == "make";
      }};
  static const CsvSchema<ContactEvent> schema(
      {finite("time", &ContactEvent::time), kind, finite("overlap", &ContactEvent::overlap),
       finite("overlap_rate", &ContactEvent::overlap_rate), finite("force", &ContactEvent::force),
       csv_column("id_i", &ContactEvent::id_i), csv_column("id_j", &ContactEvent::id_j)});
  return schema;
}

const CsvSchema<CycleSummary> &cycle_columns() {
  static const CsvSchema<CycleSummary> schema(
      {csv_column("cycle", &CycleSummary::cycle), csv_column("time", &CycleSummary::time),
       csv_column("a_drum_min", &CycleSummary::a_drum_min),
       csv_column("a_drum_max", &CycleSummary::a_drum_max),
       csv_column("F_contact_min", &CycleSummary::F_contact_min),
       csv_column("F_contact_max", &CycleSummary::F_contact_max),
       csv_column("contact_share", &CycleSummary::contact_share), csv_column("makes", &CycleSummary::makes),
       csv_column("breaks", &CycleSummary::breaks)});
  return schema;
}

/// Columns of cycles.csv that read_cycle_columns() reads; any of them may be missing.
constexpr const char *known_cycle_columns[] = {
    "cycle",           "time",          "a_drum_min", "a_drum_max",      "F_contact_min",
    "F_contact_max",   "contact_share", "a1_cos",     "a1_sin",          "a2_cos",
    "a2_sin",          "ah_cos",        "ah_sin",     "work_excitation", "dissipated_contact",
    "dissipated_bond", "kinetic",       "potential",  "stored_contact",  "stored_bond",
    "settlement"};

} // namespace

ChainHistory read_chain(const fs::path &file, CutRows cut) {
  // A long record has millions of cells: they go straight into numbers, not through a Table of text.
  CsvRows rows(file, cut);
  const auto any_of = [&](ColumnGroup group) {
    return std::any_of(history_columns.begin(), history_columns.end(), [&](const HistoryColumn &column) {
      return column.group == group && rows.find(column.name);
    });
  };
  std::vector<std::pair<const HistoryColumn *, std::size_t>> found; // with the place in a row
  for (const HistoryColumn &column : history_columns) {
    const std::optional<std::size_t> place = rows.find(column.name);
    const bool optional = column.group == ColumnGroup::motion ? column.values == &ChainHistory::F_excitation
                                                              : !any_of(column.group);
    if (place)
      found.emplace_back(&column, *place);
    else if (!optional)
      rows.missing(column.name);
  }

  ChainHistory history;
  std::vector<std::string> cells;
  while (rows.next(cells)) {
    for (const auto &[column, place] : found)
      (history.*column->values).push_back(csv_number(file, rows.line(), column->name, cells[place]));
    const std::size_t count = history.size();
    if (count > 1 && !(history.time[count - 1] > history.time[count - 2]))
      csv_refusal(file, rows.line(), "time", fmt::format("{}", history.time[count - 1]),
                  fmt::format("more than {} of the row before", history.time[count - 2]));
  }
  if (history.F_excitation.empty()) history.F_excitation.assign(history.size(), 0.0);
  return history;
}

std::vector<ContactEvent> read_events(const fs::path &file, CutRows cut) {
  return event_columns().rows(read_table(file, cut));
}

CycleColumns read_cycle_columns(const fs::path &file) {
  const Table table = read_table(file, CutRows::last);
  CycleColumns cycles;
  cycles.rows = table.rows();
  for (const char *name : known_cycle_columns)
    if (table.has(name)) cycles.columns[name] = table.numbers(name);
  return cycles;
}

std::string chain_text(const ChainHistory &history) {
  std::vector<std::string> names;
  std::vector<const std::vector<double> *> columns;
  for (const HistoryColumn &column : history_columns) {
    if (!history.has(column.group)) continue;
    names.emplace_back(column.name);
    columns.push_back(&(history.*column.values));
    if (columns.back()->size() != history.size())
      throw std::invalid_argument(fmt::format("a chain history has columns of {} and of {} rows",
                                              history.size(), columns.back()->size()));
  }
  fmt::memory_buffer out;
  out.append(csv_line(names));
  for (std::size_t row = 0; row < history.size(); ++row)
    for (const std::vector<double> *column : columns) {
      fmt::format_to(std::back_inserter(out), "{:.17g}", (*column)[row]);
      out.push_back(column == columns.back() ? '\n' : ',');
    }
  return fmt::to_string(out);
}

std::string events_text(const std::vector<ContactEvent> &events) { return event_columns().text(events); }

std::string cycles_text(const std::vector<CycleSummary> &cycles) { return cycle_columns().text(cycles); }

} // namespace drumlin::post
