#include "calibration/calibration.h"

#include "calibration/search.h"
#include "studies/placed_bed.h"
#include "studies/study.h"
#include "support/csv.h"
#include "support/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <mutex>
#include <stdexcept>

namespace drumlin::post {

namespace {

/// Scatter of the objective between points, relative to its range: dlib then does not follow differences below it.
constexpr double search_noise = 0.01;
/// Evaluations that fail from the first on, after which a calibration is given up.
constexpr std::size_t hopeless = 4;

/// The function that the search minimises: ln(1 + objective). It equals the objective near the targets. Far from them the
/// objective is so steep that its Lipschitz constant would give the search no useful bound; the logarithm is flatter.
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
    // Slopes are measured around the best of the search alone, and the estimate comes from these two stages, so that a continued
    // calibration finds the points of both among its evaluations.
    evaluate(slope_points(task_, best_of(task_, until(Stage::search))->point), Stage::slopes);
    const std::vector<Evaluation> before = until(Stage::slopes);
    const Evaluation centre = *best_of(task_, before);
    if (const Sensitivity first = sensitivity_at(task_, before, centre); first.identified())
      evaluate({estimate(first, centre.point)}, Stage::estimate);
    const Evaluation last = *best_of(task_, evaluations_);
    return {evaluations_, last, sensitivity_at(task_, evaluations_, last)};
  }

private:
  /// Evaluations times seeds, at most: a continued calibration may have made some of those beside its best point.
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
    std::vector<std::function<void()>> tasks;
    for (Evaluation &evaluation : evaluations_)
      for (int seed = 1; seed <= task_.seeds; ++seed)
        if (std::none_of(evaluation.seeds.begin(), evaluation.seeds.end(),
                         [seed](const SeedResult &one) { return one.seed == seed; }))
          tasks.emplace_back([this, &evaluation, seed] { measure_one(evaluation, seed); });
    in_parallel(tasks, effort_.jobs);
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
          throw std::runtime_error(
              fmt::format("{} is {:.3g}: not above zero", task_.targets[i].name, result.values[i]));
    } catch (const std::exception &fault) { // a failed run is a result, too
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
      Evaluation fresh;
      fresh.number = evaluations_.empty() ? 1 : evaluations_.back().number + 1;
      fresh.stage = stage;
      fresh.point = point;
      evaluations_.push_back(fresh);
    }
    complete();
    refuse_hopeless(hopeless);
  }

  double searched_value(const Evaluation &evaluation) const {
    if (evaluation.good(task_)) return compressed(evaluation.objective(task_));
    double worst = compressed(1.0);
    for (const Evaluation &one : evaluations_)
      if (one.good(task_)) worst = std::max(worst, compressed(one.objective(task_)));
    return worst;
  }

  const Evaluation *at(const std::vector<double> &point) const {
    const auto found = std::find_if(evaluations_.begin(), evaluations_.end(),
                                    [&point](const Evaluation &one) { return same_point(one.point, point); });
    return found == evaluations_.end() ? nullptr : &*found;
  }

  void search() {
    std::vector<SearchPoint> earlier;
    earlier.reserve(evaluations_.size());
    for (const Evaluation &one : evaluations_)
      earlier.push_back({unit_point(task_, one.point), searched_value(one)});
    PointSearch search(task_.vary.size(), search_noise, earlier);
    // As many points at a time as give work to all jobs. The search can name a point again: then it has converged as far as six
    // digits go.
    const int at_once = std::max(1, effort_.jobs / task_.seeds);
    int done = searched();
    while (done < effort_.evaluations) {
      std::vector<std::vector<double>> points;
      for (int i = 0; i < std::min(at_once, effort_.evaluations - done); ++i)
        points.push_back(point_at(task_, search.next()));
      evaluate(points, Stage::search);
      std::vector<double> values;
      values.reserve(points.size());
      for (const std::vector<double> &point : points)
        values.push_back(searched_value(*at(point)));
      search.give(values);
      done += static_cast<int>(points.size());
    }
    refuse_hopeless(1);
  }

  /// Throws if none of the evaluations succeeded, `least` of them or more.
  void refuse_hopeless(std::size_t least) const {
    if (evaluations_.size() >= least && best_of(task_, evaluations_) == nullptr)
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

  /// The point at which the fitted linear model meets the targets, moved back into the ranges of the parameters. It also stays so
  /// close to the best evaluated point that a fit around it can use the evaluations that exist already.
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
  StudyResults results_;
  std::vector<Evaluation> evaluations_;
  CountedProgress progress_;
};

} // namespace

Calibration calibrate(const CalibrationTask &task, const CalibrationEffort &effort,
                      const std::filesystem::path &out, const MeasureSeed &measure) {
  return Run(task, effort, out, measure).finish();
}

} // namespace drumlin::post
