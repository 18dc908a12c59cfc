#include "report/answer.h"

#include "bed/relative_density.h"
#include "report/chain/engine_comparison.h"
#include "report/chain/tables.h"
#include "runs/parameter_file.h"
#include "support/statistics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace drumlin::post {

namespace {

/// "a, b and c".
std::string enumerated(const std::vector<std::string> &words) {
  if (words.size() < 2) return words.empty() ? "" : words.front();
  return fmt::format("{} and {}", fmt::join(words.begin(), words.end() - 1, ", "), words.back());
}

std::string counted(std::size_t number, const std::string &one, const std::string &many) {
  return fmt::format("{} {}", number, number == 1 ? one : many);
}

/// Each word once, in the order of first appearance; empty words are left out.
std::vector<std::string> distinct(const std::vector<std::string> &words) {
  std::vector<std::string> out;
  for (const std::string &word : words)
    if (!word.empty() && std::find(out.begin(), out.end(), word) == out.end()) out.push_back(word);
  return out;
}

std::string what_was_run(const ReportResults &results) {
  std::size_t chains = 0;
  std::size_t impacts = 0;
  std::vector<std::string> cases;
  std::vector<std::string> engines;
  std::set<std::string> transitions;
  for (const RunResult &result : results.runs) {
    const Run &run = result.run;
    if (run.kind == RunKind::chain) ++chains;
    if (run.kind == RunKind::impact) ++impacts;
    if (run.kind == RunKind::unknown) continue;
    if (run.kind == RunKind::chain && run.at_case) cases.push_back(run.case_name);
    transitions.insert(transition_name(run.transition()));
    engines.push_back(run.direct ? "the exact solution" : run.text("engine", ""));
  }
  std::vector<std::string> parts;
  if (chains > 0) {
    cases = distinct(cases);
    std::sort(cases.begin(), cases.end()); // I, II, III, IV
    parts.push_back(counted(chains, "run", "runs") + " of the chain soil – drum – frame" +
                    (cases.empty()
                         ? ""
                         : fmt::format(" ({} {})", cases.size() == 1 ? "case" : "cases", enumerated(cases))));
  }
  if (impacts > 0) parts.push_back(counted(impacts, "single impact", "single impacts"));
  const std::size_t others = results.runs.size() - chains - impacts;
  if (others > 0) parts.push_back(counted(others, "run", "runs") + " without usable parameters");
  std::string words = enumerated(parts);
  if (!transitions.empty())
    words += fmt::format(" under {} {}", transitions.size() == 1 ? "condition" : "conditions",
                         enumerated({transitions.begin(), transitions.end()}));
  engines = distinct(engines);
  if (!engines.empty()) words += ", by " + enumerated(engines);
  return words + ".";
}

/// How the judged values of each integration scheme came out, if there are several.
std::string by_scheme(const ReportResults &results) {
  std::map<std::string, std::pair<std::size_t, std::size_t>> schemes; // values that agree, and all
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    const Run &run = results.runs[i].run;
    const CheckCount own = count_checks(results, i);
    if (own.all == 0) continue;
    auto &[agree, all] = schemes[run.direct ? "exact solution" : run.text("stepping")];
    agree += own.agree;
    all += own.all;
  }
  if (schemes.size() < 2) return {};
  std::vector<std::string> parts;
  parts.reserve(schemes.size());
  for (const auto &[scheme, sum] : schemes)
    parts.push_back(fmt::format("{} {} of {}", scheme, sum.first, sum.second));
  return fmt::format("By integration scheme (stepping): {}.", enumerated(parts));
}

