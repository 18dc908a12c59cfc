#include "bed/packing.h"

#include "support/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

namespace {

/// Cells that the search for neighbours may have, 8 bytes each.
constexpr double most_cells = 5e7;
/// Cells and balls that may be looked at while the balls are placed: about an hour. Ten million balls at the
/// default share need a tenth.
constexpr double most_work = 1e11;
/// Height of the box above the soil balls, m: space for drum and frame.
constexpr double room_above = 2.0;
/// Drum and frame: a box cannot change its number of types later.
constexpr int roller_types = 2;
constexpr std::array<std::pair<Grading, const char *>, 2> gradings = {
    {{Grading::uniform, "uniform"}, {Grading::mass, "mass"}}};

/// Numbers from 0 to 1, 1 left out. The C++ standard prescribes the output of the random engine, but not that
/// of the distributions.
class Random {
public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  double operator()() { return static_cast<double>(bits_() >> 11U) * 0x1p-53; }
  double between(double low, double high) { return low + (*this)() * (high - low); }

private:
  std::mt19937_64 bits_;
};

/// Inverse of the distribution of radii. Mass goes with the area or the volume of a ball, so that the same
/// mass in equal intervals means a density of numbers ~ r^-2 or r^-3. Without pow(), only with operations
/// that IEEE 754 rounds correctly, so that all machines get the same bits.
double radius(const PackingOptions &options, double share) {
  const double low = options.radius_min;
  const double high = options.radius_max;
  if (options.grading == Grading::uniform) return low + share * (high - low);
  if (options.dimensions() == 2) return 1.0 / (1.0 / low - share * (1.0 / low - 1.0 / high));
  const double few = 1.0 / (low * low);
  return 1.0 / std::sqrt(few - share * (few - 1.0 / (high * high)));
}

/// Radii of all balls in the order in which they are placed.
std::vector<double> radii_of(const PackingOptions &options, Random &random) {
  const auto count = static_cast<std::size_t>(options.balls);
  std::vector<double> radii(count);
  if (!options.sieve) {
    for (double &r : radii)
      r = radius(options, random());
    return radii;
  }
  const BallNumbers numbers(*options.sieve, options.dimensions());
  for (std::size_t i = count; i-- > 0;) {
    const double share = (static_cast<double>(i) + random()) / static_cast<double>(count);
    const auto size = static_cast<double>(static_cast<float>(numbers.size(share)));
    radii[count - 1 - i] = std::clamp(0.5 * size, options.smallest_radius(),
                                      options.largest_radius()); // rounding may pass an end
  }
  return radii;
}

/// Balls by their size and the cell that holds their centre. Balls of one level are at most twice as large as
/// each other, and a cell of the level is as wide as the largest of them, so that a search looks at few
/// balls, whatever the grading.
class Cells {
public:
  /// \param most about the number of cells of a level, which smaller balls share
  Cells(const std::array<double, 3> &size, double largest, double smallest, double most) {
    for (double radius = largest;; radius *= 0.5) {
      Level level{2.0 * radius, {}, {}};
      double cells = 1.0;
      for (std::size_t a = 0; a < 3; ++a) {
        level.count[a] = static_cast<long>(size[a] / level.width) + 1;
        cells *= static_cast<double>(level.count[a]);
      }
      if (!levels_.empty() && cells > most) return;
      level.first.assign(static_cast<std::size_t>(cells), -1);
      levels_.push_back(std::move(level));
      if (radius * 0.5 < smallest) return;
    }
  }

  void add(const std::vector<PackedBall> &balls) {
    const PackedBall &ball = balls.back();
    auto level = levels_.begin();
    while (std::next(level) != levels_.end() && ball.radius <= 0.5 * std::next(level)->width)
      ++level;
    level->is_empty = false;
    long &first = level->first[level->index(level->place(ball.centre, 0.0))];
    next_.push_back(std::exchange(first, static_cast<long>(balls.size()) - 1));
  }

