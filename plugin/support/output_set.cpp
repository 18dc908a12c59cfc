#include "support/output_set.h"

#include "support/whole_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <sys/file.h>
#include <unistd.h>
#include <utility>

namespace drumlin {

namespace fs = std::filesystem;

namespace {

constexpr const char *backup_suffix = ".earlier";

fs::path backup_of(const fs::path &file) { return file.string() + backup_suffix; }

/// Gives a backup that a killed process has not restored the name of its file back.
void recover(const fs::path &file) {
  std::error_code code;
  if (fs::exists(backup_of(file), code)) fs::rename(backup_of(file), file, code);
}

/// The number in a file's name, if the name matches the pattern.
std::optional<long> number_of(const std::string &name, const NumberedFiles &pattern) {
  const std::size_t ends = pattern.prefix.size() + pattern.suffix.size();
  if (name.size() <= ends || name.compare(0, pattern.prefix.size(), pattern.prefix) != 0 ||
      name.compare(name.size() - pattern.suffix.size(), pattern.suffix.size(), pattern.suffix) != 0)
    return {};
  const std::string digits = name.substr(pattern.prefix.size(), name.size() - ends);
  constexpr std::size_t most_digits = 18;
  if (digits.size() > most_digits || digits.find_first_not_of("0123456789") != std::string::npos) return {};
  return std::stol(digits);
}

/// The files and folders in a folder; empty if it does not exist.
std::vector<fs::path> files_in(const std::string &folder) {
  std::error_code code;
  std::vector<fs::path> files;
  for (const auto &entry : fs::directory_iterator(folder, code))
    files.push_back(entry.path());
  return files;
}

/// Whether a dump is complete: a VTK file ends with its closing tag, a text dump has as many rows as each of
/// its headers says.
bool is_whole_dump(const fs::path &file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string tag = "</VTKFile>";
  if (text.rfind("<?xml", 0) == 0) return text.rfind(tag) != std::string::npos;
  std::istringstream lines(text);
  long left = 0;
  bool counts = false; // whether the next line is a number of rows
  for (std::string line; std::getline(lines, line);) {
    if (counts)
      left = std::strtol(line.c_str(), nullptr, 10);
    else if (line.rfind("ITEM: ATOMS", 0) != 0 && line.rfind("ITEM: ENTRIES", 0) != 0 && left > 0 &&
             line.rfind("ITEM:", 0) != 0)
      --left;
    counts = line.rfind("ITEM: NUMBER OF", 0) == 0;
  }
  return !text.empty() && text.back() == '\n' && left <= 0;
}

/// Replaces the last row of a run's parameters; not of a file that does not end with it.
void replace_end(const std::string &file, const std::string &before, const std::string &now) {
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (text.size() < before.size() || text.compare(text.size() - before.size(), before.size(), before) != 0)
    return;
  text.erase(text.size() - before.size());
  write_whole_file(file, text + now);
}

/// All sets of this process that are not destroyed, of all engine instances: when a command fails, the engine
/// calls exit() without destroying its fixes, and only a function of the process, registered by atexit(), can
/// then restore the files.
std::set<OutputSet *> &open_sets() {
  static std::set<OutputSet *> sets;
  return sets;
}

/// A cell of a CSV file.
std::string quoted(const std::string &text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text)
    result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

} // namespace

std::string record_row(const std::string &name, const std::string &value) {
  return quoted(name) + ',' + quoted(value) + '\n';
}

OutputSet::OutputSet() {
  open_sets().insert(this);
  static const int registered = std::atexit([] {
    for (OutputSet *set : open_sets())
      set->finish(ended_by_error);
  });
  static_cast<void>(registered);
}

OutputSet::~OutputSet() {
  finish(ended_yes);
  open_sets().erase(this);
  if (folder_lock_ >= 0) close(folder_lock_);
}

void OutputSet::make_folder(const std::string &folder) {
  std::vector<fs::path> missing;
  for (fs::path path = fs::path(folder); !path.empty() && !fs::exists(path); path = path.parent_path())
    missing.insert(missing.begin(), path);
  std::error_code code;
  fs::create_directories(folder, code);
  if (!fs::is_directory(folder, code))
    throw std::runtime_error(fmt::format("folder is '{}'; allowed: one that can be made", folder));
  made_.insert(made_.end(), missing.begin(), missing.end());
}

void OutputSet::lock_folder(const std::string &folder) {
  make_folder(folder);
  folder_lock_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder_lock_ < 0)
    throw std::runtime_error(fmt::format("folder is '{}'; allowed: one that can be made", folder));
  // Some network file systems cannot lock a folder. There a second run is not refused.
  if (flock(folder_lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw std::runtime_error(fmt::format("folder is '{}', into which another run writes; allowed: another "
                                         "folder, or to wait for the end of that run",
                                         folder));
}

void OutputSet::back_up(const fs::path &file) {
  std::error_code code;
  if (fs::symlink_status(file, code).type() == fs::file_type::not_found) {
    files_.emplace(file, false);
    return;
  }
  for (const std::string &input : inputs_)
    if (fs::equivalent(file, input, code))
      throw std::runtime_error(fmt::format(
          "file is '{}'; allowed: another file than '{}', which the run has read", file.string(), input));
  fs::rename(file, backup_of(file), code);
  if (code)
    throw std::runtime_error(fmt::format(
        "file is '{}', of which no backup can be made ({}); allowed: a folder that can be written",
        file.string(), code.message()));
  files_[file] = true;
}

void OutputSet::replace(const std::string &file) {
  recover(file);
  if (!is_output_file(file))
    throw std::runtime_error(
        fmt::format("file is '{}', which cannot be written; allowed: {}", file, output_name_allowed));
  back_up(file);
}

void OutputSet::truncate_table(const std::string &file, double time) {
  replace(file);
  if (!files_.at(file)) return;
  std::ifstream in(backup_of(file));
  std::string line;
  std::getline(in, line);
  std::istringstream names(line);
  std::string name;
  std::size_t column = 0;
  while (std::getline(names, name, ',') && name != "time")
    ++column;
  if (name != "time") return;
  std::string kept = line + '\n';
  while (std::getline(in, line) && !in.eof()) {
    std::istringstream cells(line);
    std::string cell;
    for (std::size_t n = 0; n <= column; ++n)
      std::getline(cells, cell, ',');
    if (std::strtod(cell.c_str(), nullptr) <= time) kept += line + '\n';
  }
  if (!write_whole_file(file, kept))
    throw std::runtime_error(
        fmt::format("file is '{}', which cannot be written; allowed: a file on a disk with room", file));
}

void OutputSet::replace_numbered(const std::vector<NumberedFiles> &patterns, long from) {
  numbered_ = patterns;
  std::set<std::string> folders;
  for (const NumberedFiles &pattern : patterns)
    folders.insert(pattern.folder);
  for (const std::string &folder : folders)
    for (const fs::path &file : files_in(folder))
      if (file.extension() == backup_suffix) recover(file.parent_path() / file.stem());
  for (const std::string &folder : folders)
    for (const fs::path &file : files_in(folder))
      before_.insert(file);
  std::vector<fs::path> earlier;
  for (const std::string &folder : folders)
    for (const fs::path &file : files_in(folder)) {
      const std::optional<long> number = number_in(folder, file);
      if (!number || !fs::is_regular_file(fs::symlink_status(file)))
        throw std::runtime_error(fmt::format("folder is '{}' with the file '{}', which is no dump of a run; "
                                             "allowed: a folder with nothing but dumps",
                                             folder, file.filename().string()));
      if (*number >= from)
        earlier.push_back(file);
      else
        checked_.insert(file);
    }
  for (const fs::path &file : earlier)
    back_up(file);
}

std::optional<long> OutputSet::number_in(const std::string &folder, const fs::path &file) const {
  for (const NumberedFiles &pattern : numbered_)
    if (pattern.folder == folder)
      if (const std::optional<long> number = number_of(file.filename().string(), pattern)) return number;
  return {};
}

void OutputSet::check_numbered() {
  for (const NumberedFiles &pattern : numbered_)
    for (const fs::path &file : files_in(pattern.folder)) {
      if (!number_of(file.filename().string(), pattern) || checked_.count(file) != 0) continue;
      if (!is_whole_dump(file))
        throw std::runtime_error(
            fmt::format("dump is '{}', which is incomplete; allowed: a disk with room", file.string()));
      checked_.insert(file);
    }
}

void OutputSet::commit() {
  committed_ = true;
  std::error_code code;
  for (const auto &[file, kept] : files_)
    if (kept) fs::remove(backup_of(file), code);
}

void OutputSet::note_end(const std::string &why) {
  const std::string before = record_row(ended_name, end_.empty() ? ended_not : end_);
  end_ = why;
  if (committed_ && !record_.empty()) replace_end(record_, before, record_row(ended_name, end_));
}

void OutputSet::finish(const std::string &otherwise) {
  if (!committed_) return roll_back();
  if (end_.empty()) note_end(otherwise);
  std::error_code code;
  if (end_ == ended_yes)
    for (const std::string &file : restarts_)
      if (is_output_file(file)) fs::remove(file, code);
}

void OutputSet::roll_back() {
  committed_ = true; // so that exit() does not roll back a second time
  record_.clear();
  restarts_.clear();
  std::error_code code;
  for (const NumberedFiles &pattern : numbered_)
    for (const fs::path &file : files_in(pattern.folder))
      if (number_of(file.filename().string(), pattern) && before_.count(file) == 0) fs::remove(file, code);
  for (const auto &[file, kept] : files_)
    if (kept)
      fs::rename(backup_of(file), file, code);
    else
      fs::remove(file, code);
  for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder)
    fs::remove(*folder, code); // removes empty folders only
}

} // namespace drumlin
