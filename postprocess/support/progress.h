// Progress of work that takes seconds to hours, as lines on standard output.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>

namespace drumlin::post {

/// Takes one line without its line end.
using ProgressSink = std::function<void(const std::string &)>;

/// Prints the line, at once even into a file.
void print_progress(const std::string &line);

/// Prints a line at most every two seconds; the first one after two, so that short work prints nothing.
class TimedProgress {
public:
  /// Prints the line, formatted as fmt::print does, if it is time for one.
  template <class... Values>
  void tell(fmt::format_string<Values...> format, Values &&...values) {
    if (due()) print_progress(fmt::format(format, std::forward<Values>(values)...));
  }

private:
  /// Whether it is time for a line; if so, the next is due two seconds from now.
  bool due();
  std::chrono::steady_clock::time_point told_ = std::chrono::steady_clock::now();
};

/// One line for each piece of work, whose number is known: how many of how many, and what.
class CountedProgress {
public:
  /// \param kind what is counted, before the numbers; may be empty
  explicit CountedProgress(std::size_t total, std::string kind = {}, ProgressSink sink = print_progress)
      : total_(total), kind_(std::move(kind)), sink_(std::move(sink)) {}
  /// A piece that begins.
  void begins(const std::string &what);
  /// A piece that an earlier call has finished; no line.
  void found() { ++found_; }
  /// A piece that is finished, with the time left if the others take as long.
  void measured(const std::string &what);

private:
  void tell(const std::string &what) const;

  std::size_t total_;
  std::string kind_;
  ProgressSink sink_;
  std::size_t found_ = 0;
  std::size_t done_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

} // namespace drumlin::post
