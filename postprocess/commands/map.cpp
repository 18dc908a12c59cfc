#include "commands/commands.h"

#include "commands/chain_options.h"
#include "map/map_results.h"
#include "runs/chain_files.h"
#include "runs/parameter_file.h"
#include "support/csv.h"
#include "support/files.h"
#include "support/options.h"
#include "support/resumed.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace {

constexpr int most_values = 2000;     ///< per axis
constexpr int least_map_cycles = 100; ///< fewer do not let a motion settle

struct MapArguments : Options {
  explicit MapArguments(Command &of) : Options(of) {
    constexpr const char *of_map = "without --x and --y, which are those of a map";
    not_with(x, {&sweep}, of_map);
    not_with(y, {&sweep}, of_map);
    not_with(sweep, {&threads}, "without --sweep, which is one computation");
  }
  ChainArguments chain{command()};
  Text x = text("--x", "AXIS",
                "axis NAME:FROM:TO:COUNT or NAME:FROM:TO:COUNT:log, NAME one of k, D, omega, "
                "frequency, Fw, me_re, m2, m3, k23, c23; without axes k:1e6:200e6:60:log over D:0.02:1:50");
  Text y = text("--y", "AXIS", "the other axis; not given: what the meter shows along --x");
  Count identify =
      count("--identify", 0, 1'000'000,
            "with --x alone: identify a record at every so many-th point; 10 if not given, 0: at none");
  DrumArguments drum{command()};
  Text sweep = text("--sweep", "AXIS",
                    "instead of a map: follow the motion along one axis up and down, once-per-cycle samples");
  Number me_re = number("--me-re", {1e-9, 1e12, "kg m"},
                        "eccentric moment m_e r_e [kg m]: Fw = m_e r_e omega^2 instead of a fixed Fw");
  Count contacts = count(
      "--contacts", 2, most_contacts,
      fmt::format("a drum with two ends on 2 to {} contacts along its width, which share k and D (eight or "
                  "more where an end leaves the soil): whether its ends lift off together or by turns; then "
                  "a NAME of an axis may be ratio, of k and c below the left half to those below the right "
                  "one; without axes k:5e6:100e6:39 over ratio:1:4:25:log",
                  most_contacts));
  Count cycles = count("--cycles", least_map_cycles, 100'000,
                       "cycles of the excitation at each point, 100 or more", "300");
  Count threads = count("--threads", 1, 256, "points at the same time", "2");
  ResultPath out = result_folder("--out", "folder of the results", "results/map");
  Flag fresh = flag("--fresh", "forget the points of an earlier call");
};

struct AskedMap : MapTask {
  std::optional<GivenRoller> given_roller;
  bool along = false; ///< along x alone: what the meter shows
};

MapAxis axis_option(const Text &option, const std::string &text) {
  try {
    return axis_from_text(option.name(), text, most_values);
  } catch (const std::invalid_argument &error) {
    throw UsageError(error.what());
  }
}

// Refuses chains that cannot be computed, or that move so much faster than they are excited that a cycle
// takes seconds.
void judge_corner(const ChainArguments &arguments, const ChainParameters &parameters) {
  if (const std::string fault = parameters.invalid(); !fault.empty()) throw UsageError("--" + fault);
  constexpr double most_pieces = 1e4;
  for (const bool touching : {true, false}) {
    const PhaseDynamics dynamics(parameters, touching ? parameters.k : 0.0,
                                 touching ? parameters.damping() : 0.0);
    // Judged by the pieces after the fast decay, since they make up nearly all of the motion.
    if (parameters.period() / dynamics.longest_piece(1e300) > most_pieces)
      throw UsageError(frequency_refusal(
          arguments, parameters.omega,
          fmt::format("a frequency not so far below those of the chain itself: a cycle of k = {:g} N/m, m2 = "
                      "{:g} kg, c23 = {:g} N s/m would take more than {:g} pieces",
                      parameters.k, parameters.m2, parameters.c23, most_pieces)));
  }
}

