#include "commands/commands.h"

#include "chain/closed_form.h"
#include "chain/direct_solver.h"
#include "chain/parameters.h"
#include "commands/chain_options.h"
#include "commands/text_options.h"
#include "runs/chain_files.h"
#include "support/files.h"
#include "support/options.h"
#include "support/progress.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

// The options as given. Numbers stay text until they are checked.
struct Arguments {
  ChainArguments chain;
  std::string cycles = "30";
  std::string samples_per_cycle = "200";
  std::optional<std::string> rtol;
  std::string impact_speed = "0";
  std::string out;
};

struct Task {
  ChainParameters parameters;
  std::optional<double> me_re; ///< kg m, from which Fw follows; none: Fw is given
  std::optional<GivenRoller> roller;
  DirectOptions options;
  bool closed_form = true;
  fs::path out;
};

constexpr std::array<const char *, 4> file_names = {"chain.csv", "events.csv", "cycles.csv",
                                                    "parameters.csv"};

Task judge(const Arguments &arguments) {
  Task task;
  const AskedChain chain = judged_chain(arguments.chain);
  task.parameters = chain.parameters;
  task.me_re = chain.me_re;
  task.roller = chain.roller;
  DirectOptions &options = task.options;
  options.cycles = number_option("--cycles", arguments.cycles, DirectOptions::cycles_range);
  options.samples_per_cycle =
      count_option("--samples-per-cycle", arguments.samples_per_cycle, 1, DirectOptions::most_samples);
  if (arguments.rtol) options.rtol = number_option("--rtol", *arguments.rtol, DirectOptions::rtol_range);
  options.impact_speed =
      number_option("--impact-speed", arguments.impact_speed, DirectOptions::impact_speed_range);
  std::string fault = options.invalid();
  if (fault.empty()) fault = too_much_work(task.parameters, options);
  if (!fault.empty()) throw UsageError("--" + fault);
  task.closed_form = !arguments.rtol && closed_form_suffices(task.parameters, options.cycles);
  task.out = output_folder_option("--out", arguments.out);
  keep_apart(files_of(arguments.chain.roller),
             files_in("--out", task.out, {file_names.begin(), file_names.end()}));
  for (const char *name : file_names)
    try {
      check_output_file(task.out / name);
    } catch (const std::runtime_error &error) {
      throw UsageError(fmt::format("--out is '{}': {} {}", task.out.string(), name, error.what()));
    }
  return task;
}

std::vector<std::pair<std::string, std::string>> record(const Arguments &arguments, const Task &task,
                                                        const DirectCost &cost, const std::string &command) {
  const ChainParameters &p = task.parameters;
  std::vector<std::pair<std::string, std::string>> values = parameter_values(p);
  values.insert(values.begin(), {"case", arguments.chain.chain_case});
  const std::string solver =
      task.closed_form ? "closed form"
                       : fmt::format("{} {}", direct_solver_name(), cost.bdf ? "Adams and BDF" : "Adams");
  values.insert(values.end(), {{"c", number_text(p.damping())},
                               {"impact_speed", number_text(task.options.impact_speed)},
                               {"cycles", number_text(task.options.cycles)},
                               {"samples_per_cycle", fmt::format("{}", task.options.samples_per_cycle)},
                               {"solver", solver},
                               {"rtol", number_text(task.closed_form ? 0.0 : task.options.rtol)}});
  if (task.roller) {
    const auto rows = task.roller->rows(p.g);
    values.insert(values.end(), rows.begin(), rows.end());
  }
  values.insert(values.end(), {{"command", command}, {"ended", "yes"}});
  return values;
}

void run(const Arguments &arguments, const std::string &command) {
  const Task task = judge(arguments);
  if (task.roller)
    for (const std::string &line : task.roller->lines(task.parameters.g))
      fmt::print("{}\n", line);
  TimedProgress progress;
  const SolverProgress tell = [&](double share) {
    progress.tell("solved to cycle {:.1f} of {:g}", share * task.options.cycles, task.options.cycles);
  };
  const DirectResult result = task.closed_form ? solve_closed_form(task.parameters, task.options, tell)
                                               : solve_direct(task.parameters, task.options, tell);
  try {
    make_output_folder(task.out);
  } catch (const std::runtime_error &error) {
    throw UsageError(fmt::format("--out is '{}': {}", task.out.string(), error.what()));
  }
  const FolderLock lock = lock_output_folder(task.out);
  write_files({{task.out / file_names[0], chain_text(result.history)},
               {task.out / file_names[1], events_text(result.events)},
               {task.out / file_names[2], cycles_text(result.cycles)},
               {task.out / file_names[3], parameters_text(record(arguments, task, result.cost, command))}});
  const std::string of_moment =
      task.me_re
          ? fmt::format(", of the eccentric moment {:g} kg m of the roller, whatever the masses", *task.me_re)
          : "";
  fmt::print("{}: {} samples, {} events, {} cycles (case {}, transition {}; {} steps), Fw {:g} N{}\n",
             task.out.string(), result.history.size(), result.events.size(), result.cycles.size(),
             arguments.chain.chain_case, arguments.chain.transition, result.cost.steps, task.parameters.Fw,
             of_moment);
}

} // namespace

void add_exact_command(CLI::App &app, Session &session) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App *exact = app.add_subcommand(
      "exact",
      "Solve the chain soil - drum - frame without an engine, in closed form; by the integrator CVODE "
      "with --rtol, and where contact and bond decay so fast that the closed form would take long. "
      "Writes chain.csv, events.csv, cycles.csv and parameters.csv.");
  add_chain_options(*exact, arguments->chain);
  text_option(exact, "--cycles", "NUMBER", arguments->cycles, "cycles of the excitation");
  text_option(exact, "--samples-per-cycle", "COUNT", arguments->samples_per_cycle,
              "rows of chain.csv per cycle");
  text_option(exact, "--rtol", "NUMBER", arguments->rtol,
              "solve by the integrator, with this relative tolerance, 1e-14 to 1e-3");
  text_option(exact, "--impact-speed", "NUMBER", arguments->impact_speed,
              "if positive: start touching and moving down at this speed [m/s] instead of at equilibrium");
  exact->add_option("--out", arguments->out, "folder for the files, made if missing")
      ->type_name("DIR")
      ->required();
  exact->callback([arguments, &session] { run(*arguments, session.command); });
}

} // namespace drumlin::post
