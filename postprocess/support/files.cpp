#include "support/files.h"

#include "support/process.h"
#include "support/usage_error.h"

#include <iterator>
#include <fstream>
#include <fmt/format.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <cstddef>
#include <set>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr const char *allowed_folders = "a folder that can be made and written to";
constexpr const char *allowed_files = "a file that can be written";

[[noreturn]] void fail(const fs::path &file, const std::string &why) {
  throw std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(), why));
}

/// Where a path leads, with all symbolic links followed; std::filesystem::filesystem_error where they go in a
/// circle.
fs::path real_path(const fs::path &path) { return fs::weakly_canonical(fs::absolute(path)); }

bool below_a_system_folder(const fs::path &real) {
  constexpr std::array<const char *, 3> system_folders = {"/dev", "/proc", "/sys"};
  return std::any_of(system_folders.begin(), system_folders.end(), [&real](const char *name) {
    const fs::path folder = name;
    return std::mismatch(folder.begin(), folder.end(), real.begin(), real.end()).first == folder.end();
  });
}

bool leads_nowhere(const fs::path &path) { return fs::is_symlink(path) && !fs::exists(path); }

/// Why nothing can be put into a folder; empty if it can.
std::string fault_of_folder(const fs::path &folder) {
  if (leads_nowhere(folder)) return "is a symbolic link to nothing";
  const fs::path real = real_path(folder);
  if (below_a_system_folder(real)) return fmt::format("{} belongs to the system", real.string());
  fs::path existing = real;
  while (!fs::exists(existing) && existing.has_relative_path())
    existing = existing.parent_path();
  if (!fs::is_directory(existing)) return fmt::format("{} is not a folder", existing.string());
  if (::access(existing.c_str(), W_OK | X_OK) != 0)
    return fmt::format("{} cannot be written to", existing.string());
  return {};
}

/// Why a file cannot be written; empty if it can.
std::string fault_of_file(const fs::path &file) {
  if (file.filename().empty()) return "is the name of a folder";
  if (leads_nowhere(file)) return "is a symbolic link to nothing";
  const fs::path real = real_path(file);
  if (std::string fault = fault_of_folder(real.parent_path()); !fault.empty()) return fault;
  struct stat found = {};
  if (::lstat(real.c_str(), &found) != 0) return errno == ENOENT ? "" : std::strerror(errno);
  if (S_ISDIR(found.st_mode)) return "is a folder";
  if (!S_ISREG(found.st_mode)) return "is a device, a pipe or a socket, no regular file";
  // The super-user may write whatever the mode says; a file that nobody may write is meant to stay.
  constexpr mode_t anybody = S_IWUSR | S_IWGRP | S_IWOTH;
  if ((found.st_mode & anybody) == 0 || ::access(real.c_str(), W_OK) != 0) return "is read-only";
  return {};
}

template <class Fault>
void check(const fs::path &path, const char *allowed, Fault fault_of) {
  std::string fault;
  try {
    fault = fault_of(path);
  } catch (const fs::filesystem_error &error) {
    fault = "cannot be used: " + error.code().message();
  }
  if (!fault.empty()) throw std::runtime_error(fmt::format("{}; allowed: {}", fault, allowed));
}

void make_folders(const fs::path &real) {
  std::error_code code;
  fs::create_directories(real, code);
  if (code)
    throw std::runtime_error(fmt::format("cannot be made: {}; allowed: {}", code.message(), allowed_folders));
}

/// A temporary file, removed with this object unless it was renamed to its final name.
class Temporary {
public:
  explicit Temporary(const fs::path &file) : place_(real_path(file)) {
    constexpr int most_tries = 100; // a killed call of the same process number may have left some
    for (int i = 0; i < most_tries && file_ < 0; ++i) {
      name_ = fmt::format("{}.tmp.{}.{}", place_.string(), ::getpid(), i);
      file_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (file_ < 0 && errno != EEXIST) break;
    }
    if (file_ < 0) throw std::system_error(errno, std::generic_category());
    struct stat earlier = {};
    if (::stat(place_.c_str(), &earlier) == 0) {
      constexpr mode_t permissions = 07777;
      ::fchmod(file_, earlier.st_mode & permissions);
    }
  }
  ~Temporary() {
    if (file_ >= 0) ::close(file_);
    if (!name_.empty()) ::unlink(name_.c_str());
  }
  Temporary(const Temporary &) = delete;
  Temporary &operator=(const Temporary &) = delete;
  Temporary(Temporary &&other) noexcept
      : place_(std::move(other.place_)), name_(std::exchange(other.name_, {})),
        file_(std::exchange(other.file_, -1)) {}
  Temporary &operator=(Temporary &&) = delete;

