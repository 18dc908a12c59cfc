// Measured values of chains and single impacts, the exact solution of each chain as reference, and the
// comparison with the reference values of the paper's cases.
#pragma once

#include "chain/analysis.h"
#include "chain/exact_solution.h"
#include "report/run_folder.h"

#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// Number of cycles at the end of a run that count as its steady state. Even, since a state may alternate
/// from cycle to cycle.
constexpr int steady_cycles = 10;

/// Number of cycles at the end of a run over which its velocity error counts.
constexpr int error_cycles = 5;

/// Measured values of a chain run.
struct ChainMeasures {
  TimeWindow steady;    ///< the last cycles, s
  int steady_count = 0; ///< number of these cycles
  SteadyExtremes extremes;
  double contact_share = 0.0;   ///< -
  bool share_exact = false;     ///< whether it follows from located events
  double makes_per_cycle = 0.0; ///< in the steady window
  double breaks_per_cycle = 0.0;
  std::size_t makes = 0; ///< in the whole run
  std::size_t breaks = 0;
  std::optional<Extremes> force_at_make;    ///< N, steady window
  std::optional<Extremes> force_at_break;   ///< N
  std::optional<Extremes> overlap_at_break; ///< m
  HarmonicAmplitudes amplitudes;            ///< m/s2
  bool amplitudes_every_step = false;       ///< whether the run integrated them over every step
  std::optional<EnergyBalance> energy;
  std::string energy_missing;
  std::optional<RollerForce> roller;

  // Comparison with the reference solution (`reference`: the exact solution at the same parameters), if there
  // is one.
  /// Relative RMS error of the drum velocity over the last error_cycles cycles.
  double velocity_error_last = std::numeric_limits<double>::quiet_NaN();
  std::optional<double> velocity_error_25_to_30; ///< the same, cycles 25 to 30
  bool reference_interpolated = false; ///< whether the run has rows between those of the reference solution
  EventMatch match;                    ///< all events
};

/// How a measured value compares with its reference value.
enum class Agreement {
  same_digits, ///< rounds to the digits given, or lies in the range given
  tolerance,   ///< within the stated tolerance
  differs,
  not_measured,
  not_judged ///< the run was cut, or has too few cycles for the reference values
};

/// One comparison, in the reference's unit.
struct Check {
  std::size_t run = 0; ///< index into ReportResults::runs
  std::string quantity;
  std::string unit;
  std::string reference;            ///< as the reference gives it
  std::string measured;             ///< with two digits more than the reference
  double value = 0.0;               ///< measured
  double difference = 0.0;          ///< measured minus reference (0 inside a range)
  double relative_difference = 0.0; ///< NaN for a reference of 0
  std::optional<double> direct;     ///< the same quantity of the reference solution, over the same cycles
  std::string tolerance;            ///< in words
  std::string source;
  Agreement agreement = Agreement::not_measured;
  std::string note;
  bool agrees() const { return agreement == Agreement::same_digits || agreement == Agreement::tolerance; }
};

/// A run with its measured values.
struct RunResult {
  Run run;
  std::optional<ChainMeasures> chain;
  std::optional<ImpactMeasure> impact;
  std::optional<ChainMeasures> reference_chain;   ///< the same values of the reference solution
  std::shared_ptr<const ExactSolution> reference; ///< reference solution of the same chain; empty for
                                                  ///< impacts, and of a chain that takes too long
};

/// Everything that the report says about chains and single impacts.
struct ReportResults {
  std::vector<RunResult> runs;
  std::vector<Check> checks;      ///< steady states and meter values
  std::vector<Check> restitution; ///< impacts
  std::vector<Check> words;       ///< statements that the paper makes in words
};

/// Computes exact solutions, each set of parameters once.
class ExactSolutions {
public:
  /// \param samples_per_cycle rows per cycle, as in the run
  /// \param impact_speed m/s; 0: start from equilibrium Throws std::runtime_error if it would
  /// take too long.
  std::shared_ptr<const ExactSolution> solve(const ChainParameters &parameters, int cycles,
                                             int samples_per_cycle, double impact_speed);

private:
  std::map<std::string, std::shared_ptr<const ExactSolution>> known_;
};

/// Measures a run; `exact` computes its reference solution.
RunResult analyse(Run run, ExactSolutions &exact);

/// Compares all runs with the reference values: fills checks, restitution and words.
void compare(ReportResults &results);

/// The run that the figures show for a case and a transition. Preferred are, in this order: runs that were
/// not cut, those with the parameters of the case, long runs, runs in an engine, and the smallest velocity
/// error. nullptr if there is no such run.
const RunResult *best_run(const ReportResults &results, const std::string &case_name, Transition transition);

/// One reference value of a case and a transition.
struct ReferenceValue {
  std::string case_name;  ///< "I" to "IV", or "D=0.2" of an impact
  std::string transition; ///< "A" or "B"
  std::string quantity;
  std::string unit; ///< of low, high and tolerance; empty for a pure number
  /// As given, in `unit`; equal unless the reference gives a range.
  std::string low_text, high_text;
  double low = 0.0, high = 0.0;
  double tolerance = 0.0; ///< how far outside [low, high] a value may lie and still agree; NaN: not judged
  std::string source;

  int decimals() const; ///< digits given after the point
};

/// Every value, in the order of the file.
const std::vector<ReferenceValue> &reference_values();

/// The value of a case, a transition and a quantity, if there is one.
const ReferenceValue *reference_value(const std::string &case_name, const std::string &transition,
                                      const std::string &quantity);

} // namespace drumlin::post