  bool is_free(const PackedBall &ball, const std::vector<PackedBall> &balls) {
    return std::none_of(levels_.begin(), levels_.end(),
                        [&](const Level &level) { return !level.is_empty && touches(level, ball, balls); });
  }

  /// Cells and balls that all searches have looked at.
  double work() const { return work_; }

private:
  struct Level {
    double width; ///< of a cell, m: no ball of the level is larger
    std::array<long, 3> count;
    std::vector<long> first; ///< ball of each cell, the first of a chain; -1: none
    bool is_empty = true;

    std::array<long, 3> place(const std::array<double, 3> &centre, double shift) const {
      std::array<long, 3> at{};
      for (std::size_t a = 0; a < 3; ++a)
        at[a] = std::clamp(static_cast<long>((centre[a] + shift) / width), 0L, count[a] - 1);
      return at;
    }
    std::size_t index(const std::array<long, 3> &at) const {
      return static_cast<std::size_t>((at[0] * count[1] + at[1]) * count[2] + at[2]);
    }
  };

  bool touches(const Level &level, const PackedBall &ball, const std::vector<PackedBall> &balls) {
    constexpr double and_rounding = 1.0 + 1e-9;
    const double reach = (ball.radius + 0.5 * level.width) * and_rounding;
    const std::array<long, 3> from = level.place(ball.centre, -reach), to = level.place(ball.centre, reach);
    for (long i = from[0]; i <= to[0]; ++i)
      for (long j = from[1]; j <= to[1]; ++j)
        for (long k = from[2]; k <= to[2]; ++k, ++work_)
          for (long n = level.first[level.index({i, j, k})]; n >= 0;
               n = next_[static_cast<std::size_t>(n)], ++work_)
            if (touch(ball, balls[static_cast<std::size_t>(n)])) return true;
    return false;
  }

  static bool touch(const PackedBall &a, const PackedBall &b) {
    const double x = a.centre[0] - b.centre[0];
    const double y = a.centre[1] - b.centre[1];
    const double z = a.centre[2] - b.centre[2];
    const double reach = a.radius + b.radius;
    return x * x + y * y + z * z <= reach * reach;
  }

  std::vector<Level> levels_; ///< the largest balls first
  std::vector<long> next_;    ///< of each ball, the next of its chain; -1: none
  double work_ = 0.0;
};

/// Area of a disc or volume of a ball, m2 or m3.
double content(double radius, int dimensions) {
  return dimensions == 2 ? pi * radius * radius : 4.0 / 3.0 * pi * radius * radius * radius;
}

} // namespace

std::string grading_name(Grading grading) {
  return std::find_if(gradings.begin(), gradings.end(),
                      [grading](const auto &g) { return g.first == grading; })
      ->second;
}

Grading grading_from_name(const std::string &name) {
  for (const auto &[grading, known] : gradings)
    if (name == known) return grading;
  throw std::invalid_argument(refusal("grading", name, "uniform, mass"));
}

double settled_share(int dimensions) { return dimensions == 2 ? 0.825 : 0.6; }
double largest_share(int dimensions) { return dimensions == 2 ? 0.5 : 0.34; }
double default_share(int dimensions) { return dimensions == 2 ? 0.45 : 0.28; }

std::string PackingOptions::invalid() const {
  if (balls < 1 || balls > most_balls)
    return refusal("balls", balls, fmt::format("a whole number from 1 to {}", most_balls));
  if (!sieve && !radius_range.holds(radius_min))
    return refusal("radius-min", radius_min, radius_range.words());
  if (!sieve &&
      !(radius_max >= radius_min && radius_max <= most_spread * radius_min && radius_range.holds(radius_max)))
    return refusal(
        "radius-max", radius_max,
        fmt::format("a number from radius-min, which is {}, to {:g} times it [m]", radius_min, most_spread));
  const Range room = {2.0 * largest_radius(), length_range.most, "m"};
  const Range or_zero = {2.0 * largest_radius(), length_range.most, "m", true};
  if (!room.holds(width)) return refusal("width", width, room.words() + ": room for the largest ball");
  if (!or_zero.holds(depth))
    return refusal("depth", depth,
                   or_zero.words() + ": 0 makes two dimensions, else room for the largest ball");
  if (!or_zero.holds(height))
    return refusal("height", height, or_zero.words() + ": 0 is as needed, else room for the largest ball");
  return {};
}

