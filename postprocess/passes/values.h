// What each pass of a roller has left, and what its meter has shown: means over the measured part of the way
// and values of its cells.
#pragma once

#include "meter/values.h"
#include "passes/drive.h"
#include "passes/soil.h"
#include "support/files.h"
#include "support/statistics.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

struct PassesOptions {
  double cell = 0.34;            ///< m, length of a cell along the way
  std::optional<double> spacing; ///< m, of the lines along which surfaces are measured; usual_spacing()
  MeterOptions meter;            ///< of which the window is that of each cell
};

/// A cell of the way in a pass, or before the first, pass 0, which no meter has seen.
struct WayCell {
  int pass = 0;
  WayPart part;
  SoilLayers before, after;     ///< the pass
  int cycles = 0;               ///< of the excitation, an even number; 0: too few for meter values
  MeterWindow meter;            ///< of these cycles
  std::optional<double> ccv;    ///< from samples, which alone give it
  double energy_exciter = 0.0;  ///< J per metre driven
  double energy_traction = 0.0; ///< J per metre driven, of traction and of the torque on the drum
};

/// A pass, or the bed before the first, pass 0. What is not known is NaN.
struct PassValues {
  int pass = 0;
  SoilLayers soil;                 ///< after the pass
  double settlement = 0.0;         ///< of the surface since before the first pass, mean, m
  double settlement_scatter = 0.0; ///< standard deviation of the cells' means, m
  double compaction = 0.0;         ///< the part of the settlement that is compaction of the layers, m
  double heave = 0.0; ///< largest rise outside of the measured part since before the first pass, m
  std::vector<double> solid_scatter;      ///< of each layer, standard deviation of the cells
  std::vector<double> relative_density;   ///< of the inside of each layer
  std::vector<double> degree;             ///< of compaction of that, density over the densest one
  double energy_exciter, energy_traction; ///< J per metre driven
  double traction;                        ///< N, mean, along the direction of the pass
  double cmv, cmv_scatter, rmv, ccv, k_B, E_vib, contact_share, peak_force; ///< means of the cells
  double k, k_half_width, D, D_half_width; ///< identified, with 95 % intervals, N/m, -
  std::string mode;                        ///< of most cells; empty: not known

  /// What of the settlement is not compaction: soil that was pushed along or aside, m.
  double pushed() const { return settlement - compaction; }
};

/// A slice of the profile after a pass.
struct PassDepth {
  int pass = 0;
  DepthRow row;
  std::size_t passing = 0; ///< number of dumps under the passing drum that the stresses are from
};

/// The dumps of a pass that can be shown as an animation.
struct PassDumps {
  int pass = 0; ///< 0: no pass has enough of them
  std::vector<long> steps;
  std::vector<double> times, places; ///< s; of the roller, m
};

/// What a run has left.
struct PassesResult {
  std::filesystem::path folder;
  std::map<std::string, std::string> parameters; ///< of parameters.csv
  WayPart measured;
  std::vector<WayPart> spots;          ///< soft or stiff parts of the lowest layer
  double speed = 0.0, frequency = 0.0; ///< m/s, Hz
  double cell = 0.0;                   ///< m
  bool flat = true;
  HarmonicSource source = HarmonicSource::every_step;
  std::vector<PassValues> passes; ///< the first is pass 0
  std::vector<WayCell> cells;     ///< by pass, then along the way
  VerticalLines lines;
  std::vector<std::vector<double>> surfaces; ///< on the lines, before the first pass and after each, m
  std::vector<PassDepth> depth;
  PassDumps animated; ///< the first pass with enough dumps
  std::vector<std::string> notes;

  std::size_t layers() const { return passes.front().soil.thickness.size(); }
};

/// Measures a run. std::invalid_argument, "OPTION is ...; allowed: ...", for a cell that holds less than four
/// cycles or is longer than the measured part, or a spacing of too many lines.
PassesResult measure_passes(const Drive &drive, const PassesOptions &options);

/// The least number of passes after which no pass has changed the value by as much as `share` of the whole
/// change; nothing if the last one still did, or if there was no change. The values before the first pass and
/// after each.
std::optional<int> passes_until_level(const std::vector<double> &values, double share = 0.05);

/// The change of a layer's solid fraction over all passes, with the 95 % interval of the mean over the cells.
MeanInterval gain_along_the_way(const PassesResult &result, std::size_t layer);

/// The text of a number in a CSV cell; empty if the number is NaN or absent.
std::string cell_of(double value);
std::string cell_of(std::optional<double> value);

/// A number of a pass, as a column of passes.csv.
struct PassColumn {
  std::string header;
  std::function<double(const PassValues &)> value; ///< NaN: not known
};
/// The columns of a bed of so many layers.
std::vector<PassColumn> pass_columns(std::size_t layers);

/// passes.csv of several runs: of each column the mean over the runs and half of its 95 % interval, in the
/// row of each pass that at least one run has, and the number of runs that have it.
/// \pre runs of equal layers
std::string passes_csv(const std::vector<PassesResult> &results);
/// The four tables of a run, as files in `folder`. passes.csv has a row for the state before the first pass
/// and for that after each; way.csv a row for each pass and cell of the way; surface.csv the height along the
/// way, a column for each pass; depth.csv a row for each pass and layer of equal depth.
std::vector<FileText> pass_tables(const std::filesystem::path &folder, const PassesResult &result);

/// The number of passes that the longest of the runs has.
std::size_t most_passes(const std::vector<PassesResult> &results);
/// A value of the runs after a pass, 0: before; those that have it.
std::vector<double> values_after(const std::vector<PassesResult> &results, std::size_t pass,
                                 const std::function<double(const PassValues &)> &value);
/// The mode of most runs in a pass; empty: not known.
std::string mode_in(const std::vector<PassesResult> &results, std::size_t pass);

} // namespace drumlin::post