/// The drum with two ends. Refuses one that cannot be solved at the corners of the axes.
EndsFamily judge_contacts(int contacts, const AskedMap &task) {
  EndsFamily family;
  family.chain = task.grid.chain;
  family.contacts = contacts;
  if (task.given_roller) {
    family.roller = task.given_roller->machine;
    if (!family.roller.width)
      throw UsageError(fmt::format("width of '{}' is missing; allowed: the width of the drum, which "
                                   "--contacts needs",
                                   task.given_roller->file));
  }
  const auto judge_corner = [&](const std::vector<std::pair<std::string, double>> &values) {
    const TwoEnds machine = family.at(values);
    if (const std::string fault = machine.invalid(); !fault.empty())
      throw UsageError(fault.rfind("contacts", 0) == 0 ? "--" + fault : fault);
    ExactOptions options;
    options.cycles = longest_transient * task.grid.cycles;
    if (const std::string fault = too_much_work(machine, options); !fault.empty())
      throw UsageError("--" + fault);
  };
  const MapGrid &grid = task.grid;
  if (task.sweep)
    for (const double value : {task.sweep->from, task.sweep->to})
      judge_corner({{task.sweep->name, value}});
  else
    for (const double x : {grid.x.from, grid.x.to})
      for (const double y : {grid.y.from, grid.y.to})
        judge_corner({{grid.x.name, x}, {grid.y.name, y}});
  return family;
}

AskedMap judge(const MapArguments &arguments) {
  AskedMap task;
  MapGrid &grid = task.grid;
  const AskedChain chain = judged_chain(arguments.chain);
  task.given_roller = chain.roller;
  grid.chain.base = chain.parameters;
  grid.chain.me_re = arguments.me_re.value();
  if (task.given_roller && grid.chain.me_re) task.given_roller->setting.me_re = *grid.chain.me_re;
  std::vector<std::pair<MapAxis, const Text *>> axes;
  if (arguments.sweep) {
    task.sweep = axis_option(arguments.sweep, *arguments.sweep);
    axes = {{*task.sweep, &arguments.sweep}};
  } else {
    const char *const usual = arguments.contacts ? "k:5e6:100e6:39" : "k:1e6:200e6:60:log";
    grid.x = axis_option(arguments.x, arguments.x.value_or(usual));
    axes = {{grid.x, &arguments.x}};
    task.along = arguments.x && !arguments.y && !arguments.contacts;
  }
  if (!task.sweep && !task.along) {
    const char *const usual = arguments.contacts ? "ratio:1:4:25:log" : "D:0.02:1:50";
    const std::string y = arguments.y.value_or(usual);
    grid.y = axis_option(arguments.y, y);
    if (grid.x.parameter() == grid.y.parameter())
      throw UsageError(refusal("--y", y, "another NAME than that of --x"));
    axes.emplace_back(grid.y, &arguments.y);
  }
  const auto is_axis = [&axes](const char *name) {
    return std::any_of(axes.begin(), axes.end(), [&](const auto &axis) { return axis.first.name == name; });
  };
  const bool moment = arguments.me_re || is_axis("me_re");
  if (const Number *const Fw = arguments.chain.given("Fw"); moment && Fw != nullptr)
    throw Fw->refused("not together with me_re, from which Fw follows");
  for (const auto &[axis, option] : axes) {
    if (const Number *const given = arguments.chain.given(axis.parameter()))
      throw given->refused(fmt::format("not together with the axis {} of {}", axis.name, option->name()));
    if (axis.name == ratio_name && !arguments.contacts)
      throw UsageError(
          refusal(option->name(), axis.name, "that of the halves of a drum only with --contacts"));
    if (axis.name == "Fw" && moment)
      throw UsageError(refusal(option->name(), "Fw", "not together with me_re, from which Fw follows"));
    if (axis.name == "me_re" && arguments.me_re)
      throw arguments.me_re.refused("not together with an axis me_re");
  }
  if (!moment && !is_axis("Fw")) grid.chain.me_re = chain.me_re;
  grid.cycles = *arguments.cycles;
  task.threads = *arguments.threads;
  if (task.sweep)
    for (const double value : {task.sweep->from, task.sweep->to})
      judge_corner(arguments.chain, grid.chain.with({{task.sweep->name, value}}));
  else
    for (const double x : {grid.x.from, grid.x.to})
      for (const double y : {grid.y.from, grid.y.to})
        judge_corner(arguments.chain, grid.at(x, y));
  if (arguments.contacts) task.ends = judge_contacts(*arguments.contacts, task);
  task.identify = arguments.identify.value_or(task.identify);
  if (!task.along)
    for (const Option *option : std::initializer_list<const Option *>{
             &arguments.identify, &arguments.drum.radius, &arguments.drum.width, &arguments.drum.poisson})
      if (option->given()) throw option->refused("only with --x and without --y");
  task.drum = judged(arguments.drum, task.given_roller);
  task.out = *arguments.out;
  if (task.given_roller) {
    const auto rows = task.given_roller->rows(grid.chain.base.g);
    task.roller = roller_words({rows.begin(), rows.end()});
  }
  keep_apart(files_of(arguments.chain.roller), {{"--out", task.out, true}});
  return task;
}

