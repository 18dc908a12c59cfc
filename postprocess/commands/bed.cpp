#include "commands/commands.h"

#include "bed/packing.h"
#include "bed/relative_density.h"
#include "commands/command.h"
#include "commands/made_packings.h"
#include "engine/deck_run.h"
#include "pages/figure.h"
#include "pages/gnuplot.h"
#include "support/files.h"
#include "support/options.h"
#include "support/progress.h"
#include "support/usage_error.h"

#include <boost/algorithm/string/split.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// Balls in a box, and the file that gets them.
struct BedRequest {
  PackingOptions packing;
  /// Layers, the lowest first, instead of `packing` and `asked`: empty for a bed of one kind of soil.
  struct Layer {
    BedLayer bed;
    std::optional<SieveCurve> asked;
  };
  std::vector<Layer> layers;
  std::vector<Spot> spots;         ///< of the lowest layer
  double density = 2650.0;         ///< of a ball, kg/m3; in two dimensions of a disc 1 m thick
  std::optional<SieveCurve> asked; ///< the whole curve that PackingOptions::sieve is the coarser part of
  std::filesystem::path out = "results/bed/balls.data"; ///< its folder is made if missing
};

constexpr Range box_side = {PackingOptions::length_range.least, PackingOptions::length_range.most, "m"};
constexpr Range side_or_zero = {box_side.least, box_side.most, "m", true};

/// More would need more types than the engine's neighbour lists are made for; a road has half a dozen layers.
constexpr std::size_t most_layers = 10;

template <class Value>
std::string usual(Value PackingOptions::*value) {
  return fmt::format("{}", PackingOptions().*value);
}

struct BedArguments : Options {
  explicit BedArguments(Command &of) : Options(of) {
    only_with(sieve, {&cut});
    for (const Option *option : std::initializer_list<const Option *>{&radius_min, &radius_max, &grading})
      not_with(*option, {&sieve}, "without " + option->name() + ": the curve says the sizes");
    for (const Option *option : std::initializer_list<const Option *>{&sieve, &cut, &height})
      not_with(*option, {&layers});
    only_with(relative_densities, {&packings, &friction, &rolling});
    only_with(layers, {&spots});
  }
  Count balls =
      count("--balls", 1, PackingOptions::most_balls, "number of balls", usual(&PackingOptions::balls));
  Number width =
      number("--width", box_side, "width of the box [m], wall to wall", usual(&PackingOptions::width));
  Number depth =
      number("--depth", side_or_zero, "depth of the box [m]; 0: two dimensions, the balls are discs",
             usual(&PackingOptions::depth));
  Number height =
      number("--height", side_or_zero, "filled height [m]; 0: as needed", usual(&PackingOptions::height));
  Number radius_min = number("--radius-min", PackingOptions::radius_range, "smallest radius [m]",
                             usual(&PackingOptions::radius_min));
  Number radius_max = number("--radius-max", PackingOptions::radius_range, "largest radius [m]",
                             usual(&PackingOptions::radius_max));
  Number density =
      number("--density", {1e-3, 1e6, "kg/m3"}, "density of a ball [kg/m3]; of a disc, 1 m thick",
             fmt::format("{:g}", BedRequest().density));
  Text grading =
      text("--grading", "NAME",
           "uniform: every radius as often as any other; mass: the same mass in equal intervals of radius",
           grading_name(PackingOptions().grading));
  Text sieve = text(
      "--sieve", "FILE",
      fmt::format("grading instead of radii: a table of the laboratory with the columns size (mm) and "
                  "passing (%) or retained (%) by mass, one of {}, or the smallest and the largest size, as "
                  "32-48 [mm]",
                  grading_names()));
  Text cut = text("--cut", "NUMBER",
                  "smallest size of a ball with --sieve [mm]; default: so that the balls fill the box to "
                  "--height, or to half its width");
  Texts layers = texts_in_a_row(
      "--layer", "THICKNESS[:SIEVE[:CUT]]",
      "a layer of the bed, the lowest first; several form a bed of layers with contacts of their own: its "
      "thickness when it has settled [m], a curve as of --sieve (else radii as of --radius-min, "
      "--radius-max, --grading), and the smallest size of its balls [mm] (else so that the layer has its "
      "share of --balls, the same for each); --balls then counts for curves without CUT only");
  Texts spots = texts_in_a_row(
      "--spot", "FROM:TO",
      "a part of the lowest layer, along the way, with contacts of its own, such as a soft spot; may "
      "be given several times, in the order of the way; x is 0 in the middle [m]");
  Texts relative_densities =
      texts_in_a_row("--relative-density", "NUMBER",
                     "of a layer, or of the whole bed, from 0, the loosest packing of its mix, to 1, the "
                     "densest that shaking leaves; above 1, up to some 1.3, denser than any soil, which can "
                     "only loosen; once, or once for each "
                     "--layer: in.settle then pours the layer with the friction that gives it");
  Texts packings = texts_in_a_row(
      "--packings", "FILE",
      "table of the loosest and the shaken packing of the layer's mix and those between: density.csv of "
      "inputs/soil/in.density, or OUT_packings.csv of an earlier call; once, or once for each --layer; "
      "default: the stored ones of case gravel for its radii and friction, else a table beside --out, "
      "which LIGGGHTS makes once, in some minutes");
  Number friction =
      number("--friction", {0.0, 1e3},
             "of the soil once it lies, for --relative-density; default: that of case base, 0.8");
  Number rolling =
      number("--rolling", {0.0, 1e3},
             "rolling friction of the soil once it lies, for --relative-density; default: that of case "
             "base, 0.45");
  Seed seed = random_seed("--seed", "of the random numbers", usual(&PackingOptions::seed));
  ResultPath out =
      result_file("--out", "the data file; its folder is made if missing", BedRequest().out.string());
};

