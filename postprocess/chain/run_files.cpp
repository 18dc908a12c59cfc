#include "chain/run_files.h"

#include "support/files.h"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <limits>
#include <optional>
#include <stdexcept>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr const char *chain_header =
    "time,x_drum,v_drum,a_drum,x_frame,v_frame,a_frame,F_contact,F_excitation,F_bond";
constexpr const char *events_header = "time,event,overlap,overlap_rate,force,id_i,id_j";
constexpr const char *cycles_header =
    "cycle,time,a_drum_min,a_drum_max,F_contact_min,F_contact_max,contact_share,makes,breaks";
constexpr const char *parameters_header = "name,value";

/// Columns of cycles.csv that are read; any of them may be missing.
constexpr const char *cycle_columns[] = {
    "cycle",           "time",          "a_drum_min", "a_drum_max",      "F_contact_min",
    "F_contact_max",   "contact_share", "a1_cos",     "a1_sin",          "a2_cos",
    "a2_sin",          "ah_cos",        "ah_sin",     "work_excitation", "dissipated_contact",
    "dissipated_bond", "kinetic",       "potential",  "stored_contact",  "stored_bond",
    "settlement"};

void append_number(fmt::memory_buffer &out, double value) {
  fmt::format_to(std::back_inserter(out), "{:.17g}", value);
}

} // namespace

ChainHistory read_chain(const fs::path &file) {
  struct Column {
    const char *name;
    std::vector<double> ChainHistory::*values;
    bool frame; // may be missing, but only together with the other columns of the frame
    std::optional<std::size_t> index;
  };
  std::array<Column, 10> columns = {{
      {"time", &ChainHistory::time, false, {}},
      {"x_drum", &ChainHistory::x_drum, false, {}},
      {"v_drum", &ChainHistory::v_drum, false, {}},
      {"a_drum", &ChainHistory::a_drum, false, {}},
      {"F_contact", &ChainHistory::F_contact, false, {}},
      {"F_excitation", &ChainHistory::F_excitation, false, {}},
      {"x_frame", &ChainHistory::x_frame, true, {}},
      {"v_frame", &ChainHistory::v_frame, true, {}},
      {"a_frame", &ChainHistory::a_frame, true, {}},
      {"F_bond", &ChainHistory::F_bond, true, {}},
  }};

  // A long record has millions of cells: they go straight into numbers, not through a Table of text.
  CsvRows rows(file);
  bool any_of_frame = false;
  for (Column &column : columns) {
    column.index = rows.find(column.name);
    any_of_frame = any_of_frame || (column.frame && column.index);
  }
  for (const Column &column : columns) {
    const bool optional = column.frame ? !any_of_frame : column.values == &ChainHistory::F_excitation;
    if (!column.index && !optional) rows.missing(column.name);
  }

  ChainHistory history;
  std::vector<std::string> cells;
  while (rows.next(cells)) {
    for (const Column &column : columns)
      if (column.index)
        (history.*column.values).push_back(csv_number(file, rows.line(), column.name, cells[*column.index]));
    const std::size_t count = history.size();
    if (count > 1 && !(history.time[count - 1] > history.time[count - 2]))
      csv_fault(file, rows.line(), "time",
                fmt::format("found {}, expected more than {} of the row before", history.time[count - 1],
                            history.time[count - 2]));
  }
  if (history.F_excitation.empty()) history.F_excitation.assign(history.size(), 0.0);
  return history;
}

std::vector<ContactEvent> read_events(const fs::path &file) {
  const Table table = read_table(file);
  const std::vector<double> time = table.numbers("time");
  const std::vector<std::string> kind = table.text("event");
  const std::vector<double> overlap = table.numbers("overlap");
  const std::vector<double> overlap_rate = table.numbers("overlap_rate");
  const std::vector<double> force = table.numbers("force");
  const std::vector<long> id_i = table.integers("id_i");
  const std::vector<long> id_j = table.integers("id_j");
  std::vector<ContactEvent> events;
  events.reserve(table.rows());
  for (std::size_t i = 0; i < table.rows(); ++i) {
    if (kind[i] != "make" && kind[i] != "break")
      csv_fault(file, table.line(i), "event", fmt::format("found '{}', expected make or break", kind[i]));
    events.push_back({time[i], kind[i] == "make", overlap[i], overlap_rate[i], force[i], id_i[i], id_j[i]});
  }
  return events;
}

std::vector<CycleSummary> read_cycles(const fs::path &file) {
  const Table table = read_table(file);
  const auto counts = [&table](const char *column) {
    std::vector<long> values =
        table.has(column) ? table.integers(column) : std::vector<long>(table.rows(), 0);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (values[i] < 0 || values[i] > std::numeric_limits<int>::max())
        csv_fault(table.file(), table.line(i), column, fmt::format("found {}, expected a count", values[i]));
    return values;
  };
  const std::vector<long> cycle = counts("cycle");
  const std::vector<long> makes = counts("makes");
  const std::vector<long> breaks = counts("breaks");
  table.text("cycle"); // a fault if the column is missing
  const std::vector<double> time = table.numbers("time");
  const std::vector<double> a_min = table.numbers("a_drum_min");
  const std::vector<double> a_max = table.numbers("a_drum_max");
  const std::vector<double> F_min = table.numbers("F_contact_min");
  const std::vector<double> F_max = table.numbers("F_contact_max");
  const std::vector<double> share = table.numbers("contact_share");
  std::vector<CycleSummary> cycles;
  cycles.reserve(table.rows());
  for (std::size_t i = 0; i < table.rows(); ++i)
    cycles.push_back({static_cast<int>(cycle[i]), time[i], a_min[i], a_max[i], F_min[i], F_max[i], share[i],
                      static_cast<int>(makes[i]), static_cast<int>(breaks[i])});
  return cycles;
}

