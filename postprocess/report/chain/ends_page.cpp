#include "report/chain/ends_page.h"

#include "pages/drawing.h"
#include "pages/figure.h"
#include "pages/html.h"
#include "record/chain_record.h"
#include "record/record.h"
#include "report/page.h"
#include "report/content.h"
#include "support/csv.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace drumlin::post {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<double, 3> side_of_place = {-1.0, 0.0, 1.0};
constexpr std::array<const char *, 3> places = {"left end", "middle", "right end"};
constexpr std::size_t middle_place = 1;
constexpr const char *ends_section = "ends";

/// Rows of the last `count` complete cycles: the first, and the one behind the last.
struct RowRange {
  std::size_t first = 0, end = 0;
  std::size_t size() const { return end - first; }
};
RowRange last_rows(const Run &run, int count) {
  const std::vector<double> &time = run.history.time;
  const double period = run.chain.period();
  const TimeWindow window = last_cycles_window(run.complete, count, period);
  const auto row = [&](double at) {
    return static_cast<std::size_t>(std::lower_bound(time.begin(), time.end(), at - 1e-6 * period) -
                                    time.begin());
  };
  const std::size_t first = std::min(row(window.begin), time.size() - 1);
  return {first, std::max(first, row(window.end))};
}

/// Height of the drum at a distance from its middle.
double height(const ChainHistory &h, std::size_t row, double y) {
  return h.x_drum[row] + y * h.theta_drum[row];
}

/// Amplitude of the first harmonic of the height over some rows of whole cycles.
double amplitude_of(const Run &run, const RowRange &rows, double y) {
  const ChainHistory &h = run.history;
  double mean = 0.0; // which would leak into the sum if a cycle had no whole number of rows
  for (std::size_t i = rows.first; i < rows.end; ++i)
    mean += height(h, i, y) / static_cast<double>(rows.size());
  std::complex<double> sum = 0.0;
  for (std::size_t i = rows.first; i < rows.end; ++i)
    sum += (height(h, i, y) - mean) * std::polar(1.0, -run.chain.omega * h.time[i]);
  return 2.0 * std::abs(sum) / static_cast<double>(rows.size());
}

double half_range(const std::vector<double> &values, const RowRange &rows) {
  if (rows.size() == 0) return nan;
  const auto begin = values.begin();
  const auto [least, most] = std::minmax_element(begin + static_cast<std::ptrdiff_t>(rows.first),
                                                 begin + static_cast<std::ptrdiff_t>(rows.end));
  return 0.5 * (*most - *least);
}

double share_without_force(const std::vector<double> &force, const RowRange &rows) {
  const auto begin = force.begin();
  return static_cast<double>(std::count(begin + static_cast<std::ptrdiff_t>(rows.first),
                                        begin + static_cast<std::ptrdiff_t>(rows.end), 0.0)) /
         static_cast<double>(rows.size());
}

/// Up to this share of its range a motion counts as the same.
constexpr double same = 0.02;

/// Cycles after which both ends repeat their motion, judged by the last cycle: 1, 2, or 0 for neither.
int repeats_after(const Run &run, double y) {
  const ChainHistory &h = run.history;
  const RowRange last = last_rows(run, 1);
  for (const std::size_t cycles : {std::size_t{1}, std::size_t{2}}) {
    const std::size_t back = cycles * static_cast<std::size_t>(run.samples_per_cycle);
    if (last.size() == 0 || last.first < back) return 0;
    bool repeats = true;
    for (const double side : {-y, y}) {
      double least = height(h, last.first, side), most = least, difference = 0.0;
      for (std::size_t i = last.first - back; i < last.end; ++i) {
        least = std::min(least, height(h, i, side));
        most = std::max(most, height(h, i, side));
        if (i >= last.first)
          difference = std::max(difference, std::abs(height(h, i, side) - height(h, i - back, side)));
      }
      repeats = repeats && difference <= same * (most - least);
    }
    if (repeats) return static_cast<int>(cycles);
  }
  return 0;
}

