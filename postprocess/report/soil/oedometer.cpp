#include "report/soil/pages.h"

#include "runs/element_rows.h"
#include "pages/figure.h"
#include "pages/page.h"
#include "report/soil/page_parts.h"
#include "support/csv.h"

#include <cmath>
#include <limits>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

using OedometerRun = ElementRun<OedometerRow>;

/// Largest modulus of the loads that increase the stress, or of those that decrease it; NaN if there are
/// none.
double largest_modulus(const std::vector<OedometerRow> &rows, bool increasing) {
  double most = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t n = 1; n < rows.size(); ++n)
    if ((rows[n].stress > rows[n - 1].stress) == increasing) most = std::fmax(most, rows[n].modulus);
  return most;
}

PageTable run_table(const std::vector<OedometerRun> &runs) {
  PageTable table = element_run_table(
      "oedometer_runs",
      "friction (-) | k (N/m) | void ratio at the start (-) | settlement at the largest stress (mm) | "
      "settlement at the end (mm) | largest modulus, loading (MPa) | largest modulus, unloading (MPa)");
  for (const OedometerRun &run : runs)
    add_element_run(table, run.run,
                    {run.run.text("friction"), run.run.text("k"), number_cell(run.rows.front().void_ratio),
                     number_cell(largest(run.rows, &OedometerRow::settlement)),
                     number_cell(run.rows.back().settlement), number_cell(largest_modulus(run.rows, true)),
                     number_cell(largest_modulus(run.rows, false))},
                    quality_of(run.rows));
  table.notes = {"Settlement: of the platen since the seating stress, at which the sample was made. Modulus: "
                 "constrained modulus, the change of stress over the change of strain between two loads at "
                 "rest. Inertial number: strain rate while the stress changes, times diameter "
                 "sqrt(density/stress); below 1e-3 a test is quasi-static. Energy error: stored energy + "
                 "heat - work of the platen's force, over the largest work."};
  return table;
}

/// Every row of every run.
PageTable row_table(const std::vector<OedometerRun> &runs) {
  PageTable table("oedometer_rows", "The sample at rest under each stress",
                  "run | stress (kPa) | settlement (mm) | strain (%) | void ratio (-) | modulus (MPa)");
  for (const OedometerRun &run : runs)
    for (const OedometerRow &row : run.rows)
      table.add({run.run.name, number_cell(row.stress), number_cell(row.settlement),
                 number_cell(100 * row.strain), number_cell(row.void_ratio), number_cell(row.modulus)});
  return table;
}

/// The runs' curves over stress: a panel for each of modulus, settlement and void ratio.
PageFigure stress_figure(const std::vector<OedometerRun> &runs) {
  const std::string name = "oedometer";
  Panel modulus{"Constrained modulus", "stress (kPa)", "modulus (MPa)", {}};
  modulus.y_range = "[0:*] noreverse"; // gnuplot keeps `reverse` from panel to panel
  Panel settlement{"Settlement", "stress (kPa)", "settlement (mm)", {}};
  settlement.y_range = "[*:*] reverse";
  Panel voids{"Void ratio", "stress (kPa)", "void ratio (-)", {}};
  voids.y_range = "[*:*] noreverse";
  CurveTable table("stress (kPa),settlement (mm),void ratio (-),modulus (MPa)");
  for (std::size_t n = 0; n < runs.size(); ++n) {
    const std::string key = curve_text(runs[n].run.name);
    for (const OedometerRow &row : runs[n].rows)
      table.row(key, {row.stress, row.settlement, row.void_ratio, row.modulus});
    const CurveStyle style = series_style(n);
    settlement.curves.push_back(curve(name, key, "$2", "3", style));
    voids.curves.push_back(curve(name, key, "$2", "4", style));
    modulus.curves.push_back(curve(name, key, "$2", "5", style));
  }
  PageFigure figure = page_figure(
      "Fig. 1",
      "Constrained modulus, settlement and void ratio over the stress of the platen, loads connected in "
      "their order. A modulus is drawn at the stress at which its change of stress ends.",
      {name, "Samples under the stresses of the oedometer", {modulus, settlement, voids}, 1}, 1.0);
  for (Panel &panel : figure.figure.panels)
    panel.log_x = true;
  figure.csv = table.text();
  return figure;
}

} // namespace

PageWriter read_oedometer_page(const std::vector<fs::path> &folders) {
  return [runs = read_element_runs(folders, "oedometer.csv", read_oedometer)](const fs::path &out) {
    Page page(out, oedometer_title, Drawing::oedometer);
    page.answer("Samples of soil between two rough plates, confined sideways, under one stress after the "
                "other. The slope of stress over strain is the constrained modulus of the soil.");
    answer_quality(page, runs);
    page.section("Modulus and settlement");
    page.figure(stress_figure(runs));
    page.section("Numbers");
    page.table(run_table(runs));
    page.table(row_table(runs));
    page.write();
  };
}

} // namespace drumlin::post
