#include "lab/accuracy/page.h"

#include "engine/deck_run.h"
#include "support/files.h"

#include "advice/steps.h"
#include "experiment/study.h"
#include "lab/accuracy/results.h"
#include "pages/acceptance.h"
#include "pages/figure_data.h"
#include "pages/page.h"
#include "support/convergence.h"

#include "runs/chain_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr std::array<const char *, 4> cases = {"I", "II", "III", "IV"};
constexpr std::array<double, 4> ratios = {0.2, 0.5, 0.8, 2.0};
constexpr std::array<double, 4> targets = {1e-2, 1e-3, 1e-4, 1e-5};

/// An integration scheme under a condition, and the style of its curve.
struct Series {
  const char *stepping;
  Transition transition;
  CurveStyle style;
  const char *name; ///< in legends
};
constexpr std::array<Series, 5> all_series = {
    {{"second", Transition::B, CurveStyle::series_1, "second B"},
     {"second", Transition::A, CurveStyle::series_2, "second A"},
     {"stock", Transition::B, CurveStyle::series_3, "stock B"},
     {"stock", Transition::A, CurveStyle::series_4, "stock A"},
     {"reference", Transition::B, CurveStyle::series_5, "engine law B"}}};

struct Data {
  std::vector<ChainPoint> chain;
  std::vector<ImpactPoint> impacts;
  std::vector<ScalingPoint> scaling;

  std::vector<ErrorPoint> curve(const char *name, const Series &series, double ChainErrors::*error) const {
    return chain_curve(chain, name, series.transition, series.stepping, error);
  }
  std::vector<ErrorPoint> curve(double ratio, const Series &series) const {
    return impact_curve(impacts, series.transition, ratio, series.stepping, &ReboundErrors::worst);
  }
};

/// A number of steps, rounded for tables.
std::string steps_text(double steps) { return fmt::format("{:g}", std::round(10.0 * steps) / 10.0); }

std::string steps_needed_text(const std::vector<ErrorPoint> &points, double error) {
  const std::optional<double> steps = steps_needed(points, error);
  return steps ? fmt::format("{:.10g}", *steps) : fmt::format("> {:.10g}", points.back().steps);
}

/// The order of convergence, fitted where the error is 1 % and smaller: coarser steps need not be in the
/// asymptotic range.
std::optional<FittedOrder> order_of(const std::vector<ErrorPoint> &points) {
  const std::optional<double> from = steps_needed(points, 1e-2);
  return from ? fitted_order(points, *from) : std::nullopt;
}

/// Steps needed over those of the second-order scheme; a lower bound where no measured number of steps
/// reached the error.
struct Ratio {
  double value;
  bool at_least;
};
std::optional<Ratio> ratio_to(const std::vector<ErrorPoint> &second, const std::vector<ErrorPoint> &points,
                              double error) {
  const std::optional<double> base = steps_needed(second, error);
  if (!base || points.empty()) return std::nullopt;
  const std::optional<double> steps = steps_needed(points, error);
  return Ratio{steps.value_or(points.back().steps) / *base, !steps};
}

void add_order_row(PageTable &table, const std::string &what, const Series &series,
                   const std::vector<ErrorPoint> &points, const std::vector<ErrorPoint> &second) {
  if (points.empty()) return;
  std::vector<std::string> row = {what, transition_name(series.transition), series.stepping};
  const std::optional<FittedOrder> fit = order_of(points);
  const std::optional<FittedOrder> finer = fitted_order(points, finer_half(points));
  row.push_back(fit ? fmt::format("{:.2f}", fit->order) : "–");
  row.push_back(fit ? fmt::format("{:.2f}", fit->scatter) : "–");
  row.push_back(fit ? steps_text(fit->from) + " to " + steps_text(fit->to) : "–");
  row.push_back(finer ? fmt::format("{:.2f}", finer->order) : "–");
  for (const double error : targets)
    row.push_back(steps_needed_text(points, error));
  for (const double error : targets) {
    const std::optional<Ratio> ratio =
        series.stepping == std::string("second") ? std::nullopt : ratio_to(second, points, error);
    row.push_back(ratio ? fmt::format("{}{:.3g}", ratio->at_least ? "> " : "", ratio->value) : "–");
  }
  table.add(row);
}