/// The curve that an option names, and its name as one word.
std::pair<SieveCurve, std::string> asked_grading(const char *option, const std::string &text) {
  if (const KnownGrading *known = find_grading(text)) return {known->curve(), known->name};
  const fs::path file = path_option(option, text);
  if (!fs::exists(file)) {
    if (const std::optional<SieveCurve> curve = curve_between(text)) return {*curve, text};
    throw UsageError(refusal(
        option, text,
        fmt::format("a CSV file with the columns size (mm) and passing (%) or retained (%), or one of {}, or "
                    "the smallest and the largest size, in mm, as 32-48",
                    grading_names())));
  }
  std::string name = file.stem().string();
  for (char &letter : name)
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '-' && letter != '.') letter = '_';
  try {
    return {read_sieve_file(file), name};
  } catch (const std::runtime_error &fault) {
    throw UsageError(fault.what());
  }
}

/// Size, m, from a text in mm at which a curve is cut.
double given_cut(const char *option, const std::string &text, const SieveCurve &curve) {
  const double least = std::max(curve.smallest(), curve.largest() / PackingOptions::most_spread);
  const Range range = {least * 1e3, curve.largest() * 1e3, "mm", false, false, true};
  return std::clamp(number_option(option, text, range) * 1e-3, least, curve.largest());
}

void set_grading(PackingOptions &options, const SieveCurve &curve, const std::string &name, double cut) {
  options.sieve = curve.coarser_than(cut);
  options.sieve_name = name;
}

/// Sets the sizes of the balls from `--sieve` and `--cut`.
void judge_sieve(const BedArguments &arguments, BedRequest &request) {
  if (!arguments.sieve) return;
  const auto [curve, name] = asked_grading("--sieve", *arguments.sieve);
  request.asked = curve;
  set_grading(request.packing, curve, name,
              arguments.cut ? given_cut("--cut", *arguments.cut, curve)
                            : default_cut(curve, request.packing));
}

/// What an option given once, or once for each layer, says of a layer; empty: the option is not given.
std::string of_layer(const Texts &option, std::size_t layer, std::size_t layers) {
  const std::vector<std::string> &given = *option;
  if (given.empty()) return {};
  if (given.size() != 1 && given.size() != layers)
    throw option.refused(given.back(), fmt::format("once, or once for each of the {} layers", layers));
  return given.size() == 1 ? given.front() : given[layer];
}