  /// Writes the text and closes the file: some file systems report a full disk only then.
  void write_and_close(std::string_view text) {
    write_all(file_, text);
    if (::close(std::exchange(file_, -1)) != 0) throw std::system_error(errno, std::generic_category());
  }
  void give_name() {
    fs::rename(name_, place_);
    name_.clear();
  }

  static void write_all(int file, std::string_view text) {
    while (!text.empty()) {
      const ssize_t written = ::write(file, text.data(), text.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) throw std::system_error(errno, std::generic_category());
      text.remove_prefix(static_cast<std::size_t>(written));
    }
  }

private:
  fs::path place_;
  std::string name_;
  int file_ = -1;
};

/// The folders in `parent` whose names are the prefix and a number.
std::vector<fs::path> numbered(const fs::path &parent, const std::string &prefix) {
  std::vector<fs::path> found;
  std::error_code ignored;
  for (fs::directory_iterator entry(parent, ignored), end; entry != end; entry.increment(ignored)) {
    const std::string name = entry->path().filename().string();
    if (name.size() > prefix.size() && name.compare(0, prefix.size(), prefix) == 0 &&
        name.find_first_not_of("0123456789.", prefix.size()) == std::string::npos &&
        entry->symlink_status(ignored).type() == fs::file_type::directory)
      found.push_back(entry->path());
  }
  return found;
}

[[noreturn]] void refuse_second_call(const fs::path &out, const char *option = "--out") {
  throw UsageError(fmt::format("{} is '{}', into which another call writes; allowed: another folder, or to "
                               "wait for the end of that call",
                               option, out.string()));
}

void must_be_writable(const fs::path &file) {
  if (const std::string fault = fault_of_file(file); !fault.empty()) fail(file, fault);
}

} // namespace

void check_output_folder(const fs::path &folder) {
  check(folder, allowed_folders, [](const fs::path &path) {
    return real_path(path) == real_path("/") ? std::string("is the root folder") : fault_of_folder(path);
  });
}

void check_output_file(const fs::path &file) { check(file, allowed_files, fault_of_file); }

void make_output_folder(const fs::path &folder) {
  check_output_folder(folder);
  make_folders(real_path(folder));
}

void make_parent_folder(const fs::path &file) {
  check_output_file(file);
  make_folders(real_path(file).parent_path());
}

void write_files(const std::vector<FileText> &files) {
  end_if_told();
  const fs::path *current = nullptr;
  try {
    std::vector<Temporary> temporaries;
    temporaries.reserve(files.size());
    for (const auto &[file, text] : files) {
      current = &file;
      must_be_writable(file);
      temporaries.emplace_back(file);
      temporaries.back().write_and_close(text);
    }
    for (std::size_t i = 0; i < files.size(); ++i) {
      current = &files[i].first;
      temporaries[i].give_name();
    }
  } catch (const std::system_error &error) {
    fail(*current, error.code().message());
  }
}

void replace_file(const fs::path &finished, const fs::path &file) {
  try {
    must_be_writable(file);
    fs::rename(finished, real_path(file));
  } catch (const std::system_error &error) {
    fail(file, error.code().message());
  }
}

void append_text(const fs::path &file, const std::string &text) {
  try {
    must_be_writable(file);
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (descriptor < 0) throw std::system_error(errno, std::generic_category());
    const off_t before = ::lseek(descriptor, 0, SEEK_END);
    try {
      Temporary::write_all(descriptor, text);
    } catch (const std::system_error &) {
      if (before >= 0) static_cast<void>(::ftruncate(descriptor, before) == 0);
      ::close(descriptor);
      throw;
    }
    if (::close(descriptor) != 0) throw std::system_error(errno, std::generic_category());
  } catch (const std::system_error &error) {
    fail(file, error.code().message());
  }
}

FolderLock::FolderLock(const fs::path &folder)
    : file_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  removed_ = file_ < 0 && errno == ENOENT;
  if (file_ < 0) return;
  struct stat held = {}, now = {};
  if (::flock(file_, LOCK_EX | LOCK_NB) != 0)
    of_another_ = errno == EWOULDBLOCK;
  else if (::fstat(file_, &held) == 0 && ::stat(folder.c_str(), &now) == 0 && held.st_ino == now.st_ino)
    return;
  else
    removed_ = true;
  ::close(std::exchange(file_, -1));
}

FolderLock::~FolderLock() {
  if (file_ >= 0) ::close(file_);
}