namespace {

/// Length, or area in three dimensions, that balls can fill at the bottom of the box: less than all of it,
/// since a strip along the walls is filled less. m or m2
double free_base(const PackingOptions &options) {
  const double strip = options.largest_radius();
  return (options.width - strip) * (options.dimensions() == 2 ? 1.0 : options.depth - strip);
}

/// The height that balls of the given content (volume, area in two dimensions) fill: the one that was asked
/// for, if they fit, or as much as they need. std::invalid_argument if they do not fit.
double filled_height(const PackingOptions &options, double content_of_all) {
  const int dimensions = options.dimensions();
  if (options.height == 0.0) {
    const double strip = options.largest_radius();
    return std::max(content_of_all / (free_base(options) * default_share(dimensions)) + strip, 2.0 * strip);
  }
  const double base = options.width * (dimensions == 2 ? 1.0 : options.depth);
  const double least = content_of_all / (base * largest_share(dimensions));
  if (options.height < least)
    throw std::invalid_argument(
        refusal("height", options.height,
                fmt::format("0 (as needed) or at least {:.3f} [m], in which {} balls of radius {} to {} m "
                            "fit without touching",
                            least, options.balls, options.smallest_radius(), options.largest_radius())));
  return options.height;
}

/// Refuses, before any work, boxes of too many cells. std::invalid_argument
void check_cells(const PackingOptions &options, double height) {
  const double side = 2.0 * options.largest_radius();
  const double cell_number =
      (options.width / side + 1.0) * (options.depth / side + 1.0) * (height / side + 1.0);
  if (cell_number > most_cells)
    throw std::invalid_argument(
        refusal(options.height > options.width ? "height" : "width", std::max(options.height, options.width),
                fmt::format("a box of at most {:g} times the largest ball's volume (area in two dimensions)",
                            most_cells)));
}

} // namespace

namespace {

/// Area, m2, of a disc of mean mass, or volume, m3, of such a sphere.
double mean_content(const PackingOptions &options) {
  const int dimensions = options.dimensions();
  if (options.sieve) return content(0.5, dimensions) * BallNumbers(*options.sieve, dimensions).mean_power();
  const double low = options.radius_min, high = options.radius_max;
  const double squares = low * low + high * high;
  if (options.grading == Grading::uniform)
    return dimensions == 2 ? pi * (squares + low * high) / 3.0
                           : 4.0 / 3.0 * pi * 0.25 * (low + high) * squares;
  return dimensions == 2 ? pi * low * high : 4.0 / 3.0 * pi * 2.0 * low * low * high * high / (low + high);
}

/// Area, m2, or volume, m3, that the balls of a layer take of its settled thickness: without the voids.
double settled_content(const BedLayer &layer) {
  const PackingOptions &options = layer.packing;
  const double base = options.width * (options.dimensions() == 2 ? 1.0 : options.depth);
  return base * layer.thickness *
         (layer.pouring ? layer.pouring->solid_fraction() : settled_share(options.dimensions()));
}

/// The size at which the curve must be cut so that options.balls balls have a content. \param height m, for
/// the error
double cut_for(const SieveCurve &curve, const PackingOptions &options, double wanted, double height) {
  const int dimensions = options.dimensions();
  const auto number_for = [&](double size) {
    const double mean = BallNumbers(curve.coarser_than(size), dimensions).mean_power();
    const double of_one = content(0.5, dimensions) * mean; // content goes with the power of the size
    return wanted / of_one;
  };
  double low = std::max(curve.smallest(), curve.largest() / PackingOptions::most_spread);
  double high = 0.5 * curve.largest();
  if (low >= high || number_for(low) <= options.balls) return low;
  if (const double least = std::ceil(number_for(high)); least > options.balls)
    throw std::invalid_argument(
        refusal("balls", options.balls,
                fmt::format("at least {:.0f}, so that grains from {:g} to {:g} mm fill the box to a height "
                            "of {:g} m; or a larger smallest size",
                            least, high * 1e3, curve.largest() * 1e3, height)));
  while (high / low > 1.0 + 1e-6) {
    const double middle = std::sqrt(low * high);
    (number_for(middle) > options.balls ? low : high) = middle;
  }
  const double digit = std::pow(10.0, std::floor(std::log10(high)) - 2.0);
  return std::ceil(high / digit) * digit;
}

PackingOptions checked_with(const SieveCurve &curve, const PackingOptions &options) {
  PackingOptions with_curve = options;
  with_curve.sieve = curve; // for the size of the largest ball
  if (const std::string fault = with_curve.invalid(); !fault.empty()) throw std::invalid_argument(fault);
  return with_curve;
}

} // namespace