PageTable order_table(const Data &data) {
  PageTable table("orders", "Orders of convergence, and steps needed",
                  "what | transition | stepping | order (-) | scatter (decades) | fitted over steps | order "
                  "of the finer half (-)",
                  3);
  for (const double error : targets)
    table.header.push_back(fmt::format("steps for {:g}", error));
  for (const double error : targets)
    table.header.push_back(fmt::format("ratio to second at {:g}", error));
  for (const char *name : cases)
    for (const Series &series : all_series) {
      const Series second = {"second", series.transition, series.style, ""};
      add_order_row(table, fmt::format("chain {}", name), series,
                    data.curve(name, series, &ChainErrors::velocity),
                    data.curve(name, second, &ChainErrors::velocity));
    }
  for (const double ratio : ratios)
    for (const Series &series : all_series) {
      const Series second = {"second", series.transition, series.style, ""};
      add_order_row(table, fmt::format("impact D = {:g}", ratio), series, data.curve(ratio, series),
                    data.curve(ratio, second));
    }
  table.notes = {"Order: error ~ steps^-order, fitted where the error is 1 % and smaller; scatter: root mean "
                 "square distance from that line. Finer half: fitted over the finer half of the steps on a "
                 "logarithmic scale. Chain: relative RMS error of drum velocity, steps per cycle. Impact: "
                 "worst absolute error of the restitution, steps per undamped contact.",
                 "Steps for an error: the smallest measured number from which on all larger numbers have at "
                 "most that error; > N: not with N steps. A ratio with > is a lower bound for the same "
                 "reason. Stepping second is the second-order scheme, stock velocity Verlet with the "
                 "plugin's law, reference the engine's own law, hooke/stiffness with limitForce."};
  return table;
}

Acceptance at_most(const std::string &what, double value, double bound) {
  return {fmt::format("{}: at most {:g}", what, bound), fmt::format("{:.2g}", value), value <= bound};
}

Acceptance at_least(const std::string &what, const Ratio &ratio, double bound) {
  return {fmt::format("{}: at least {:g}", what, bound),
          fmt::format("{}{:.3g}", ratio.at_least ? "> " : "", ratio.value), ratio.value >= bound};
}

std::optional<double> error_at(const std::vector<ErrorPoint> &points, double steps) {
  for (const ErrorPoint &point : points)
    if (point.steps == steps) return point.error;
  return std::nullopt;
}

/// The criterion that no error of the chain has grown since the table was made from which `drumlin advise`
/// answers.
Acceptance not_larger(const std::vector<ChainPoint> &chain, bool complete) {
  const std::vector<std::string> larger =
      larger_errors(chain, read_points(input_file("study/accuracy") / "chain.csv", chain_points()), complete);
  return {fmt::format("every error of the chain: at most {:g} times that of the same row of "
                      "inputs/study/accuracy/chain.csv",
                      allowed_growth),
          larger.empty() ? fmt::format("all {} rows", chain.size())
                         : fmt::format("all rows but {}", fmt::join(larger, "; ")),
          larger.empty()};
}

