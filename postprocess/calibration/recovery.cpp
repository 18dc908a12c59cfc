#include "calibration/recovery.h"

#include "pages/figure_data.h"
#include "pages/page.h"
#include "engine/deck_run.h"
#include "support/csv.h"
#include "support/parallel.h"
#include "support/progress.h"
#include "support/resumed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <stdexcept>

namespace drumlin::post {

namespace {

std::vector<std::string> record_header(const CalibrationTask &task) {
  std::vector<std::string> header = {"seed"};
  for (const CalibrationTarget &target : task.targets)
    header.push_back("measured " + target.name);
  return header;
}

/// The values of a seed that an earlier call has measured; empty if it has not.
std::vector<double> known_values(const CalibrationTask &task, const std::filesystem::path &file, int seed) {
  const Table table = finished_rows(file);
  const std::vector<double> seeds = table.numbers("seed");
  const auto row = std::find(seeds.begin(), seeds.end(), static_cast<double>(seed));
  std::vector<double> values;
  for (std::size_t i = 0; row != seeds.end() && i < task.targets.size(); ++i)
    values.push_back(
        table.numbers("measured " + task.targets[i].name)[static_cast<std::size_t>(row - seeds.begin())]);
  return values;
}

/// The beds with the known parameters, measured.
std::vector<RecoveredBed> records_of(const CalibrationTask &task, const std::vector<double> &known, int beds,
                                     int jobs, const std::filesystem::path &out, const MeasureSeed &measure) {
  Evaluation at_known; // number 0: calibrate() counts from 1
  at_known.point = known;
  ResumedTable rows(out / recovered_name, record_header(task), 1);
  CountedProgress progress(static_cast<std::size_t>(beds), "beds with known parameters");
  std::mutex mutex; // of rows and progress
  std::vector<RecoveredBed> records(static_cast<std::size_t>(beds));
  std::vector<RecoveredBed *> missing;
  for (RecoveredBed &record : records) {
    record.seed = task.seeds + 1 + static_cast<int>(&record - records.data());
    if (!rows.has({std::to_string(record.seed)})) {
      missing.push_back(&record);
      continue;
    }
    record.values = known_values(task, rows.file(), record.seed);
    progress.found();
  }
  in_parallel(missing.size(), jobs, [&](std::size_t i) {
    RecoveredBed &record = *missing[i];
    try {
      record.values = measure(at_known, record.seed);
    } catch (const SceneFault &fault) {
      throw std::runtime_error(fmt::format("a bed with the known parameters cannot be measured: seed {}: {}",
                                           record.seed, fault.what()));
    }
    std::vector<std::string> row = {std::to_string(record.seed)};
    for (const double value : record.values)
      row.push_back(number_text(value));
    const std::lock_guard lock(mutex);
    rows.add(row);
    progress.measured(fmt::format("seed {}", record.seed));
  });
  return records;
}

PageFigure interval_figure(const CalibrationTask &task, const std::vector<double> &known,
                           const std::vector<RecoveredBed> &found) {
  constexpr const char *name = "recovered";
  PageFigure figure;
  figure.label = "Fig. 1";
  figure.weight = 1.0;
  figure.caption =
      "Estimates and 95 % confidence intervals from the values of each bed; the line is the value with "
      "which all these beds were made.";
  figure.figure = {
      name, "Parameters found again", {}, static_cast<int>(std::min<std::size_t>(2, task.vary.size()))};
  CurveTable data("bed,value,low,high");
  for (std::size_t j = 0; j < task.vary.size(); ++j) {
    const std::string &parameter = task.vary[j].name;
    Panel panel;
    panel.title = parameter;
    panel.x_label = "bed";
    panel.y_label = parameter;
    panel.log_y = true;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const ParameterEstimate &one = found[i].estimates[j];
      data.row(parameter, {static_cast<double>(i + 1), one.value, one.low, one.high});
    }
    for (const double end : {0.5, 0.5 + static_cast<double>(found.size())})
      data.row("known " + parameter, {end, known[j], known[j], known[j]});
    panel.curves = {curve(name, "known " + parameter, "$2", "3", CurveStyle::plain),
                    curve(name, parameter, "$2", "3:4:5", CurveStyle::spread)};
    panel.curves[0].title = "known";
    panel.curves[1].title = "found";
    figure.figure.panels.push_back(panel);
  }
  figure.csv = data.text();
  return figure;
}

PageTable interval_table(const CalibrationTask &task, const std::vector<double> &known,
                         const std::vector<RecoveredBed> &found) {
  PageTable table;
  table.name = "beds";
  table.title = "Parameters found again";
  table.header = {"seed of the bed"};
  for (const CalibrationTarget &target : task.targets)
    table.header.push_back("measured " + target.name);
  for (const VariedParameter &parameter : task.vary) {
    table.header.push_back(parameter.name);
    table.header.push_back("95 % confidence interval of " + parameter.name);
  }
  table.criterion = "all intervals hold the known values";
  for (const RecoveredBed &bed : found) {
    std::vector<std::string> row = {std::to_string(bed.seed)};
    bool all = true;
    for (const double value : bed.values)
      row.push_back(fmt::format("{:.4g}", value));
    for (std::size_t j = 0; j < task.vary.size(); ++j) {
      const ParameterEstimate &one = bed.estimates[j];
      row.push_back(fmt::format("{:.4g}", one.value));
      row.push_back(fmt::format("{:.4g} to {:.4g}", one.low, one.high));
      all = all && bed.holds(j, known[j]);
    }
    table.add(row, all ? RowState::agrees : RowState::differs);
  }
  return table;
}

} // namespace

