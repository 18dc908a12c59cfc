// Work that continues where an earlier call was interrupted: the folder of its results, tables of which each
// row is written when it is known, and names for files that depend on what made them.
#pragma once

#include "support/csv_schema.h"
#include "support/files.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace drumlin::post {

/// The file of a folder of results that has the settings they depend on.
constexpr const char *settings_name = "study.txt";

/// The folder within it where calls at the same time make a part each.
constexpr const char *parts_name = "parts";

/// A folder of results that a later call with the same settings continues. No other call can write into it as
/// long as this object lives.
class ResumedFolder {
public:
  /// Makes the folder, or opens that of an earlier call of the same settings. Throws UsageError for the
  /// option --out if another call writes into it, if it has other files, or if its results are of other
  /// settings or of another version, unless `fresh`, which removes them.
  /// \param kind what the results are: study, map, calibration
  /// \param settings lines with all that the results depend on
  ResumedFolder(const std::filesystem::path &out, const std::string &kind, const std::string &settings,
                bool fresh);

private:
  FolderLock lock_;
};

/// The rows of a table of points that are finished, without a last one that an interruption cut short, and
/// without those with a cell that is NaN. No rows and no header if the table ends before the end of its
/// header.
Table finished_rows(const std::filesystem::path &file);

/// Throws the fault that a row is there twice.
[[noreturn]] void refuse_double(const Table &table, std::size_t row, std::size_t keys);

/// The points of such a table; none if there is no such file. std::runtime_error for a cell that cannot be
/// understood and for a point that is there twice.
template <class Point>
std::vector<Point> read_points(const std::filesystem::path &file, const CsvSchema<Point> &schema) {
  if (!std::filesystem::exists(file)) return {};
  const Table table = finished_rows(file);
  if (table.header().empty()) return {};
  std::vector<Point> points = schema.rows(table);
  std::map<std::vector<std::string>, std::size_t> known;
  for (std::size_t i = 0; schema.keys() > 0 && i < points.size(); ++i)
    if (!known.emplace(schema.key(points[i]), i).second) refuse_double(table, i, schema.keys());
  return points;
}

/// The points of a call that are finished: a CSV file, each row written when it is known. Rows that
/// finished_rows() leaves out are removed, so that their points are measured again. The caller asks for all
/// points in the order of the call, by has(), so that finish() can tell rows that do not belong to the call,
/// and put the others in this order.
class ResumedTable {
public:
  using Row = std::vector<std::string>;

  /// Throws UsageError or std::runtime_error, and leaves the file as it is, if it has other columns, a row of
  /// another length, or a point twice.
  /// \param columns header line, with units in the names
  /// \param keys how many columns, from the first on, name a point
  ResumedTable(std::filesystem::path file, Row columns, std::size_t keys);
  template <class Point>
  ResumedTable(std::filesystem::path file, const CsvSchema<Point> &schema)
      : ResumedTable(std::move(file), schema.header(), schema.keys()) {}

  /// Whether the point with this key is finished.
  bool has(const Row &key);
  /// Adds points and writes them at once.
  void add(const std::vector<Row> &rows);
  void add(const Row &row) { add(std::vector<Row>{row}); }
  /// Puts the rows in the order in which has() was asked for them first, as a call without an interruption
  /// writes them. Throws std::runtime_error, and leaves the file as it is, if it has a row that was not asked
  /// for.
  void finish();
  const std::filesystem::path &file() const { return file_; }

private:
  struct Place {
    std::size_t asked = 0; ///< how many points had been asked for, this one included; 0: not asked for
    bool finished = false;
  };

  std::filesystem::path file_;
  Row columns_;
  std::size_t keys_;
  std::map<Row, Place> places_;
  std::size_t asked_ = 0;
};

/// Sixteen digits that depend on each letter of a text: for the name of a file, so that one made of something
/// else is not taken for it.
std::string fingerprint(std::string_view text);

} // namespace drumlin::post