Answer reference_values_answer(const ReportResults &results) {
  const CheckCount count = count_checks(results);
  Answer answer;
  if (count.all > 0) {
    answer.verdict = count.agree == count.all ? Verdict::good : Verdict::bad;
    answer.sentences.push_back({fmt::format("{} of {} values agree with the reference values, which are "
                                            "computed and not measured, {} of them in every digit given.",
                                            count.agree, count.all, count.same_digits),
                                "Verification."});
    if (const std::string schemes = by_scheme(results); !schemes.empty())
      answer.sentences.push_back({schemes});
  }
  if (count.not_judged > 0)
    answer.sentences.push_back(
        {fmt::format(
             "{} values are not judged: the reference values are of steady states, which need runs of {} "
             "cycles or more that have ended; the table of runs has the commands for such runs.",
             count.not_judged, long_run_cycles),
         count.all > 0 ? "" : "Verification."});
  if (count.all + count.not_judged == 0)
    answer.sentences.push_back(
        {"No run has the parameters of a case with reference values.", "Verification."});
  return answer;
}

std::string force_words(const RunResult &result) {
  const Extremes &force = result.chain->extremes.force;
  return fmt::format("{:.2f} kN under {}{}", force.max * 1e-3, transition_name(result.run.transition()),
                     force.min < 0.0 ? fmt::format(", with tension up to {:.2f} kN,", -force.min * 1e-3)
                                     : "");
}

/// Of the cases that were run under both conditions: the one in which the largest contact forces differ most.
std::string a_against_b(const ReportResults &results) {
  const RunResult *most_a = nullptr;
  const RunResult *most_b = nullptr;
  double most = 0.0;
  std::vector<std::string> equal;
  for (const char *name : {"I", "II", "III", "IV"}) {
    const RunResult *a = best_run(results, name, Transition::A);
    const RunResult *b = best_run(results, name, Transition::B);
    if (a == nullptr || b == nullptr || a->run.at_case != b->run.at_case) continue;
    const double difference = std::abs(a->chain->extremes.force.max / b->chain->extremes.force.max - 1.0);
    constexpr double same = 1e-9;
    if (difference < same) equal.emplace_back(name);
    if (most_a != nullptr && difference <= most) continue;
    most_a = a;
    most_b = b;
    most = difference;
  }
  if (most_a == nullptr) return {};
  const std::string coincide =
      equal.empty() ? "" : fmt::format("{} {}", equal.size() == 1 ? "case" : "cases", enumerated(equal));
  if (most == 0.0 || equal.size() == 4) return fmt::format("Conditions A and B coincide in {}.", coincide);
  return fmt::format("Conditions A and B differ most in case {}: the largest contact force is {} and {}{}.",
                     most_a->run.case_name, force_words(*most_a), force_words(*most_b),
                     coincide.empty() ? "" : fmt::format("; in {} they coincide", coincide));
}

/// Restitution of a single impact under each condition, at the damping ratio of the first impact.
std::string restitution_words(const ReportResults &results) {
  std::map<std::string, std::string> rebounds;
  double damping_ratio = -1.0;
  for (const RunResult &result : results.runs) {
    if (!result.impact || !result.impact->hits || !result.impact->ended) continue;
    if (damping_ratio < 0.0) damping_ratio = result.run.impact.damping_ratio;
    if (result.run.impact.damping_ratio == damping_ratio)
      rebounds.emplace(transition_name(result.run.transition()),
                       fmt::format("{:.4f} under {}", result.impact->restitution(),
                                   transition_name(result.run.transition())));
  }
  if (rebounds.empty()) return {};
  std::vector<std::string> parts;
  parts.reserve(rebounds.size());
  for (const auto &[transition, words] : rebounds)
    parts.push_back(words);
  return fmt::format("The restitution of a single impact at D = {:g} is {}.", damping_ratio,
                     enumerated(parts));
}

std::string error_words(const ReportResults &results) {
  const RunResult *worst = nullptr;
  for (const RunResult &result : results.runs) {
    if (!result.chain || result.run.direct || !std::isfinite(result.chain->velocity_error_last)) continue;
    if (worst == nullptr || result.chain->velocity_error_last > worst->chain->velocity_error_last)
      worst = &result;
  }
  if (worst == nullptr) return {};
  return fmt::format("The drum velocity differs from the exact solution by at most "
                     "{:.2e} (relative RMS over {}; run {}).",
                     worst->chain->velocity_error_last,
                     last_cycles_words({std::min(error_cycles, worst->run.complete)}), worst->run.name);
}