/// The acceptance criteria that the measured points can decide.
std::vector<Acceptance> judge(const Data &data, bool complete) {
  constexpr std::array<double, 4> at_800 = {1e-5, 1.2e-4, 3e-5, 2e-4}, at_6400 = {2e-7, 2e-6, 5e-7, 2e-6};
  const Series &second = all_series[0], &reference = all_series[4];
  std::vector<Acceptance> criteria = {not_larger(data.chain, complete)};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const std::vector<ErrorPoint> curve = data.curve(cases[i], second, &ChainErrors::velocity);
    for (const auto &[steps, bound] : {std::pair{800.0, at_800[i]}, std::pair{6400.0, at_6400[i]}})
      if (const std::optional<double> error = error_at(curve, steps))
        criteria.push_back(at_most(
            fmt::format("velocity error, chain {} B, {:g} steps per cycle", cases[i], steps), *error, bound));
  }
  for (const Series &series : all_series) {
    if (series.stepping != std::string("second")) continue;
    const std::string transition = transition_name(series.transition);
    for (const char *name : cases)
      if (const auto fit = order_of(data.curve(name, series, &ChainErrors::velocity)))
        criteria.push_back(at_least(fmt::format("order, chain {} {}, {:g} to {:g} steps per cycle", name,
                                                transition, fit->from, fit->to),
                                    {fit->order, false}, 1.9));
    for (const double ratio : ratios)
      if (const auto fit = order_of(data.curve(ratio, series)))
        criteria.push_back(at_least(fmt::format("order, impact {}, D = {:g}, {:g} to {:g} steps per contact",
                                                transition, ratio, fit->from, fit->to),
                                    {fit->order, false}, 1.9));
    for (const auto &[ratio, first, last] :
         {std::tuple{0.2, 3e-4, 2e-5}, std::tuple{0.5, 1.5e-4, 1e-5}, std::tuple{2.0, 3e-5, 2e-6}})
      for (const auto &[steps, bound] : {std::pair{100.0, first}, std::pair{400.0, last}})
        if (const std::optional<double> error = error_at(data.curve(ratio, series), steps))
          criteria.push_back(
              at_most(fmt::format("restitution error, impact {}, D = {:g}, {:g} steps per contact",
                                  transition, ratio, steps),
                      *error, bound));
  }
  double worst = 0.0;
  long unmatched = 0;
  constexpr int fine = 200;
  for (const ChainPoint &point : data.chain) {
    if (point.stepping != "second" || point.steps_per_cycle < fine) continue;
    if (!std::isfinite(point.errors.event_time_s)) ++unmatched;
    const double step = table1_case(point.chain_case, point.transition).period() / point.steps_per_cycle;
    worst = std::max(worst, point.errors.event_time_s / step);
  }
  const std::string from = fmt::format(", from {} steps per cycle on", fine);
  if (worst > 0.0) {
    criteria.push_back(at_most("time of any make or break, in steps" + from, worst, 0.05));
    criteria.push_back(
        at_most("runs whose events do not match one by one" + from, static_cast<double>(unmatched), 0.0));
  }
  for (const auto &[error, bound] : {std::pair{1e-3, 12.0}, std::pair{1e-5, 100.0}})
    for (std::size_t i = 1; i < cases.size(); ++i)
      if (const auto ratio = ratio_to(data.curve(cases[i], second, &ChainErrors::velocity),
                                      data.curve(cases[i], reference, &ChainErrors::velocity), error))
        criteria.push_back(at_least(
            fmt::format("steps of the engine's own law over ours, chain {} B, error {:g}", cases[i], error),
            *ratio, bound));
  return criteria;
}

PageTable scaling_table(const Data &data) {
  PageTable table("scaling", "Advice for chains that were not measured",
                  "set | transition | stepping | k (MN/m) | D (-) | f (Hz) | Fw (kN) | m2 (kg) | m3 (kg) | "
                  "k23 (MN/m) | c23 (kN s/m) | error asked for | steps per cycle advised | error found",
                  3);
  for (const ScalingPoint &point : data.scaling) {
    const ChainParameters &p = point.parameters;
    table.add({std::to_string(point.set), transition_name(p.transition), point.stepping,
               fmt::format("{:.1f}", p.k * 1e-6), fmt::format("{:.2f}", p.D),
               fmt::format("{:.1f}", 1.0 / p.period()), fmt::format("{:.0f}", p.Fw * 1e-3),
               fmt::format("{:.0f}", p.m2), fmt::format("{:.0f}", p.m3), fmt::format("{:.2f}", p.k23 * 1e-6),
               fmt::format("{:.1f}", p.c23 * 1e-3), fmt::format("{:g}", point.target),
               std::to_string(point.steps_per_cycle), fmt::format("{:.2g}", point.error)},
              point.error <= point.target ? RowState::agrees : RowState::differs);
  }
  const int drawn = data.scaling.empty() ? 0 : data.scaling.back().set;
  std::vector<int> sets;
  for (const ScalingPoint &point : data.scaling)
    sets.push_back(point.set);
  sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
  table.criterion = "chains have at most the error asked for";
  table.notes = {
      fmt::format("Advice was {}. Of {} chains drawn at random {} were refused: within a run they keep the "
                  "memory of their initial state, so their motion does not converge with the time step.",
                  scaling_summary(data.scaling), drawn, drawn - static_cast<int>(sets.size()))};
  return table;
}

/// A figure of an error of the chain over steps or time, with a panel for each case.
struct ChainFigure {
  const char *name;
  const char *title;
  const char *y_label;
  double ChainErrors::*error;
  bool over_time;      ///< over the wall time of a cycle instead of its steps
  const char *y_range; ///< of all panels
  const char *caption;
};

