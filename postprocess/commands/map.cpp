#include "commands/map.h"

#include "commands/commands.h"
#include "commands/text_options.h"
#include "map/ends_map.h"
#include "map/figures.h"
#include "map/course.h"
#include "map/regime_map.h"
#include "pages/drawing.h"
#include "pages/html.h"
#include "runs/chain_files.h"
#include "runs/parameter_file.h"
#include "support/csv.h"
#include "support/files.h"
#include "support/options.h"
#include "support/progress.h"
#include "support/resumed.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr int most_values = 2000; ///< per axis
constexpr int most_cycles = 100000;
constexpr int least_cycles = 100; ///< fewer do not let a motion settle
constexpr int most_threads = 256;
constexpr const char *points_name = "regimes.csv";
constexpr const char *boundaries_name = "boundaries.csv";
constexpr const char *record_name = "parameters.csv";
constexpr const char *page_name = "index.html";

struct Task {
  MapGrid grid;
  std::optional<GivenRoller> roller;
  std::optional<MapAxis> sweep;
  bool along = false; ///< along x alone: what the meter shows
  std::optional<LineContact> drum;
  int identify = 10; ///< every so many-th point of one axis
  int threads = 1;
  std::optional<EndsFamily> ends; ///< a drum with two ends
  fs::path out;
};

MapAxis axis_option(const char *option, const std::string &text) {
  try {
    return axis_from_text(option, text, most_values);
  } catch (const std::invalid_argument &error) {
    throw UsageError(error.what());
  }
}

// Refuses chains that cannot be computed, or that move so much faster than they are excited that a cycle
// takes seconds.
void judge_corner(const ChainArguments &arguments, const ChainParameters &parameters) {
  if (const std::string fault = parameters.invalid(); !fault.empty()) throw UsageError("--" + fault);
  constexpr double most_pieces = 1e4;
  for (const bool touching : {true, false}) {
    const PhaseDynamics dynamics(parameters, touching ? parameters.k : 0.0,
                                 touching ? parameters.damping() : 0.0);
    // Judged by the pieces after the fast decay, since they make up nearly all of the motion.
    if (parameters.period() / dynamics.longest_piece(1e300) > most_pieces)
      throw UsageError(frequency_refusal(
          arguments, parameters.omega,
          fmt::format("a frequency not so far below those of the chain itself: a cycle of k = {:g} N/m, m2 = "
                      "{:g} kg, c23 = {:g} N s/m would take more than {:g} pieces",
                      parameters.k, parameters.m2, parameters.c23, most_pieces)));
  }
}

/// The drum with two ends. Refuses one that cannot be solved at the corners of the axes.
EndsFamily judge_contacts(const std::string &contacts, const Task &task) {
  EndsFamily family;
  family.chain = task.grid.chain;
  family.contacts = count_option("--contacts", contacts, 2, most_contacts);
  if (task.roller) {
    family.roller = task.roller->machine;
    if (!family.roller.width)
      throw UsageError(fmt::format("width of '{}' is missing; allowed: the width of the drum, which "
                                   "--contacts needs",
                                   task.roller->file));
  }
  const auto judge_corner = [&](const std::vector<std::pair<std::string, double>> &values) {
    const TwoEnds machine = family.at(values);
    if (const std::string fault = machine.invalid(); !fault.empty())
      throw UsageError(fault.rfind("contacts", 0) == 0 ? "--" + fault : fault);
    ExactOptions options;
    options.cycles = longest_transient * task.grid.cycles;
    if (const std::string fault = too_much_work(machine, options); !fault.empty())
      throw UsageError("--" + fault);
  };
  const MapGrid &grid = task.grid;
  if (task.sweep)
    for (const double value : {task.sweep->from, task.sweep->to})
      judge_corner({{task.sweep->name, value}});
  else
    for (const double x : {grid.x.from, grid.x.to})
      for (const double y : {grid.y.from, grid.y.to})
        judge_corner({{grid.x.name, x}, {grid.y.name, y}});
  return family;
}

