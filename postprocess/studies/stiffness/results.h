// Results of the stiffness study: the rows of its file runs.csv, and what a variable changes.
#pragma once

#include "identify/identified_record.h"
#include "studies/study.h"
#include "support/statistics.h"

#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// The linear law that identification finds in a run on a bed, whose first two members name the run. Forces,
/// masses and the law are per metre of the drum's width. NaN: the record does not give the value.
struct BedLaw {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::string run; ///< default_run, or the variable that differs from it and its value
  int seed = 0;
  double load = 0.0;          ///< weight of drum and frame [N]
  double Fw = 0.0;            ///< amplitude of the excitation force [N]
  double frequency = 0.0;     ///< of the excitation [Hz]
  double k = none;            ///< [N/m]
  double k_half_width = none; ///< of its 95 % confidence interval in this record [N/m]
  double D = none;            ///< [-]
  double D_half_width = none; ///< [-]
  double r2 = none;           ///< share of the variance of the force in contact that the law explains [-]
  std::string pulls;          ///< yes, no, cannot be told; or none, if there is no law
  double contact_share = 0.0; ///< of the time, last half of the cycles [-]
  double peak_force = 0.0;    ///< mean over the last half of the cycles [N]
  double cpu_s = 0.0;         ///< processor time of the engine, excitation only
};
constexpr const char *default_run = "default";

/// The columns of runs.csv.
const CsvSchema<BedLaw> &bed_laws();

/// Load, excitation and law of the record in a folder of a run: what `drumlin identify` finds in the whole
/// record. A record that does not determine the law gives none; std::runtime_error for one that cannot be
/// read.
BedLaw identified_law(const std::filesystem::path &folder);

/// One of the three quantities that the study varies.
struct LawVariable {
  const char *name;  ///< of its figure
  const char *title; ///< in a sentence
  const char *label; ///< with unit
  double BedLaw::*value;
  double scale; ///< from SI to the label's unit
};
extern const std::array<LawVariable, 3> law_variables;

/// The runs with one value of a variable, over the seeds.
struct LawLevel {
  double value = 0.0; ///< [SI]
  std::vector<BedLaw> runs;
  std::vector<double> k, D, r2; ///< of the runs that have them
  /// Change over the default value, seed by seed; none for the default itself or without two seeds.
  std::optional<MeanInterval> k_change, D_change;
};

/// The values of a variable, growing; in all other respects the runs are as the default run.
std::vector<LawLevel> levels_of(const std::vector<BedLaw> &laws, const LawVariable &variable);

/// Writes figures, tables and index.html into the study's folder.
/// \param beds what they are, in words
/// \param failures runs that failed, one sentence each
void write_stiffness_page(const std::filesystem::path &out, const std::string &beds,
                          const std::vector<BedLaw> &laws, const std::vector<std::string> &failures);

} // namespace drumlin::post
