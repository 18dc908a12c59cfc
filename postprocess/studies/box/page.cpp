#include "studies/box/results.h"

#include "pages/figure_data.h"
#include "pages/page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace {

/// A change whose whole confidence interval is within it counts as negligible.
constexpr double tolerance = 0.1;

/// The mean over the seeds of a run, in the unit of tables; none without a value.
std::optional<MeanInterval> mean_of(const std::vector<BoxRun> &runs, const std::string &name,
                                    std::size_t quantity) {
  const std::vector<double> values = finite_values(runs, name, quantity);
  if (values.empty()) return std::nullopt;
  const MeanInterval mean = mean_interval(values);
  return MeanInterval{box_quantities[quantity].scale * mean.mean,
                      box_quantities[quantity].scale * mean.half_width};
}

std::string change_text(const std::optional<MeanInterval> &change, std::size_t quantity) {
  if (!change) return no_value;
  const double scale = is_relative(quantity) ? 100.0 : box_quantities[quantity].scale;
  return fmt::format("{:+.3g} ± {:.2g}{}", scale * change->mean, scale * change->half_width,
                     change->significant() ? " *" : "");
}

/// A comparison over all sizes of the box at once, and what box_change() compares one by one.
constexpr const char *all_boxes = "absorbing instead of rigid, all boxes together";

struct Change {
  std::string what;
  std::array<std::optional<MeanInterval>, box_quantity_count> of; ///< by quantity
};

std::vector<Change> changes_of(const std::vector<BoxRun> &runs,
                               const std::vector<BedComparison> &comparisons) {
  std::vector<Change> changes;
  for (const BedComparison &compared : comparisons) {
    changes.push_back({compared.what, {}});
    for (std::size_t q = 0; q < box_quantities.size(); ++q)
      changes.back().of[q] = box_change(runs, compared, q);
  }
  changes.push_back({all_boxes, {}});
  for (std::size_t q = 0; q < box_quantities.size(); ++q)
    changes.back().of[q] = boundary_change(runs, q);
  return changes;
}

PageTable change_table(const std::vector<Change> &changes) {
  PageTable table;
  table.name = "changes";
  table.title = "What another box changes";
  table.header = {"change"};
  for (std::size_t q = 0; q < box_quantities.size(); ++q)
    table.header.push_back(
        fmt::format("{} ({})", box_quantities[q].name, is_relative(q) ? "%" : box_quantities[q].unit));
  for (const Change &change : changes) {
    std::vector<std::string> row = {change.what};
    for (std::size_t q = 0; q < box_quantities.size(); ++q)
      row.push_back(change_text(change.of[q], q));
    table.add(std::move(row));
  }
  table.notes = {
      "Mean change and half of its 95 % confidence interval (Student's t), in percent of the mean of what it "
      "is "
      "compared with; of the settlement in mm. * marks those whose interval does not contain zero; by chance "
      "alone one of twenty has the mark.",
      "Runs in boxes of one size start from the same beds, and changes are taken seed by seed. Boxes of "
      "different sizes hold different beds: the change is the difference of the means, with the scatter "
      "of both (Welch)."};
  return table;
}

PageTable mean_table(const std::vector<BoxRun> &runs) {
  PageTable table;
  table.name = "means";
  table.title = "Means over the seeds";
  table.header = {"box", "seeds"};
  for (const BoxQuantity &quantity : box_quantities)
    table.header.push_back(fmt::format("{} ({})", quantity.name, quantity.unit));
  table.header.emplace_back("processor time (s)");
  std::vector<std::string> names;
  for (const BoxRun &run : runs)
    if (std::find(names.begin(), names.end(), run.run) == names.end()) names.push_back(run.run);
  for (const std::string &name : names) {
    std::vector<double> cpu;
    for (const BoxRun &run : runs)
      if (run.run == name) cpu.push_back(run.cpu_s);
    std::vector<std::string> row = {name, std::to_string(cpu.size())};
    for (std::size_t q = 0; q < box_quantities.size(); ++q) {
      const std::optional<MeanInterval> mean = mean_of(runs, name, q);
      row.push_back(mean ? fmt::format("{:.3g} ± {:.2g}", mean->mean, mean->half_width) : no_value);
    }
    row.push_back(fmt::format("{:.3g}", mean_interval(cpu).mean));
    table.add(std::move(row));
  }
  table.notes = {
      "After the ±: half of the 95 % confidence interval over the seeds. Peaks, contact and CMV are means "
      "over "
      "the second half of the cycles, the settlement is that of the last cycle, k and D are what `drumlin "
      "identify` finds in the record."};
  return table;
}