std::string settings(const AskedMap &task) {
  const MapGrid &grid = task.grid;
  const auto words = [](const MapAxis &axis) {
    return fmt::format("{}:{}:{}:{}{}", axis.name, number_text(axis.from), number_text(axis.to), axis.count,
                       axis.log ? ":log" : "");
  };
  std::vector<std::pair<std::string, std::string>> values = parameter_values(grid.chain.base);
  const auto is_axis = [&task, &grid](const char *name) {
    return task.sweep ? task.sweep->parameter() == name
                      : grid.x.parameter() == name || grid.y.parameter() == name;
  };
  const bool varies = is_axis("Fw") || is_axis("me_re") || (grid.chain.me_re && is_axis("omega"));
  for (auto &[name, value] : values)
    if (name == "Fw") value = varies ? "" : number_text(grid.chain.with({}).Fw);
  values.emplace_back("me_re", grid.chain.me_re ? number_text(*grid.chain.me_re) : "");
  if (task.sweep) {
    values.emplace_back("sweep", words(*task.sweep));
  } else {
    values.emplace_back("x", words(grid.x));
    if (!task.along) values.emplace_back("y", words(grid.y));
  }
  if (task.along) {
    const auto of_drum = [&task](double LineContact::*part) {
      return task.drum ? number_text((*task.drum).*part) : std::string();
    };
    values.emplace_back("identify", fmt::format("{}", task.identify));
    values.emplace_back("drum_radius", of_drum(&LineContact::radius));
    values.emplace_back("drum_width", of_drum(&LineContact::length));
    values.emplace_back("poisson", of_drum(&LineContact::poisson));
  }
  if (task.ends) {
    values.emplace_back("contacts", fmt::format("{}", task.ends->contacts));
    values.emplace_back("ends_assumed", fmt::format("{}", fmt::join(assumed_ends(task.ends->roller), " ")));
  }
  values.emplace_back("cycles", fmt::format("{}", grid.cycles));
  if (task.given_roller) {
    const auto rows = task.given_roller->rows(grid.chain.base.g);
    values.insert(values.end(), rows.begin(), rows.end());
  }
  return parameters_text(values);
}

void run(const MapArguments &arguments) {
  const AskedMap task = judge(arguments);
  const std::string record = settings(task);
  const ResumedFolder folder(task.out, "map", record, arguments.fresh.given());
  write_files({{task.out / map_record_name, record}});
  if (task.given_roller)
    for (const std::string &line : task.given_roller->lines(task.grid.chain.base.g))
      fmt::print("{}\n", line);
  if (task.ends && !assumed_ends(task.ends->roller).empty())
    fmt::print("Assumed, as of Axas2020: {}.\n", fmt::join(assumed_ends(task.ends->roller), ", "));
  if (task.ends)
    task.sweep ? write_ends_sweep(task) : write_ends_map(task);
  else if (task.sweep)
    write_sweep(task);
  else
    task.along ? write_course(task) : write_regime_map(task);
}

} // namespace

void add_map_command(CLI::App &app, Session &session) {
  add_command<MapArguments>(
      app, session, "map",
      "Which motion a roller comes to, over two numbers of the chain "
      "or along one: continuous contact, partial uplift, period 2 (double jump), higher period, "
      "aperiodic; CMV, RMV, peak force and share of contact. With --x alone all that its meter "
      "shows, where a value means several stiffnesses, and what identify finds. "
      "Writes CSV files and plots. An interrupted map continues where it was interrupted.",
      run);
}

} // namespace drumlin::post
