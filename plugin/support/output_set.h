#pragma once
// The files that a run writes, as one set. Files of an earlier run are backed up until the new run has passed
// its first steps.

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace drumlin {

/// A row of a run's parameters: a name and a value, in quotes if they need them (RFC 4180).
std::string record_row(const std::string &name, const std::string &value);
/// The last row: whether and why the run has ended.
constexpr char ended_name[] = "ended";
constexpr char ended_not[] = "no";
constexpr char ended_yes[] = "yes";
constexpr char ended_by_error[] = "an error, which the engine's output names";

/// Files whose names differ by a number only, as dumps have: FOLDER/PREFIX NUMBER SUFFIX.
struct NumberedFiles {
  std::string folder, prefix, suffix;
};

/// The output files of one run. A file of an earlier run is renamed to its backup NAME.earlier. commit()
/// removes the backups. If the object is destroyed or the process ends before commit(), what the failed run
/// has written is removed and the backups get their names back. If a process is killed, the backups remain;
/// the next set with these names restores them first.
///
/// Functions throw std::runtime_error with the part of an error line behind "COMMAND: ". To be used on one
/// rank.
class OutputSet {
public:
  OutputSet();
  ~OutputSet();
  OutputSet(const OutputSet &) = delete;
  OutputSet &operator=(const OutputSet &) = delete;

  /// Files that the run has read: later functions throw for one of them, which a backup would take away.
  void keep(std::vector<std::string> inputs) { inputs_ = std::move(inputs); }

  /// Makes a folder, with its parents, and locks it until the end of the object: a second process cannot lock
  /// it meanwhile.
  void lock_folder(const std::string &folder);

  /// Makes a folder, with its parents. If the run fails, the folders that were made here are removed.
  void make_folder(const std::string &folder);

  /// Backs up an earlier file of this name, for a run that writes it from the beginning.
  void replace(const std::string &file);

  /// Backs up an earlier file, for a run that continues it. If it is a table (comma-separated values with a
  /// column `time`), a copy with the rows up to a time, s, takes its place.
  void truncate_table(const std::string &file, double time);

  /// Backs up the numbered files from a number on. Their folders need not exist; a folder that exists must
  /// have no other files than those of the patterns.
  void replace_numbered(const std::vector<NumberedFiles> &patterns, long from);

  /// Checks that the numbered files written since the last call are complete, which they are not after a full
  /// disk.
  void check_numbered();

  /// The run's parameters, a file with a last row `ended,no`, of a run that is not done or was killed. When
  /// the object is destroyed or the process ends, the row says `yes` or why the run has ended before its
  /// time.
  void record(const std::string &file) { record_ = file; }
  /// Why the run ends before its time: written at once, since mpirun may kill the process before it ends.
  void note_end(const std::string &why);
  bool ends() const { return !end_.empty(); }

  /// Names the file from which a stopped run continues: a run that has ended removes it.
  void continues_from(const std::string &file) { restarts_.push_back(file); }

  /// Removes the backups: the run has passed its first steps.
  void commit();
  bool committed() const { return committed_; }

private:
  /// \param otherwise the end of a run that has noted none
  void finish(const std::string &otherwise);
  void roll_back();
  std::optional<long> number_in(const std::string &folder, const std::filesystem::path &file) const;
  void back_up(const std::filesystem::path &file);

  std::map<std::filesystem::path, bool> files_; ///< what the run writes; true if an earlier file is backed up
  std::vector<std::filesystem::path> made_;     ///< folders, the outermost first
  std::vector<NumberedFiles> numbered_;
  std::vector<std::string> inputs_, restarts_;
  std::string record_, end_;
  std::set<std::filesystem::path> before_;  ///< numbered files of earlier runs, as found at the start
  std::set<std::filesystem::path> checked_; ///< numbered files known to be complete
  int folder_lock_ = -1;
  bool committed_ = false;
};

} // namespace drumlin
