#include "leftovers.h"

#include <cerrno>
#include <charconv>
#include <csignal>
#include <system_error>
#include <vector>

#include <unistd.h>

#include <fmt/format.h>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// Whether a name is the prefix and the number of a process that is no more.
bool is_leftover(const std::string &name, const std::string &prefix) {
  if (name.size() <= prefix.size() || name.compare(0, prefix.size(), prefix) != 0) return false;
  pid_t process = 0;
  const char *end = name.data() + name.size();
  const auto [stop, code] = std::from_chars(name.data() + prefix.size(), end, process);
  return code == std::errc() && stop == end && process > 0 && ::kill(process, 0) != 0 && errno == ESRCH;
}

std::vector<fs::path> leftovers(const fs::path &parent, const std::string &prefix) {
  std::vector<fs::path> found;
  std::error_code ignored;
  for (fs::directory_iterator entry(parent, ignored), end; entry != end; entry.increment(ignored))
    if (entry->symlink_status(ignored).type() == fs::file_type::directory &&
        is_leftover(entry->path().filename().string(), prefix))
      found.push_back(entry->path());
  return found;
}

} // namespace

std::string own_name(const std::string &prefix) { return fmt::format("{}{}", prefix, ::getpid()); }

void remove_leftovers(const fs::path &parent, const std::string &prefix) {
  std::error_code ignored;
  for (const fs::path &folder : leftovers(parent, prefix))
    fs::remove_all(folder, ignored);
}

fs::path leftover(const fs::path &parent, const std::string &prefix) {
  const std::vector<fs::path> found = leftovers(parent, prefix);
  return found.empty() ? fs::path() : found.front();
}

} // namespace drumlin::post
