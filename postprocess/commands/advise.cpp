#include "commands/commands.h"

#include "chain/run_files.h"
#include "commands/chain_options.h"
#include "engine/places.h"
#include "studies/step_advice.h"
#include "engine/deck_run.h"
#include "studies/study.h"
#include "support/options.h"
#include "support/progress.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

struct Arguments {
  ChainArguments chain;
  std::string error = "1e-3";
  std::string stepping = "second";
  std::string measure = "velocity";
  std::string cycles = "30";
  std::optional<std::string> from;
};

/// The largest number that in.chain allows.
constexpr int most_cycles = 10'000'000;

struct Measure {
  const char *name;
  ErrorMeasure measure;
  const char *words;
};
constexpr std::array<Measure, 3> measures = {
    {{"velocity", ErrorMeasure::velocity, "relative RMS error of the drum's velocity"},
     {"force", ErrorMeasure::force, "relative error of the peak contact force"},
     {"acceleration", ErrorMeasure::acceleration, "relative error of the drum's peak acceleration"}}};

const Measure &measure_of(const std::string &name) {
  const auto *const found =
      std::find_if(measures.begin(), measures.end(), [&](const Measure &m) { return name == m.name; });
  if (found == measures.end()) throw UsageError(refusal("--measure", name, "velocity, force, acceleration"));
  return *found;
}

void run(const Arguments &arguments) {
  AdviceRequest request;
  request.parameters = judged(arguments.chain);
  request.stepping = choice_option("--stepping", arguments.stepping, {"second", "stock"});
  request.error = number_option("--error", arguments.error, {1e-15, 1.0, "", false, false, true});
  const Measure &measure = measure_of(arguments.measure);
  request.measure = measure.measure;
  const int cycles = count_option("--cycles", arguments.cycles, 1, most_cycles);
  const fs::path folder =
      arguments.from ? path_option("--from", *arguments.from) : input_file("study/accuracy");
  if (!fs::is_regular_file(folder / "chain.csv"))
    throw UsageError(refusal("--from", folder.string(), "folders of an accuracy study, with chain.csv"));

  if (const double least = slowest_excitation(request.parameters); request.parameters.omega < least)
    throw UsageError(
        refusal("--omega", request.parameters.omega,
                fmt::format("at least {:.3g} rad/s with the other numbers of this chain: {} cycles "
                            "of it are solved several times",
                            least, accuracy_cycles)));
  const std::vector<ChainPoint> points = read_points(folder / "chain.csv", chain_points());
  TimedProgress progress;
  const StepAdvice advice = advise(request, points, [&](const ChainParameters &chain) {
    return sensitivity(chain, [&](double share) {
      progress.tell("{:.0f} % of the solutions that tell how sensitive a chain is", 100.0 * share);
    });
  });
  const double step = request.parameters.period() / advice.steps_per_cycle;
  fmt::print("{} steps per cycle, a step of {:.4g} s, with {} stepping\n", advice.steps_per_cycle, step,
             request.stepping);
  fmt::print("  for        {} of at most {:g} over cycles {} to {}\n", measure.words, request.error,
             accuracy_cycles - accuracy_window + 1, accuracy_cycles);
  const std::string curve =
      fmt::format("case {} {}", advice.from, transition_name(request.parameters.transition));
  if (advice.measured) {
    fmt::print("  from       runs of {} itself: all with as many steps or more kept to it\n", curve);
  } else {
    const std::vector<ScalingPoint> tests = read_points(folder / "scaling.csv", scaling_points());
    fmt::print("  from       the curve of {}, scaled by max(sqrt(k/m2), omega) dt and by the sensitivity "
               "{:.2g} of this "
               "chain, times {:g}\n"
               "  scaling    {}\n",
               curve, advice.sensitivity, scaling_margin, scaling_summary(tests));
    if (const std::string outside = outside_of_tests(request.parameters, tests); !outside.empty())
      fmt::print("  outside    {}: compare with a run of half the step\n", outside);
  }
  fmt::print("  stability  the critical step is {:.4g} s, {:.3g} times as long\n",
             request.parameters.period() / advice.critical_steps,
             advice.steps_per_cycle / advice.critical_steps);
  fmt::print("  time       about {:.2g} s for {} cycles at {:.2g} microseconds a step, as where the curves "
             "were measured, in addition to the start of the engine\n",
             advice.seconds_per_step * cycles * advice.steps_per_cycle, cycles,
             1e6 * advice.seconds_per_step);
  fmt::print("  run        {} run inputs/chain/in.chain{} -var stepping {} -var cycles {} -var "
             "steps_per_cycle {}\n",
             front_command(), deck_words(arguments.chain), request.stepping, cycles, advice.steps_per_cycle);
}

} // namespace

void add_advise_command(CLI::App &app, Session &) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App *command = app.add_subcommand(
      "advise",
      "Steps per cycle that a run of the chain needs for an error, by the measured curves of the accuracy "
      "study; for other chains than the measured ones scaled, with a margin.");
  add_chain_options(*command, arguments->chain);
  command->add_option("--error", arguments->error, "relative error that is allowed")
      ->type_name("NUMBER")
      ->capture_default_str();
  command->add_option("--measure", arguments->measure, "error of: velocity, force or acceleration")
      ->capture_default_str();
  command->add_option("--stepping", arguments->stepping, "second or stock")->capture_default_str();
  command->add_option("--cycles", arguments->cycles, "length of the run, for its time")
      ->type_name("COUNT")
      ->capture_default_str();
  command
      ->add_option_function<std::string>(
          "--from", [arguments](const std::string &text) { arguments->from = text; },
          "folder of an accuracy study of your own, instead of the project's")
      ->type_name("DIR");
  command->callback([arguments] { run(*arguments); });
}

} // namespace drumlin::post
