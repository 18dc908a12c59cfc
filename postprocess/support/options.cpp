#include "support/options.h"

#include "support/csv.h"
#include "support/files.h"
#include "support/usage_error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sys/stat.h>

#include <algorithm>
#include <charconv>
#include <climits>
#include <limits>
#include <map>
#include <stdexcept>
#include <system_error>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const char *option, const std::string &text, const std::string &allowed) {
  throw UsageError(refusal(option, text, allowed));
}

/// What all paths to one file or folder have in common: device and inode, or of one that is not made yet its
/// name behind all links.
std::string identity(const fs::path &path) {
  struct stat found = {};
  if (::stat(path.c_str(), &found) == 0) return fmt::format("{}:{}", found.st_dev, found.st_ino);
  std::error_code code;
  return fs::weakly_canonical(fs::absolute(path), code).string();
}

/// Whether a path is below a folder, by its name as given or behind all links.
bool is_below(const fs::path &path, const fs::path &folder) {
  const auto starts = [](const fs::path &long_path, const fs::path &beginning) {
    auto part = long_path.begin();
    for (const fs::path &of_beginning : beginning) {
      if (of_beginning.empty()) continue; // behind a slash at the end
      if (part == long_path.end() || *part++ != of_beginning) return false;
    }
    return true;
  };
  std::error_code code;
  const fs::path real = fs::weakly_canonical(fs::absolute(path), code);
  const fs::path real_folder = fs::weakly_canonical(fs::absolute(folder), code);
  return (!code && starts(real, real_folder)) ||
         starts(fs::absolute(path).lexically_normal(), fs::absolute(folder).lexically_normal());
}

/// Refuses a folder in which two regular files are one: what is written to one would change the other.
void refuse_twins(const GivenPath &output) {
  std::map<std::string, std::string> names;
  std::error_code code;
  for (fs::directory_iterator entry(output.path, code), end; entry != end; entry.increment(code)) {
    if (!entry->is_regular_file(code)) continue;
    const std::string name = entry->path().filename().string();
    const auto [other, is_new] = names.emplace(identity(entry->path()), name);
    if (!is_new)
      refuse(output.option.c_str(), output.path.string(),
             fmt::format("a folder in which '{}' and '{}' are not one file", std::min(name, other->second),
                         std::max(name, other->second)));
  }
}

} // namespace

void keep_apart(const std::vector<GivenPath> &inputs, const std::vector<GivenPath> &outputs) {
  const auto refuse_pair = [](const GivenPath &output, const GivenPath &other, const char *use) {
    refuse(output.option.c_str(), output.path.string(),
           fmt::format("another {} than {} '{}', which is {}", output.folder ? "folder" : "file",
                       other.option, shown(other.path.string()), use));
  };
  std::map<std::string, const GivenPath *> read, written;
  for (const GivenPath &input : inputs)
    read.emplace(identity(input.path), &input);
  for (const GivenPath &output : outputs) {
    const std::string id = identity(output.path);
    if (const auto found = read.find(id); found != read.end()) refuse_pair(output, *found->second, "read");
    if (const auto [found, is_new] = written.emplace(id, &output); !is_new)
      refuse_pair(output, *found->second, "written, too");
    if (!output.folder) continue;
    for (const GivenPath &input : inputs)
      if (is_below(input.path, output.path)) refuse_pair(output, input, "read");
    for (const GivenPath &other : outputs)
      if (&other != &output && is_below(other.path, output.path)) refuse_pair(other, output, "written, too");
    refuse_twins(output);
  }
}

std::vector<GivenPath> files_in(const char *option, const fs::path &folder,
                                const std::vector<std::string> &names) {
  std::vector<GivenPath> files;
  files.reserve(names.size());
  for (const std::string &name : names)
    files.push_back({option, folder / name});
  return files;
}

double number_option(const char *option, const std::string &text, const Range &range) {
  try {
    const double value = number_from_text(text);
    if (range.holds(value)) return value;
  } catch (const std::invalid_argument &) { // refused below, as any other
  }
  refuse(option, text, range.words());
}

int count_option(const char *option, const std::string &text, int least, int most) {
  try {
    const double value = number_from_text(text);
    if (value >= least && value <= most && value == static_cast<double>(static_cast<int>(value)))
      return static_cast<int>(value);
  } catch (const std::invalid_argument &) { // refused below, as any other
  }
  refuse(option, text, fmt::format("a whole number from {} to {}", least, most));
}

std::uint64_t seed_option(const char *option, const std::string &text) {
  std::uint64_t seed = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (fault != std::errc() || end != text.data() + text.size())
    refuse(option, text,
           fmt::format("a whole number from 0 to {}", std::numeric_limits<std::uint64_t>::max()));
  return seed;
}

const std::string &choice_option(const char *option, const std::string &text,
                                 std::initializer_list<const char *> words) {
  if (std::find(words.begin(), words.end(), text) == words.end())
    refuse(option, text, fmt::format("{}", fmt::join(words, ", ")));
  return text;
}

fs::path path_option(const char *option, const std::string &text) {
  fs::path path = text;
  // The name of its temporary file is some characters longer.
  constexpr std::size_t longest_part = NAME_MAX - 25;
  constexpr std::size_t longest = PATH_MAX - 200;
  if (text.empty()) refuse(option, text, "the name of a file or folder");
  if (fs::absolute(path).native().size() > longest ||
      std::any_of(path.begin(), path.end(),
                  [](const fs::path &part) { return part.native().size() > longest_part; }))
    refuse(option, text,
           fmt::format("a path of at most {} characters, none of its parts longer than {}", longest,
                       longest_part));
  return path;
}

namespace {

fs::path output_option(const char *option, const std::string &text, void (*check)(const fs::path &)) {
  fs::path path = path_option(option, text);
  try {
    check(path);
  } catch (const std::runtime_error &fault) {
    throw UsageError(fmt::format("{} is '{}': {}", option, shown(text), fault.what()));
  }
  return path;
}

} // namespace

fs::path output_folder_option(const char *option, const std::string &text) {
  return output_option(option, text, check_output_folder);
}

fs::path output_file_option(const char *option, const std::string &text) {
  return output_option(option, text, check_output_file);
}

} // namespace drumlin::post
