#include "pages/acceptance.h"

#include <algorithm>

#include <fmt/format.h>

namespace drumlin::post {

PageTable acceptance_table(const std::vector<Acceptance> &criteria) {
  PageTable table("acceptance", "Acceptance criteria", "acceptance criterion | measured | holds", 2);
  table.verdict = "holds";
  table.criterion = "criteria hold";
  for (const Acceptance &one : criteria)
    table.add({one.criterion, one.measured, one.holds ? "yes" : "no"},
              one.holds ? RowState::agrees : RowState::differs);
  return table;
}

std::string acceptance_words(const std::vector<Acceptance> &criteria) {
  if (criteria.empty()) return "No acceptance criterion can be judged by these runs.";
  const auto held =
      std::count_if(criteria.begin(), criteria.end(), [](const Acceptance &one) { return one.holds; });
  std::string words = fmt::format("{} of {} acceptance criteria hold.", held, criteria.size());
  const char *separator = " Not met: ";
  for (const Acceptance &one : criteria) {
    if (one.holds) continue;
    words += fmt::format("{}{} (measured {})", separator, one.criterion, one.measured);
    separator = "; ";
  }
  return words + (words.back() == '.' ? "" : ".");
}

} // namespace drumlin::post
