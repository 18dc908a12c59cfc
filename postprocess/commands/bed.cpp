#include "commands/bed.h"

#include "bed/known_gradings.h"
#include "commands/commands.h"
#include "pages/figure_data.h"
#include "pages/gnuplot.h"
#include "support/files.h"
#include "support/options.h"
#include "support/progress.h"
#include "support/usage_error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

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
  std::optional<std::string> sieve, cut;
  std::string instead_of_sieve; ///< an option that was given and says the sizes in another way; empty: none
};

/// The curve that `--sieve` names, and its name as one word.
std::pair<SieveCurve, std::string> asked_grading(const std::string &text) {
  if (const KnownGrading *known = find_grading(text)) return {known->curve(), known->name};
  const fs::path file = path_option("--sieve", text);
  if (!fs::exists(file))
    throw UsageError(refusal(
        "--sieve", text,
        fmt::format("a CSV file with the columns size (mm) and passing (%), or one of {}", grading_names())));
  std::string name = file.stem().string();
  for (char &letter : name)
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '-' && letter != '.') letter = '_';
  try {
    return {read_sieve_file(file), name};
  } catch (const std::runtime_error &fault) {
    throw UsageError(fault.what());
  }
}

/// Sets the sizes of the balls from `--sieve` and `--cut`.
void judge_sieve(const Arguments &arguments, BedRequest &request) {
  if (!arguments.sieve) {
    if (arguments.cut) throw UsageError(refusal("--cut", *arguments.cut, "only with --sieve"));
    return;
  }
  if (!arguments.instead_of_sieve.empty())
    throw UsageError(
        refusal("--sieve", *arguments.sieve,
                fmt::format("without {}: the curve says the sizes", arguments.instead_of_sieve)));
  const auto [curve, name] = asked_grading(*arguments.sieve);
  double cut = 0.0;
  if (arguments.cut) {
    const double least = std::max(curve.smallest(), curve.largest() / PackingOptions::most_spread);
    const Range range = {least * 1e3, curve.largest() * 1e3, "mm", false, false, true};
    cut = std::clamp(number_option("--cut", *arguments.cut, range) * 1e-3, least, curve.largest());
  } else {
    cut = default_cut(curve, request.packing);
  }
  request.asked = curve;
  request.packing.sieve = curve.coarser_than(cut);
  request.packing.sieve_name = name;
}

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
    judge_sieve(arguments, request);
  } catch (const std::invalid_argument &fault) {
    throw UsageError(fmt::format("--{}", fault.what()));
  }
  write_bed(request);
}

constexpr const char *asked_curve = "asked for";
constexpr const char *cut_curve = "asked for without the fines"; // no comma: see CurveTable
constexpr const char *bed_curve = "bed";

/// The curves as the figure shows them: those asked for at their sieves, the bed at many sizes.
std::string grading_csv(const SieveCurve &asked, const SieveCurve &cut, const Sieving &bed) {
  CurveTable table("size (mm),passing (%)");
  for (const auto &[name, curve] : {std::pair{asked_curve, &asked}, std::pair{cut_curve, &cut}})
    for (const Sieve &sieve : curve->sieves())
      table.row(name, {sieve.size * 1e3, sieve.passing * 100.0});
  constexpr int steps = 200;
  for (int i = 0; i <= steps; ++i) {
    const double size = cut.smallest() * std::pow(cut.largest() / cut.smallest(), i / double{steps});
    table.row(bed_curve, {size * 1e3, bed.passing(size) * 100.0});
  }
  return table.text();
}

Figure grading_figure(const std::string &name, const BedRequest &request, const GrainSizes &bed) {
  Figure figure;
  figure.name = name;
  figure.title = fmt::format("Grading of {}", request.out.string());
  Panel panel;
  panel.title = fmt::format("Grading {}, {} balls: d50 = {:.3g} mm, Cu = {:.3g}, Cc = {:.3g}",
                            request.packing.sieve_name, request.packing.balls, bed.d50 * 1e3,
                            bed.uniformity(), bed.curvature());
  panel.x_label = "size (mm)";
  panel.y_label = "mass that passes (%)";
  panel.log_x = panel.plain_numbers = panel.tight_x = true;
  panel.y_range = "[0:100]";
  for (const auto &[curve, style] :
       {std::pair{asked_curve, CurveStyle::series_1}, std::pair{bed_curve, CurveStyle::plain},
        std::pair{cut_curve, CurveStyle::series_2}})
    panel.curves.push_back({name + ".csv", of_curve(curve, "column(2)"), "3", curve, style});
  figure.panels.push_back(panel);
  return figure;
}

