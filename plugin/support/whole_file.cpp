#include "support/whole_file.h"

#include <algorithm>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace drumlin {

namespace fs = std::filesystem;

namespace {

fs::path folder_of(const std::string &name) {
  const fs::path folder = fs::path(name).parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

bool write_all(int file, const std::string &contents) {
  const char *next = contents.data();
  for (std::size_t left = contents.size(); left > 0;) {
    const ssize_t written = write(file, next, left);
    if (written <= 0) return false;
    next += written;
    left -= static_cast<std::size_t>(written);
  }
  return true;
}

} // namespace

bool is_output_folder(const std::string &folder) {
  std::error_code code;
  const fs::path absolute = fs::absolute(folder.empty() ? "." : folder, code);
  const fs::path real = fs::weakly_canonical(absolute, code);
  if (code || real == real.root_path()) return false;
  const std::string first = (++real.begin())->string();
  return first != "dev" && first != "proc" && first != "sys";
}

bool is_output_file(const std::string &name) {
  std::error_code code;
  const fs::path folder = folder_of(name);
  if (name.empty() || !is_output_folder(folder.string())) return false;
  const fs::file_status status = fs::symlink_status(name, code);
  if (status.type() == fs::file_type::not_found)
    return fs::is_directory(folder, code) && access(folder.c_str(), W_OK | X_OK) == 0;
  // access() is true for root whatever the permissions are: a file that nobody has permission to write is not
  // replaced by root either.
  const auto writers = fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  return status.type() == fs::file_type::regular && (status.permissions() & writers) != fs::perms::none &&
         access(name.c_str(), W_OK) == 0;
}

bool write_whole_file(const std::string &name, const std::string &contents) {
  const std::string unfinished = name + ".unfinished";
  const int file = open(unfinished.c_str(), O_WRONLY | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
  if (file < 0) return false;
  struct stat status {};
  bool good = fstat(file, &status) == 0 && S_ISREG(status.st_mode) && flock(file, LOCK_EX | LOCK_NB) == 0;
  const bool ours = good;
  good = good && ftruncate(file, 0) == 0 && write_all(file, contents) && fsync(file) == 0;
  if (good) good = std::rename(unfinished.c_str(), name.c_str()) == 0;
  if (!good && ours) unlink(unfinished.c_str());
  return close(file) == 0 && good;
}

} // namespace drumlin