Task judge(const MapArguments &arguments) {
  Task task;
  MapGrid &grid = task.grid;
  const AskedChain chain = judged_chain(arguments.chain);
  task.roller = chain.roller;
  grid.chain.base = chain.parameters;
  if (arguments.me_re) grid.chain.me_re = number_option("--me-re", *arguments.me_re, {1e-9, 1e12, "kg m"});
  if (task.roller && grid.chain.me_re) task.roller->setting.me_re = *grid.chain.me_re;
  std::vector<std::pair<MapAxis, const char *>> axes;
  if (arguments.sweep) {
    if (arguments.x || arguments.y)
      throw UsageError(refusal("--sweep", *arguments.sweep, "without --x and --y, which are those of a map"));
    task.sweep = axis_option("--sweep", *arguments.sweep);
    axes = {{*task.sweep, "--sweep"}};
  } else {
    grid.x = axis_option("--x",
                         arguments.x.value_or(arguments.contacts ? "k:5e6:100e6:39" : "k:1e6:200e6:60:log"));
    axes = {{grid.x, "--x"}};
    task.along = arguments.x && !arguments.y && !arguments.contacts;
  }
  if (!task.sweep && !task.along) {
    const std::string y = arguments.y.value_or(arguments.contacts ? "ratio:1:4:25:log" : "D:0.02:1:50");
    grid.y = axis_option("--y", y);
    if (grid.x.parameter() == grid.y.parameter())
      throw UsageError(refusal("--y", y, "another NAME than that of --x"));
    axes.emplace_back(grid.y, "--y");
  }
  const bool moment = arguments.me_re || std::any_of(axes.begin(), axes.end(), [](const auto &axis) {
                        return axis.first.name == "me_re";
                      });
  if (const auto Fw = given_number(arguments.chain, "Fw"); moment && Fw)
    throw UsageError(refusal(Fw->first, Fw->second, "not together with me_re, from which Fw follows"));
  for (const auto &[axis, option] : axes) {
    if (const auto given = given_number(arguments.chain, axis.parameter()))
      throw UsageError(refusal(given->first, given->second,
                               fmt::format("not together with the axis {} of {}", axis.name, option)));
    if (axis.name == ratio_name && !arguments.contacts)
      throw UsageError(refusal(option, axis.name, "that of the halves of a drum only with --contacts"));
    if (axis.name == "Fw" && moment)
      throw UsageError(refusal(option, "Fw", "not together with me_re, from which Fw follows"));
    if (axis.name == "me_re" && arguments.me_re)
      throw UsageError(refusal("--me-re", *arguments.me_re, "not together with an axis me_re"));
  }
  const bool force =
      std::any_of(axes.begin(), axes.end(), [](const auto &axis) { return axis.first.name == "Fw"; });
  if (!moment && !force) grid.chain.me_re = chain.me_re;
  grid.cycles = count_option("--cycles", arguments.cycles, least_cycles, most_cycles);
  task.threads = count_option("--threads", arguments.threads, 1, most_threads);
  if (task.sweep)
    for (const double value : {task.sweep->from, task.sweep->to})
      judge_corner(arguments.chain, grid.chain.with({{task.sweep->name, value}}));
  else
    for (const double x : {grid.x.from, grid.x.to})
      for (const double y : {grid.y.from, grid.y.to})
        judge_corner(arguments.chain, grid.at(x, y));
  if (arguments.contacts) task.ends = judge_contacts(*arguments.contacts, task);
  constexpr int most_points = 1000000;
  if (arguments.identify) task.identify = count_option("--identify", *arguments.identify, 0, most_points);
  const auto along_only = [&task](const std::optional<std::string> &given, const char *option) {
    if (given && !task.along) throw UsageError(refusal(option, *given, "only with --x and without --y"));
  };
  along_only(arguments.identify, "--identify");
  along_only(arguments.drum.radius, "--drum-radius");
  along_only(arguments.drum.width, "--drum-width");
  along_only(arguments.drum.poisson, "--poisson");
  task.drum = judged(arguments.drum, task.roller);
  task.out = output_folder_option("--out", arguments.out);
  keep_apart(files_of(arguments.chain.roller), {{"--out", task.out, true}});
  return task;
}