/// Prints d10 to d60, C_u and C_c, and how far the bed differs from the curve at its sieves.
void print_grading(const BedRequest &request, const Sieving &bed) {
  const SieveCurve &asked = *request.asked, &cut = *request.packing.sieve;
  fmt::print("Grading {}: {:.1f} % of the mass are grains finer than {:g} mm, which are left out\n"
             "{:<32}    d10    d30    d50    d60 mm    C_u    C_c\n",
             request.packing.sieve_name, asked.passing(cut.smallest()) * 100.0, cut.smallest() * 1e3, "");
  double largest = 0.0, at = 0.0;
  for (const Sieve &sieve : cut.sieves())
    if (const double difference = std::abs(bed.passing(sieve.size) - sieve.passing); difference > largest) {
      largest = difference;
      at = sieve.size;
    }
  const auto line = [](const char *name, const GrainSizes &s, bool known) {
    const auto cell = [&](double value) { return known ? fmt::format("{:.3g}", value) : "-"; };
    fmt::print("{:<32} {:>6} {:>6.3g} {:>6.3g} {:>6.3g}    {:>6} {:>6}\n", name, cell(s.d10 * 1e3),
               s.d30 * 1e3, s.d50 * 1e3, s.d60 * 1e3, cell(s.uniformity()), cell(s.curvature()));
  };
  line(asked_curve, grain_sizes(asked), asked.sieves().front().passing <= 0.1);
  line(cut_curve, grain_sizes(cut), true);
  line(bed_curve, grain_sizes(bed), true);
  fmt::print(
      "largest difference of the bed from the cut curve at a sieve: {:.2f} % of the mass, at {:g} mm\n",
      largest * 100.0, at * 1e3);
}

} // namespace

void write_bed(const BedRequest &request) {
  const fs::path &out = request.out;
  const fs::path folder = out.has_parent_path() ? out.parent_path() : ".";
  const fs::path gnuplot = request.asked ? find_gnuplot() : fs::path();
  Packing packing;
  try {
    TimedProgress progress;
    packing = pack_balls(request.packing, [&](std::size_t placed) {
      progress.tell("{} of {} balls placed", placed, request.packing.balls);
    });
  } catch (const std::invalid_argument &fault) {
    throw UsageError(fmt::format("--{}", fault.what()));
  }
  const Sieving bed = sieved(packing, request.packing.dimensions());
  const std::string figure = out.stem().string() + "_grading";
  std::optional<FilesInProgress> files;
  try {
    if (out.has_parent_path()) make_parent_folder(out);
    if (request.asked) {
      files.emplace(folder);
      write_files({{*files / (figure + ".csv"), grading_csv(*request.asked, *request.packing.sieve, bed)}});
    }
    write_files({{out, bed_data(request.packing, request.density, packing)}});
  } catch (const std::runtime_error &fault) {
    throw UsageError(
        fmt::format("--out is '{}': {}; allowed: a file that can be written", out.string(), fault.what()));
  }
  fmt::print("{}: {} balls, filled to {:.3f} m\n", out.string(), packing.balls.size(), packing.height);
  if (!files) return;
  print_grading(request, bed);
  render(gnuplot, (*files / figure).parent_path(), grading_figure(figure, request, grain_sizes(bed)));
  files->publish({figure + ".csv", figure + ".gp", figure + ".svg", figure + ".png"},
                 [](const std::string &) { return false; });
  fmt::print("{}: the grading of the bed beside the one asked for\n",
             (folder / (figure + ".png")).lexically_normal().string());
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
  bed->add_option("--sieve", arguments->sieve,
                  fmt::format("grading instead of radii: a CSV file with the columns size (mm) and passing "
                              "(%) by mass, or one "
                              "of {}",
                              grading_names()))
      ->type_name("FILE");
  bed->add_option("--cut", arguments->cut,
                  "smallest size of a ball with --sieve [mm]; default: so that the balls fill the box to "
                  "--height, or to "
                  "half its width")
      ->type_name("NUMBER");
  bed->add_option("--seed", arguments->seed, "of the random numbers")
      ->type_name("COUNT")
      ->capture_default_str();
  bed->add_option("--out", arguments->out, "the data file; its folder is made if missing")
      ->type_name("FILE")
      ->capture_default_str();
  bed->callback([arguments, bed] {
    for (const char *option : {"--radius-min", "--radius-max", "--grading"})
      if (bed->count(option) > 0) arguments->instead_of_sieve = option;
    run(*arguments);
  });
}

} // namespace drumlin::post
