// A line on standard output now and then, for work of seconds to hours.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <cstdio>

namespace drumlin::post {

/// Tells of the progress at most every two seconds; the first line comes after two, so that short work says nothing.
class TimedProgress {
public:
  /// Whether it is time for a line; if so, the next is due two seconds from now.
  bool due() {
    const auto now = std::chrono::steady_clock::now();
    if (now - told_ < std::chrono::seconds(2)) return false;
    told_ = now;
    return true;
  }
  /// Prints the line, formatted as fmt::print does, if it is time for one.
  template <class... Values>
  void tell(fmt::format_string<Values...> format, Values &&...values) {
    if (!due()) return;
    fmt::print(format, std::forward<Values>(values)...);
    std::fputc('\n', stdout);
    std::fflush(stdout);
  }

private:
  std::chrono::steady_clock::time_point told_ = std::chrono::steady_clock::now();
};

} // namespace drumlin::post
