#include "report/chain/figures.h"

#include "pages/figure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace drumlin::post {

CurveStyle line_style(Transition transition) {
  return transition == Transition::A ? CurveStyle::condition_a : CurveStyle::condition_b;
}

namespace {

constexpr const char *case_names[] = {"I", "II", "III", "IV"};

// The report opens with its two figures of largest weight: if the runs allow, with Fig. 5 (case II, where
// contact is lost) and Fig. 8 (DEM against the reference solution).
constexpr double case_weights[] = {7.0, 10.0, 8.0, 9.0};
constexpr double fig_8_weight = 9.5;
constexpr double impact_weight = 5.0;

/// Distance of markers along a record, in rows: about 24 markers per cycle.
int stride_of(const Run &run) { return std::max(1, run.samples_per_cycle / 24); }

TimeWindow shown(const Run &run) {
  return last_cycles_window(run.complete, shown_cycles, run.chain.period());
}

/// Name of a run's curve: "A DEM" or, for an exact solution that was given as a run, "A direct run".
std::string run_label(const RunResult &result) {
  return transition_name(result.run.transition()) + (result.run.direct ? " direct run" : " DEM");
}
/// Name of the curve of the reference solution in the CSV file.
std::string direct_label(const RunResult &result) {
  return transition_name(result.run.transition()) + " direct";
}

CurveStyle marker_style(Transition transition) {
  return transition == Transition::A ? CurveStyle::direct_a : CurveStyle::direct_b;
}

/// The same in the legend.
std::string direct_legend(const RunResult &result) {
  return transition_name(result.run.transition()) + " reference";
}

/// Whether the reference solution is drawn with the run. Not if the run is an exact solution itself.
bool shows_direct(const RunResult &result) { return !result.run.direct && result.reference != nullptr; }

/// Adds the histories of a run and its reference solution in a window; their second column is the time since
/// its start.
void put_history(CurveTable &table, const RunResult &result, TimeWindow window) {
  const Run &run = result.run;
  const EventSeries series = with_events(run.history, run.events, run.chain, window);
  for (std::size_t i = 0; i < series.time.size(); ++i)
    table.row(run_label(result), {series.time[i], series.time[i] - window.begin, series.overlap[i],
                                  series.velocity[i], series.acceleration[i], series.force[i]});
  if (!shows_direct(result)) return;
  const EventSeries reference = with_events(result.reference->history, {}, run.chain, window);
  for (std::size_t i = 0; i < reference.time.size(); ++i)
    table.row(direct_label(result),
              {reference.time[i], reference.time[i] - window.begin, reference.overlap[i],
               reference.velocity[i], reference.acceleration[i], reference.force[i]});
}
constexpr const char *figure_columns =
    "time (s),time in window (s),overlap (m),drum velocity (m/s),drum acceleration (m/s2),contact force (N)";
constexpr const char *since_ms = "$3*1e3";

/// The words for captions and axes that say how many cycles at the end of the runs a figure shows.
std::string shown_words(const std::vector<const RunResult *> &runs) {
  std::vector<int> counts;
  counts.reserve(runs.size());
  for (const RunResult *result : runs)
    counts.push_back(std::min(shown_cycles, result->run.complete));
  return last_cycles_words(counts);
}

/// Whether all runs have at least long_run_cycles cycles, after which the motion is steady.
bool all_steady(const std::vector<const RunResult *> &runs) {
  return std::all_of(runs.begin(), runs.end(),
                     [](const RunResult *run) { return run->run.complete >= long_run_cycles; });
}

/// Curves in drawing order: B, then A above it, then the markers of the reference solution.
void add_curves(Panel &panel, const std::string &figure, const std::vector<const RunResult *> &runs,
                const std::string &x, const std::string &y) {
  for (const RunResult *result : runs)
    panel.curves.push_back(curve(figure, run_label(*result), x, y, line_style(result->run.transition())));
  int phase = 0;
  for (const RunResult *result : runs) {
    if (!shows_direct(*result)) continue;
    const int stride = stride_of(result->run);
    panel.add(curve(figure, direct_label(*result), x, y, marker_style(result->run.transition()), stride,
                    phase % stride),
              direct_legend(*result));
    phase = stride / 2;
  }
}

std::vector<const RunResult *> runs_of_case(const ReportResults &results, const std::string &name) {
  std::vector<const RunResult *> runs;
  for (const Transition transition : {Transition::B, Transition::A})
    if (const RunResult *run = best_run(results, name, transition)) runs.push_back(run);
  return runs;
}

std::string names_of(const std::vector<const RunResult *> &runs) {
  std::string out;
  for (const RunResult *run : runs)
    out += fmt::format("{}{}: {}", out.empty() ? "" : ", ", transition_name(run->run.transition()),
                       run->run.name);
  return out;
}

/// "A: -43.8 to 96.7 m/s², tension to 66.3 kN" for a caption.
std::string range_words(const RunResult &result) {
  const SteadyExtremes &e = result.chain->extremes;
  std::string words = fmt::format("{}: {:.1f} to {:.1f} m/s²", transition_name(result.run.transition()),
                                  e.acceleration.min, e.acceleration.max);
  if (e.force.min < 0.0) words += fmt::format(", tensile contact force to {:.1f} kN", -e.force.min / 1e3);
  return words;
}

bool all_at_case(const std::vector<const RunResult *> &runs) {
  return std::all_of(runs.begin(), runs.end(), [](const RunResult *run) { return run->run.at_case; });
}

/// "case II", or "own parameters after case II" if a run has others than the paper's.
std::string case_title(const std::string &name, const std::vector<const RunResult *> &runs) {
  return (all_at_case(runs) ? "case " : "own parameters after case ") + name;
}

std::string case_words(const std::string &name, const std::vector<const RunResult *> &runs) {
  std::string own;
  for (const RunResult *run : runs)
    if (!run->run.at_case)
      own += fmt::format("{}{}: {}", own.empty() ? "" : "; ", run->run.name, run->run.not_at_case);
  if (!own.empty()) return fmt::format("Not at the paper's parameters: {}.", own);
  if (!all_steady(runs))
    return fmt::format("With fewer than {} cycles the motion may not be steady yet, as it is in the paper.",
                       long_run_cycles);
  if (name == "I") return "The drum never loses contact with the soil, so A and B coincide.";
  if (name == "II")
    return "The drum loses contact in every cycle. Under A the contact force is tensile until the overlap is "
           "zero, and jumps to zero there. Under B contact ends at zero force, and the next blow is harder.";
  if (name == "III")
    return "At twice the frequency of case II the curves have the same shape, and the peak is less than half "
           "as high. (The paper's caption of Fig. 6 names case II; the figure shows case III.)";
  return "Under A the tensile force of the strong damper keeps the drum in contact, and the acceleration is "
         "a sine. Under B the drum loses contact, and the acceleration jumps at every make of contact. (The "
         "paper's caption of Fig. 7 names case II; the figure shows case IV.)";
}

// ---------------------------------------------------------------------------------------------------------
// Fig. 3

struct ImpactPair {
  const RunResult *a = nullptr;
  const RunResult *b = nullptr;
};

/// The impacts under A and B that Fig. 3 shows: both of one damping ratio, as near as possible to 0.5.
ImpactPair impact_pair(const ReportResults &results) {
  ImpactPair best;
  double best_rank = std::numeric_limits<double>::infinity();
  for (const RunResult &first : results.runs) {
    if (!first.impact || !first.impact->hits) continue;
    ImpactPair pair;
    (first.run.transition() == Transition::A ? pair.a : pair.b) = &first;
    double rank = 1000.0; // one of them alone
    for (const RunResult &second : results.runs) {
      if (!second.impact || !second.impact->hits || second.run.transition() == first.run.transition())
        continue;
      if (std::abs(second.run.impact.damping_ratio - first.run.impact.damping_ratio) > 1.0e-9) continue;
      (second.run.transition() == Transition::A ? pair.a : pair.b) = &second;
      rank = 0.0;
      break;
    }
    rank += std::abs(first.run.impact.damping_ratio - 0.5);
    if (rank < best_rank) {
      best_rank = rank;
      best = pair;
    }
  }
  return best;
}

/// Time from make to break of contact by the closed form, at most until the end of the record (s).
double contact_time(const RunResult &result) {
  return std::min(impact_duration(result.run.impact),
                  result.run.history.time.back() - result.impact->make_time);
}

void plan_impact(const ReportResults &results, FigurePlan &plan) {
  const ImpactPair pair = impact_pair(results);
  if (pair.a == nullptr && pair.b == nullptr) {
    plan.absent.push_back(
        {"impact", "Fig. 3",
         "no run of an impact (deck=impact in parameters.csv) in which the mass hits the soil was given"});
    return;
  }
  const std::string name = "fig3_single_impact";
  CurveTable table("time since make (s),overlap (m),contact force (N)");
  std::vector<const RunResult *> runs;
  for (const RunResult *result : {pair.b, pair.a})
    if (result != nullptr) runs.push_back(result);
  Panel over_overlap{"force against overlap", "overlap (mm)", "contact force (kN)", {}};
  Panel over_time{"force against time", "time since make (ms)", "contact force (kN)", {}};
  std::string words;
  double longest = 0.0; // both are shown until a little after the end of the longer contact
  for (const RunResult *result : runs)
    longest = std::max(longest, contact_time(*result));
  for (const RunResult *result : runs) {
    const Run &run = result->run;
    const ImpactMeasure &measure = *result->impact;
    const double duration = contact_time(*result);
    const TimeWindow window{measure.make_time - 0.1 * longest, measure.make_time + 1.15 * longest};
    const EventSeries series = with_events(run.history, run.events, run.chain, window);
    for (std::size_t i = 0; i < series.time.size(); ++i)
      table.row(run_label(*result), {series.time[i] - measure.make_time, series.overlap[i], series.force[i]});
    constexpr int points = 40;
    for (int i = 0; i <= points; ++i) {
      const double t = duration * i / points;
      const ImpactState state = impact_state(run.impact, t);
      table.row(direct_label(*result), {t, state.overlap, state.force});
    }
    words += fmt::format("{}{}: rebound {:.4f} of the impact speed", words.empty() ? "" : "; ",
                         transition_name(run.transition()), measure.restitution());
  }
  for (const RunResult *result : runs)
    for (auto &[panel, x] : {std::pair(&over_overlap, "$3*1e3"), std::pair(&over_time, "$2*1e3")})
      panel->curves.push_back(
          curve(name, run_label(*result), x, "($4*1e-3)", line_style(result->run.transition())));
  for (const RunResult *result : runs)
    for (auto &[panel, x] : {std::pair(&over_overlap, "$3*1e3"), std::pair(&over_time, "$2*1e3")})
      panel->add(curve(name, direct_label(*result), x, "($4*1e-3)", marker_style(result->run.transition())),
                 transition_name(result->run.transition()) + " closed form");
  over_time.x_range = axis_range(-0.05 * longest * 1e3, 1.15 * longest * 1e3);
  const ImpactParameters &p = runs.front()->run.impact;
  PageFigure figure{"impact", "Fig. 3", "", {}, table.text(), impact_weight};
  figure.figure = {name, "Fig. 3  Single impact without gravity", {over_overlap, over_time}, 2};
  figure.caption =
      fmt::format("Contact force of a single impact (D = {:g}, {:g} m/s) against overlap and against time. "
                  "At the make of contact the force jumps to the same value under both. Under A contact ends "
                  "at zero overlap, after a tensile phase; under B it ends when the force reaches zero, "
                  "while drum and soil still overlap. Markers: closed-form solution. {}. Runs: {}.",
                  p.damping_ratio, p.speed, words, names_of(runs));
  plan.figures.push_back(std::move(figure));
}

// ---------------------------------------------------------------------------------------------------------
// Figs. 4 to 8 of the paper, and figures that the paper does not have

void plan_case(const ReportResults &results, std::size_t index, FigurePlan &plan) {
  const std::string case_name = case_names[index];
  const std::string label = fmt::format("Fig. {}", index + 4);
  const std::vector<const RunResult *> runs = runs_of_case(results, case_name);
  if (runs.empty()) {
    plan.absent.push_back({"steady", label, fmt::format("no run of case {} was given", case_name)});
    return;
  }
  const bool of_paper = all_at_case(runs);
  const std::string name = of_paper ? fmt::format("fig{}_case_{}", index + 4, case_name)
                                    : fmt::format("own_after_case_{}", case_name);
  CurveTable table(figure_columns);
  Panel panel{fmt::format("{}Drum acceleration{}, {}", of_paper ? label + "  " : "",
                          all_steady(runs) ? " at steady state" : "", case_title(case_name, runs)),
              fmt::format("time since the start of {} (ms)", shown_words(runs)),
              "drum acceleration (m/s²)",
              {}};
  panel.tight_x = true;
  std::string ranges;
  for (const RunResult *result : runs) {
    put_history(table, *result, shown(result->run));
    ranges += (ranges.empty() ? "" : "; ") + range_words(*result);
  }
  add_curves(panel, name, runs, since_ms, "6");
  PageFigure figure{"steady", of_paper ? label : "Own parameters", "", {}, table.text(), case_weights[index]};
  figure.figure = {name, panel.title, {panel}, 1};
  figure.caption = fmt::format("Drum acceleration over {}, {}. {} {}. Markers: reference solution. Runs: {}.",
                               shown_words(runs), case_title(case_name, runs), case_words(case_name, runs),
                               ranges, names_of(runs));
  plan.figures.push_back(std::move(figure));
}

/// A figure of a quantity over the last cycles with a panel for each case, of runs under condition B. `fill`
/// adds a run's rows and curves; it returns false if the run lacks the data.
template <class Fill>
void plan_panels(const ReportResults &results, FigurePlan &plan, PageFigure figure,
                 const std::string &quantity, const std::string &columns, Fill fill) {
  CurveTable table(columns);
  std::string absent;
  std::vector<const RunResult *> runs;
  const char letters[] = {'a', 'b', 'c', 'd'};
  for (std::size_t i = 0; i < 4; ++i) {
    const RunResult *result = best_run(results, case_names[i], Transition::B);
    if (result == nullptr) {
      absent += fmt::format("{}{}", absent.empty() ? "" : ", ", case_names[i]);
      continue;
    }
    Panel panel;
    panel.title = fmt::format("({}) {}", letters[i], case_title(case_names[i], {result}));
    panel.tight_x = true;
    if (!fill(*result, table, panel)) continue;
    figure.figure.panels.push_back(panel);
    runs.push_back(result);
  }
  if (runs.empty()) {
    plan.absent.push_back(
        {figure.section, figure.label, "no run under condition B that has the data was given"});
    return;
  }
  figure.csv = table.text();
  figure.caption = fmt::format("{} over {} under condition B: {} Runs: {}.", quantity, shown_words(runs),
                               figure.caption, names_of(runs));
  if (!absent.empty()) figure.caption += fmt::format(" No run was given for case {}.", absent);
  plan.figures.push_back(std::move(figure));
}

void plan_dem_and_direct(const ReportResults &results, FigurePlan &plan) {
  const std::string name = "fig8_dem_and_direct";
  PageFigure figure{"direct", "Fig. 8", "", {}, ""};
  figure.figure = {
      name, "Fig. 8  Drum acceleration by DEM and by the reference solution, condition B", {}, 2};
  figure.weight = fig_8_weight;
  figure.key_panel = 1; // case II, if all are there
  figure.caption = "the run (line), and the exact solution (markers). The table "
                   "below has the differences.";
  plan_panels(
      results, plan, std::move(figure), "Drum acceleration",
      "case,time (s),time in window (s),drum acceleration (m/s2)",
      [&](const RunResult &result, CurveTable &table, Panel &panel) {
        if (result.reference == nullptr) return false;
        const Run &run = result.run;
        const TimeWindow window = shown(run);
        const double number =
            static_cast<double>(std::find(std::begin(case_names), std::end(case_names), run.case_name) -
                                std::begin(case_names) + 1);
        const std::string line = run.case_name + " " + run_label(result);
        const std::string marks = run.case_name + " " + direct_label(result);
        const EventSeries series = with_events(run.history, run.events, run.chain, window);
        for (std::size_t i = 0; i < series.time.size(); ++i)
          table.row(line, {number, series.time[i], series.time[i] - window.begin, series.acceleration[i]});
        const EventSeries reference = with_events(result.reference->history, {}, run.chain, window);
        for (std::size_t i = 0; i < reference.time.size(); ++i)
          table.row(marks,
                    {number, reference.time[i], reference.time[i] - window.begin, reference.acceleration[i]});
        panel.x_label = "time in window (ms)";
        panel.y_label = "drum acceleration (m/s²)";
        panel.curves = {curve(name, line, "$4*1e3", "5", CurveStyle::condition_b),
                        curve(name, marks, "$4*1e3", "5", CurveStyle::direct_b, stride_of(run))};
        panel.curves[0].title = run.direct ? "direct run" : "DEM";
        panel.curves[1].title = "reference solution";
        return true;
      });
}

/// Number of cycles to draw: 1 if the last cycle repeats the one before, else 2. A second, equal orbit would
/// fill the gaps of the dashed line.
int orbit_cycles(const Run &run) {
  const std::vector<double> &x = run.history.x_drum;
  const auto cycle = static_cast<std::size_t>(run.samples_per_cycle);
  const std::size_t end = cycle * static_cast<std::size_t>(run.complete);
  if (run.complete < 2 || end >= x.size()) return 2;
  double largest = 0.0;
  double difference = 0.0;
  for (std::size_t i = end - cycle; i < end; ++i) {
    largest = std::max(largest, std::abs(x[i]));
    difference = std::max(difference, std::abs(x[i] - x[i - cycle]));
  }
  return difference < 1.0e-2 * largest ? 1 : 2;
}

void plan_loops(const ReportResults &results, std::size_t index, FigurePlan &plan) {
  const std::string case_name = case_names[index];
  const std::string label = fmt::format("Fig. R{}", index + 1);
  const std::vector<const RunResult *> runs = runs_of_case(results, case_name);
  if (runs.empty()) {
    plan.absent.push_back({"loops", label, fmt::format("no run of case {} was given", case_name)});
    return;
  }
  const std::string name = fmt::format("figR{}_loops_case_{}", index + 1, case_name);
  CurveTable table(figure_columns);
  Panel phase{"phase portrait", "drum position (mm), 0 = just touching", "drum velocity (m/s)", {}};
  Panel loop{"force against overlap", "overlap (mm)", "contact force (kN)", {}};
  double largest = 0.0;
  for (const RunResult *result : runs) {
    const Run &run = result->run;
    const TimeWindow window = last_cycles_window(run.complete, orbit_cycles(run), run.chain.period());
    put_history(table, *result, window);
    const EventSeries series = with_events(run.history, run.events, run.chain, window);
    for (const double overlap : series.overlap)
      largest = std::max(largest, overlap);
  }
  add_curves(phase, name, runs, "(-$4*1e3)", "5");
  add_curves(loop, name, runs, "$4*1e3", "($7*1e-3)");
  loop.x_range = axis_range(-0.12 * largest * 1e3, 1.08 * largest * 1e3);
  PageFigure figure{"loops", label, "", {}, table.text()};
  figure.figure = {name,
                   fmt::format("{}  Orbits{}, {}", label, all_steady(runs) ? " at steady state" : "",
                               case_title(case_name, runs)),
                   {phase, loop},
                   2};
  figure.caption = fmt::format(
      "The last cycle of each run, or the last two if they differ, {}. Left: drum velocity against drum "
      "position. Right: contact force against overlap; the area of the loop is the energy that the contact "
      "dissipates per cycle, and a vertical line is the jump of the force at a make{}. Most of the time "
      "without contact is outside of the right panel. Runs: {}.",
      case_title(case_name, runs), " or, under A, at break", names_of(runs));
  if (case_name == "I" && all_at_case(runs) && all_steady(runs))
    figure.caption = fmt::format("Case I, last cycle. Left: drum velocity against drum position. Right: "
                                 "contact force against overlap; the area of the loop is the energy that the "
                                 "contact dissipates per cycle. A and B coincide. Runs: {}.",
                                 names_of(runs));
  plan.figures.push_back(std::move(figure));
}

void plan_restitution(const ReportResults &results, FigurePlan &plan) {
  const std::string name = "figR5_restitution";
  CurveTable table("damping ratio D (-),restitution e (-)");
  bool any_a = false;
  bool any_b = false;
  double largest = 1.2;
  for (const RunResult &result : results.runs) {
    if (!result.impact || !result.impact->hits) continue;
    const bool a = result.run.transition() == Transition::A;
    (a ? any_a : any_b) = true;
    largest = std::max(largest, 1.1 * result.run.impact.damping_ratio);
    table.row(run_label(result),
              {result.run.impact.damping_ratio, result.impact->ended ? result.impact->restitution() : 0.0});
  }
  if (!any_a && !any_b) {
    plan.absent.push_back(
        {"impact", "Fig. R5", "no run of an impact in which the mass hits the soil was given"});
    return;
  }
  constexpr int points = 200;
  for (const char *transition : {"A", "B"})
    for (int i = 0; i <= points; ++i) {
      const double D = largest * i / points;
      table.row(fmt::format("{} closed form", transition), {D, closed_form_restitution(transition, D)});
    }
  Panel panel{"Fig. R5  Restitution of a single impact", "damping ratio D (-)", "restitution e (-)", {}};
  panel.x_range = "[0:*]";
  panel.curves = {curve(name, "B closed form", "$2", "3", CurveStyle::condition_b),
                  curve(name, "A closed form", "$2", "3", CurveStyle::condition_a)};
  if (any_b) panel.curves.push_back(curve(name, "B DEM", "$2", "3", CurveStyle::measured_b));
  if (any_a) panel.curves.push_back(curve(name, "A DEM", "$2", "3", CurveStyle::measured_a));
  PageFigure figure{"impact", "Fig. R5", "", {}, table.text()};
  figure.figure = {name, panel.title, {panel}, 1};
  figure.caption = "Restitution (rebound speed over impact speed) against the damping ratio: closed forms "
                   "(lines) and the given runs (markers). It is larger under B, since no tensile force holds "
                   "the drum back; under A there is no rebound for D of 1 and more.";
  plan.figures.push_back(std::move(figure));
}

void plan_errors(const ReportResults &results, FigurePlan &plan) {
  const std::string name = "figR6_velocity_error";
  CurveTable table("run number (-),relative RMS error of drum velocity (-)");
  Panel panel{"Fig. R6  Error of drum velocity against the reference solution",
              "",
              fmt::format("relative RMS error, last {} cycles (-)", error_cycles),
              {}};
  panel.log_y = true;
  bool any_a = false;
  bool any_b = false;
  for (const RunResult &result : results.runs) {
    if (!result.chain || result.run.direct || !(result.chain->velocity_error_last > 0.0)) continue;
    panel.x_ticks.push_back(result.run.name);
    const bool a = result.run.transition() == Transition::A;
    (a ? any_a : any_b) = true;
    table.row(run_label(result),
              {static_cast<double>(panel.x_ticks.size()), result.chain->velocity_error_last});
  }
  if (panel.x_ticks.empty()) {
    plan.absent.push_back(
        {"direct", "Fig. R6", "no run of the chain in an engine was given whose error is above 0"});
    return;
  }
  if (any_a) panel.curves.push_back(curve(name, "A DEM", "$2", "3", CurveStyle::measured_a));
  if (any_b) panel.curves.push_back(curve(name, "B DEM", "$2", "3", CurveStyle::measured_b));
  PageFigure figure{"direct", "Fig. R6", "", {}, table.text()};
  figure.figure = {name, panel.title, {panel}, 1};
  figure.caption =
      fmt::format("Relative RMS error of the drum velocity of each run over its last {} cycles, or all of a "
                  "shorter run, against the reference solution at equal times; logarithmic scale.",
                  error_cycles);
  plan.figures.push_back(std::move(figure));
}

void plan_roller(const ReportResults &results, FigurePlan &plan) {
  const std::string name = "figR7_roller_force";
  PageFigure figure{"roller", "Fig. R7", "", {}, ""};
  figure.figure = {name, "Fig. R7  Contact force: of the law, and from measured motion, condition B", {}, 2};
  figure.caption = "from the contact law (line), and from the equation of motion, m2 a2 + m3 a3 + (m2 + m3) "
                   "g + Fe, with accelerations by differences of the recorded positions (markers; none near "
                   "a make or break of contact, where the force jumps).";
  plan_panels(
      results, plan, std::move(figure), "Contact force", "case,time (s),time in window (s),contact force (N)",
      [&](const RunResult &result, CurveTable &table, Panel &panel) {
        const Run &run = result.run;
        if (!result.chain->roller) return false;
        const TimeWindow window = shown(run);
        const double number =
            static_cast<double>(std::find(std::begin(case_names), std::end(case_names), run.case_name) -
                                std::begin(case_names) + 1);
        const std::string law = run.case_name + " law";
        const std::string roller = run.case_name + " roller";
        const EventSeries series = with_events(run.history, run.events, run.chain, window);
        for (std::size_t i = 0; i < series.time.size(); ++i)
          table.row(law, {number, series.time[i], series.time[i] - window.begin, series.force[i]});
        for (std::size_t i = 0; i < run.history.size(); ++i)
          if (run.history.time[i] >= window.begin && run.history.time[i] < window.end)
            table.row(roller, {number, run.history.time[i], run.history.time[i] - window.begin,
                               result.chain->roller->force[i]});
        panel.x_label = "time in window (ms)";
        panel.y_label = "contact force (kN)";
        panel.curves = {curve(name, law, "$4*1e3", "($5*1e-3)", CurveStyle::condition_b),
                        curve(name, roller, "$4*1e3", "($5*1e-3)", CurveStyle::direct_a, stride_of(run))};
        panel.curves[0].title = "contact law";
        panel.curves[1].title = "from measured motion";
        return true;
      });
}

} // namespace

FigurePlan plan_figures(const ReportResults &results) {
  FigurePlan plan;
  plan_impact(results, plan);
  plan_restitution(results, plan);
  for (std::size_t i = 0; i < 4; ++i)
    plan_case(results, i, plan);
  for (std::size_t i = 0; i < 4; ++i)
    plan_loops(results, i, plan);
  plan_dem_and_direct(results, plan);
  plan_errors(results, plan);
  plan_roller(results, plan);
  return plan;
}

} // namespace drumlin::post
