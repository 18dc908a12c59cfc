#pragma once
// The files that a run writes, as one set: those of an earlier run are kept aside until the new run has passed its first steps.

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace drumlin {

/// Files with a number in their names, as dumps have: FOLDER/PREFIX NUMBER SUFFIX.
struct NumberedFiles {
  std::string folder, prefix, suffix;
};

/// Output files of one run. An earlier file is renamed to NAME.earlier. commit() removes what was kept aside; without it, the end of the
/// object or of the process puts it back and removes what the failed run has written. A process that is killed leaves the earlier
/// files aside: the next set with their names puts them back first.
///
/// Functions throw std::runtime_error with the words behind "COMMAND: " of an error line. For one rank.
class OutputSet {
public:
  OutputSet();
  ~OutputSet();
  OutputSet(const OutputSet &) = delete;
  OutputSet &operator=(const OutputSet &) = delete;

  /// Makes a folder, with its parents, and holds it until the end of the object: no other process can hold it meanwhile.
  void hold_folder(const std::string &folder);

  /// Makes a folder, with its parents; one that this made goes again with a run that fails.
  void make_folder(const std::string &folder);

  /// Keeps an earlier file of this name aside.
  void replace(const std::string &file);

  /// Keeps an earlier file aside; of a table (comma-separated values with a column `time`) it leaves a copy with the rows up to a time, s.
  void cut(const std::string &file, double time);

  /// Keeps numbered files from a number on aside. Their folder may be missing; if it is there, it may hold nothing but
  /// files of these patterns.
  void replace_numbered(const std::vector<NumberedFiles> &patterns, long from);

  /// Checks that the numbered files written since the last call are whole, which a full disk prevents.
  void check_numbered();

  /// The run has passed its first steps: what was kept aside goes.
  void commit();
  bool committed() const { return committed_; }

private:
  void roll_back();
  std::optional<long> number_in(const std::string &folder, const std::filesystem::path &file) const;
  void keep_aside(const std::filesystem::path &file);

  std::map<std::filesystem::path, bool>
      files_;                               ///< what the run writes; whether an earlier file is kept aside
  std::vector<std::filesystem::path> made_; ///< folders, the outermost first
  std::vector<NumberedFiles> numbered_;
  std::set<std::filesystem::path> before_;  ///< numbered files of earlier runs, as found at the start
  std::set<std::filesystem::path> checked_; ///< numbered files known to be whole
  int folder_lock_ = -1;
  bool committed_ = false;
};

} // namespace drumlin
