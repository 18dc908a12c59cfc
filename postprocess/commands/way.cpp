#include "commands/commands.h"

#include "chain/driven_way.h"
#include "commands/command.h"
#include "support/files.h"

#include <fmt/format.h>

namespace drumlin::post {

namespace {

struct RandomWayArguments : Options {
  using Options::Options;
  Number mean = number("--mean", {1e-3, 1e12, "N/m"}, "mean of k [N/m]", required);
  Number variation = number("--variation", {1e-6, 10.0, "", true},
                            "coefficient of variation of k: standard deviation over mean [-]", required);
  Number correlation = number("--correlation", {1e-3, 1e6, "m"}, "length of correlation [m]", required);
  Number D = number("--D", {1e-12, 1e6, "", true}, "damping ratio [-], everywhere the same", "0.25");
  Number ratio =
      number("--ratio", {1e-3, 1e3},
             "of k below the left half of the drum over that below the right one, everywhere the same; with "
             "another one than 1 the table has k_left and k_right",
             "1");
  Number from = number("--from", {-1e6, 1e6, "m"}, "place of the first row [m]", "0");
  Number to = number("--to", {-1e6, 1e6, "m"}, "place of the last row [m]", required);
  Number step = number("--step", {1e-6, 1e6, "m"}, "distance of rows, between which k is linear [m]", "0.1");
  Count seed = count("--seed", 0, 2'000'000'000, "of the random numbers", "1", "NUMBER");
  ResultPath out = result_file("--out", "CSV file to write", required);
};

void run(const RandomWayArguments &arguments) {
  RandomSoil soil;
  soil.mean = *arguments.mean;
  soil.variation = *arguments.variation;
  soil.correlation = *arguments.correlation;
  soil.seed = static_cast<unsigned>(*arguments.seed);
  soil.D = *arguments.D;
  soil.ratio = *arguments.ratio;
  soil.from = *arguments.from;
  soil.to = *arguments.to;
  soil.step = *arguments.step;
  if (!(soil.to > soil.from))
    throw arguments.to.refused(fmt::format("a number above --from, {:g} [m]", soil.from));
  constexpr double most = 1e5;
  if (!((soil.to - soil.from) / soil.step <= most))
    throw arguments.step.refused(fmt::format("a number that gives at most {:g} rows [m]", most));
  const Way way = random_way(soil);
  write_files({{*arguments.out, way_text(way)}});
  fmt::print("{}: {} rows from {:g} to {:g} m\n", arguments.out->string(), way.size(), way.front().s,
             way.back().s);
}

} // namespace

void add_way_command(CLI::App &app, Session &session) {
  add_command<RandomWayArguments>(
      app, session, "way",
      "Write a way, the soil that a roller meets, for `exact --way`: k is a random field along it, "
      "log-normal, whose logarithm is correlated as exp(-distance/length). The same options give the "
      "same way.",
      run);
}

} // namespace drumlin::post
