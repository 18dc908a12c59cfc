// The parts that all studies share: options, and results that are kept when a study is interrupted.
#pragma once

#include "support/csv_schema.h"

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

/// Options of all studies.
struct StudyOptions {
  std::filesystem::path out; ///< folder of its results, made if missing
  bool fresh = false;        ///< discard the results of an earlier call
  bool quick = false;        ///< few points, to test that the study works; the results are not meaningful
  int balls = 2500;          ///< of the complete bed, in a study whose beds are scaled
  int jobs = 1;              ///< runs at the same time, in a study that does not time them against each other
};

/// Throws UsageError for a folder that the engine would split at a space.
void check_engine_path(const std::filesystem::path &out);

/// Makes the folder of a study, or opens one in which an earlier call has left points, to continue it. Throws
/// UsageError if these points are from another build of the plugin or another choice of `quick`, unless the
/// options say `fresh`, which removes them.
void open_study(const StudyOptions &options);

/// The rows of a study's file without those that an interruption cut short, and without those with a cell
/// that is NaN.
Table finished_rows(const std::filesystem::path &file);

/// Reads the points of a study that are finished, as StudyResults does; none if there is no such file.
/// std::runtime_error for a cell that cannot be understood.
template <class Point>
std::vector<Point> read_points(const std::filesystem::path &file, const CsvSchema<Point> &schema) {
  if (!std::filesystem::exists(file)) return {};
  return schema.rows(finished_rows(file));
}

/// The point among `points` with the same key as `like`; nullptr if there is none.
template <class Point>
const Point *find_point(const std::vector<Point> &points, const CsvSchema<Point> &schema, const Point &like) {
  for (const Point &point : points)
    if (schema.key(point) == schema.key(like)) return &point;
  return nullptr;
}

/// The points of a study that are finished: a CSV file, each row written when it is known. Rows that
/// finished_rows() leaves out are removed, so that their points are measured again.
class StudyResults {
public:
  using Row = std::vector<std::string>;

  /// \param columns header line, with units in the names
  /// \param keys how many columns, from the first on, name a point
  StudyResults(std::filesystem::path file, Row columns, std::size_t keys);
  template <class Point>
  StudyResults(std::filesystem::path file, const CsvSchema<Point> &schema)
      : StudyResults(std::move(file), schema.header(), schema.keys()) {}

  /// Whether the point with this key is finished.
  bool has(const Row &key) const { return finished_.count(key) > 0; }
  /// Adds a point and writes it at once.
  void add(const Row &row);
  const std::filesystem::path &file() const { return file_; }

private:
  Row key_of(const Row &row) const { return {row.begin(), row.begin() + static_cast<std::ptrdiff_t>(keys_)}; }

  std::filesystem::path file_;
  Row columns_;
  std::size_t keys_;
  std::set<Row> finished_;
};

/// The note below a table of means and changes over seeds, as written in pages: MEAN ± HALF WIDTH, * for a significant
/// change. \param compared what a change compares, in words
std::string seed_by_seed_note(const std::string &compared);

} // namespace drumlin::post
