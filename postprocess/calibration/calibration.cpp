#include "calibration/calibration.h"

#include "calibration/evaluations.h"
#include "engine/deck_run.h"
#include "support/parallel.h"
#include "support/progress.h"
#include "support/units.h"
#include "support/resumed.h"
#include "support/usage_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <mutex>
#include <set>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

namespace {

/// Scatter of the objective between points, relative to its range: dlib then does not follow differences
/// below it.
constexpr double search_noise = 0.01;
/// Evaluations that fail from the first on, after which a calibration is given up.
constexpr std::size_t hopeless = 4;

/// The function that the search minimises: ln(1 + objective). It equals the objective near the targets. Far
/// from them the objective is so steep that its Lipschitz constant would give the search no useful bound; the
/// logarithm is flatter.
double compressed(double objective) { return std::log1p(objective); }

bool same_point(const std::vector<double> &a, const std::vector<double> &b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::fabs(a[i] - b[i]) > 1e-9 * std::fabs(b[i])) return false;
  return true;
}

class Run {
public:
  Run(const CalibrationTask &task, const CalibrationEffort &effort, const std::filesystem::path &out,
      const MeasureSeed &measure)
      : task_(task), effort_(effort), measure_(measure),
        results_(out / evaluations_name, evaluation_header(task), evaluation_keys),
        evaluations_(read_evaluations(task, results_.file())), progress_(planned()) {
    for (const Evaluation &evaluation : evaluations_)
      for (std::size_t i = 0; i < evaluation.seeds.size(); ++i)
        progress_.found();
    complete(); // seeds that an interrupted call did not measure
  }

  Calibration finish() {
    search();
    // Slopes are measured around the best of the search alone, and the estimate comes from these two stages,
    // so that a continued calibration finds the points of both among its evaluations.
    const std::vector<Evaluation> searched = until(Stage::search);
    evaluate(slope_points(task_, best_of(task_, searched)->point), Stage::slopes);
    const std::vector<Evaluation> before = until(Stage::slopes);
    const Evaluation centre = *best_of(task_, before);
    if (const Sensitivity first = sensitivity_at(task_, before, centre); first.identified())
      evaluate({estimate(first, centre.point)}, Stage::estimate);
    for (const Evaluation &evaluation : evaluations_)
      for (const SeedResult &result : evaluation.seeds)
        results_.has({std::to_string(evaluation.number), std::to_string(result.seed)});
    results_.finish();
    const Evaluation last = *best_of(task_, evaluations_);
    return {evaluations_, last, sensitivity_at(task_, evaluations_, last)};
  }

private:
  /// Evaluations times seeds, at most: a continued calibration may have made some of those beside its best
  /// point.
  std::size_t planned() const {
    const auto left = static_cast<std::size_t>(std::max(0, effort_.evaluations - searched()));
    return (evaluations_.size() + left + 2 * task_.vary.size() + 1) * static_cast<std::size_t>(task_.seeds);
  }

  /// How many evaluations the search has made.
  int searched() const {
    return static_cast<int>(std::count_if(evaluations_.begin(), evaluations_.end(),
                                          [](const Evaluation &one) { return one.stage == Stage::search; }));
  }

  /// Measures the seeds that evaluations lack, several at the same time.
  void complete() {
    std::vector<std::pair<Evaluation *, int>> missing;
    for (Evaluation &evaluation : evaluations_)
      for (int seed = 1; seed <= task_.seeds; ++seed)
        if (std::none_of(evaluation.seeds.begin(), evaluation.seeds.end(),
                         [seed](const SeedResult &one) { return one.seed == seed; }))
          missing.emplace_back(&evaluation, seed);
    in_parallel(missing.size(), effort_.jobs,
                [&](std::size_t i) { measure_one(*missing[i].first, missing[i].second); });
    for (Evaluation &evaluation : evaluations_)
      std::sort(evaluation.seeds.begin(), evaluation.seeds.end(),
                [](const SeedResult &a, const SeedResult &b) { return a.seed < b.seed; });
  }

