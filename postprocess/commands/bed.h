// `drumlin bed`: soil balls at random, from which a bed is made.
#pragma once

#include "bed/packing.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace drumlin::post {

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

/// Packs the balls, writes the data file that inputs/bed/in.settle reads, and prints one line about it. With
/// a grading that was asked for it also prints a table of d10 to d60, C_u and C_c, and draws the grading of
/// the balls beside the one asked for, each layer in a panel of its own: OUT_grading.csv, .gp, .svg and .png,
/// where OUT is the file without extension. Throws UsageError for options that no packing fulfils and for a
/// file that cannot be written.
void write_bed(const BedRequest &request);

} // namespace drumlin::post
