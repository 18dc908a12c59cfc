#include "commands/commands.h"

#include "advice/bed.h"
#include "advice/steps.h"
#include "commands/chain_options.h"
#include "engine/deck_run.h"
#include "engine/places.h"
#include "experiment/study.h"
#include "runs/chain_files.h"
#include "support/csv.h"
#include "support/options.h"
#include "support/units.h"
#include "support/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// The largest number of cycles that in.chain allows.
constexpr int most_advised_cycles = 10'000'000;

struct AdviseArguments : Options {
  explicit AdviseArguments(Command &of) : Options(of) {
    only_with(bed, {&question, &within}, "with --bed");
    for (const Option *option : all_of_command())
      if (option != &from && option != &question && option != &within) not_with(bed, {option});
  }
  ChainArguments chain{command()};
  Number error =
      number("--error", {1e-15, 1.0, "", false, false, true}, "relative error that is allowed", "1e-3");
  Text measure = text("--measure", "TEXT", "error of: velocity, force or acceleration", "velocity");
  Text stepping = text("--stepping", "TEXT", "second or stock", "second");
  Count cycles = count("--cycles", 1, most_advised_cycles, "length of the run, for its time", "30");
  Text from =
      text("--from", "DIR",
           "folder of an accuracy study of your own (with --bed: of any study of beds), instead of the "
           "project's");
  Flag bed = flag(
      "--bed",
      "advise on a bed instead: the cheapest scene that a study of beds has measured (see `drumlin study "
      "fidelity`)");
  Text question = text("--question", "TEXT",
                       "with --bed: force, acceleration, settlement, stiffness or density, the gain of solid "
                       "fraction of "
                       "a lift under a roller that drives (study drive)");
  Text within =
      text("--within", "TEXT",
           "with --bed: error that is allowed, 10% if not given; of settlement also in mm per cycle, as 2mm");
};

struct Measure {
  const char *name;
  ErrorMeasure measure;
  const char *words;
};
constexpr std::array<Measure, 3> known_measures = {
    {{"velocity", ErrorMeasure::velocity, "relative RMS error of the drum's velocity"},
     {"force", ErrorMeasure::force, "relative error of the peak contact force"},
     {"acceleration", ErrorMeasure::acceleration, "relative error of the drum's peak acceleration"}}};

const Measure &measure_of(const Text &name) {
  const auto *const found = std::find_if(known_measures.begin(), known_measures.end(),
                                         [&](const Measure &m) { return name.text() == m.name; });
  if (found == known_measures.end()) throw name.refused("velocity, force, acceleration");
  return *found;
}

/// Sets the error of the request that --within allows: 0.1, 10% or, of settlement, 2mm.
void judge_within(const std::string &text, BedQuestion &request) {
  const bool settlement = request.name == "settlement";
  const auto ends_with = [&](const std::string &unit) {
    return text.size() > unit.size() && text.compare(text.size() - unit.size(), unit.size(), unit) == 0;
  };
  request.absolute = settlement && ends_with("mm");
  const std::string unit = request.absolute ? "mm" : ends_with("%") ? "%" : "";
  const double scale = request.absolute ? 1e-3 : ends_with("%") ? 0.01 : 1.0;
  const std::optional<double> value = any_number_from_text(text.substr(0, text.size() - unit.size()));
  request.within = value ? scale * *value : 0.0;
  if (!(request.within > 0.0 && request.within <= 10.0))
    throw UsageError(refusal("--within", text,
                             fmt::format("a share above 0, as 10% or 0.1, up to 1000%{}",
                                         settlement ? ", or a settlement per cycle, as 2mm" : "")));
}

/// What answers a question, and the study of beds that has measured it.
struct Question {
  const char *name, *quantity, *study;
};
constexpr std::array<Question, 5> questions = {{{"force", "force", "study/fidelity"},
                                                {"acceleration", "acceleration", "study/fidelity"},
                                                {"settlement", "settlement", "study/fidelity"},
                                                {"stiffness", "k", "study/fidelity"},
                                                {"density", "lift_gain", "study/drive"}}};

const Question &question_of(const Text &name) {
  const auto *const found = std::find_if(questions.begin(), questions.end(),
                                         [&](const Question &one) { return name.text() == one.name; });
  if (found == questions.end()) throw name.refused("force, acceleration, settlement, stiffness, density");
  return *found;
}

/// The quantity of an answered question: the study has it.
const Quantity &quantity_of(const BedExperiment &experiment, const BedQuestion &request) {
  const std::vector<Quantity> &all = experiment.plan.quantities;
  return *std::find_if(all.begin(), all.end(),
                       [&](const Quantity &one) { return one.name == request.quantity; });
}

/// How many beds of each scene give its own mean within the request, and the time that they take.
void tell_scatter(const BedExperiment &experiment, const BedQuestion &request) {
  const Quantity &quantity = quantity_of(experiment, request);
  fmt::print(
      "  beds       that give the mean of a scene within {:g} {}, in brackets if its scatter is at the "
      "ends of its own 95 % interval, and their processor time; mean and scatter of the seeds "
      "measured:\n",
      request.absolute ? 1e3 * request.within : 100.0 * request.within, request.absolute ? "mm" : "%");
  const auto seconds = [](double time) {
    constexpr double whole = 10.0; // from here on without decimals
    return time < whole ? fmt::format("{:.2g} s", time) : fmt::format("{:.0f} s", time);
  };
  const auto shown_beds = [](int beds) {
    return beds > 0 ? std::to_string(beds) : std::string("more than a million");
  };
  for (const SceneScatter &one : scatter_of_scenes(experiment, request)) {
    const std::string beds =
        one.beds > 0 ? fmt::format("{} ({} to {}) x {} = {}", one.beds, shown_beds(one.least_beds),
                                   shown_beds(one.most_beds), seconds(one.cpu_s), seconds(one.total_s()))
                     : std::string("not known: the mean may be zero");
    const double scatter = quantity.scale * one.scatter.estimate;
    const int decimals = // two digits of the scatter
        scatter > 0.0 ? std::max(0, 1 - static_cast<int>(std::floor(std::log10(scatter)))) : 0;
    fmt::print("             {}: {}; {:.{}f} +- {:.{}f} {}, one bed +- {:.{}f} ({} seeds)\n", one.scene->name,
               beds, quantity.scale * one.mean.mean, decimals, quantity.scale * one.mean.half_width, decimals,
               quantity.shown_unit, scatter, decimals, one.seeds);
  }
}