/// Friction and rolling friction of the settled soil: --friction and --rolling, or those of case base.
SoilFriction asked_friction(const BedArguments &arguments) {
  SoilFriction soil;
  soil.friction = arguments.friction.value_or(soil.friction);
  soil.rolling = arguments.rolling.value_or(soil.rolling);
  return soil;
}

/// The packings in a file that --packings names.
MeasuredPackings given_packings(const std::string &file, const BedArguments &arguments,
                                const PackingOptions &box) {
  const fs::path path = path_option("--packings", file);
  if (!fs::exists(path))
    throw arguments.packings.refused(
        file, "the density.csv of a run of inputs/soil/in.density, or a table of packings that "
              "this command has made");
  try {
    MeasuredPackings packings = read_packings(path);
    if (const std::string other = other_balls(packings, box); !other.empty())
      throw arguments.packings.refused(file, other);
    const SoilFriction asked = asked_friction(arguments);
    const MeasuredPackings::Row &loosest = packings.of_loosest();
    for (const auto &[option, wanted, has] :
         {std::tuple{&arguments.friction, asked.friction, loosest.friction},
          std::tuple{&arguments.rolling, asked.rolling, loosest.rolling}})
      if (*option && wanted != has)
        throw option->refused(fmt::format("{:g}, of which {} has packings", has, file));
    return packings;
  } catch (const std::runtime_error &fault) {
    throw UsageError(fault.what());
  }
}

/// The stored packings of case gravel, if they are of such balls and contacts.
std::optional<MeasuredPackings> stored_packings(const SoilFriction &soil, const PackingOptions &box) {
  MeasuredPackings packings = packings_of_gravel(box.dimensions());
  const SoilFriction gravel;
  if (!other_balls(packings, box).empty() || soil.friction != gravel.friction ||
      soil.rolling != gravel.rolling)
    return {};
  return packings;
}

/// Says of each layer how it is poured to get the relative density that is asked for. An engine makes
/// packings that are not known.
void pour_layers(const BedArguments &arguments, BedRequest &request) {
  const std::size_t layers = request.layers.size();
  if (!arguments.relative_densities) return;
  const SoilFriction soil = asked_friction(arguments);
  if (!(soil.friction > 0.0))
    throw arguments.friction.refused(
        "above 0 with --relative-density: without friction all packings are the densest");
  struct Wanted {
    double relative;
    std::optional<MeasuredPackings> packings;
  };
  std::vector<Wanted> wanted;
  for (std::size_t n = 0; n < layers; ++n) {
    const std::string density = of_layer(arguments.relative_densities, n, layers),
                      file = of_layer(arguments.packings, n, layers);
    constexpr Range range = {0.0, 2.0};
    const PackingOptions &box = request.layers[n].bed.packing;
    wanted.push_back({number_option("--relative-density", density, range),
                      file.empty() ? stored_packings(soil, box) : given_packings(file, arguments, box)});
    const double most = wanted.back().packings.value_or(packings_of_gravel(box.dimensions())).most();
    if (wanted.back().relative > most)
      throw arguments.relative_densities.refused(
          density, fmt::format("at most {:.3f}, of the packing without friction", most));
  }
  for (std::size_t n = 0; n < layers; ++n) {
    BedLayer &layer = request.layers[n].bed;
    if (!wanted[n].packings) {
      const std::string number = layers > 1 ? fmt::format("_{}", n + 1) : "";
      wanted[n].packings = made_packings(
          layer, soil, request.density,
          request.out.parent_path() / fmt::format("{}_packings{}.csv", request.out.stem().string(), number),
          fmt::format("Layer {}", n + 1));
    }
    if (wanted[n].packings->estimated)
      print_progress(
          fmt::format("Layer {}: nothing was shaken; how dense shaking makes it is estimated from case "
                      "gravel, {:.2f} of the way from the loosest to the frictionless packing, "
                      "uncertain by a tenth or more",
                      n + 1, 1.0 / wanted[n].packings->most()));
    else if (wanted[n].relative < 0.4) // inputs/study/density
      print_progress(
          fmt::format("Layer {}: in.settle leaves layers that ask for less than 0.4 looser, by 0.2 to "
                      "0.3 in the plane; it tells what it has got",
                      n + 1));
    layer.pouring = wanted[n].packings->pouring(wanted[n].relative);
    if (!arguments.layers)
      layer.thickness *= layer.packing.balls / static_cast<double>(balls_of(layer));
    else
      layer.packing.balls = balls_of(layer);
  }
}

