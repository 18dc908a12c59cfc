#include "support/options.h"

#include "support/csv.h"
#include "support/files.h"
#include "support/usage_error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <climits>
#include <limits>
#include <stdexcept>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const char *option, const std::string &text, const std::string &allowed) {
  throw UsageError(refusal(option, text, allowed));
}

} // namespace

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

fs::path output_folder_option(const char *option, const std::string &text) {
  fs::path path = path_option(option, text);
  try {
    check_output_folder(path);
  } catch (const std::runtime_error &fault) {
    throw UsageError(fmt::format("{} is '{}': {}", option, shown(text), fault.what()));
  }
  return path;
}

fs::path output_file_option(const char *option, const std::string &text) {
  fs::path path = path_option(option, text);
  try {
    check_output_file(path);
  } catch (const std::runtime_error &fault) {
    throw UsageError(fmt::format("{} is '{}': {}", option, shown(text), fault.what()));
  }
  return path;
}

} // namespace drumlin::post
