#include "report/chain/tables.h"

#include "engine/places.h"
#include "report/chain/engine_comparison.h"
#include "report/chain/measures.h"
#include "support/text.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// The words that say over how many cycles at the end of the runs the chains were measured.
std::string measured_words(const ReportResults &results) {
  std::vector<int> counts;
  for (const RunResult &result : results.runs)
    if (result.chain) counts.push_back(result.chain->steady_count);
  return last_cycles_words(counts);
}

/// A ratio as text; a dash where it is not finite, since its denominator is zero.
template <class Number>
std::string finite(const char *format, Number value) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : no_value;
}

std::string scientific(double value) { return finite("{:.2e}", value); }

std::string steps_text(const Run &run) {
  if (run.direct) return "adaptive";
  if (run.kind == RunKind::impact) return run.text("steps_per_contact", no_value) + " per contact";
  return run.steps_per_cycle > 0 ? fmt::format("{}", run.steps_per_cycle) : no_value;
}

std::string engine_text(const Run &run) {
  return run.direct ? "exact solution" : run.text("engine", no_value);
}

std::string transition_text(const Run &run) {
  return run.kind == RunKind::unknown ? no_value : transition_name(run.transition());
}

std::string case_text(const Run &run) {
  if (run.kind == RunKind::impact) return fmt::format("impact, D = {:g}", run.impact.damping_ratio);
  if (run.kind == RunKind::unknown) return no_value;
  if (run.case_name.empty()) return "own";
  return run.case_name + (run.at_case ? "" : ", changed");
}

/// Whether an error is small enough to be marked as good; plain if it was not measured.
RowState state_of_error(const Run &run, double relative) {
  if (!run.cut.empty()) return RowState::plain;
  return std::isnan(relative)               ? RowState::plain
         : std::abs(relative) <= good_error ? RowState::agrees
                                            : RowState::differs;
}

/// "0.8600" or "0.8600 to 0.8612".
std::string range_text(const std::optional<Extremes> &extremes, double scale, int decimals) {
  if (!extremes) return no_value;
  const std::string low = fmt::format("{:.{}f}", extremes->min * scale, decimals);
  const std::string high = fmt::format("{:.{}f}", extremes->max * scale, decimals);
  return low == high ? low : low + " to " + high;
}

std::string agreement_text(const Check &check, const Run &run) {
  std::string words;
  switch (check.agreement) {
  case Agreement::same_digits:
    words = "to all digits";
    break;
  case Agreement::tolerance:
    words = "in tolerance";
    break;
  case Agreement::differs:
    words = "no";
    break;
  case Agreement::not_measured:
    words = "not measured";
    break;
  case Agreement::not_judged:
    words = run.cut.empty() ? "not judged (short run)" : "not judged (cut run)";
    break;
  }
  return words;
}

/// Digits after the point of a number's text.
int decimals_of(const std::string &text) {
  const std::size_t point = text.find('.');
  return point == std::string::npos ? 0 : static_cast<int>(text.size() - point - 1);
}

using RunColumns = TableColumns<RunResult>;

/// Columns that name a run, and further ones.
RunColumns naming(RunColumns further) {
  RunColumns columns = {{"run", [](const RunResult &r) { return r.run.name; }},
                        {"case", [](const RunResult &r) { return case_text(r.run); }},
                        {"transition", [](const RunResult &r) { return transition_text(r.run); }}};
  std::move(further.begin(), further.end(), std::back_inserter(columns));
  return columns;
}

std::string stepping_text(const RunResult &r) {
  return r.run.direct ? "exact" : r.run.text("stepping", no_value);
}

/// The text of a parameter that the exact solution has none of.
std::function<std::string(const RunResult &)> text_of(const char *name) {
  return [name](const RunResult &r) { return r.run.direct ? no_value : r.run.text(name, no_value); };
}

/// What a path of members leads to; those that may be missing are there.
template <class Value>
const Value &held(const Value &value) {
  return value;
}
template <class Value>
const Value &held(const std::optional<Value> &value) {
  return *value;
}
template <class From, class Member>
auto follow(const From &from, Member member) {
  return std::invoke(member, held(from));
}
template <class From, class Member, class... Members>
auto follow(const From &from, Member member, Members... members) {
  return follow(std::invoke(member, held(from)), members...);
}

