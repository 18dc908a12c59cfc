#include "commands/commands.h"

#include "chain/exact_solution.h"
#include "chain/driven_way.h"
#include "chain/parameters.h"
#include "chain/two_ends.h"
#include "commands/chain_options.h"
#include "runs/chain_files.h"
#include "support/files.h"
#include "support/options.h"
#include "support/progress.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

struct ExactArguments : Options {
  explicit ExactArguments(Command &of) : Options(of) {
    only_with(way, {&speed, &passes}, "a number with --way FILE");
    only_with(way, {&turn_round}, "none without --way FILE");
    only_with(contacts, {&turn_round}, "none without --contacts: the drum has no sides");
    only_with(contacts, {&tilt}, "a number with --contacts");
    not_with(way, {&cycles}, "none with --way: they follow from its length, --speed and --passes");
  }
  ChainArguments chain{command()};
  Number cycles = number("--cycles", ExactOptions::cycles_range, "cycles of the excitation (default 30)");
  Text way = text(
      "--way", "FILE",
      fmt::format("the roller drives over the soil of this table, with the columns {}, or with --contacts "
                  "{}; chain.csv then has place and pass",
                  way_file::header, way_file::header_of_halves));
  Number speed = number("--speed", {1e-6, 100.0, "m/s"}, "of a roller that drives [m/s]");
  Count passes = count("--passes", 1, 1000, "over the whole way: forth, back and so on (default 1)");
  Flag turn_round =
      flag("--turn-round",
           "with --way and --contacts: it turns round for its way back, so that the ends of the drum "
           "change sides; else it drives in reverse");
  Text contacts =
      text("--contacts", "COUNT|FILE",
           fmt::format("drum and frame tilt, too, on 1 to {} equal contacts along the width of the drum that "
                       "share k and c, or on those of a table with the columns {}; chain.csv then has tilt "
                       "and both ends",
                       most_contacts, contact_columns));
  Number tilt =
      number("--tilt", {-0.1, 0.1, "rad"},
             "with --contacts: tilt of drum and frame at the start besides that of equilibrium [rad]");
  Count samples_per_cycle =
      count("--samples-per-cycle", 1, ExactOptions::most_samples, "rows of chain.csv per cycle", "200");
  Number impact_speed = number(
      "--impact-speed", ExactOptions::impact_speed_range,
      "if positive: start touching and moving down at this speed [m/s] instead of at equilibrium", "0");
  ResultPath out = result_folder("--out", "folder for the files, made if missing", required);
};

/// A roller that drives.
struct DriveAsked {
  Way way;
  double speed = 0.0; ///< [m/s]
  int passes = 1;
  WayBack back = WayBack::in_reverse;
};

/// A drum with two ends.
struct Ends {
  TwoEnds machine;
  double width = 0.0;           ///< of the drum [m]
  std::optional<fs::path> file; ///< of the contacts; none: they are equal
  std::vector<std::string> assumed;
};

struct ExactTask {
  ChainParameters parameters;
  std::optional<DriveAsked> drive;
  std::optional<Ends> ends;
  std::optional<double> me_re; ///< kg m, from which Fw follows; none: Fw is given
  std::optional<GivenRoller> roller;
  ExactOptions options;
  fs::path out;
};

constexpr std::array<const char *, 4> file_names = {"chain.csv", "events.csv", "cycles.csv",
                                                    "parameters.csv"};

/// The roller that drives, if it does, and its time in the options.
std::optional<DriveAsked> judge_drive(const ExactArguments &arguments, const ChainParameters &parameters,
                                      ExactOptions &options) {
  if (!arguments.way) return std::nullopt;
  DriveAsked drive;
  if (arguments.turn_round) drive.back = WayBack::turned_round;
  try {
    drive.way = read_way(*arguments.way, arguments.contacts.given());
  } catch (const std::invalid_argument &error) {
    throw UsageError(
        fmt::format("{}{}", std::string(error.what()).rfind("way", 0) == 0 ? "--" : "", error.what()));
  }
  for (const char *name : {"k", "D"})
    if (const Number *const given = arguments.chain.given(name))
      throw given->refused("none with --way, which has it of each place");
  if (!arguments.speed) throw UsageError("--speed is missing; allowed: a number [m/s], with --way");
  drive.speed = *arguments.speed;
  drive.passes = arguments.passes.value_or(drive.passes);
  const double length = drive.way.back().s - drive.way.front().s;
  options.cycles = drive.passes * length / drive.speed / parameters.period();
  if (!ExactOptions::cycles_range.holds(options.cycles))
    throw arguments.speed.refused(fmt::format("one with which {} passes over {:g} m take at most {:g} cycles",
                                              drive.passes, length, ExactOptions::cycles_range.most));
  constexpr std::size_t most_sections = 1'000'000;
  if (drive.way.size() * static_cast<std::size_t>(drive.passes) > most_sections)
    throw arguments.passes.refused(fmt::format("passes times rows of --way up to {}", most_sections));
  options.way = post::drive(drive.way, drive.speed, drive.passes, drive.back);
  return drive;
}

