#include "commands/commands.h"

#include "commands/record_options.h"
#include "identify/page.h"
#include "runs/parameter_file.h"
#include "support/files.h"
#include "support/options.h"
#include "support/units.h"
#include "support/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr const char *table_name = "identify.csv";

struct IdentifyArguments : Options {
  using Options::Options;
  RecordArguments record{command()};
  Flag accelerations_only =
      flag("--accelerations-only",
           "do not use positions and velocities of the record: what a roller with accelerometers has");
  Flag anyway = flag("--anyway", "show a result that contradicts itself, or of a filtered record");
  Flag compare =
      flag("--compare", "solve the chain with this k and D, and draw it over the record: acceleration, force "
                        "loop, share of contact, CMV, with what a spring and a dashpot cannot do; of a run, "
                        "whose parameters.csv or --roller gives the bond");
  Text origin =
      text("--origin", "WORD",
           "known: x_drum = 0 is where drum and soil just touch; free: unknown, for each contact; if not "
           "given known "
           "for the run of a chain whose parameters.csv has D or way");
  Number phase_within = number(
      "--phase-within", {0.0, 20.0, "degrees"},
      "largest error of the exciter's phase [degrees], 0 to 20: the phase is then fitted as far as the "
      "record tells it; if not given 3 for --phase, else 0");
  Number least_force = number(
      "--least-force", {0.0, 90.0, "%"},
      "forces up to this share of the largest one [%] are not fitted, unless the law follows them, 0 to 90; "
      "if not given 0 for the run of a chain, 20 for all others, since soil that a drum just touches is "
      "softer");
  Number m2_tolerance = number("--m2-tolerance", {0.0, 20.0, "%"}, tolerance_help("the mass of the drum"));
  Number m3_tolerance = number("--m3-tolerance", {0.0, 20.0, "%"}, tolerance_help("the mass of the frame"));
  Number me_re_tolerance =
      number("--me-re-tolerance", {0.0, 20.0, "%"}, tolerance_help("the eccentric moment or force"));
  Number bond_tolerance = number(
      "--bond-tolerance", {0.0, 100.0, "%"},
      "by how much stiffness and damping of the bond may be off [%], 0 to 100, if the record has no "
      "acceleration of the frame; if not given 0, or 50 for a bond that neither --roller nor --k23 and --c23 "
      "give");
  Text window = text("--window", "COUNT",
                     "cycles of a window, 4 or more, or of a roller that drives metres such as 0.5m", "10");
  WayArguments way{command()};
  ResultPath out = result_folder("--out", "folder of the results", "results/identify");

private:
  static std::string tolerance_help(const char *what) {
    return fmt::format("by how much {} may be off [%], 0 to 20: the effect on k, c and D is shown apart",
                       what);
  }
};

RecordSetting judge(const IdentifyArguments &arguments) {
  RecordSetting setting;
  setting.accelerations_only = arguments.accelerations_only.given();
  if (arguments.origin)
    setting.known_origin = choice_option("--origin", *arguments.origin, {"known", "free"}) == "known";
  constexpr double usual_degrees = 3.0;
  if (arguments.phase_within || arguments.record.phase)
    setting.phase_within = pi / 180.0 * arguments.phase_within.value_or(usual_degrees);
  if (arguments.least_force) setting.least_force = 0.01 * *arguments.least_force;
  constexpr int most_window = 1000000;
  if (!window_length(*arguments.window))
    setting.window = count_option("--window", *arguments.window, least_cycles, most_window);
  return setting;
}

/// The record, or the part of the way of it that is asked for.
Record read(const RecordArguments &arguments, const WayRange &way) {
  const Record record = judged(arguments);
  return way.given() ? part_of(record, rows_on(record, way)) : record;
}

