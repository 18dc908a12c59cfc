#include "report/chain/engine_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

namespace drumlin::post {

namespace {

/// The first word of "LAMMPS 29 Sep 2021".
std::string engine_name(const Run &run) {
  const std::string engine = run.text("engine", "");
  return engine.substr(0, engine.find(' '));
}

/// Whether two runs have the same parameters, apart from those that say where and how they ran.
bool same_chain(const Run &one, const Run &other) {
  const auto chain = [](std::map<std::string, std::string> parameters) {
    for (const char *name : {"engine", "plugin", "ranks", "command"})
      parameters.erase(name);
    return parameters;
  };
  return chain(one.parameters) == chain(other.parameters);
}

/// Largest |a - b| over the largest |b|; infinite for different lengths.
double difference(const std::vector<double> &a, const std::vector<double> &b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double largest = 0.0;
  double apart = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    largest = std::max(largest, std::fabs(b[n]));
    apart = std::max(apart, std::fabs(a[n] - b[n]));
  }
  return apart == 0.0 ? 0.0 : apart / largest;
}

/// Largest difference in time between corresponding events, s; infinite if kind or number of the events
/// differ.
double event_distance(const Run &one, const Run &other) {
  if (one.events.size() != other.events.size()) return std::numeric_limits<double>::infinity();
  double apart = 0.0;
  for (std::size_t n = 0; n < one.events.size(); ++n) {
    if (one.events[n].make != other.events[n].make) return std::numeric_limits<double>::infinity();
    apart = std::max(apart, std::fabs(one.events[n].time - other.events[n].time));
  }
  return apart;
}

} // namespace

std::vector<std::pair<std::size_t, std::size_t>> engine_pairs(const ReportResults &results) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  const auto is_engine = [](const Run &run) {
    return run.kind == RunKind::chain && run.cut.empty() && !run.direct && !engine_name(run).empty();
  };
  for (std::size_t a = 0; a < results.runs.size(); ++a)
    for (std::size_t b = 0; b < results.runs.size(); ++b) {
      const Run &one = results.runs[a].run;
      const Run &other = results.runs[b].run;
      if (is_engine(one) && is_engine(other) && engine_name(one) < engine_name(other) &&
          same_chain(one, other))
        pairs.emplace_back(a, b);
    }
  return pairs;
}

PageTable engine_table(const ReportResults &results) {
  std::vector<HistoryColumn> columns; // that the engines compute
  for (const HistoryColumn &column : history_columns)
    if (column.derivative != time_column && column.group != ColumnGroup::way &&
        column.group != ColumnGroup::ends && column.values != &ChainHistory::F_excitation)
      columns.push_back(column);
  PageTable table("engines", "Largest difference over the largest value",
                  "run | against | engines | case | transition | stepping");
  table.section = "engines";
  table.verdict = "agree";
  table.criterion = fmt::format("pairs of runs agree within {:g}", engines_agree_to);
  for (const HistoryColumn &column : columns)
    table.header.push_back(std::string(column.name) + " (-)");
  table.header.insert(table.header.end(), {"events", "event times (s)", "agree"});
  table.text_columns = 6;
  table.shown_columns = table.header.size();
  for (const auto &[a, b] : engine_pairs(results)) {
    const Run &one = results.runs[a].run;
    const Run &other = results.runs[b].run;
    std::vector<std::string> row = {one.name,
                                    other.name,
                                    one.text("engine", "") + ", " + other.text("engine", ""),
                                    one.case_name,
                                    transition_name(one.transition()),
                                    one.text("stepping")};
    const double events = event_distance(one, other);
    double worst = events / one.history.time.back();
    for (const HistoryColumn &column : columns) {
      const double apart = difference(one.history.*column.values, other.history.*column.values);
      worst = std::max(worst, apart);
      row.push_back(std::isfinite(apart) ? fmt::format("{:.1e}", apart) : "–");
    }
    const bool agree = worst <= engines_agree_to;
    row.insert(row.end(),
               {std::to_string(one.events.size()),
                std::isfinite(events) ? fmt::format("{:.1e}", events) : "–", agree ? "yes" : "no"});
    table.add(std::move(row), agree ? RowState::agrees : RowState::differs);
  }
  if (!table.rows.empty())
    table.notes.push_back(fmt::format("Both engines use the same fixes and contact laws; pair styles and "
                                      "neighbour lists are their own. Only rounding errors, and their growth "
                                      "in the motion of the chain, can make a difference. Allowed: {:g}.",
                                      engines_agree_to));
  return table;
}

} // namespace drumlin::post