/// Refuses options that do not go with --contacts.
void judge_with_contacts(const ExactArguments &arguments, bool file) {
  if (arguments.way && file) throw arguments.contacts.refused("a whole number with --way, which has k and D");
  if (arguments.tilt && *arguments.impact_speed > 0.0)
    throw arguments.tilt.refused("none with --impact-speed");
  for (const char *name : {"k", "D"})
    if (const Number *const given = arguments.chain.given(name); given != nullptr && file)
      throw given->refused("none with a file of --contacts, which has k and c of each");
}

/// The drum with two ends, if it is asked for.
std::optional<Ends> judge_ends(const ExactArguments &arguments, const AskedChain &chain,
                               const ExactOptions &options) {
  if (!arguments.contacts) return std::nullopt;
  const std::string &contacts = *arguments.contacts;
  const std::string allowed = fmt::format("a whole number from 1 to {}, or a file that can be read, with the "
                                          "columns {}",
                                          most_contacts, contact_columns);
  std::optional<double> count;
  try {
    count = number_from_text(contacts);
  } catch (const std::invalid_argument &) { // a file
  }
  judge_with_contacts(arguments, !count);
  const Roller roller = chain.roller ? chain.roller->machine : Roller();
  if (chain.roller && !roller.width)
    throw UsageError(fmt::format("width of '{}' is missing; allowed: the width of the drum, which --contacts "
                                 "needs",
                                 shown(chain.roller->file)));
  Ends ends;
  ends.width = drum_width(roller);
  ends.assumed = assumed_ends(roller);
  ends.machine = two_ends(chain.parameters, roller);
  const ChainParameters &p = chain.parameters;
  if (count) {
    if (!(*count >= 1.0 && *count <= most_contacts && *count == std::floor(*count)))
      throw arguments.contacts.refused(allowed);
    ends.machine.contacts = equal_contacts(static_cast<int>(*count), ends.width, p.k, p.damping());
    if (!options.way.empty()) ends.machine = over(std::move(ends.machine), options.way.front());
  } else {
    ends.file = contacts;
    if (std::error_code ignored; contacts.empty() || !fs::is_regular_file(*ends.file, ignored))
      throw arguments.contacts.refused(allowed);
    try {
      ends.machine.contacts = read_contacts(*ends.file, ends.width);
    } catch (const std::invalid_argument &error) {
      throw UsageError(error.what());
    }
  }
  if (arguments.tilt) ends.machine.tilt = *arguments.tilt;
  if (const std::string fault = ends.machine.invalid(); !fault.empty())
    throw UsageError(fault.rfind("contacts", 0) == 0 ? "--" + fault : fault); // else of the roller's file
  return ends;
}

ExactTask judge(const ExactArguments &arguments) {
  ExactTask task;
  const AskedChain chain = judged_chain(arguments.chain);
  task.parameters = chain.parameters;
  task.me_re = chain.me_re;
  task.roller = chain.roller;
  ExactOptions &options = task.options;
  task.drive = judge_drive(arguments, task.parameters, options);
  if (arguments.cycles) options.cycles = *arguments.cycles;
  options.samples_per_cycle = *arguments.samples_per_cycle;
  options.impact_speed = *arguments.impact_speed;
  std::string fault = options.invalid();
  task.ends = judge_ends(arguments, chain, options);
  if (fault.empty())
    fault = task.ends ? too_much_work(task.ends->machine, options) : too_much_work(task.parameters, options);
  if (!fault.empty()) throw UsageError("--" + fault);
  task.out = *arguments.out;
  std::vector<GivenPath> given = files_of(arguments.chain.roller);
  if (arguments.way) given.push_back({"--way", *arguments.way});
  if (task.ends && task.ends->file) given.push_back({"--contacts", *task.ends->file});
  keep_apart(given, files_in("--out", task.out, {file_names.begin(), file_names.end()}));
  for (const char *name : file_names)
    try {
      check_output_file(task.out / name);
    } catch (const std::runtime_error &error) {
      throw UsageError(fmt::format("--out is '{}': {} {}", task.out.string(), name, error.what()));
    }
  return task;
}

