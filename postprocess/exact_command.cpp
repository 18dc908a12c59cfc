#include "exact_command.h"

#include "chain_csv.h"
#include "chain_model.h"
#include "direct_solver.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <unistd.h>

#include <array>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <system_error>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

// A number of the chain that the command line may set instead of the case.
struct Override {
  const char *option;
  double ChainParameters::*value;
  const char *help;
};
constexpr std::array<Override, 9> overrides = {{
    {"--k", &ChainParameters::k, "contact stiffness [N/m]"},
    {"--D", &ChainParameters::D, "contact damping ratio [-], c = 2 D sqrt(m2 k)"},
    {"--omega", &ChainParameters::omega, "angular frequency of the excitation [rad/s]"},
    {"--Fw", &ChainParameters::Fw, "amplitude of the excitation force [N]"},
    {"--m2", &ChainParameters::m2, "mass of the drum [kg]"},
    {"--m3", &ChainParameters::m3, "mass of the frame [kg]"},
    {"--k23", &ChainParameters::k23, "stiffness of the bond drum - frame [N/m]"},
    {"--c23", &ChainParameters::c23, "damping of the bond drum - frame [N s/m]"},
    {"--g", &ChainParameters::g, "gravity [m/s2]"},
}};

// The options as given. Numbers stay text until all are judged by one rule with one kind of message.
struct Arguments {
  std::string chain_case = "II";
  std::string transition = "B";
  std::array<std::string, overrides.size()> numbers;
  std::string cycles = "30";
  std::string samples_per_cycle = "200";
  std::string rtol = "1e-12";
  std::string impact_speed = "0";
  std::string out;
};

struct Task {
  ChainParameters parameters;
  DirectOptions options;
  fs::path out;
};

double number_option(const char *option, const std::string &text) {
  try {
    return number_from_text(text);
  } catch (const std::invalid_argument &) {
    throw UsageError(fmt::format("{} = '{}': allowed are finite numbers", option, text));
  }
}

int count_option(const char *option, const std::string &text) {
  const double value = number_option(option, text);
  const int count = value >= 1.0 && value <= std::numeric_limits<int>::max() ? static_cast<int>(value) : 0;
  if (static_cast<double>(count) != value)
    throw UsageError(fmt::format("{} = '{}': allowed are whole numbers from 1", option, text));
  return count;
}

// Refuses a folder that files cannot be written to, before the work is done. Nothing is made yet.
void check_folder(const fs::path &out) {
  fs::path existing = fs::absolute(out);
  std::error_code code;
  while (!fs::exists(existing, code) && existing.has_relative_path())
    existing = existing.parent_path();
  const auto refuse = [&out](const fs::path &where, const char *why) {
    throw UsageError(fmt::format("--out = '{}': {} {}; allowed are folders that can be made and written to",
                                 out.string(), where.string(), why));
  };
  if (!fs::is_directory(existing, code)) refuse(existing, "is not a folder");
  if (::access(existing.c_str(), W_OK | X_OK) != 0) refuse(existing, "cannot be written to");
}

Task judge(const Arguments &arguments) {
  Task task;
  try {
    task.parameters = table1_case(arguments.chain_case, transition_from_name(arguments.transition));
  } catch (const std::invalid_argument &error) {
    throw UsageError(fmt::format("--{}", error.what()));
  }
  for (std::size_t i = 0; i < overrides.size(); ++i)
    if (!arguments.numbers[i].empty())
      task.parameters.*overrides[i].value = number_option(overrides[i].option, arguments.numbers[i]);
  task.options.cycles = number_option("--cycles", arguments.cycles);
  task.options.samples_per_cycle = count_option("--samples-per-cycle", arguments.samples_per_cycle);
  task.options.rtol = number_option("--rtol", arguments.rtol);
  task.options.impact_speed = number_option("--impact-speed", arguments.impact_speed);
  for (const std::string &fault : {task.parameters.invalid(), task.options.invalid()})
    if (!fault.empty()) throw UsageError("--" + fault);
  if (arguments.out.empty())
    throw UsageError("--out = '': allowed are folders that can be made and written to");
  task.out = arguments.out;
  check_folder(task.out);
  return task;
}

