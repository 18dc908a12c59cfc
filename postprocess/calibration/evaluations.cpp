#include "calibration/evaluations.h"

#include "support/csv.h"
#include "support/resumed.h"

#include <dlib/global_optimization/global_function_search.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace drumlin::post {

namespace {

constexpr int point_digits = 6;
constexpr std::array<const char *, 3> stage_names = {"search", "slopes", "estimate"};

Stage stage_of(const Table &table, std::size_t row, const std::string &cell) {
  const auto *const found = std::find(stage_names.begin(), stage_names.end(), cell);
  if (found == stage_names.end())
    csv_refusal(table.file(), table.line(row), "stage", cell, "search, slopes, estimate");
  return static_cast<Stage>(found - stage_names.begin());
}

/// Whole numbers of a column, from 1.
std::vector<int> whole_numbers(const Table &table, const std::string &column, int most) {
  std::vector<int> numbers;
  for (const std::string &cell : table.text(column)) {
    const std::optional<long> number = whole_number_from_text(cell);
    if (!number || *number < 1 || *number > most)
      csv_refusal(table.file(), table.line(numbers.size()), column, cell,
                  fmt::format("a whole number from 1 to {}", most));
    numbers.push_back(static_cast<int>(*number));
  }
  return numbers;
}

} // namespace

std::string stage_name(Stage stage) { return stage_names.at(static_cast<std::size_t>(stage)); }

bool Evaluation::finished(const CalibrationTask &task) const {
  return seeds.size() == static_cast<std::size_t>(task.seeds);
}

bool Evaluation::good(const CalibrationTask &task) const { return finished(task) && failure().empty(); }

std::string Evaluation::failure() const {
  for (const SeedResult &result : seeds)
    if (result.values.empty()) return result.failure;
  return {};
}

double Evaluation::mean(std::size_t target) const {
  double sum = 0.0;
  for (const SeedResult &result : seeds)
    sum += std::log(result.values[target]);
  return std::exp(sum / static_cast<double>(seeds.size()));
}

double Evaluation::objective(const CalibrationTask &task) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < task.targets.size(); ++i) {
    const double off = std::log(mean(i) / task.targets[i].value) / task.targets[i].tolerance;
    sum += off * off;
  }
  return sum;
}

const Evaluation *best_of(const CalibrationTask &task, const std::vector<Evaluation> &evaluations) {
  const Evaluation *best = nullptr;
  for (const Evaluation &evaluation : evaluations)
    if (evaluation.good(task) && (best == nullptr || evaluation.objective(task) < best->objective(task)))
      best = &evaluation;
  return best;
}

std::vector<double> unit_point(const CalibrationTask &task, const std::vector<double> &point) {
  std::vector<double> unit;
  for (std::size_t i = 0; i < point.size(); ++i) {
    const VariedParameter &varied = task.vary[i];
    const double share = std::log(point[i] / varied.low) / std::log(varied.high / varied.low);
    unit.push_back(std::clamp(share, 0.0, 1.0));
  }
  return unit;
}

std::vector<double> point_at(const CalibrationTask &task, const std::vector<double> &unit) {
  std::vector<double> point;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const VariedParameter &varied = task.vary[i];
    const double value = varied.low * std::pow(varied.high / varied.low, unit[i]);
    point.push_back(number_from_text(number_text(value, point_digits)));
  }
  return point;
}

std::vector<std::string> evaluation_header(const CalibrationTask &task) {
  std::vector<std::string> header = {"evaluation", "seed", "stage"};
  for (const VariedParameter &parameter : task.vary)
    header.push_back(parameter.name);
  for (const CalibrationTarget &target : task.targets)
    header.push_back("measured " + target.name);
  header.emplace_back("failure");
  return header;
}

std::vector<std::string> evaluation_row(const Evaluation &evaluation, const SeedResult &result,
                                        std::size_t targets) {
  std::vector<std::string> row = {std::to_string(evaluation.number), std::to_string(result.seed),
                                  stage_name(evaluation.stage)};
  for (const double value : evaluation.point)
    row.push_back(number_text(value));
  for (std::size_t i = 0; i < targets; ++i)
    row.push_back(result.values.empty() ? "" : number_text(result.values[i]));
  row.push_back(result.failure);
  return row;
}

