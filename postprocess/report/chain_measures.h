// What the report says of the runs, before anything is drawn: measures of each run, the direct solution
// beside it, and the checks against the reference values.
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "chain/analysis.h"
#include "chain/direct_solver.h"
#include "chain/reference_values.h"
#include "report/run_folder.h"

namespace drumlin::post {

/// Cycles at the end of a run that count as its steady state; even, since the state may alternate.
constexpr int steady_cycles = 10;

/// What was measured in a chain run.
struct ChainMeasures {
  TimeWindow steady;    ///< the last cycles, s
  int steady_count = 0; ///< how many
  SteadyExtremes extremes;
  double contact_share = 0.0;   ///< -
  bool share_exact = false;     ///< from located events
  double makes_per_cycle = 0.0; ///< in the steady window
  double breaks_per_cycle = 0.0;
  std::size_t makes = 0; ///< in the whole run
  std::size_t breaks = 0;
  std::optional<Extremes> force_at_make;    ///< N, steady window
  std::optional<Extremes> force_at_break;   ///< N
  std::optional<Extremes> overlap_at_break; ///< m
  HarmonicAmplitudes amplitudes;            ///< m/s2
  bool amplitudes_every_step = false;       ///< integrated by the run over every step
  std::optional<EnergyLedger> energy;
  std::string energy_missing;
  std::optional<RollerForce> roller;

  // Against the direct solution of the same parameters, if there is one.
  double velocity_error_last =
      std::numeric_limits<double>::quiet_NaN();  ///< relative RMS of drum velocity, last five cycles
  std::optional<double> velocity_error_25_to_30; ///< the same, cycles 25 to 30
  bool truth_interpolated = false;               ///< the run's times are not on the direct solution's grid
  EventMatch match;                              ///< all events
};

/// How a measured value stands to its reference.
enum class Agreement {
  same_digits, ///< rounds to the digits given, or lies in the range given
  tolerance,   ///< within the stated tolerance
  differs,
  not_measured,
  not_judged ///< the run is shorter than the reference values ask for
};

/// One comparison, in the reference's unit.
struct Check {
  std::size_t run = 0; ///< index into ReportResults::runs
  std::string quantity;
  std::string unit;
  std::string reference;            ///< as the reference gives it
  std::string measured;             ///< with two digits more
  double value = 0.0;               ///< measured
  double difference = 0.0;          ///< measured minus reference (0 inside a range)
  double relative_difference = 0.0; ///< NaN for a reference of 0
  std::optional<double> direct;     ///< the same quantity of the direct solution, same cycles
  std::string tolerance;            ///< in words
  std::string source;
  Agreement agreement = Agreement::not_measured;
  std::string note;
  bool agrees() const { return agreement == Agreement::same_digits || agreement == Agreement::tolerance; }
};

/// A run with everything that was found out about it.
struct RunResult {
  Run run;
  std::optional<ChainMeasures> chain;
  std::optional<ImpactMeasure> impact;
  std::optional<ChainMeasures> truth_chain; ///< the same measures of the direct solution
  std::shared_ptr<const DirectResult>
      truth; ///< direct solution of the same chain; empty for impacts and if it failed
};

/// Everything that the report prints.
struct ReportResults {
  std::vector<RunResult> runs;
  std::vector<Check> checks;      ///< steady states and meter values
  std::vector<Check> restitution; ///< impacts
  std::vector<Check> words;       ///< what the paper says in words
};

/// Solves the chains directly, each set of parameters once (with rows at the run's own times).
class DirectSolutions {
public:
  /// impact_speed in m/s; 0 starts from equilibrium.
  std::shared_ptr<const DirectResult> solve(const ChainParameters &parameters, int cycles,
                                            int samples_per_cycle, double impact_speed);

private:
  std::map<std::string, std::shared_ptr<const DirectResult>> known_;
};

/// Measures a run; `direct` supplies its truth.
RunResult analyse(Run run, DirectSolutions &direct);

/// Compares all runs with the reference values. Fills checks, restitution and words.
void compare(ReportResults &results);

/// The run that stands for a case and a transition in the figures: at the case's parameters and long before
/// short, engine before direct solver, then the smallest velocity error. nullptr if there is none.
const RunResult *best_run(const ReportResults &results, const std::string &case_name, Transition transition);

} // namespace drumlin::post
