#include "study_accuracy.h"

#include "accuracy_results.h"
#include "study.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace drumlin::post {

namespace {

/// What is to be measured.
struct Plan {
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

Plan plan_of(bool quick) {
  Plan plan;
  const std::vector<std::string> cases =
      quick ? std::vector<std::string>{"II"} : std::vector<std::string>{"I", "II", "III", "IV"};
  const int first = quick ? 100 : 50;
  const auto add = [&](Transition transition, const char *stepping, int last) {
    for (const std::string &name : cases)
      for (const int steps : step_counts(first, last))
        plan.chain.push_back({name, transition, stepping, steps, {}});
  };
  for (const Transition transition : {Transition::A, Transition::B}) {
    add(transition, "second", quick ? 400 : 12800);
    add(transition, "stock", quick ? 800 : 204800);
  }
  add(Transition::B, "reference", quick ? 800 : 204800);
  std::stable_sort(plan.chain.begin(), plan.chain.end(), [](const ChainPoint &a, const ChainPoint &b) {
    return a.steps_per_cycle < b.steps_per_cycle;
  });

  for (double steps = quick ? 50.0 : 12.5; steps <= (quick ? 200.0 : 1600.0); steps *= 2.0)
    for (const Transition transition : {Transition::A, Transition::B})
      for (const double ratio : quick ? std::vector<double>{0.5} : std::vector<double>{0.2, 0.5, 0.8, 2.0})
        for (const char *stepping : {"second", "stock"})
          if (transition == Transition::B || ratio < 1.0) // else nothing rebounds
            plan.impacts.push_back({transition, ratio, stepping, steps, {}});
  return plan;
}

template <typename Point>
std::vector<std::string> key(const Point &point, std::size_t keys) {
  std::vector<std::string> row = cells(point);
  row.resize(keys);
  return row;
}

/// The direct solutions, each made when it is first asked for.
class Truths {
public:
  const DirectResult &of(const std::string &chain_case, Transition transition) {
    const std::string name = chain_case + transition_name(transition);
    auto found = known_.find(name);
    if (found == known_.end())
      found = known_.emplace(name, accuracy_truth(table1_case(chain_case, transition))).first;
    return found->second;
  }

private:
  std::map<std::string, DirectResult> known_;
};

} // namespace

void run_accuracy_study(const StudyOptions &options) {
  const Plan plan = plan_of(options.quick);
  StudyResults chain(options.out / "chain.csv", chain_point_columns, chain_point_keys);
  StudyResults impacts(options.out / "impacts.csv", impact_point_columns, impact_point_keys);
  StudyProgress progress(plan.chain.size() + plan.impacts.size());
  Truths truths;

  for (ImpactPoint point : plan.impacts) {
    if (impacts.find(key(point, impact_point_keys)) != nullptr) {
      progress.found();
      continue;
    }
    point.errors = measure_impacts(point.transition, point.damping_ratio, point.stepping,
                                   point.steps_per_contact, options.quick ? 8 : 64);
    impacts.add(cells(point));
    progress.measured(fmt::format("impacts, {}, D = {:g}, {}, {:g} steps per contact",
                                  transition_name(point.transition), point.damping_ratio, point.stepping,
                                  point.steps_per_contact));
  }
  for (ChainPoint point : plan.chain) {
    if (chain.find(key(point, chain_point_keys)) != nullptr) {
      progress.found();
      continue;
    }
    const DirectResult &truth = truths.of(point.chain_case, point.transition);
    point.errors = point.stepping == "reference"
                       ? measure_reference(point.chain_case, point.steps_per_cycle, truth)
                       : measure_chain(table1_case(point.chain_case, point.transition), point.stepping,
                                       point.steps_per_cycle, truth);
    chain.add(cells(point));
    progress.measured(fmt::format("chain {} {}, {}, {} steps per cycle", point.chain_case,
                                  transition_name(point.transition), point.stepping, point.steps_per_cycle));
  }
}

} // namespace drumlin::post
