// Soil balls placed at random in a box, none touching another: the loose initial state, from which the bed
// settles; and the gradings of base courses that have a name.
#pragma once

#include "bed/relative_density.h"
#include "bed/sieve_curve.h"
#include "support/units.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// Distribution of the radii between the smallest and the largest.
enum class Grading {
  uniform, ///< every radius as often as any other
  mass     ///< the same mass of balls in equal intervals of radius
};

std::string grading_name(Grading grading);
/// From "uniform" or "mass"; else std::invalid_argument.
Grading grading_from_name(const std::string &name);

struct PackingOptions {
  int balls = 2500;          ///< >= 1
  double width = 2.0;        ///< m, > 0, of the box, wall to wall
  double depth = 0.0;        ///< m, along the axis of the drum; 0: two dimensions, the balls are discs
  double height = 0.0;       ///< m, of the part of the box that is filled; 0: as default_share() gives it
  double radius_min = 0.016; ///< m, > 0
  double radius_max = 0.024; ///< m, >= radius_min
  std::uint64_t seed = 1;
  Grading grading = Grading::uniform;
  std::optional<SieveCurve> sieve; ///< instead of radii and grading, which then do not count: no mass passes
                                   ///< its smallest sieve
  std::string sieve_name = {};     ///< of the sieve curve, one word

  static constexpr int most_balls = 10'000'000;
  static constexpr Range radius_range = {1e-6, 1e3, "m"};
  static constexpr Range length_range = {1e-6, 1e5, "m"}; ///< of the sides of the box
  static constexpr double most_spread = 1000.0;           ///< of the largest radius over the smallest

  int dimensions() const { return depth > 0.0 ? 3 : 2; }
  double smallest_radius() const { return sieve ? 0.5 * sieve->smallest() : radius_min; }
  double largest_radius() const { return sieve ? 0.5 * sieve->largest() : radius_max; }
  /// Empty if every value is allowed, else what is wrong: name, value, what is allowed.
  std::string invalid() const;
};

/// The largest share of area (or volume) that balls may take of the box. Balls of one size placed at random
/// one after the other, and not moved, leave no space for another one at a share of 0.547 in two dimensions
/// and near 0.38 in three (Feder 1980, J. Theor. Biol. 87, 237-254); near this share the number of attempts
/// per ball grows without bound. Such a bed is far looser than any gravel: it becomes a packing only when it
/// settles.
double largest_share(int dimensions);
/// The share from which the filled height is computed by default; each ball then needs a few attempts.
double default_share(int dimensions);

/// The size, m, rounded up to three digits, at which `curve` must be cut so that options.balls balls of what
/// is coarser fill the box to options.height, or to half its width if that is 0; the smallest sieve if they
/// do so without a cut. Throws std::invalid_argument as pack_balls() does if the balls are so few that the
/// cut would be above half of the largest size: hardly a distribution is left of the curve then.
double default_cut(const SieveCurve &curve, const PackingOptions &options);

/// Says of packings that they are of balls as in this box.
void note_balls(MeasuredPackings &packings, const PackingOptions &box);
/// Empty if packings were measured of balls like these; else of which, and of which they should be.
std::string other_balls(const MeasuredPackings &packings, const PackingOptions &box);

/// A layer of a bed of several, whose balls fall on the layers below when these have come to rest.
struct BedLayer {
  PackingOptions packing;
  double thickness;                    ///< m, wanted after it has settled
  std::optional<Pouring> pouring = {}; ///< for a wanted density; nothing: as in.settle pours by default

  /// Empty if the thickness is allowed, else what is wrong: name, value, what is allowed.
  std::string invalid() const;
};

/// The share of area (or volume) that balls of case gravel take of a bed when they have settled, as measured
/// (inputs/study/grading). Other friction and other gradings change it by 4 % at most.
double settled_share(int dimensions);

