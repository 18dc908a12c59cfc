// The soil of a bed along its way: surfaces of its layers, solid fractions, profiles over depth.
#pragma once

#include "passes/drive.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace drumlin::post {

/// Vertical lines along the way, in the middles of equal intervals; in three dimensions as many rows of them
/// across the bed as the same spacing allows.
struct VerticalLines {
  double low = 0.0;     ///< m, where the first interval begins
  double spacing = 0.0; ///< m
  std::size_t count = 0;

  double at(std::size_t line) const { return low + (static_cast<double>(line) + 0.5) * spacing; }
};

/// The lines that lie in a box of soil, with a whole number of them on the measured part; `spacing` is fitted
/// to that. std::invalid_argument if they would be too many.
VerticalLines lines_over(const Drive &drive, double spacing);

/// A quarter of the radius of the smallest soil ball: the mean height is then right to 1e-2 of a radius.
double usual_spacing(const Drive &drive);

/// Heights of the surfaces of all layers on all lines, m above the floor at y = 0, by layer and line: the
/// highest point of the balls of this layer and of those below it; in three dimensions the mean across the
/// bed. As drumlin/surface in the decks, whose last layer is all of the soil.
using LayerTops = std::vector<std::vector<double>>;
LayerTops layer_tops(const Drive &drive, const DumpedBed &state, const VerticalLines &lines);

/// Mean over the lines of a part of the way; NaN without such lines.
double mean_over(const std::vector<double> &heights, const VerticalLines &lines, const WayPart &part);

/// The layers on a part of the way, the lowest first.
struct SoilLayers {
  double surface = 0.0;               ///< m, mean height
  std::vector<double> thickness;      ///< m, mean
  std::vector<double> solid_fraction; ///< volume (area) of its balls over that between its surfaces
  /// Volume (area) of balls in the inside of each layer, and of this: between the planes that are two mean
  /// diameters, at most a quarter of the thickness, away from the mean heights of its surfaces. As
  /// in.density measures the loosest and the densest packing, without the pores at surfaces.
  std::vector<double> inner_content, inner_space;

  double inner_solid_fraction(std::size_t layer) const { return inner_content[layer] / inner_space[layer]; }
};

/// Balls that reach over the ends of the part count with what lies inside, exactly; in the inside of a layer
/// a ball that is cut there counts with its share.
SoilLayers soil_on(const Drive &drive, const DumpedBed &state, const VerticalLines &lines,
                   const LayerTops &tops, const WayPart &part);

/// Gives a part of the way the inside of layers of its cells, each between planes of its own.
void take_inside(SoilLayers &whole, const std::vector<SoilLayers> &cells);

/// How much of a settlement is compaction, m: sum of h0 (1 - phi0/phi1) over the layers. What is left of the
/// settlement is soil that has left the part of the way, over the solid fraction of its layer.
double compaction_of(const SoilLayers &before, const SoilLayers &after);

/// The largest rise of the surface outside of the measured part, means over `length`, m; NaN without soil
/// there.
double heave_of(const std::vector<double> &before, const std::vector<double> &after,
                const VerticalLines &lines, const WayPart &measured, double length);

/// Means over the measured way in slices of one height.
struct DepthRow {
  double height = 0.0;         ///< m, of the middle above the floor
  double solid_fraction = 0.0; ///< -
  std::optional<double> coordination;
  std::optional<double> vertical, largest_vertical;     ///< Pa, compression positive
  std::optional<double> horizontal, largest_horizontal; ///< Pa
};

/// Slices from the floor to the surface and cells of about `cell` along the way, one and a half mean
/// diameters high; slices that lie wholly below the surface. Stresses are means over the way and over the
/// states, and the largest of all cells; without states with contacts they have no value.
/// \param loaded states from which the stresses are; empty: `state`
std::vector<DepthRow> depth_profile(const Drive &drive, const DumpedBed &state,
                                    const std::vector<DumpedBed> &loaded, double surface, double cell);

} // namespace drumlin::post