/// A number of a chain's measures, found by a path of members, as text.
template <class... Members>
std::function<std::string(const RunResult &)> number(const char *format, Members... members) {
  return [=](const RunResult &r) { return finite(format, follow(*r.chain, members...)); };
}

PageTable empty_table(const char *section, const char *name, const char *title, std::size_t text_columns) {
  PageTable table;
  table.section = section;
  table.name = name;
  table.title = title;
  table.text_columns = text_columns;
  return table;
}

/// A check with what its row needs.
struct CheckRow {
  const Check &check;
  const Run &run;
  bool valued() const { return check.agreement != Agreement::not_measured; }
  bool number() const {
    return valued() && std::isfinite(check.difference) && check.measured != "no rebound";
  }
  bool compared() const { return check.direct && number(); }
};

std::string direct_text(const CheckRow &row) {
  if (!row.compared()) return no_value;
  return row.check.measured == "none" && *row.check.direct == 0.0
             ? "none"
             : fmt::format("{:.{}f}", *row.check.direct, decimals_of(row.check.measured));
}

const TableColumns<CheckRow> check_columns = {
    {"run", [](const CheckRow &r) { return r.run.name; }},
    {"case", [](const CheckRow &r) { return case_text(r.run); }},
    {"transition", [](const CheckRow &r) { return transition_text(r.run); }},
    {"quantity", [](const CheckRow &r) { return r.check.quantity; }},
    {"unit", [](const CheckRow &r) { return r.check.unit; }},
    {"reference", [](const CheckRow &r) { return r.check.reference; }},
    {"measured", [](const CheckRow &r) { return r.valued() ? r.check.measured : no_value; }},
    {"difference",
     [](const CheckRow &r) { return r.number() ? fmt::format("{:.2g}", r.check.difference) : no_value; }},
    {"relative (-)",
     [](const CheckRow &r) { return r.number() ? finite("{:.1e}", r.check.relative_difference) : no_value; }},
    {"tolerance", [](const CheckRow &r) { return r.check.tolerance; }},
    {"agrees", [](const CheckRow &r) { return agreement_text(r.check, r.run); }},
    {"direct solution", direct_text},
    {"run minus direct",
     [](const CheckRow &r) {
       return r.compared() ? fmt::format("{:.1e}", r.check.value - *r.check.direct) : no_value;
     }},
    {"remark", [](const CheckRow &r) { return r.check.note; }},
    {"reference from", [](const CheckRow &r) { return r.check.source; }}};

PageTable check_table(const char *section, const char *name, const char *title, const ReportResults &results,
                      const std::vector<Check> &checks) {
  PageTable table = empty_table(section, name, title, 5);
  set_header(table, check_columns);
  table.shown_columns = 14;
  table.verdict = "agrees";
  table.criterion = "values agree with the reference within the tolerance";
  for (const Check &check : checks)
    add_row(table, check_columns, {check, results.runs[check.run].run},
            check.agrees()                             ? RowState::agrees
            : check.agreement == Agreement::not_judged ? RowState::plain
                                                       : RowState::differs);
  return table;
}

/// "17", "17 (cut)" or "17 (short run)"; a dash for what is no chain.
std::string cycles_text(const RunResult &r) {
  if (r.run.kind != RunKind::chain) return no_value;
  return fmt::format("{}{}", r.run.complete,
                     !r.run.cut.empty()                 ? " (cut)"
                     : r.run.complete < long_run_cycles ? " (short run)"
                                                        : "");
}

