// Results of the friction study: the rows of its file runs.csv, and what the friction model changes.
#pragma once

#include "studies/study.h"
#include "support/statistics.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// A roller on a bed of one friction model; the first two members name the run. Forces and k are per metre of the
/// drum's width. NaN: the record does not give the value.
struct FrictionRun {
  std::string tangential; ///< friction model of the deck, `coulomb` or `history`
  int seed = 0;
  double depth = 0.0;         ///< of the drum at rest, share of its diameter [-]; < 0: above the mean surface
  double settlement = 0.0;    ///< of the drum: mean over the last cycle, from its position at rest [m]
  double peak_force = 0.0;    ///< of the contact, mean over the last half of the cycles [N/m]
  double acceleration = 0.0;  ///< largest of the drum, the same mean [m/s2]
  double contact_share = 0.0; ///< of the time, the same mean [-]
  double k = 0.0;             ///< stiffness that identification finds [N/m per m]
  double D = 0.0;             ///< damping ratio [-]
  double r2 = 0.0;            ///< share of the variance of the force that k and D explain [-]
};

/// The columns of runs.csv.
const CsvSchema<FrictionRun> &friction_runs();

/// One of the values that are compared.
struct FrictionQuantity {
  const char *label; ///< with unit
  double FrictionRun::*value;
  double scale; ///< from SI to the label's unit
};
extern const std::array<FrictionQuantity, 8> friction_quantities;

/// Values of a quantity with one model, in SI; without those that are NaN.
std::vector<double> values_of(const std::vector<FrictionRun> &runs, const std::string &tangential,
                              const FrictionQuantity &quantity);
/// Change of a quantity from `coulomb` to `history` on beds of the same seed, in SI; nothing for fewer than two
/// seeds.
std::optional<MeanInterval> friction_change(const std::vector<FrictionRun> &runs,
                                            const FrictionQuantity &quantity);

/// Writes tables and index.html into the study's folder.
/// \param beds what they are, in words
/// \param failures runs that failed, one sentence each
void write_friction_page(const std::filesystem::path &out, const std::string &beds,
                         const std::vector<FrictionRun> &runs, const std::vector<std::string> &failures);

} // namespace drumlin::post
