// What the fidelity study measures: its file runs.csv, row by row, and the effects that follow.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// What is asked of a bed, from the second half of a run.
enum class BedQuantity {
  acceleration, ///< largest of the drum, mean over the cycles, m/s2
  force,        ///< largest contact force, mean over the cycles, N per metre of width
  settlement,   ///< of the drum per cycle, m
  contact       ///< share of steps with contact
};
constexpr std::array<BedQuantity, 4> bed_quantities = {BedQuantity::acceleration, BedQuantity::force,
                                                       BedQuantity::settlement, BedQuantity::contact};
/// Name with unit, for headers.
std::string bed_quantity_name(BedQuantity quantity);

/// One row of runs.csv. The first two name the run.
struct FidelityRun {
  std::string variant;
  int seed;
  std::array<double, bed_quantities.size()> values; ///< in the order of `bed_quantities`
  double wall_s;                                    ///< of the engine's loop, excitation only
};

extern const std::vector<std::string> fidelity_run_columns;
constexpr std::size_t fidelity_run_keys = 2;
std::vector<std::string> cells(const FidelityRun &run);
/// The rows of a file in order. std::runtime_error for one that cannot be understood.
std::vector<FidelityRun> read_fidelity_runs(const std::filesystem::path &file);

/// Mean over seeds and twice its standard error; the error is infinite for one seed.
struct MeanError {
  double mean, two_errors;
  /// Whether the mean is farther from zero than two standard errors: a claim that scatter does not make.
  bool beyond_scatter() const;
};
MeanError mean_error(const std::vector<double> &values);

/// A variant over its base: differences seed by seed, so that what a seed's bed does to both falls out.
struct Effect {
  std::string variant, base;
  int seeds;
  std::array<MeanError, bed_quantities.size()> change; ///< relative to the mean of the base
  double wall_ratio;                                   ///< median over the seeds
};
/// std::invalid_argument if the two share no seed.
Effect effect_of(const std::vector<FidelityRun> &runs, const std::string &variant, const std::string &base);

} // namespace drumlin::post
