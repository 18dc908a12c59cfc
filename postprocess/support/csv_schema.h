// The columns of a CSV file whose rows are objects, written down once for its writer and its reader:
//
//   const CsvSchema<Run> runs({csv_column("law", &Run::law), csv_column("time_s", &Run::time)}, 1);
#pragma once

#include "support/csv.h"

#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace drumlin::post {

/// One column: its name with unit, how a row's value becomes a cell, and how a cell becomes the value.
template <class Row>
struct CsvColumn {
  std::string name;
  std::function<std::string(const Row &)> cell;
  /// Throws std::invalid_argument that says what is allowed. Empty: the column is written, but not read.
  std::function<void(Row &, const std::string &)> take;
};

/// A value as a cell. Numbers have so many significant digits; with less than all of them, as measured values
/// have it, a number that is not finite is an empty cell.
template <class Value>
std::string csv_text(const Value &value, int digits) {
  if constexpr (std::is_same_v<Value, std::string>)
    return value;
  else if constexpr (std::is_integral_v<Value>)
    return std::to_string(value);
  else
    return digits < all_digits && !std::isfinite(value) ? std::string() : number_text(value, digits);
}

/// The value of a cell. A number may be infinite; an empty cell is NaN, the word "nan" is refused.
template <class Value>
Value csv_value(const std::string &cell) {
  if constexpr (std::is_same_v<Value, std::string>) {
    return cell;
  } else if constexpr (std::is_integral_v<Value>) {
    const std::optional<long> value = whole_number_from_text(cell);
    if (!value || *value < std::numeric_limits<Value>::min() || *value > std::numeric_limits<Value>::max())
      throw std::invalid_argument("a whole number");
    return static_cast<Value>(*value);
  } else {
    if (cell.empty()) return std::numeric_limits<Value>::quiet_NaN();
    const std::optional<double> value = any_number_from_text(cell);
    if (!value || std::isnan(*value)) throw std::invalid_argument("a number");
    return *value;
  }
}

/// A column of the value that `part` refers to, a function of a row, const or not, that returns a reference.
template <class Row, class Value, class Part>
CsvColumn<Row> csv_column_of(std::string name, Part part, int digits) {
  return {std::move(name), [part, digits](const Row &row) { return csv_text<Value>(part(row), digits); },
          [part](Row &row, const std::string &cell) { part(row) = csv_value<Value>(cell); }};
}

/// A column of a member: text, a whole number or a number.
template <class Row, class Value>
CsvColumn<Row> csv_column(std::string name, Value Row::*member, int digits = all_digits) {
  return csv_column_of<Row, Value>(
      std::move(name), [member](auto &row) -> auto & { return row.*member; }, digits);
}

/// A column of a member of a member.
template <class Row, class Part, class Value>
CsvColumn<Row> csv_column(std::string name, Part Row::*part, Value Part::*member, int digits = all_digits) {
  return csv_column_of<Row, Value>(
      std::move(name), [ part, member ](auto &row) -> auto & { return row.*part.*member; }, digits);
}

/// Rows of one kind: the columns, of which the first `keys` name a row.
template <class Row>
class CsvSchema {
public:
  explicit CsvSchema(std::vector<CsvColumn<Row>> columns, std::size_t keys = 0)
      : columns_(std::move(columns)), keys_(keys) {}

  std::size_t keys() const { return keys_; }

  std::vector<std::string> header() const {
    std::vector<std::string> names;
    names.reserve(columns_.size());
    for (const CsvColumn<Row> &column : columns_)
      names.push_back(column.name);
    return names;
  }

  std::vector<std::string> cells(const Row &row) const {
    std::vector<std::string> all;
    all.reserve(columns_.size());
    for (const CsvColumn<Row> &column : columns_)
      all.push_back(column.cell(row));
    return all;
  }

  /// The cells that name a row.
  std::vector<std::string> key(const Row &row) const {
    std::vector<std::string> all;
    all.reserve(keys_);
    for (std::size_t i = 0; i < keys_; ++i)
      all.push_back(columns_[i].cell(row));
    return all;
  }

  /// The text of a file with these rows.
  std::string text(const std::vector<Row> &rows) const {
    std::string all = csv_line(header());
    for (const Row &row : rows)
      all += csv_line(cells(row));
    return all;
  }

  /// The rows of a table, whose columns may be in any order, among others that are ignored.
  /// std::runtime_error with file, line, column, the cell and what is allowed.
  std::vector<Row> rows(const Table &table) const {
    std::vector<Row> all(table.rows());
    for (const CsvColumn<Row> &column : columns_) {
      if (!column.take) continue;
      const std::vector<std::string> cells = table.text(column.name);
      for (std::size_t i = 0; i < all.size(); ++i)
        try {
          column.take(all[i], cells[i]);
        } catch (const std::invalid_argument &allowed) {
          csv_refusal(table.file(), table.line(i), column.name, cells[i], allowed.what());
        }
    }
    return all;
  }

private:
  std::vector<CsvColumn<Row>> columns_;
  std::size_t keys_;
};

} // namespace drumlin::post
