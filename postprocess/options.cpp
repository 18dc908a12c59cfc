#include "options.h"

#include "chain_csv.h"
#include "command.h"

#include <fmt/format.h>

#include <limits>

namespace drumlin::post {

double number_option(const char *option, const std::string &text) {
  try {
    return number_from_text(text);
  } catch (const std::invalid_argument &) {
    throw UsageError(fmt::format("{} = '{}': allowed are finite numbers", option, text));
  }
}

int count_option(const char *option, const std::string &text) {
  const double value = number_option(option, text);
  const int count = value >= 1.0 && value <= std::numeric_limits<int>::max() ? static_cast<int>(value) : 0;
  if (count < 1 || static_cast<double>(count) != value)
    throw UsageError(fmt::format("{} = '{}': allowed are whole numbers from 1", option, text));
  return count;
}

} // namespace drumlin::post
