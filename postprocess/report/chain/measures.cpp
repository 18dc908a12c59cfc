#include "report/chain/measures.h"

#include "engine/deck_run.h"
#include "support/units.h"
#include "support/csv_schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>

namespace drumlin::post {

int ReferenceValue::decimals() const {
  const std::size_t point = low_text.find('.');
  return point == std::string::npos ? 0 : static_cast<int>(low_text.size() - point) - 1;
}

const std::vector<ReferenceValue> &reference_values() {
  using Value = ReferenceValue;
  static const std::vector<Value> values = [] {
    const CsvSchema<Value> schema(
        {csv_column("case", &Value::case_name), csv_column("transition", &Value::transition),
         csv_column("quantity", &Value::quantity), csv_column("unit", &Value::unit),
         csv_column("low", &Value::low_text), csv_column("low", &Value::low),
         csv_column("high", &Value::high_text), csv_column("high", &Value::high),
         csv_column("tolerance", &Value::tolerance), csv_column("source", &Value::source)});
    return schema.rows(read_table(input_file("chain/reference_values.csv")));
  }();
  return values;
}

const ReferenceValue *reference_value(const std::string &case_name, const std::string &transition,
                                      const std::string &quantity) {
  const std::vector<ReferenceValue> &all = reference_values();
  const auto found = std::find_if(all.begin(), all.end(), [&](const ReferenceValue &value) {
    return value.case_name == case_name && value.transition == transition && value.quantity == quantity;
  });
  return found == all.end() ? nullptr : &*found;
}

namespace {

std::size_t row_at(const std::vector<double> &time, double t) {
  return static_cast<std::size_t>(std::lower_bound(time.begin(), time.end(), t) - time.begin());
}

/// Drum velocity of the reference solution at the times of the run, by cubic interpolation where it has no
/// row at that time.
std::vector<double> reference_velocity(const ChainHistory &run, const ChainHistory &reference, double period,
                                       bool &interpolated) {
  std::vector<double> out;
  out.reserve(run.size());
  std::size_t r = 0;
  for (std::size_t i = 0; i < run.size(); ++i) {
    const double t = run.time[i];
    while (r + 2 < reference.size() && reference.time[r + 1] <= t)
      ++r;
    const double h = reference.time[r + 1] - reference.time[r];
    const double s = (t - reference.time[r]) / h;
    if (s > 1.0 + 1.0e-6) break; // rows of the run after its last complete cycle
    if (std::abs(s) * h < 1.0e-9 * period) {
      out.push_back(reference.v_drum[r]);
    } else if (std::abs(1.0 - s) * h < 1.0e-9 * period) {
      out.push_back(reference.v_drum[r + 1]);
    } else {
      interpolated = true;
      const double s2 = s * s;
      const double s3 = s2 * s;
      out.push_back(reference.v_drum[r] * (2 * s3 - 3 * s2 + 1) +
                    reference.v_drum[r + 1] * (3 * s2 - 2 * s3) +
                    h * (reference.a_drum[r] * (s3 - 2 * s2 + s) + reference.a_drum[r + 1] * (s3 - s2)));
    }
  }
  return out;
}

double velocity_error(const ChainHistory &run, const std::vector<double> &reference, TimeWindow window,
                      double period) {
  const double slack = 1.0e-6 * period;
  const std::size_t first = std::min(row_at(run.time, window.begin - slack), reference.size());
  const std::size_t last = std::min(row_at(run.time, window.end + slack), reference.size());
  return relative_rms(run.v_drum, reference, first, last);
}

void widen(std::optional<Extremes> &extremes, double value) {
  if (!extremes) {
    extremes = Extremes{value, value};
    return;
  }
  extremes->min = std::min(extremes->min, value);
  extremes->max = std::max(extremes->max, value);
}

double share_from_samples(const ChainHistory &history, TimeWindow window) {
  std::size_t all = 0;
  std::size_t touching = 0;
  for (std::size_t i = 0; i < history.size(); ++i) {
    if (history.time[i] < window.begin || history.time[i] >= window.end) continue;
    ++all;
    if (history.F_contact[i] != 0.0) ++touching;
  }
  return all == 0 ? not_a_number : static_cast<double>(touching) / static_cast<double>(all);
}

/// Fills the values that compare a run with its reference solution.
void compare_with_reference(ChainMeasures &m, const Run &run, const ExactSolution &reference) {
  const double period = run.chain.period();
  const std::vector<double> exact =
      reference_velocity(run.history, reference.history, period, m.reference_interpolated);
  m.velocity_error_last =
      velocity_error(run.history, exact, last_cycles_window(run.complete, error_cycles, period), period);
  if (run.complete >= 30)
    m.velocity_error_25_to_30 = velocity_error(run.history, exact, {25.0 * period, 30.0 * period}, period);
  const TimeWindow all{-std::numeric_limits<double>::infinity(), run.complete * period};
  m.match = match_events(events_in(run.events, all), events_in(reference.events, all));
}

/// \param reference the reference solution; nullptr if there is none
ChainMeasures measure_chain(const Run &run, const ExactSolution *reference) {
  ChainMeasures m;
  const ChainParameters &p = run.chain;
  const double period = p.period();
  m.steady_count = std::min(steady_cycles, run.complete);
  if (m.steady_count > 1) m.steady_count = m.steady_count / 2 * 2;
  m.steady = last_cycles_window(run.complete, m.steady_count, period);
  m.extremes = steady_extremes(run.history, run.events, run.cycles, p, m.steady,
                               static_cast<std::size_t>(m.steady_count));
  m.share_exact = run.has_events;
  m.contact_share = run.has_events ? contact_share(run.events, m.steady, run.history.F_contact.front() != 0.0)
                                   : share_from_samples(run.history, m.steady);
  for (const ContactEvent &event : run.events)
    if (event.time > 0.0) ++(event.make ? m.makes : m.breaks);
  std::size_t makes = 0;
  std::size_t breaks = 0;
  for (const ContactEvent &event : events_in(run.events, m.steady)) {
    if (event.make) {
      ++makes;
      widen(m.force_at_make, event.force);
    } else {
      ++breaks;
      widen(m.force_at_break, event.force);
      widen(m.overlap_at_break, event.overlap);
    }
  }
  m.makes_per_cycle = static_cast<double>(makes) / std::max(1, m.steady_count);
  m.breaks_per_cycle = static_cast<double>(breaks) / std::max(1, m.steady_count);

  std::optional<HarmonicAmplitudes> integrated;
  if (run.cycles) integrated = harmonic_amplitudes(*run.cycles, static_cast<std::size_t>(m.steady_count));
  m.amplitudes_every_step = integrated.has_value();
  if (integrated) {
    m.amplitudes = *integrated;
  } else {
    const TimeWindow wider{m.steady.begin - period / run.samples_per_cycle, m.steady.end};
    const EventSeries series = with_events(run.history, run.events, p, wider);
    m.amplitudes = harmonic_amplitudes(series.time, series.acceleration, p.omega, m.steady);
  }
  if (run.cycles)
    m.energy = energy_balance(*run.cycles, m.energy_missing);
  else
    m.energy_missing = "cycles.csv";
  m.roller = roller_force(run.history, run.events, p);

  if (reference != nullptr) compare_with_reference(m, run, *reference);
  return m;
}

/// The reference solution in the form of a run, so that it is measured in the same way.
Run as_run(const Run &run, const ExactSolution &reference) {
  Run out;
  out.kind = RunKind::chain;
  out.direct = true;
  out.chain = run.chain;
  out.history = reference.history;
  out.events = reference.events;
  out.has_events = true;
  out.complete = run.complete;
  out.samples_per_cycle = run.samples_per_cycle;
  CycleColumns cycles;
  cycles.rows = reference.cycles.size();
  for (const CycleSummary &cycle : reference.cycles) {
    cycles.columns["a_drum_min"].push_back(cycle.a_drum_min);
    cycles.columns["a_drum_max"].push_back(cycle.a_drum_max);
    cycles.columns["F_contact_min"].push_back(cycle.F_contact_min);
    cycles.columns["F_contact_max"].push_back(cycle.F_contact_max);
  }
  out.cycles = std::move(cycles);
  return out;
}

/// A quantity that has reference values.
struct JudgedQuantity {
  const char *name;
  double scale; ///< the unit of the reference per SI unit
  /// In SI units; nothing if the run does not have it.
  std::optional<double> (*of)(const ChainMeasures &measures, bool has_events);
  enum { plain, extreme, count } kind = plain;
};

std::optional<double> end_of(const std::optional<Extremes> &found, double Extremes::*end) {
  return found ? std::optional((*found).*end) : std::nullopt;
}

using M = ChainMeasures;
constexpr double kN = 1e-3, mm = 1e3; // per SI unit
const std::array<JudgedQuantity, 11> judged_quantities = {{
    {"drum acceleration, min", 1.0,
     [](const M &m, bool) { return std::optional(m.extremes.acceleration.min); }, JudgedQuantity::extreme},
    {"drum acceleration, max", 1.0,
     [](const M &m, bool) { return std::optional(m.extremes.acceleration.max); }, JudgedQuantity::extreme},
    {"contact force, min", kN, [](const M &m, bool) { return std::optional(m.extremes.force.min); },
     JudgedQuantity::extreme},
    {"contact force, max", kN, [](const M &m, bool) { return std::optional(m.extremes.force.max); },
     JudgedQuantity::extreme},
    {"share of time in contact", 1.0, [](const M &m, bool) { return std::optional(m.contact_share); }},
    {"contact force at break", kN, [](const M &m, bool) { return end_of(m.force_at_break, &Extremes::min); }},
    {"overlap at break", mm, [](const M &m, bool) { return end_of(m.overlap_at_break, &Extremes::max); }},
    {"contact force at make", kN, [](const M &m, bool) { return end_of(m.force_at_make, &Extremes::max); }},
    {"breaks per cycle", 1.0,
     [](const M &m, bool events) { return events ? std::optional(m.breaks_per_cycle) : std::nullopt; },
     JudgedQuantity::count},
    {"makes per cycle", 1.0,
     [](const M &m, bool events) { return events ? std::optional(m.makes_per_cycle) : std::nullopt; },
     JudgedQuantity::count},
    {"meter value CMV", 1.0,
     [](const M &m, bool) { return std::optional(compaction_meter_value(m.amplitudes)); }},
}};

/// Fills value, differences and agreement. `half_digit` is half a unit of the last digit given.
void judge(Check &check, double value, double low, double high, double tolerance, double half_digit) {
  check.value = value;
  check.difference = value < low ? value - low : value > high ? value - high : 0.0;
  const double nearest = value < low ? low : value > high ? high : value;
  check.relative_difference = nearest != 0.0 ? check.difference / std::abs(nearest) : not_a_number;
  const double off = std::abs(check.difference);
  const double rounding = 1.0e-12 * std::max(std::abs(low), std::abs(high));
  if (off <= std::min(half_digit, tolerance) + rounding)
    check.agreement = Agreement::same_digits;
  else if (off <= tolerance + rounding)
    check.agreement = Agreement::tolerance;
  else
    check.agreement = Agreement::differs; // also if the value is not a number
}

/// Whether a run's steady state is compared with the reference values.
bool is_judged(const Run &run) { return run.cut.empty() && run.complete >= long_run_cycles; }

Check steady_check(std::size_t index, const RunResult &result, const ReferenceValue &reference,
                   const JudgedQuantity &quantity) {
  Check check;
  check.run = index;
  check.quantity = reference.quantity;
  check.unit = reference.unit;
  check.source = reference.source;
  const int decimals = reference.decimals();
  const bool count = quantity.kind == JudgedQuantity::count;
  check.reference = count ? "none"
                    : reference.low_text == reference.high_text
                        ? reference.low_text
                        : reference.low_text + " to " + reference.high_text;
  check.tolerance =
      reference.tolerance == 0.0 ? "exact" : fmt::format("{:.{}f}", reference.tolerance, decimals);
  const bool judged = is_judged(result.run);
  const std::optional<double> value = quantity.of(*result.chain, result.run.has_events);
  if (!value) {
    if (!judged) check.agreement = Agreement::not_judged;
    check.note = "the run has no such event in its last cycles, or recorded none";
    return check;
  }
  if (result.reference_chain)
    if (const std::optional<double> direct = quantity.of(*result.reference_chain, true))
      check.direct = *direct * quantity.scale;
  judge(check, *value * quantity.scale, reference.low, reference.high, reference.tolerance,
        0.5 * std::pow(10.0, -decimals));
  if (!judged) check.agreement = Agreement::not_judged;
  check.measured = count && *value == 0.0
                       ? "none"
                       : fmt::format("{:.{}f}", check.value + 0.0, std::max(decimals + 2, count ? 1 : 0));
  if (reference.quantity == "share of time in contact" && !result.chain->share_exact)
    check.note = "from samples, not from located events";
  if ((quantity.kind == JudgedQuantity::extreme && !result.chain->extremes.every_step) ||
      (reference.quantity == "meter value CMV" && !result.chain->amplitudes_every_step))
    check.note = "from samples and events, not from every step";
  return check;
}

void compare_impact(std::size_t index, const RunResult &result, std::vector<Check> &checks) {
  const ImpactParameters &p = result.run.impact;
  const std::string transition = transition_name(p.transition);
  const double exact = closed_form_restitution(transition, p.damping_ratio);
  Check check;
  check.run = index;
  check.quantity = "restitution";
  double low = exact;
  double tolerance = 1.0e-4;
  check.source = "closed form";
  if (const ReferenceValue *reference =
          reference_value(fmt::format("D={:g}", p.damping_ratio), transition, "restitution")) {
    low = reference->low;
    tolerance = reference->tolerance;
    check.source = reference->source;
  }
  check.reference = fmt::format("{:.6f}", low);
  check.tolerance = fmt::format("{:g}", tolerance);
  if (!result.impact) {
    check.note = "the mass does not move towards the ball at the start of the record";
  } else if (!result.impact->hits) {
    check.note = "the mass does not reach the ball within the record";
  } else if (!result.impact->ended) {
    check.note = "the record ends before the rebound";
  } else {
    judge(check, result.impact->restitution(), low, low, tolerance, 0.5e-6);
    check.measured = fmt::format("{:.8f}", check.value);
  }
  if (exact == 0.0) { // A, over-damped: no rebound is the answer
    check.reference = "no rebound";
    if (result.impact && result.impact->hits) {
      check.measured = result.impact->ended ? "rebound" : "no rebound";
      check.agreement = result.impact->ended ? Agreement::differs : Agreement::same_digits;
      check.note.clear();
    }
  }
  if (!result.run.cut.empty()) check.agreement = Agreement::not_judged;
  checks.push_back(std::move(check));
}

/// A statement of the paper, not yet judged. \param result the run that it is about
Check paper_check(const ReportResults &results, const RunResult *result, const char *quantity,
                  const char *reference, const char *tolerance, const std::string &source) {
  Check check;
  check.run = static_cast<std::size_t>(result - results.runs.data());
  check.quantity = quantity;
  check.reference = reference;
  check.tolerance = tolerance;
  check.source = source;
  return check;
}

void compare_words(ReportResults &results) {
  const auto at_case = [](const RunResult *result) { return result != nullptr && result->run.at_case; };
  const RunResult *one_a = best_run(results, "I", Transition::A);
  const RunResult *one_b = best_run(results, "I", Transition::B);
  if (at_case(one_a) && at_case(one_b)) {
    Check check =
        paper_check(results, one_b, "case I: largest difference of drum acceleration between A and B", "0",
                    "1e-06", "paper, section 4.1.1: \"identical\"");
    check.unit = "m/s²";
    const std::vector<double> &a = one_a->run.history.a_drum, &b = one_b->run.history.a_drum;
    if (one_a->run.samples_per_cycle != one_b->run.samples_per_cycle) {
      check.note = "A and B have different numbers of samples per cycle";
    } else {
      double largest = 0.0;
      for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        largest = std::max(largest, std::abs(a[i] - b[i]));
      judge(check, largest, 0.0, 0.0, 1.0e-6, 0.0);
      check.measured = fmt::format("{:.2g}", largest);
    }
    if (!one_a->run.cut.empty() || !one_b->run.cut.empty()) check.agreement = Agreement::not_judged;
    results.words.push_back(check);
  }
  const RunResult *two = best_run(results, "II", Transition::B);
  const RunResult *three = best_run(results, "III", Transition::B);
  if (at_case(two) && at_case(three)) {
    constexpr double ratio = 0.40, tolerance = 0.005;
    Check check = paper_check(results, three, "largest drum acceleration, case III over case II (B)", "0.40",
                              "0.005", "paper, Case III (\"approximately half\"); reference, steady states");
    judge(check, three->chain->extremes.acceleration.max / two->chain->extremes.acceleration.max, ratio,
          ratio, tolerance, tolerance);
    check.measured = fmt::format("{:.4f}", check.value);
    if (!is_judged(two->run) || !is_judged(three->run)) check.agreement = Agreement::not_judged;
    results.words.push_back(check);
  }
  const RunResult *four = best_run(results, "IV", Transition::A);
  if (at_case(four)) {
    Check check = paper_check(results, four, "case IV, A: second harmonic over fundamental", "0", "1e-04",
                              "paper, section 4.1.4: \"remains in the sinusoidal shape\"");
    judge(check, four->chain->amplitudes.second / four->chain->amplitudes.fundamental, 0.0, 0.0, 1.0e-4, 0.0);
    check.measured = fmt::format("{:.2g}", check.value);
    if (!is_judged(four->run)) check.agreement = Agreement::not_judged;
    results.words.push_back(check);
  }
}

} // namespace

std::shared_ptr<const ExactSolution> ExactSolutions::solve(const ChainParameters &parameters, int cycles,
                                                           int samples_per_cycle, double impact_speed) {
  std::string key = fmt::format("{} {} {} {}", transition_name(parameters.transition), cycles,
                                samples_per_cycle, impact_speed);
  for (const ChainNumber &number : chain_numbers)
    key += fmt::format(" {}", parameters.*number.value);
  std::shared_ptr<const ExactSolution> &entry = known_[key];
  if (!entry) {
    ExactOptions options;
    options.cycles = cycles;
    options.samples_per_cycle = samples_per_cycle;
    options.impact_speed = impact_speed;
    if (const std::string fault = too_much_work(parameters, options); !fault.empty())
      throw std::runtime_error(fault);
    entry = std::make_shared<const ExactSolution>(solve_chain(parameters, options));
  }
  return entry;
}

RunResult analyse(Run run, ExactSolutions &exact) {
  RunResult result;
  result.run = std::move(run);
  const Run &r = result.run;
  if (r.kind == RunKind::chain && r.complete >= 1) {
    try {
      result.reference = exact.solve(r.chain, r.complete, r.samples_per_cycle, r.impact_speed);
    } catch (const std::exception &failure) {
      result.run.missing.push_back(fmt::format(
          "no comparison with the reference solution, which cannot be computed: {}.", failure.what()));
    }
    result.chain = measure_chain(r, result.reference.get());
    if (result.reference)
      result.reference_chain = measure_chain(as_run(r, *result.reference), result.reference.get());
  } else if (r.kind == RunKind::chain) {
    result.run.missing.emplace_back(
        "nothing is measured, since chain.csv ends before the first complete cycle.");
  } else if (r.kind == RunKind::impact) {
    result.impact = measure_impact(r.history, r.events);
  }
  return result;
}

void compare(ReportResults &results) {
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    const RunResult &result = results.runs[i];
    if (result.run.kind == RunKind::impact) compare_impact(i, result, results.restitution);
    if (!result.chain || !result.run.at_case) continue;
    const std::string transition = transition_name(result.run.chain.transition);
    for (const ReferenceValue &reference : reference_values())
      for (const JudgedQuantity &quantity : judged_quantities)
        if (reference.case_name == result.run.case_name && reference.transition == transition &&
            reference.quantity == quantity.name)
          results.checks.push_back(steady_check(i, result, reference, quantity));
  }
  compare_words(results);
}

const RunResult *best_run(const ReportResults &results, const std::string &case_name, Transition transition) {
  const auto rank = [](const RunResult &result) {
    const double error = result.chain->velocity_error_last;
    return std::tuple(!result.run.cut.empty(), !result.run.at_case, result.run.complete < long_run_cycles,
                      result.run.direct, std::isnan(error) ? std::numeric_limits<double>::infinity() : error);
  };
  const RunResult *best = nullptr;
  for (const RunResult &result : results.runs) {
    if (!result.chain || result.run.case_name != case_name || result.run.chain.transition != transition)
      continue;
    if (best == nullptr || rank(result) < rank(*best)) best = &result;
  }
  return best;
}

} // namespace drumlin::post