double default_cut(const SieveCurve &curve, const PackingOptions &options) {
  const PackingOptions whole = checked_with(curve, options);
  const double height = options.height > 0.0 ? options.height : 0.5 * options.width;
  const double wanted = free_base(whole) * std::max(height - whole.largest_radius(), whole.largest_radius()) *
                        default_share(options.dimensions());
  return cut_for(curve, options, wanted, height);
}

namespace {

std::string name_of_grading(const PackingOptions &options) {
  return options.sieve ? fmt::format("{}_from_{:g}mm", options.sieve_name, options.sieve->smallest() * 1e3)
                       : grading_name(options.grading);
}

} // namespace

void note_balls(MeasuredPackings &packings, const PackingOptions &box) {
  const double low = box.smallest_radius(), high = box.largest_radius();
  packings.dimensions = box.dimensions();
  packings.spread = (high - low) / (high + low);
  packings.grading = name_of_grading(box);
  packings.d50_over_smallest = box.sieve ? grain_sizes(*box.sieve).d50 / box.sieve->smallest() : 0.0;
}

std::string other_balls(const MeasuredPackings &packings, const PackingOptions &box) {
  MeasuredPackings wanted = packings;
  note_balls(wanted, box);
  constexpr double rounding = 1e-4; // of numbers with a few digits
  const auto equal = [](double a, double b) { return std::abs(a - b) <= rounding * std::abs(b); };
  const auto ratio = [](const MeasuredPackings &of) { return (1.0 + of.spread) / (1.0 - of.spread); };
  if (wanted.grading == packings.grading && packings.dimensions == box.dimensions() &&
      equal(ratio(packings), ratio(wanted)) && equal(packings.d50_over_smallest, wanted.d50_over_smallest))
    return {};
  const auto balls = [&](const MeasuredPackings &of) {
    std::string text = fmt::format("{} with radii from r to {:.4g} r, grading {}",
                                   of.dimensions == 2 ? "discs" : "spheres", ratio(of), of.grading);
    if (of.d50_over_smallest > 0.0)
      text += fmt::format(" with d50 {:.4g} times the smallest size", of.d50_over_smallest);
    return text;
  };
  return fmt::format("packings of {}; it has those of {}", balls(wanted), balls(packings));
}

std::string BedLayer::invalid() const {
  const Range range = {2.0 * packing.largest_radius(), PackingOptions::length_range.most, "m"};
  if (range.holds(thickness)) return {};
  return refusal("layer", thickness, range.words() + ": at least as thick as its largest ball");
}

int balls_of(const BedLayer &layer) {
  const double number = std::round(settled_content(layer) / mean_content(layer.packing));
  return static_cast<int>(std::clamp(number, 1.0, PackingOptions::most_balls + 1.0));
}

double default_cut_of_layer(const SieveCurve &curve, const BedLayer &layer) {
  const BedLayer whole = {checked_with(curve, layer.packing), layer.thickness, layer.pouring};
  if (const std::string fault = whole.invalid(); !fault.empty()) throw std::invalid_argument(fault);
  return cut_for(curve, layer.packing, settled_content(layer), layer.thickness);
}