/// A sentence on the roller; empty without one.
std::string roller_sentence(const Task &task) {
  if (!task.roller) return {};
  const auto rows = task.roller->rows(task.grid.chain.base.g);
  return roller_words({rows.begin(), rows.end()});
}

std::string settings(const Task &task) {
  const MapGrid &grid = task.grid;
  const auto words = [](const MapAxis &axis) {
    return fmt::format("{}:{}:{}:{}{}", axis.name, number_text(axis.from), number_text(axis.to), axis.count,
                       axis.log ? ":log" : "");
  };
  std::vector<std::pair<std::string, std::string>> values = parameter_values(grid.chain.base);
  const auto is_axis = [&task, &grid](const char *name) {
    return task.sweep ? task.sweep->parameter() == name
                      : grid.x.parameter() == name || grid.y.parameter() == name;
  };
  const bool varies = is_axis("Fw") || is_axis("me_re") || (grid.chain.me_re && is_axis("omega"));
  for (auto &[name, value] : values)
    if (name == "Fw") value = varies ? "" : number_text(grid.chain.with({}).Fw);
  values.emplace_back("me_re", grid.chain.me_re ? number_text(*grid.chain.me_re) : "");
  if (task.sweep) {
    values.emplace_back("sweep", words(*task.sweep));
  } else {
    values.emplace_back("x", words(grid.x));
    if (!task.along) values.emplace_back("y", words(grid.y));
  }
  if (task.along) {
    const auto of_drum = [&task](double LineContact::*part) {
      return task.drum ? number_text((*task.drum).*part) : std::string();
    };
    values.emplace_back("identify", fmt::format("{}", task.identify));
    values.emplace_back("drum_radius", of_drum(&LineContact::radius));
    values.emplace_back("drum_width", of_drum(&LineContact::length));
    values.emplace_back("poisson", of_drum(&LineContact::poisson));
  }
  if (task.ends) {
    values.emplace_back("contacts", fmt::format("{}", task.ends->contacts));
    values.emplace_back("ends_assumed", fmt::format("{}", fmt::join(assumed_ends(task.ends->roller), " ")));
  }
  values.emplace_back("cycles", fmt::format("{}", grid.cycles));
  if (task.roller) {
    const auto rows = task.roller->rows(grid.chain.base.g);
    values.insert(values.end(), rows.begin(), rows.end());
  }
  return parameters_text(values);
}

/// A row of regimes.csv; the values of the axes name it.
template <class Point>
struct MapRow {
  double x = 0.0, y = 0.0;
  Point point;
};

using ChainRow = MapRow<RegimePoint>;
CsvSchema<ChainRow> map_columns(const MapGrid &grid) {
  const auto number = [](const char *name, auto part) {
    return csv_column_of<ChainRow, double>(name, part, all_digits);
  };
  return CsvSchema<ChainRow>(
      {csv_column(grid.x.label(), &ChainRow::x),
       csv_column(grid.y.label(), &ChainRow::y),
       {"regime",
        [](const ChainRow &row) { return regime_names[static_cast<std::size_t>(row.point.regime)]; },
        [](ChainRow &row, const std::string &cell) { row.point.regime = regime_from_name(cell); }},
       csv_column("period [cycles]", &ChainRow::point, &RegimePoint::period),
       number(
           "CMV [-]", [](auto &row) -> auto & { return row.point.meter.cmv; }),
       number(
           "RMV [-]", [](auto &row) -> auto & { return row.point.meter.rmv; }),
       number(
           "peak_force [N]", [](auto &row) -> auto & { return row.point.meter.peak_force; }),
       number(
           "contact_share [-]", [](auto &row) -> auto & { return row.point.meter.contact_share; }),
       csv_column("multiplier [-]", &ChainRow::point, &RegimePoint::multiplier),
       number(
           "exponent [1/cycle]", [](auto &row) -> auto & { return row.point.exponent.mean; }),
       number(
           "exponent_low [1/cycle]", [](auto &row) -> auto & { return row.point.exponent.low; }),
       number(
           "exponent_high [1/cycle]", [](auto &row) -> auto & { return row.point.exponent.high; })},
      2);
}