/// The number of balls that make a layer of its thickness. At least 1; more than PackingOptions::most_balls
/// are that number plus one.
int balls_of(const BedLayer &layer);

/// The size, m, at which `curve` must be cut so that `balls` balls of what is coarser make the layer; see
/// default_cut().
double default_cut_of_layer(const SieveCurve &curve, const BedLayer &layer);

struct PackedBall {
  std::array<double, 3> centre; ///< m: across, along the drum's axis (0 in two dimensions), up from the floor
  double radius;                ///< m
  int layer = 0;                ///< from 0, the lowest
};

struct Packing {
  std::vector<PackedBall> balls;
  double height; ///< m, of the filled part
};

/// Places the balls. With a sieve curve ball i of N, in the order of size, has a size at random between those
/// that the shares i/N and (i+1)/N of all balls do not exceed, so that the mass of all balls that are finer
/// than any size differs from the curve's by less than two balls of this size; the largest ball is placed
/// first, since it would find no space between the others. The same options give the same balls, bit for bit,
/// on any machine: the random numbers are computed without rounding errors, and sizes from a sieve curve are
/// rounded to single precision, so that the last digits of log() and cbrt(), which differ between machines,
/// do not reach them.
/// \param progress is called every few thousand tries with the number of balls placed Throws
/// std::invalid_argument with what() naming the option, its value and what is allowed: before any ball is
/// placed if their area or volume is more than largest_share() of the box, else when no free position was
/// found for a ball in `attempts` tries.
Packing pack_balls(const PackingOptions &options, const std::function<void(std::size_t)> &progress = {},
                   int attempts = 100'000);

/// Layers one above the other as they are before they settle, the first the lowest; each of its own options,
/// which have the same box.
Packing pack_layers(const std::vector<BedLayer> &layers,
                    const std::function<void(std::size_t)> &progress = {});

/// A part of the lowest layer along the way, whose balls have contacts of their own.
struct Spot {
  double from, to; ///< m from the middle of the box
};

/// The text of the data file for the engine's read_data: balls of type 1 (types 2 and 3 are drum and frame),
/// and of type 4, 5, ... for the second and further layers, in a box with space for the roller above them. y
/// is up; x = 0 and z = 0 are the middle. Density of a ball in kg/m3, of a disc 1 m thick. The header notes
/// for later decks: the grading as one word, the radii of the smallest and largest ball, m, d50, m, and C_u.
std::string bed_data(const PackingOptions &options, double density, const Packing &packing);
/// The same for a bed of layers. Of the notes the grading is that of each layer, the lowest first, joined by
/// +, d50 and C_u are those of each layer, separated by commas, and the radii are of all balls; the number of
/// layers and their thicknesses are noted, too, and, if all have a wanted density, their relative densities,
/// the void ratios of their loosest and shaken packings, and how they are poured. Balls of spots have the
/// types behind those of the layers.
std::string bed_data(const std::vector<BedLayer> &layers, double density, const Packing &packing,
                     const std::vector<Spot> &spots = {});

/// The balls of a packing sorted by size.
Sieving sieved(const Packing &packing, int dimensions);
/// The balls of one layer before it settles.
Sieving sieved_layer(const Packing &packing, int dimensions, int layer);

/// Limits for the share of the mass that passes a sieve.
struct SieveLimits {
  double size;         ///< mm
  double lower, upper; ///< %
};

/// A grading that a specification describes.
struct KnownGrading {
  const char *name;
  const char *what;   ///< material and range of sizes
  const char *source; ///< specification, and where its numbers were read
  std::vector<SieveLimits> limits;

  /// The mean of the limits at each sieve.
  SieveCurve curve() const;
};

/// All of them.
const std::vector<KnownGrading> &known_gradings();
/// The one of this name; nullptr if there is none.
const KnownGrading *find_grading(const std::string &name);
/// Their names, separated by commas.
std::string grading_names();

} // namespace drumlin::post
