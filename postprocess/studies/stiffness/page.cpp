#include "studies/stiffness/results.h"

#include "pages/figure_data.h"
#include "pages/page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace {

/// Share of the variance of the force below which a linear law is said to fit badly.
constexpr double good_fit = 0.9;

/// What is drawn over a variable.
struct LawQuantity {
  const char *label; ///< with unit
  double BedLaw::*value;
  std::vector<double> LawLevel::*values; ///< over the seeds
  double scale;                          ///< from SI to the label's unit
  bool has_mean;                         ///< R2 has none: its values crowd below 1
};
const std::array<LawQuantity, 3> law_quantities = {{{"k [MN/m per m]", &BedLaw::k, &LawLevel::k, 1e-6, true},
                                                    {"D [-]", &BedLaw::D, &LawLevel::D, 1.0, true},
                                                    {"R^2 [-]", &BedLaw::r2, &LawLevel::r2, 1.0, false}}};

std::string interval_text(const MeanInterval &interval, double scale) {
  return fmt::format("{:.3g} ± {:.2g}", scale * interval.mean, scale * interval.half_width);
}

std::string mean_text(const std::vector<double> &values, double scale) {
  return values.empty() ? no_value : interval_text(mean_interval(values), scale);
}

std::string change_text(const std::optional<MeanInterval> &change, double scale) {
  if (!change) return no_value;
  return fmt::format("{:+.3g} ± {:.2g}{}", scale * change->mean, scale * change->half_width,
                     change->significant() ? " *" : "");
}

double mean_of(const std::vector<BedLaw> &runs, double BedLaw::*value) {
  double sum = 0.0;
  for (const BedLaw &run : runs)
    sum += run.*value;
  return sum / static_cast<double>(runs.size());
}

/// How many of the runs have each answer: "no 3, cannot be told 2".
std::string pull_text(const std::vector<BedLaw> &runs) {
  std::vector<std::string> parts;
  for (const char *answer : {"yes", "no", "cannot be told", "none"})
    if (const auto count = std::count_if(runs.begin(), runs.end(),
                                         [answer](const BedLaw &run) { return run.pulls == answer; }))
      parts.push_back(fmt::format("{} {}", answer, count));
  return fmt::format("{}", fmt::join(parts, ", "));
}

PageTable level_table(const std::vector<BedLaw> &laws, const LawVariable &variable) {
  PageTable table;
  table.name = fmt::format("over_{}", variable.name);
  table.title = fmt::format("Over {}", variable.title);
  table.text_columns = 0;
  table.header = {variable.label,
                  "seeds",
                  "k [MN/m per m]",
                  "D [-]",
                  "R2, median [-]",
                  "R2, lowest [-]",
                  "change of k [MN/m per m]",
                  "change of D [-]",
                  "share of time in contact [-]",
                  "peak force [kN/m]",
                  "does the contact pull"};
  for (const LawLevel &level : levels_of(laws, variable))
    table.add({fmt::format("{:.3g}", variable.scale * level.value), std::to_string(level.runs.size()),
               mean_text(level.k, 1e-6), mean_text(level.D, 1.0),
               level.r2.empty() ? no_value : fmt::format("{:.3f}", median(level.r2)),
               level.r2.empty() ? no_value
                                : fmt::format("{:.3f}", *std::min_element(level.r2.begin(), level.r2.end())),
               change_text(level.k_change, 1e-6), change_text(level.D_change, 1.0),
               fmt::format("{:.2f}", mean_of(level.runs, &BedLaw::contact_share)),
               fmt::format("{:.3g}", 1e-3 * mean_of(level.runs, &BedLaw::peak_force)),
               pull_text(level.runs)});
  table.notes = {seed_by_seed_note("changes are those from the default run on the same seed")};
  return table;
}