Packing pack_balls(const PackingOptions &options, const std::function<void(std::size_t)> &progress,
                   int attempts) {
  if (const std::string fault = options.invalid(); !fault.empty()) throw std::invalid_argument(fault);
  const int dimensions = options.dimensions();
  Random random(options.seed);

  const std::vector<double> radii = radii_of(options, random);
  double all = 0.0;
  for (const double r : radii)
    all += content(r, dimensions);
  const double height = filled_height(options, all);
  check_cells(options, height);

  std::vector<PackedBall> balls;
  balls.reserve(radii.size());
  std::size_t all_tries = 0;
  Cells cells({options.width, options.depth, height}, options.largest_radius(), options.smallest_radius(),
              2.0 * static_cast<double>(options.balls));
  for (const double r : radii) {
    PackedBall ball{{}, r};
    int failed = 0;
    do {
      constexpr std::size_t now_and_then = 4096;
      if (progress && ++all_tries % now_and_then == 0) progress(balls.size());
      if (++failed > attempts)
        throw std::invalid_argument(
            refusal("balls", options.balls,
                    fmt::format("fewer balls, or a wider or higher box (width {}, height {:.3f} m): {} found "
                                "a place and the next none in {} tries",
                                options.width, height, balls.size(), attempts)));
      if (cells.work() > most_work)
        throw std::invalid_argument(
            refusal("balls", options.balls,
                    fmt::format("fewer balls, or a wider or higher box (width {}, height {:.3f} m): {} found "
                                "a place before the search took too long",
                                options.width, height, balls.size())));
      ball.centre[0] = random.between(r, options.width - r);
      if (dimensions == 3) ball.centre[1] = random.between(r, options.depth - r);
      ball.centre[2] = random.between(r, height - r);
    } while (!cells.is_free(ball, balls));
    balls.push_back(ball);
    cells.add(balls);
  }
  return {std::move(balls), height};
}

Packing pack_layers(const std::vector<BedLayer> &layers, const std::function<void(std::size_t)> &progress) {
  Packing all = {{}, 0.0};
  for (std::size_t n = 0; n < layers.size(); ++n) {
    if (const std::string fault = layers[n].invalid(); !fault.empty()) throw std::invalid_argument(fault);
    PackingOptions options = layers[n].packing;
    constexpr std::uint64_t apart = 0x9e3779b97f4a7c15; // seeds of layers far from those of other beds
    options.seed += n * apart;
    const std::size_t placed_before = all.balls.size();
    const Packing layer = pack_balls(options, [&](std::size_t placed) {
      if (progress) progress(placed_before + placed);
    });
    for (PackedBall ball : layer.balls) {
      ball.centre[2] += all.height;
      ball.layer = static_cast<int>(n);
      all.balls.push_back(ball);
    }
    all.height += layer.height;
  }
  return all;
}