/// What meters show at the end of the run.
void take_meters(EndsResult &result) {
  try {
    const Record record = read_record(result.run.folder);
    result.machine = record.ends;
    MeterOptions options;
    const MeterRecord cycles = meter_cycles(record);
    options.window = std::min(options.window, static_cast<int>(cycles.cycles.size() / 2 * 2));
    result.middle = meter_windows(cycles, options).back();
    result.ends = both_ends(record, options);
  } catch (const std::runtime_error &error) {
    result.no_meter = error.what();
  }
}

/// What the figure of a run shows: three cycles, or six of a motion that repeats every two.
int cycles_drawn(const EndsResult &result) {
  constexpr int usual = 3;
  return std::min(result.run.complete, result.repeats == 2 ? 2 * usual : usual);
}

PageFigure figure_of(const EndsResult &result, std::size_t number) {
  const Run &run = result.run;
  const ChainHistory &h = run.history;
  const std::string name = fmt::format("ends_{}", number);
  const int shown = cycles_drawn(result);
  RowRange rows = last_rows(run, shown);
  rows.end = std::min(rows.end + 1, h.size()); // the row that ends the last cycle
  const double begin = h.time[rows.first], y = result.half_width.value_or(nan);
  constexpr double gravity = 9.81;
  CurveTable table("time (s),time in window (s),value (mm or mrad or kN or g)");
  const auto put = [&](const std::string &label, const auto &value) {
    for (std::size_t i = rows.first; i < rows.end; ++i)
      table.row(label, {h.time[i], h.time[i] - begin, value(i)});
  };
  const std::string time = fmt::format("time in {} (ms)", last_cycles_words({shown}));
  const auto line = [&](Panel &panel, const std::string &label, CurveStyle style, const std::string &legend) {
    panel.add(curve(name, label, "$3*1e3", "4", style), legend);
  };
  const auto panel_of = [&](const char *title, const char *axis) {
    Panel panel{title, time, axis, {}};
    panel.tight_x = true;
    return panel;
  };
  constexpr std::array styles = {CurveStyle::line_1, CurveStyle::plain, CurveStyle::line_2};

  Panel motion = panel_of("Height of the drum", "height (mm)");
  for (std::size_t p = 0; p < places.size(); ++p) {
    if (p != middle_place && !result.half_width) continue;
    const double at = p == middle_place ? 0.0 : side_of_place[p] * y;
    put(places[p], [&](std::size_t i) { return 1e3 * height(h, i, at); });
    line(motion, places[p], styles[p], places[p]);
  }
  Panel tilt = panel_of("Tilt", "tilt (mrad)");
  Panel force = panel_of("Contact force", "contact force (kN)");
  Panel acceleration = panel_of("Acceleration at the sensors", "acceleration (g)");
  struct EndsLine {
    Panel *panel;
    const char *label, *legend;
    const std::vector<double> *values;
    double per_unit;
    CurveStyle style;
  };
  for (const EndsLine &l :
       {EndsLine{&tilt, "tilt of the drum", "of the drum", &h.theta_drum, 1e3, CurveStyle::plain},
        EndsLine{&tilt, "tilt of the frame", "of the frame", &h.theta_frame, 1e3, CurveStyle::line_3},
        EndsLine{&force, "force of the left half", "left half", &h.F_left, 1e-3, styles.front()},
        EndsLine{&force, "force of the right half", "right half", &h.F_right, 1e-3, styles.back()},
        EndsLine{&acceleration, "left sensor", "left sensor", &h.a_left, 1.0 / gravity, styles.front()},
        EndsLine{&acceleration, "right sensor", "right sensor", &h.a_right, 1.0 / gravity, styles.back()}}) {
    put(l.label, [&](std::size_t i) { return l.per_unit * (*l.values)[i]; });
    line(*l.panel, l.label, l.style, l.legend);
  }
  const double error = std::abs(result.error()[0]); // the page opens with the largest ones
  PageFigure figure{
      ends_section,
      fmt::format("Fig. {}", number),
      fmt::format("Run {} over {}{}: height of the drum above where the whole drum just touches the soil, "
                  "tilt of drum and frame (positive: the right end is higher), force of the soil below each "
                  "half, and acceleration at both sensors (g = 9.81 m/s²).",
                  run.name, last_cycles_words({shown}),
                  result.repeats == 2 ? ", since the motion repeats after two" : ""),
      {name, "Run " + run.name, {motion, tilt, force, acceleration}, 2},
      table.text(),
      (result.half_width ? 2.0 : 1.0) + (std::isfinite(error) ? error / (1.0 + error) : 0.0)};
  return figure;
}