/// The cycles in which the roller drives a length [m] at its mean speed.
int cycles_on(const Record &record, const Text &window, double length) {
  double driven = 0.0;
  for (std::size_t row = 1; row < record.s.size(); ++row)
    driven += std::abs(record.s[row] - record.s[row - 1]);
  if (!(driven > 0.0)) throw window.refused("metres only for a roller that drives, of a run with s");
  const double a_cycle = driven / record.cycles();
  const double cycles = std::round(length / a_cycle);
  if (cycles < least_cycles || cycles > record.cycles() + 0.5)
    throw window.refused(fmt::format("{:.3g}m, four cycles of the excitation, to {:.3g}m, the whole way",
                                     least_cycles * a_cycle, driven));
  return static_cast<int>(cycles);
}

// The folder of results, absolute: new, empty or of an earlier identification, which is replaced.
fs::path judged_folder(const ResultPath &out) {
  if (fs::exists(*out) && !fs::is_empty(*out) && !fs::exists(*out / table_name))
    throw out.refused("a folder that is new, empty or of an earlier identification");
  fs::path place = fs::absolute(*out).lexically_normal();
  if (!place.has_filename()) place = place.parent_path();
  return place;
}

/// The tolerances that were given, half widths of 95 %; else those of the roller's file.
MachineTolerances judge_tolerances(const IdentifyArguments &arguments, const Record &record) {
  const auto share = [](const Number &given, double of_file) { return given ? 0.01 * *given : of_file; };
  const MachineTolerances &file = record.tolerances;
  const bool with_force = record.excitation_read || !record.Fw;
  if (with_force && arguments.me_re_tolerance)
    throw arguments.me_re_tolerance.refused("not given for a record with a column F_excitation");
  return {share(arguments.m2_tolerance, file.m2), share(arguments.m3_tolerance, file.m3),
          share(arguments.me_re_tolerance, with_force ? 0.0 : file.me_re),
          record.two_sided() ? file.exciter : 0.0};
}

/// k, c and D of each contact, with the parts of the machine.
using Laws = std::vector<MachinePart>;

Laws laws_of(const IdentifiedRecord &found) {
  const LawEstimate &law = found.whole.law;
  return {{law.k.mean, law.c.mean, law.D.mean}};
}

Laws laws_of(const TwoSidedRecord &found) {
  Laws laws;
  for (const HalfLaw &half : found.halves)
    laws.push_back({half.k.mean, half.c.mean, half.D.mean});
  return laws;
}

const MotionFit *motion_of(const IdentifiedRecord &found) { return found.motion ? &*found.motion : nullptr; }
const MotionFit *motion_of(const TwoSidedRecord &found) { return &found.motion; }