/// The n-th layer from THICKNESS[:SIEVE[:CUT]]. \param box what the layer shares with the others; its number
/// of balls is the layer's share of --balls
BedRequest::Layer asked_layer(const BedArguments &arguments, std::size_t n, const PackingOptions &box) {
  const std::string &text = (*arguments.layers)[n];
  std::vector<std::string> parts;
  boost::split(parts, text, [](char letter) { return letter == ':'; });
  constexpr std::size_t most_parts = 3;
  if (parts.size() > most_parts) throw arguments.layers.refused(text, "THICKNESS[:SIEVE[:CUT]]");
  BedRequest::Layer layer{{box, number_option("--layer", parts[0], box_side)}, {}};
  if (parts.size() > 1) {
    const auto [curve, name] = asked_grading("--layer", parts[1]);
    layer.asked = curve;
    set_grading(layer.bed.packing, curve, name,
                parts.size() == most_parts ? given_cut("--layer", parts[2], curve)
                                           : default_cut_of_layer(curve, layer.bed));
  }
  if (const std::string fault = layer.bed.packing.invalid(); !fault.empty())
    throw std::invalid_argument(fault);
  if (const std::string fault = layer.bed.invalid(); !fault.empty()) throw std::invalid_argument(fault);
  layer.bed.packing.balls = balls_of(layer.bed);
  return layer;
}

/// Refuses options that have no effect with these layers: the number of balls decides where a sieve curve is
/// cut that has no cut of its own, and radii are those of layers without a curve.
void judge_effects(const BedArguments &arguments) {
  const auto any_has = [&arguments](std::ptrdiff_t parts) {
    return std::any_of(arguments.layers.begin(), arguments.layers.end(), [parts](const std::string &layer) {
      return std::count(layer.begin(), layer.end(), ':') + 1 == parts;
    });
  };
  if (arguments.balls.given() && !any_has(2))
    throw arguments.balls.refused(
        "only with a layer THICKNESS:SIEVE, where it decides the cut; else its thickness says the number");
  for (const Option *option : std::initializer_list<const Option *>{&arguments.grading, &arguments.radius_max,
                                                                    &arguments.radius_min})
    if (option->given() && !any_has(1))
      throw arguments.layers.refused(arguments.layers->front(),
                                     fmt::format("without {}: the curves say the sizes", option->name()));
}

/// Sets the spots from `--spot`, in the order of the way.
void judge_spots(const BedArguments &arguments, BedRequest &request) {
  if (request.layers.size() + arguments.spots->size() > most_layers)
    throw arguments.spots.refused(arguments.spots->back(),
                                  fmt::format("at most {} layers and spots", most_layers));
  double from = -0.5 * request.packing.width;
  for (const std::string &text : arguments.spots) {
    const std::size_t colon = text.find(':');
    const double least = 2.0 * request.layers.front().bed.packing.largest_radius();
    const Range way = {from, 0.5 * request.packing.width, "m"};
    const auto refused = [&] {
      return arguments.spots.refused(
          text, fmt::format("FROM:TO, {} from the middle, in the order of the way, each at "
                            "least {:g} m long: the largest ball of the lowest layer",
                            way.words(), least));
    };
    if (colon == std::string::npos) throw refused();
    Spot spot{};
    try {
      spot = {number_option("--spot", text.substr(0, colon), way),
              number_option("--spot", text.substr(colon + 1), way)};
    } catch (const UsageError &) {
      throw refused();
    }
    if (!(spot.to - spot.from >= least)) throw refused();
    request.spots.push_back(spot);
    from = spot.to;
  }
}

