#include "experiment/exact_quantities.h"

#include "experiment/stable_step.h"

#include "bed/dump_readers.h"
#include "chain/analysis.h"
#include "chain/exact_solution.h"
#include "chain/parameters.h"
#include "runs/chain_files.h"
#include "runs/parameter_file.h"
#include "support/csv.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

class RunParameters {
public:
  explicit RunParameters(const fs::path &folder)
      : file_(folder / "parameters.csv"), texts_(read_parameters(file_)) {}
  const std::string &text(const std::string &name) const {
    const auto found = texts_.find(name);
    if (found == texts_.end()) csv_fault(file_, 0, name, "is missing");
    return found->second;
  }
  double number(const std::string &name) const { return number_from_text(text(name)); }
  Transition transition() const { return transition_from_name(text("transition")); }

private:
  fs::path file_;
  std::map<std::string, std::string> texts_;
};

/// A run of the chain and its exact solution, with rows at the same times.
struct ChainPair {
  explicit ChainPair(const fs::path &folder) : run(read_chain(folder / "chain.csv")) {
    const RunParameters given(folder);
    for (const ChainNumber &number : chain_numbers)
      chain.*number.value = given.number(number.name);
    chain.transition = given.transition();
    ExactOptions options;
    options.cycles = given.number("cycles");
    options.samples_per_cycle = static_cast<int>(given.number("samples_per_cycle"));
    exact = solve_chain(chain, options);
    if (run.size() != exact.history.size())
      csv_fault(folder / "chain.csv", 0, "time", "has other rows than the exact solution");
  }
  double rms(const std::vector<double> &values, const std::vector<double> &reference) const {
    return relative_rms(values, reference, 0, reference.size());
  }
  /// The drum's displacement from where it rests in the soil without excitation.
  std::vector<double> from_rest(std::vector<double> x_drum) const {
    for (double &x : x_drum)
      x += (chain.m2 + chain.m3) * chain.g / chain.k;
    return x_drum;
  }
  ChainParameters chain;
  ChainHistory run;
  ExactSolution exact;
};

double velocity_error(const fs::path &folder) {
  const ChainPair pair(folder);
  return pair.rms(pair.run.v_drum, pair.exact.history.v_drum);
}

double way_error(const fs::path &folder) {
  const ChainPair pair(folder);
  return pair.rms(pair.from_rest(pair.run.x_drum), pair.from_rest(pair.exact.history.x_drum));
}

/// Largest error of the times of makes and breaks, over the period; NaN if they do not match one by one.
double event_time_error(const fs::path &folder) {
  const ChainPair pair(folder);
  const EventMatch match = match_events(read_events(folder / "events.csv"), pair.exact.events);
  const bool all = match.matched == match.reference_count && match.run_count == match.reference_count;
  return all ? match.largest_difference / pair.chain.period() : std::numeric_limits<double>::quiet_NaN();
}

/// Error of the drum's speed at the end of a run of chain/in.impact, over the speed of the impact.
double rebound_error(const fs::path &folder) {
  const RunParameters given(folder);
  const ImpactParameters p{given.transition(), given.number("m2"), given.number("k"), given.number("D"),
                           given.number("speed")};
  const ChainHistory history = read_chain(folder / "chain.csv");
  const double end = impact_duration(p), w0 = std::sqrt(p.stiffness / p.mass), last = history.time.back();
  const bool leaves = end < last - 0.01 / w0;
  // The drum starts above the soil and flies for half a time step until it touches it.
  const ImpactState exact = impact_state(p, leaves ? end : last - 0.5 * given.number("timestep"));
  return std::fabs(history.v_drum.back() + exact.rate) / p.speed;
}

double largest_rebound_error(const fs::path &folder) { return rebound_errors(folder).worst; }

} // namespace

ReboundErrors rebound_errors(const fs::path &folder) {
  const RunParameters given(folder);
  const double exact = closed_form_restitution(given.text("transition"), given.number("D")),
               phases = given.number("phases");
  const std::vector<TextDump> dumps = read_text_dumps(folder / "rebound.txt");
  if (dumps.empty() || static_cast<double>(dumps.back().rows.size()) != phases) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    return {none, none};
  }
  const std::size_t velocity = dumps.back().column("vz");
  ReboundErrors errors{0.0, 0.0};
  for (const std::vector<double> &row : dumps.back().rows) {
    const double error = std::fabs(row[velocity] / given.number("speed") - exact);
    errors.worst = std::max(errors.worst, error);
    errors.rms += error * error / phases;
  }
  errors.rms = std::sqrt(errors.rms);
  return errors;
}

const std::vector<ExactQuantity> &exact_quantities() {
  static const std::vector<ExactQuantity> all = {
      {"velocity_error", "relative RMS error of the drum's velocity", &velocity_error},
      {"way_error", "relative RMS error of the drum's way from rest", &way_error},
      {"event_time_error", "largest error of the time of an event over a cycle", &event_time_error},
      {"rebound_error", "error of the rebound over the speed of the impact", &rebound_error},
      {"largest_rebound_error", "largest error of the rebound over the speed of the impact",
       &largest_rebound_error},
      {"stable_step", "longest stable w0 dt", &stable_step}};
  return all;
}

} // namespace drumlin::post