/// What the tolerances do to k, c and D of each contact: the record is read and identified again with each
/// datum changed. Nothing without tolerances.
/// \param identify a function that identifies a record as this one was, without a search
template <class Found, class Identify>
Laws machine_parts(const RecordArguments &arguments, const WayRange &way, const Record &record,
                   const Found &result, const Identify &identify) {
  const MachineTolerances &tolerances = record.tolerances;
  const Laws found = laws_of(result);
  const bool by_motion = motion_of(result) != nullptr;
  // The whole motion has force and bond among its unknowns.
  const double of_bond = record.frame_computed && !by_motion ? record.bond->tolerance : 0.0;
  const double of_force = by_motion ? 0.0 : tolerances.me_re;
  if (tolerances.m2 + tolerances.m3 + tolerances.exciter + of_force + of_bond == 0.0) return {};
  Laws parts(found.size());
  MachineTolerances changed_tolerances = tolerances;
  if (by_motion && motion_of(result)->any_force) changed_tolerances.me_re = machine_agreement;
  const auto add = [&](double tolerance, double most_step,
                       const std::function<void(RecordArguments &, double)> &change) {
    if (tolerance == 0.0) return;
    const double step = std::min(tolerance, most_step); // the effect is linear in smaller ones
    RecordArguments changed = arguments;
    changed.roller.is_first = false;
    if (record.frame_computed) { // a given frame mass must not change the bond of a roller
      changed.k23.set(record.bond->stiffness);
      changed.c23.set(record.bond->damping);
      changed.bond_tolerance->set(100.0 * record.bond->tolerance);
    }
    change(changed, step);
    Record other = read(changed, way);
    other.tolerances = changed_tolerances;
    Found of_other = identify(other);
    // Flights tell force over mass: with another mass one motion follows the record with another force only.
    if (by_motion && motion_of(result)->is_noise && !(motion_of(of_other) && motion_of(of_other)->is_noise)) {
      changed_tolerances.me_re = other.tolerances.me_re = machine_agreement;
      of_other = identify(other);
    }
    const Laws again = laws_of(of_other);
    for (std::size_t i = 0; i < parts.size(); ++i)
      for (const auto value : {&MachinePart::k, &MachinePart::c, &MachinePart::D})
        parts[i].*value = std::hypot(parts[i].*value, tolerance / step * (again[i].*value - found[i].*value));
  };
  constexpr double share = 0.01, length = 0.01; // m
  add(tolerances.m2, share, [&](RecordArguments &a, double by) { a.m2.set((1.0 + by) * *record.m2); });
  add(tolerances.m3, share, [&](RecordArguments &a, double by) { a.m3.set((1.0 + by) * *record.m3); });
  add(tolerances.exciter, length, [&](RecordArguments &a, double by) { a.exciter_shift = by; });
  add(of_bond, share, [&](RecordArguments &a, double by) {
    a.k23.set((1.0 + by) * record.bond->stiffness);
    a.c23.set((1.0 + by) * record.bond->damping);
  });
  add(of_force, share, [&](RecordArguments &a, double by) {
    if (a.Fw)
      a.Fw.set((1.0 + by) * *record.Fw);
    else
      a.me_re.set((1.0 + by) * (*record.Fw / (*record.omega * *record.omega)));
  });
  return parts;
}

void make_parent_of(const fs::path &place, const IdentifyArguments &arguments) {
  try {
    make_output_folder(place.parent_path());
  } catch (const std::runtime_error &error) {
    throw UsageError(fmt::format("--out is '{}': {}", arguments.out.text(), error.what()));
  }
}

/// Writes the page and the tables, either all or none of them, and prints the answer. \param page a function
/// that writes the page into a folder
template <class Found, class Page>
void publish(const IdentifyArguments &arguments, const fs::path &place, const Record &record,
             const Found &found, const Page &page) {
  make_parent_of(place, arguments);
  FolderInProgress draft(place);
  page(draft.path());
  write_files({{draft.path() / table_name, identification_csv(found)},
               {draft.path() / "parameters.csv", settings_of(record)}});
  draft.publish();
  for (const std::string &line : record.notes)
    fmt::print("{}\n", line);
  fmt::print("{}: {:.4g} cycles at {:.4g} Hz, 95 % confidence intervals\n", found.file.string(), found.cycles,
             found.frequency);
}

/// A record of both ends of the drum.
void run_two_sided(const IdentifyArguments &arguments, const RecordArguments &asked,
                   const RecordSetting &setting, const fs::path &place, const Record &record,
                   const WayRange &way) {
  const char *const allowed = "not given for a record of both ends of the drum";
  if (arguments.compare) throw UsageError(refusal("--compare", "", allowed));
  for (const Text *option : {&arguments.origin, &arguments.record.logger_low_pass})
    if (*option) throw option->refused(allowed);
  TimedProgress progress;
  TwoSidedRecord found = identify_two_sided(
      record, setting, [&progress](const std::string &what) { progress.tell("{}", what); });
  const Laws parts = machine_parts(asked, way, record, found, [&](const Record &changed) {
    RecordSetting same = setting;
    same.search = false;
    same.force = found.motion.force.mean;
    return identify_two_sided(changed, same);
  });
  for (std::size_t half = 0; half < parts.size(); ++half)
    found.halves[half].machine = parts[half];
  publish(arguments, place, record, found, [&](const fs::path &folder) {
    write_identification_page(folder, found, roller_words(record.parameters));
  });
  for (const std::string &line : identification_answer(found))
    fmt::print("  {}\n", line);
  fmt::print("{}\n", (*arguments.out / "index.html").string());
}