/// All points of the map in its order; those that an earlier call has written are not computed again.
/// \param at_once number of points that are computed before they are written
template <class Point, class Judge>
std::vector<Point> map_points(const Task &task, const CsvSchema<MapRow<Point>> &columns, std::size_t at_once,
                              const Judge &judge) {
  const MapGrid &grid = task.grid;
  ResumedTable table(task.out / points_name, columns);
  std::map<std::pair<double, double>, Point> earlier;
  for (const MapRow<Point> &row : read_points(table.file(), columns))
    earlier[{row.x, row.y}] = row.point;
  std::vector<Point> points(grid.size());
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (table.has(columns.key({grid.x_of(i), grid.y_of(i), {}})))
      points[i] = earlier.at({grid.x_of(i), grid.y_of(i)});
    else
      missing.push_back(i);
  table.finish(); // before hours of work, for rows that belong to no point
  const std::size_t there = points.size() - missing.size();
  if (there > 0) fmt::print("{} of {} points are there already\n", there, points.size());
  TimedProgress progress;
  judge_points<Point>(missing, task.threads, at_once, judge,
                      [&](std::size_t first, const std::vector<Point> &more) {
                        std::vector<ResumedTable::Row> rows;
                        for (std::size_t i = 0; i < more.size(); ++i) {
                          const std::size_t number = missing[first + i];
                          points[number] = more[i];
                          rows.push_back(columns.cells({grid.x_of(number), grid.y_of(number), more[i]}));
                        }
                        table.add(rows);
                        progress.tell("{} of {} points", there + first + more.size(), points.size());
                      });
  table.finish();
  return points;
}

std::vector<RegimePoint> chain_points(const Task &task) {
  constexpr std::size_t at_once = 200;
  return map_points(task, map_columns(task.grid), at_once,
                    [&task](std::size_t point) { return task.grid.judged(point); });
}

void draw(const fs::path &out, const MapFigures &figures) {
  std::vector<FileText> files;
  for (const auto &[name, text] : figures.data)
    files.emplace_back(out / name, text);
  write_files(files);
  const fs::path gnuplot = find_gnuplot();
  for (const Figure &figure : figures.figures)
    render(gnuplot, out, figure);
}

// The page of a map: its pictures, and links to its tables.
void write_page(const Task &task, const std::vector<Figure> &figures, const std::string &motions) {
  std::vector<Sentence> answer = {
      {fmt::format("The motion that the roller reaches from rest, over {} and {}: {} of {} points.",
                   task.grid.x.name, task.grid.y.name, motions, task.grid.size())}};
  if (const std::string roller = roller_sentence(task); !roller.empty()) answer.push_back({roller});
  std::string body = answer_html(answer, Verdict::none, drawing_html(Drawing::chain));
  std::vector<PageLink> contents = {{"#answer", "Answer"}};
  for (const Figure &figure : figures) {
    contents.push_back({"#" + figure.name, figure.title});
    body +=
        fmt::format("<figure id=\"{0}\">\n<a href=\"{0}.png\"><img src=\"{0}.png\" alt=\"{1}\" width=\"{2}\" "
                    "height=\"{3}\" /></a>\n<figcaption>{1}</figcaption>\n</figure>\n",
                    figure.name, html_escaped(figure.title), figure_width(figure), figure_height(figure));
  }
  body += fmt::format("<p><a href=\"{0}\">{0}</a>, <a href=\"{1}\">{1}</a>, <a href=\"{2}\">{2}</a></p>\n",
                      points_name, boundaries_name, record_name);
  write_files({{task.out / page_name,
                html_page("Which motion will the roller have?",
                          fmt::format("{} cycles at each point, computed in closed form.", task.grid.cycles),
                          contents, body)}});
}

std::string boundaries_csv(const MapGrid &grid, const std::vector<BoundaryPoint> &boundaries) {
  std::string text = fmt::format("kind,{},{}\n", grid.x.label(), grid.y.label());
  for (const BoundaryPoint &point : boundaries)
    text += fmt::format("{},{},{}\n", point.kind, number_text(point.x), number_text(point.y));
  return text;
}

