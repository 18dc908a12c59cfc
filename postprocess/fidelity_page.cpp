#include "fidelity_page.h"

#include "curve_table.h"
#include "study_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace drumlin::post {

namespace {

std::string percent(const MeanError &change) {
  return fmt::format("{:+.1f} ± {:.1f}", 100.0 * change.mean, 100.0 * change.two_errors);
}

ReportTable effect_table(const std::vector<Effect> &effects) {
  ReportTable table;
  table.name = "effects";
  table.title = "What an ingredient changes";
  table.text_columns = 2;
  table.header = {"ingredient", "matters for", "seeds"};
  for (const BedQuantity quantity : bed_quantities) {
    const std::string name = bed_quantity_name(quantity);
    table.header.push_back(name.substr(0, name.find(" (")) + " (%)");
  }
  table.header.emplace_back("wall time over base (-)");
  for (const Effect &effect : effects) {
    std::vector<std::string> matters;
    for (std::size_t q = 0; q < bed_quantities.size(); ++q)
      if (effect.change[q].beyond_scatter()) {
        const std::string name = bed_quantity_name(bed_quantities[q]);
        matters.push_back(name.substr(0, name.find(" (")));
      }
    std::vector<std::string> row = {effect.variant,
                                    matters.empty() ? "nothing beyond the scatter"
                                                    : fmt::format("{}", fmt::join(matters, ", ")),
                                    std::to_string(effect.seeds)};
    for (const MeanError &change : effect.change)
      row.push_back(percent(change));
    row.push_back(fmt::format("{:.2f}", effect.wall_ratio));
    table.add(std::move(row));
  }
  table.notes = {
      "Change against the base, seed by seed: mean and twice its standard error, in percent of the mean of "
      "the base. "
      "What is smaller than that is not claimed: a bed is chaotic.",
      "Acceleration and force: largest values of a cycle; all means over the second half of the run."};
  return table;
}

ReportTable run_table(const std::vector<FidelityRun> &runs) {
  ReportTable table;
  table.name = "means";
  table.title = "Means over the seeds";
  table.header = {"variant", "seeds"};
  for (const BedQuantity quantity : bed_quantities)
    table.header.push_back(bed_quantity_name(quantity));
  table.header.emplace_back("wall time (s)");
  std::vector<std::string> names;
  for (const FidelityRun &run : runs)
    if (std::find(names.begin(), names.end(), run.variant) == names.end()) names.push_back(run.variant);
  for (const std::string &name : names) {
    std::array<std::vector<double>, bed_quantities.size()> values;
    std::vector<double> wall;
    for (const FidelityRun &run : runs) {
      if (run.variant != name) continue;
      for (std::size_t q = 0; q < bed_quantities.size(); ++q)
        values[q].push_back(run.values[q]);
      wall.push_back(run.wall_s);
    }
    std::vector<std::string> row = {name, std::to_string(wall.size())};
    for (const std::vector<double> &quantity : values) {
      const MeanError mean = mean_error(quantity);
      row.push_back(fmt::format("{:.4g} ± {:.2g}", mean.mean, mean.two_errors));
    }
    row.push_back(fmt::format("{:.3g}", mean_error(wall).mean));
    table.add(std::move(row));
  }
  table.notes = {"Twice the standard error behind the ±."};
  return table;
}

PlannedFigure effect_figure(const std::vector<Effect> &effects) {
  const std::string name = "changes";
  PlannedFigure figure;
  figure.label = "Fig. 1";
  figure.caption = "Change against the base, mean over the seeds and twice its standard error: bars that "
                   "cross zero say nothing.";
  figure.figure = {name, "What an ingredient changes", {}, 2, 900, 520};
  CurveTable table("ingredient,change (%),low (%),high (%)");
  for (std::size_t q = 0; q < bed_quantities.size(); ++q) {
    std::string title = bed_quantity_name(bed_quantities[q]);
    title = title.substr(0, title.find(" ("));
    Panel panel;
    panel.title = title;
    panel.y_label = "change (%)";
    panel.curves = {curve(name, title, "$2", "3:4:5", CurveStyle::spread)};
    panel.curves.back().title.clear();
    panel.legend_rows = 4; // room for the names
    for (std::size_t n = 0; n < effects.size(); ++n) {
      panel.x_ticks.push_back(effects[n].variant);
      const MeanError &change = effects[n].change[q];
      table.row(title,
                {static_cast<double>(n + 1), 100.0 * change.mean, 100.0 * (change.mean - change.two_errors),
                 100.0 * (change.mean + change.two_errors)});
    }
    figure.figure.panels.push_back(panel);
  }
  figure.csv = table.text();
  return figure;
}

} // namespace

void write_fidelity_page(const std::filesystem::path &out, const std::vector<FidelityRun> &runs,
                         const std::vector<Effect> &effects) {
  StudyPage page(out, "What a bed needs");
  page.paragraph(
      "Each ingredient of a bed is put in, left out or set otherwise, on the same five beds (seeds), and "
      "compared with "
      "the base: 2500 balls, condition B, friction 0.5, second-order stepping, 2500 steps per cycle, 20 Hz.");
  page.section("Effects");
  page.table(effect_table(effects));
  page.figure(effect_figure(effects));
  page.section("Means");
  page.table(run_table(runs));
  page.write();
}

} // namespace drumlin::post