PageTable runs_table(const ReportResults &results) {
  PageTable table = empty_table("runs", "runs", "Runs", 4);
  table.verdict = "checks that agree";
  table.criterion = "judged runs agree with all their reference values";
  CheckCount count; // of the run whose row is added
  const RunColumns columns =
      naming({{"stepping", stepping_text},
              {"steps per cycle", [](const RunResult &r) { return steps_text(r.run); }},
              {"cycles (-)", cycles_text},
              {"engine", [](const RunResult &r) { return engine_text(r.run); }},
              {"ranks", text_of("ranks")},
              {"plugin", text_of("plugin")},
              {"checks that agree",
               [&count](const RunResult &) {
                 return count.all > 0          ? fmt::format("{} of {}", count.agree, count.all)
                        : count.not_judged > 0 ? "not judged"
                                               : no_value;
               }},
              {"command", [](const RunResult &r) { return r.run.text("command", no_value); }}});
  set_header(table, columns);
  table.shown_columns = 10;
  table.notes.emplace_back(
      "stepping is the scheme by which the engine integrates a time step: second is the second-order scheme, "
      "which knows the part of a step during which balls are in contact; stock is the engine's velocity "
      "Verlet scheme; exact is the exact solution.");
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    const Run &run = results.runs[i].run;
    count = count_checks(results, i);
    add_row(table, columns, results.runs[i],
            count.all == 0             ? RowState::plain
            : count.agree == count.all ? RowState::agrees
                                       : RowState::differs);
    if (run.kind == RunKind::chain && !run.at_case)
      table.notes.push_back(fmt::format("{} has no reference values: {}.", run.name, run.not_at_case));
    if (count.not_judged > 0 && run.kind == RunKind::chain)
      table.notes.push_back(
          fmt::format("{}: {} values are not judged, since the run {} {} cycles and the reference values "
                      "need {}. This command makes a run that is long enough: {}",
                      run.name, count.not_judged, run.cut.empty() ? "has" : "was cut after", run.complete,
                      long_run_cycles, judging_command(run)));
    for (const std::string &missing : run.missing)
      table.notes.push_back(fmt::format("{}: {}", run.name, missing));
  }
  return table;
}

/// The text of a number of the paired events; a dash if there are none.
std::string paired(const RunResult &r, const char *format, double value) {
  return r.chain->match.matched > 0 ? fmt::format(fmt::runtime(format), value) : no_value;
}

/// The range of an event's force or overlap.
std::function<std::string(const RunResult &)> range(std::optional<Extremes> ChainMeasures::*of, double scale,
                                                    int decimals) {
  return [=](const RunResult &r) { return range_text(follow(*r.chain, of), scale, decimals); };
}

std::string steps_apart(const RunResult &r) {
  const EventMatch &match = r.chain->match;
  return match.matched > 0 && r.run.timestep > 0.0 && !r.run.direct
             ? fmt::format("{:.3g}", match.largest_difference / r.run.timestep)
             : no_value;
}

using Measures = ChainMeasures;
const RunColumns event_columns =
    naming({{"makes", number("{}", &Measures::makes)},
            {"breaks", number("{}", &Measures::breaks)},
            {"makes per cycle (-)", number("{:g}", &Measures::makes_per_cycle)},
            {"breaks per cycle (-)", number("{:g}", &Measures::breaks_per_cycle)},
            {"force at make (kN)", range(&Measures::force_at_make, 1e-3, 3)},
            {"force at break (kN)", range(&Measures::force_at_break, 1e-3, 3)},
            {"overlap at break (mm)", range(&Measures::overlap_at_break, 1e3, 4)},
            {"events of direct solution", number("{}", &Measures::match, &EventMatch::reference_count)},
            {"paired", number("{}", &Measures::match, &EventMatch::matched)},
            {"largest time difference (µs)",
             [](const RunResult &r) { return paired(r, "{:.3g}", r.chain->match.largest_difference * 1e6); }},
            {"the same (steps)", steps_apart},
            {"at time (s)", [](const RunResult &r) { return paired(r, "{:.4f}", r.chain->match.at_time); }}});