void run(const IdentifyArguments &arguments) {
  RecordSetting setting = judge(arguments);
  const WayRange way = judged(arguments.way);
  const fs::path place = judged_folder(arguments.out);
  keep_apart(files_of(arguments.record), {{"--out", place, true}});
  RecordArguments asked = arguments.record;
  asked.bond_tolerance = arguments.bond_tolerance;
  Record record = read(asked, way);
  if (const auto length = window_length(*arguments.window))
    setting.window = cycles_on(record, arguments.window, *length);
  record.tolerances = judge_tolerances(arguments, record);
  if (record.low_pass > 0.0 && !arguments.anyway.given())
    throw UsageError(refusal("--low-pass", fmt::format("{:g}", record.low_pass),
                             "no filter: it smooths the jump of each landing, which changes k and c; the fit "
                             "averages noise by itself"));
  if (record.two_sided()) {
    run_two_sided(arguments, asked, setting, place, record, way);
    return;
  }
  if (arguments.compare) require_comparable(record);
  TimedProgress progress;
  IdentifiedRecord found =
      identify_record(record, setting, [&progress](const std::string &what) { progress.tell("{}", what); });
  const std::optional<std::string> doubt = contradiction(found);
  if (doubt && !arguments.anyway.given())
    throw std::runtime_error(fmt::format("{}: {} (--anyway shows the result)", found.file.string(), *doubt));
  const Laws parts = machine_parts(asked, way, record, found, [&](const Record &changed) {
    RecordSetting same = setting;
    same.window = 0;
    same.search = false;
    return identify_record(changed, same);
  });
  if (!parts.empty()) found.machine = parts.front();
  std::optional<LumpedComparison> compared;
  if (arguments.compare) compared = compare_lumped(record, found);
  publish(arguments, place, record, found, [&](const fs::path &folder) {
    write_identification_page(folder, found, compared ? &*compared : nullptr,
                              roller_words(record.parameters));
  });
  if (doubt) fmt::print("  The result contradicts itself: {}.\n", *doubt);
  for (const std::string &line : identification_answer(found))
    fmt::print("  {}\n", line);
  if (!found.windows.empty()) {
    const LawEstimate &law = found.whole.law;
    const std::string words = averaging_words(record, found.windows.back().begin, found.windows.back().end,
                                              std::pair(law.k.mean, law.c.mean));
    if (!words.empty()) fmt::print("  {}\n", words);
  }
  if (compared)
    for (const std::string &line : lumped_answer({*compared}))
      fmt::print("  {}\n", line);
  fmt::print("{}: loops, residuals and {} windows\n", (*arguments.out / "index.html").string(),
             found.windows.size());
}

} // namespace

void add_identify_command(CLI::App &app, Session &session) {
  add_command<IdentifyArguments>(
      app, session, "identify",
      "Stiffness k, damping c and D of the contact between drum and soil, with 95 % confidence "
      "intervals, and whether the contact pulls, from the motion of drum and frame. Writes a page "
      "with plots, and identify.csv.",
      run,
      "Examples:\n"
      "  drumlin identify results/chain\n"
      "  drumlin identify results/bed/B --compare --window 5 --out results/identify-bed\n"
      "  drumlin identify measured.csv --column 'a_drum=Acc drum:g' --column 'a_frame=Acc frame:g' "
      "--sampling-rate 1000 --frequency 29 --phase 90 --phase-within 1 --me-re 7.31 --m2 3962 --m3 "
      "3379\n"
      "  drumlin identify measured.csv --roller inputs/rollers/CA3500 --setting high\n");
}

} // namespace drumlin::post
