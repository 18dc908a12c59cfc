#include "support/progress.h"

#include "support/process.h"

#include <algorithm>
#include <cstdio>

namespace drumlin::post {

using std::chrono::steady_clock;

void print_progress(const std::string &line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

bool TimedProgress::due() {
  end_if_told();
  const auto now = steady_clock::now();
  if (now - told_ < std::chrono::seconds(2)) return false;
  told_ = now;
  return true;
}

void CountedProgress::tell(const std::string &what) const {
  if (sink_)
    sink_(fmt::format("{}{}[{:{}}/{}] {}", kind_, kind_.empty() ? "" : " ", found_ + done_,
                      fmt::formatted_size("{}", total_), total_, what));
}

void CountedProgress::begins(const std::string &what) {
  ++done_;
  tell(what);
}

void CountedProgress::measured(const std::string &what) {
  ++done_;
  const double seconds = std::chrono::duration<double>(steady_clock::now() - begin_).count();
  const std::size_t left = total_ - std::min(found_ + done_, total_);
  tell(fmt::format("{}, about {:.0f} s left", what,
                   seconds / static_cast<double>(done_) * static_cast<double>(left)));
}

} // namespace drumlin::post