std::vector<std::pair<std::string, std::string>> record(const Arguments &arguments, const Task &task,
                                                        const DirectCost &cost, const std::string &command) {
  const ChainParameters &p = task.parameters;
  return {{"case", arguments.chain_case},
          {"transition", transition_name(p.transition)},
          {"k", number_text(p.k)},
          {"D", number_text(p.D)},
          {"c", number_text(p.damping())},
          {"omega", number_text(p.omega)},
          {"Fw", number_text(p.Fw)},
          {"m2", number_text(p.m2)},
          {"m3", number_text(p.m3)},
          {"k23", number_text(p.k23)},
          {"c23", number_text(p.c23)},
          {"g", number_text(p.g)},
          {"impact_speed", number_text(task.options.impact_speed)},
          {"cycles", number_text(task.options.cycles)},
          {"samples_per_cycle", fmt::format("{}", task.options.samples_per_cycle)},
          {"solver", fmt::format("{} {}", direct_solver_name(), cost.bdf ? "Adams and BDF" : "Adams")},
          {"rtol", number_text(task.options.rtol)},
          {"command", command}};
}

void run(const Arguments &arguments, const std::string &command) {
  const Task task = judge(arguments);
  const DirectResult result = solve_direct(task.parameters, task.options);
  std::error_code code;
  fs::create_directories(task.out, code);
  if (code)
    throw UsageError(
        fmt::format("--out = '{}': cannot be made: {}; allowed are folders that can be made and written to",
                    task.out.string(), code.message()));
  try {
    write_files(
        {{task.out / "chain.csv", chain_text(result.history)},
         {task.out / "events.csv", events_text(result.events)},
         {task.out / "cycles.csv", cycles_text(result.cycles)},
         {task.out / "parameters.csv", parameters_text(record(arguments, task, result.cost, command))}});
  } catch (const std::runtime_error &error) {
    throw UsageError(fmt::format("--out = '{}': {}; allowed are folders that can be made and written to",
                                 task.out.string(), error.what()));
  }
  fmt::print("{}: {} samples, {} events, {} cycles (case {}, transition {}; {} steps)\n", task.out.string(),
             result.history.size(), result.events.size(), result.cycles.size(), arguments.chain_case,
             arguments.transition, result.cost.steps);
}

} // namespace

void add_exact_command(CLI::App &app, Session &session) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App *exact = app.add_subcommand(
      "exact",
      "Solve the chain soil - drum - frame directly, without an engine: the truth beside engine runs. Writes "
      "chain.csv, events.csv, cycles.csv and parameters.csv.");
  exact->add_option("--case", arguments->chain_case, "case of the paper's Table 1: I, II, III or IV")
      ->capture_default_str();
  exact->add_option("--transition", arguments->transition, "transition condition of the contact: A or B")
      ->capture_default_str();
  for (std::size_t i = 0; i < overrides.size(); ++i)
    exact->add_option(overrides[i].option, arguments->numbers[i], overrides[i].help)
        ->type_name("NUMBER")
        ->group("Instead of the case's values");
  exact->add_option("--cycles", arguments->cycles, "cycles of the excitation")
      ->type_name("NUMBER")
      ->capture_default_str();
  exact->add_option("--samples-per-cycle", arguments->samples_per_cycle, "rows of chain.csv per cycle")
      ->type_name("COUNT")
      ->capture_default_str();
  exact->add_option("--rtol", arguments->rtol, "relative tolerance of the integrator, 1e-14 to 1e-3")
      ->type_name("NUMBER")
      ->capture_default_str();
  exact
      ->add_option(
          "--impact-speed", arguments->impact_speed,
          "if positive: start touching and moving down at this speed [m/s] instead of at equilibrium")
      ->type_name("NUMBER")
      ->capture_default_str();
  exact->add_option("--out", arguments->out, "folder for the files, made if missing")
      ->type_name("DIR")
      ->required();
  exact->callback([arguments, &session] { run(*arguments, session.command); });
}

} // namespace drumlin::post