namespace {

/// Sizes of the balls for which take(ball) holds.
template <class Take>
Sieving sieved_if(const Packing &packing, int dimensions, const Take &take) {
  std::vector<double> sizes;
  sizes.reserve(packing.balls.size());
  for (const PackedBall &ball : packing.balls)
    if (take(ball)) sizes.push_back(2.0 * ball.radius);
  return {std::move(sizes), dimensions};
}

/// Type of the balls of a layer in the engine: 1, then 4, 5, ...
int type_of(int layer) { return layer == 0 ? 1 : layer + 1 + roller_types; }

/// One of the numbers of Pouring for each layer, separated by commas, the lowest layer first.
std::string poured_list(const std::vector<BedLayer> &layers, double Pouring::*number, int digits = 6) {
  std::string list;
  for (const BedLayer &layer : layers)
    list += fmt::format("{}{:.{}g}", list.empty() ? "" : ",", (*layer.pouring).*number, digits);
  return list;
}

/// What the header notes of layers of a wanted density. A spot is poured as the lowest layer.
std::string poured_notes(const std::vector<BedLayer> &layers, std::size_t spots) {
  if (std::any_of(layers.begin(), layers.end(), [](const BedLayer &layer) { return !layer.pouring; }))
    return {};
  std::string notes;
  for (const auto &[name, number] :
       {std::pair{"relative_density", &Pouring::relative_density}, std::pair{"e_loosest", &Pouring::loosest},
        std::pair{"e_shaken", &Pouring::shaken}})
    notes += fmt::format("# drumlin note {} {}\n", name, poured_list(layers, number));
  std::vector<BedLayer> poured = layers;
  poured.insert(poured.end(), spots, layers.front());
  for (const auto &[name, number] :
       {std::pair{"pour_friction", &Pouring::friction}, std::pair{"pour_rolling", &Pouring::rolling}})
    notes += fmt::format("# drumlin note {} {}\n", name, poured_list(poured, number));
  constexpr int all_digits = 15; // in.settle compares these
  for (const auto &[name, number] : {std::pair{"packings_friction", &Pouring::soil_friction},
                                     std::pair{"packings_rolling", &Pouring::soil_rolling}})
    notes += fmt::format("# drumlin note {} {}\n", name, poured_list(poured, number, all_digits));
  return notes;
}

/// \param parts the options of each layer, which have the same box
/// \param more further comment lines of the file's header: what is noted of the layers
std::string data_text(const std::vector<PackingOptions> &parts, const std::string &more, double density,
                      const Packing &packing, const std::vector<Spot> &spots = {}) {
  const PackingOptions &options = parts.front();
  const bool flat = options.dimensions() == 2;
  std::string grading;
  double smallest = options.smallest_radius(), largest = options.largest_radius();
  for (const PackingOptions &part : parts) {
    grading += (grading.empty() ? "" : "+") + name_of_grading(part);
    smallest = std::min(smallest, part.smallest_radius());
    largest = std::max(largest, part.largest_radius());
  }
  const double depth = flat ? 2.0 * largest : options.depth;
  const double top = packing.height + room_above;
  std::string text = fmt::format("# {} balls at random: radius {} to {} m, grading {}, {} m wide, {} m deep, "
                                 "filled to {} m, seed {} (drumlin bed)\n",
                                 packing.balls.size(), smallest, largest, grading, options.width,
                                 options.depth, packing.height, options.seed);
  auto out = std::back_inserter(text);
  std::string medians, uniformities; // of each layer
  for (std::size_t n = 0; n < parts.size(); ++n) {
    const GrainSizes sizes = grain_sizes(sieved_layer(packing, options.dimensions(), static_cast<int>(n)));
    medians += fmt::format("{}{}", n == 0 ? "" : ",", sizes.d50);
    uniformities += fmt::format("{}{}", n == 0 ? "" : ",", sizes.uniformity());
  }
  // drumlin/take of in.settle reads these lines.
  fmt::format_to(out,
                 "# drumlin note seed {}\n# drumlin note grading {}\n# drumlin note r_min {}\n"
                 "# drumlin note r_max {}\n# drumlin note d50 {}\n# drumlin note C_u {}\n",
                 options.seed, grading, smallest, largest, medians, uniformities);
  text += more;
  fmt::format_to(out, "\n{} atoms\n{} atom types\n\n", packing.balls.size(),
                 parts.size() + spots.size() + roller_types);
  fmt::format_to(out, "{:.17g} {:.17g} xlo xhi\n0 {:.17g} ylo yhi\n{:.17g} {:.17g} zlo zhi\n",
                 -0.5 * options.width, 0.5 * options.width, top, -0.5 * depth, 0.5 * depth);
  fmt::format_to(out, "\nAtoms\n\n"); // ID, type, diameter, density, x, y, z
  std::size_t id = 0;
  for (const PackedBall &ball : packing.balls) {
    const double x = ball.centre[0] - 0.5 * options.width;
    const auto spot = std::find_if(spots.begin(), spots.end(),
                                   [x](const Spot &one) { return one.from <= x && x <= one.to; });
    const int soil = ball.layer == 0 && spot != spots.end()
                         ? static_cast<int>(parts.size()) + static_cast<int>(spot - spots.begin())
                         : ball.layer;
    fmt::format_to(out, "{} {} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", ++id, type_of(soil),
                   2.0 * ball.radius, density, x, ball.centre[2], flat ? 0.0 : ball.centre[1] - 0.5 * depth);
  }
  return text;
}

} // namespace