/// Range of the values of all seeds and of the intervals, with a margin.
std::string range_of(const std::vector<LawLevel> &levels, const LawQuantity &quantity) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const LawLevel &level : levels) {
    for (const double value : level.*quantity.values) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
    if (!quantity.has_mean || (level.*quantity.values).size() < 2) continue;
    const MeanInterval mean = mean_interval(level.*quantity.values);
    low = std::min(low, mean.mean - mean.half_width);
    high = std::max(high, mean.mean + mean.half_width);
  }
  const double margin = 0.05 * (high - low);
  return axis_range(quantity.scale * (low - margin), quantity.scale * (high + margin));
}

PageFigure level_figure(const std::vector<BedLaw> &laws, const LawVariable &variable, int number) {
  const std::string name = variable.name;
  PageFigure figure;
  figure.label = fmt::format("Fig. {}", number);
  figure.caption = fmt::format("Stiffness k, damping ratio D and R2 of the identified law over {}. Squares: "
                               "mean over the seeds with its "
                               "95 % confidence interval; circles: single seeds.",
                               variable.title);
  figure.weight = number == 1 ? 2.0 : number == 2 ? 1.0 : 0.0;
  figure.figure = {name, fmt::format("k, D and R2 over {}", variable.title), {}, 3};
  CurveTable table(fmt::format("{},value,low,high", variable.label));
  const std::vector<LawLevel> levels = levels_of(laws, variable);
  for (const LawQuantity &quantity : law_quantities) {
    const std::string symbol = std::string(quantity.label).substr(0, 1); // k, D, R
    Panel panel;
    panel.x_label = variable.label;
    panel.y_label = quantity.label;
    panel.y_range = range_of(levels, quantity);
    const double reach = variable.scale * 0.1 * (levels.back().value - levels.front().value);
    panel.x_range = axis_range(variable.scale * levels.front().value - reach,
                               variable.scale * levels.back().value + reach);
    for (const LawLevel &level : levels) {
      for (const BedLaw &run : level.runs)
        table.row(symbol + " of a seed",
                  {variable.scale * level.value, quantity.scale * run.*quantity.value});
      if (!quantity.has_mean || (level.*quantity.values).empty()) continue;
      const MeanInterval mean = mean_interval(level.*quantity.values);
      table.row(symbol + " mean", {variable.scale * level.value, quantity.scale * mean.mean,
                                   quantity.scale * (mean.mean - mean.half_width),
                                   quantity.scale * (mean.mean + mean.half_width)});
    }
    const auto add = [&](const std::string &what, const char *title, const char *y, CurveStyle style) {
      panel.curves.push_back(curve(name, symbol + what, "$2", y, style));
      panel.curves.back().title = title;
    };
    if (quantity.has_mean) add(" mean", "mean", "3:4:5", CurveStyle::spread);
    add(" of a seed", "seeds", "3", CurveStyle::direct_a);
    figure.figure.panels.push_back(panel);
  }
  figure.csv = table.text();
  return figure;
}

/// "amplitude of the force 14.7 kN/m".
std::string value_words(const LawVariable &variable, double value) {
  const std::string label = variable.label;
  const std::size_t unit = label.find(" [");
  return fmt::format("{} {:.3g} {}", label.substr(0, unit), variable.scale * value,
                     label.substr(unit + 2, label.size() - unit - 3));
}

/// The changes that leave the scatter of the seeds, and how many were looked at.
std::string changes_words(const std::vector<BedLaw> &laws) {
  std::vector<std::string> found;
  std::size_t changes = 0;
  for (const LawVariable &variable : law_variables)
    for (const LawLevel &level : levels_of(laws, variable)) {
      const auto look = [&](const std::optional<MeanInterval> &change, double scale, const char *words) {
        if (!change) return;
        ++changes;
        if (change->significant())
          found.push_back(fmt::format(fmt::runtime(words), scale * change->mean, scale * change->half_width) +
                          " at " + value_words(variable, level.value));
      };
      look(level.k_change, 1e-6, "k by {:+.2g} ± {:.2g} MN/m per m");
      look(level.D_change, 1.0, "D by {:+.2g} ± {:.2g}");
    }
  return fmt::format(
      "{} of {} changes from the default run leave the scatter of the seeds (by chance alone, one "
      "of twenty does){}{}.",
      found.size(), changes, found.empty() ? "" : ": ", fmt::join(found, "; "));
}