// ---- error of meters at one end over the ratio of stiffness ----

/// The soil below the whole drum: k [N/m] and c [N s/m].
struct WholeSoil {
  double k = 0.0, c = 0.0;
};

/// Stiffness of the run: the given one if contacts are equal, else that measured in unbroken contact.
std::optional<WholeSoil> soil_of(const EndsResult &result) {
  const std::optional<double> k = result.run.number("k"), c = result.run.number("c");
  if (k && c) return WholeSoil{*k, *c};
  if (!result.ends || !result.ends->missing.empty()) return std::nullopt;
  WholeSoil soil;
  for (const std::vector<MeterWindow> &half : result.ends->halves) {
    const MeterWindow &last = half.back();
    if (last.mode != OperatingMode::continuous_contact || !last.k_1 || !last.c_1) return std::nullopt;
    soil.k += *last.k_1;
    soil.c += *last.c_1;
  }
  return soil;
}

/// What meters at both ends show on halves of a ratio.
struct OneSidedError {
  double ratio = 1.0;         ///< of k below the left half over that below the right one
  std::array<double, 2> ends; ///< k_1 at that end over k_1 in the middle, less 1 [-]
  bool lost = false;          ///< whether a contact was lost
};

/// Contacts of these computations: more do not change what meters show.
constexpr int most_shown_contacts = 8;

/// Solved from rest until it has settled.
ExactOptions until_settled() {
  ExactOptions options;
  options.cycles = 200;
  options.samples_per_cycle = 100;
  return options;
}

OneSidedError one_sided_error(const TwoEnds &machine, double ratio) {
  const ExactOptions options = until_settled();
  const ExactSolution solved = solve_two_ends(machine, options);
  const Record record = chain_record(machine.chain, solved.history);
  const MeterOptions meter;
  OneSidedError error;
  error.ratio = ratio;
  const double in_middle = meter_windows(meter_cycles(record), meter).back().k_1.value_or(nan);
  const std::optional<BothEnds> ends = both_ends(record, meter);
  for (std::size_t end = 0; end < error.ends.size(); ++end)
    error.ends[end] = ends->at_end[end].back().k_1.value_or(nan) / in_middle - 1.0;
  const double begin = solved.history.time.back() - meter.window * machine.chain.period();
  error.lost = std::any_of(solved.events.begin(), solved.events.end(),
                           [begin](const ContactEvent &event) { return event.time >= begin; });
  return error;
}