FolderLock::FolderLock(FolderLock &&other) noexcept
    : file_(std::exchange(other.file_, -1)), of_another_(other.of_another_), removed_(other.removed_) {}

FolderLock &FolderLock::operator=(FolderLock &&other) noexcept {
  std::swap(file_, other.file_);
  std::swap(of_another_, other.of_another_);
  std::swap(removed_, other.removed_);
  return *this;
}

FolderLock lock_output_folder(const fs::path &folder, const char *option) {
  FolderLock lock(folder);
  if (lock.of_another()) refuse_second_call(folder, option);
  return lock;
}

TemporaryFolder::TemporaryFolder(const fs::path &parent, const std::string &prefix) : prefix_(prefix) {
  std::error_code ignored;
  for (const fs::path &earlier : numbered(parent, prefix))
    if (const FolderLock lock(earlier); lock.held()) fs::remove_all(earlier, ignored);
  // Between making and locking it, a process or thread that starts now may take it for the folder of a killed
  // one and remove it, and then make one of the same name.
  for (int number = 0; path_.empty(); ++number) {
    path_ = parent / fmt::format("{}{}.{}", prefix, ::getpid(), number);
    std::error_code error;
    const bool made = fs::create_directory(path_, error);
    if (error && error != std::errc::file_exists)
      throw fs::filesystem_error("cannot create directory", path_, error);
    if (made) lock_ = FolderLock(path_);
    if (!made || lock_.of_another() || lock_.removed()) path_.clear();
  }
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

bool TemporaryFolder::has_others() const {
  const std::vector<fs::path> all = numbered(path_.parent_path(), prefix_);
  return std::any_of(all.begin(), all.end(), [this](const fs::path &folder) {
    return folder != path_ && FolderLock(folder).of_another();
  });
}

namespace {

/// Prefix of the names of folders next to `place` that hold its new content, or its earlier content during
/// the exchange.
std::string prefix_beside(const fs::path &place, const char *which) {
  return fmt::format(".{}.{}-", place.filename().string(), which);
}

} // namespace

FolderInProgress::FolderInProgress(const fs::path &place)
    : place_(place), folder_(place.parent_path(), prefix_beside(place, "new")) {
  if (folder_.has_others()) refuse_second_call(place);
  // A process that was killed between the two renames of publish() has left the earlier folder without its
  // name.
  for (const fs::path &earlier : numbered(place.parent_path(), prefix_beside(place, "old"))) {
    std::error_code ignored;
    if (fs::exists(place))
      fs::remove_all(earlier, ignored);
    else
      fs::rename(earlier, place);
  }
}

void FolderInProgress::publish() {
  const fs::path old = place_.parent_path() / fmt::format("{}{}", prefix_beside(place_, "old"), ::getpid());
  const bool replaces = fs::exists(place_);
  if (replaces) fs::rename(place_, old);
  std::error_code error;
  fs::rename(path(), place_, error);
  if (error) {
    if (replaces) fs::rename(old, place_);
    fail(place_, error.message());
  }
  std::error_code ignored;
  fs::remove_all(old, ignored);
}

FilesInProgress::FilesInProgress(const fs::path &folder)
    : folder_(folder), made_(fs::create_directories(folder)),
      temporary_(std::in_place, folder, "unfinished.") {
  if (temporary_->has_others()) refuse_second_call(folder);
}

FilesInProgress::~FilesInProgress() {
  temporary_.reset();
  std::error_code ignored;
  if (made_) fs::remove(folder_, ignored); // fails unless it is empty
}

void FilesInProgress::publish(const std::vector<std::string> &names,
                              const std::function<bool(const std::string &)> &is_ours) {
  for (const std::string &name : names)
    check_output_file(folder_ / name); // all of them, before the first is replaced
  for (const std::string &name : names)
    replace_file(*this / name, folder_ / name);
  const std::set<std::string> fresh(names.begin(), names.end());
  for (const fs::directory_entry &entry : fs::directory_iterator(folder_)) {
    const std::string name = entry.path().filename().string();
    if (is_ours(name) && fresh.count(name) == 0 && fs::is_regular_file(entry.symlink_status()))
      fs::remove(entry.path());
  }
}

std::string read_text(const fs::path &file) {
  const auto fault = [&file](std::string_view why) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), why));
  };
  std::error_code ignored; // of a file that is not there
  if (fs::is_directory(file, ignored)) fault("cannot be read: it is a folder");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fault(fmt::format("cannot be read: {}", std::strerror(errno)));
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (stream.bad()) fault("reading stopped before the end of the file");
  return text;
}

} // namespace drumlin::post
