#include "studies/step_advice.h"

#include "chain/analysis.h"
#include "chain/direct_solver.h"
#include "studies/study.h"
#include "support/usage_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

namespace drumlin::post {

namespace {

constexpr std::array<const char *, 4> case_names = {"I", "II", "III", "IV"};

constexpr std::array<double ChainParameters::*, 9> all_numbers = {
    &ChainParameters::k,   &ChainParameters::D,   &ChainParameters::omega,
    &ChainParameters::Fw,  &ChainParameters::m2,  &ChainParameters::m3,
    &ChainParameters::k23, &ChainParameters::c23, &ChainParameters::g};

bool same(const ChainParameters &a, const ChainParameters &b) {
  return a.transition == b.transition &&
         std::all_of(all_numbers.begin(), all_numbers.end(), [&](auto number) {
           return std::fabs(a.*number - b.*number) <= 1e-12 * std::fabs(b.*number);
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

/// A start costs more than a step: only long runs tell the time of a step.
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
    std::vector<double> v_drum = accuracy_truth(chain, [&](double share) {
                                   if (progress)
                                     progress((static_cast<double>(solved) + share) / (1.0 + numbers.size()));
                                 }).history.v_drum;
    ++solved;
    return v_drum;
  };
  const std::vector<double> truth = solution(parameters);
  double sum = 0.0;
  for (const auto number : numbers) {
    ChainParameters other = parameters;
    other.*number *= 1.0 + change;
    if (!other.invalid().empty())
      other.*number = parameters.*number * (1.0 - change); // at the end of its range
    const std::size_t rows = truth.size();
    const double grown =
        relative_rms(solution(other), truth, rows - 1 - accuracy_window * accuracy_samples, rows);
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
  double low = 0.0, high = 2.0 * std::sqrt(p.m2 / p.k); // the contact's spring alone: never stable beyond
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
  for (const char *name : case_names)
    if (same(p, table1_case(name, p.transition)))
      if (const std::optional<double> steps = steps_needed(curve_of(name), request.error)) {
        advice.measured = true;
        advice.from = name;
        needed = *steps;
      }
  if (!advice.measured) {
    advice.sensitivity = sensitivity_of(p);
    if (!(advice.sensitivity <= most_sensitive))
      throw UsageError(fmt::format("no step can be advised: a change of 1e-6 in k, D and m2 changes the "
                                   "drum's velocity by {:.2g} within {} "
                                   "cycles; allowed are chains where it grows less than {:g} times",
                                   1e-6 * advice.sensitivity, accuracy_cycles, most_sensitive));
    for (const char *name : case_names) {
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
    throw UsageError(fmt::format("the study has no curve for transition {} and {} stepping",
                                 transition_name(p.transition), request.stepping));
  needed = std::max(needed, stability_margin * advice.critical_steps);
  constexpr double most_steps = 1e8; // what in.chain takes
  if (!(needed <= most_steps))
    throw UsageError(
        fmt::format("--error = '{:g}': would take {:.2g} steps per cycle; allowed are errors that {:g} reach",
                    request.error, needed, most_steps));
  advice.steps_per_cycle = advised_multiple * static_cast<int>(std::ceil(needed / advised_multiple));
  advice.seconds_per_step = seconds_per_step(points, request.stepping);
  return advice;
}

std::string outside_of_tests(const ChainParameters &parameters, const std::vector<ScalingPoint> &points) {
  struct Quantity {
    const char *name;
    const char *unit;
    double (*of)(const ChainParameters &);
  };
  const Quantity quantities[] = {
      {"sqrt(k/m2)", " rad/s", [](const ChainParameters &p) { return std::sqrt(p.k / p.m2); }},
      {"omega", " rad/s", [](const ChainParameters &p) { return p.omega; }},
      {"D", "", [](const ChainParameters &p) { return p.D; }}};
  std::string text;
  for (const Quantity &quantity : quantities) {
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
  std::set<int> sets;
  std::size_t kept = 0;
  double worst = 0.0;
  for (const ScalingPoint &point : points) {
    sets.insert(point.set);
    if (point.error <= point.target) ++kept;
    worst = std::max(worst, point.error / point.target);
  }
  if (points.empty()) return "not tested on other parameter sets";
  return fmt::format(
      "tested on {} other parameter sets: {} of {} runs kept the error asked for; the worst had "
      "{:.2g} times as much",
      sets.size(), kept, points.size(), worst);
}

} // namespace drumlin::post
