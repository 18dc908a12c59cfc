#include "lab/stability/extremes.h"

#include "chain/analysis.h"
#include "chain/exact_solution.h"
#include "chain/parameters.h"
#include "engine/places.h"
#include "lab/accuracy/runs.h"
#include "lab/stability/bed.h"
#include "runs/chain_files.h"
#include "runs/parameter_file.h"
#include "support/progress.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <stdexcept>

namespace drumlin::post {

namespace {

constexpr double two_pi = 6.283185307179586;
constexpr double infinite = std::numeric_limits<double>::infinity();

double largest(const std::vector<double> &values) {
  double most = 0.0;
  for (const double value : values)
    most = std::isfinite(value) ? std::max(most, std::fabs(value)) : infinite;
  return most;
}

/// Highest angular frequency of the undamped chain in contact, rad/s.
double fastest(const ChainParameters &p) {
  const double a = (p.k + p.k23) / p.m2;
  const double b = p.k23 / p.m3;
  const double half = 0.5 * (a - b);
  return std::sqrt(0.5 * (a + b) + std::sqrt(half * half + p.k23 / p.m2 * b));
}

/// A run of in.chain.
struct ChainPlan {
  ChainParameters parameters = table1_case("II", Transition::B);
  int cycles = 3;
  double w0_dt = 0.05; ///< at most, of the fastest motion and of the excitation
  int samples = 50;    ///< per cycle

