#include "calibration/page.h"

#include "pages/figure.h"
#include "pages/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>

namespace drumlin::post {

namespace {

/// A target's values over the seeds at an evaluation: their geometric mean and its 95 % confidence interval.
struct Measured {
  double mean, low, high;
};

Measured measured(const Evaluation &evaluation, std::size_t target) {
  std::vector<double> logs;
  for (const SeedResult &result : evaluation.seeds)
    logs.push_back(std::log(result.values[target]));
  const MeanInterval interval = mean_interval(logs);
  return {std::exp(interval.mean), std::exp(interval.mean - interval.half_width),
          std::exp(interval.mean + interval.half_width)};
}

std::string between(double low, double high) {
  return std::isfinite(high) ? fmt::format("{:.4g} to {:.4g}", low, high) : std::string(no_value);
}

PageTable parameter_table(const CalibrationTask &task, const Calibration &found) {
  PageTable table;
  table.name = "parameters";
  table.title = "Parameters";
  table.header = {"parameter", "best evaluation", "estimate", "95 % confidence interval", "range", "why not"};
  table.criterion = "identified by the targets";
  for (std::size_t i = 0; i < task.vary.size(); ++i) {
    const ParameterEstimate &one = found.sensitivity.parameters[i];
    table.add({task.vary[i].name, fmt::format("{:.4g}", found.best.point[i]),
               fmt::format("{:.4g}", one.value), between(one.low, one.high),
               between(task.vary[i].low, task.vary[i].high), one.unidentified},
              one.unidentified.empty() ? RowState::agrees : RowState::differs);
  }
  table.notes = {
      "The estimate meets the targets by the linear model around the best evaluation. Its interval is that "
      "of the scatter over the seeds (Student's t); errors of the linear model are not part of it."};
  return table;
}

PageTable target_table(const CalibrationTask &task, const Calibration &found) {
  PageTable table;
  table.name = "targets";
  table.title = "Targets at the best evaluation";
  table.header = {"target",         "wanted",       "measured", "95 % confidence interval",
                  "difference [%]", "tolerance [%]"};
  table.criterion = "within the tolerance";
  for (std::size_t i = 0; i < task.targets.size(); ++i) {
    const CalibrationTarget &target = task.targets[i];
    const Measured value = measured(found.best, i);
    const double off = std::log(value.mean / target.value);
    table.add({target.name, fmt::format("{:.4g}", target.value), fmt::format("{:.4g}", value.mean),
               between(value.low, value.high), fmt::format("{:+.2g}", 100.0 * std::expm1(off)),
               fmt::format("{:.2g}", 100.0 * target.tolerance)},
              std::fabs(off) <= target.tolerance ? RowState::agrees : RowState::differs);
  }
  return table;
}

PageTable slope_table(const CalibrationTask &task, const Calibration &found) {
  PageTable table;
  table.name = "slopes";
  table.title = "Slopes d ln(target) / d ln(parameter)";
  table.header = {"target"};
  for (const VariedParameter &parameter : task.vary)
    table.header.push_back(parameter.name);
  for (std::size_t i = 0; i < task.targets.size(); ++i) {
    std::vector<std::string> row = {task.targets[i].name};
    for (const MeanInterval &slope : found.sensitivity.slopes[i])
      row.push_back(
          fmt::format("{:+.3f} ± {:.2g}{}", slope.mean, slope.half_width, slope.significant() ? " *" : ""));
    table.add(row);
  }
  table.notes = {
      fmt::format("Least squares over {} evaluations, seed by seed; after the ±: half of the 95 % confidence "
                  "interval over the seeds. * marks intervals that do not contain zero.",
                  found.sensitivity.points)};
  return table;
}

PageTable correlation_table(const CalibrationTask &task, const Calibration &found) {
  PageTable table;
  table.name = "correlation";
  table.title = "Correlation of the estimates";
  table.header = {"parameter"};
  for (std::size_t i = 0; i < task.vary.size(); ++i) {
    table.header.push_back(task.vary[i].name);
    std::vector<std::string> row = {task.vary[i].name};
    for (const double value : found.sensitivity.correlation[i])
      row.push_back(fmt::format("{:+.3f}", value));
    table.add(row);
  }
  table.notes = {fmt::format("For errors of the targets in proportion to their tolerances. Above {} the "
                             "targets cannot tell two parameters apart.",
                             most_correlation)};
  return table;
}

PageFigure progress_figure(const CalibrationTask &task, const Calibration &found) {
  constexpr const char *name = "progress";
  PageFigure figure;
  figure.label = "Fig. 1";
  figure.caption = "Left: objective of the evaluations, in the order in which they were made, and the "
                   "smallest so far. Right: measured over wanted values, means over the seeds.";
  figure.weight = 2.0;
  figure.figure = {name, "The search", {}, 2};
  CurveTable data("evaluation,value");
  std::vector<const Evaluation *> good;
  for (const Evaluation &one : found.evaluations)
    if (one.good(task)) good.push_back(&one);
  // An axis of logarithms has no zero.
  const auto objective = [&task](const Evaluation &one) { return std::max(one.objective(task), 1e-9); };
  double least = std::numeric_limits<double>::infinity();
  for (const Evaluation *one : good)
    data.row("objective", {static_cast<double>(one->number), objective(*one)});
  for (const Evaluation *one : good) {
    least = std::min(least, objective(*one));
    data.row("smallest", {static_cast<double>(one->number), least});
  }
  for (std::size_t i = 0; i < task.targets.size(); ++i)
    for (const Evaluation *one : good)
      data.row(task.targets[i].name,
               {static_cast<double>(one->number), one->mean(i) / task.targets[i].value});
  figure.csv = data.text();
  Panel left{"", "evaluation", "objective [-]", {}};
  left.log_y = true;
  left.curves = {curve(name, "objective", "$2", "3", CurveStyle::direct_a),
                 curve(name, "smallest", "$2", "3", CurveStyle::condition_b)};
  left.curves.back().title = "smallest so far";
  Panel right{"", "evaluation", "measured / wanted [-]", {}};
  right.log_y = true;
  for (std::size_t i = 0; i < task.targets.size(); ++i)
    right.curves.push_back(
        curve(name, task.targets[i].name, "$2", "3",
              static_cast<CurveStyle>(static_cast<std::size_t>(CurveStyle::series_1) + i % 6)));
  figure.figure.panels = {left, right};
  return figure;
}

PageFigure slope_figure(const CalibrationTask &task, const Calibration &found) {
  constexpr const char *name = "sensitivity";
  PageFigure figure;
  figure.label = "Fig. 2";
  figure.caption =
      "How the targets depend on the parameters around the best evaluation: by how many per cent a target "
      "grows if a parameter grows by one per cent, with 95 % confidence intervals over the seeds.";
  figure.weight = 1.0;
  figure.figure = {name, "Sensitivity", {}, static_cast<int>(std::min<std::size_t>(3, task.targets.size()))};
  CurveTable data("parameter,slope,low,high");
  for (std::size_t i = 0; i < task.targets.size(); ++i) {
    Panel panel{"target " + task.targets[i].name, "", "slope [-]", {}};
    panel.x_range = axis_range(0.5, 0.5 + static_cast<double>(task.vary.size()));
    for (std::size_t j = 0; j < task.vary.size(); ++j) {
      const MeanInterval &slope = found.sensitivity.slopes[i][j];
      const double reach = std::isfinite(slope.half_width) ? slope.half_width : 0.0;
      data.row(task.targets[i].name,
               {static_cast<double>(j + 1), slope.mean, slope.mean - reach, slope.mean + reach});
      panel.x_ticks.push_back(task.vary[j].name);
    }
    panel.curves = {curve(name, task.targets[i].name, "$2", "3:4:5", CurveStyle::spread)};
    panel.curves.back().title = "slope";
    figure.figure.panels.push_back(panel);
  }
  figure.csv = data.text();
  return figure;
}

} // namespace

std::vector<std::string> calibration_answer(const CalibrationTask &task, const Calibration &found) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < task.vary.size(); ++i) {
    const ParameterEstimate &one = found.sensitivity.parameters[i];
    const std::string &name = task.vary[i].name;
    if (!one.unidentified.empty())
      lines.push_back(fmt::format("Parameter {} is not identified: {}.", name, one.unidentified));
    else if (best_is_within(found))
      lines.push_back(fmt::format(
          "Parameter {} = {:.4g}; by the slopes the targets are met at {:.4g}, 95 % confidence interval {}.",
          name, found.best.point[i], one.value, between(one.low, one.high)));
    else
      lines.push_back(fmt::format("Parameter {} = {:.4g}, at which the targets are met by the slopes, 95 % "
                                  "confidence interval {}; the best evaluation has {:.4g}.",
                                  name, one.value, between(one.low, one.high), found.best.point[i]));
  }
  for (std::size_t i = 0; i < task.targets.size(); ++i) {
    const CalibrationTarget &target = task.targets[i];
    const double mean = found.best.mean(i), off = std::log(mean / target.value);
    lines.push_back(
        fmt::format("Target {}: wanted {:.4g}, measured {:.4g}, {:+.2g} %{}.", target.name, target.value,
                    mean, 100.0 * std::expm1(off),
                    std::fabs(off) <= target.tolerance ? "" : ", which is outside of the tolerance"));
  }
  return lines;
}