PageTable events_table(const ReportResults &results) {
  PageTable table = empty_table("events", "event_table", "Makes and breaks of contact", 3);
  table.criterion = "runs have the same events as the reference solution, one by one";
  set_header(table, event_columns);
  for (const RunResult &result : results.runs) {
    if (!result.chain || !result.run.has_events) continue;
    const EventMatch &match = result.chain->match;
    const bool all = match.run_count == match.reference_count && match.matched == match.run_count;
    add_row(table, event_columns, result,
            !result.reference || !result.run.cut.empty() ? RowState::plain
            : all                                        ? RowState::agrees
                                                         : RowState::differs);
    if (!all)
      table.notes.push_back(
          fmt::format("{}: {} events, {} in the reference solution; the first {} were paired.",
                      result.run.name, match.run_count, match.reference_count, match.matched));
  }
  table.notes.insert(table.notes.begin(),
                     fmt::format("Forces, overlap and counts per cycle: over {} of each run. Time "
                                 "differences: of all events of the run to those of the reference solution "
                                 "(direct solution), paired in their order; also in time steps of the run.",
                                 measured_words(results)));
  return table;
}

double rmv(const HarmonicAmplitudes &amplitudes) { return resonance_meter_value(amplitudes); }

const RunColumns meter_columns =
    naming({{"A1 (m/s²)", number("{:.4f}", &Measures::amplitudes, &HarmonicAmplitudes::fundamental)},
            {"A2 (m/s²)", number("{:.4f}", &Measures::amplitudes, &HarmonicAmplitudes::second)},
            {"A0.5 (m/s²)", number("{:.2e}", &Measures::amplitudes, &HarmonicAmplitudes::half)},
            {"CMV (-)", number("{:.2f}", &Measures::amplitudes, &compaction_meter_value)},
            {"RMV (-)", number("{:.2g}", &Measures::amplitudes, rmv)},
            {"integrated over", [](const RunResult &r) {
               return r.chain->amplitudes_every_step ? "every step" : "samples and events";
             }}});

PageTable meters_table(const ReportResults &results) {
  PageTable table = empty_table("reference", "meter_values", "Compaction meter values", 3);
  set_header(table, meter_columns);
  for (const RunResult &result : results.runs)
    if (result.chain) add_row(table, meter_columns, result);
  table.notes.push_back(fmt::format(
      "Compaction meter value CMV = 300 A2 / A1 and resonance meter value RMV = 100 A0.5 / A1. A1, A2 and "
      "A0.5 are the amplitudes of drum acceleration at 1, 2 and 1/2 times the excitation frequency, over {}.",
      measured_words(results)));
  return table;
}

/// Known errors of a case at so many steps per cycle, with either scheme.
std::string known_error(const RunResult &r, bool second) {
  const Run &run = r.run;
  const bool comparable = run.at_case && run.chain.transition == Transition::B;
  if (!comparable && !(second && run.case_name == "I")) return no_value;
  const ReferenceValue *known =
      reference_value(run.case_name, "B",
                      fmt::format("velocity error at {} steps, {} stepping", run.steps_per_cycle,
                                  second ? "second" : "stock"));
  return known != nullptr ? scientific(known->low) : no_value;
}

const RunColumns error_columns = naming(
    {{"stepping", stepping_text},
     {"steps per cycle", [](const RunResult &r) { return steps_text(r.run); }},
     {"cycles (-)", [](const RunResult &r) { return fmt::format("{}", r.run.complete); }},
     {"last 5 cycles (-)", [](const RunResult &r) { return scientific(r.chain->velocity_error_last); }},
     {"cycles 25 to 30 (-)",
      [](const RunResult &r) {
        return r.chain->velocity_error_25_to_30 ? scientific(*r.chain->velocity_error_25_to_30) : no_value;
      }},
     {"known: second-order stepping (-)", [](const RunResult &r) { return known_error(r, true); }},
     {"known: stock stepping (-)", [](const RunResult &r) { return known_error(r, false); }}});

PageTable errors_table(const ReportResults &results) {
  PageTable table = empty_table("direct", "error_table",
                                "Relative RMS error of drum velocity against the reference solution", 4);
  table.criterion = "runs have an error of at most 1 % over their last five cycles, or all of a shorter run";
  set_header(table, error_columns);
  bool interpolated = false;
  for (const RunResult &result : results.runs) {
    if (!result.chain) continue;
    add_row(table, error_columns, result, state_of_error(result.run, result.chain->velocity_error_last));
    interpolated = interpolated || result.chain->reference_interpolated;
  }
  table.notes.emplace_back("Known: errors that the reference values give for cycles 25 to 30 under condition "
                           "B, at 200, 400, 800, 1600, 3200 and 6400 steps per cycle.");
  if (interpolated)
    table.notes.emplace_back("Some runs have rows at times between those of the reference solution, which "
                             "was interpolated there.");
  return table;
}

