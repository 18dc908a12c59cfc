// Beds of several seeds with a roller on them, and the runs that studies make on them: inputs/bed.
#pragma once

#include "bed/packing.h"
#include "engine/engine_run.h"
#include "studies/study.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace drumlin::post {

/// A bed with a roller on it, made once for each seed, and the deck variables of its runs.
struct PlacedBed {
  std::string name; ///< of its files
  PackingOptions packing;
  Variables scene;       ///< of all its decks
  std::string ratio;     ///< unbalanced force at which it counts as at rest: see in.settle
  Variables settle = {}; ///< of in.settle alone, before `scene`
  /// Name of the files of its settled soil, which beds that differ in the roller alone share; empty: `name`.
  std::string soil = {};
  Variables place = {};              ///< of in.place alone, before `scene`
  std::vector<BedLayer> layers = {}; ///< the lowest first, instead of `packing`; empty: a bed of one layer
};

/// 150 discs of case loose in a box 0.6 m wide, under a drum of 100 kg: to test a study. The mass of the frame, m3, is
/// missing in its scene.
PlacedBed small_bed();
/// 1000 discs of case gravel in a box 1.26 m wide, as deep as the bed of 2500 discs.
PlacedBed gravel_bed();

constexpr double soil_density = 2650.0; ///< of the balls [kg/m3]

Variables joined(Variables first, const Variables &second);

/// The restart file of a bed's soil at rest, in the folder `beds` of the study; made if an earlier call did not finish it. Its name
/// has the fingerprint of all that the soil is made of.
std::filesystem::path settled_soil(const PlacedBed &bed, int seed, const std::filesystem::path &out);

/// Name of a bed with its roller, of one seed, with the fingerprint of all that soil and roller are made of.
std::string placed_name(const PlacedBed &bed, int seed);

/// The restart file of a bed with its roller at rest, in the folder `beds` of the study; made if an earlier
/// call did not finish it. Beds that share their soil are not made at the same time.
std::filesystem::path placed(const PlacedBed &bed, int seed, const std::filesystem::path &out);

/// `variables` with those of in.bed for a run on a bed with its roller at rest. in.bed refuses by default what a bed
/// placed with a ratio of 1 leaves unbalanced: it is made to accept it.
Variables with_start(Variables variables, const std::filesystem::path &start, int cycles);

/// What a run gave.
struct MeasuredRun {
  ResumedTable::Row row; ///< of the results
  std::string words;     ///< for the progress
};

/// A run on the bed of a seed. The results of its study have the columns name and seed as their key.
struct SeedRun {
  std::string name;
  int seed;
  std::function<MeasuredRun()> measure;
};

/// Makes the runs that the results do not have: those of a group one after the other, `jobs` groups at the
/// same time. A run that fails does not stop the others. Returns the failures, one sentence each.
std::vector<std::string> make_runs(const std::vector<std::vector<SeedRun>> &groups, int jobs,
                                   ResumedTable &results);

} // namespace drumlin::post
