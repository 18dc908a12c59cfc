#include "report/element_test.h"

#include "pages/table.h"
#include "support/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace drumlin::post {

std::vector<Run> read_named_runs(const std::vector<std::filesystem::path> &folders) {
  std::vector<Run> runs;
  for (const std::filesystem::path &folder : folders) {
    Run run;
    run.folder = folder;
    for (const auto &[name, value] : read_parameters(folder / "parameters.csv"))
      run.parameters.emplace(valid_utf8(name), valid_utf8(value));
    runs.push_back(std::move(run));
  }
  name_runs(runs);
  return runs;
}

std::string number_cell(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : no_value;
}

std::string curve_text(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ',' || c == '"'; }, ' ');
  return name; // gnuplot splits a row at each comma
}

} // namespace drumlin::post
