#include "advice/steps.h"

#include "chain/analysis.h"
#include "chain/exact_solution.h"
#include "support/units.h"
#include "support/statistics.h"
#include "support/usage_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace drumlin::post {

namespace {

bool same(const ChainParameters &a, const ChainParameters &b) {
  return a.transition == b.transition &&
         std::all_of(chain_numbers.begin(), chain_numbers.end(), [&](const ChainNumber &number) {
           return std::fabs(a.*number.value - b.*number.value) <= 1e-12 * std::fabs(b.*number.value);
         });
}

double ChainErrors::*column(ErrorMeasure measure) {
  switch (measure) {
  case ErrorMeasure::velocity:
    return &ChainErrors::velocity;
  case ErrorMeasure::force:
    return &ChainErrors::force;
  case ErrorMeasure::acceleration:
    return &ChainErrors::acceleration;
  }
  return nullptr;
}

/// h per step and cycle: the resolution of a run of N steps per cycle is this over N.
double resolution(const ChainParameters &p) { return p.period() * std::max(p.omega, std::sqrt(p.k / p.m2)); }

/// Time of a step, from long runs only: in short ones the start of the program counts.
double seconds_per_step(const std::vector<ChainPoint> &points, const std::string &stepping) {
  int most = 0;
  for (const ChainPoint &point : points)
    if (point.stepping == stepping) most = std::max(most, point.steps_per_cycle);
  std::vector<double> seconds;
  for (const ChainPoint &point : points)
    if (point.stepping == stepping && 4 * point.steps_per_cycle >= most)
      seconds.push_back(point.errors.loop_s / (accuracy_cycles * point.steps_per_cycle));
  return median(seconds);
}

} // namespace

double sensitivity(const ChainParameters &parameters, const SolverProgress &progress) {
  constexpr double change = 1e-6;
  constexpr std::array numbers = {&ChainParameters::k, &ChainParameters::D, &ChainParameters::m2};
  std::size_t solved = 0;
  const auto solution = [&](const ChainParameters &chain) {
    std::vector<double> v_drum = accuracy_reference(chain, [&](double share) {
                                   if (progress)
                                     progress((static_cast<double>(solved) + share) / (1.0 + numbers.size()));
                                 }).history.v_drum;
    ++solved;
    return v_drum;
  };
  const std::vector<double> reference = solution(parameters);
  double sum = 0.0;
  for (const auto number : numbers) {
    ChainParameters other = parameters;
    other.*number *= 1.0 + change;
    if (!other.invalid().empty())
      other.*number = parameters.*number * (1.0 - change); // at the end of its range
    const std::size_t rows = reference.size();
    const double grown =
        relative_rms(solution(other), reference, rows - 1 - accuracy_window * accuracy_samples, rows);
    sum += grown * grown / (change * change);
  }
  return std::sqrt(sum);
}

double slowest_excitation(const ChainParameters &parameters) {
  return parameters.omega * accuracy_cycles / most_cycles(parameters);
}

double critical_steps(const ChainParameters &parameters, const std::string &stepping) {
  const ChainParameters &p = parameters;
  const double damped = stepping == "stock" ? 2.0 : 0.0;
  const auto stable = [&](double dt) {
    const double contact = damped * dt * p.damping() + dt * dt * p.k;
    const double bond = damped * dt * p.c23 + dt * dt * p.k23;
    const double drum = 4.0 * p.m2 - contact - bond, frame = 4.0 * p.m3 - bond;
    return drum > 0.0 && frame > 0.0 && drum * frame > bond * bond;
  };
  double low = 0.0, high = 2.0 * std::sqrt(p.m2 / p.k); // limit of the spring alone: no chain exceeds it
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return p.period() / high;
}

StepAdvice advise(const AdviceRequest &request, const std::vector<ChainPoint> &points,
                  const std::function<double(const ChainParameters &)> &remembered) {
  const auto sensitivity_of = [&](const ChainParameters &chain) {
    return remembered ? remembered(chain) : sensitivity(chain);
  };
  const ChainParameters &p = request.parameters;
  const double order = request.stepping == "second" ? 2.0 : 1.0;
  StepAdvice advice;
  advice.critical_steps = critical_steps(p, request.stepping);

  double needed = 0.0;
  const auto curve_of = [&](const char *name) {
    return chain_curve(points, name, p.transition, request.stepping, column(request.measure));
  };
  for (const char *name : table1_cases)
    if (same(p, table1_case(name, p.transition)))
      if (const std::optional<double> steps = steps_needed(curve_of(name), request.error)) {
        advice.measured = true;
        advice.from = name;
        needed = *steps;
      }
  if (!advice.measured) {
    advice.sensitivity = sensitivity_of(p);
    if (!(advice.sensitivity <= most_sensitive))
      throw UsageError(
          refusal("the sensitivity of the chain", fmt::format("{:.2g}", advice.sensitivity),
                  fmt::format("at most {:g}; no step can be advised where a relative change of k, D and m2 "
                              "grows so much in the drum's velocity within {} cycles",
                              most_sensitive, accuracy_cycles)));
    for (const char *name : table1_cases) {
      const ChainParameters known = table1_case(name, p.transition);
      const std::vector<ErrorPoint> curve = curve_of(name);
      if (curve.empty()) continue;
      const double error = request.error * sensitivity_of(known) / advice.sensitivity;
      const std::optional<double> steps = steps_for(curve, error, order);
      if (!steps) continue;
      const double scaled = scaling_margin * *steps * resolution(p) / resolution(known);
      if (scaled < needed) continue;
      needed = scaled;
      advice.from = name;
    }
  }
  if (advice.from.empty())
    throw UsageError(refusal("--stepping", request.stepping,
                             fmt::format("one of which the study has a curve under transition {}",
                                         transition_name(p.transition))));
  needed = std::max(needed, stability_margin * advice.critical_steps);
  constexpr double most_steps = 1e8; // allowed by in.chain
  if (!(needed <= most_steps))
    throw UsageError(
        refusal("--error", fmt::format("{:g}", request.error),
                fmt::format("errors for which {:g} steps per cycle are enough; this one takes {:.2g}",
                            most_steps, needed)));
  advice.steps_per_cycle = advised_multiple * static_cast<int>(std::ceil(needed / advised_multiple));
  advice.seconds_per_step = seconds_per_step(points, request.stepping);
  return advice;
}