  void measure_one(Evaluation &evaluation, int seed) {
    SeedResult result{seed, {}, {}};
    try {
      result.values = measure_(evaluation, seed);
      for (std::size_t i = 0; i < result.values.size(); ++i)
        if (!(result.values[i] > 0.0))
          throw SceneFault(
              fmt::format("{} is {:.3g}: not above zero", task_.targets[i].name, result.values[i]));
    } catch (const SceneFault &fault) { // which is a result, too
      result.values.clear();
      result.failure = fault.what();
    }
    const std::lock_guard lock(mutex_);
    results_.add(evaluation_row(evaluation, result, task_.targets.size()));
    evaluation.seeds.push_back(result);
    progress_.measured(words(evaluation, result));
  }

  std::string words(const Evaluation &evaluation, const SeedResult &result) const {
    std::string text = fmt::format("evaluation {}, seed {}:", evaluation.number, result.seed);
    for (std::size_t i = 0; i < task_.vary.size(); ++i)
      text += fmt::format(" {} {:.4g}", task_.vary[i].name, evaluation.point[i]);
    text += " ->";
    for (std::size_t i = 0; i < result.values.size(); ++i)
      text += fmt::format(" {} {:.4g}", task_.targets[i].name, result.values[i]);
    return result.failure.empty() ? text : text + " " + result.failure;
  }

  /// Evaluates points that are not yet among the evaluations.
  void evaluate(const std::vector<std::vector<double>> &points, Stage stage) {
    for (const std::vector<double> &point : points) {
      if (std::any_of(evaluations_.begin(), evaluations_.end(),
                      [&point](const Evaluation &one) { return same_point(one.point, point); }))
        continue;
      // The smallest free number: of points that were measured at the same time, an interruption can have
      // left the later ones.
      Evaluation fresh;
      auto place = evaluations_.begin();
      for (fresh.number = 1; place != evaluations_.end() && place->number == fresh.number; ++place)
        ++fresh.number;
      fresh.stage = stage;
      fresh.point = point;
      evaluations_.insert(place, fresh);
    }
    complete();
    refuse_hopeless(hopeless);
  }

  /// The value that the search gets for an evaluation when those up to `last` are known.
  double searched_value(const Evaluation &evaluation, int last) const {
    if (evaluation.good(task_)) return compressed(evaluation.objective(task_));
    double worst = compressed(1.0);
    for (const Evaluation &one : evaluations_)
      if (one.number <= last && one.good(task_)) worst = std::max(worst, compressed(one.objective(task_)));
    return worst;
  }

  const Evaluation *at(const std::vector<double> &point) const {
    const auto found = std::find_if(evaluations_.begin(), evaluations_.end(),
                                    [&point](const Evaluation &one) { return same_point(one.point, point); });
    return found == evaluations_.end() ? nullptr : &*found;
  }

  /// Searches from points that are known already, or from the beginning: that is repeated with the values of
  /// the evaluations that an earlier call has made. Returns false if these are of another search.
  bool search_from(const std::vector<SearchPoint> &known, int done) {
    PointSearch search(task_.vary.size(), search_noise, known);
    const int earlier = known.empty() ? searched() : 0;
    std::set<int> repeated;
    int last = 0;
    // The search can name a point again: then it has converged as far as six digits go.
    while (done < effort_.evaluations) {
      std::vector<std::vector<double>> points;
      bool all = true; // are there already
      for (int i = 0; i < std::min(effort_.at_once, effort_.evaluations - done); ++i) {
        points.push_back(point_at(task_, search.next()));
        const Evaluation *one = at(points.back());
        all = all && one != nullptr;
        if (one != nullptr && one->stage == Stage::search) repeated.insert(one->number);
      }
      if (!all && static_cast<int>(repeated.size()) < earlier) return false;
      if (!all && !said_ && evaluations_.size() > static_cast<std::size_t>(searched())) {
        said_ = true;
        print_progress(
            "the search goes on after its end: evaluations have other numbers than those of a calibration "
            "with as many evaluations from the start, and slopes that were measured before count, too");
      }
      evaluate(points, Stage::search);
      for (const std::vector<double> &point : points)
        last = std::max(last, at(point)->number);
      std::vector<double> values;
      values.reserve(points.size());
      for (const std::vector<double> &point : points)
        values.push_back(searched_value(*at(point), last));
      search.give(values);
      done += static_cast<int>(points.size());
    }
    return true;
  }