void run_map(const Task &task) {
  const MapGrid &grid = task.grid;
  const std::vector<RegimePoint> points = chain_points(task);
  TimedProgress progress;
  const std::vector<BoundaryPoint> boundaries =
      find_boundaries(grid, points, task.threads,
                      [&](double share) { progress.tell("boundaries: {:.0f} %", 100.0 * share); });
  write_files({{task.out / boundaries_name, boundaries_csv(grid, boundaries)}});
  const MapFigures figures = map_figures(grid, points, boundaries);
  draw(task.out, figures);
  fmt::print("{}: {} points, {} points of boundaries\n", task.out.string(), points.size(), boundaries.size());
  std::array<std::size_t, regime_count> counts{};
  for (const RegimePoint &point : points)
    ++counts[static_cast<std::size_t>(point.regime)];
  std::string motions;
  for (std::size_t i = 0; i < regime_count; ++i) {
    if (counts[i] == 0) continue;
    fmt::print("  {:<20}{:>7}\n", regime_names[i], counts[i]);
    motions += fmt::format("{}{} at {}", motions.empty() ? "" : ", ", regime_names[i], counts[i]);
  }
  write_page(task, figures.figures, motions);
}

/// What the meter shows along one axis.
void run_along(const Task &task) {
  const MapGrid &grid = task.grid;
  CourseChain roller;
  roller.chain = [&grid](double value) { return grid.at(value, 0.0); };
  roller.setting.drum = task.drum;
  roller.setting.cycles = grid.cycles;
  roller.identify_every = task.identify;
  const std::vector<CoursePoint> points =
      course_points(task.out / points_name, grid.x, {roller}, task.threads);
  std::vector<RegimePoint> motions;
  motions.reserve(points.size());
  for (const CoursePoint &point : points)
    motions.push_back(point.motion);
  TimedProgress progress;
  const std::vector<BoundaryPoint> boundaries =
      find_boundaries(grid, motions, task.threads,
                      [&](double share) { progress.tell("boundaries: {:.0f} %", 100.0 * share); });
  std::string text = fmt::format("kind,{}\n", grid.x.label());
  for (const BoundaryPoint &point : boundaries) {
    text += fmt::format("{},{}\n", point.kind, number_text(point.x));
    fmt::print("  {:<20}{} = {:.10g}\n", point.kind, grid.x.name, point.x);
  }
  write_files({{task.out / boundaries_name, text}, {task.out / "meter.csv", course_csv(grid.x, points)}});
  const std::string roller_text = roller_sentence(task);
  write_course_page(task.out,
                    conditions(grid.chain, {grid.x.parameter()}) +
                        (roller_text.empty() ? "" : ". " + roller_text.substr(0, roller_text.size() - 1)),
                    grid.x, points, boundaries);
  const Course cmv = course_of(points, course_values[0]);
  const auto several =
      std::count_if(cmv.same.begin(), cmv.same.end(), [](std::size_t count) { return count > 1; });
  fmt::print("  {} of {} points have a CMV that belongs to several {}\n", several, points.size(),
             grid.x.name);
  fmt::print("{}: {} points\n", (task.out / page_name).string(), points.size());
}

/// The columns of what a drum with two ends settles to, behind those that name a row.
template <class Row>
CsvSchema<Row> with_ends_columns(std::vector<CsvColumn<Row>> columns) {
  const std::size_t keys = columns.size();
  columns.push_back(
      {"regime", [](const Row &row) { return ends_mode_names[static_cast<std::size_t>(row.point.mode)]; },
       [](Row &row, const std::string &cell) {
         const auto *const found = std::find(ends_mode_names.begin(), ends_mode_names.end(), cell);
         if (found == ends_mode_names.end())
           throw std::invalid_argument(fmt::format("{}", fmt::join(ends_mode_names, ", ")));
         row.point.mode = static_cast<EndsMode>(found - ends_mode_names.begin());
       }});
  columns.push_back(csv_column("period [cycles]", &Row::point, &EndsPoint::period));
  columns.push_back(csv_column("multiplier [-]", &Row::point, &EndsPoint::multiplier));
  const auto number = [&columns](const char *name, auto part) {
    columns.push_back(csv_column_of<Row, double>(name, part, all_digits));
  };
  number(
      "exponent [1/cycle]", [](auto &row) -> auto & { return row.point.exponent.mean; });
  number(
      "tilt [rad]", [](auto &row) -> auto & { return row.point.tilt; });
  number(
      "contact_left [-]", [](auto &row) -> auto & { return row.point.contact_share[0]; });
  number(
      "contact_right [-]", [](auto &row) -> auto & { return row.point.contact_share[1]; });
  return CsvSchema<Row>(std::move(columns), keys);
}

