#include "lab/studies.h"

#include "advice/steps.h"
#include "experiment/study.h"
#include "lab/accuracy/page.h"
#include "lab/accuracy/results.h"
#include "support/progress.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include <fmt/format.h>

namespace drumlin::post {

namespace {

/// The points to be measured.
struct Points {
  std::vector<ChainPoint> chain; ///< coarse first
  std::vector<ImpactPoint> impacts;
};

/// Two step counts per octave up to a last one, all multiples of the samples per cycle.
std::vector<int> step_counts(int first, int last) {
  std::vector<int> counts;
  for (const int start : {50, 150}) // 50, 100, 200, ... and 150, 300, ...
    for (int steps = start; steps <= last; steps *= 2)
      if (steps >= first) counts.push_back(steps);
  std::sort(counts.begin(), counts.end());
  return counts;
}

Points points_of(bool quick) {
  Points points;
  const std::vector<std::string> cases =
      quick ? std::vector<std::string>{"II"} : std::vector<std::string>{"I", "II", "III", "IV"};
  const int first = quick ? 200 : 50;
  const auto add = [&](Transition transition, const char *stepping, int last) {
    for (const std::string &name : cases)
      for (const int steps : step_counts(first, last))
        points.chain.push_back({name, transition, stepping, steps, {}});
  };
  for (const Transition transition : {Transition::A, Transition::B}) {
    add(transition, "second", quick ? 400 : 12800);
    add(transition, "stock", quick ? 400 : 204800);
  }
  add(Transition::B, "reference", quick ? 400 : 204800);
  std::stable_sort(points.chain.begin(), points.chain.end(), [](const ChainPoint &a, const ChainPoint &b) {
    return a.steps_per_cycle < b.steps_per_cycle;
  });

  for (const double steps : quick ? std::vector<double>{50, 100, 200}
                                  : std::vector<double>{12.5, 25, 50, 100, 200, 400, 800, 1600})
    for (const Transition transition : {Transition::A, Transition::B})
      for (const double ratio : quick ? std::vector<double>{0.5} : std::vector<double>{0.2, 0.5, 0.8, 2.0})
        for (const char *stepping : {"second", "stock"})
          if (transition == Transition::B || ratio < 1.0) // else there is no rebound
            points.impacts.push_back({transition, ratio, stepping, steps, {}});
  return points;
}

/// The reference solutions, each computed when it is first needed.
class References {
public:
  const ExactSolution &of(const std::string &chain_case, Transition transition) {
    const std::string name = chain_case + transition_name(transition);
    auto found = known_.find(name);
    if (found == known_.end())
      found = known_.emplace(name, accuracy_reference(table1_case(chain_case, transition))).first;
    return found->second;
  }

private:
  std::map<std::string, ExactSolution> known_;
};

/// Uniform numbers that are the same everywhere: the distributions of the standard library are not.
class Draw {
public:
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  double between_decades(double low, double high) { return low * std::pow(high / low, between(0.0, 1.0)); }

private:
  std::mt19937 engine_{2018};
};

/// Chains with random parameters: soft to stiff, hardly to heavily damped, with little to much loss of
/// contact.
ChainParameters drawn(Draw &draw, Transition transition) {
  ChainParameters p;
  p.transition = transition;
  p.k = draw.between_decades(5e6, 4e8);
  p.D = draw.between_decades(0.15, 3.0);
  p.omega = 2.0 * std::acos(-1.0) * draw.between(15.0, 45.0);
  p.Fw = draw.between(30e3, 100e3);
  p.m2 = draw.between(1500.0, 3000.0);
  p.m3 = draw.between(500.0, 1500.0);
  p.k23 = draw.between_decades(5e5, 2e6);
  p.c23 = draw.between_decades(5e3, 2e4);
  return p;
}

/// sensitivity(), computed once for each chain.
class Sensitivities {
public:
  double of(const ChainParameters &parameters) {
    const std::vector<std::string> name = scaling_points().cells({0, "", 0.0, parameters, 0, 0.0});
    const auto found = known_.find(name);
    return found != known_.end() ? found->second : known_[name] = sensitivity(parameters);
  }

private:
  std::map<std::vector<std::string>, double> known_;
};

/// The points of scaling.csv. Chains for which no number of steps can be advised are not run, and the file
/// has no row with their number.
std::vector<ScalingPoint> scaling_plan(bool quick, Sensitivities &sensitivities) {
  std::vector<ScalingPoint> plan;
  const std::size_t sets = quick ? 1 : 12;
  Draw draw;
  for (int set = 1; plan.size() < (quick ? 1 : 3) * sets; ++set) {
    const ChainParameters p = drawn(draw, set % 2 == 0 ? Transition::A : Transition::B);
    if (!(sensitivities.of(p) <= most_sensitive)) continue;
    plan.push_back({set, "second", 1e-3, p, 0, 0.0});
    if (quick) continue;
    plan.push_back({set, "second", 1e-4, p, 0, 0.0});
    plan.push_back({set, "stock", 1e-2, p, 0, 0.0});
  }
  return plan;
}

void measure(std::vector<ImpactPoint> plan, int phases, ResumedTable &results, CountedProgress &progress) {
  for (ImpactPoint &point : plan) {
    if (results.has(impact_points().key(point))) {
      progress.found();
      continue;
    }
    point.errors = measure_impacts(point.transition, point.damping_ratio, point.stepping,
                                   point.steps_per_contact, phases);
    results.add(impact_points().cells(point));
    progress.measured(fmt::format("impacts {}, D = {:g}, {}, {:g} steps per contact",
                                  transition_name(point.transition), point.damping_ratio, point.stepping,
                                  point.steps_per_contact));
  }
  results.finish();
}

void measure(std::vector<ChainPoint> plan, ResumedTable &results, CountedProgress &progress) {
  References references;
  for (ChainPoint &point : plan) {
    if (results.has(chain_points().key(point))) {
      progress.found();
      continue;
    }
    const ExactSolution &reference = references.of(point.chain_case, point.transition);
    point.errors = point.stepping == "reference"
                       ? measure_engine_law(point.chain_case, point.steps_per_cycle, reference)
                       : measure_chain(table1_case(point.chain_case, point.transition), point.stepping,
                                       point.steps_per_cycle, reference);
    results.add(chain_points().cells(point));
    progress.measured(fmt::format("chain {} {}, {}, {} steps per cycle", point.chain_case,
                                  transition_name(point.transition), point.stepping, point.steps_per_cycle));
  }
  results.finish();
}

void measure(std::vector<ScalingPoint> plan, const std::vector<ChainPoint> &known,
             Sensitivities &sensitivities, ResumedTable &results, CountedProgress &progress) {
  for (ScalingPoint &point : plan) {
    if (results.has(scaling_points().key(point))) {
      progress.found();
      continue;
    }
    AdviceRequest request;
    request.parameters = point.parameters;
    request.stepping = point.stepping;
    request.error = point.target;
    point.steps_per_cycle =
        advise(request, known, [&](const ChainParameters &p) { return sensitivities.of(p); }).steps_per_cycle;
    point.error = measure_chain(point.parameters, point.stepping, point.steps_per_cycle,
                                accuracy_reference(point.parameters))
                      .velocity;
    results.add(scaling_points().cells(point));
    progress.measured(fmt::format("scaling, set {}, {}, error {:g}, {} steps per cycle", point.set,
                                  point.stepping, point.target, point.steps_per_cycle));
  }
  results.finish();
}

} // namespace

void run_accuracy_study(const StudyOptions &options) {
  const Points points = points_of(options.quick);
  Sensitivities sensitivities;
  const std::vector<ScalingPoint> other_chains = scaling_plan(options.quick, sensitivities);
  ResumedTable chain(options.out / "chain.csv", chain_points());
  ResumedTable impacts(options.out / "impacts.csv", impact_points());
  ResumedTable scaling(options.out / "scaling.csv", scaling_points());
  CountedProgress progress(points.chain.size() + points.impacts.size() + other_chains.size());

  measure(points.impacts, options.quick ? 8 : 64, impacts, progress);
  measure(points.chain, chain, progress);
  measure(other_chains, read_points(chain.file(), chain_points()), sensitivities, scaling, progress);
  write_accuracy_page(options.out, !options.quick);
  fmt::print("{}\n", (options.out / "index.html").string());
}

} // namespace drumlin::post
