#include "calibration/search.h"

#include <dlib/global_optimization/global_function_search.h>

namespace drumlin::post {

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
