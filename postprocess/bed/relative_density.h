// Relative density: how densely a soil is packed, between the loosest and the densest packing of its mix, on
// the scale of a laboratory: loosest by pouring, densest by shaking.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace drumlin::post {

/// D_r = (e_loosest - e)/(e_loosest - e_shaken), of void ratios e: volume (in two dimensions area) of voids
/// over that of balls. 0: as loose as pouring makes soil; 1: as dense as shaking does.
double relative_density(double void_ratio, double loosest, double shaken);

/// How a layer is poured so that it gets a wanted density.
struct Pouring {
  double relative_density;
  double friction, rolling;           ///< of the balls while they are poured and come to rest
  double void_ratio;                  ///< that they have then
  double loosest, shaken;             ///< void ratios of their mix
  double soil_friction, soil_rolling; ///< of the soil that has these void ratios, once it lies

  double solid_fraction() const { return 1.0 / (1.0 + void_ratio); }
};

/// Friction and rolling friction of the balls of a soil, once it lies.
struct SoilFriction {
  double friction = 0.8, rolling = 0.45; ///< those of case base and case gravel
};

/// The packings of a mix that inputs/soil/in.density has measured, or `drumlin bed` with
/// inputs/bed/in.settle: poured ones, of which that without friction is denser than any soil, and one that
/// was shaken.
class MeasuredPackings {
public:
  struct Row {
    double share;             ///< of the soil's friction and rolling friction
    double friction, rolling; ///< of the balls while they were poured
    double void_ratio;
  };
  /// \param poured those of the shares 0 and 1 among them, that of 1 looser than that of 0. One packing is
  /// one sample: a void ratio that is below that of a smaller share, or above that of the loosest packing,
  /// counts as equal to it. \param shaken void ratio of the shaken packing, below that of the loosest Throws
  /// std::invalid_argument for others.
  MeasuredPackings(std::vector<Row> poured, double shaken);

  int dimensions = 2;  ///< of the samples
  double spread = 0.0; ///< radii were between 1 - spread and 1 + spread times the mean of both limits
  std::string grading = "uniform"; ///< every radius as often as any other; else the name of a distribution
  double d50_over_smallest = 0.0;  ///< of such a distribution
  bool estimated = false;          ///< shaken() is estimated from another mix

  const std::vector<Row> &poured() const { return poured_; } ///< in the order of shares, from 0
  double loosest() const { return poured_.back().void_ratio; }
  double shaken() const { return shaken_; }
  const Row &of_loosest() const { return poured_.back(); }
  const Row &frictionless() const { return poured_.front(); }
  /// The largest relative density that can be poured: that of the packing without friction.
  double most() const;
  /// Friction and rolling friction by linear interpolation over the void ratio. \param relative from 0 to
  /// most()
  Pouring pouring(double relative) const;

private:
  std::vector<Row> poured_;
  double shaken_;
};

/// The scale of relative density in a layer of a bed: void ratios of the loosest and the shaken packing of
/// its soil.
struct LayerPackings {
  double top; ///< m, height of the layer's surface
  double loosest, shaken;

  double relative_density(double solid_fraction) const;
  /// Degree of compaction, density over that of the shaken packing.
  double compaction(double solid_fraction) const { return solid_fraction * (1.0 + shaken); }
};

/// The same of all layers of a bed, the lowest first, from the parameters of its run; empty if they are not
/// known. std::runtime_error for parameters that no deck writes.
std::vector<LayerPackings> noted_packings(const std::map<std::string, std::string> &parameters);
/// The layer at a height; that above all layers is the highest one.
const LayerPackings &layer_at(const std::vector<LayerPackings> &layers, double height);

/// The table of packings as text: what read_packings() reads.
std::string packings_csv(const MeasuredPackings &packings);
/// Reads a table of packings: one of packings_csv(), or density.csv of inputs/soil/in.density. Throws
/// std::runtime_error for any other file, and for a table that does not tell the sizes of its balls or has no
/// shaken packing.
MeasuredPackings read_packings(const std::filesystem::path &file);
/// The stored packings of case gravel, which are those of case base, too.
MeasuredPackings packings_of_gravel(int dimensions);

/// The largest solid fraction that shaking leaves of a layer's soil, which can only loosen if it is denser:
/// as its run notes, else that of case gravel. \param flat true: discs in the plane; false: spheres
double densest_by_shaking(const std::map<std::string, std::string> &parameters, std::size_t layer, bool flat);

} // namespace drumlin::post