std::string outside_of_tests(const ChainParameters &parameters, const std::vector<ScalingPoint> &points) {
  struct Tested {
    const char *name;
    const char *unit;
    double (*of)(const ChainParameters &);
  };
  const Tested quantities[] = {
      {"sqrt(k/m2)", " rad/s", [](const ChainParameters &p) { return std::sqrt(p.k / p.m2); }},
      {"omega", " rad/s", [](const ChainParameters &p) { return p.omega; }},
      {"D", "", [](const ChainParameters &p) { return p.D; }}};
  std::string text;
  for (const Tested &quantity : quantities) {
    double low = std::numeric_limits<double>::infinity(), high = 0.0;
    for (const ScalingPoint &point : points) {
      low = std::min(low, quantity.of(point.parameters));
      high = std::max(high, quantity.of(point.parameters));
    }
    const double value = quantity.of(parameters);
    if (points.empty() || (value >= low && value <= high)) continue;
    text += fmt::format("{}{} = {:.3g}{}, tested from {:.3g} to {:.3g}", text.empty() ? "" : "; ",
                        quantity.name, value, quantity.unit, low, high);
  }
  return text;
}

std::string scaling_summary(const std::vector<ScalingPoint> &points) {
  std::set<double> chains; // by their k
  std::size_t kept = 0;
  double worst = 0.0;
  for (const ScalingPoint &point : points) {
    chains.insert(point.parameters.k);
    if (point.error <= point.target) ++kept;
    worst = std::max(worst, point.error / point.target);
  }
  if (points.empty()) return "not tested on other parameter sets";
  return fmt::format("tested on {} other parameter sets: {} of {} runs kept the error asked for; the worst "
                     "had {:.2g} times as much",
                     chains.size(), kept, points.size(), worst);
}

ExactSolution accuracy_reference(const ChainParameters &parameters, const SolverProgress &progress) {
  ExactOptions options;
  options.cycles = accuracy_cycles;
  options.samples_per_cycle = accuracy_samples;
  return solve_chain(parameters, options, progress);
}

namespace {

/// The column "transition" of the member that `of(row)` refers to.
template <class Row, class Of>
CsvColumn<Row> transition_column(Of of) {
  return {"transition", [of](const Row &row) { return transition_name(of(row)); },
          [of](Row &row, const std::string &cell) {
            if (cell != "A" && cell != "B") throw std::invalid_argument("A, B");
            of(row) = transition_from_name(cell);
          }};
}

} // namespace

const CsvSchema<ChainPoint> &chain_points() {
  const auto error = [](const char *name, double ChainErrors::*value) {
    return csv_column(name, &ChainPoint::errors, value);
  };
  static const CsvSchema<ChainPoint> schema(
      {csv_column("case", &ChainPoint::chain_case),
       transition_column<ChainPoint>([](auto &row) -> auto & { return row.transition; }),
       csv_column("stepping", &ChainPoint::stepping),
       csv_column("steps_per_cycle", &ChainPoint::steps_per_cycle),
       error("velocity_error", &ChainErrors::velocity), error("force_error", &ChainErrors::force),
       error("acceleration_error", &ChainErrors::acceleration), error("loop_s", &ChainErrors::loop_s)},
      4);
  return schema;
}

const CsvSchema<ScalingPoint> &scaling_points() {
  const auto parameter = [](const char *name, double ChainParameters::*value) {
    return csv_column(name, &ScalingPoint::parameters, value);
  };
  static const CsvSchema<ScalingPoint> schema(
      {csv_column("stepping", &ScalingPoint::stepping), csv_column("target_error", &ScalingPoint::target),
       transition_column<ScalingPoint>([](auto &row) -> auto & { return row.parameters.transition; }),
       parameter("k_N_per_m", &ChainParameters::k), parameter("D", &ChainParameters::D),
       parameter("omega_rad_per_s", &ChainParameters::omega), parameter("Fw_N", &ChainParameters::Fw),
       parameter("m2_kg", &ChainParameters::m2), parameter("m3_kg", &ChainParameters::m3),
       parameter("k23_N_per_m", &ChainParameters::k23), parameter("c23_N_s_per_m", &ChainParameters::c23),
       parameter("g_m_per_s2", &ChainParameters::g),
       csv_column("steps_per_cycle", &ScalingPoint::steps_per_cycle),
       csv_column("velocity_error", &ScalingPoint::error)},
      4);
  return schema;
}

std::vector<ErrorPoint> chain_curve(const std::vector<ChainPoint> &points, const std::string &chain_case,
                                    Transition transition, const std::string &stepping,
                                    double ChainErrors::*error) {
  std::vector<ErrorPoint> curve;
  for (const ChainPoint &point : points)
    if (point.chain_case == chain_case && point.transition == transition && point.stepping == stepping)
      curve.push_back({static_cast<double>(point.steps_per_cycle), point.errors.*error});
  std::sort(curve.begin(), curve.end(),
            [](const ErrorPoint &a, const ErrorPoint &b) { return a.steps < b.steps; });
  return curve;
}

} // namespace drumlin::post
