#include "report/chain/tables.h"

#include "engine/places.h"
#include "report/chain/engine_comparison.h"
#include "support/text.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

const std::string dash = no_value;

/// The words that say over how many cycles at the end of the runs the chains were measured.
std::string measured_words(const ReportResults &results) {
  std::vector<int> counts;
  for (const RunResult &result : results.runs)
    if (result.chain) counts.push_back(result.chain->steady_count);
  return last_cycles_words(counts);
}

/// A ratio as text; a dash where it is not finite, since its denominator is zero.
std::string finite(const char *format, double value) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : dash;
}

std::string scientific(double value) { return finite("{:.2e}", value); }

std::string steps_text(const Run &run) {
  if (run.direct) return "adaptive";
  if (run.kind == RunKind::impact) return run.text("steps_per_contact", dash) + " per contact";
  return run.steps_per_cycle > 0 ? fmt::format("{}", run.steps_per_cycle) : dash;
}

std::string engine_text(const Run &run) {
  return run.direct ? run.text("solver", run.text("engine", dash)) : run.text("engine", dash);
}

std::string transition_text(const Run &run) {
  return run.kind == RunKind::unknown ? dash : transition_name(run.transition());
}

std::string case_text(const Run &run) {
  if (run.kind == RunKind::impact) return fmt::format("impact, D = {:g}", run.impact.damping_ratio);
  if (run.kind == RunKind::unknown) return dash;
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
  if (!extremes) return dash;
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

void add_check(PageTable &table, const ReportResults &results, const Check &check) {
  const Run &run = results.runs[check.run].run;
  const bool valued = check.agreement != Agreement::not_measured;
  const bool number = valued && std::isfinite(check.difference) && check.measured != "no rebound";
  std::string direct = dash;
  std::string from_direct = dash;
  if (check.direct && number) {
    direct = check.measured == "none" && *check.direct == 0.0
                 ? "none"
                 : fmt::format("{:.{}f}", *check.direct, decimals_of(check.measured));
    from_direct = fmt::format("{:.1e}", check.value - *check.direct);
  }
  table.add({run.name, case_text(run), transition_text(run), check.quantity, check.unit, check.reference,
             valued ? check.measured : dash, number ? fmt::format("{:.2g}", check.difference) : dash,
             number && std::isfinite(check.relative_difference)
                 ? fmt::format("{:.1e}", check.relative_difference)
                 : dash,
             check.tolerance, agreement_text(check, run), direct, from_direct, check.note, check.source},
            check.agrees()                             ? RowState::agrees
            : check.agreement == Agreement::not_judged ? RowState::plain
                                                       : RowState::differs);
}

PageTable check_table(const std::string &section, const std::string &name, const std::string &title) {
  PageTable table;
  table.section = section;
  table.name = name;
  table.title = title;
  table.header = {"run",
                  "case",
                  "transition",
                  "quantity",
                  "unit",
                  "reference",
                  "measured",
                  "difference",
                  "relative (-)",
                  "tolerance",
                  "agrees",
                  "direct solution",
                  "run minus direct",
                  "remark",
                  "reference from"};
  table.shown_columns = 14;
  table.text_columns = 5;
  table.verdict = "agrees";
  table.criterion = "values agree with the reference within the tolerance";
  return table;
}

PageTable runs_table(const ReportResults &results) {
  PageTable table;
  table.section = "runs";
  table.name = "runs";
  table.verdict = "checks that agree";
  table.criterion = "judged runs agree with all their reference values";
  table.title = "Runs";
  table.header = {"run",    "case",  "transition", "stepping",          "steps per cycle", "cycles (-)",
                  "engine", "ranks", "plugin",     "checks that agree", "command"};
  table.shown_columns = 10;
  table.text_columns = 4;
  table.notes.emplace_back(
      "stepping is the scheme by which the engine integrates a time step: second is the second-order scheme, "
      "which knows the part of a step during which balls are in contact; stock is the engine's velocity "
      "Verlet "
      "scheme; exact is the direct solver.");
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    const Run &run = results.runs[i].run;
    const CheckCount count = count_checks(results, i);
    const std::string cycles = run.kind == RunKind::chain
                                   ? fmt::format("{}{}", run.complete,
                                                 !run.cut.empty()                 ? " (cut)"
                                                 : run.complete < long_run_cycles ? " (short run)"
                                                                                  : "")
                                   : dash;
    table.add({run.name, case_text(run), transition_text(run),
               run.direct ? "exact" : run.text("stepping", dash), steps_text(run), cycles, engine_text(run),
               run.direct ? dash : run.text("ranks", dash), run.direct ? dash : run.text("plugin", dash),
               count.all > 0          ? fmt::format("{} of {}", count.agree, count.all)
               : count.not_judged > 0 ? "not judged"
                                      : dash,
               run.text("command", dash)},
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

PageTable events_table(const ReportResults &results) {
  PageTable table;
  table.section = "events";
  table.name = "event_table";
  table.title = "Makes and breaks of contact";
  table.criterion = "runs have the same events as the reference solution, one by one";
  table.header = {"run",
                  "case",
                  "transition",
                  "makes",
                  "breaks",
                  "makes per cycle (-)",
                  "breaks per cycle (-)",
                  "force at make (kN)",
                  "force at break (kN)",
                  "overlap at break (mm)",
                  "events of direct solution",
                  "paired",
                  "largest time difference (µs)",
                  "the same (steps)",
                  "at time (s)"};
  table.shown_columns = table.header.size();
  table.text_columns = 3;
  for (const RunResult &result : results.runs) {
    if (!result.chain || !result.run.has_events) continue;
    const Run &run = result.run;
    const ChainMeasures &m = *result.chain;
    const EventMatch &match = m.match;
    const bool paired = match.matched > 0;
    table.add({run.name, case_text(run), transition_text(run), fmt::format("{}", m.makes),
               fmt::format("{}", m.breaks), fmt::format("{:g}", m.makes_per_cycle),
               fmt::format("{:g}", m.breaks_per_cycle), range_text(m.force_at_make, 1e-3, 3),
               range_text(m.force_at_break, 1e-3, 3), range_text(m.overlap_at_break, 1e3, 4),
               fmt::format("{}", match.reference_count), fmt::format("{}", match.matched),
               paired ? fmt::format("{:.3g}", match.largest_difference * 1e6) : dash,
               paired && run.timestep > 0.0 && !run.direct
                   ? fmt::format("{:.3g}", match.largest_difference / run.timestep)
                   : dash,
               paired ? fmt::format("{:.4f}", match.at_time) : dash},
              !result.reference || !run.cut.empty() ? RowState::plain
              : match.run_count == match.reference_count && match.matched == match.run_count
                  ? RowState::agrees
                  : RowState::differs);
    if (match.run_count != match.reference_count || match.matched != match.run_count)
      table.notes.push_back(
          fmt::format("{}: {} events, {} in the reference solution; the first {} were paired.", run.name,
                      match.run_count, match.reference_count, match.matched));
  }
  table.notes.insert(table.notes.begin(), fmt::format("Forces, overlap and counts per cycle: over {} of each "
                                                      "run. Time differences: of all "
                                                      "events of the run to those of the reference solution "
                                                      "(direct solution), paired in their order; also "
                                                      "in time steps of the run.",
                                                      measured_words(results)));
  return table;
}

PageTable meters_table(const ReportResults &results) {
  PageTable table;
  table.section = "reference";
  table.name = "meter_values";
  table.title = "Compaction meter values";
  table.header = {"run",         "case",    "transition", "A1 (m/s²)",      "A2 (m/s²)",
                  "A0.5 (m/s²)", "CMV (-)", "RMV (-)",    "integrated over"};
  table.shown_columns = table.header.size();
  table.text_columns = 3;
  for (const RunResult &result : results.runs) {
    if (!result.chain) continue;
    const HarmonicAmplitudes &a = result.chain->amplitudes;
    table.add({result.run.name, case_text(result.run), transition_text(result.run),
               fmt::format("{:.4f}", a.fundamental), fmt::format("{:.4f}", a.second),
               fmt::format("{:.2e}", a.half), finite("{:.2f}", compaction_meter_value(a)),
               finite("{:.2g}", resonance_meter_value(a)),
               result.chain->amplitudes_every_step ? "every step" : "samples and events"});
  }
  table.notes.push_back(fmt::format("Compaction meter value CMV = 300 A2 / A1 and resonance meter value RMV "
                                    "= 100 A0.5 / A1. A1, A2 and A0.5 "
                                    "are the amplitudes of drum acceleration at 1, 2 and 1/2 times the "
                                    "excitation frequency, over {}.",
                                    measured_words(results)));
  return table;
}

PageTable errors_table(const ReportResults &results) {
  PageTable table;
  table.section = "direct";
  table.name = "error_table";
  table.title = "Relative RMS error of drum velocity against the reference solution";
  table.criterion = "runs have an error of at most 1 % over their last five cycles, or all of a shorter run";
  table.header = {"run",
                  "case",
                  "transition",
                  "stepping",
                  "steps per cycle",
                  "cycles (-)",
                  "last 5 cycles (-)",
                  "cycles 25 to 30 (-)",
                  "known: second-order stepping (-)",
                  "known: stock stepping (-)"};
  table.shown_columns = table.header.size();
  table.text_columns = 4;
  bool interpolated = false;
  for (const RunResult &result : results.runs) {
    if (!result.chain) continue;
    const Run &run = result.run;
    const ChainMeasures &m = *result.chain;
    const bool comparable = run.at_case && run.chain.transition == Transition::B;
    const std::optional<double> known = comparable || run.case_name == "I"
                                            ? reference_velocity_error(run.case_name, run.steps_per_cycle)
                                            : std::nullopt;
    const std::optional<double> stock =
        comparable ? reference_stock_velocity_error(run.case_name, run.steps_per_cycle) : std::nullopt;
    table.add({run.name, case_text(run), transition_text(run),
               run.direct ? "exact" : run.text("stepping", dash), steps_text(run),
               fmt::format("{}", run.complete), scientific(m.velocity_error_last),
               m.velocity_error_25_to_30 ? scientific(*m.velocity_error_25_to_30) : dash,
               known ? scientific(*known) : dash, stock ? scientific(*stock) : dash},
              state_of_error(run, m.velocity_error_last));
    interpolated = interpolated || m.reference_interpolated;
  }
  table.notes.emplace_back(
      "Known: errors that the reference values give for cycles 25 to 30 under condition B, at 200, 400, 800, "
      "1600, 3200 and 6400 steps per cycle.");
  if (interpolated)
    table.notes.emplace_back("Some runs have rows at times between those of the reference solution, which "
                             "was interpolated there.");
  return table;
}

PageTable energy_table(const ReportResults &results) {
  PageTable table;
  table.section = "energy";
  table.name = "energy_table";
  table.title = "Energy balance (J)";
  table.criterion = "runs close their energy balance within 1 % of the exciter's work";
  table.header = {"run",
                  "cycles",
                  "work of the exciter (J)",
                  "dissipated by contact (J)",
                  "dissipated by bond (J)",
                  "change of kinetic (J)",
                  "of potential (J)",
                  "of stored in contact (J)",
                  "of stored in bond (J)",
                  "energy error (J)",
                  "energy error (% of work)"};
  table.shown_columns = table.header.size();
  table.text_columns = 2;
  for (const RunResult &result : results.runs) {
    if (!result.chain) continue;
    if (!result.chain->energy) {
      table.notes.push_back(fmt::format("{}: no energy balance, since the run lacks {}.", result.run.name,
                                        result.chain->energy_missing));
      continue;
    }
    const EnergyBalance &e = *result.chain->energy;
    const auto joule = [](double value) { return fmt::format("{:.4f}", value); };
    table.add({result.run.name, fmt::format("{:g} to {:g}", e.first_cycle, e.last_cycle),
               joule(e.work_excitation), joule(e.dissipated_contact), joule(e.dissipated_bond),
               joule(e.change_kinetic), joule(e.change_potential), joule(e.change_stored_contact),
               joule(e.change_stored_bond), scientific(e.energy_error()),
               scientific(e.energy_error_percent())},
              state_of_error(result.run, 0.01 * e.energy_error_percent()));
  }
  if (!table.rows.empty())
    table.notes.insert(
        table.notes.begin(),
        "From the end of the first to the end of the last cycle named; cycle 0 is the start of the "
        "excitation. Closure is the energy error: work of the exciter minus dissipated energy "
        "minus changes of kinetic, potential and stored energy.");
  return table;
}

PageTable roller_table(const ReportResults &results) {
  PageTable table;
  table.section = "roller";
  table.name = "roller_table";
  table.title = "Contact force from measured motion against that of the law";
  table.criterion = "runs have a largest difference of at most 1 % of the largest force";
  table.header = {"run",
                  "case",
                  "transition",
                  "largest difference (N)",
                  "largest contact force (N)",
                  "difference over force (-)",
                  "at time (s)",
                  "rows compared"};
  table.shown_columns = table.header.size();
  table.text_columns = 3;
  for (const RunResult &result : results.runs) {
    if (!result.chain) continue;
    if (!result.chain->roller) {
      table.notes.push_back(
          fmt::format("{}: nothing to compare, since chain.csv has no frame, or its rows are "
                      "not equally spaced in time.",
                      result.run.name));
      continue;
    }
    const RollerForce &force = *result.chain->roller;
    table.add({result.run.name, case_text(result.run), transition_text(result.run),
               fmt::format("{:.3g}", force.largest_difference), fmt::format("{:.6g}", force.largest_force),
               scientific(force.largest_difference / force.largest_force),
               fmt::format("{:.5f}", force.at_time), fmt::format("{}", force.rows)},
              state_of_error(result.run, force.largest_difference / force.largest_force));
  }
  if (!table.rows.empty())
    table.notes.insert(
        table.notes.begin(),
        "Accelerations of drum and frame are differences of the positions in five successive rows "
        "of chain.csv; their error is of fourth order in the time between rows. Five rows with a "
        "make or break of contact among them are left out, since the force jumps there.");
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

  PageTable restitution = check_table("impact", "restitution", "Restitution of single impacts");
  for (const Check &check : results.restitution)
    add_check(restitution, results, check);
  tables.push_back(std::move(restitution));

  PageTable steady =
      check_table("reference", "checks", "Steady states and meter values against the reference");
  for (const Check &check : results.checks)
    add_check(steady, results, check);
  steady.notes.push_back(fmt::format(
      "Measured over {}. Forces and accelerations at a make of contact are those of "
      "the located events; the share of time in contact follows from the times of the events. To all "
      "digits: the measured value rounds to the reference value. The tolerance is one unit of the last "
      "digit given or, for accelerations and forces, 2e-4 of the value, since the states of the "
      "reference were not closer to steady than that. Direct solution: the reference solution (direct "
      "solver) over the same cycles, evaluated in the same way.",
      measured_words(results)));
  if (count_checks(results).not_judged > 0)
    steady.notes.push_back(
        fmt::format("Short run: fewer than {} cycles, or cut. Its state may not yet be steady to "
                    "the digits given.",
                    long_run_cycles));
  tables.push_back(std::move(steady));

  PageTable words = check_table("reference", "paper_words", "What the paper says in words");
  for (const Check &check : results.words)
    add_check(words, results, check);
  tables.push_back(std::move(words));

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