void answer(Page &page, const std::string &beds, const std::vector<BedLaw> &laws) {
  page.answer(fmt::format(
      "A roller on beds of several seeds ({}): the stiffness k and the damping ratio D that identification "
      "finds in the motion of drum and frame, while static load, force amplitude or frequency differs from "
      "the deck's default.",
      beds));
  std::vector<double> r2, widths;
  std::size_t bad = 0, without = 0;
  for (const BedLaw &law : laws) {
    if (!std::isfinite(law.k) || !std::isfinite(law.D)) ++without;
    if (std::isfinite(law.k)) widths.push_back(std::fabs(law.k_half_width / law.k));
    if (!std::isfinite(law.r2)) continue;
    r2.push_back(law.r2);
    bad += law.r2 < good_fit ? 1 : 0;
  }
  std::vector<BedLaw> base;
  std::copy_if(laws.begin(), laws.end(), std::back_inserter(base),
               [](const BedLaw &law) { return law.run == default_run; });
  if (r2.empty() || base.empty()) {
    page.answer("No record gave a law yet.");
    return;
  }
  for (const LawLevel &level : levels_of(base, law_variables[0]))
    page.answer(
        fmt::format("The default has k = {} MN/m per metre of width and D = {} (means of {} seeds with "
                    "95 % confidence intervals).",
                    mean_text(level.k, 1e-6), mean_text(level.D, 1.0), level.runs.size()));
  page.answer(changes_words(laws));
  page.answer(
      fmt::format("A spring and a dashpot explain {:.0f} to {:.0f} % of the variance of the contact "
                  "force; in {} of {} records less than {:.0f} %, where k and D describe the loop badly.",
                  100.0 * *std::min_element(r2.begin(), r2.end()),
                  100.0 * *std::max_element(r2.begin(), r2.end()), bad, laws.size(), 100.0 * good_fit));
  page.answer(fmt::format("The interval of k that a single record gives has a half width of {:.0f} % in the "
                          "median; {} records give no positive k.",
                          100.0 * median(widths), without));
}

} // namespace

void write_stiffness_page(const std::filesystem::path &out, const std::string &beds,
                          const std::vector<BedLaw> &laws, const std::vector<std::string> &failures) {
  Page page(out, "Stiffness and damping of a bed under a roller", Scene::bed);
  answer(page, beds, laws);
  for (const std::string &failure : failures)
    page.answer("Missing: " + failure);
  page.section("How to read it");
  page.paragraph(
      "Each record is identified as `drumlin identify` does it: contact force from the equations of motion "
      "of "
      "drum and frame, and the line F = -k x - c v that fits it best over all contacts of the record, where "
      "the position at which each contact begins is unknown and forces below 20 % of the largest one are not "
      "fitted. D = c / (2 sqrt(m2 k)) with the mass m2 of the drum. R2 is taken about the mean of all fitted "
      "forces, with the positions fitted contact by contact.");
  page.paragraph("The static load is the weight of drum and frame; it is varied by the mass of the frame, "
                 "and the roller "
                 "is placed anew with it. The amplitude of the force is the same at all frequencies.");
  int number = 0;
  for (const LawVariable &variable : law_variables) {
    if (levels_of(laws, variable).empty()) continue;
    page.section(fmt::format("Over {}", variable.title));
    page.figure(level_figure(laws, variable, ++number));
    page.table(level_table(laws, variable));
  }
  page.write();
}

} // namespace drumlin::post
