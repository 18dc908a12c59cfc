#include "map/map_results.h"

#include "engine/places.h"
#include "files/roller.h"
#include "map/course.h"
#include "map/figures.h"
#include "pages/drawing.h"
#include "pages/html.h"
#include "runs/chain_files.h"
#include "support/csv.h"
#include "support/files.h"
#include "support/progress.h"
#include "support/resumed.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr const char *points_name = "regimes.csv";
constexpr const char *boundaries_name = "boundaries.csv";
constexpr const char *page_name = "index.html";

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

/// All points of the map, row by row; those that stand in the table of an earlier call are read from it.
/// \param at_once number of points that are computed before they are written
template <class Point, class Judge>
std::vector<Point> map_points(const MapTask &task, const CsvSchema<MapRow<Point>> &columns,
                              std::size_t at_once, const Judge &judge) {
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

std::vector<RegimePoint> chain_points(const MapTask &task) {
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
void write_page(const MapTask &task, const std::vector<Figure> &figures, const std::string &motions) {
  std::vector<Sentence> answer = {
      {fmt::format("The motion that the roller reaches from rest, over {} and {}: {} of {} points.",
                   task.grid.x.name, task.grid.y.name, motions, task.grid.size())}};
  if (!task.roller.empty()) answer.push_back({task.roller});
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
                      points_name, boundaries_name, map_record_name);
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

/// The boundaries along one axis, which are printed, too.
std::string told_boundaries(const MapAxis &axis, const std::vector<BoundaryPoint> &boundaries) {
  std::string text = fmt::format("kind,{}\n", axis.label());
  for (const BoundaryPoint &point : boundaries) {
    text += fmt::format("{},{}\n", point.kind, number_text(point.x));
    fmt::print("  {:<20}{} = {:.10g}\n", point.kind, axis.name, point.x);
  }
  return text;
}

} // namespace

void write_regime_map(const MapTask &task) {
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

void write_course(const MapTask &task) {
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
  write_files({{task.out / boundaries_name, told_boundaries(grid.x, boundaries)},
               {task.out / "meter.csv", course_csv(grid.x, points)}});
  write_course_page(task.out,
                    conditions(grid.chain, {grid.x.parameter()}) +
                        (task.roller.empty() ? "" : ". " + task.roller.substr(0, task.roller.size() - 1)),
                    grid.x, points, boundaries);
  const Course cmv = course_of(points, course_values[0]);
  const auto several =
      std::count_if(cmv.same.begin(), cmv.same.end(), [](std::size_t count) { return count > 1; });
  fmt::print("  {} of {} points have a CMV that belongs to several {}\n", several, points.size(),
             grid.x.name);
  fmt::print("{}: {} points\n", (task.out / page_name).string(), points.size());
}

void write_ends_map(const MapTask &task) {
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

void write_ends_sweep(const MapTask &task) {
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

void write_sweep(const MapTask &task) {
  constexpr int kept = 32;
  TimedProgress progress;
  const Sweep found = sweep(task.grid.chain, *task.sweep, task.grid.cycles, kept,
                            [&](double share) { progress.tell("{:.0f} %", 100.0 * share); });
  std::string samples = fmt::format("direction,{},x_drum [m],v_drum [m/s]\n", task.sweep->label());
  for (const SweepSample &sample : found.samples)
    samples += fmt::format("{},{},{},{}\n", sample.up ? "up" : "down", number_text(sample.value),
                           number_text(sample.x_drum), number_text(sample.v_drum));
  write_files({{task.out / "sweep.csv", samples},
               {task.out / boundaries_name, told_boundaries(*task.sweep, found.boundaries)}});
  draw(task.out, sweep_figures(task.grid.chain, *task.sweep, found));
  fmt::print("{}: {} samples of {} values, up and down\n", task.out.string(), found.samples.size(),
             task.sweep->count);
}

namespace {

/// The rollers of the study: case of Table 1, or MACHINE-SETTING of a file in inputs/rollers, and title.
constexpr std::array<std::pair<const char *, const char *>, 9> soil_rollers = {
    {{"II", "paper, 20 Hz"},
     {"III", "paper, 40 Hz"},
     {"BW120-63Hz", "BW 120, 63 Hz"},
     {"BW120-67Hz", "BW 120, 67 Hz"},
     {"CA3500-high", "CA3500, high amplitude"},
     {"CA3500-low", "CA3500, low amplitude"},
     {"CA6500-high", "CA6500, high amplitude"},
     {"CA6500-low", "CA6500, low amplitude"},
     {"Axas2020-29Hz", "Axas 2020, 29 Hz"}}};

} // namespace

SoilMachine soil_machine(const std::string &roller) {
  const std::size_t dash = roller.find('-');
  if (dash == std::string::npos) return {table1_case(roller, Transition::B), {}, {}};
  const std::string file = (places().inputs / "rollers" / roller.substr(0, dash)).string();
  const Roller machine = read_roller(file);
  SoilMachine soil = {table1_case("II", Transition::B), machine.width, machine.diameter};
  set_machine(soil.chain, machine, setting_of(machine, roller.substr(dash + 1), file));
  return soil;
}

void run_meter_study(const std::filesystem::path &out, bool quick) {
  const MapAxis axis = {"k", 1e6, 200e6, quick ? 8 : 41, true};
  std::vector<CourseChain> chains;
  std::vector<CourseRoller> rollers;
  for (const auto &[name, title] : soil_rollers) {
    if (quick && name != std::string(soil_rollers.back().first)) continue;
    const SoilMachine machine = soil_machine(name);
    CourseChain chain;
    chain.roller = name;
    chain.chain = [machine](double k) {
      ChainParameters p = machine.chain;
      p.k = k;
      return p;
    };
    if (machine.diameter && machine.width)
      chain.setting.drum = {0.5 * *machine.diameter, *machine.width, usual_poisson};
    chains.push_back(std::move(chain));
    rollers.push_back({name, title});
  }
  constexpr int threads = 2;
  const std::vector<CoursePoint> points = course_points(out / "records.csv", axis, chains, threads);
  write_soil_page(out, rollers, axis, points);
  fmt::print("{}\n", (out / "index.html").string());
}

} // namespace drumlin::post
