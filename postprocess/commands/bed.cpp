#include "commands/bed.h"

#include "commands/commands.h"
#include "support/files.h"
#include "support/options.h"
#include "support/progress.h"
#include "support/usage_error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <stdexcept>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

struct Number {
  const char *option;
  double PackingOptions::*value;
  Range range;
  const char *help;
};
constexpr Range side = {PackingOptions::length_range.least, PackingOptions::length_range.most, "m"};
constexpr Range side_or_zero = {side.least, side.most, "m", true};
constexpr std::array<Number, 5> number_options = {{
    {"--width", &PackingOptions::width, side, "width of the box [m], wall to wall"},
    {"--depth", &PackingOptions::depth, side_or_zero,
     "depth of the box [m]; 0: two dimensions, the balls are discs"},
    {"--height", &PackingOptions::height, side_or_zero, "filled height [m]; 0: as needed"},
    {"--radius-min", &PackingOptions::radius_min, PackingOptions::radius_range, "smallest radius [m]"},
    {"--radius-max", &PackingOptions::radius_max, PackingOptions::radius_range, "largest radius [m]"},
}};

struct Arguments {
  std::string balls, density, seed, grading, out = BedRequest().out.string();
  std::array<std::string, number_options.size()> numbers;
};

void run(const Arguments &arguments) {
  BedRequest request;
  PackingOptions &options = request.packing;
  options.balls = count_option("--balls", arguments.balls, 1, PackingOptions::most_balls);
  for (std::size_t i = 0; i < number_options.size(); ++i)
    options.*number_options[i].value =
        number_option(number_options[i].option, arguments.numbers[i], number_options[i].range);
  options.seed = seed_option("--seed", arguments.seed);
  request.density = number_option("--density", arguments.density, {1e-3, 1e6, "kg/m3"});
  request.out = output_file_option("--out", arguments.out);
  try {
    options.grading = grading_from_name(arguments.grading);
  } catch (const std::invalid_argument &fault) {
    throw UsageError(fmt::format("--{}", fault.what()));
  }
  write_bed(request);
}

} // namespace

void write_bed(const BedRequest &request) {
  const fs::path &out = request.out;
  Packing packing;
  try {
    TimedProgress progress;
    packing = pack_balls(request.packing, [&](std::size_t placed) {
      progress.tell("{} of {} balls placed", placed, request.packing.balls);
    });
  } catch (const std::invalid_argument &fault) {
    throw UsageError(fmt::format("--{}", fault.what()));
  }
  try {
    if (out.has_parent_path()) make_parent_folder(out);
    write_files({{out, bed_data(request.packing, request.density, packing)}});
  } catch (const std::runtime_error &fault) {
    throw UsageError(
        fmt::format("--out is '{}': {}; allowed: a file that can be written", out.string(), fault.what()));
  }
  fmt::print("{}: {} balls, filled to {:.3f} m\n", out.string(), packing.balls.size(), packing.height);
}

void add_bed_command(CLI::App &app, Session &) {
  const auto arguments = std::make_shared<Arguments>();
  const BedRequest request;
  const PackingOptions &defaults = request.packing;
  arguments->balls = fmt::format("{}", defaults.balls);
  arguments->density = fmt::format("{:g}", request.density);
  arguments->seed = fmt::format("{}", defaults.seed);
  arguments->grading = grading_name(defaults.grading);
  for (std::size_t i = 0; i < number_options.size(); ++i)
    arguments->numbers[i] = fmt::format("{}", defaults.*number_options[i].value);

  CLI::App *bed = app.add_subcommand(
      "bed", "Soil balls at random in a box, none touching another, as the data file that "
             "inputs/bed/in.settle reads. The same options give the same file on any machine.");
  bed->add_option("--balls", arguments->balls, "number of balls")->type_name("COUNT")->capture_default_str();
  for (std::size_t i = 0; i < number_options.size(); ++i)
    bed->add_option(number_options[i].option, arguments->numbers[i], number_options[i].help)
        ->type_name("NUMBER")
        ->capture_default_str();
  bed->add_option("--density", arguments->density, "density of a ball [kg/m3]; of a disc, 1 m thick")
      ->type_name("NUMBER")
      ->capture_default_str();
  bed->add_option(
         "--grading", arguments->grading,
         "uniform: every radius as often as any other; mass: the same mass in equal intervals of radius")
      ->type_name("NAME")
      ->capture_default_str();
  bed->add_option("--seed", arguments->seed, "of the random numbers")
      ->type_name("COUNT")
      ->capture_default_str();
  bed->add_option("--out", arguments->out, "the data file; its folder is made if missing")
      ->type_name("FILE")
      ->capture_default_str();
  bed->callback([arguments] { run(*arguments); });
}

} // namespace drumlin::post
