// Measured values of runs of the roller on a bed of balls, and the pairs of runs that are shown together. SI
// units; in two dimensions masses, forces and energies are per metre of the drum's width.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "chain/analysis.h"
#include "report/run_folder.h"
#include "runs/bed_files.h"

namespace drumlin::post {

/// Energy error in each row (J): kinetic + potential + elastic + dissipated - work_excitation, less the same
/// in the first row.
std::vector<double> energy_imbalance(const BedHistory &bed);

/// Measured values of a bed run. Its steady part is about the second half of its cycles: an even number of
/// them, since the state may alternate from cycle to cycle, and at most steady_cycles; one cycle for a run of
/// one cycle, none for a shorter run.
struct BedMeasures {
  int cycles = 0;          ///< complete, with a row in cycles.csv
  int steady_count = 0;    ///< cycles of the steady part
  TimeWindow steady;       ///< the steady part in time, s
  SteadyExtremes extremes; ///< over every step of the steady part
  double contact_share = 0.0;
  double settlement = 0.0;           ///< of the last cycle, m
  double settlement_per_cycle = 0.0; ///< in the steady part, m
  std::optional<HarmonicAmplitudes>
      amplitudes;                 ///< m/s2, over the steady part; nothing for less than two cycles
  double imbalance_percent = 0.0; ///< energy error at the end, in % of the exciter's work until then
  double depth_percent = 0.0; ///< of the drum's lowest point at rest below the surface, in % of its diameter;
                              ///< NaN if it is not known
  double coordination_start = 0.0; ///< first row
  double coordination_end = 0.0;   ///< mean over the last cycle
  double void_ratio_start = 0.0;   ///< first row
  double void_ratio_end = 0.0;     ///< mean over the last cycle
};

/// A bed run with its measured values.
struct BedResult {
  Run run;
  BedHistory bed;
  BedMeasures measures;
};

/// Reads the columns of the bed of a run of kind bed and measures the run. Throws std::runtime_error with
/// file and line for a file that cannot be read, or if cycles.csv is missing.
BedResult analyse_bed(Run run);

/// Whether the roller of a run's folder drives over the bed, so that there are passes.
bool drives(const std::filesystem::path &folder);

/// Whether masses, forces and energies are per metre of the drum: in two dimensions.
bool per_metre(const Run &run);
/// "/m" or " per m" behind a unit of forces, masses and energies of a run, or nothing.
const char *per_metre_words(const Run &run, const char *words = "/m");

/// A number to two digits, as the scatter of single beds allows, without an exponent.
std::string two_digits(double value);

/// How single beds scatter that differ in their seed alone: standard deviations of five beds of the default
/// gravel, inputs/study/fidelity/findings.md.
struct BedScatter {
  static constexpr double force = 0.18, acceleration = 0.18, contact_share = 0.14; ///< relative
  static constexpr double settlement = 3.3e-3;                                     ///< of a cycle, m
  static std::string words();                                                      ///< the same as a sentence
};

/// Bed runs that the figures show together: under B, under A or both, equal otherwise, on one bed or on beds
/// that differ in their seed.
struct BedGroup {
  std::vector<const BedResult *> runs; ///< those under B first, the order of drawing
  /// Those under one condition.
  std::vector<const BedResult *> under(Transition transition) const;
  /// The conditions that it has, B first.
  std::vector<Transition> conditions() const;
  /// Whether a condition has several beds.
  bool several() const { return runs.size() > conditions().size(); }
};

/// The groups, in the order of their first runs. If a run has several partners under the other condition, one
/// from the same restart file is preferred. Beds are of different seeds if their restart files and their
/// balls (d50) differ.
std::vector<BedGroup> group_beds(const std::vector<BedResult> &beds);

} // namespace drumlin::post
