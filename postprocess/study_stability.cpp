#include "study_stability.h"

#include "stability_extremes.h"
#include "stability_map.h"

#include <fmt/format.h>
#include <stdexcept>
#include <string>
#include <vector>

namespace drumlin::post {

void run_stability_study(const StudyOptions &options) {
  std::vector<std::string> failing;
  for (const MapVerdict &verdict : judge_stability_map(measure_stability_map(options))) {
    fmt::print("{}: {}: {}\n", verdict.promise, verdict.found, verdict.holds ? "holds" : "fails");
    if (!verdict.holds) failing.push_back(verdict.promise);
  }
  for (const ExtremeVerdict &verdict : measure_extremes(options))
    if (!verdict.holds) failing.push_back(verdict.row.name);
  if (!failing.empty())
    throw std::runtime_error(fmt::format("{} rows fail: {}", failing.size(), fmt::join(failing, "; ")));
}

} // namespace drumlin::post