void advise_on_bed(const AdviseArguments &arguments) {
  BedQuestion request;
  const Question &question = question_of(arguments.question);
  request.name = question.name;
  request.quantity = question.quantity;
  judge_within(arguments.within.value_or("10%"), request);
  const BedExperiment experiment = read_bed_experiment(arguments.from ? path_option("--from", *arguments.from)
                                                                      : input_file(question.study));
  const BedAdvice advice = advise_bed(experiment, request);
  const double scale = request.absolute ? 1e3 : 100.0;
  const int decimals = request.absolute ? 1 : 0;
  const double last_digit = std::pow(10.0, -decimals);
  const std::string unit = request.absolute ? "mm" : "%";
  const bool complete = advice.scene == &experiment.plan.scenes.front();
  fmt::print("{}: {}\n", advice.scene->name,
             complete ? "all its parts are needed: no cheaper scene is known to be within the error"
                      : advice.differs);
  fmt::print("  for        {} within {:g} {}\n", quantity_of(experiment, request).label,
             scale * request.within, unit);
  if (!complete)
    fmt::print("  error      {:+.1f} +- {:.1f} {} against the complete scene, 95 % confidence interval over "
               "{} seeds\n",
               scale * advice.error.mean, scale * advice.error.half_width, unit, advice.seeds);
  else if (!advice.closest.empty())
    fmt::print("  closest    of the cheaper scenes, '{}' keeps to {:.{}f} {}\n", advice.closest,
               std::ceil(scale * advice.least_error / last_digit) * last_digit, decimals, unit);
  fmt::print("  scatter    one bed differs from another by {:.{}f} {} (standard deviation): the mean of {} "
             "beds is within {:g} {}\n",
             scale * advice.scatter, decimals, unit, advice.beds, scale * request.within, unit);
  const std::string cycles = value_of(*advice.scene, "cycles"); // a roller that drives has passes
  fmt::print("  time       {:.0f} s of processor time{} where it was measured, {:.2g} times that of the "
             "complete scene; settling and placing come in addition\n",
             advice.cpu_s, cycles.empty() ? "" : fmt::format(" for {} cycles", cycles), advice.cost);
  tell_scatter(experiment, request);
  fmt::print("  scene      {}\n", scene_words(*advice.scene));
  for (const std::string &words : scene_commands(*advice.scene))
    fmt::print("  run        {} {}\n", front_command(), words);
}

void advise_on_chain(const AdviseArguments &arguments) {
  AdviceRequest request;
  const AskedChain asked = judged_chain(arguments.chain);
  request.parameters = asked.parameters;
  request.stepping = choice_option("--stepping", *arguments.stepping, {"second", "stock"});
  request.error = *arguments.error;
  const Measure &measure = measure_of(arguments.measure);
  request.measure = measure.measure;
  const int cycles = *arguments.cycles;
  const fs::path folder =
      arguments.from ? path_option("--from", *arguments.from) : input_file("study/accuracy");
  if (!fs::is_regular_file(folder / "chain.csv"))
    throw UsageError(refusal("--from", folder.string(), "folders of an accuracy study, with chain.csv"));

  if (const double least = slowest_excitation(request.parameters); request.parameters.omega < least)
    throw UsageError(frequency_refusal(
        arguments.chain, request.parameters.omega,
        fmt::format("at least {:.3g} rad/s, {:.3g} Hz, with the other numbers of this chain: {} cycles "
                    "of it are solved several times",
                    least, least / (2.0 * pi), accuracy_cycles)));
  const std::vector<ChainPoint> points = read_points(folder / "chain.csv", chain_points());
  TimedProgress progress;
  const StepAdvice advice = advise(request, points, [&](const ChainParameters &chain) {
    return sensitivity(chain, [&](double share) {
      progress.tell("{:.0f} % of the solutions that tell how sensitive a chain is", 100.0 * share);
    });
  });
  if (asked.roller)
    for (const std::string &line : asked.roller->lines(request.parameters.g))
      fmt::print("{}\n", line);
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
               "{:.2g} of this chain, times {:g}\n"
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

void run(const AdviseArguments &arguments) {
  if (arguments.bed)
    advise_on_bed(arguments);
  else
    advise_on_chain(arguments);
}

} // namespace

void add_advise_command(CLI::App &app, Session &session) {
  add_command<AdviseArguments>(
      app, session, "advise",
      "Steps per cycle that a run of the chain needs for an error, by the measured curves of the accuracy "
      "study; for other chains than the measured ones scaled, with a margin. With --bed the cheapest scene "
      "of a bed, and how many beds of each scene give its mean.",
      run,
      "Examples:\n"
      "  drumlin advise --error 1e-3 --case II\n"
      "  drumlin advise --bed --question force --within 20%\n"
      "  drumlin advise --bed --question settlement --within 2mm\n"
      "  drumlin advise --bed --from inputs/study/scatter --question stiffness --within 10%\n");
}

} // namespace drumlin::post