/// The whole bed as one layer, as thick as its balls make it.
BedRequest::Layer only_layer(const BedRequest &request) {
  BedRequest::Layer layer{{request.packing, 1.0}, request.asked};
  layer.bed.thickness = request.packing.balls / static_cast<double>(balls_of(layer.bed));
  if (const std::string fault = layer.bed.packing.invalid(); !fault.empty())
    throw std::invalid_argument(fault);
  if (!layer.bed.invalid().empty())
    throw std::invalid_argument(refusal("balls", request.packing.balls,
                                        "with --relative-density so many that the bed is at least as thick "
                                        "as its largest ball"));
  return layer;
}

/// Sets the layers from `--layer`.
void judge_layers(const BedArguments &arguments, BedRequest &request) {
  if (!arguments.layers) {
    if (arguments.relative_densities) request.layers.push_back(only_layer(request));
    return;
  }
  const std::vector<std::string> &layers = *arguments.layers;
  if (layers.size() > most_layers)
    throw arguments.layers.refused(layers[most_layers], fmt::format("at most {} layers", most_layers));
  PackingOptions box = request.packing;
  box.balls = std::max(1, box.balls / static_cast<int>(layers.size()));
  double balls = 0.0;
  for (std::size_t n = 0; n < layers.size(); ++n) {
    request.layers.push_back(asked_layer(arguments, n, box));
    balls += request.layers.back().bed.packing.balls;
    if (balls > PackingOptions::most_balls)
      throw arguments.layers.refused(
          layers[n], fmt::format("layers of at most {} balls in all", PackingOptions::most_balls));
  }
  judge_effects(arguments);
}

/// The figure of a grading beside the balls, and its files.
std::string grading_figure(const fs::path &out) { return out.stem().string() + "_grading"; }
std::vector<std::string> grading_files(const fs::path &out) {
  const std::string figure = grading_figure(out);
  return {figure + ".csv", figure + ".gp", figure + ".svg", figure + ".png"};
}

/// Refuses results in the place of a curve that is read.
void keep_curves(const BedArguments &arguments, const fs::path &out) {
  std::vector<GivenPath> curves;
  const auto add = [&curves](const char *option, const std::string &text) {
    if (find_grading(text) == nullptr) curves.push_back({option, path_option(option, text)});
  };
  if (arguments.sieve) add("--sieve", *arguments.sieve);
  for (const std::string &layer : arguments.layers) {
    std::vector<std::string> parts;
    boost::split(parts, layer, [](char letter) { return letter == ':'; });
    if (parts.size() > 1) add("--layer", parts[1]);
  }
  for (const std::string &file : arguments.packings)
    curves.push_back({"--packings", path_option("--packings", file)});
  std::vector<GivenPath> outputs = files_in("--out", out.parent_path(), grading_files(out));
  outputs.push_back({"--out", out});
  keep_apart(curves, outputs);
}

constexpr const char *asked_curve = "asked for";
constexpr const char *cut_curve = "asked for without the fines"; // no comma: see CurveTable
constexpr const char *bed_curve = "bed";

/// A grading that was asked for, and that of the balls. Of a layer, or of the whole bed.
struct GradingPair {
  std::string title; ///< "Layer 2: ", or nothing
  std::string of;    ///< what distinguishes its curves from those of others: " 2", or nothing
  PackingOptions packing;
  SieveCurve asked;
  Sieving balls;

  const SieveCurve &cut() const { return *packing.sieve; }
};

/// Those parts of the bed for which a grading was asked for.
std::vector<GradingPair> grading_pairs(const BedRequest &request, const Packing &packing) {
  std::vector<GradingPair> pairs;
  if (request.layers.empty() && request.asked)
    pairs.push_back({"", "", request.packing, *request.asked, sieved(packing, request.packing.dimensions())});
  for (std::size_t n = 0; n < request.layers.size(); ++n)
    if (const auto &[bed, asked] = request.layers[n]; asked)
      pairs.push_back({fmt::format("Layer {}: ", n + 1), fmt::format(" {}", n + 1), bed.packing, *asked,
                       sieved_layer(packing, bed.packing.dimensions(), static_cast<int>(n))});
  return pairs;
}

