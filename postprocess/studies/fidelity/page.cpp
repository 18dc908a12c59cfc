#include "studies/fidelity/page.h"

#include "pages/figure_data.h"
#include "pages/page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace drumlin::post {

namespace {

/// How the changes of a quantity are given: in percent of the mean of the base, but those of the settlement, whose mean may be about zero, in
/// mm per cycle.
struct Scale {
  std::string unit;
  double factor; ///< to this unit, of Effect::change or, if absolute, of Effect::difference
  double
      tolerance; ///< in this unit: a change whose whole confidence interval is within it counts as negligible
  bool absolute;
};

Scale scale_of(BedQuantity quantity) {
  if (quantity == BedQuantity::settlement) return {"mm per cycle", 1e3, 1.0, true};
  return {"%", 100.0, 10.0, false};
}

/// In the unit of its scale; NaN if no seed gives it.
MeanInterval change_of(const Effect &effect, std::size_t q) {
  const Scale scale = scale_of(bed_quantities[q]);
  const MeanInterval &change = (scale.absolute ? effect.difference : effect.change)[q];
  return {scale.factor * change.mean, scale.factor * change.half_width};
}

std::string change_words(const MeanInterval &change) {
  if (std::isnan(change.mean)) return no_value;
  return fmt::format("{:+.1f} ± {:.1f}", change.mean, change.half_width);
}

std::string without_unit(BedQuantity quantity) {
  const std::string name = bed_quantity_name(quantity);
  return name.substr(0, name.find(" ("));
}

/// For each quantity: the ingredients that change it, those that do not, and those that are not decided.
PageTable conclusion_table(const std::vector<Effect> &effects) {
  PageTable table;
  table.name = "needs";
  table.title = "Which ingredients a question needs";
  table.text_columns = 4;
  table.header = {"question", "it changes with",
                  "free to choose: changes it by less than 10 % (settlement: 1 mm per cycle)",
                  "not decided by these seeds"};
  for (std::size_t q = 0; q < bed_quantities.size(); ++q) {
    std::array<std::vector<std::string>, 3> cells;
    for (const Effect &effect : effects) {
      const MeanInterval change = change_of(effect, q);
      if (std::isnan(change.mean)) continue;
      const Scale scale = scale_of(bed_quantities[q]);
      const std::string text = fmt::format("{} ({:+.{}f} {}, time x {:.2g})", effect.compared.what,
                                           change.mean, scale.absolute ? 1 : 0, scale.unit, effect.cost);
      cells[change.within(scale.tolerance) ? 1 : change.significant() ? 0 : 2].push_back(text);
    }
    std::vector<std::string> row = {without_unit(bed_quantities[q])};
    for (const std::vector<std::string> &cell : cells)
      row.push_back(cell.empty() ? "-" : fmt::format("{}", fmt::join(cell, "; ")));
    table.add(std::move(row));
  }
  table.notes = {
      "In brackets: the mean change, and the processor time over that of the model it is compared with.",
      "A change is in the second column if its whole 95 % confidence interval is within 10 % (settlement: 1 "
      "mm per cycle), else in the "
      "first if the interval does not contain zero, else in the third."};
  return table;
}

PageTable effect_table(const std::vector<Effect> &effects) {
  PageTable table;
  table.name = "effects";
  table.title = "Change by each ingredient";
  table.text_columns = 3;
  table.header = {"row", "ingredient", "matters for", "seeds"};
  for (const BedQuantity quantity : bed_quantities)
    table.header.push_back(fmt::format("{} ({})", without_unit(quantity), scale_of(quantity).unit));
  table.header.emplace_back("processor time (ratio)");
  for (const Effect &effect : effects) {
    std::vector<std::string> matters;
    for (std::size_t q = 0; q < bed_quantities.size(); ++q)
      if (effect.change[q].significant()) matters.push_back(without_unit(bed_quantities[q]));
    std::vector<std::string> row = {std::to_string(table.rows.size() + 1), effect.compared.what,
                                    matters.empty() ? "nothing significant"
                                                    : fmt::format("{}", fmt::join(matters, ", ")),
                                    std::to_string(effect.seeds)};
    for (std::size_t q = 0; q < bed_quantities.size(); ++q)
      row.push_back(change_words(change_of(effect, q)));
    row.push_back(fmt::format("{:.2f}", effect.cost));
    table.add(std::move(row));
  }
  table.notes = {
      "Change seed by seed: mean and half of its 95 % confidence interval (Student's t), in percent of the "
      "mean of the model it "
      "is compared with; that of the settlement, whose mean may be about zero, in mm per cycle. If the "
      "interval contains zero, the change is not significant. The motion of a bed "
      "is chaotic: of "
      "twenty comparisons without any effect one is significant by chance.",
      "Acceleration and force: largest values of a cycle; all means over the second half of the run."};
  return table;
}

/// Which ingredients change a quantity significantly.
std::string effects_words(const std::vector<Effect> &effects) {
  std::vector<std::string> names;
  for (const Effect &effect : effects)
    if (std::any_of(effect.change.begin(), effect.change.end(),
                    [](const MeanInterval &change) { return change.significant(); }))
      names.push_back(effect.compared.what);
  if (effects.empty()) return "There is no comparison yet.";
  return fmt::format(
      "{} of {} ingredients change at least one quantity significantly (95 % confidence interval without "
      "zero){}{}.",
      names.size(), effects.size(), names.empty() ? "" : ": ", fmt::join(names, ", "));
}

PageTable run_table(const std::vector<FidelityRun> &runs) {
  PageTable table;
  table.name = "means";
  table.title = "Means over the seeds";
  table.header = {"variant", "seeds"};
  for (const BedQuantity quantity : bed_quantities)
    table.header.push_back(bed_quantity_name(quantity));
  table.header.emplace_back("processor time (s)");
  std::vector<std::string> names;
  for (const FidelityRun &run : runs)
    if (std::find(names.begin(), names.end(), run.variant) == names.end()) names.push_back(run.variant);
  for (const std::string &name : names) {
    std::array<std::vector<double>, bed_quantities.size()> values;
    std::vector<double> cpu;
    for (const FidelityRun &run : runs) {
      if (run.variant != name) continue;
      for (std::size_t q = 0; q < bed_quantities.size(); ++q)
        if (std::isfinite(run.values[q])) values[q].push_back(run.values[q]);
      cpu.push_back(run.cpu_s);
    }
    std::vector<std::string> row = {name, std::to_string(cpu.size())};
    for (const std::vector<double> &quantity : values) {
      if (quantity.empty()) {
        row.emplace_back(no_value);
        continue;
      }
      const MeanInterval mean = mean_interval(quantity);
      row.push_back(fmt::format("{:.4g} ± {:.2g}", mean.mean, mean.half_width));
    }
    row.push_back(fmt::format("{:.3g}", mean_interval(cpu).mean));
    table.add(std::move(row));
  }
  table.notes = {"After the ±: half of the 95 % confidence interval of the mean."};
  return table;
}

PageFigure effect_figure(const std::vector<Effect> &effects) {
  const std::string name = "changes";
  PageFigure figure;
  figure.label = "Fig. 1";
  figure.weight = 1.0;
  figure.caption = "Change: mean over the seeds and its 95 % confidence interval. A bar that crosses zero is "
                   "not significant.";
  figure.figure = {name, "Change by each ingredient", {}, 2};
  CurveTable table("ingredient,change (% or mm per cycle),low,high");
  for (std::size_t q = 0; q < bed_quantities.size(); ++q) {
    const std::string title = without_unit(bed_quantities[q]);
    Panel panel;
    panel.title = title;
    panel.y_label = fmt::format("change ({})", scale_of(bed_quantities[q]).unit);
    panel.curves = {curve(name, title, "$2", "3:4:5", CurveStyle::spread)};
    panel.curves.back().title.clear();
    panel.x_label = "row of the table of effects";
    double lowest = 0.0, highest = 0.0;
    for (std::size_t n = 0; n < effects.size(); ++n) {
      panel.x_ticks.push_back(std::to_string(n + 1));
      const MeanInterval change = change_of(effects[n], q);
      table.row(title, {static_cast<double>(n + 1), change.mean, change.mean - change.half_width,
                        change.mean + change.half_width});
      if (!std::isfinite(change.half_width)) continue; // one seed
      lowest = std::min(lowest, change.mean - change.half_width);
      highest = std::max(highest, change.mean + change.half_width);
    }
    // A range for each panel: by default gnuplot takes that of all rows of the file.
    panel.y_range = fmt::format("[{:.4g}:{:.4g}]", 1.1 * lowest - 1.0, 1.1 * highest + 1.0);
    figure.figure.panels.push_back(panel);
  }
  figure.csv = table.text();
  return figure;
}

} // namespace

void write_fidelity_page(const std::filesystem::path &out, const std::string &beds,
                         const std::vector<FidelityRun> &runs, const std::vector<Effect> &effects,
                         const std::vector<std::string> &failures) {
  Page page(out, "What a bed needs", Scene::bed);
  page.answer("Each ingredient of a bed is added, left out or changed, on beds of the same seeds, and "
              "compared with the complete scene: " +
              beds + ".");
  page.answer(effects_words(effects));
  for (const std::string &failure : failures)
    page.answer("Missing: " + failure);
  page.section("Conclusions");
  page.table(conclusion_table(effects));
  page.section("Effects");
  page.table(effect_table(effects));
  page.figure(effect_figure(effects));
  page.section("Means");
  page.table(run_table(runs));
  page.write();
}

} // namespace drumlin::post