/// Adds the figure of the run, or why there is none.
void add_error_figure(const EndsResult &result, std::size_t number, FigurePlan &plan) {
  const std::string label = fmt::format("Fig. {}", number), name = "ends_error";
  const std::optional<WholeSoil> soil = soil_of(result);
  if (!result.machine || !result.half_width || !soil) {
    plan.absent.push_back({ends_section, label,
                           fmt::format("{} does not say width, inertia and bonds of the machine and the "
                                       "stiffness of the whole soil",
                                       result.run.name)});
    return;
  }
  const auto refuse = [&](const std::string &fault) {
    plan.absent.push_back(
        {ends_section, label, fmt::format("{} cannot be solved: {}", result.run.name, fault)});
  };
  TwoEnds machine = *result.machine;
  machine.chain = result.run.chain;
  const double width = 2.0 * *result.half_width;
  const auto count = any_number_from_text(result.run.text("contacts"));
  const int contacts = static_cast<int>(std::clamp(count.value_or(2.0), 2.0, double(most_shown_contacts)));
  const auto machine_on = [&](double ratio) {
    TwoEnds on_halves = machine;
    on_halves.contacts = equal_contacts(contacts, width, soil->k, soil->c);
    set_ratio(on_halves.contacts, ratio);
    return on_halves;
  };
  constexpr double largest_ratio = 4.0;
  const TwoEnds hardest = machine_on(largest_ratio);
  if (const std::string fault = hardest.invalid(); !fault.empty()) return refuse(fault);
  if (const std::string fault = too_much_work(hardest, until_settled()); !fault.empty()) return refuse(fault);
  CurveTable table("ratio (-),error (%)");
  constexpr std::array<const char *, 2> ends = {"left end", "right end"};
  constexpr int steps = 8; // to either side
  std::vector<OneSidedError> errors;
  for (int step = -steps; step <= steps; ++step) {
    const double ratio = std::pow(largest_ratio, static_cast<double>(step) / steps);
    errors.push_back(one_sided_error(machine_on(ratio), ratio));
  }
  for (std::size_t end = 0; end < ends.size(); ++end) {
    for (const OneSidedError &error : errors)
      table.row(ends[end], {error.ratio, 100.0 * error.ends[end]});
    for (const OneSidedError &error : errors)
      if (error.lost) table.row("contact is lost", {error.ratio, 100.0 * error.ends[end]});
  }
  Panel panel{"Error of a meter at one end",
              "stiffness of the left half over that of the right (-)",
              "k_1 less that in the middle (%)",
              {}};
  panel.log_x = panel.plain_numbers = panel.tight_x = true;
  panel.add(curve(name, ends[0], "$2", "3", CurveStyle::line_1), "sensor at the left end");
  panel.add(curve(name, ends[1], "$2", "3", CurveStyle::line_2), "at the right end");
  panel.add(curve(name, "contact is lost", "$2", "3", CurveStyle::mark_1),
            "contact is lost: apparent values");
  plan.figures.push_back(
      {ends_section,
       label,
       fmt::format(
           "Machine of run {} on halves that share k = {:.4g} MN/m and c = {:.4g} kN s/m, {} contacts, "
           "transition {}: k_1 of a meter at each end over that of one in the middle, less 1, from the "
           "last {} of 200 cycles of the exact solution. Dots: a contact is lost in these cycles. The "
           "way back over the same soil has the inverse ratio if the roller turns round.",
           result.run.name, 1e-6 * soil->k, 1e-3 * soil->c, contacts,
           transition_name(result.run.transition()), MeterOptions().window),
       {name, "Run " + result.run.name, {panel}, 1},
       table.text()});
}

std::string cell(double value, const char *format) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : no_value;
}

void add_note(PageTable &table, const EndsResult &result, const std::string &words) {
  table.notes.push_back(fmt::format("{}: {}", result.run.name, words));
}

PageTable motion_table(const std::vector<EndsResult> &results) {
  PageTable table(
      "ends_motion", "Motion of both ends of the drum",
      "run | transition | amplitude, left end (mm) | amplitude, middle (mm) | amplitude, right end "
      "(mm) | tilt (mrad) | time without contact, left half (-) | time without contact, right half "
      "(-) | repeats after (cycles) | last cycles (-)",
      2);
  table.section = ends_section;
  for (const EndsResult &result : results) {
    const Run &run = result.run;
    std::vector<std::string> row = {run.name, transition_name(run.transition())};
    for (const double amplitude : result.amplitude)
      row.push_back(cell(1e3 * amplitude, "{:.4f}"));
    row.push_back(cell(1e3 * result.tilt, "{:.4f}"));
    for (const double share : result.no_contact)
      row.push_back(cell(share, "{:.3f}"));
    row.push_back(result.repeats > 0 ? fmt::format("{}", result.repeats) : no_value);
    row.push_back(fmt::format("{}", result.cycles));
    table.add(std::move(row));
    for (const std::string &missing : run.missing)
      add_note(table, result, missing);
    if (!result.half_width)
      add_note(table, result,
               "parameters.csv has no width above 0: the motion of the drum's ends is left out.");
  }
  table.notes.push_back(fmt::format(
      "Values are of so many cycles at the end of the run as the last column says, the tilt of the last two. "
      "Amplitude: of the first harmonic of the height. Tilt: half of the range of the drum's tilt. Time "
      "without contact: share of the rows of chain.csv in which no force acts on that half. The motion "
      "repeats if both ends come back to within {:g} % of their range.",
      100.0 * same));
  return table;
}

