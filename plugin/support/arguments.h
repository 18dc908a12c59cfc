#pragma once
// Reads the arguments of a style or command from left to right. A wrong argument ends the run with one line
// that names command, keyword and value, and says what is allowed.

#include "engine.h"
#include "physics/parameter_checks.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

namespace drumlin {

using physics::Range;

/// The value of a word that is, as a whole, a finite decimal number. NaN for every other word, also for
/// hexadecimal numbers, nan and inf, which are not allowed as arguments.
inline double parse_number(const std::string &word) {
  char *end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  const bool whole =
      !word.empty() && end == word.c_str() + word.size() && word.find_first_of("xXnN") == std::string::npos;
  return whole && std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
}

/// Whether a number is finite and in the range.
inline bool in_range(double value, const Range &range) { return range.contains(value); }

/// The range in words, for an error.
inline std::string allowed_text(const Range &range) { return physics::detail::text_of(range); }

/// The words as one text, separated by `separator`. (fmt::join() is in a header that the fmt of some LAMMPS
/// releases does not have.)
inline std::string joined(const std::vector<std::string> &words, const std::string &separator) {
  std::string text;
  for (std::size_t n = 0; n < words.size(); ++n)
    text.append(n == 0 ? "" : separator).append(words[n]);
  return text;
}

/// The parts of a list whose entries are separated by commas; one empty part of an empty list.
inline std::vector<std::string> list_entries(const std::string &list) {
  std::vector<std::string> entries;
  for (std::size_t from = 0;;) {
    const std::size_t comma = list.find(',', from);
    entries.push_back(list.substr(from, comma == std::string::npos ? comma : comma - from));
    if (comma == std::string::npos) return entries;
    from = comma + 1;
  }
}

/// "I, II or III" of {"I", "II", "III"}.
inline std::string join_choices(const std::vector<std::string> &choices) {
  std::string text;
  for (std::size_t n = 0; n < choices.size(); ++n)
    text += (n == 0 ? "" : n + 1 == choices.size() ? " or " : ", ") + choices[n];
  return text;
}

/// Reader of the arguments of a style or command. Each function that reads an argument ends the run through
/// the engine's error->all() if the argument is not allowed, with "ERROR: COMMAND: WHAT is 'VALUE'; allowed:
/// ...", or missing, with "ERROR: COMMAND: WHAT is missing; allowed: ...". `what` is the argument's name in
/// the error.
class Arguments {
public:
  /// \param command name for the error text, e.g. "fix drum/excite"
  Arguments(LAMMPS_NS::Error *error, std::string command, int narg, char **arg)
      : error_(error), command_(std::move(command)), words_(arg, arg + narg) {}

  bool empty() const { return next_ >= words_.size(); }
  /// The next argument, without moving on to the one after it. Not to be called if empty().
  const std::string &peek() const { return words_[next_]; }

  /// The next argument as a word. \param what its name in the error \param allowed what it may be
  const std::string &word(const std::string &what, const std::string &allowed = "a word") {
    if (empty()) fail(what + " is missing; allowed: " + allowed);
    return words_[next_++];
  }

  /// The next argument as a number.
  double number(const std::string &what, const Range &range = Range::any) {
    const std::string text = word(what, allowed_text(range));
    const double value = parse_number(text);
    if (!in_range(value, range)) fail(what, text, allowed_text(range));
    return value;
  }

  /// The next argument as a whole number from `lowest` to `highest`.
  engine::bigint integer(const std::string &what, engine::bigint lowest,
                         engine::bigint highest = std::numeric_limits<int>::max()) {
    const std::string allowed =
        "a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest);
    const std::string text = word(what, allowed);
    char *end = nullptr;
    const long long value = std::strtoll(text.c_str(), &end, 10);
    if (text.empty() || *end != '\0' || value < lowest || value > highest) fail(what, text, allowed);
    return static_cast<engine::bigint>(value);
  }

  /// Reads the next argument, which must be one of `choices`, and returns its index among them.
  int choice(const std::string &what, const std::vector<std::string> &choices) {
    const std::string text = word(what, join_choices(choices));
    for (std::size_t n = 0; n < choices.size(); ++n)
      if (text == choices[n]) return static_cast<int>(n);
    fail(what, text, join_choices(choices));
  }

  /// The next three arguments as a vector other than 0 0 0, scaled to length 1.
  std::array<double, 3> direction(const std::string &what) {
    std::array<double, 3> v{};
    for (std::size_t a = 0; a < 3; ++a)
      v[a] = number(what + ", " + "xyz"[a]);
    const double length = std::hypot(v[0], v[1], v[2]);
    if (length == 0.0) fail(what, "0 0 0", "a vector with a length");
    for (double &component : v)
      component /= length;
    return v;
  }

  /// Reads the next argument, which must be the name of a group that exists, and returns the group's index.
  int group(const std::string &what, LAMMPS_NS::Group *groups) {
    const std::string name = word(what, "the name of a group");
    const int index =
        groups->find(name.c_str()); // NOLINT(readability-redundant-string-cstr): LIGGGHTS takes a char *
    if (index < 0) fail(what, name, "the name of a group");
    return index;
  }

  /// Ends the run if there are more arguments. \param allowed the arguments that are allowed, for the error
  void expect_end(const std::string &allowed) const {
    if (!empty()) fail("argument is '" + peek() + "', one too many; allowed: " + allowed);
  }

  /// Ends the run with "COMMAND: WHAT is 'VALUE'; allowed: ALLOWED".
  [[noreturn]] void fail(const std::string &what, const std::string &value,
                         const std::string &allowed) const {
    fail(what + " is '" + value + "'; allowed: " + allowed);
  }

  /// Ends the run with "COMMAND: FAULT".
  [[noreturn]] void fail(const std::string &fault) const {
    error_->all(FLERR, engine::error_text(command_ + ": " + fault));
    std::abort(); // not reached: error->all() ends the process
  }

private:
  LAMMPS_NS::Error *error_;
  std::string command_;
  std::vector<std::string> words_;
  std::size_t next_ = 0;
};

} // namespace drumlin
