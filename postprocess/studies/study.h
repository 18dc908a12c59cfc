// What every study shares: results that survive an interruption, a progress display, runs of decks in folders of their own.
#pragma once

#include "engine/deck_run.h"
#include "support/statistics.h"

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace drumlin::post {

/// What a user asks of any study.
struct StudyOptions {
  std::filesystem::path out; ///< folder of its results, made if missing
  bool fresh = false;        ///< forget what an earlier call measured
  bool quick = false;        ///< few points: to see that it works, not to learn from
  int jobs = 1;              ///< runs at the same time, in a study that does not time them against each other
};

/// Throws UsageError for a folder that the engine would split at a space.
void check_engine_path(const std::filesystem::path &out);

/// Makes the folder of a study, or finds an earlier call's points there, to go on from. Points of another build of the
/// plugin, or of another choice of `quick`, do not mix: UsageError, unless the options say fresh, which removes them.
void open_study(const StudyOptions &options);

/// The points of a study that are finished: a CSV file, each row written when it is known. A row cut short by an
/// interruption is forgotten, and so is one with a cell that is nan: it is measured again.
class StudyResults {
public:
  using Row = std::vector<std::string>;

  /// \param columns header line, with units in the names
  /// \param keys how many columns, from the first on, name a point
  StudyResults(std::filesystem::path file, Row columns, std::size_t keys);

  /// The point with this key, or nullptr.
  const Row *find(const Row &key) const;
  /// Adds a point and writes it at once.
  void add(const Row &row);
  /// All points in the order in which they were measured.
  const std::vector<Row> &rows() const { return rows_; }
  /// Place of a column; std::logic_error if there is none of that name.
  std::size_t column(const std::string &name) const;
  const std::string &text(const Row &row, const std::string &name) const { return row[column(name)]; }
  /// The number in a cell, 0 for an empty one. UsageError for a cell that holds something else.
  double number(const Row &row, const std::string &name) const;
  const std::filesystem::path &file() const { return file_; }

private:
  std::filesystem::path file_;
  Row columns_;
  std::size_t keys_;
  std::vector<Row> rows_;
  std::map<Row, std::size_t> places_;
};

/// One line per point on standard output: how many of how many, what, and the time left.
class StudyProgress {
public:
  explicit StudyProgress(std::size_t total) : total_(total) {}
  void found();                           ///< a point that an earlier call measured
  void measured(const std::string &what); ///< a point that was measured now

private:
  std::size_t total_;
  std::size_t found_ = 0;
  std::size_t measured_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

} // namespace drumlin::post
