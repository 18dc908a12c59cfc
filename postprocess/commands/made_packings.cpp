#include "commands/made_packings.h"

#include "engine/deck_run.h"
#include "support/csv.h"
#include "support/files.h"
#include "support/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// Samples of so many balls scatter by some 9 % of the range from the loosest to the frictionless packing,
/// means of three by 5 %.
constexpr int sample_balls = 1000;
constexpr std::uint64_t seeds = 3;
/// Packings change steeply where there is little friction.
constexpr std::array<double, 5> shares = {1.0, 0.5, 0.2, 0.07, 0.0};

/// Void ratio that shaking would leave: as far from the loosest to the frictionless packing as of case
/// gravel.
double estimated_shaken(const std::vector<MeasuredPackings::Row> &rows, int dimensions) {
  const double loosest = rows.front().void_ratio, frictionless = rows.back().void_ratio;
  return loosest - (loosest - frictionless) / packings_of_gravel(dimensions).most();
}

/// The layer in a box of another width, and in three dimensions depth, with so many balls.
BedLayer sample_of(BedLayer layer) {
  layer.pouring.reset();
  PackingOptions &box = layer.packing;
  const double wanted = static_cast<double>(sample_balls) / balls_of(layer);
  const double factor = box.dimensions() == 2 ? wanted : std::sqrt(wanted);
  constexpr double least = 8.0; // largest balls beside each other
  const auto side = [&](double length) {
    return std::max(length * factor, least * 2.0 * box.largest_radius());
  };
  box.width = side(box.width);
  if (box.dimensions() == 3) box.depth = side(box.depth);
  box.balls = balls_of(layer);
  return layer;
}

/// The solid fraction of the sample, poured with a share of the soil's friction.
double poured(const fs::path &balls, int dimensions, const SoilFriction &soil, double share) {
  const Variables variables = {{"case", dimensions == 2 ? "base" : "base3d"},
                               {"balls", balls.string()},
                               {"bed", "soil.restart"},
                               {"walls", "0"},
                               {"friction", number_text(soil.friction)},
                               {"rolling", number_text(soil.rolling)},
                               {"pour_friction", number_text(share * soil.friction)},
                               {"pour_rolling", number_text(share * soil.rolling)}};
  return DeckRun("bed/in.settle", variables).must_succeed().printed("solid fraction ");
}

/// The table, if it is there and holds for these balls and contacts.
std::optional<MeasuredPackings> found(const fs::path &table, const PackingOptions &box,
                                      const SoilFriction &soil) {
  if (!fs::exists(table)) return {};
  try {
    MeasuredPackings packings = read_packings(table);
    if (other_balls(packings, box).empty() && packings.of_loosest().friction == soil.friction &&
        packings.of_loosest().rolling == soil.rolling)
      return packings;
  } catch (const std::runtime_error &) {
    // A damaged table is made again.
  }
  return {};
}

} // namespace

MeasuredPackings made_packings(const BedLayer &layer, const SoilFriction &soil, double density,
                               const fs::path &table, const std::string &title) {
  if (std::optional<MeasuredPackings> known = found(table, layer.packing, soil)) {
    print_progress(fmt::format("{}: packings of {}", title, table.string()));
    return *known;
  }
  BedLayer sample = sample_of(layer);
  const int dimensions = sample.packing.dimensions();
  const std::size_t samples = seeds * shares.size();
  print_progress(fmt::format("{}: its loosest packing and denser ones are not known; LIGGGHTS "
                             "pours {} samples of {} {}, some {} minutes",
                             title, samples, sample.packing.balls, dimensions == 2 ? "discs" : "spheres",
                             dimensions == 2 ? 5 : 20));
  const TemporaryFolder folder(fs::temp_directory_path(), "drumlin-packings-");
  const auto balls = [&folder](std::uint64_t seed) { return folder.path() / fmt::format("{}.data", seed); };
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    sample.packing.seed = seed;
    write_files({{balls(seed), bed_data({sample}, density, pack_layers({sample}))}});
  }
  CountedProgress progress(samples, "packing");
  std::vector<MeasuredPackings::Row> rows;
  for (const double share : shares) {
    MeasuredPackings::Row &row =
        rows.emplace_back(MeasuredPackings::Row{share, share * soil.friction, share * soil.rolling, 0.0});
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const double phi = poured(balls(seed), dimensions, soil, share);
      row.void_ratio += (1.0 / phi - 1.0) / seeds;
      progress.measured(fmt::format("friction {:.3g}, rolling friction {:.3g}: solid fraction {:.4f}",
                                    row.friction, row.rolling, phi));
    }
  }
  const double shaken = estimated_shaken(rows, dimensions);
  MeasuredPackings packings(std::move(rows), shaken);
  packings.estimated = true;
  note_balls(packings, sample.packing);
  make_parent_folder(table);
  write_files({{table, packings_csv(packings)}});
  print_progress(table.string());
  return read_packings(table); // with the digits of the file, as a later call has it
}

} // namespace drumlin::post