using Energy = EnergyBalance;
constexpr const char *joule = "{:.4f}", *small = "{:.2e}";
const RunColumns energy_columns = {
    {"run", [](const RunResult &r) { return r.run.name; }},
    {"cycles",
     [](const RunResult &r) {
       return fmt::format("{:g} to {:g}", r.chain->energy->first_cycle, r.chain->energy->last_cycle);
     }},
    {"work of the exciter (J)", number(joule, &Measures::energy, &Energy::work_excitation)},
    {"dissipated by contact (J)", number(joule, &Measures::energy, &Energy::dissipated_contact)},
    {"dissipated by bond (J)", number(joule, &Measures::energy, &Energy::dissipated_bond)},
    {"change of kinetic (J)", number(joule, &Measures::energy, &Energy::change_kinetic)},
    {"of potential (J)", number(joule, &Measures::energy, &Energy::change_potential)},
    {"of stored in contact (J)", number(joule, &Measures::energy, &Energy::change_stored_contact)},
    {"of stored in bond (J)", number(joule, &Measures::energy, &Energy::change_stored_bond)},
    {"energy error (J)", number(small, &Measures::energy, &Energy::energy_error)},
    {"energy error (% of work)", number(small, &Measures::energy, &Energy::energy_error_percent)}};

PageTable energy_table(const ReportResults &results) {
  PageTable table = empty_table("energy", "energy_table", "Energy balance (J)", 2);
  table.criterion = "runs close their energy balance within 1 % of the exciter's work";
  set_header(table, energy_columns);
  for (const RunResult &result : results.runs) {
    if (!result.chain) continue;
    if (result.chain->energy)
      add_row(table, energy_columns, result,
              state_of_error(result.run, 0.01 * result.chain->energy->energy_error_percent()));
    else
      table.notes.push_back(fmt::format("{}: no energy balance, since the run lacks {}.", result.run.name,
                                        result.chain->energy_missing));
  }
  if (!table.rows.empty())
    table.notes.insert(table.notes.begin(),
                       "From the end of the first to the end of the last cycle named; cycle 0 is the start "
                       "of the excitation. Closure is the energy error: work of the exciter minus dissipated "
                       "energy minus changes of kinetic, potential and stored energy.");
  return table;
}

double relative_difference(const RollerForce &force) {
  return force.largest_difference / force.largest_force;
}

const RunColumns roller_columns =
    naming({{"largest difference (N)", number("{:.3g}", &Measures::roller, &RollerForce::largest_difference)},
            {"largest contact force (N)", number("{:.6g}", &Measures::roller, &RollerForce::largest_force)},
            {"difference over force (-)", number("{:.2e}", &Measures::roller, relative_difference)},
            {"at time (s)", number("{:.5f}", &Measures::roller, &RollerForce::at_time)},
            {"rows compared", number("{}", &Measures::roller, &RollerForce::rows)}});

PageTable roller_table(const ReportResults &results) {
  PageTable table =
      empty_table("roller", "roller_table", "Contact force from measured motion against that of the law", 3);
  table.criterion = "runs have a largest difference of at most 1 % of the largest force";
  set_header(table, roller_columns);
  for (const RunResult &result : results.runs) {
    if (!result.chain) continue;
    if (result.chain->roller)
      add_row(table, roller_columns, result,
              state_of_error(result.run, relative_difference(*result.chain->roller)));
    else
      table.notes.push_back(fmt::format(
          "{}: nothing to compare, since chain.csv has no frame, or its rows are not equally spaced in time.",
          result.run.name));
  }
  if (!table.rows.empty())
    table.notes.insert(
        table.notes.begin(),
        "Accelerations of drum and frame are differences of the positions in five successive rows of "
        "chain.csv; their error is of fourth order in the time between rows. Five rows with a make or break "
        "of contact among them are left out, since the force jumps there.");
  return table;
}