std::vector<std::pair<std::string, std::string>> record(const ExactArguments &arguments,
                                                        const ExactTask &task) {
  const ChainParameters &p = task.parameters;
  std::vector<std::pair<std::string, std::string>> values = parameter_values(p);
  values.insert(values.begin(), {{"deck", "exact"}, {"case", *arguments.chain.chain_case}});
  const bool of_file = task.ends && task.ends->file;
  if (task.drive || of_file) { // k, D and c are those of each place
    const auto of_place = [](const auto &value) { return value.first == "k" || value.first == "D"; };
    values.erase(std::remove_if(values.begin(), values.end(), of_place), values.end());
  }
  if (task.drive) {
    values.insert(values.end(), {{"way", *arguments.way},
                                 {"way_begin", number_text(task.drive->way.front().s)},
                                 {"way_end", number_text(task.drive->way.back().s)},
                                 {"speed", number_text(task.drive->speed)},
                                 {"passes", fmt::format("{}", task.drive->passes)}});
    if (task.ends)
      values.emplace_back("way_back",
                          task.drive->back == WayBack::turned_round ? "turned round" : "in reverse");
  } else if (!of_file) {
    values.emplace_back("c", number_text(p.damping()));
  }
  if (task.ends) {
    const TwoEnds &machine = task.ends->machine;
    values.insert(values.end(), {{"contacts", *arguments.contacts},
                                 {"width", number_text(task.ends->width)},
                                 {"drum_inertia", number_text(machine.drum_inertia)},
                                 {"frame_inertia", number_text(machine.frame_inertia)},
                                 {"exciter_place", number_text(machine.exciter)},
                                 {"sensor_distance", number_text(machine.sensor)},
                                 {"tilt", number_text(machine.tilt)}});
    for (std::size_t i = 0; i < machine.bonds.size(); ++i) {
      const AxleLink &bond = machine.bonds[i];
      values.emplace_back(fmt::format("bond_{}", i + 1),
                          fmt::format("y {} m, k {} N/m, c {} N s/m", number_text(bond.y),
                                      number_text(bond.k), number_text(bond.c)));
    }
    values.emplace_back("ends_assumed", fmt::format("{}", fmt::join(task.ends->assumed, " ")));
  }
  values.insert(values.end(), {{"impact_speed", number_text(task.options.impact_speed)},
                               {"cycles", number_text(task.options.cycles)},
                               {"samples_per_cycle", fmt::format("{}", task.options.samples_per_cycle)}});
  if (task.roller) {
    const auto rows = task.roller->rows(p.g);
    values.insert(values.end(), rows.begin(), rows.end());
  }
  values.insert(values.end(), {{"command", arguments.session().command}, {"ended", "yes"}});
  return values;
}

void run(const ExactArguments &arguments) {
  const ExactTask task = judge(arguments);
  if (task.roller)
    for (const std::string &line : task.roller->lines(task.parameters.g))
      fmt::print("{}\n", line);
  if (task.ends && !task.ends->assumed.empty())
    fmt::print("Assumed, as of Axas2020: {}.\n", fmt::join(task.ends->assumed, ", "));
  TimedProgress progress;
  const SolverProgress tell = [&](double share) {
    progress.tell("solved to cycle {:.1f} of {:g}", share * task.options.cycles, task.options.cycles);
  };
  TwoEndsOrbit orbit;
  const ExactSolution result = [&]() -> ExactSolution {
    if (!task.ends) return solve_chain(task.parameters, task.options, tell);
    TwoEndsResult solved = solve_two_ends(task.ends->machine, task.options, tell);
    orbit = solved.orbit;
    return std::move(solved);
  }();
  try {
    make_output_folder(task.out);
  } catch (const std::runtime_error &error) {
    throw UsageError(fmt::format("--out is '{}': {}", task.out.string(), error.what()));
  }
  const FolderLock lock = lock_output_folder(task.out);
  write_files({{task.out / file_names[0], chain_text(result.history)},
               {task.out / file_names[1], events_text(result.events)},
               {task.out / file_names[2], cycles_text(result.cycles)},
               {task.out / file_names[3], parameters_text(record(arguments, task))}});
  const std::string of_moment =
      task.me_re
          ? fmt::format(", of the eccentric moment {:g} kg m of the roller, whatever the masses", *task.me_re)
          : "";
  fmt::print("{}: {} samples, {} events, {} cycles (case {}, transition {}; {} steps), Fw {:g} N{}\n",
             task.out.string(), result.history.size(), result.events.size(), result.cycles.size(),
             *arguments.chain.chain_case, *arguments.chain.transition, result.pieces, task.parameters.Fw,
             of_moment);
  if (!task.ends) return;
  const std::string of_tilt = orbit.of_tilt < 0.0 ? "" : fmt::format(", of tilting {:.4g}", orbit.of_tilt);
  constexpr double rounding = 1e-6;
  const char *const judgement = orbit.largest < 1.0 - rounding   ? "stable"
                                : orbit.largest > 1.0 + rounding ? "not stable"
                                                                 : "neutral";
  if (orbit.cycles > 0)
    fmt::print("The motion repeats after {} cycle{}; largest multiplier {:.4g}{}: {}.\n", orbit.cycles,
               orbit.cycles == 1 ? "" : "s", orbit.largest, of_tilt, judgement);
  else if (orbit.largest > 0.0)
    fmt::print(
        "The motion does not repeat within 8 cycles; small differences grow {:.4g} times per cycle{}.\n",
        orbit.largest, of_tilt);
}

} // namespace

void add_exact_command(CLI::App &app, Session &session) {
  add_command<ExactArguments>(
      app, session, "exact",
      "Solve the chain soil - drum - frame without an engine, in closed form. Writes chain.csv, events.csv, "
      "cycles.csv and parameters.csv.",
      run);
}

} // namespace drumlin::post