/// What the drum with two ends does, in words.
std::string ends_counts(const std::vector<EndsPoint> &points) {
  std::string words;
  for (std::size_t mode = 0; mode < ends_mode_count; ++mode) {
    const auto count = std::count_if(points.begin(), points.end(), [mode](const EndsPoint &point) {
      return static_cast<std::size_t>(point.mode) == mode;
    });
    if (count > 0)
      words += fmt::format("{}{} at {}", words.empty() ? "" : ", ", ends_mode_names[mode], count);
  }
  return words;
}

void run_ends_map(const Task &task) {
  const MapGrid &grid = task.grid;
  using Row = MapRow<EndsPoint>;
  constexpr std::size_t at_once = 8; // a point can take a second
  const std::vector<EndsPoint> points = map_points(
      task,
      with_ends_columns<Row>({csv_column(grid.x.label(), &Row::x), csv_column(grid.y.label(), &Row::y)}),
      at_once, [&](std::size_t point) { return judged(*task.ends, grid, point); });
  TimedProgress progress;
  const std::vector<BoundaryPoint> boundaries =
      ends_boundaries(*task.ends, grid, points, task.threads,
                      [&](double share) { progress.tell("boundaries: {:.0f} %", 100.0 * share); });
  write_files({{task.out / boundaries_name, boundaries_csv(grid, boundaries)}});
  const MapFigures figures = ends_figures(grid, points, boundaries);
  draw(task.out, figures);
  write_page(task, figures.figures, ends_counts(points));
  fmt::print("{}: {} points on {} contacts: {}\n", task.out.string(), points.size(), task.ends->contacts,
             ends_counts(points));
}

void run_ends_sweep(const Task &task) {
  TimedProgress progress;
  const std::vector<EndsSample> samples =
      sweep_ends(*task.ends, *task.sweep, task.grid.cycles,
                 [&](double share) { progress.tell("{:.0f} %", 100.0 * share); });
  const auto columns = with_ends_columns<EndsSample>(
      {{"direction", [](const EndsSample &row) { return row.up ? "up" : "down"; }, {}},
       csv_column(task.sweep->label(), &EndsSample::value)});
  std::vector<EndsPoint> points;
  points.reserve(samples.size());
  for (const EndsSample &sample : samples)
    points.push_back(sample.point);
  int apart = 0;
  for (std::size_t i = 0; i < samples.size() / 2; ++i)
    if (samples[i].point.mode != samples[samples.size() - 1 - i].point.mode) ++apart;
  write_files({{task.out / "sweep.csv", columns.text(samples)}});
  draw(task.out, ends_sweep_figures(task.grid.chain, *task.sweep, samples));
  fmt::print("{}: {} values, up and down, on {} contacts: {}; another motion downwards at {}\n",
             task.out.string(), task.sweep->count, task.ends->contacts, ends_counts(points), apart);
}

void run_sweep(const Task &task) {
  constexpr int kept = 32;
  TimedProgress progress;
  const Sweep found = sweep(task.grid.chain, *task.sweep, task.grid.cycles, kept,
                            [&](double share) { progress.tell("{:.0f} %", 100.0 * share); });
  std::string samples = fmt::format("direction,{},x_drum [m],v_drum [m/s]\n", task.sweep->label());
  for (const SweepSample &sample : found.samples)
    samples += fmt::format("{},{},{},{}\n", sample.up ? "up" : "down", number_text(sample.value),
                           number_text(sample.x_drum), number_text(sample.v_drum));
  std::string boundaries = fmt::format("kind,{}\n", task.sweep->label());
  for (const BoundaryPoint &point : found.boundaries) {
    boundaries += fmt::format("{},{}\n", point.kind, number_text(point.x));
    fmt::print("  {:<20}{} = {:.10g}\n", point.kind, task.sweep->name, point.x);
  }
  write_files({{task.out / "sweep.csv", samples}, {task.out / boundaries_name, boundaries}});
  draw(task.out, sweep_figures(task.grid.chain, *task.sweep, found));
  fmt::print("{}: {} samples of {} values, up and down\n", task.out.string(), found.samples.size(),
             task.sweep->count);
}

} // namespace