void count(CheckCount &sum, const Check &check) {
  if (check.agreement == Agreement::not_judged) {
    ++sum.not_judged;
    return;
  }
  ++sum.all;
  if (check.agrees()) ++sum.agree;
  if (check.agreement == Agreement::same_digits) ++sum.same_digits;
}

} // namespace

CheckCount count_checks(const ReportResults &results) {
  CheckCount sum;
  for (const std::vector<Check> *checks : {&results.checks, &results.restitution, &results.words})
    for (const Check &check : *checks)
      count(sum, check);
  return sum;
}

CheckCount count_checks(const ReportResults &results, std::size_t run) {
  CheckCount sum;
  for (const std::vector<Check> *checks : {&results.checks, &results.restitution})
    for (const Check &check : *checks)
      if (check.run == run) count(sum, check);
  return sum;
}

std::string judging_command(const Run &run) {
  constexpr int cycles = 120;
  static_assert(cycles >= long_run_cycles);
  const std::string out =
      (fs::canonical(run.folder).parent_path() /
       fmt::format("{}-{}-{}-cycles", run.case_name, transition_name(run.transition()), cycles))
          .string();
  if (run.direct)
    return fmt::format("{} exact --case {} --transition {} --cycles {} --out {}", front_command(),
                       run.case_name, transition_name(run.transition()), cycles, shell_word(out));
  std::string command =
      fmt::format("{} run inputs/chain/in.chain{} -var case {} -var transition {}", front_command(),
                  run.text("engine", "").rfind("LAMMPS", 0) == 0 ? ".lammps" : "", run.case_name,
                  transition_name(run.transition()));
  if (const std::string stepping = run.text("stepping", ""); stepping == "second" || stepping == "stock")
    command += " -var stepping " + stepping;
  if (run.steps_per_cycle > 0) command += fmt::format(" -var steps_per_cycle {}", run.steps_per_cycle);
  if (run.steps_per_cycle > 0 && run.samples_per_cycle > 0 &&
      run.steps_per_cycle % run.samples_per_cycle == 0)
    command += fmt::format(" -var samples_per_cycle {}", run.samples_per_cycle);
  return command + fmt::format(" -var cycles {} -var out {}", cycles, shell_word(out));
}

std::vector<PageTable> make_tables(const ReportResults &results) {
  std::vector<PageTable> tables;
  tables.push_back(runs_table(results));

  tables.push_back(
      check_table("impact", "restitution", "Restitution of single impacts", results, results.restitution));

  PageTable steady = check_table(
      "reference", "checks", "Steady states and meter values against the reference", results, results.checks);
  steady.notes.push_back(
      fmt::format("Measured over {}. Forces and accelerations at a make of contact are those of the located "
                  "events; the share of time in contact follows from the times of the events. To all digits: "
                  "the measured value rounds to the reference value. The tolerance is one unit of the last "
                  "digit given or, for accelerations and forces, 2e-4 of the value, since the states of the "
                  "reference were not closer to steady than that. Direct solution: the exact solution "
                  "over the same cycles, evaluated in the same way.",
                  measured_words(results)));
  if (count_checks(results).not_judged > 0)
    steady.notes.push_back(fmt::format(
        "Short run: fewer than {} cycles, or cut. Its state may not yet be steady to the digits given.",
        long_run_cycles));
  tables.push_back(std::move(steady));

  tables.push_back(
      check_table("reference", "paper_words", "What the paper says in words", results, results.words));

  tables.push_back(engine_table(results));
  tables.push_back(meters_table(results));
  tables.push_back(events_table(results));
  tables.push_back(errors_table(results));
  tables.push_back(energy_table(results));
  tables.push_back(roller_table(results));
  tables.erase(
      std::remove_if(tables.begin(), tables.end(),
                     [](const PageTable &table) { return table.rows.empty() && table.notes.empty(); }),
      tables.end());
  return tables;
}

} // namespace drumlin::post
