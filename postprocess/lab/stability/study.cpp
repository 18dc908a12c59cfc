#include "lab/studies.h"

#include "experiment/study.h"
#include "lab/stability/map.h"
#include "lab/stability/page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>
#include <string>
#include <vector>

namespace drumlin::post {

void run_stability_study(const StudyOptions &options) {
  const std::vector<MapPoint> map = measure_stability_map(options);
  write_stability_page(options.out, map);
  fmt::print("{}\n", (options.out / "index.html").string());

  std::vector<std::string> failing;
  for (const Acceptance &p : judge_stability_map(map))
    if (!p.holds) failing.push_back(p.criterion + ": " + p.measured);
  if (!failing.empty())
    throw std::runtime_error(fmt::format("{} criteria fail: {}", failing.size(), fmt::join(failing, "; ")));
}

} // namespace drumlin::post