  int steps() const {
    const double w = std::max(fastest(parameters), parameters.omega);
    return samples *
           std::max(1, static_cast<int>(std::ceil(two_pi * w / (parameters.omega * w0_dt * samples))));
  }
  /// The variables that differ from the deck's defaults.
  Variables variables() const {
    const ChainParameters usual = table1_case("II", Transition::B);
    Variables given;
    for (const ChainNumber &number : chain_numbers)
      if (parameters.*number.value != usual.*number.value)
        given.emplace_back(number.name, number_text(parameters.*number.value));
    given.insert(given.end(), {{"cycles", std::to_string(cycles)},
                               {"steps_per_cycle", std::to_string(steps())},
                               {"samples_per_cycle", std::to_string(samples)}});
    return given;
  }
};

ExactSolution direct(const ChainPlan &plan) {
  ExactOptions options;
  options.cycles = plan.cycles;
  options.samples_per_cycle = plan.samples;
  return solve_chain(plan.parameters, options);
}

/// Where the drum rests in the soil without excitation, m.
double rest_overlap(const ChainParameters &p) { return (p.m2 + p.m3) * p.g / p.k; }

/// The drum's displacement from its position at rest.
std::vector<double> from_rest(std::vector<double> x_drum, const ChainParameters &p) {
  for (double &x : x_drum)
    x += rest_overlap(p);
  return x_drum;
}

/// Relative RMS error of a column of the run.
double against_direct(const ChainPlan &plan, const DeckRun &run,
                      const std::function<std::vector<double>(const ChainHistory &)> &column) {
  const ChainHistory reference = direct(plan).history;
  const ChainHistory history = read_chain(run.file("chain.csv"));
  if (history.size() != reference.size())
    throw std::runtime_error(fmt::format("{} rows instead of {}", history.size(), reference.size()));
  return relative_rms(column(history), column(reference), 0, reference.size());
}

Extreme chain_row(const std::string &group, const std::string &name, const ChainPlan &plan, double allowed) {
  Extreme row;
  row.group = group;
  row.name = name;
  row.deck = "chain/in.chain";
  row.variables = plan.variables();
  row.expected = "velocity of the drum as the exact solution's (relative RMS)";
  row.allowed = allowed;
  row.error = [plan](const DeckRun &run) {
    return against_direct(plan, run.must_succeed(),
                          [](const ChainHistory &history) { return history.v_drum; });
  };
  return row;
}

/// A chain without excitation, which must stay at rest for so many steps or a few more.
Extreme rest_row(const std::string &name, ChainPlan plan, double steps) {
  plan.parameters.Fw = 0.0;
  plan.samples = 1;
  plan.cycles = static_cast<int>(std::ceil(steps / plan.steps()));
  Extreme row = chain_row("At rest", fmt::format("{}; {:.0e} steps", name, steps), plan, 1e-9);
  row.limit = 1800.0;
  row.expected = "drum stays at its static overlap (largest distance over that overlap)";
  row.error = [p = plan.parameters](const DeckRun &run) {
    return largest(from_rest(read_chain(run.must_succeed().file("chain.csv")).x_drum, p)) / rest_overlap(p);
  };
  return row;
}

/// A drum kept in contact by an excitation that is slow compared with the contact, at the longest step that
/// must be stable. The ratio of bond to contact is that of case II: the limit on the step is of the contact,
/// and a stiffer bond has a limit of its own.
Extreme edge_row(const std::string &name, ChainPlan plan, int cycles) {
  ChainParameters &p = plan.parameters;
  const double softer = p.k / ChainParameters().k;
  p.k23 *= softer;
  p.c23 *= std::sqrt(softer);
  p.g *= std::min(1.0, softer); // with a soft bond the frame would leave the box
  constexpr double w0_dt = 1.95;
  constexpr int steps = 5000;
  p.omega = two_pi * fastest(p) / (w0_dt * steps);
  p.Fw = 0.3 * (p.m2 + p.m3) * p.g;
  plan.w0_dt = w0_dt * (1.0 + 1e-12);
  plan.cycles = cycles;
  Extreme row = chain_row("At the longest stable step: w0 dt = 1.95", name, plan, 2e-2);
  row.expected =
      fmt::format("way of the drum from rest over {:.0e} steps as the exact solution's (relative RMS)",
                  static_cast<double>(cycles) * steps);
  row.error = [plan](const DeckRun &run) {
    return against_direct(plan, run.must_succeed(), [&](const ChainHistory &history) {
      return from_rest(history.x_drum, plan.parameters);
    });
  };
  return row;
}

Extreme impact_row(const std::string &name, const ImpactParameters &p) {
  Extreme row;
  row.group = "Single impacts";
  row.name = name;
  row.deck = "chain/in.impact";
  row.variables = {{"transition", transition_name(p.transition)},
                   {"k", number_text(p.stiffness)},
                   {"D", number_text(p.damping_ratio)},
                   {"m2", number_text(p.mass)},
                   {"speed", number_text(p.speed)},
                   {"steps_per_contact", "400"},
                   {"samples", "100"},
                   {"contacts", "4"}};
  row.expected = "speed of the rebound as in the closed form (difference over the speed of the impact)";
  row.allowed = 1e-4;
  row.error = [p](const DeckRun &run) {
    const double end = impact_duration(p);
    const ChainHistory history = read_chain(run.must_succeed().file("chain.csv"));
    const double w0 = std::sqrt(p.stiffness / p.mass);
    const bool leaves = end < history.time.back() - 0.01 / w0;
    const ImpactState last =
        impact_state(p, leaves ? end : history.time.back() - 0.5 * 3.141592653589793 / (400 * w0));
    return std::fabs(history.v_drum.back() + last.rate) / p.speed;
  };
  return row;
}

/// Makes a run one that must end with an error that names `word`.
Extreme stopping(Extreme row, const std::string &word) {
  row.group = "Must stop";
  row.allowed = 0.0;
  row.limit = 30.0;
  row.expected = fmt::format("an ERROR that says '{}' (0: it does)", word);
  row.error = [word](const DeckRun &run) {
    const bool stopped = run.outcome().status != 0 && !run.outcome().timed_out;
    return stopped && engine_error(run.outcome().output).find(word) != std::string::npos ? 0.0 : 1.0;
  };
  return row;
}

Extreme stop_row(const std::string &name, ChainPlan plan, const std::string &word) {
  return stopping(chain_row("Must stop", name, plan, 0.0), word);
}

/// The plan with one parameter changed.
ChainPlan with(double ChainParameters::*parameter, double value) {
  ChainPlan plan;
  plan.parameters.*parameter = value;
  return plan;
}

std::vector<double> decades(double first, int count, int step = 1) {
  std::vector<double> values;
  for (int n = 0; n < count; n += step)
    values.push_back(first * std::pow(10.0, n));
  return values;
}

void add_chain_rows(std::vector<Extreme> &rows, bool quick) {
  for (const double k : decades(1e5, 8, quick ? 7 : 1)) {
    ChainPlan plan = with(&ChainParameters::k, k);
    plan.cycles = 1;
    rows.push_back(chain_row("Stiffness of the contact", fmt::format("k = {:.0e} N/m", k), plan, 1e-3));
  }
  for (const double ratio : decades(1.0, 7, quick ? 6 : 2)) {
    const ChainParameters usual;
    ChainPlan light_frame = with(&ChainParameters::m3, usual.m2 / ratio);
    rows.push_back(chain_row("Masses", fmt::format("m2/m3 = {:g}: m3 = {:g} kg", ratio, usual.m2 / ratio),
                             light_frame, 1e-3));
    ChainPlan light_drum = with(&ChainParameters::m2, usual.m3 / ratio);
    rows.push_back(chain_row("Masses", fmt::format("m3/m2 = {:g}: m2 = {:g} kg", ratio, usual.m3 / ratio),
                             light_drum, 1e-3));
  }
  for (const double omega : decades(0.1, 6, quick ? 5 : 1)) {
    ChainPlan plan = with(&ChainParameters::omega, omega);
    plan.parameters.Fw =
        omega < 50.0 ? 20e3 : 58.8e3; // a slow force must be below the weight, or the roller leaves the box
    plan.cycles = omega < 50.0 ? 1 : static_cast<int>(omega / 10.0);
    rows.push_back(chain_row("Excitation",
                             fmt::format("omega = {:g} rad/s; Fw = {:g} kN", omega, plan.parameters.Fw / 1e3),
                             plan, 1e-3));
  }
  for (const double Fw : decades(1.0, 7, quick ? 6 : 1)) {
    ChainPlan plan = with(&ChainParameters::Fw, Fw);
    plan.cycles = Fw < 1e5 ? 3 : 1;
    rows.push_back(chain_row("Excitation", fmt::format("Fw = {:g} N", Fw), plan, 1e-3));
  }
  std::vector<double> ratios = decades(0.01, 7, quick ? 6 : 1);
  ratios.insert(ratios.begin(), 0.0);
  for (const double D : ratios) {
    ChainPlan plan = with(&ChainParameters::D, D);
    if (D > 1.0)
      plan.w0_dt = 0.005; // the dashpot alone stops the drum within a step: D w0 dt > 1 beyond D = 200
    rows.push_back(
        chain_row("Damping of the contact", fmt::format("D = {:g}", D), plan, D > 1.0 ? 5e-3 : 1e-3));
  }
  if (quick) return;
  ChainPlan undamped = with(&ChainParameters::D, 0.0);
  undamped.parameters.c23 = 0.0;
  rows.push_back(chain_row("Damping of the contact", "D = 0 and c23 = 0", undamped, 1e-3));
  ChainPlan weightless = with(&ChainParameters::g, 0.0);
  weightless.cycles = 1;
  rows.push_back(chain_row("Gravity", "g = 0", weightless, 1e-3));
}

/// Runs in which the drum reverses its motion after the contact is broken, while the balls still overlap.
void add_remade_rows(std::vector<Extreme> &rows) {
  ChainPlan plan = with(&ChainParameters::k, 1e7);
  plan.cycles = 10;
  rows.push_back(
      chain_row("Re-made at Fc = 0 with overlap", "D = 0.5; 20 Hz; k = 10 MN/m: motion", plan, 1e-3));
  Extreme events = chain_row("Re-made at Fc = 0 with overlap", "the same: events", plan, 0.01);
  events.expected =
      "makes and breaks as the exact solution's; some makes with overlap (largest difference in "
      "time over a cycle)";
  events.error = [plan](const DeckRun &run) {
    const std::vector<ContactEvent> found = read_events(run.must_succeed().file("events.csv"));
    const EventMatch match = match_events(found, direct(plan).events);
    const bool remade = std::any_of(found.begin(), found.end(), [](const ContactEvent &event) {
      return event.time > 0.0 && event.make && event.overlap > 1e-5;
    });
    if (!remade) throw std::runtime_error("no contact was made again with overlap");
    if (match.matched != match.reference_count || match.run_count != match.reference_count)
      throw std::runtime_error(
          fmt::format("{} events; the exact solution has {}", match.run_count, match.reference_count));
    return match.largest_difference / plan.parameters.period();
  };
  rows.push_back(events);
}

void add_edge_rows(std::vector<Extreme> &rows, bool quick) {
  const int cycles = quick ? 2 : 20;
  for (const double k : decades(1e5, 8, quick ? 7 : 1))
    rows.push_back(edge_row(fmt::format("k = {:.0e} N/m", k), with(&ChainParameters::k, k), cycles));
  for (const double D : {0.0, 0.5, 2.0, 100.0, 1e4})
    if (!quick || D == 1e4)
      rows.push_back(edge_row(fmt::format("D = {:g}", D), with(&ChainParameters::D, D), cycles));
}

void add_rest_rows(std::vector<Extreme> &rows, bool quick) {
  ChainPlan fine;
  fine.w0_dt = 0.01;
  if (quick) {
    rows.push_back(rest_row("case II", fine, 1e4));
    return;
  }
  for (const double D : {0.0, 2.0, 1e4}) {
    ChainPlan edge = with(&ChainParameters::D, D);
    edge.w0_dt = 1.95;
    rows.push_back(rest_row(fmt::format("D = {:g} at w0 dt = 1.95", D), edge, 1e6));
  }
}

void add_impact_rows(std::vector<Extreme> &rows, bool quick) {
  for (const Transition transition : {Transition::A, Transition::B}) {
    ImpactParameters p;
    p.transition = transition;
    p.speed = 0.5;
    const auto add = [&](const char *words, double ImpactParameters::*parameter,
                         const std::vector<double> &values) {
      for (const double value : values) {
        ImpactParameters other = p;
        other.*parameter = value;
        rows.push_back(impact_row(
            fmt::format("{}: {}", transition_name(transition), fmt::format(fmt::runtime(words), value)),
            other));
      }
    };
    const std::vector<double> ratios = {0.0, 0.01, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4};
    add("D = {:g}", &ImpactParameters::damping_ratio, quick ? std::vector{ratios.back()} : ratios);
    if (quick) continue;
    add("k = {:.0e} N/m", &ImpactParameters::stiffness, decades(1e5, 8));
    add("{:g} m/s", &ImpactParameters::speed, {1e-6, 1e-3, 10.0});
    add("{:g} kg", &ImpactParameters::mass, {1e-3, 1.0, 1e6});
  }
}

/// Impacts with few steps in a contact, against those of the engine's scheme.
Extreme coarse_row(Transition transition, double D, bool hertz, int steps) {
  constexpr int places = 20;
  Extreme row;
  row.group = "Few steps in a contact";
  row.name = fmt::format("{} law; {}: D = {:g}; {} steps", hertz ? "Hertz" : "linear",
                         transition_name(transition), D, steps);
  row.deck = "study/in.impacts";
  row.variables = {{"transition", transition_name(transition)},
                   {"hertz", hertz ? "1" : "0"},
                   {"D", number_text(D)},
                   {"steps_per_contact", std::to_string(steps)},
                   {"contacts", "8"},
                   {"phases", std::to_string(places)}};
  row.expected = fmt::format("largest error of the rebound over {} places of the make at most 1.2 times that "
                             "of stepping stock (ratio of the two)",
                             places);
  row.allowed = 1.2;
  row.error = [transition, D, variables = row.variables, deck = row.deck](const DeckRun &run) {
    constexpr double speed = 0.5; // m/s, the deck's
    Variables stock = variables;
    stock.emplace_back("stepping", "stock");
    return impact_errors(run, places, transition, D, speed).worst /
           impact_errors(DeckRun(deck, stock), places, transition, D, speed).worst;
  };
  return row;
}

void add_coarse_rows(std::vector<Extreme> &rows, bool quick) {
  for (const bool hertz : {false, true})
    for (const Transition transition : {Transition::A, Transition::B})
      for (const double D : {0.0, 0.003, 0.03, 0.3, 2.0})
        for (const int steps : {10, 20, 40}) {
          if (transition == Transition::A && D >= 1.0) continue; // the contact does not end
          if (!quick || (D == 0.003 && steps == 20)) rows.push_back(coarse_row(transition, D, hertz, steps));
        }
}

/// An impact with the Hertz law: a sphere on a rigid plane, test 3 of Chung and Ooi with one variable
/// changed.
Extreme hertz_row(const std::string &name, const std::string &variable, double value,
                  const Variables &more = {}) {
  Extreme row;
  row.group = "Single impacts: the Hertz law";
  row.name = name;
  row.deck = "benchmarks/in.spheres";
  row.variables = more;
  row.variables.insert(row.variables.end(), {{"case", "chung_ooi_3"}, {variable, number_text(value)}});
  row.expected = "speed of the rebound as in the closed form (difference over the speed of the impact)";
  row.allowed = 1e-4;
  row.error = [](const DeckRun &run) {
    const double e = csv_value<double>(read_parameters(run.must_succeed().file("parameters.csv")).at("e"));
    return std::fabs(read_table(run.file("result.csv")).numbers("restitution").back() - e);
  };
  return row;
}

void add_hertz_rows(std::vector<Extreme> &rows, bool quick) {
  for (const double e : {1.0, 0.5, 0.1, 0.01})
    if (!quick || e == 0.01) rows.push_back(hertz_row(fmt::format("e = {:g}", e), "e", e));
  for (const double speed : {1e-6, 1e-3, 10.0})
    if (!quick || speed == 1e-6) rows.push_back(hertz_row(fmt::format("{:g} m/s", speed), "vn", speed));
  if (quick) return;
  for (const double E : decades(1e5, 8))
    rows.push_back(hertz_row(fmt::format("E = {:.0e} Pa; 0.01 m/s", E), "E", E, {{"vn", "0.01"}}));
  for (const double radius : {1e-5, 1.0})
    rows.push_back(hertz_row(fmt::format("r = {:g} m", radius), "r1", radius));
  for (const double density : {1e-3, 1e6})
    rows.push_back(hertz_row(fmt::format("density {:g} kg/m3; 0.01 m/s", density), "density", density,
                             {{"vn", "0.01"}}));
}

void add_stop_rows(std::vector<Extreme> &rows) {
  ChainPlan long_step =
      with(&ChainParameters::omega, 1.0); // many steps in a cycle: w0 dt is nearly what is asked for
  long_step.w0_dt = 2.2;
  long_step.samples = 1;
  rows.push_back(stop_row("a step above the critical one: w0 dt = 2.2", long_step, "critical step"));
  const ChainPlan soft = with(&ChainParameters::k, 2e4);
  rows.push_back(stop_row("the drum sinks through the soil: k = 2e4 N/m", soft, "overlap"));
  const ChainPlan heavy = with(&ChainParameters::m2, 6e6);
  rows.push_back(stop_row("the drum is too heavy for the soil: m2 = 6e6 kg", heavy, "overlap"));
  ChainPlan undefined;
  Extreme given = stop_row("not a number is given: Fw = nan", undefined, "allowed: ");
  given.variables.emplace_back("Fw", "nan");
  rows.push_back(given);
  rows.push_back(
      stopping(hertz_row("a sphere sinks through the floor: Hertz law; E = 1e5 Pa", "E", 1e5), "overlap"));
  // c = 2 D sqrt(m2 k) would overflow.
  ChainPlan infinite_damping;
  Extreme overflow =
      stop_row("a number overflows: D = 1e304", infinite_damping, "between 1e-30 and 1e30 in size");
  overflow.variables.emplace_back("D", "1e304");
  rows.push_back(overflow);
  for (const int ranks : {1, 2}) {
    Extreme packed;
    packed.name = fmt::format("balls start in one another: 0.8 of a radius apart, ranks: {}", ranks);
    packed.deck = "study/in.small_bed";
    packed.variables = {{"spacing", "0.8"}};
    packed.ranks = ranks;
    rows.push_back(stopping(packed, "of the smaller radius at step 0; allowed"));
  }
}

std::string without_commas(std::string text) {
  std::replace(text.begin(), text.end(), ',', ';');
  return text;
}

constexpr const char *holding = "holds";

/// Makes a row's run and judges it.
ExtremeRow measure(const Extreme &extreme) {
  const DeckRun run(extreme.deck, extreme.variables, extreme.ranks, extreme.limit);
  double error = infinite;
  std::string found = engine_error(run.outcome().output);
  try {
    error = extreme.error(run);
  } catch (const std::runtime_error &failure) {
    found = failure.what();
  }
  return {extreme.group,
          extreme.name,
          command_of(extreme),
          extreme.expected,
          error,
          extreme.allowed,
          error <= extreme.allowed ? holding : "fails",
          without_commas(found)};
}

} // namespace

std::string command_of(const Extreme &row) {
  std::string words = front_command() + " run";
  if (row.ranks > 1) words += fmt::format(" -np {}", row.ranks);
  words += " inputs/" + row.deck;
  for (const auto &[name, value] : row.variables)
    words += fmt::format(" -var {} {}", name, value);
  return words;
}

std::vector<Extreme> extremes(bool quick) {
  std::vector<Extreme> rows;
  add_chain_rows(rows, quick);
  add_remade_rows(rows);
  add_edge_rows(rows, quick);
  add_rest_rows(rows, quick);
  add_impact_rows(rows, quick);
  add_hertz_rows(rows, quick);
  add_coarse_rows(rows, quick);
  add_bed_rows(rows, quick);
  add_stop_rows(rows);
  if (!quick) { // at the end, since it takes minutes
    ChainPlan fine;
    fine.w0_dt = 0.01;
    rows.push_back(rest_row("case II", fine, 1e8));
  }
  return rows;
}

const CsvSchema<ExtremeRow> &extreme_rows() {
  const auto rounded = [](const char *name, double ExtremeRow::*value) {
    return CsvColumn<ExtremeRow>{
        name, [value](const ExtremeRow &row) { return number_text(row.*value, 3); },
        [value](ExtremeRow &row, const std::string &cell) { row.*value = csv_value<double>(cell); }};
  };
  static const CsvSchema<ExtremeRow> schema(
      {csv_column("table", &ExtremeRow::table), csv_column("row", &ExtremeRow::row),
       csv_column("command", &ExtremeRow::command), csv_column("expected", &ExtremeRow::expected),
       rounded("error", &ExtremeRow::error), rounded("allowed", &ExtremeRow::allowed),
       csv_column("verdict", &ExtremeRow::verdict), csv_column("found", &ExtremeRow::found)},
      3);
  return schema;
}

std::vector<ExtremeVerdict> measure_extremes(const StudyOptions &options) {
  ResumedTable results(options.out / "extremes.csv", extreme_rows());
  const std::vector<ExtremeRow> known = read_points(results.file(), extreme_rows());
  const std::vector<Extreme> all = extremes(options.quick);
  CountedProgress progress(all.size());
  std::vector<ExtremeVerdict> verdicts;
  for (const Extreme &extreme : all) {
    ExtremeRow row{extreme.group, extreme.name, command_of(extreme)};
    if (results.has(extreme_rows().key(row))) {
      progress.found();
      row = *find_point(known, extreme_rows(), row);
    } else {
      row = measure(extreme);
      results.add(extreme_rows().cells(row));
      progress.measured(fmt::format("{}: {}: {:.2g} of {:.2g} allowed: {}{}", row.table, row.row, row.error,
                                    row.allowed, row.verdict, row.verdict == holding ? "" : " " + row.found));
    }
    verdicts.push_back({extreme, row.error, row.found, row.verdict == holding});
  }
  results.finish();
  return verdicts;
}

} // namespace drumlin::post