  void search() {
    if (searched() < effort_.evaluations && !search_from({}, 0)) {
      print_progress("the evaluations that are there are of another search: further points are others than "
                     "those of a calibration without an interruption");
      std::vector<SearchPoint> known;
      known.reserve(evaluations_.size());
      for (const Evaluation &one : evaluations_)
        known.push_back({unit_point(task_, one.point), searched_value(one, evaluations_.back().number)});
      search_from(known, searched());
    }
    refuse_hopeless(1);
  }

  /// Throws if none of the evaluations succeeded, `least` of them or more.
  void refuse_hopeless(std::size_t least) const {
    if (evaluations_.size() >= least && best_of(task_, until(Stage::search)) == nullptr)
      throw std::runtime_error(fmt::format("none of {} evaluations succeeded; the last one: {}",
                                           evaluations_.size(), evaluations_.back().failure()));
  }

  /// The evaluations of the stages up to one.
  std::vector<Evaluation> until(Stage stage) const {
    std::vector<Evaluation> earlier;
    std::copy_if(evaluations_.begin(), evaluations_.end(), std::back_inserter(earlier),
                 [stage](const Evaluation &one) { return one.stage <= stage; });
    return earlier;
  }

  /// The point at which the fitted linear model meets the targets, moved back into the ranges of the
  /// parameters. It also stays so close to the best evaluated point that a fit around it can use the
  /// evaluations that exist already.
  std::vector<double> estimate(const Sensitivity &sensitivity, const std::vector<double> &centre) const {
    const double reach = std::exp(fit_reach - slope_step);
    std::vector<double> point;
    point.reserve(centre.size());
    for (std::size_t i = 0; i < centre.size(); ++i)
      point.push_back(std::clamp(sensitivity.parameters[i].value, centre[i] / reach, centre[i] * reach));
    return point_at(task_, unit_point(task_, point));
  }

  const CalibrationTask &task_;
  const CalibrationEffort &effort_;
  const MeasureSeed &measure_;
  std::mutex mutex_; // of results_, evaluations' seeds and progress_
  ResumedTable results_;
  std::vector<Evaluation> evaluations_;
  CountedProgress progress_;
  bool said_ = false; ///< that the search goes on after its end
};

/// Whether the interval of an estimate holds a value.
bool within(const ParameterEstimate &one, double value) { return one.low <= value && value <= one.high; }

} // namespace

bool best_is_within(const Calibration &found) {
  return std::equal(found.best.point.begin(), found.best.point.end(), found.sensitivity.parameters.begin(),
                    [](double value, const ParameterEstimate &one) { return within(one, value); });
}

std::vector<double> found_point(const CalibrationTask &task, const Calibration &found) {
  if (best_is_within(found)) return found.best.point;
  std::vector<double> point;
  for (const ParameterEstimate &one : found.sensitivity.parameters)
    point.push_back(one.value);
  point = point_at(task, unit_point(task, point));
  for (std::size_t i = 0; i < point.size(); ++i)
    if (const ParameterEstimate &one = found.sensitivity.parameters[i]; !within(one, point[i]))
      throw UsageError(refusal(
          "--vary", fmt::format("{}={:g}:{:g}", task.vary[i].name, task.vary[i].low, task.vary[i].high),
          fmt::format("a range with {:.4g}, at which the targets are met by the slopes (95 % confidence "
                      "interval {:.4g} to {:.4g}); no case file is written",
                      one.value, one.low, one.high)));
  return point;
}

Calibration calibrate(const CalibrationTask &task, const CalibrationEffort &effort,
                      const std::filesystem::path &out, const MeasureSeed &measure) {
  return Run(task, effort, out, measure).finish();
}

} // namespace drumlin::post
