#include "engine/places.h"

#include "support/files.h"
#include "support/usage_error.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <pwd.h>
#include <stdexcept>
#include <string>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

Places read_places() {
  const char *given = std::getenv("DRUMLIN_PLACES");
  const fs::path file =
      given != nullptr ? fs::path(given) : fs::read_symlink("/proc/self/exe").parent_path() / "places";
  std::ifstream in(file);
  if (!in)
    throw std::runtime_error(
        fmt::format("'{}', which says where decks and plugin are, cannot be read; allowed: to build again",
                    file.string()));
  // By names only, so that a link without blanks above the folder stays in the result.
  const fs::path folder = file.parent_path();
  const auto path = [&folder](const std::string &text) {
    return text.empty() ? fs::path() : (folder / text).lexically_normal();
  };
  Places found;
  for (std::string line; std::getline(in, line);) {
    const std::size_t sign = line.find('=');
    if (sign == std::string::npos) continue;
    const std::string name = line.substr(0, sign);
    std::string value = line.substr(sign + 1);
    if (name == "inputs") found.inputs = path(value);
    if (name == "liggghts_plugin") found.liggghts_plugin = path(value);
    if (name == "lammps_plugin") found.lammps_plugin = path(value);
    if (name == "installed") found.installed = value == "yes";
    if (name == "liggghts")
      found.liggghts = std::move(value);
    else if (name == "lammps")
      found.lammps = std::move(value);
  }
  return found;
}

} // namespace

const Places &places() {
  static const Places found = read_places();
  return found;
}

fs::path inputs_here() {
  std::error_code code;
  return fs::equivalent(places().inputs, "inputs", code) ? fs::path("inputs") : places().inputs;
}

std::string front_command() { return places().installed ? "drumlin" : "./drumlin"; }

namespace {

/// The folder for what programs keep for a user between calls; empty if the user has none.
fs::path user_cache() {
  const auto value = [](const char *name) {
    const char *text = std::getenv(name);
    return fs::path(text == nullptr ? "" : text);
  };
  if (fs::path cache = value("XDG_CACHE_HOME"); !cache.empty()) return cache;
  fs::path home = value("HOME");
  if (home.empty())
    if (const passwd *user = ::getpwuid(::getuid()); user != nullptr) home = user->pw_dir;
  return home.empty() ? fs::path() : home / ".cache";
}

/// Makes a folder, and those above it that are missing, for this user alone. Errors are not reported: the
/// caller checks that the folder exists.
void make_private_folders(const fs::path &folder) {
  fs::path made;
  for (const fs::path &part : folder) {
    made /= part;
    ::mkdir(made.c_str(), S_IRWXU);
  }
}

/// Whether the folder is no link, belongs to the user and can be written: in /tmp another user may have made
/// it.
bool is_own_folder(const fs::path &folder) {
  struct stat found = {};
  return ::lstat(folder.c_str(), &found) == 0 && S_ISDIR(found.st_mode) && found.st_uid == ::geteuid() &&
         ::access(folder.c_str(), W_OK | X_OK) == 0;
}

/// Makes a symbolic link in one step, so that another process that makes the same one never finds it missing.
bool make_link(const fs::path &target, const fs::path &link) {
  std::error_code code;
  if (fs::read_symlink(link, code) == target) return true;
  const fs::path fresh = fmt::format("{}.{}", link.string(), ::getpid());
  fs::remove(fresh, code);
  fs::create_directory_symlink(target, fresh, code);
  if (!code) fs::rename(fresh, link, code);
  if (code) {
    std::error_code ignored;
    fs::remove(fresh, ignored);
  }
  return !code;
}

} // namespace

bool is_split(const fs::path &path) {
  return path.native().find_first_of(" \t\r\n\v\f:") != std::string::npos;
}

fs::path plain_folder(const fs::path &folder) {
  if (!is_split(folder)) return folder;
  const fs::path target = fs::absolute(folder).lexically_normal();
  const fs::path cache = user_cache();
  std::vector<fs::path> places;
  if (!cache.empty()) places.push_back(cache / "drumlin/links");
  places.emplace_back(fmt::format("/tmp/drumlin-{}", ::getuid()));
  for (const fs::path &place : places) {
    if (is_split(place)) continue;
    make_private_folders(place);
    if (!is_own_folder(place)) continue;
    fs::path link = place / fmt::format("{:016x}", std::hash<std::string>()(target.string()));
    if (make_link(target, link)) return link;
  }
  throw UsageError(fmt::format("'{}' has blanks or colons, at which engines split it, and no link to it can "
                               "be made in {} or /tmp; allowed: a path without",
                               folder.string(), places.front().string()));
}

fs::path plain_file(const fs::path &file) { return plain_folder(file.parent_path()) / file.filename(); }

} // namespace drumlin::post
