// Results of an experiment, and the effects computed from them.
#pragma once

#include "experiment/plan.h"
#include "support/csv_schema.h"
#include "support/statistics.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// The copy of the plan in the folder of an experiment.
constexpr const char *plan_name = "plan";

/// A row of the file: one quantity of one run. The first three name it.
struct Result {
  std::string scene;
  int seed = 0;
  std::string quantity;
  std::string unit;
  double value = 0.0; ///< NaN: the run does not give it
  double cost = 0.0;  ///< processor time of the run, without what made its bed [s]; NaN: not known
};

/// The columns of the file.
const CsvSchema<Result> &result_rows();

/// The results of all runs, looked up by scene and quantity.
class Results {
public:
  explicit Results(const std::vector<Result> &rows);

  /// Finite values by seed.
  const std::map<int, double> &values(const std::string &scene, const std::string &quantity) const;
  /// Processor times by seed [s].
  const std::map<int, double> &costs(const std::string &scene) const;
  /// Names of the scenes that have runs, in the order of the rows.
  const std::vector<std::string> &scenes() const { return scenes_; }

private:
  std::map<std::string, std::map<std::string, std::map<int, double>>> values_;
  std::map<std::string, std::map<int, double>> costs_;
  std::vector<std::string> scenes_;
};

/// The results in the folder of an experiment. Throws std::runtime_error as read_points(), and for a value in
/// another unit than that of the plan.
Results read_results(const std::filesystem::path &folder, const Plan &plan);

/// The text of a table of the plan: means over the seeds, empty where a scene has none.
std::string table_text(const PlanTable &table, const Plan &plan, const Results &results);

/// The numbers of a map by seed, in its order.
std::vector<double> numbers(const std::map<int, double> &by_seed);

/// Change of a quantity, with its 95 % confidence interval; infinitely wide without two seeds.
struct Change {
  MeanInterval difference; ///< in the unit of the quantity
  MeanInterval relative;   ///< over the mean of what it is compared with

  /// What pages show: the difference if the quantity is absolute, else the relative change.
  const MeanInterval &shown(const Quantity &quantity) const {
    return quantity.absolute ? difference : relative;
  }
};

/// Nothing if no pair has values of both scenes; of pairs, of the same seed.
std::optional<Change> change_of(const Results &results, const Comparison &compared,
                                const std::string &quantity);

/// The quantities in the units in which pages show them. Lengths are in mm if all values are below 1 m;
/// forces, energies and stiffnesses are in kN, kJ, kN/m and so on if the largest value is 1000 or more, and
/// in MN, MJ, MN/m from 1e6 on. Changes of a quantity that is positive in some runs and negative in others
/// are given in its unit instead of in percent, and count as negligible if they are smaller than a tenth of
/// the largest mean of all scenes.
std::vector<Quantity> as_shown(std::vector<Quantity> quantities, const Results &results);

/// What a comparison finds.
struct Effect {
  const Comparison *compared = nullptr; ///< of the plan
  std::size_t seeds = 0;                ///< pairs of runs; of scenes that are not paired, runs of the first
  double cost = 0.0; ///< processor time over that of what it is compared with, median; NaN: not known
  /// In the order of the plan's quantities. Nothing, too, of a relative change where the mean of what is
  /// compared with is zero.
  std::vector<std::optional<Change>> changes;
};
/// Those of a plan's comparisons that have runs of both scenes.
std::vector<Effect> effects_of(const Plan &plan, const Results &results);

/// A known value of a scene beside what its runs give.
struct Judged {
  const Scene *scene = nullptr; ///< of the plan
  const Expected *expected = nullptr;
  double found = 0.0; ///< mean over the seeds
  double error = 0.0; ///< its difference from the known value, over the scale
  double difference =
      0.0;            ///< of a scene in LAMMPS from the same in LIGGGHTS, over the same scale; in LIGGGHTS 0
  bool holds = false; ///< within the tolerance; false if the runs do not give the quantity
};
/// Those of the scenes that have runs.
std::vector<Judged> judged(const Plan &plan, const Results &results);

} // namespace drumlin::post