/// The curves as the figure shows them: those asked for at their sieves, the bed at many sizes.
std::string grading_csv(const std::vector<GradingPair> &pairs) {
  CurveTable table("size (mm),passing (%)");
  for (const GradingPair &pair : pairs) {
    for (const auto &[name, curve] : {std::pair{asked_curve, &pair.asked}, std::pair{cut_curve, &pair.cut()}})
      for (const Sieve &sieve : curve->sieves())
        table.row(name + pair.of, {sieve.size * 1e3, sieve.passing * 100.0});
    constexpr int steps = 200;
    for (int i = 0; i <= steps; ++i) {
      const double size =
          pair.cut().smallest() * std::pow(pair.cut().largest() / pair.cut().smallest(), i / double{steps});
      table.row(bed_curve + pair.of, {size * 1e3, pair.balls.passing(size) * 100.0});
    }
  }
  return table.text();
}

Panel grading_panel(const std::string &name, const GradingPair &pair) {
  const GrainSizes sizes = grain_sizes(pair.balls);
  Panel panel{fmt::format("{}Grading {}, {} balls: d50 = {:.3g} mm, Cu = {:.3g}, Cc = {:.3g}", pair.title,
                          pair.packing.sieve_name, pair.packing.balls, sizes.d50 * 1e3, sizes.uniformity(),
                          sizes.curvature()),
              "size (mm)",
              "mass that passes (%)",
              {}};
  panel.log_x = panel.plain_numbers = panel.tight_x = true;
  panel.y_range = "[0:100]";
  for (const auto &[curve, style] :
       {std::pair{asked_curve, CurveStyle::series_1}, std::pair{bed_curve, CurveStyle::plain},
        std::pair{cut_curve, CurveStyle::series_2}})
    panel.curves.push_back({name + ".csv", of_curve(curve + pair.of, "column(2)"), "3", curve, style});
  return panel;
}