PageTable meter_table(const std::vector<EndsResult> &results) {
  PageTable table(
      "ends_meters", "What meters at both ends show",
      "run | transition | k_1, left end (MN/m) | k_1, middle (MN/m) | k_1, right end (MN/m) | "
      "error, left end (%) | error, right end (%) | k_1, left half (MN/m) | k_1, right half (MN/m)",
      2);
  table.section = ends_section;
  for (const EndsResult &result : results) {
    std::vector<std::string> row = {result.run.name, transition_name(result.run.transition())};
    for (const double k : result.stiffness())
      row.push_back(cell(1e-6 * k, "{:.2f}"));
    for (const double error : result.error())
      row.push_back(cell(1e2 * error, "{:+.1f}"));
    for (const double k : result.of_halves())
      row.push_back(cell(1e-6 * k, "{:.2f}"));
    table.add(std::move(row));
    if (!result.no_meter.empty())
      add_note(table, result, fmt::format("no meter values: {}.", result.no_meter));
    if (result.ends && !result.ends->missing.empty())
      add_note(table, result,
               fmt::format("no stiffness of the halves, for which drumlin meter needs more. {}.",
                           result.ends->missing));
  }
  table.notes.emplace_back(
      "Values are of the same cycles, as drumlin meter gives them. k_1: real part of the soil's force over "
      "the displacement at the excitation frequency; at an end with the acceleration of the sensor there and "
      "the force on the whole drum. Error: k_1 at an end over k_1 in the middle, less 1; if the "
      "roller turns round, the way back has both ends exchanged. k_1 of a half: force over displacement of "
      "that half. In unbroken contact it is the stiffness of the soil there; with loss of contact all of "
      "these are apparent.");
  return table;
}

/// "22 % more".
std::string percent_text(double value) {
  return fmt::format("{:.0f} % {}", 100.0 * std::abs(value), value < 0.0 ? "less" : "more");
}

/// Largest error of a meter at one end, or NaN.
double largest_error(const EndsResult &result) {
  const auto [left, right] = result.error();
  return std::max(std::abs(left), std::abs(right));
}

/// The run of which the answer tells: whole before cut, with the stiffness of its halves, in unbroken
/// contact, then that with the largest error.
const EndsResult *told_run(const std::vector<EndsResult> &results) {
  const EndsResult *told = nullptr;
  const auto rank = [](const EndsResult &r) {
    return std::tuple(r.run.cut.empty(), std::isfinite(r.of_halves()[0]),
                      r.no_contact[0] == 0.0 && r.no_contact[1] == 0.0, largest_error(r));
  };
  for (const EndsResult &result : results) {
    if (!std::isfinite(largest_error(result))) continue;
    if (told == nullptr || rank(result) > rank(*told)) told = &result;
  }
  return told;
}

} // namespace

std::array<double, 3> EndsResult::stiffness() const {
  const auto at_end = [this](std::size_t end) {
    return ends ? ends->at_end[end].back().k_1.value_or(nan) : nan;
  };
  return {at_end(0), middle ? middle->k_1.value_or(nan) : nan, at_end(1)};
}

std::array<double, 2> EndsResult::of_halves() const {
  if (!ends || !ends->missing.empty()) return {nan, nan};
  return {ends->halves[0].back().k_1.value_or(nan), ends->halves[1].back().k_1.value_or(nan)};
}

