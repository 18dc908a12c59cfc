#include "report/soil/pages.h"

#include "pages/figure.h"
#include "pages/page.h"
#include "report/soil/page_parts.h"
#include "support/statistics.h"

#include <fmt/format.h>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

using DensityRun = ElementRun<DensityRow>;

/// A number of one row of all runs of a soil, as mean over seeds; the loosest packing is row 0, the densest
/// row 1.
std::string mean_of(const std::vector<DensityRun> &runs, const SoilGroup &soil, std::size_t row,
                    double DensityRow::*number) {
  std::vector<double> values;
  for (const std::size_t n : soil.runs)
    values.push_back(runs[n].rows[row].*number);
  const MeanInterval interval = mean_interval(values);
  return values.size() < 2 ? fmt::format("{:.3f}", interval.mean)
                           : fmt::format("{:.3f} ± {:.3f}", interval.mean, interval.half_width);
}

/// What the runs of a soil have found, and how sure that is.
std::string answer_of(const std::vector<DensityRun> &runs, const SoilGroup &soil) {
  const std::string alone =
      soil.runs.size() < 2 ? "; a single run does not say how much samples scatter: take several seeds" : "";
  return fmt::format("Void ratio of the loosest packing {}, of the {} {} ({}){}.",
                     mean_of(runs, soil, 0, &DensityRow::void_ratio),
                     runs[soil.runs.front()].rows[1].made.empty() ? "frictionless" : "shaken",
                     mean_of(runs, soil, 1, &DensityRow::void_ratio), soil.name, alone);
}

PageTable soil_table(const std::vector<DensityRun> &runs) {
  PageTable table(
      "density_soils", "Void ratios of each soil",
      "soil | runs | void ratio, loosest (-) | void ratio, densest (-) | solid fraction, loosest (-) "
      "| solid fraction, densest (-)");
  for (const SoilGroup &soil : soils_of(runs, {"shares"})) {
    const auto mean = [&](std::size_t row, double DensityRow::*number) {
      return mean_of(runs, soil, row, number);
    };
    table.add({soil.name, std::to_string(soil.runs.size()), mean(0, &DensityRow::void_ratio),
               mean(1, &DensityRow::void_ratio), mean(0, &DensityRow::solid_fraction),
               mean(1, &DensityRow::solid_fraction)});
  }
  table.notes = {"Behind ± is half of the 95 % confidence interval of the mean over runs, which differ in "
                 "their seeds. In two dimensions void ratios and solid fractions are those of areas."};
  return table;
}

/// Every packing of every run.
PageTable packing_table(const std::vector<DensityRun> &runs) {
  PageTable table(
      "density_packings", "Packings",
      "run | made | friction while it was made (-) | rolling friction then (-) | void ratio (-) | solid "
      "fraction (-) | relative density (-) | degree of compaction (-) | contacts per ball (-)");
  for (const DensityRun &run : runs)
    for (const DensityRow &row : run.rows)
      table.add({run.run.name, row.made.empty() ? no_value : row.made, number_cell(row.friction),
                 number_cell(row.rolling), number_cell(row.void_ratio), number_cell(row.solid_fraction),
                 number_cell(row.relative_density), number_cell(row.compaction),
                 number_cell(row.coordination)});
  table.notes = {"Relative density: 0 for the loosest packing of a run, 1 for its shaken one; degree of "
                 "compaction: density over that of the shaken packing. In a run without a shaken packing the "
                 "frictionless one, which is denser than any soil, takes its place: this is not the scale of "
                 "beds."};
  return table;
}

PageFigure void_figure(const std::vector<DensityRun> &runs) {
  const std::string name = "density";
  Panel voids{"Void ratio", "friction while the packing was made (-)", "void ratio (-)", {}};
  CurveTable table("friction (-),void ratio (-)");
  for (std::size_t n = 0; n < runs.size(); ++n) {
    const std::string key = curve_text(runs[n].run.name);
    std::vector<DensityRow> rows = runs[n].rows;
    std::sort(rows.begin(), rows.end(),
              [](const DensityRow &a, const DensityRow &b) { return a.friction < b.friction; });
    for (const DensityRow &row : rows)
      table.row(key, {row.friction, row.void_ratio});
    voids.curves.push_back(curve(name, key, "$2", "3", series_style(n)));
  }
  PageFigure figure = page_figure(
      "Fig. 1", "Void ratio over the friction with which a packing was made; rolling friction goes with it.",
      {name, "Packings between the densest and the loosest", {voids}, 1}, 1.0);
  figure.csv = table.text();
  return figure;
}

} // namespace

PageWriter read_density_page(const std::vector<fs::path> &folders) {
  return [runs = read_element_runs(folders, "density.csv", read_density)](const fs::path &out) {
    Page page(out, density_title, std::nullopt);
    page.answer(
        "Balls that sank to a rough floor and came to rest: with the friction of the soil they form its "
        "loosest packing, shaken its densest, and without friction one that is denser than any soil.");
    for (const SoilGroup &soil : soils_of(runs, {"shares"}))
      page.answer(answer_of(runs, soil));
    page.section("Void ratios");
    page.figure(void_figure(runs));
    page.section("Numbers");
    page.table(soil_table(runs));
    page.table(packing_table(runs));
    page.write();
  };
}

} // namespace drumlin::post