void write_calibration_page(const std::filesystem::path &out, const std::string &beds,
                            const CalibrationTask &task, const Calibration &found,
                            const std::vector<LumpedComparison> &compared) {
  const auto failed =
      static_cast<std::size_t>(std::count_if(found.evaluations.begin(), found.evaluations.end(),
                                             [&task](const Evaluation &one) { return !one.good(task); }));
  Page page(out, "Calibration of a bed", Drawing::bed);
  for (const std::string &line : calibration_answer(task, found))
    page.answer(line);
  page.answer(fmt::format("{} evaluations of {}{}.", found.evaluations.size(), beds,
                          failed == 0 ? "" : fmt::format("; {} of them failed", failed)));
  page.section("How to read it");
  page.paragraph(
      "Each evaluation measures all targets with the same values of the parameters on a bed of each seed. "
      "The objective is the sum over the targets of (ln(measured / wanted) / tolerance)^2, with the "
      "geometric mean over the seeds; 1 is a target that is off by its tolerance. A search over the whole "
      "ranges is followed by evaluations beside its best point, which give the slopes, and by one at the "
      "point that meets the targets by these slopes.");
  page.section("Search");
  page.figure(progress_figure(task, found));
  page.table(target_table(task, found));
  page.section("Parameters");
  page.table(parameter_table(task, found));
  page.section("What the targets tell");
  page.figure(slope_figure(task, found));
  page.table(slope_table(task, found));
  page.table(correlation_table(task, found));
  if (!compared.empty()) {
    page.section("Chain and bed");
    page.paragraph("The beds of the best evaluation, and beside each the chain with the k and D that its "
                   "record gives. The figures show seed 1.");
    add_lumped_comparison(page, compared, 3);
  }
  if (failed > 0) {
    page.section("Evaluations that failed");
    for (const Evaluation &one : found.evaluations)
      if (!one.good(task)) page.paragraph(fmt::format("Evaluation {}: {}", one.number, one.failure()));
  }
  page.write();
}

} // namespace drumlin::post