PageFigure chain_figure(const Data &data, const ChainFigure &wanted) {
  const std::string x_label = wanted.over_time ? "wall time per cycle (s)" : "steps per cycle";
  PageFigure figure;
  figure.caption = wanted.caption;
  figure.figure = {wanted.name, wanted.title, {}, 2};
  CurveTable table(x_label + "," + wanted.y_label);
  for (const char *chain_case : cases) {
    Panel panel{fmt::format("case {}", chain_case), x_label, wanted.y_label, {}};
    panel.log_x = panel.log_y = true;
    panel.x_range = wanted.over_time ? "" : "[40:3e5]";
    panel.y_range = wanted.y_range;
    for (const Series &series : all_series) {
      const std::vector<ErrorPoint> errors = data.curve(chain_case, series, wanted.error);
      const std::vector<ErrorPoint> seconds = data.curve(chain_case, series, &ChainErrors::loop_s);
      const std::string curve_name = fmt::format("{} {}", chain_case, series.name);
      bool any = false;
      for (std::size_t i = 0; i < errors.size(); ++i) {
        if (!(errors[i].error > 0.0)) continue; // not measured, or no event
        table.row(curve_name,
                  {wanted.over_time ? seconds[i].error / accuracy_cycles : errors[i].steps, errors[i].error});
        any = true;
      }
      if (!any) continue;
      panel.add(curve(wanted.name, curve_name, "$2", "3", series.style), series.name);
    }
    if (!panel.curves.empty()) figure.figure.panels.push_back(panel);
  }
  figure.csv = table.text();
  return figure;
}

PageFigure impact_figure(const Data &data) {
  const std::string name = "impacts";
  PageFigure figure;
  figure.caption = "Worst error of the restitution over the phases of the make of contact within a time "
                   "step, against the closed form. Under A there is no rebound at D = 2.";
  CurveTable table("steps per contact,worst restitution error (-)");
  figure.figure = {name, "Restitution of single impacts: worst error", {}, 2};
  for (const double ratio : ratios) {
    Panel panel{fmt::format("D = {:g}", ratio),
                "steps per undamped contact, π/(ω_0 dt)",
                "worst error of restitution (-)",
                {}};
    panel.log_x = panel.log_y = true;
    panel.x_range = "[10:2000]";
    panel.y_range = "[1e-8:1]";
    for (const Series &series : all_series) {
      const std::string curve_name = fmt::format("D{:g} {}", ratio, series.name);
      const std::vector<ErrorPoint> points = data.curve(ratio, series);
      for (const ErrorPoint &point : points)
        table.row(curve_name, {point.steps, point.error});
      if (points.empty()) continue;
      panel.add(curve(name, curve_name, "$2", "3", series.style), series.name);
    }
    if (panel.curves.empty()) continue;
    // Lines of orders 1 and 2 from a common point above the curves.
    for (const int order : {1, 2}) {
      const std::string curve_name = fmt::format("order {}", order);
      if (figure.figure.panels.empty())
        for (const double steps : {12.5, 1600.0})
          table.row(curve_name, {steps, 0.5 * std::pow(12.5 / steps, order)});
      panel.curves.push_back(
          curve(name, curve_name, "$2", "3", order == 1 ? CurveStyle::direct_line : CurveStyle::limit));
    }
    figure.figure.panels.push_back(panel);
  }
  figure.csv = table.text();
  return figure;
}

constexpr ChainFigure velocity_error = {
    "velocity_error",
    "Error of drum velocity against steps per cycle",
    "relative RMS error (-)",
    &ChainErrors::velocity,
    false,
    "[1e-9:1]",
    "Relative RMS error of drum velocity. Where contact is lost, the error of stock stepping depends on "
    "where within a step the make of contact happens to be, and scatters; the second-order scheme locates "
    "the make within the step."};
constexpr ChainFigure velocity_error_time = {
    "velocity_error_time",
    "Error of drum velocity against wall time",
    "relative RMS error (-)",
    &ChainErrors::velocity,
    true,
    "[1e-9:1]",
    "The same over the wall time of a cycle, by the engine's clock, without starting and settling. Runs of "
    "the engine's own law write drum velocity only; the others also write events, cycles and every column of "
    "chain.csv."};
constexpr ChainFigure force_error = {"force_error",
                                     "Error of the peak contact force",
                                     "relative error (-)",
                                     &ChainErrors::force,
                                     false,
                                     "[1e-10:1]",
                                     "Peak contact force over the last five cycles, of all steps and of both "
                                     "sides of the located makes of contact."};
