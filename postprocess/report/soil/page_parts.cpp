#include "report/soil/page_parts.h"

#include "support/statistics.h"
#include "support/text.h"

#include <fmt/format.h>

#include <array>
#include <limits>

namespace drumlin::post {

namespace {

/// The parameters in which tests of one soil agree, as one text.
std::string soil_text(const Run &run, const std::vector<std::string> &varied) {
  std::string text;
  for (const auto &[name, value] : run.parameters)
    if (!varies_with_seed(name) && std::find(varied.begin(), varied.end(), name) == varied.end())
      text.append(name).append(" ").append(value).append("\n");
  return text;
}

} // namespace

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

bool TestQuality::good() const {
  return inertial_number <= allowed_inertial_number && energy_error <= allowed_energy_error &&
         strain_reached.value_or(1.0) >= complete_strain;
}

TestQuality worst_of(const std::vector<TestQuality> &qualities) {
  TestQuality worst = qualities.front();
  for (const TestQuality &quality : qualities) {
    worst.inertial_number = std::max(worst.inertial_number, quality.inertial_number);
    worst.energy_error = std::max(worst.energy_error, quality.energy_error);
    if (quality.strain_reached)
      worst.strain_reached = std::min(worst.strain_reached.value_or(1.0), *quality.strain_reached);
  }
  return worst;
}

std::vector<Acceptance> quality_criteria(const TestQuality &quality) {
  std::vector<Acceptance> criteria = {
      {fmt::format("largest inertial number at most {:g}", allowed_inertial_number),
       number_cell(quality.inertial_number, 2), quality.inertial_number <= allowed_inertial_number},
      {fmt::format("largest energy error at most {:g}", allowed_energy_error),
       number_cell(quality.energy_error, 2), quality.energy_error <= allowed_energy_error}};
  if (quality.strain_reached)
    criteria.push_back({fmt::format("every run reached at least {:g} % of its strain", 100 * complete_strain),
                        fmt::format("{:.0f} %", 100 * *quality.strain_reached),
                        *quality.strain_reached >= complete_strain});
  return criteria;
}

PageTable element_run_table(const std::string &name, const std::string &columns) {
  PageTable table(name, "Runs",
                  "run | sample | balls | " + columns +
                      " | largest inertial number (-) | largest energy error (-) | engine | command",
                  2);
  table.shown_columns = table.header.size() - 1;
  table.criterion =
      fmt::format("runs have an inertial number of at most {:g} and an energy error of at most {:g}",
                  allowed_inertial_number, allowed_energy_error);
  return table;
}

void add_element_run(PageTable &table, const Run &run, const std::vector<std::string> &measured,
                     const TestQuality &quality) {
  std::vector<std::string> cells = {run.name, run.text("sample"), run.text("balls")};
  cells.insert(cells.end(), measured.begin(), measured.end());
  cells.insert(cells.end(), {number_cell(quality.inertial_number, 2), number_cell(quality.energy_error, 2),
                             run.text("engine"), run.text("command")});
  table.add(std::move(cells), quality.good() ? RowState::agrees : RowState::differs);
}

std::vector<SoilGroup> soils_of(const std::vector<const Run *> &runs,
                                const std::vector<std::string> &varied) {
  std::vector<SoilGroup> soils;
  std::vector<std::string> texts;
  for (std::size_t n = 0; n < runs.size(); ++n) {
    const std::string text = soil_text(*runs[n], varied);
    const auto found = std::find(texts.begin(), texts.end(), text);
    const auto index = static_cast<std::size_t>(found - texts.begin());
    if (found == texts.end()) {
      texts.push_back(text);
      soils.push_back(
          {curve_text(fmt::format("soil {}: {}", texts.size(), runs[n]->text("engine", ""))), {}});
    }
    soils[index].runs.push_back(n);
  }
  return soils;
}

std::map<double, std::vector<std::size_t>> grouped_by(const std::vector<double> &numbers,
                                                      const SoilGroup &soil) {
  std::map<double, std::vector<std::size_t>> groups;
  for (const std::size_t n : soil.runs)
    groups[numbers[n]].push_back(n);
  return groups;
}

void SeedValues::add(const std::string &seed, double value) {
  if (std::isfinite(value)) values_[seed].push_back(value);
}

std::string SeedValues::mean_text(int decimals) const {
  if (values_.empty()) return no_value;
  std::vector<double> means;
  means.reserve(values_.size());
  for (const auto &[seed, of_seed] : values_)
    means.push_back(mean_interval(of_seed).mean);
  const MeanInterval mean = mean_interval(means);
  return means.size() < 2 ? fmt::format("{:.{}f}", mean.mean, decimals)
                          : fmt::format("{:.{}f} ± {:.{}f}", mean.mean, decimals, mean.half_width, decimals);
}

std::string SeedValues::range_text() const {
  if (values_.empty()) return no_value;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const auto &[seed, of_seed] : values_)
    for (const double value : of_seed) {
      least = std::min(least, value);
      most = std::max(most, value);
    }
  return fmt::format("{:.1f} to {:.1f}", least, most);
}

CurveStyle series_style(std::size_t n) {
  constexpr std::array styles = {CurveStyle::series_1, CurveStyle::series_2, CurveStyle::series_3,
                                 CurveStyle::series_4, CurveStyle::series_5, CurveStyle::series_6};
  return styles[n % styles.size()];
}

CurveStyle line_style(std::size_t n) {
  constexpr std::array styles = {CurveStyle::line_1, CurveStyle::line_2, CurveStyle::line_3,
                                 CurveStyle::line_4, CurveStyle::line_5, CurveStyle::direct_line};
  return styles[n % styles.size()];
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
