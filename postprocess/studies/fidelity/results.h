// Results of the fidelity study: the rows of its file runs.csv, and the effects computed from them.
#pragma once

#include "support/csv_schema.h"
#include "support/statistics.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// The quantities of a bed that are compared, from the second half of a run.
enum class BedQuantity {
  acceleration, ///< largest of the drum, mean over the cycles, m/s2
  force,        ///< largest contact force, mean over the cycles, N per metre of width
  settlement,   ///< of the drum per cycle, m
  contact,      ///< share of steps with contact
  stiffness     ///< k of the soil that `identify` finds, N/m per metre of width; NaN if it finds none
};
constexpr std::array<BedQuantity, 5> bed_quantities = {BedQuantity::acceleration, BedQuantity::force,
                                                       BedQuantity::settlement, BedQuantity::contact,
                                                       BedQuantity::stiffness};
/// Name with unit, for headers.
std::string bed_quantity_name(BedQuantity quantity);

/// In the order of `bed_quantities`.
using BedValues = std::array<double, bed_quantities.size()>;

/// The quantities from the second half of a run's cycles.csv, which does not give the stiffness. \param width of the bed, m \pre at least two
/// cycles behind the row of the start
BedValues bed_values(const Table &cycles, double width);

/// One row of runs.csv. The first two name the run.
struct FidelityRun {
  std::string variant;
  int seed;
  BedValues values;
  double cpu_s;  ///< processor time of the engine, excitation only: what a machine of one's own would take
  int balls = 0; ///< of the soil
};

/// The columns of runs.csv.
const CsvSchema<FidelityRun> &fidelity_runs();
/// The rows of a file in order. std::runtime_error for one that cannot be understood or lacks a finite
/// number other than the stiffness.
std::vector<FidelityRun> read_fidelity_runs(const std::filesystem::path &file);

/// Which two variants are compared.
struct BedComparison {
  std::string what, variant, base;
};

/// A variant over its base: differences are taken for each seed, so that effects of the seed's bed on both
/// cancel.
struct Effect {
  BedComparison compared;
  int seeds;
  std::array<MeanInterval, bed_quantities.size()>
      change; ///< relative to the mean of the base; NaN if no seed gives it
  std::array<MeanInterval, bed_quantities.size()>
      difference; ///< in the unit of the quantity; NaN if no seed gives it
  double cost;    ///< processor time over the base's, median over the seeds
};
/// Nothing if the two share no seed.
std::optional<Effect> effect_of(const std::vector<FidelityRun> &runs, const BedComparison &compared);

} // namespace drumlin::post
