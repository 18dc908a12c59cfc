// The scenes of the fidelity study: a complete bed, and the same with one part of its model changed or left out.
#pragma once

#include "studies/fidelity/results.h"
#include "studies/placed_bed.h"

#include <string>
#include <vector>

namespace drumlin::post {

/// A bed with a roller on it, and how it is shaken.
struct FidelityScene {
  std::string name;   ///< in runs.csv, without commas
  std::string base;   ///< name of the scene that it is compared with; empty: none
  std::string change; ///< in words, what differs from the base
  PlacedBed bed;
  Variables run = {}; ///< of in.bed alone, before those of all decks

  /// Name of the files of its settled soil.
  const std::string &soil() const { return bed.soil.empty() ? bed.name : bed.soil; }
  /// The variables of in.bed except the restart file, the first of a name counts.
  Variables run_variables() const { return joined(run, bed.scene); }
};

/// The scenes, cheap ones first. The first scene is the complete bed, the reference of all that have it as their base.
struct FidelityPlan {
  std::vector<FidelityScene> scenes;
  int seeds = 5;
  int cycles = 8;

  const FidelityScene &reference() const { return scenes.front(); }
  /// Those of each scene with its base, in the order of the scenes.
  std::vector<BedComparison> comparisons() const;
};

/// Number of discs of the default bed of inputs/bed.
constexpr int default_balls = 2500;
/// \param balls of the complete bed: box and roller are scaled so that they keep their proportions, the balls stay as large. In two
/// dimensions masses and forces per metre go with the square of lengths; so does k, so that the drum on the soil keeps its natural frequency,
/// and overlaps their size.
FidelityPlan fidelity_plan(int balls);
/// Three scenes of 150 discs of case loose, two seeds: to see that the study works.
FidelityPlan quick_fidelity_plan();

} // namespace drumlin::post