bool RecoveredBed::holds(std::size_t parameter, double known) const {
  return estimates[parameter].low <= known && known <= estimates[parameter].high;
}

std::vector<RecoveredBed> recover(CalibrationTask task, const std::vector<double> &known, int beds,
                                  const CalibrationEffort &effort, const std::filesystem::path &out,
                                  const MeasureSeed &measure) {
  std::vector<RecoveredBed> found = records_of(task, known, beds, effort.jobs, out, measure);
  task.target_beds = 1;
  const std::vector<Evaluation> earlier = read_evaluations(task, out / evaluations_name);
  if (std::any_of(earlier.begin(), earlier.end(),
                  [](const Evaluation &one) { return one.stage != Stage::search; }))
    print_progress("continued: the intervals of the first beds are also from evaluations that were made for "
                   "later beds, unlike "
                   "those of a call without an interruption");
  for (RecoveredBed &bed : found) {
    for (std::size_t i = 0; i < task.targets.size(); ++i)
      task.targets[i].value = bed.values[i];
    bed.estimates = calibrate(task, effort, out, measure).sensitivity.parameters;
  }
  return found;
}

std::vector<std::string> recovery_answer(const CalibrationTask &task, const std::vector<double> &known,
                                         const std::vector<RecoveredBed> &found) {
  std::vector<std::string> lines;
  lines.reserve(task.vary.size());
  for (std::size_t j = 0; j < task.vary.size(); ++j) {
    const auto held = std::count_if(found.begin(), found.end(),
                                    [&](const RecoveredBed &bed) { return bed.holds(j, known[j]); });
    std::vector<double> widths;
    widths.reserve(found.size());
    for (const RecoveredBed &bed : found)
      widths.push_back(std::sqrt(bed.estimates[j].high / bed.estimates[j].low));
    std::sort(widths.begin(), widths.end());
    lines.push_back(fmt::format(
        "Parameter {} = {:.4g}: {} of {} intervals of 95 % hold it; the median interval reaches from "
        "1/{:.2f} to {:.2f} times its estimate.",
        task.vary[j].name, known[j], held, found.size(), median(widths), median(widths)));
  }
  return lines;
}

void write_recovery_page(const std::filesystem::path &out, const std::string &beds,
                         const CalibrationTask &task, const std::vector<double> &known,
                         const std::vector<RecoveredBed> &found) {
  Page page(out, "Does calibration find known parameters again?", Drawing::bed);
  for (const std::string &line : recovery_answer(task, known, found))
    page.answer(line);
  page.answer(fmt::format("Measured on {}; calibrated on {}.", beds,
                          fmt::format("{} other beds of the same kind", task.seeds)));
  page.section("How it is done");
  page.paragraph("Beds with known parameters are measured. For each of them a calibration then looks for "
                 "parameters with which "
                 "other beds, of other seeds, have the values of this one. Its interval contains the scatter "
                 "of those beds and of "
                 "the one bed that it is calibrated to. The calibrations share their evaluations, so that "
                 "their errors are not "
                 "independent: an error of the mean of the calibrating beds is in all of them.");
  page.figure(interval_figure(task, known, found));
  page.table(interval_table(task, known, found));
  page.write();
}

} // namespace drumlin::post