Sieving sieved(const Packing &packing, int dimensions) {
  return sieved_if(packing, dimensions, [](const PackedBall &) { return true; });
}

Sieving sieved_layer(const Packing &packing, int dimensions, int layer) {
  return sieved_if(packing, dimensions, [layer](const PackedBall &ball) { return ball.layer == layer; });
}

std::string bed_data(const PackingOptions &options, double density, const Packing &packing) {
  return data_text({options}, "", density, packing);
}

std::string bed_data(const std::vector<BedLayer> &layers, double density, const Packing &packing,
                     const std::vector<Spot> &spots) {
  std::vector<PackingOptions> parts;
  std::string thicknesses, places;
  for (const BedLayer &layer : layers) {
    parts.push_back(layer.packing);
    thicknesses += fmt::format("{}{}", thicknesses.empty() ? "" : ",", layer.thickness);
  }
  for (const Spot &spot : spots)
    places += fmt::format("{}{}:{}", places.empty() ? "" : ",", spot.from, spot.to);
  return data_text(parts,
                   fmt::format("# drumlin note layers {}\n# drumlin note layer_thicknesses {}\n",
                               layers.size(), thicknesses) +
                       (spots.empty() ? "" : fmt::format("# drumlin note spots {}\n", places)) +
                       poured_notes(layers, spots.size()),
                   density, packing, spots);
}

SieveCurve KnownGrading::curve() const {
  std::vector<Sieve> sieves;
  for (const SieveLimits &at : limits)
    sieves.push_back({at.size * 1e-3, 0.5 * (at.lower + at.upper) / 100.0});
  return SieveCurve(std::move(sieves));
}

const std::vector<KnownGrading> &known_gradings() {
  static const std::vector<KnownGrading> gradings = {
      {"M147-B",
       "soil-aggregate for base courses, 0 to 50 mm",
       "AASHTO M 147, Table 1, grading B, as a laboratory's form for sieve analyses has it (weight sieve "
       "bands, AASHTO_M147_B)",
       {{0.075, 5, 20},
        {0.425, 15, 30},
        {2, 20, 45},
        {4.75, 30, 60},
        {9.5, 40, 75},
        {25, 75, 95},
        {50, 100, 100}}},
      {"PM1-20",
       "crushed rock for base courses, 0 to 26.5 mm",
       "South Australia, Part 215, PM1/20, as sustainableaggregates.com.au/spec_compliance.php has it (its "
       "sieves 0.43 and 0.08 mm are those of 0.425 and 0.075 mm)",
       {{0.075, 5, 11},
        {0.425, 13, 23},
        {2.36, 29, 49},
        {4.75, 44, 64},
        {9.5, 63, 83},
        {13.2, 77, 93},
        {19, 95, 100},
        {26.5, 100, 100}}},
      {"WMM",
       "wet mix macadam, crushed stone for base courses, 0 to 53 mm",
       "India, MoRTH specifications, fifth revision, Table 400-13, as "
       "constructionblogs.in/wet-mix-macadam-wmm has it; an earlier edition has 0 to 8 % at 0.075 mm",
       {{0.075, 0, 5},
        {0.6, 8, 22},
        {2.36, 15, 30},
        {4.75, 25, 40},
        {11.2, 40, 60},
        {22.4, 60, 80},
        {45, 95, 100},
        {53, 100, 100}}},
  };
  return gradings;
}

const KnownGrading *find_grading(const std::string &name) {
  const std::vector<KnownGrading> &all = known_gradings();
  const auto found =
      std::find_if(all.begin(), all.end(), [&name](const KnownGrading &g) { return name == g.name; });
  return found == all.end() ? nullptr : &*found;
}

std::string grading_names() {
  std::string names;
  for (const KnownGrading &grading : known_gradings())
    names += (names.empty() ? "" : ", ") + std::string(grading.name);
  return names;
}

} // namespace drumlin::post