Answer engines_answer(const ReportResults &results) {
  const PageTable table = engine_table(results);
  Answer answer;
  if (table.rows.empty()) return answer;
  const std::size_t agree = table.count(RowState::agrees);
  answer.sentences.push_back({fmt::format("LIGGGHTS and LAMMPS agree within {:g} in {} of {} pairs of runs.",
                                          engines_agree_to, agree, table.rows.size()),
                              "Engines."});
  answer.verdict = agree == table.rows.size() ? Verdict::good : Verdict::bad;
  return answer;
}

/// "36 mm under B and 35 mm under A", of several beds "36 ± 2 mm under B"; one value if all are the
/// same text.
std::string of_each(const BedGroup &group, const std::function<double(const BedMeasures &)> &value,
                    const std::string &unit) {
  std::vector<std::string> values;
  std::vector<std::string> words;
  for (const Transition transition : group.conditions()) {
    std::vector<double> found;
    for (const BedResult *result : group.under(transition))
      found.push_back(value(result->measures));
    const MeanError mean = mean_error(found);
    const double deviation = std::sqrt(mean.variance.value * static_cast<double>(found.size()));
    values.push_back(found.size() == 1
                         ? two_digits(mean.mean) + unit
                         : fmt::format("{} ± {}{}", two_digits(mean.mean), two_digits(deviation), unit));
    words.push_back(fmt::format("{} under {}", values.back(), transition_name(transition)));
  }
  return words.size() > 1 && distinct(values).size() == 1 ? values.front() : enumerated(words);
}

/// What the results of a bed are worth, told before them.
std::string worth_of(const BedGroup &group) {
  std::string words = "Settlement and change of density of a bed are not those of a site; forces, "
                      "accelerations and stiffness count as means over several beds.";
  const BedResult &first = *group.runs.front();
  const double solid = 1.0 / (1.0 + first.measures.void_ratio_start);
  if (const double shaken = densest_by_shaking(first.run.parameters, 0, per_metre(first.run)); solid > shaken)
    words += fmt::format(" The soil begins at a solid fraction of {:.3f}; shaking leaves at most {:.3f} of "
                         "such soil, so that it can only loosen: disregard how its density changes.",
                         solid, shaken);
  return words;
}

