#include "report/soil/pages.h"

#include "bed/element_results.h"
#include "pages/figure.h"
#include "pages/page.h"
#include "report/soil/page_parts.h"
#include "support/csv.h"

#include <Eigen/QR>
#include <fmt/format.h>

#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

using PlateRun = ElementRun<PlateRow>;

/// Width of the plate of a run, m. Throws std::runtime_error if it is not noted.
double width_of(const Run &run) {
  const std::optional<double> width = run.number("plate_width");
  if (!width || *width <= 0.0)
    throw std::runtime_error(fmt::format("{}: plate_width is '{}'; allowed: a number above 0",
                                         (run.folder / "parameters.csv").string(),
                                         run.text("plate_width", "")));
  return *width;
}

std::vector<PlateResult> results_of(const std::vector<PlateRun> &runs) {
  std::vector<PlateResult> results;
  results.reserve(runs.size());
  for (const PlateRun &run : runs)
    results.push_back(plate_result(run.rows, width_of(run.run)));
  return results;
}

/// The quantities of a test, for the columns of tables.
struct Quantity {
  const char *header;
  double (*of)(const PlateResult &);
};
constexpr std::array quantities = {
    Quantity{"k_s, first loading (MN/m³)", [](const PlateResult &r) { return r.first_reaction; }},
    Quantity{"k_s, second loading (MN/m³)", [](const PlateResult &r) { return r.second_reaction; }},
    Quantity{"E_v1 (MPa)", [](const PlateResult &r) { return r.first_modulus; }},
    Quantity{"E_v2 (MPa)", [](const PlateResult &r) { return r.second_modulus; }},
    Quantity{"E_v2/E_v1 (-)", [](const PlateResult &r) { return r.ratio(); }},
    Quantity{"bearing capacity (kPa)", [](const PlateResult &r) { return r.bearing_capacity; }}};

/// Means over the beds of one soil.
PageTable soil_table(const std::vector<PlateRun> &runs, const std::vector<PlateResult> &results) {
  PageTable table("plate_soils", "Means over the beds", "soil | tests");
  for (const Quantity &quantity : quantities)
    table.header.emplace_back(quantity.header);
  for (const SoilGroup &soil : soils_of(runs, {"bed"})) {
    std::vector<std::string> cells = {soil.name, std::to_string(soil.runs.size())};
    for (const Quantity &quantity : quantities) {
      SeedValues values;
      for (const std::size_t n : soil.runs)
        values.add(runs[n].run.text("bed"), quantity.of(results[n]));
      cells.push_back(values.mean_text());
    }
    table.add(std::move(cells));
  }
  table.notes = {"Mean and half of its 95 % confidence interval over the beds. A parabola is fitted to the "
                 "settlement over the stress of each loading. Modulus of subgrade reaction k_s: slope of "
                 "stress over settlement between 0.3 and 0.7 of the largest stress of the first loading, on "
                 "this parabola. Strain modulus: 0.75 times width times k_s, which is the formula of DIN "
                 "18134 with the width of the strip for the diameter of a round plate; the values of a strip "
                 "and of a round plate on one soil differ. Bearing capacity: the stress at which the "
                 "settlement is a tenth of the width in the first loading, linear between stages."};
  return table;
}

PageTable run_table(const std::vector<PlateRun> &runs, const std::vector<PlateResult> &results) {
  std::string columns =
      "plate width (m) | largest stress (kPa) | settlement at the end of the first loading (mm)";
  for (const Quantity &quantity : quantities)
    columns += std::string(" | ") + quantity.header;
  PageTable table = element_run_table("plate_runs", columns);
  for (std::size_t n = 0; n < runs.size(); ++n) {
    const PlateRun &run = runs[n];
    double most = 0.0, settlement = 0.0;
    for (const PlateRow &row : run.rows)
      if (row.is(PlatePhase::first_loading)) {
        most = row.stress;
        settlement = row.settlement;
      }
    std::vector<std::string> cells = {number_cell(width_of(run.run)), number_cell(most),
                                      number_cell(settlement)};
    for (const Quantity &quantity : quantities)
      cells.push_back(number_cell(quantity.of(results[n])));
    add_element_run(table, run.run, cells, quality_of(run.rows));
  }
  table.notes = {"Inertial number: settlement over width during a change of the stress, over its time, times "
                 "diameter sqrt(density/stress), with the smaller of the two stresses; below 1e-3 a test is "
                 "quasi-static. While the soil fails it is larger. Energy error: stored energy + heat - work "
                 "of the plate's force and of gravity, over the largest work."};
  return table;
}

/// Every row of every run.
PageTable row_table(const std::vector<PlateRun> &runs) {
  constexpr std::array phases = {"seating", "first loading", "unloading", "second loading"};
  PageTable table("plate_rows", "The bed at rest under each stress",
                  "run | part | stress (kPa) | settlement (mm)", 2);
  for (const PlateRun &run : runs)
    for (const PlateRow &row : run.rows)
      table.add({run.run.name, phases.at(static_cast<std::size_t>(row.phase)), number_cell(row.stress),
                 number_cell(row.settlement)});
  return table;
}

PageFigure settlement_figure(const std::vector<PlateRun> &runs) {
  const std::string name = "plate";
  Panel panel{"", "stress (kPa)", "settlement (mm)", {}};
  panel.y_range = "[*:*] reverse";
  CurveTable table("stress (kPa),settlement (mm)");
  for (std::size_t n = 0; n < runs.size(); ++n) {
    const std::string key = curve_text(runs[n].run.name);
    for (const PlateRow &row : runs[n].rows)
      table.row(key, {row.stress, row.settlement});
    panel.curves.push_back(curve(name, key, "$2", "3", series_style(n)));
  }
  PageFigure figure =
      page_figure("Fig. 1", "Settlement of the plate over its stress, the stages connected in their order.",
                  {name, "A plate on the bed: first loading, unloading, second loading", {panel}, 1}, 1.0);
  figure.csv = table.text();
  return figure;
}

} // namespace

PageWriter read_plate_page(const std::vector<fs::path> &folders) {
  const std::vector<PlateRun> runs = read_element_runs(folders, "plate.csv", read_plate);
  return [runs, results = results_of(runs)](const fs::path &out) {
    Page page(out, plate_title, Drawing::plate);
    page.answer(
        "A rigid plate on a bed of soil balls carries a stress that increases stage by stage, decreases, and "
        "increases again. The slope of stress over settlement is the modulus of subgrade reaction.");
    answer_quality(page, runs);
    page.section("Settlement");
    page.figure(settlement_figure(runs));
    page.section("Moduli and bearing capacity");
    page.table(soil_table(runs, results));
    page.section("Numbers");
    page.table(run_table(runs, results));
    page.table(row_table(runs));
    page.write();
  };
}

} // namespace drumlin::post
