#include "commands/commands.h"

#include "chain/driven_way.h"
#include "commands/text_options.h"
#include "support/csv.h"
#include "support/files.h"
#include "support/options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <string>

namespace drumlin::post {

namespace {

// The options as given. Numbers stay text until they are checked.
struct Arguments {
  std::string mean, variation, correlation, seed = "1", from = "0", to, step = "0.1", D = "0.25", ratio = "1",
                                            out;
};

void run(const Arguments &arguments) {
  RandomSoil soil;
  soil.mean = number_option("--mean", arguments.mean, {1e-3, 1e12, "N/m"});
  soil.variation = number_option("--variation", arguments.variation, {1e-6, 10.0, "", true});
  soil.correlation = number_option("--correlation", arguments.correlation, {1e-3, 1e6, "m"});
  soil.seed = static_cast<unsigned>(count_option("--seed", arguments.seed, 0, 2'000'000'000));
  soil.D = number_option("--D", arguments.D, {1e-12, 1e6, "", true});
  soil.ratio = number_option("--ratio", arguments.ratio, {1e-3, 1e3, ""});
  soil.from = number_option("--from", arguments.from, {-1e6, 1e6, "m"});
  soil.to = number_option("--to", arguments.to, {-1e6, 1e6, "m"});
  if (!(soil.to > soil.from))
    throw UsageError(refusal("--to", soil.to, fmt::format("a number above --from, {:g} [m]", soil.from)));
  soil.step = number_option("--step", arguments.step, {1e-6, 1e6, "m"});
  constexpr double most = 1e5;
  if (!((soil.to - soil.from) / soil.step <= most))
    throw UsageError(
        refusal("--step", soil.step, fmt::format("a number that gives at most {:g} rows [m]", most)));
  const std::filesystem::path out = output_file_option("--out", arguments.out);
  const Way way = random_way(soil);
  write_files({{out, way_text(way)}});
  fmt::print("{}: {} rows from {:g} to {:g} m\n", out.string(), way.size(), way.front().s, way.back().s);
}

} // namespace

void add_way_command(CLI::App &app, Session & /*session*/) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App *way = app.add_subcommand(
      "way", "Write a way, the soil that a roller meets, for `exact --way`: k is a random field along it, "
             "log-normal, whose logarithm is correlated as exp(-distance/length). The same options give the "
             "same way.");
  text_option(way, "--mean", "NUMBER", arguments->mean, "mean of k [N/m]")->required();
  text_option(way, "--variation", "NUMBER", arguments->variation,
              "coefficient of variation of k: standard deviation over mean [-]")
      ->required();
  text_option(way, "--correlation", "NUMBER", arguments->correlation, "length of correlation [m]")
      ->required();
  text_option(way, "--D", "NUMBER", arguments->D, "damping ratio [-], everywhere the same");
  text_option(way, "--ratio", "NUMBER", arguments->ratio,
              "of k below the left half of the drum over that below the right one, everywhere the same; with "
              "another one than 1 the table has k_left and k_right");
  text_option(way, "--from", "NUMBER", arguments->from, "place of the first row [m]");
  text_option(way, "--to", "NUMBER", arguments->to, "place of the last row [m]")->required();
  text_option(way, "--step", "NUMBER", arguments->step, "distance of rows, between which k is linear [m]");
  text_option(way, "--seed", "NUMBER", arguments->seed, "of the random numbers");
  way->add_option("--out", arguments->out, "CSV file to write")->type_name("FILE")->required();
  way->callback([arguments] { run(*arguments); });
}

} // namespace drumlin::post
