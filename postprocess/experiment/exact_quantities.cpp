#include "experiment/exact_quantities.h"

#include "bed/dump_readers.h"
#include "chain/analysis.h"
#include "chain/exact_solution.h"
#include "chain/parameters.h"
#include "runs/chain_files.h"
#include "runs/parameter_file.h"
#include "support/csv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <vector>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr double first_push = 1e-6;  // m, of the deck
constexpr double growth_limit = 1e3; // times the first push: a larger motion is unstable
// With heavy damping and second-order stepping an unstable motion grows by as little as a factor of 1 + 1e-7
// per step. That is seen in the part of the motion that changes sign every step, measured at half time and at
// the end of the run.
constexpr double fast_growth = 1.0 + 1e-4;
constexpr double fast_noise = 1e-11; // m: above rounding errors

/// The largest fourth difference over the window: 16 times the amplitude of what changes sign every
/// step; of a motion that takes many steps it is nearly zero.
double fast_part(const std::vector<double> &x) {
  double most = 0.0;
  for (std::size_t n = 4; n < x.size(); ++n)
    most = std::max(most, std::fabs(x[n] - 4.0 * x[n - 1] + 6.0 * x[n - 2] - 4.0 * x[n - 3] + x[n - 4]));
  return most;
}

/// Positions of a ball along one direction, in the two time windows in which the deck dumps.
struct Watched {
  std::vector<double> half_time, end;

  bool has_grown(bool damped) const {
    for (const std::vector<double> *window : {&half_time, &end})
      for (const double x : *window)
        if (!(std::fabs(x) < growth_limit * first_push)) return true;
    // In both halves of the window: rounding can kick a heavily damped ball once.
    const auto middle = end.begin() + static_cast<std::ptrdiff_t>(end.size() / 2);
    const double fast = std::min(fast_part({end.begin(), middle}), fast_part({middle, end.end()}));
    return damped && fast > fast_noise && fast > fast_growth * fast_part(half_time);
  }
};

/// Which balls are stable. A ball that is lost is not.
std::vector<bool> stable_balls(const fs::path &looks, std::size_t balls, bool damped) {
  const std::vector<TextDump> dumps = read_text_dumps(looks);
  std::vector<std::array<Watched, 2>> watched(balls); // x and z
  bool second_window = false;
  for (std::size_t n = 0; n < dumps.size(); ++n) {
    const TextDump &dump = dumps[n];
    second_window = second_window || (n > 0 && dump.step != dumps[n - 1].step + 1);
    const std::size_t id = dump.column("id"), x = dump.column("x"), z = dump.column("z");
    for (const std::vector<double> &row : dump.rows) {
      std::array<Watched, 2> &ball = watched.at(static_cast<std::size_t>(std::lround(row[id])) - 1);
      (second_window ? ball[0].end : ball[0].half_time).push_back(row[x]);
      (second_window ? ball[1].end : ball[1].half_time).push_back(row[z]);
    }
  }
  if (!second_window) csv_fault(looks, 0, "x", "has not two windows");
  std::vector<bool> stable;
  stable.reserve(watched.size());
  for (const auto &[x, z] : watched)
    stable.push_back(x.half_time.size() + x.end.size() == dumps.size() && !x.has_grown(damped) &&
                     !z.has_grown(damped));
  return stable;
}

} // namespace

double stable_step(const fs::path &folder) {
  const std::vector<double> steps = read_table(folder / "steps.csv").numbers("w0_dt");
  const double D = number_from_text(read_parameters(folder / "parameters.csv").at("D"));
  const std::vector<bool> stable = stable_balls(folder / "looks.dump", steps.size(), D > 0.0);
  const auto turn = static_cast<std::size_t>(std::find(stable.begin(), stable.end(), false) - stable.begin());
  if (turn == 0) csv_fault(folder / "steps.csv", 1, "w0_dt", "is unstable");
  return turn == steps.size() ? steps.back() : std::sqrt(steps[turn - 1] * steps[turn]);
}

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

/// A chain with the parameters of a run, and its exact solution at the times of the rows of that run.
struct ExactChain {
  explicit ExactChain(const fs::path &folder) {
    const RunParameters given(folder);
    for (const ChainNumber &number : chain_numbers)
      chain.*number.value = given.number(number.name);
    chain.transition = given.transition();
    ExactOptions options;
    options.cycles = given.number("cycles");
    options.samples_per_cycle = static_cast<int>(given.number("samples_per_cycle"));
    samples_per_cycle = static_cast<std::size_t>(options.samples_per_cycle);
    exact = solve_chain(chain, options);
  }
  ChainParameters chain;
  std::size_t samples_per_cycle;
  ExactSolution exact;
};

/// Relative RMS error of a column of chain.csv from a row on.
double rms_error(const fs::path &folder, const std::vector<double> &values,
                 const std::vector<double> &reference, std::size_t from = 0) {
  if (values.size() != reference.size())
    csv_fault(folder / "chain.csv", 0, "time", "has other rows than the exact solution");
  return relative_rms(values, reference, from, reference.size());
}

std::vector<double> v_drum_of(const fs::path &folder) {
  return read_table(folder / "chain.csv").numbers("v_drum");
}