void add_group(Answer &answer, const BedGroup &group) {
  const Run &run = group.runs.front()->run;
  std::vector<std::string> names;
  std::vector<int> steady;
  int cycles = run.complete;
  bool good = true, judged = true;
  for (const BedResult *result : group.runs) {
    names.push_back(result->run.name);
    steady.push_back(result->measures.steady_count);
    cycles = std::min(cycles, result->measures.cycles);
    good = good && energy_is_good(result->measures);
    judged = judged && result->run.cut.empty();
  }
  const char *per = per_metre_words(run);
  const std::string scene =
      fmt::format("A roller on {} balls ({}): drum {:g} kg{}, frame {:g} kg{}, exciter {:g} kN{} at {:g} Hz",
                  run.text("balls", "?"), enumerated(names), run.chain.m2, per, run.chain.m3, per,
                  run.chain.Fw * 1e-3, per, 1.0 / run.chain.period());
  if (cycles < 1) {
    answer.sentences.push_back({scene + ". It ends before its first complete cycle.", "Bed."});
    return;
  }
  answer.sentences.push_back({worth_of(group), "Bed."});
  answer.sentences.push_back({scene + "."});
  if (const std::string roller = roller_words(run.parameters); !roller.empty())
    answer.sentences.push_back({roller});
  const auto risen = [](const BedResult *result) { return result->measures.settlement < 0.0; };
  const bool all_risen = std::all_of(group.runs.begin(), group.runs.end(), risen);
  const bool some_risen = !all_risen && std::any_of(group.runs.begin(), group.runs.end(), risen);
  const double sign = all_risen ? -1e3 : 1e3;
  answer.sentences.push_back({fmt::format(
      "After {} the drum has {} by {} (mean over the last cycle{}); the largest contact force on it in {} is "
      "{}.",
      counted(static_cast<std::size_t>(cycles), "cycle", "cycles"), all_risen ? "risen" : "settled",
      of_each(
          group, [sign](const BedMeasures &m) { return m.settlement * sign; }, " mm"),
      some_risen ? ", negative where it has risen" : "", last_cycles_words(steady),
      of_each(
          group, [](const BedMeasures &m) { return m.extremes.force.max * 1e-3; },
          std::string(" kN") + per))});
  std::vector<std::string> beds;
  for (const Transition transition : group.conditions())
    beds.push_back(fmt::format("{} under {}", counted(group.under(transition).size(), "bed", "beds"),
                               transition_name(transition)));
  answer.sentences.push_back(
      {group.several()
           ? fmt::format(
                 "Means are over {}, and behind ± stands the standard deviation of single beds, which differ "
                 "in their seed.",
                 enumerated(beds))
           : BedScatter::words()});
  answer.sentences.push_back({fmt::format(
      "The void ratio of the bed, at first {}, changes by {}, the number of contacts per ball, at first {}, "
      "by {}.",
      two_digits(group.runs.front()->measures.void_ratio_start),
      of_each(
          group, [](const BedMeasures &m) { return m.void_ratio_end - m.void_ratio_start; }, ""),
      two_digits(group.runs.front()->measures.coordination_start),
      of_each(
          group, [](const BedMeasures &m) { return m.coordination_end - m.coordination_start; }, ""))});
  if (std::isfinite(group.runs.front()->measures.imbalance_percent))
    answer.sentences.push_back(
        {fmt::format("The energy error, a check of the integration alone, is {} of the exciter's work.",
                     of_each(
                         group, [](const BedMeasures &m) { return m.imbalance_percent; }, " %"))});
  // That energy is balanced does not show that a bed is right: no good verdict.
  if (judged && !good) answer.verdict = Verdict::bad;
}

} // namespace

void Answer::add(const Answer &other) {
  sentences.insert(sentences.end(), other.sentences.begin(), other.sentences.end());
  if (other.verdict == Verdict::bad || verdict == Verdict::none) verdict = other.verdict;
}

Answer chain_answer(const ReportResults &results) {
  Answer answer;
  if (results.runs.empty()) return answer;
  answer.sentences.push_back({what_was_run(results), "Runs."});
  std::vector<std::string> rollers;
  for (const RunResult &result : results.runs)
    rollers.push_back(roller_words(result.run.parameters));
  for (const std::string &roller : distinct(rollers))
    answer.sentences.push_back({roller});
  answer.add(reference_values_answer(results));
  for (const Sentence &sentence :
       {Sentence{a_against_b(results), "A against B."}, Sentence{restitution_words(results), "Impact."},
        Sentence{error_words(results), "Error."}})
    if (!sentence.text.empty()) answer.sentences.push_back(sentence);
  const Verdict values = answer.verdict;
  answer.add(engines_answer(results));
  // Agreement of the engines does not show that their values are right.
  if (values == Verdict::none && answer.verdict == Verdict::good) answer.verdict = Verdict::none;
  return answer;
}

Answer bed_answer(const std::vector<BedGroup> &groups) {
  Answer answer;
  constexpr std::size_t most = 2; // groups; the tables have all
  for (std::size_t i = 0; i < std::min(most, groups.size()); ++i)
    add_group(answer, groups[i]);
  if (groups.size() > most)
    answer.sentences.push_back({fmt::format("The page on beds has {} more.", groups.size() - most)});
  return answer;
}

bool energy_is_good(const BedMeasures &measures) {
  return std::abs(measures.imbalance_percent) <= 100.0 * good_error;
}

} // namespace drumlin::post