/// Prints d10 to d60, C_u and C_c, and how far the bed differs from the curve at its sieves.
void print_grading(const GradingPair &pair) {
  const SieveCurve &asked = pair.asked, &cut = pair.cut();
  fmt::print("{}Grading {}: {:.1f} % of the mass are grains finer than {:g} mm, which are left out; in the "
             "soil they fill pores, so that relative densities may be compared, solid fractions not\n"
             "{:<32}    d10    d30    d50    d60 mm    C_u    C_c\n",
             pair.title, pair.packing.sieve_name, asked.passing(cut.smallest()) * 100.0, cut.smallest() * 1e3,
             "");
  double largest = 0.0, at = 0.0;
  for (const Sieve &sieve : cut.sieves())
    if (const double difference = std::abs(pair.balls.passing(sieve.size) - sieve.passing);
        difference > largest) {
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
  line(bed_curve, grain_sizes(pair.balls), true);
  fmt::print(
      "largest difference of the bed from the cut curve at a sieve: {:.2f} % of the mass, at {:g} mm\n",
      largest * 100.0, at * 1e3);
}

std::vector<BedLayer> layers_of(const BedRequest &request) {
  std::vector<BedLayer> layers;
  for (const BedRequest::Layer &layer : request.layers)
    layers.push_back(layer.bed);
  return layers;
}

/// How a layer is poured, for the line about it.
std::string poured_words(const BedLayer &layer) {
  if (!layer.pouring) return {};
  const Pouring &poured = *layer.pouring;
  return fmt::format(
      ", at a relative density of {:g}: void ratio {:.3f} ({:.3f} loosest, {:.3f} shaken), "
      "poured with friction {:.3g} and rolling friction {:.3g}{}",
      poured.relative_density, poured.void_ratio, poured.loosest, poured.shaken, poured.friction,
      poured.rolling,
      poured.relative_density > 1.0 ? "; denser than shaking leaves it, so that it can only loosen" : "");
}

/// Number of balls that the bed is to have.
int wanted_balls(const BedRequest &request) {
  int balls = request.layers.empty() ? request.packing.balls : 0;
  for (const BedRequest::Layer &layer : request.layers)
    balls += layer.bed.packing.balls;
  return balls;
}

/// Packs the balls and writes the data file OUT.data that inputs/bed/in.settle reads. With a sieve curve it
/// also prints d10 to d60, C_u and C_c of the curve and of the balls, and draws both, a panel for each layer,
/// in OUT_grading.csv, .gp, .svg and .png. Throws UsageError for options that no packing fulfils and for a
/// file that cannot be written.
void write_bed(const BedRequest &request) {
  const fs::path &out = request.out;
  const fs::path folder = out.has_parent_path() ? out.parent_path() : ".";
  const bool has_grading =
      request.asked || std::any_of(request.layers.begin(), request.layers.end(),
                                   [](const BedRequest::Layer &layer) { return layer.asked.has_value(); });
  const fs::path gnuplot = has_grading ? find_gnuplot() : fs::path();
  const std::vector<BedLayer> layers = layers_of(request);
  Packing packing;
  try {
    TimedProgress progress;
    const auto tell = [&](std::size_t placed) {
      progress.tell("{} of {} balls placed", placed, wanted_balls(request));
    };
    packing = layers.empty() ? pack_balls(request.packing, tell) : pack_layers(layers, tell);
  } catch (const std::invalid_argument &fault) {
    throw UsageError(fmt::format("--{}", fault.what()));
  }
  const std::vector<GradingPair> gradings = grading_pairs(request, packing);
  const std::string figure = grading_figure(out);
  std::optional<FilesInProgress> files;
  try {
    if (out.has_parent_path()) make_parent_folder(out);
    if (has_grading) {
      files.emplace(folder);
      write_files({{*files / (figure + ".csv"), grading_csv(gradings)}});
    }
    write_files({{out, layers.empty() ? bed_data(request.packing, request.density, packing)
                                      : bed_data(layers, request.density, packing, request.spots)}});
  } catch (const std::runtime_error &fault) {
    throw UsageError(
        fmt::format("--out is '{}': {}; allowed: a file that can be written", out.string(), fault.what()));
  }
  fmt::print("{}: {} balls, filled to {:.3f} m\n", out.string(), packing.balls.size(), packing.height);
  for (std::size_t n = 0; n < layers.size(); ++n)
    fmt::print("Layer {}: {} balls, to be {:.3g} m thick when it has settled{}\n", n + 1,
               layers[n].packing.balls, layers[n].thickness, poured_words(layers[n]));
  if (!files) return;
  Figure drawn;
  drawn.name = figure;
  drawn.title = fmt::format("Grading of {}", out.string());
  for (const GradingPair &pair : gradings) {
    print_grading(pair);
    drawn.panels.push_back(grading_panel(figure, pair));
  }
  render(gnuplot, (*files / figure).parent_path(), drawn);
  files->publish(grading_files(out), [](const std::string &) { return false; });
  fmt::print("{}: the grading of the bed beside the one asked for\n",
             (folder / (figure + ".png")).lexically_normal().string());
}

void run(const BedArguments &arguments) {
  BedRequest request;
  PackingOptions &options = request.packing;
  options.balls = *arguments.balls;
  options.width = *arguments.width;
  options.depth = *arguments.depth;
  options.height = *arguments.height;
  options.radius_min = *arguments.radius_min;
  options.radius_max = *arguments.radius_max;
  options.seed = *arguments.seed;
  request.density = *arguments.density;
  request.out = *arguments.out;
  keep_curves(arguments, request.out);
  try {
    options.grading = grading_from_name(*arguments.grading);
    judge_sieve(arguments, request);
    judge_layers(arguments, request);
    judge_spots(arguments, request);
    pour_layers(arguments, request);
  } catch (const std::invalid_argument &fault) {
    throw UsageError(fmt::format("--{}", fault.what()));
  }
  write_bed(request);
}

} // namespace

void add_bed_command(CLI::App &app, Session &session) {
  add_command<BedArguments>(app, session, "bed",
                            "Soil balls at random in a box, none touching another, as the data file that "
                            "inputs/bed/in.settle reads. The same options give the same file on any machine.",
                            run);
}

} // namespace drumlin::post
