// Where results go and how they are written: never onto a device, a pipe or a folder, and an earlier file is
// replaced only when the new one is complete.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

/// Checks that a folder can take results, before any work is done: it exists and can be written to, or can be
/// made. A symbolic link to a folder is followed. Refused are the root folder, /dev, /proc, /sys and all
/// below them. Nothing is made. Throws std::runtime_error "WHY; allowed: WHAT", without the folder's name.
void check_output_folder(const std::filesystem::path &folder);

/// Checks that a file can be written, in a folder that can take it: it does not exist, or it is a regular
/// file that its mode lets be written. A symbolic link to such a file is followed; one that leads nowhere, a
/// device, a pipe, a socket and a folder are refused. Nothing is made. Throws as check_output_folder does.
void check_output_file(const std::filesystem::path &file);

/// Makes the folder of results and those above it; std::runtime_error "WHY; allowed: WHAT" if it cannot be
/// made or used.
void make_output_folder(const std::filesystem::path &folder);

/// Makes the folder of a file that is to be written; the same errors.
void make_parent_folder(const std::filesystem::path &file);

/// A whole file as text; std::runtime_error "FILE: WHY" if it cannot be read.
std::string read_text(const std::filesystem::path &file);

/// A name of a file and the text to go into it.
using FileText = std::pair<std::filesystem::path, std::string>;

/// Writes the files, all or none: every text is first written to a temporary file in the same folder, every
/// write and close is checked, then all are renamed. A symbolic link stays, and the file to which it points
/// is replaced; an earlier file's mode is kept. The folder must exist. std::runtime_error names the file that
/// failed and why; earlier files are then as they were.
void write_files(const std::vector<FileText> &files);

/// Gives a finished file its name, in the place of an earlier regular file if there is one; the rules of
/// check_output_file. std::runtime_error names the file and why it failed.
void replace_file(const std::filesystem::path &finished, const std::filesystem::path &file);

/// Adds text at the end of a file and checks that all of it arrived. std::runtime_error names the file and
/// why not; the part that was added is then removed again where that is possible.
void append_text(const std::filesystem::path &file, const std::string &text);

/// Holds a folder for this process, as decks hold theirs (flock), until the object ends or the process does,
/// however it ends. Some network file systems cannot lock a folder: there nobody is refused.
class FolderLock {
public:
  FolderLock() = default; ///< holds nothing
  explicit FolderLock(const std::filesystem::path &folder);
  ~FolderLock();
  FolderLock(FolderLock &&other) noexcept;
  FolderLock &operator=(FolderLock &&other) noexcept;
  bool held() const { return file_ >= 0; }
  /// Whether it is not held because another object or process holds the folder.
  bool of_another() const { return of_another_; }
  /// Whether it is not held because the folder has been removed, and perhaps made again by another.
  bool removed() const { return removed_; }

private:
  int file_ = -1;
  bool of_another_ = false, removed_ = false;
};

/// Holds a folder of results. Throws UsageError if another call writes into it.
/// \param option by which the folder is given
FolderLock lock_output_folder(const std::filesystem::path &folder, const char *option = "--out");

/// A temporary folder, PARENT/PREFIX followed by a number, which is held as long as this object lives. The
/// destructor removes it with all that is still in it. The constructor first removes such folders that nobody
/// holds: those of processes that were killed.
class TemporaryFolder {
public:
  TemporaryFolder(const std::filesystem::path &parent, const std::string &prefix);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder &) = delete;
  TemporaryFolder &operator=(const TemporaryFolder &) = delete;
  const std::filesystem::path &path() const { return path_; }
  /// Whether another process holds a folder of the same parent and prefix.
  bool has_others() const;

private:
  std::filesystem::path path_;
  std::string prefix_;
  FolderLock lock_;
};

/// Results that replace a folder as a whole once all of them are there. They are made in a temporary folder
/// next to it. The destructor removes what was not published.
class FolderInProgress {
public:
  /// \param place absolute, without a trailing slash; its parent exists. If a process was killed while it
  /// published, the earlier folder is put back first. Throws UsageError for the option --out if another
  /// process makes results for the same place.
  explicit FolderInProgress(const std::filesystem::path &place);
  /// Where the results are made.
  const std::filesystem::path &path() const { return folder_.path(); }
  /// Puts the results in their place. std::runtime_error if that fails; an earlier folder is then where it
  /// was.
  void publish();

private:
  std::filesystem::path place_;
  TemporaryFolder folder_;
};

/// Files that are moved into a folder, which may have others, once all of them are there. They are made in a
/// temporary folder inside it. The destructor removes what was not published, and the folder if this object
/// has made it and it is still empty.
class FilesInProgress {
public:
  /// Throws UsageError for the option --out if another process makes files for the same folder.
  explicit FilesInProgress(const std::filesystem::path &folder);
  ~FilesInProgress();
  FilesInProgress(const FilesInProgress &) = delete;
  FilesInProgress &operator=(const FilesInProgress &) = delete;
  /// Where a file is made.
  std::filesystem::path operator/(const std::string &name) const { return temporary_->path() / name; }
  /// Moves the files into the folder, and removes those of an earlier call, which `is_ours` knows by name,
  /// that they do not replace.
  void publish(const std::vector<std::string> &names,
               const std::function<bool(const std::string &)> &is_ours);

private:
  std::filesystem::path folder_;
  bool made_;
  std::optional<TemporaryFolder> temporary_;
};

} // namespace drumlin::post