double velocity_error(const fs::path &folder) {
  return rms_error(folder, v_drum_of(folder), ExactChain(folder).exact.history.v_drum);
}

double steady_velocity_error(const fs::path &folder) {
  const ExactChain known(folder);
  const std::vector<double> &reference = known.exact.history.v_drum;
  return rms_error(folder, v_drum_of(folder), reference,
                   reference.size() - 1 - steady_error_cycles * known.samples_per_cycle);
}

double way_error(const fs::path &folder) {
  const ExactChain known(folder);
  const ChainParameters &p = known.chain;
  // The drum's displacement from where it rests in the soil without excitation.
  const auto from_rest = [&p](std::vector<double> x_drum) {
    for (double &x : x_drum)
      x += (p.m2 + p.m3) * p.g / p.k;
    return x_drum;
  };
  return rms_error(folder, from_rest(read_chain(folder / "chain.csv").x_drum),
                   from_rest(known.exact.history.x_drum));
}

/// Largest error of the times of makes and breaks, over the period; NaN if they do not match one by one.
double event_time_error(const fs::path &folder) {
  const ExactChain known(folder);
  const EventMatch match = match_events(read_events(folder / "events.csv"), known.exact.events);
  const bool all = match.matched == match.reference_count && match.run_count == match.reference_count;
  return all ? match.largest_difference / known.chain.period() : no_number;
}

SteadyExtremes steady_extremes_of(const fs::path &folder, const ExactChain &known) {
  const auto cycles = static_cast<int>(known.exact.cycles.size());
  return steady_extremes(read_chain(folder / "chain.csv"), read_events(folder / "events.csv"),
                         read_cycle_columns(folder / "cycles.csv"), known.chain,
                         last_cycles_window(cycles, steady_error_cycles, known.chain.period()),
                         steady_error_cycles);
}

template <class Of>
double largest_of_last(const ExactChain &known, const Of &of) {
  double most = 0.0;
  for (std::size_t i = known.exact.cycles.size() - steady_error_cycles; i < known.exact.cycles.size(); ++i)
    most = std::max(most, of(known.exact.cycles[i]));
  return most;
}

double peak_force_error(const fs::path &folder) {
  const ExactChain known(folder);
  const double found = steady_extremes_of(folder, known).force.max;
  return std::fabs(found / largest_of_last(known, [](const CycleSummary &one) { return one.F_contact_max; }) -
                   1.0);
}

double peak_acceleration_error(const fs::path &folder) {
  const ExactChain known(folder);
  const auto magnitude = [](double low, double high) { return std::max(std::fabs(low), std::fabs(high)); };
  const Extremes found = steady_extremes_of(folder, known).acceleration;
  const double exact = largest_of_last(
      known, [&](const CycleSummary &one) { return magnitude(one.a_drum_min, one.a_drum_max); });
  return std::fabs(magnitude(found.min, found.max) / exact - 1.0);
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

/// Errors of the rebounds of study/in.impacts over the speed of the impact, one for each phase of the make
/// within a step; none if not all have a rebound.
std::vector<double> rebound_errors(const fs::path &folder) {
  const RunParameters given(folder);
  const double exact = closed_form_restitution(given.text("transition"), given.number("D"));
  const std::vector<TextDump> dumps = read_text_dumps(folder / "rebound.txt");
  if (dumps.empty() || static_cast<double>(dumps.back().rows.size()) != given.number("phases")) return {};
  std::vector<double> errors;
  for (const std::vector<double> &row : dumps.back().rows)
    errors.push_back(std::fabs(row[dumps.back().column("vz")] / given.number("speed") - exact));
  return errors;
}

double largest_rebound_error(const fs::path &folder) {
  const std::vector<double> errors = rebound_errors(folder);
  return errors.empty() ? no_number : *std::max_element(errors.begin(), errors.end());
}

double rms_rebound_error(const fs::path &folder) {
  const std::vector<double> errors = rebound_errors(folder);
  const double squares = std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0);
  return std::sqrt(squares / static_cast<double>(errors.size())); // NaN of none
}

} // namespace

const std::vector<ExactQuantity> &exact_quantities() {
  static const std::vector<ExactQuantity> all = {
      {"velocity_error", "relative RMS error of the drum's velocity", &velocity_error},
      {"steady_velocity_error", "steady RMS error of velocity", &steady_velocity_error},
      {"peak_force_error", "steady error of peak force", &peak_force_error},
      {"peak_acceleration_error", "steady error of peak acceleration", &peak_acceleration_error},
      {"way_error", "relative RMS error of the drum's way from rest", &way_error},
      {"event_time_error", "largest error of the time of an event over a cycle", &event_time_error},
      {"rebound_error", "error of the rebound over the speed of the impact", &rebound_error},
      {"largest_rebound_error", "largest error of the rebound over the speed of the impact",
       &largest_rebound_error},
      {"rms_rebound_error", "RMS error of the rebound over the speed of the impact", &rms_rebound_error},
      {"stable_step", "longest stable w0 dt", &stable_step}};
  return all;
}

} // namespace drumlin::post
