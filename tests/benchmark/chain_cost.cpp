// Cost per step of the chain: the plugin's contact law beside the engine's own, and what guard, events and
// history add. Runs are interleaved, so that a busy moment of the machine falls on all variants alike, and
// the median counts.
#include "engine.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using drumlin::test::Variables;

struct Variant {
  std::string name;
  Variables switches;
  std::size_t base;            // the variant that its ratio refers to
  std::vector<double> total{}; // s, one per run
  std::vector<double> pair{};
  double drum = 0; // where the drum ends, m
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// The number after a text in the engine's output.
double number_after(const std::string &output, const std::string &text) {
  const std::size_t found = output.find(text);
  if (found == std::string::npos)
    throw std::runtime_error("'" + text + "' is missing in the engine's output:\n" + output);
  return std::stod(output.substr(found + text.size()));
}

void run(Variant &variant, int steps) {
  const drumlin::test::Scratch scratch;
  Variables variables = {{"chain", drumlin::test::chain_deck("in.chain").parent_path().string()},
                         {"steps", std::to_string(steps)}};
  variables.insert(variables.end(), variant.switches.begin(), variant.switches.end());
  const auto outcome = drumlin::test::run_deck(DRUMLIN_SOURCE_DIR "/tests/benchmark/in.cost", variables,
                                               scratch.path(), 1, 600);
  if (!outcome.ok()) throw std::runtime_error("in.cost failed:\n" + outcome.output);
  variant.total.push_back(number_after(outcome.output, "Loop time of "));
  variant.pair.push_back(number_after(outcome.output, "Pair  time (%) = "));
  variant.drum = number_after(outcome.output, "drum at ");
}

void report(const std::vector<Variant> &variants, int steps, int repeats, const std::string &file) {
  const double scale = 1e6 / steps; // s a run to microseconds a step
  std::string csv = "variant,total_us_per_step,total_min_us_per_step,total_max_us_per_step,pair_us_per_step,"
                    "ratio,ratio_to\n";
  fmt::print("\nMedian of {} interleaved runs of {} steps, microseconds per step\n\n", repeats, steps);
  fmt::print("{:<34} {:>7} {:>15} {:>7} {:>7}  {}\n", "variant", "total", "(min to max)", "pair", "ratio",
             "to");
  for (const Variant &v : variants) {
    const auto [low, high] = std::minmax_element(v.total.begin(), v.total.end());
    const Variant &base = variants[v.base];
    // Run by run, then the median: neighbours in time share the machine's mood.
    std::vector<double> ratios;
    for (std::size_t n = 0; n < v.total.size(); ++n)
      ratios.push_back(v.total[n] / base.total[n]);
    const double total = scale * median(v.total), pair = scale * median(v.pair);
    fmt::print("{:<34} {:>7.3f} ({:>5.3f} to {:>5.3f}) {:>7.3f} {:>7.3f}  {}\n", v.name, total, scale * *low,
               scale * *high, pair, median(ratios), base.name);
    csv += fmt::format("{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{}\n", v.name, total, scale * *low,
                       scale * *high, pair, median(ratios), base.name);
  }
  if (file.empty()) return;
  std::ofstream out(file);
  out << csv;
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file);
}

int measure(int steps, int repeats, const std::string &file) {
  std::vector<Variant> variants = {
      {"engine law", {{"engine_law", "1"}}, 0},
      {"plugin law", {}, 0},
      {"engine law; no bond; no exciter", {{"engine_law", "1"}, {"fixes", "0"}}, 2},
      {"plugin law; no bond; no exciter", {{"fixes", "0"}}, 2},
      {"plugin law; guard", {{"guard", "on"}}, 1},
      {"plugin law; events", {{"events", "1"}}, 1},
      {"plugin law; history", {{"history", "1"}}, 1},
      {"plugin law; all as in.chain", {{"guard", "on"}, {"events", "1"}, {"history", "1"}}, 1},
  };
  for (int n = 0; n < repeats; ++n)
    for (std::size_t i = 0; i < variants.size(); ++i) {
      fmt::print("\rrun {} of {} ", static_cast<std::size_t>(n) * variants.size() + i + 1,
                 static_cast<std::size_t>(repeats) * variants.size());
      std::fflush(stdout);
      run(variants[i], steps);
    }
  // The laws are one to rounding; over many jumps of the force rounding grows, but not to a tenth of a
  // millimetre.
  if (std::fabs(variants[0].drum - variants[1].drum) > 1e-4)
    throw std::runtime_error(fmt::format("the two laws moved the drum to {} and {} m: not the same work",
                                         variants[0].drum, variants[1].drum));
  report(variants, steps, repeats, file);
  return 0;
}

int command(int argc, char **argv) {
  CLI::App app("Cost per step of the chain, by the plugin's contact law and by the engine's own");
  int steps = 500000;
  int repeats = 9;
  std::string file;
  app.add_option("--steps", steps, "steps per run")
      ->check(CLI::Range(1000, 100000000))
      ->capture_default_str();
  app.add_option("--repeats", repeats, "runs of each variant; the median counts")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--out", file, "CSV file to write");
  CLI11_PARSE(app, argc, argv);
  return measure(steps, repeats, file);
}

} // namespace

int main(int argc, char **argv) {
  try {
    return command(argc, argv);
  } catch (const std::exception &error) {
    std::fprintf(stderr, "ERROR: chain_cost: %s\n", error.what());
  } catch (...) {
    std::fputs("ERROR: chain_cost: unknown error\n", stderr);
  }
  return 1;
}
