#include "bed_command.h"

#include "bed_packing.h"
#include "chain_csv.h"
#include "options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <system_error>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

struct Number {
  const char *option;
  double PackingOptions::*value;
  const char *help;
};
constexpr std::array<Number, 5> number_options = {{
    {"--width", &PackingOptions::width, "width of the box [m], wall to wall"},
    {"--depth", &PackingOptions::depth, "depth of the box [m]; 0: two dimensions, the balls are discs"},
    {"--height", &PackingOptions::height, "filled height [m]; 0: as needed"},
    {"--radius-min", &PackingOptions::radius_min, "smallest radius [m]"},
    {"--radius-max", &PackingOptions::radius_max, "largest radius [m]"},
}};

struct Arguments {
  std::string balls, density, seed, grading, out = "results/bed/balls.data";
  std::array<std::string, number_options.size()> numbers;
};

std::uint64_t seed_option(const std::string &text) {
  std::uint64_t seed = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (fault != std::errc() || end != text.data() + text.size())
    throw UsageError(
        fmt::format("--seed = '{}': allowed are whole numbers from 0 to 18446744073709551615", text));
  return seed;
}

void run(const Arguments &arguments) {
  PackingOptions options;
  options.balls = count_option("--balls", arguments.balls);
  for (std::size_t i = 0; i < number_options.size(); ++i)
    options.*number_options[i].value = number_option(number_options[i].option, arguments.numbers[i]);
  options.seed = seed_option(arguments.seed);
  const double density = number_option("--density", arguments.density);
  if (density <= 0.0)
    throw UsageError(fmt::format("--density = '{}': allowed are numbers > 0", arguments.density));
  const fs::path out = arguments.out;
  Packing packing;
  try {
    options.grading = grading_from_name(arguments.grading);
    packing = pack_balls(options, [&options](std::size_t placed) {
      fmt::print("{} of {} balls placed\n", placed, options.balls);
      std::fflush(stdout);
    });
    if (out.has_parent_path()) fs::create_directories(out.parent_path());
    write_files({{out, bed_data(options, density, packing)}});
  } catch (const std::invalid_argument &fault) {
    throw UsageError(fmt::format("--{}", fault.what()));
  } catch (const std::runtime_error &fault) {
    throw UsageError(
        fmt::format("--out = '{}': {}; allowed: a file that can be written", out.string(), fault.what()));
  }
  fmt::print("{}: {} balls, filled to {:.3f} m\n", out.string(), packing.balls.size(), packing.height);
}

} // namespace

void add_bed_command(CLI::App &app, Session &) {
  const auto arguments = std::make_shared<Arguments>();
  const PackingOptions defaults;
  arguments->balls = fmt::format("{}", defaults.balls);
  arguments->density = "2650";
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