/// All quantities over the width or the depth of the box, the other one being that of the default box.
PageFigure size_figure(const std::vector<BoxRun> &runs, int BoxRun::*size, int BoxRun::*other,
                       const char *name, int number) {
  PageFigure figure;
  figure.label = fmt::format("Fig. {}", number);
  figure.weight = number == 1 ? 2.0 : 1.0;
  figure.caption =
      fmt::format("All quantities over the {} of the box. Bars: mean over the seeds and its 95 % "
                  "confidence interval, with rigid walls; circles and triangles: single seeds with "
                  "rigid and absorbing floor and sides.",
                  name);
  figure.figure = {name, fmt::format("Over the {} of the box", name), {}, 3};
  const std::string label = fmt::format("{} of the box [default {}s]", name, name);
  CurveTable table(label + ",value,low,high");
  for (std::size_t q = 0; q < box_quantities.size(); ++q) {
    const BoxQuantity &quantity = box_quantities[q];
    Panel panel;
    panel.x_label = label;
    panel.y_label = fmt::format("{} [{}]", quantity.name, quantity.unit);
    panel.log_x = panel.plain_numbers = true;
    panel.x_range = "[0.8:5]";
    double low = std::numeric_limits<double>::infinity(), high = -low;
    std::vector<std::pair<int, std::string>> boxes; // with rigid walls
    for (const BoxRun &run : runs) {
      if (run.*other != 1 || !std::isfinite(run.values[q])) continue;
      const bool rigid = run.boundary == "rigid";
      const double value = quantity.scale * run.values[q];
      // Beside each other, so that neither hides the other.
      table.row(fmt::format("{} {}", quantity.name, run.boundary),
                {run.*size * (rigid ? 0.95 : 1.05), value});
      low = std::min(low, value);
      high = std::max(high, value);
      const std::pair<int, std::string> box(run.*size, run.run);
      if (rigid && std::find(boxes.begin(), boxes.end(), box) == boxes.end()) boxes.push_back(box);
    }
    for (const auto &[times, run] : boxes) {
      const MeanInterval mean = *mean_of(runs, run, q);
      if (!std::isfinite(mean.half_width)) continue; // one seed
      table.row(
          std::string(quantity.name) + " mean",
          {static_cast<double>(times), mean.mean, mean.mean - mean.half_width, mean.mean + mean.half_width});
      low = std::min(low, mean.mean - mean.half_width);
      high = std::max(high, mean.mean + mean.half_width);
    }
    const double margin = 0.05 * (high - low);
    panel.y_range = axis_range(low - margin, high + margin);
    const auto add = [&](const char *what, const char *title, const char *y, CurveStyle style) {
      panel.curves.push_back(curve(name, fmt::format("{} {}", quantity.name, what), "$2", y, style));
      panel.curves.back().title = title;
    };
    add("mean", "mean with rigid walls", "3:4:5", CurveStyle::spread);
    add("rigid", "rigid", "3", CurveStyle::direct_a);
    add("absorb", "absorbing", "3", CurveStyle::direct_b);
    figure.figure.panels.push_back(panel);
  }
  figure.csv = table.text();
  return figure;
}

/// For each quantity: the boxes that change it, those that do not, and those that are not decided.
PageTable conclusion_table(const std::vector<Change> &changes) {
  PageTable table;
  table.name = "needs";
  table.title = "Which answers need which box";
  table.text_columns = 4;
  table.header = {"answer", "it changes with", "changes by less than 10 % with",
                  "not decided by these seeds"};
  for (std::size_t q = 0; q < box_quantities.size(); ++q) {
    std::array<std::vector<std::string>, 3> cells;
    for (const Change &change : changes)
      if (change.of[q])
        cells[is_relative(q) && change.of[q]->within(tolerance) ? 1
              : change.of[q]->significant()                     ? 0
                                                                : 2]
            .push_back(change.what);
    std::vector<std::string> row = {box_quantities[q].name};
    for (const std::vector<std::string> &cell : cells)
      row.push_back(cell.empty() ? "-" : fmt::format("{}", fmt::join(cell, "; ")));
    table.add(std::move(row));
  }
  table.notes = {"A change is in the second column if its 95 % confidence interval does not contain zero, in "
                 "the third if "
                 "the whole interval is within 10 %, which goes before, else in the fourth."};
  return table;
}

std::string changes_words(const std::vector<Change> &changes) {
  std::vector<std::string> found;
  std::size_t count = 0;
  for (const Change &change : changes)
    for (std::size_t q = 0; q < box_quantities.size(); ++q)
      if (change.of[q]) {
        ++count;
        if (change.of[q]->significant())
          found.push_back(fmt::format("{} with {}", box_quantities[q].name, change.what));
      }
  if (count == 0) return "There is no comparison yet: it takes two seeds.";
  return fmt::format("{} of {} changes leave the scatter of the seeds, where chance alone makes {:.0f}{}{}.",
                     found.size(), count, 0.05 * static_cast<double>(count), found.empty() ? "" : ": ",
                     fmt::join(found, "; "));
}

} // namespace

void write_box_page(const std::filesystem::path &out, const std::string &beds,
                    const std::vector<BoxRun> &runs, const std::vector<BedComparison> &comparisons,
                    const std::vector<std::string> &failures) {
  const std::vector<Change> changes = changes_of(runs, comparisons);
  Page page(out, "What the box does", Scene::bed);
  page.answer(fmt::format(
      "A roller on beds of several seeds ({}) in boxes of several widths and depths, with rigid walls "
      "and with floor and sides that absorb waves.",
      beds));
  page.answer(changes_words(changes));
  for (const std::string &failure : failures)
    page.answer("Missing: " + failure);
  page.section("Conclusions");
  page.table(conclusion_table(changes));
  page.section("Changes");
  page.table(change_table(changes));
  page.figure(size_figure(runs, &BoxRun::width, &BoxRun::depth, "width", 1));
  page.figure(size_figure(runs, &BoxRun::depth, &BoxRun::width, "depth", 2));
  page.section("Means");
  page.table(mean_table(runs));
  page.write();
}

} // namespace drumlin::post
