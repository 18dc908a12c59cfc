#include "experiment/page.h"

#include "pages/figure.h"
#include "pages/page.h"
#include "support/statistics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

namespace drumlin::post {

namespace {

/// A name of the plan as gnuplot must be given it to draw it unchanged: an underscore alone makes the next
/// letter a subscript.
std::string as_written(const std::string &name) {
  std::string label;
  for (const char c : name)
    label += c == '_' ? std::string("\\_") : std::string(1, c);
  return label;
}

std::string with_unit(const std::string &label, const std::string &unit) {
  return unit == "-" ? label : fmt::format("{} [{}]", label, unit);
}

/// The unit of a quantity's changes, and the factor to it.
std::string change_unit(const Quantity &quantity) { return quantity.absolute ? quantity.shown_unit : "%"; }
std::string change_with_unit(const std::string &change, const Quantity &quantity) {
  const std::string unit = change_unit(quantity);
  return unit == "-" ? change : change + " " + unit;
}
double change_scale(const Quantity &quantity) { return quantity.absolute ? quantity.scale : 100.0; }

/// A number with so many significant digits, or all of those before the point, and no exponent where it is
/// not needed.
std::string rounded(double value, int digits, bool with_sign = false) {
  constexpr double most = 1e7;
  const bool whole = std::fabs(value) >= std::pow(10.0, digits) && std::fabs(value) < most;
  const std::string text = whole ? fmt::format("{:.0f}", value) : fmt::format("{:.{}g}", value, digits);
  return (with_sign && !(value < 0.0) ? "+" : "") + text;
}

/// "MEAN +- HALF WIDTH": both with as many decimals as give the half width two digits, and with none if it is
/// 10 or more.
std::string interval_text(const MeanInterval &interval, double scale, bool with_sign = false) {
  const double mean = scale * interval.mean, half_width = scale * interval.half_width;
  if (!std::isfinite(half_width)) return rounded(mean, 3, with_sign) + " (one)";
  constexpr double least = 1e-6, most = 1e7; // beyond them numbers have exponents
  if (!(half_width >= least && std::max(half_width, std::fabs(mean)) < most))
    return fmt::format("{} ± {}", rounded(mean, 3, with_sign), rounded(half_width, 2));
  const int decimals = std::max(0, 1 - static_cast<int>(std::floor(std::log10(half_width))));
  const std::string text = fmt::format("{:.{}f}", mean, decimals);
  const bool is_zero = text.find_first_of("123456789") == std::string::npos; // which has no sign
  const std::string sign = with_sign && !is_zero && mean > 0.0 ? "+" : "";
  return fmt::format("{}{} ± {:.{}f}", sign, is_zero ? fmt::format("{:.{}f}", 0.0, decimals) : text,
                     half_width, decimals);
}

std::string change_text(const std::optional<Change> &change, const Quantity &quantity) {
  if (!change) return no_value;
  const MeanInterval &shown = change->shown(quantity);
  return interval_text(shown, change_scale(quantity), true) + (shown.significant() ? " *" : "");
}

std::string cost_text(double ratio) { return std::isfinite(ratio) ? fmt::format("{:.2g}", ratio) : no_value; }

enum class Verdict { changes, negligible, undecided };

Verdict verdict_of(const Change &change, const Quantity &quantity) {
  const MeanInterval &shown = change.shown(quantity);
  if (shown.within(quantity.tolerance)) return Verdict::negligible;
  return shown.significant() ? Verdict::changes : Verdict::undecided;
}

std::string joined_cells(const std::vector<std::string> &cells) {
  return cells.empty() ? "-" : fmt::format("{}", fmt::join(cells, "; "));
}

PageTable conclusion_table(const Plan &plan, const std::vector<Effect> &effects) {
  PageTable table;
  table.name = "needs";
  table.title = "What each quantity depends on";
  table.text_columns = 4;
  table.header = {"quantity", "it changes with", "it hardly changes with", "not decided by these seeds"};
  for (std::size_t q = 0; q < plan.quantities.size(); ++q) {
    const Quantity &quantity = plan.quantities[q];
    std::array<std::vector<std::string>, 3> cells;
    for (const Effect &effect : effects) {
      if (!effect.changes[q]) continue;
      const std::string cost =
          std::isfinite(effect.cost) ? fmt::format(", time x {:.2g}", effect.cost) : std::string();
      cells[static_cast<std::size_t>(verdict_of(*effect.changes[q], quantity))].push_back(fmt::format(
          "{} ({}{})", effect.compared->words,
          change_with_unit(rounded(change_scale(quantity) * effect.changes[q]->shown(quantity).mean, 2, true),
                           quantity),
          cost));
    }
    table.add({quantity.label, joined_cells(cells[0]), joined_cells(cells[1]), joined_cells(cells[2])});
  }
  table.notes = {
      "In brackets: the mean change, and the processor time over that of what it is compared with.",
      "A quantity hardly changes if the whole 95 % confidence interval of its change is within 10 % of what "
      "it is compared with; if its changes are given in its unit, within a tenth of the largest mean of a "
      "scene (settlement per cycle: 1 mm). It changes if the interval is not, and does not contain zero."};
  return table;
}

PageTable effect_table(const Plan &plan, const std::vector<Effect> &effects) {
  PageTable table;
  table.name = "effects";
  table.title = "Changes";
  table.text_columns = 4;
  table.header = {"row", "what differs", "scene", "compared with", "runs"};
  for (const Quantity &quantity : plan.quantities)
    table.header.push_back(fmt::format("{} ({})", quantity.label, change_unit(quantity)));
  table.header.emplace_back("processor time (ratio)");
  for (const Effect &effect : effects) {
    const auto &pairs = effect.compared->pairs;
    std::vector<std::string> row = {
        std::to_string(table.rows.size() + 1), effect.compared->words,
        pairs.size() == 1 ? pairs[0].first : fmt::format("{} scenes", pairs.size()),
        pairs.size() == 1 ? pairs[0].second : fmt::format("{} scenes", pairs.size()),
        std::to_string(effect.seeds)};
    for (std::size_t q = 0; q < plan.quantities.size(); ++q)
      row.push_back(change_text(effect.changes[q], plan.quantities[q]));
    row.push_back(cost_text(effect.cost));
    table.add(std::move(row));
  }
  table.notes = {
      "Mean change and half of its 95 % confidence interval (Student's t), in percent of the mean of what it "
      "is compared with (none if that is zero), or in the unit of a quantity that can be about zero. * "
      "marks changes whose interval does not contain zero; by chance alone one of twenty has it.",
      "Changes are taken seed by seed, so that what two scenes on beds of one seed share cancels."};
  if (std::any_of(effects.begin(), effects.end(), [](const Effect &one) { return !one.compared->paired; }))
    table.notes.emplace_back("Where the beds of two scenes have nothing in common, the change is the "
                             "difference of the means, with the scatter of both (Welch).");
  return table;
}

/// Of the quantities without known values: the others have tables of their own.
PageTable mean_table(const std::vector<Quantity> &quantities, const Results &results) {
  PageTable table;
  table.name = "means";
  table.title = "Means over the seeds";
  table.header = {"scene", "seeds"};
  for (const Quantity &quantity : quantities)
    table.header.push_back(with_unit(quantity.label, quantity.shown_unit));
  table.header.emplace_back("processor time [s]");
  for (const std::string &scene : results.scenes()) {
    std::size_t seeds = 0;
    std::vector<std::string> cells;
    for (const Quantity &quantity : quantities) {
      const std::vector<double> values = numbers(results.values(scene, quantity.name));
      seeds = std::max(seeds, values.size());
      cells.push_back(values.empty() ? no_value : interval_text(mean_interval(values), quantity.scale));
    }
    const std::vector<double> costs = numbers(results.costs(scene));
    cells.push_back(costs.empty() ? no_value : fmt::format("{:.3g}", mean_interval(costs).mean));
    cells.insert(cells.begin(), {scene, std::to_string(seeds)});
    table.add(std::move(cells));
  }
  table.notes = {"After the ±: half of the 95 % confidence interval of the mean; (one): of a single seed."};
  return table;
}

constexpr const char *between_engines = "LAMMPS - LIGGGHTS";

/// The largest errors of each family of scenes, and the page's acceptance criteria.
struct KnownValues {
  PageTable summary, all;
  std::vector<Acceptance> criteria;
};

KnownValues known_values(const Plan &plan, const std::vector<Judged> &rows) {
  const bool twins = plan.between_engines > 0.0;
  const std::string last = twins ? fmt::format(" | {}", between_engines) : "";
  KnownValues known{{"summary", "Largest error of each quantity",
                     "scene | quantity | compared with | runs | largest error | tolerance" + last, 3},
                    {"values", "All known values",
                     "scene | quantity | compared with | known value | found | error | tolerance" + last, 3},
                    {}};
  known.summary.criterion = known.all.criterion = "values are within the tolerance";
  const auto add = [&](PageTable &table, std::vector<std::string> cells, const Judged &row, double error,
                       double difference, bool holds) {
    cells.push_back(fmt::format("{:.1e}", error));
    cells.push_back(fmt::format("{:.3g}", row.expected->tolerance));
    if (twins) cells.push_back(fmt::format("{:.1e}", difference));
    table.add(cells, holds ? RowState::agrees : RowState::differs);
  };
  for (auto first = rows.begin(); first != rows.end();) {
    const std::string &family = first->scene->family;
    const auto end =
        std::find_if(first, rows.end(), [&](const Judged &row) { return row.scene->family != family; });
    double share = 0.0; // of the tolerance
    bool all_hold = true;
    std::set<std::pair<std::string, std::string>> seen;
    for (auto row = first; row != end; ++row) {
      const Expected &expected = *row->expected;
      const Quantity &quantity =
          *std::find_if(plan.quantities.begin(), plan.quantities.end(),
                        [&](const Quantity &one) { return one.name == expected.quantity; });
      const std::string label = with_unit(quantity.label, quantity.shown_unit);
      share = std::max(share, row->error / expected.tolerance);
      all_hold = all_hold && row->holds;
      add(known.all,
          {row->scene->name, label, expected.source, fmt::format("{:.7g}", quantity.scale * expected.value),
           fmt::format("{:.7g}", quantity.scale * row->found)},
          *row, row->error, row->difference, row->holds);
      if (!seen.insert({expected.quantity, expected.source}).second) continue;
      int runs = 0;
      double error = 0.0, difference = 0.0;
      bool holds = true;
      for (auto other = row; other != end; ++other) {
        if (other->expected->quantity != expected.quantity || other->expected->source != expected.source)
          continue;
        ++runs;
        error = std::max(error, other->error);
        difference = std::max(difference, other->difference);
        holds = holds && other->holds;
      }
      add(known.summary, {family, label, expected.source, std::to_string(runs)}, *row, error, difference,
          holds);
    }
    known.criteria.push_back({family + ": every known value within its tolerance",
                              fmt::format("error at most {:.2f} of it", share), all_hold});
    first = end;
  }
  known.all.notes = {"Errors are the difference over a scale of the quantity, where it has one."};
  return known;
}

/// The lowest and the highest of what a panel shows.
class Reach {
public:
  void add(double value) {
    if (!std::isfinite(value)) return;
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
  }
  void add(const MeanInterval &interval, double scale) {
    add(scale * (interval.mean - interval.half_width));
    add(scale * (interval.mean + interval.half_width));
  }
  std::string range(double margin) const {
    return axis_range(low_ - margin * (high_ - low_), high_ + margin * (high_ - low_));
  }
  double length() const { return high_ - low_; }

private:
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
};

void add_interval(CurveTable &table, const std::string &curve, double x, const MeanInterval &interval,
                  double scale) {
  table.row(curve, {x, scale * interval.mean, scale * (interval.mean - interval.half_width),
                    scale * (interval.mean + interval.half_width)});
}

PageFigure effect_figure(const Plan &plan, const std::vector<Effect> &effects) {
  const std::string name = "changes";
  PageFigure figure;
  figure.label = "Fig. 1";
  figure.weight = 1.0;
  figure.caption = "Change in each row of the table of changes: mean over the seeds and its 95 % confidence "
                   "interval. A bar that crosses zero is not significant.";
  figure.figure = {name, "Changes", {}, 2};
  CurveTable table("row,change,low,high");
  for (std::size_t q = 0; q < plan.quantities.size(); ++q) {
    const Quantity &quantity = plan.quantities[q];
    Panel panel{
        quantity.label, "row of the table of changes", fmt::format("change [{}]", change_unit(quantity)), {}};
    Reach reach;
    reach.add(0.0);
    for (std::size_t n = 0; n < effects.size(); ++n) {
      panel.x_ticks.push_back(std::to_string(n + 1));
      if (!effects[n].changes[q]) continue;
      const MeanInterval &change = effects[n].changes[q]->shown(quantity);
      reach.add(change, change_scale(quantity));
      add_interval(table, quantity.name, static_cast<double>(n + 1), change, change_scale(quantity));
    }
    // A range for each panel: by default gnuplot takes that of all rows of the file.
    panel.y_range = reach.range(0.1);
    panel.add(curve(name, quantity.name, "$2", "3:4:5", CurveStyle::spread), "");
    figure.figure.panels.push_back(panel);
  }
  figure.csv = table.text();
  return figure;
}

/// The scenes that a figure over an axis shows: those with a place on it and, on all other axes, the place of
/// the first of them.
std::vector<const Scene *> scenes_over(const Plan &plan, const std::string &axis) {
  std::vector<const Scene *> scenes;
  for (const Scene &scene : plan.scenes) {
    if (scene.at.count(axis) == 0) continue;
    auto others = scene.at, first = scenes.empty() ? scene.at : scenes.front()->at;
    others.erase(axis);
    first.erase(axis);
    if (others == first) scenes.push_back(&scene);
  }
  return scenes;
}

constexpr std::array series_styles = {CurveStyle::direct_a, CurveStyle::direct_b, CurveStyle::measured_a,
                                      CurveStyle::measured_b, CurveStyle::series_5};

/// The names of the series of some scenes, the first ones.
std::vector<std::string> series_of(const std::vector<const Scene *> &scenes) {
  std::vector<std::string> names;
  for (const Scene *scene : scenes)
    if (std::find(names.begin(), names.end(), scene->series) == names.end() &&
        names.size() < series_styles.size())
      names.push_back(scene->series);
  return names;
}

/// Stem of the files of the figure over an axis.
std::string figure_name(const Axis &axis) { return "over_" + axis.name; }

constexpr std::array published_styles = {CurveStyle::measured_a, CurveStyle::measured_b};
constexpr std::array known_styles = {CurveStyle::condition_b, CurveStyle::condition_a, CurveStyle::limit,
                                     CurveStyle::plain, CurveStyle::line_5};

/// Whether a panel has a curve of that name in its legend.
bool shows(const Panel &panel, const std::string &name) {
  return std::any_of(panel.curves.begin(), panel.curves.end(),
                     [&name](const Curve &one) { return one.title == name; });
}

void add_published(Panel &panel, const Quantity &quantity, const Axis &axis,
                   const std::vector<PublishedPoint> &points, CurveTable &table) {
  std::size_t sources = 0;
  for (const PublishedPoint &point : points) {
    if (point.axis != axis.name || point.quantity != quantity.name) continue;
    const std::string name = fmt::format("{} {} {}", quantity.name, point.series, point.source);
    const std::string words = fmt::format("published, {}, {}", point.series, point.source);
    table.row(name, {point.at, quantity.scale * point.value});
    if (!shows(panel, words) && sources < published_styles.size())
      panel.add(curve(figure_name(axis), name, "$2", "3", published_styles[sources++]), words);
  }
}

/// A quantity over an axis: single seeds of all series, and means of the first one.
Panel axis_panel(const Quantity &quantity, const Axis &axis, const std::vector<const Scene *> &scenes,
                 const Results &results, const std::vector<PublishedPoint> &published, CurveTable &table) {
  const std::vector<std::string> series = series_of(scenes);
  Panel panel{"", as_written(axis.label), as_written(with_unit(quantity.label, quantity.shown_unit)), {}};
  Reach across, up;
  for (const Scene *scene : scenes)
    across.add(scene->at.at(axis.name));
  panel.log_x = panel.log_y = axis.is_log;
  if (!axis.is_log) panel.x_range = across.range(0.1);
  for (std::size_t s = 0; s < series.size(); ++s) {
    const std::string name = fmt::format("{} {}", quantity.name, s + 1);
    // Beside each other, so that none hides another.
    const double aside = axis.is_log ? 0.0 : 0.02 * across.length() * static_cast<double>(s);
    for (const Scene *scene : scenes) {
      const std::vector<double> values = numbers(results.values(scene->name, quantity.name));
      if (scene->series != series[s] || values.empty()) continue;
      const double x = scene->at.at(axis.name) + aside;
      for (const double value : values) {
        table.row(name, {x, quantity.scale * (axis.is_log ? std::fabs(value) : value)});
        up.add(quantity.scale * value);
      }
      const MeanInterval mean = mean_interval(values);
      if (s > 0 || !std::isfinite(mean.half_width)) continue;
      up.add(mean, quantity.scale);
      add_interval(table, name + " mean", x, mean, quantity.scale);
    }
    const std::string words = series[s].empty() ? "seeds" : series[s];
    if (s == 0) {
      panel.add(curve(figure_name(axis), name + " mean", "$2", "3:4:5", CurveStyle::spread),
                series[s].empty() ? "mean" : "mean, " + words);
    }
    panel.add(curve(figure_name(axis), name, "$2", "3", series_styles[s]), words);
    for (const Scene *scene : scenes)
      if (const Expected *known = known_value(*scene, quantity.name);
          known != nullptr && scene->series == series[s] && scene->twin.empty() &&
          !(axis.is_log && known->value == 0.0)) {
        table.row(name + " known", {scene->at.at(axis.name) + aside, quantity.scale * known->value});
        up.add(quantity.scale * known->value);
        if (!shows(panel, words + ", known"))
          panel.add(curve(figure_name(axis), name + " known", "$2", "3", known_styles[s]), words + ", known");
      }
  }
  add_published(panel, quantity, axis, published, table);
  if (!axis.is_log) panel.y_range = up.range(0.05);
  return panel;
}

PageFigure axis_figure(const Plan &plan, const Axis &axis, const Results &results, std::size_t number) {
  const std::vector<const Scene *> scenes = scenes_over(plan, axis.name);
  PageFigure figure;
  figure.label = fmt::format("Fig. {}", number);
  figure.weight = 2.0 + 1.0 / static_cast<double>(number);
  figure.caption = fmt::format("All quantities over {}. Squares: mean over the seeds and its 95 % confidence "
                               "interval; other marks: single seeds.",
                               axis.label);
  figure.figure = {figure_name(axis), "Over " + axis.label, {}, 3};
  CurveTable table("place,value,low,high");
  for (const Quantity &quantity : plan.quantities)
    if (!plan.knows(quantity.name) || std::any_of(scenes.begin(), scenes.end(), [&](const Scene *scene) {
          return known_value(*scene, quantity.name) != nullptr;
        }))
      figure.figure.panels.push_back(axis_panel(quantity, axis, scenes, results, plan.published, table));
  figure.csv = table.text();
  return figure;
}

/// The orders with which errors fall over the logarithmic axes, and where they keep to a value.
PageTable order_table(const Plan &plan, const Results &results) {
  constexpr std::array targets = {1e-2, 1e-3, 1e-4, 1e-5};
  PageTable table(
      "orders", "Orders of convergence",
      "quantity | over | series | order [-] | scatter [decades] | fitted from | to | order of the "
      "finer half [-]",
      3);
  for (const double target : targets)
    table.header.push_back(fmt::format("{:g} from", target));
  for (const Axis &axis : plan.axes) {
    if (!axis.is_log) continue;
    const std::vector<const Scene *> scenes = scenes_over(plan, axis.name);
    for (const Quantity &quantity : plan.quantities) {
      if (std::count(plan.errors.begin(), plan.errors.end(), quantity.name) == 0) continue;
      for (const std::string &series : series_of(scenes)) {
        std::vector<ErrorPoint> points;
        for (const Scene *scene : scenes)
          if (const std::vector<double> values = numbers(results.values(scene->name, quantity.name));
              scene->series == series && !values.empty())
            points.push_back({scene->at.at(axis.name), std::fabs(mean_interval(values).mean)});
        if (points.empty()) continue;
        std::sort(points.begin(), points.end(),
                  [](const ErrorPoint &a, const ErrorPoint &b) { return a.steps < b.steps; });
        // Coarser steps than those of an error of 1 % need not be in the asymptotic range.
        const std::optional<double> from = steps_needed(points, targets.front());
        const auto fit = from ? fitted_order(points, *from) : std::nullopt;
        const auto finer = fitted_order(points, finer_half(points));
        const auto cell = [](const auto &found, const char *form, double FittedOrder::*value) {
          return found ? fmt::format(fmt::runtime(form), *found.*value) : std::string(no_value);
        };
        std::vector<std::string> row = {quantity.label,
                                        axis.label,
                                        series,
                                        cell(fit, "{:.2f}", &FittedOrder::order),
                                        cell(fit, "{:.2f}", &FittedOrder::scatter),
                                        cell(fit, "{:g}", &FittedOrder::from),
                                        cell(fit, "{:g}", &FittedOrder::to),
                                        cell(finer, "{:.2f}", &FittedOrder::order)};
        for (const double target : targets) {
          const std::optional<double> needed = steps_needed(points, target);
          row.push_back(needed ? fmt::format("{:g}", *needed) : fmt::format("> {:g}", points.back().steps));
        }
        table.add(row);
      }
    }
  }
  table.notes = {"Order: error ~ place^-order, fitted where the error is 1 % and smaller; scatter: root mean "
                 "square distance from that line. Finer half: fitted over the finer half of the axis. Last "
                 "columns: the smallest place from which on all larger ones have at most that error; > N: "
                 "not at N."};
  return table;
}

std::string effects_words(const std::vector<Effect> &effects, const std::vector<Quantity> &quantities) {
  if (effects.empty()) return "There is no comparison yet.";
  std::size_t changes = 0, all = 0;
  for (const Effect &effect : effects)
    for (std::size_t q = 0; q < quantities.size(); ++q) {
      if (!effect.changes[q]) continue;
      ++all;
      if (verdict_of(*effect.changes[q], quantities[q]) == Verdict::changes) ++changes;
    }
  constexpr double by_chance = 0.05; // outside of a 95 % interval
  return fmt::format(
      "Changes of one quantity between two scenes: {}, of them {} larger than the scatter of the "
      "seeds (95 % confidence interval without zero), where by chance {} would be. The first table says "
      "which.",
      all, changes, rounded(by_chance * static_cast<double>(all), 1));
}

std::string cost_words(const Plan &plan, const Results &results) {
  double sum = 0.0;
  std::size_t runs = 0;
  for (const Scene &scene : plan.scenes)
    for (const double cost : numbers(results.costs(scene.name))) {
      sum += cost;
      ++runs;
    }
  constexpr double minute = 60.0;
  std::string words =
      fmt::format("{} runs of {} scenes took {} {} of processor time", runs, results.scenes().size(),
                  rounded(sum < minute ? sum : sum / minute, 2), sum < minute ? "s" : "min");
  if (const std::optional<SoilBed> &bed = plan.scenes.front().bed)
    words +=
        fmt::format("; to make their beds took more. The first scene has {} balls in a box {:.3g} m wide",
                    bed->balls(), bed->packing.width);
  return words + ".";
}

} // namespace

void write_experiment_page(const std::filesystem::path &out, Plan plan, const Results &results,
                           const std::vector<std::string> &failures) {
  plan.quantities = as_shown(std::move(plan.quantities), results);
  const std::vector<Effect> effects = effects_of(plan, results);
  Page page(out, plan.title, plan.scenes.front().bed ? std::optional(Drawing::bed) : std::nullopt);
  for (const std::string &sentence : plan.about)
    page.answer(sentence);
  const std::vector<Judged> rows = judged(plan, results);
  const KnownValues known = known_values(plan, rows);
  page.answer(known.criteria);
  if (rows.empty() || !effects.empty()) page.answer(effects_words(effects, plan.quantities));
  page.answer(cost_words(plan, results));
  for (const std::string &failure : failures)
    page.answer("Missing: " + failure);
  std::size_t figures = 0;
  if (!effects.empty()) {
    page.section("Conclusions");
    page.table(conclusion_table(plan, effects));
    page.section("Changes");
    page.table(effect_table(plan, effects));
    ++figures;
    page.figure(effect_figure(plan, effects));
  }
  for (const Axis &axis : plan.axes) {
    if (scenes_over(plan, axis.name).empty()) continue;
    page.section("Over " + axis.label);
    page.figure(axis_figure(plan, axis, results, ++figures));
  }
  if (!plan.errors.empty()) {
    page.section("Orders of convergence");
    page.table(order_table(plan, results));
  }
  if (!rows.empty()) {
    page.section("Known values");
    page.table(acceptance_table(known.criteria));
    page.table(known.summary);
  }
  std::vector<Quantity> others;
  for (const Quantity &quantity : plan.quantities)
    if (!plan.knows(quantity.name)) others.push_back(quantity);
  if (!others.empty()) {
    page.section("Means");
    page.table(mean_table(others, results));
  }
  if (!plan.notes.empty()) page.section("How to read it");
  for (const std::string &note : plan.notes)
    page.paragraph(note);
  if (!rows.empty()) {
    page.section("All known values");
    page.table(known.all);
  }
  page.write();
}

} // namespace drumlin::post