constexpr ChainFigure acceleration_error = {
    "acceleration_error",
    "Error of the peak drum acceleration",
    "relative error (-)",
    &ChainErrors::acceleration,
    false,
    "[1e-10:1]",
    "Largest magnitude of drum acceleration over the last five cycles, evaluated as the peak force."};
constexpr ChainFigure event_time_error = {
    "event_time_error",
    "Largest error of the time of a make or break of contact",
    "error (s)",
    &ChainErrors::event_time_s,
    false,
    "[1e-11:1e-2]",
    "Largest error of the time of any event, in runs whose events correspond one by one to those of the "
    "reference solution. Cases without loss of contact have no events."};
constexpr ChainFigure energy_residual = {
    "energy_residual",
    "Energy error",
    "energy error over the exciter's work (-)",
    &ChainErrors::energy,
    false,
    "[1e-10:1]",
    "Work of the exciter minus dissipated energy minus changes of kinetic, potential and stored energy, over "
    "that work. The power is integrated by the trapezoidal rule over whole steps, also over a step in which "
    "it jumps at a make: where contact is lost, the energy error therefore is of first order for every "
    "scheme."};

/// Steps needed for an error of 0.1 % of drum velocity in case II under B, by the second-order scheme and by
/// the engine's own law; empty if it was not measured.
std::string steps_words(const Data &data) {
  constexpr double error = 1e-3;
  const auto steps = [&](const Series &series) {
    const std::vector<ErrorPoint> points = data.curve("II", series, &ChainErrors::velocity);
    return points.empty() ? std::string() : steps_needed_text(points, error);
  };
  const std::string second = steps(all_series[0]);
  const std::string reference = steps(all_series[4]);
  if (second.empty() || reference.empty()) return {};
  return fmt::format("An error of 0.1 % of drum velocity in case II (condition B) takes {} steps per cycle "
                     "with the second-order scheme and {} with the engine's own law.",
                     second, reference);
}

/// Adds figures to a page and numbers them; those without any curve are left out.
class Figures {
public:
  explicit Figures(Page &page) : page_(page) {}
  void add(PageFigure figure, double weight = 0.0) {
    if (figure.figure.panels.empty()) return;
    figure.weight = weight;
    figure.key_panel = 1; // of the chains case II, where contact is lost
    figure.label = fmt::format("Fig. {}", ++number_);
    page_.figure(figure);
  }

private:
  Page &page_;
  int number_ = 0;
};

} // namespace

void write_accuracy_page(const fs::path &out, bool complete) {
  const Data data = {read_points(out / "chain.csv", chain_points()),
                     read_points(out / "impacts.csv", impact_points()),
                     read_points(out / "scaling.csv", scaling_points())};
  const PageTable orders = order_table(data);
  write_files({{out / "orders.csv", table_csv(orders)}});

  Page page(out, "Accuracy of the time integration", Drawing::chain);
  page.answer(fmt::format(
      "Runs of the chain and of single impacts in the engine at many step sizes, compared with the reference "
      "solution of the same chain and with the closed form of the restitution. Second is the "
      "plugin's second-order scheme, stock the engine's velocity Verlet scheme with the plugin's contact "
      "law; the engine's own law is hooke/stiffness with its force limited to compression. Chains run for {} "
      "cycles; errors are those of the last {}.",
      accuracy_cycles, accuracy_window));
  const std::vector<Acceptance> criteria = judge(data, complete);
  if (const std::string words = steps_words(data); !words.empty()) page.answer(words);
  page.answer(criteria);
  page.section("Acceptance criteria");
  page.table(acceptance_table(criteria));
  Figures figures(page);
  page.section("Error against steps");
  figures.add(chain_figure(data, velocity_error), 2.0);
  page.table(orders);
  figures.add(impact_figure(data), 1.0);
  page.section("Error against time");
  figures.add(chain_figure(data, velocity_error_time));
  page.section("Peaks, events, energy");
  for (const ChainFigure &wanted : {force_error, acceleration_error, event_time_error, energy_residual})
    figures.add(chain_figure(data, wanted));
  if (!data.scaling.empty()) {
    page.section("Advice");
    page.paragraph(fmt::format(
        "The command advise transfers these curves to other chains by the resolution max(sqrt(k/m2), omega) "
        "dt and by the sensitivity of the chain to its parameters, by exact solutions; it "
        "takes the worst of the four cases and multiplies its steps by {:g}.",
        scaling_margin));
    page.table(scaling_table(data));
  }
  page.write();
}

} // namespace drumlin::post