void print_map(const MapArguments &arguments) {
  const Task task = judge(arguments);
  const std::string record = settings(task);
  const ResumedFolder folder(task.out, "map", record, arguments.fresh);
  write_files({{task.out / record_name, record}});
  if (task.roller)
    for (const std::string &line : task.roller->lines(task.grid.chain.base.g))
      fmt::print("{}\n", line);
  if (task.ends && !assumed_ends(task.ends->roller).empty())
    fmt::print("Assumed, as of Axas2020: {}.\n", fmt::join(assumed_ends(task.ends->roller), ", "));
  if (task.ends && task.sweep)
    run_ends_sweep(task);
  else if (task.ends)
    run_ends_map(task);
  else if (task.sweep)
    run_sweep(task);
  else if (task.along)
    run_along(task);
  else
    run_map(task);
}

void add_map_command(CLI::App &app, Session & /*session*/) {
  const auto arguments = std::make_shared<MapArguments>();
  CLI::App *map = app.add_subcommand(
      "map", "Which motion a roller comes to, over two numbers of the chain "
             "or along one: continuous contact, partial uplift, period 2 (double jump), higher period, "
             "aperiodic; CMV, RMV, peak force and share of contact. With --x alone all that its meter "
             "shows, where a value means several stiffnesses, and what identify finds. "
             "Writes CSV files and plots. An interrupted map continues where it was interrupted.");
  add_chain_options(*map, arguments->chain);
  text_option(map, "--x", "AXIS", arguments->x,
              "axis NAME:FROM:TO:COUNT or NAME:FROM:TO:COUNT:log, NAME one of k, D, omega, "
              "frequency, Fw, me_re, m2, m3, k23, c23; without axes k:1e6:200e6:60:log over D:0.02:1:50");
  text_option(map, "--y", "AXIS", arguments->y, "the other axis; not given: what the meter shows along --x");
  text_option(map, "--identify", "COUNT", arguments->identify,
              "with --x alone: identify a record at every so many-th point; 10 if not given, 0: at none");
  add_drum_options(*map, arguments->drum);
  text_option(map, "--sweep", "AXIS", arguments->sweep,
              "instead of a map: follow the motion along one axis up and down, once-per-cycle samples");
  text_option(map, "--me-re", "NUMBER", arguments->me_re,
              "eccentric moment m_e r_e [kg m]: Fw = m_e r_e omega^2 instead of a fixed Fw");
  text_option(
      map, "--contacts", "COUNT", arguments->contacts,
      fmt::format("a drum with two ends on 2 to {} contacts along its width, which share k and D (eight or "
                  "more where an end leaves the soil): whether its ends lift off together or by turns; then "
                  "a NAME of an axis may be ratio, of k and c below the left half to those below the right "
                  "one; without axes k:5e6:100e6:39 over ratio:1:4:25:log",
                  most_contacts));
  text_option(map, "--cycles", "COUNT", arguments->cycles,
              "cycles of the excitation at each point, 100 or more");
  CLI::Option *threads =
      text_option(map, "--threads", "COUNT", arguments->threads, "points at the same time");
  text_option(map, "--out", "DIR", arguments->out, "folder of the results");
  map->add_flag("--fresh", arguments->fresh, "forget the points of an earlier call");
  map->callback([arguments, threads] {
    if (arguments->sweep && threads->count() > 0)
      throw UsageError(refusal("--threads", arguments->threads, "without --sweep, which is one computation"));
    print_map(*arguments);
  });
}

} // namespace drumlin::post