std::array<double, 2> EndsResult::error() const {
  const auto [left, in_middle, right] = stiffness();
  return {left / in_middle - 1.0, right / in_middle - 1.0};
}

EndsResult analyse_ends(Run run) {
  EndsResult result{std::move(run), {}, 0, 0, {nan, nan, nan}, nan, {nan, nan}, {}, {}, {}};
  const Run &r = result.run;
  if (const std::optional<double> width = r.number("width"); width && *width > 0.0)
    result.half_width = 0.5 * *width;
  const int most = MeterOptions().window;
  result.cycles = r.complete < 2 ? r.complete : std::min(most, r.complete / 2 * 2);
  if (result.cycles > 0) {
    const RowRange rows = last_rows(r, result.cycles);
    for (std::size_t p = 0; p < places.size(); ++p)
      result.amplitude[p] =
          amplitude_of(r, rows, p == middle_place ? 0.0 : side_of_place[p] * result.half_width.value_or(nan));
    result.tilt = half_range(r.history.theta_drum, last_rows(r, 2));
    result.no_contact = {share_without_force(r.history.F_left, rows),
                         share_without_force(r.history.F_right, rows)};
    result.repeats = repeats_after(r, result.half_width.value_or(1.0));
  }
  take_meters(result);
  return result;
}

FigurePlan plan_ends_figures(const std::vector<EndsResult> &results) {
  FigurePlan plan;
  for (std::size_t i = 0; i < results.size(); ++i)
    if (results[i].cycles > 0)
      plan.figures.push_back(figure_of(results[i], i + 1));
    else
      plan.absent.push_back({ends_section, fmt::format("Fig. {}", i + 1),
                             fmt::format("{} ends before its first complete cycle", results[i].run.name)});
  if (const EndsResult *told = told_run(results)) add_error_figure(*told, results.size() + 1, plan);
  return plan;
}

std::vector<PageTable> ends_tables(const std::vector<EndsResult> &results) {
  return {motion_table(results), meter_table(results)};
}

Answer ends_answer(const std::vector<EndsResult> &results) {
  Answer answer;
  if (results.empty()) return answer;
  const EndsResult *told = told_run(results);
  if (told == nullptr) {
    answer.sentences.push_back(
        {fmt::format("{} of a drum that tilts, without meter values of both ends.",
                     results.size() == 1 ? "One run" : fmt::format("{} runs", results.size())),
         "Two ends."});
    return answer;
  }
  const auto [left, right] = told->error();
  std::vector<std::string> lines = answer_lines(*told->ends, *told->middle);
  if (!told->ends->missing.empty()) lines.resize(1); // the table says what is missing
  answer.sentences.push_back(
      {fmt::format(
           "A meter at the left end of a drum that tilts shows {} stiffness than one in the middle, a "
           "meter at the right end {} (run {}{}).",
           percent_text(left), percent_text(right), told->run.name,
           results.size() == 1 ? "" : fmt::format(", one of {}", results.size())),
       "Two ends."});
  for (const std::string &line : lines)
    answer.sentences.push_back({line});
  return answer;
}

std::string ends_page(const ReportContent &content) {
  ReportPage page = page_beside(ends_answer(content.ends), Drawing::two_ends, content.ends_keys);
  std::string numbers =
      "<p>Drum and frame move up and down and tilt about the way of travel, on contacts along the width of "
      "the drum, each of which is made and broken by itself. A sensor at one end then shows another soil "
      "than one in the middle, and after a turn round that of the other end.</p>\n";
  for (const PageTable &table : content.tables)
    if (table.section == ends_section) numbers += table_html(table);
  page.section("numbers", "Numbers", numbers);
  page.section(ends_section, "Motion and forces of both ends",
               section_html(content.ends_figures, ends_section));
  page.section("runs", "Commands and versions",
               commands_and_versions(content.ends, report_programs(content.versions)));
  return page.html("A drum with two ends", content.versions);
}

} // namespace drumlin::post