CycleColumns read_cycle_columns(const fs::path &file) {
  const Table table = read_table(file);
  CycleColumns cycles;
  cycles.rows = table.rows();
  for (const char *name : cycle_columns)
    if (table.has(name)) cycles.columns[name] = table.numbers(name);
  return cycles;
}

std::map<std::string, std::string> read_parameters(const fs::path &file) {
  const Table table = read_table(file);
  const std::vector<std::string> names = table.text("name");
  const std::vector<std::string> values = table.text("value");
  std::map<std::string, std::string> parameters;
  for (std::size_t i = 0; i < table.rows(); ++i)
    if (!parameters.emplace(names[i], values[i]).second)
      csv_fault(file, table.line(i), "name", fmt::format("found '{}' a second time", names[i]));
  return parameters;
}

std::string chain_text(const ChainHistory &history) {
  const bool frame = history.has_frame();
  using Values = std::vector<double> ChainHistory::*;
  constexpr std::array<Values, 10> with_frame = {
      &ChainHistory::time,         &ChainHistory::x_drum,  &ChainHistory::v_drum,  &ChainHistory::a_drum,
      &ChainHistory::x_frame,      &ChainHistory::v_frame, &ChainHistory::a_frame, &ChainHistory::F_contact,
      &ChainHistory::F_excitation, &ChainHistory::F_bond};
  constexpr std::array<Values, 6> without_frame = {&ChainHistory::time,      &ChainHistory::x_drum,
                                                   &ChainHistory::v_drum,    &ChainHistory::a_drum,
                                                   &ChainHistory::F_contact, &ChainHistory::F_excitation};
  std::vector<const std::vector<double> *> columns;
  if (frame)
    for (const Values values : with_frame)
      columns.push_back(&(history.*values));
  else
    for (const Values values : without_frame)
      columns.push_back(&(history.*values));
  for (const std::vector<double> *column : columns)
    if (column->size() != history.size())
      throw std::invalid_argument(
          fmt::format("a chain history has columns of {} and of {} rows", history.size(), column->size()));

  fmt::memory_buffer out;
  out.append(std::string_view(frame ? chain_header : "time,x_drum,v_drum,a_drum,F_contact,F_excitation"));
  for (std::size_t row = 0; row < history.size(); ++row) {
    char separator = '\n';
    for (const std::vector<double> *column : columns) {
      out.push_back(separator);
      append_number(out, (*column)[row]);
      separator = ',';
    }
  }
  out.push_back('\n');
  return fmt::to_string(out);
}

std::string events_text(const std::vector<ContactEvent> &events) {
  std::string text = fmt::format("{}\n", events_header);
  for (const ContactEvent &event : events)
    text +=
        fmt::format("{:.17g},{},{:.17g},{:.17g},{:.17g},{},{}\n", event.time, event.make ? "make" : "break",
                    event.overlap, event.overlap_rate, event.force, event.id_i, event.id_j);
  return text;
}

std::string cycles_text(const std::vector<CycleSummary> &cycles) {
  std::string text = fmt::format("{}\n", cycles_header);
  for (const CycleSummary &cycle : cycles)
    text += fmt::format("{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{},{}\n", cycle.cycle, cycle.time,
                        cycle.a_drum_min, cycle.a_drum_max, cycle.F_contact_min, cycle.F_contact_max,
                        cycle.contact_share, cycle.makes, cycle.breaks);
  return text;
}

std::string parameters_text(const std::vector<std::pair<std::string, std::string>> &parameters) {
  std::string text = fmt::format("{}\n", parameters_header);
  for (const auto &[name, value] : parameters)
    text += fmt::format("{},{}\n", csv_cell(name), csv_cell(value));
  return text;
}

std::vector<std::pair<std::string, std::string>> parameter_values(const ChainParameters &p) {
  std::vector<std::pair<std::string, std::string>> values = {{"transition", transition_name(p.transition)}};
  for (const ChainNumber &number : chain_numbers)
    values.emplace_back(number.name, number_text(p.*number.value));
  return values;
}

void write_chain(const fs::path &file, const ChainHistory &history) {
  write_files({{file, chain_text(history)}});
}

void write_events(const fs::path &file, const std::vector<ContactEvent> &events) {
  write_files({{file, events_text(events)}});
}

void write_cycles(const fs::path &file, const std::vector<CycleSummary> &cycles) {
  write_files({{file, cycles_text(cycles)}});
}

void write_parameters(const fs::path &file,
                      const std::vector<std::pair<std::string, std::string>> &parameters) {
  write_files({{file, parameters_text(parameters)}});
}

} // namespace drumlin::post
