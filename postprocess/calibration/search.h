// Search for the smallest value of a noisy function that takes minutes to compute, in as few evaluations as
// possible.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace drumlin::post {

/// A point, each coordinate from 0 to 1, and the value of the function there.
struct SearchPoint {
  std::vector<double> at;
  double value = 0.0; ///< finite
};

/// dlib's global_function_search, which alternates between an upper bound of the function by its Lipschitz
/// constant (LIPO, Malherbe and Vayatis 2017), to look where nothing is known, and a quadratic model around
/// the best point. Points may be asked for before the values of earlier ones are known.
class PointSearch {
public:
  /// \param dimensions 1 or more
  /// \param noise of the function's values, relative to their range
  /// \param earlier points that are known already
  PointSearch(std::size_t dimensions, double noise, const std::vector<SearchPoint> &earlier);
  ~PointSearch();
  PointSearch(const PointSearch &) = delete;
  PointSearch &operator=(const PointSearch &) = delete;

  /// The point to look at next.
  std::vector<double> next();
  /// Gives the values, all finite, of the points that next() returned since the last call, in their order.
  void give(const std::vector<double> &values);

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace drumlin::post
