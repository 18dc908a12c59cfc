#pragma once
// Arguments of an engine command: every one checked, and a wrong one named with what is allowed, in one line.

#include "engine.h"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

namespace drumlin {

/// Range of a number.
enum class Range { any, positive, non_negative };

/// The number that a whole word means, or NaN if it is none (nan and inf are none: no quantity here may be
/// either).
inline double parse_number(const std::string &word) {
  char *end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  const bool whole =
      !word.empty() && end == word.c_str() + word.size() && word.find_first_of("xXnN") == std::string::npos;
  return whole && std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
}

inline bool in_range(double value, Range range) {
  return std::isfinite(value) && (range != Range::positive || value > 0.0) &&
         (range != Range::non_negative || value >= 0.0);
}

inline const char *allowed_text(Range range) {
  if (range == Range::positive) return "a finite number > 0";
  return range == Range::non_negative ? "a finite number >= 0" : "a finite number";
}

/// "I, II or III" of {"I", "II", "III"}.
/// The words in one text. (fmt::join() has moved to a header that not every engine's copy of fmt has.)
inline std::string joined(const std::vector<std::string> &words, const std::string &separator) {
  std::string text;
  for (std::size_t n = 0; n < words.size(); ++n)
    text.append(n == 0 ? "" : separator).append(words[n]);
  return text;
}

inline std::string join_choices(const std::vector<std::string> &choices) {
  std::string text;
  for (std::size_t n = 0; n < choices.size(); ++n)
    text += (n == 0 ? "" : n + 1 == choices.size() ? " or " : ", ") + choices[n];
  return text;
}

/// Reader of a command's words, from left to right. Ends the run through the engine's error->all() on the
/// first mistake.
class Arguments {
public:
  /// \param command words for the error text, e.g. "fix drum/excite"
  Arguments(LAMMPS_NS::Error *error, std::string command, int narg, char **arg)
      : error_(error), command_(std::move(command)), words_(arg, arg + narg) {}

  bool empty() const { return next_ >= words_.size(); }
  std::size_t left() const { return words_.size() - next_; }
  const std::string &peek() const { return words_[next_]; }

  /// Next word; `what` names it in the error if there is none, `allowed` says what may stand there.
  const std::string &word(const std::string &what, const std::string &allowed = "a word") {
    if (empty()) fail(what + " is missing; allowed: " + allowed);
    return words_[next_++];
  }

  double number(const std::string &what, Range range = Range::any) {
    const std::string text = required(what, allowed_text(range));
    const double value = parse_number(text);
    if (!in_range(value, range)) fail(what + " is '" + text + "'; allowed: " + allowed_text(range));
    return value;
  }

  engine::bigint integer(const std::string &what, engine::bigint lowest,
                         engine::bigint highest = std::numeric_limits<int>::max()) {
    const std::string allowed =
        "a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest);
    const std::string text = required(what, allowed);
    char *end = nullptr;
    const long long value = std::strtoll(text.c_str(), &end, 10);
    if (text.empty() || *end != '\0' || value < lowest || value > highest)
      fail(what + " is '" + text + "'; allowed: " + allowed);
    return static_cast<engine::bigint>(value);
  }

  /// One of some words; its index.
  int choice(const std::string &what, const std::vector<std::string> &choices) {
    const std::string text = required(what, join_choices(choices));
    for (std::size_t n = 0; n < choices.size(); ++n)
      if (text == choices[n]) return static_cast<int>(n);
    fail(what + " is '" + text + "'; allowed: " + join_choices(choices));
  }

  [[noreturn]] void fail(const std::string &why) const {
    error_->all(FLERR, engine::as_is(command_ + ": " + why));
    std::abort(); // not reached: error->all() ends the process
  }

private:
  const std::string &required(const std::string &what, const std::string &allowed) {
    if (empty()) fail(what + " has no value; allowed: " + allowed);
    return words_[next_++];
  }

  LAMMPS_NS::Error *error_;
  std::string command_;
  std::vector<std::string> words_;
  std::size_t next_ = 0;
};

} // namespace drumlin