std::vector<Evaluation> read_evaluations(const CalibrationTask &task, const std::filesystem::path &file) {
  std::vector<Evaluation> evaluations;
  if (!std::filesystem::exists(file)) return evaluations;
  const Table table = finished_rows(file);
  if (table.header().empty()) return evaluations;
  const std::vector<int> numbers = whole_numbers(table, "evaluation", std::numeric_limits<int>::max()),
                         seeds = whole_numbers(table, "seed", task.seeds);
  const std::vector<std::string> stages = table.text("stage"), failures = table.text("failure");
  std::vector<std::vector<double>> points;
  for (const VariedParameter &parameter : task.vary)
    points.push_back(table.numbers(parameter.name));
  std::vector<std::vector<std::string>> values;
  for (const CalibrationTarget &target : task.targets)
    values.push_back(table.text("measured " + target.name));
  for (std::size_t i = 0; i < table.rows(); ++i) {
    Evaluation one;
    one.number = numbers[i];
    one.stage = stage_of(table, i, stages[i]);
    for (const std::vector<double> &column : points)
      one.point.push_back(column[i]);
    auto found = std::find_if(evaluations.begin(), evaluations.end(),
                              [&one](const Evaluation &other) { return other.number == one.number; });
    if (found == evaluations.end()) found = evaluations.insert(evaluations.end(), one);
    if (found->stage != one.stage || found->point != one.point)
      csv_refusal(file, table.line(i), "evaluation", std::to_string(one.number),
                  "one stage and one point for all its seeds, or --fresh, which measures again");
    if (std::any_of(found->seeds.begin(), found->seeds.end(),
                    [&](const SeedResult &other) { return other.seed == seeds[i]; }))
      refuse_double(table, i, evaluation_keys);
    SeedResult result{seeds[i], {}, failures[i]};
    for (std::size_t j = 0; j < values.size() && result.failure.empty(); ++j) {
      const std::string column = "measured " + task.targets[j].name;
      result.values.push_back(csv_number(file, table.line(i), column, values[j][i]));
      if (!(result.values.back() > 0.0))
        csv_refusal(file, table.line(i), column, values[j][i], "a number above 0");
    }
    found->seeds.push_back(result);
  }
  for (Evaluation &evaluation : evaluations)
    std::sort(evaluation.seeds.begin(), evaluation.seeds.end(),
              [](const SeedResult &a, const SeedResult &b) { return a.seed < b.seed; });
  std::sort(evaluations.begin(), evaluations.end(),
            [](const Evaluation &a, const Evaluation &b) { return a.number < b.number; });
  return evaluations;
}

namespace {

using DlibPoint = dlib::matrix<double, 0, 1>;

DlibPoint uniform_point(std::size_t dimensions, double value) {
  DlibPoint point(static_cast<long>(dimensions));
  point = value;
  return point;
}

} // namespace

struct PointSearch::State {
  dlib::global_function_search search;
  std::vector<dlib::function_evaluation_request> pending;
};

PointSearch::PointSearch(std::size_t dimensions, double noise, const std::vector<SearchPoint> &earlier)
    : state_(std::make_unique<State>()) {
  std::vector<dlib::function_evaluation> known;
  for (const SearchPoint &point : earlier) {
    DlibPoint at(static_cast<long>(dimensions));
    for (std::size_t i = 0; i < dimensions; ++i)
      at(static_cast<long>(i)) = point.at[i];
    known.emplace_back(at, -point.value); // dlib looks for the largest value
  }
  const dlib::function_spec unit(uniform_point(dimensions, 0.0), uniform_point(dimensions, 1.0));
  state_->search = dlib::global_function_search({unit}, {known}, noise);
  state_->search.set_seed(
      static_cast<time_t>(known.size())); // a continued search does not repeat its random points
}

PointSearch::~PointSearch() = default;

std::vector<double> PointSearch::next() {
  state_->pending.push_back(state_->search.get_next_x());
  const DlibPoint &at = state_->pending.back().x();
  return {at.begin(), at.end()};
}

void PointSearch::give(const std::vector<double> &values) {
  for (std::size_t i = 0; i < state_->pending.size(); ++i)
    state_->pending[i].set(-values.at(i));
  state_->pending.clear();
}

} // namespace drumlin::post
