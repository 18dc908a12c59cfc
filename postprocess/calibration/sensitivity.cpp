#include "calibration/sensitivity.h"

#include "chain/linear_algebra.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace drumlin::post {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Index index(std::size_t i) { return static_cast<Index>(i); }

/// ln(point / centre) of each parameter.
VectorXd offset(const std::vector<double> &point, const std::vector<double> &centre) {
  VectorXd d(index(point.size()));
  for (std::size_t i = 0; i < point.size(); ++i)
    d(index(i)) = std::log(point[i] / centre[i]);
  return d;
}

/// For the beds of each seed, a linear model of the logarithms of the targets over those of the parameters,
/// fitted to the points, which are the evaluated sets of parameters near the best one.
struct Fits {
  /// Coefficients of each seed: the value at the best point and a slope for each parameter in rows, targets
  /// in columns.
  std::vector<MatrixXd> seeds;
  /// Measured minus fitted values of each seed: points in rows, targets in columns.
  std::vector<MatrixXd> residuals;
  /// Variance of the fitted value at the best point over that of a single measured value.
  double leverage = 0.0;
};

Fits fits(const CalibrationTask &task, const std::vector<const Evaluation *> &near,
          const std::vector<double> &centre) {
  const Index parameters = index(task.vary.size()), targets = index(task.targets.size());
  MatrixXd terms(index(near.size()), 1 + parameters);
  for (std::size_t i = 0; i < near.size(); ++i) {
    terms(index(i), 0) = 1.0;
    terms.row(index(i)).tail(parameters) = offset(near[i]->point, centre).transpose();
  }
  const PseudoInverse solve = pseudo_inverse_of(terms);
  if (solve.rank < terms.cols())
    throw std::runtime_error("too few evaluations near the best one succeeded: its slopes are not known");
  Fits all;
  all.leverage = solve.matrix.row(0).squaredNorm();
  for (int seed = 0; seed < task.seeds; ++seed) {
    MatrixXd values(terms.rows(), targets);
    for (std::size_t i = 0; i < near.size(); ++i)
      for (Index j = 0; j < targets; ++j)
        values(index(i), j) =
            std::log(near[i]->seeds[static_cast<std::size_t>(seed)].values[static_cast<std::size_t>(j)]);
    all.seeds.push_back(product_of(solve.matrix, values));
    all.residuals.emplace_back(values - product_of(terms, all.seeds.back()));
  }
  return all;
}

MeanInterval interval_over(const std::vector<MatrixXd> &seeds, Index row, Index column) {
  std::vector<double> values;
  values.reserve(seeds.size());
  for (const MatrixXd &seed : seeds)
    values.push_back(seed(row, column));
  return mean_interval(values);
}

/// Half the width of the 95 % confidence interval of the logarithm of a parameter if the targets are
/// themselves means over `target_beds` measured beds. The error is then that of the calibrating beds and that
/// of the target beds. The variance of a single bed is the variance between the fits of the seeds plus a part
/// that a fit averages out: settling is chaotic, so that the bed of one seed is packed differently at each
/// point.
/// \param step     change of the logarithm from the best point to where the targets are met, mean over the
/// seeds \param squares  sum of the squared residuals of all seeds and points, as changes of the logarithm of
/// the parameter \param leverage see Fits \param points number of points of a fit
double half_width_with_beds(const CalibrationTask &task, const MeanError &step, double squares,
                            double leverage, std::size_t points) {
  const double seeds = task.seeds, beds = task.target_beds;
  const double freedom = seeds * (static_cast<double>(points) - 1.0 - static_cast<double>(task.vary.size()));
  const Variance of_fits = {step.variance.value * (1.0 + seeds / beds), step.variance.freedom};
  const Variance of_points = {(1.0 - leverage) * squares / freedom / beds, freedom};
  return half_width_of_sum(of_fits, of_points);
}

void judge(const CalibrationTask &task, Sensitivity &found) {
  const auto acts = [&found](std::size_t parameter) {
    return std::any_of(found.slopes.begin(), found.slopes.end(),
                       [parameter](const auto &slopes) { return slopes[parameter].significant(); });
  };
  for (std::size_t i = 0; i < task.vary.size(); ++i) {
    std::string &why = found.parameters[i].unidentified;
    if (task.seeds < 2)
      why = "a single seed gives no intervals";
    else if (!acts(i))
      why = "the 95 % confidence interval of every slope contains zero: no target depends on it visibly";
    for (std::size_t j = 0; j < task.vary.size() && why.empty(); ++j)
      if (i != j && acts(j) && std::fabs(found.correlation[i][j]) > most_correlation)
        why = fmt::format("its estimate is correlated with that of {} by {:.3f}", task.vary[j].name,
                          found.correlation[i][j]);
  }
}

} // namespace

bool Sensitivity::identified() const {
  return std::all_of(parameters.begin(), parameters.end(),
                     [](const ParameterEstimate &one) { return one.unidentified.empty(); });
}

std::vector<std::vector<double>> slope_points(const CalibrationTask &task,
                                              const std::vector<double> &centre) {
  std::vector<std::vector<double>> points;
  const std::vector<double> unit = unit_point(task, centre);
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const double range = std::log(task.vary[i].high / task.vary[i].low);
    const double step = std::min(slope_step / range, 0.25);
    for (const double side : {-step, step}) {
      std::vector<double> other = unit;
      other[i] = std::clamp(unit[i] + side, 0.0, 1.0);
      // At the end of a range one point lies too close to tell a slope.
      if (std::fabs(other[i] - unit[i]) > 0.1 * step) points.push_back(point_at(task, other));
    }
  }
  return points;
}

Sensitivity sensitivity_at(const CalibrationTask &task, const std::vector<Evaluation> &evaluations,
                           const Evaluation &best) {
  const std::size_t parameters = task.vary.size(), targets = task.targets.size();
  std::vector<const Evaluation *> near;
  for (const Evaluation &one : evaluations)
    if (one.good(task) && offset(one.point, best.point).cwiseAbs().maxCoeff() <= fit_reach)
      near.push_back(&one);
  const Fits fit = fits(task, near, best.point);
  const std::vector<MatrixXd> &seeds = fit.seeds;

  Sensitivity found;
  found.points = near.size();
  MatrixXd mean = MatrixXd::Zero(index(1 + parameters), index(targets));
  for (const MatrixXd &seed : seeds)
    mean += seed / static_cast<double>(seeds.size());
  found.slopes.resize(targets);
  for (std::size_t i = 0; i < targets; ++i)
    for (std::size_t j = 0; j < parameters; ++j)
      found.slopes[i].push_back(interval_over(seeds, index(1 + j), index(i)));

  // Weighted least squares: an error of a target of its tolerance counts as 1.
  VectorXd weight(index(targets)), wanted(index(targets));
  for (std::size_t i = 0; i < targets; ++i) {
    weight(index(i)) = 1.0 / task.targets[i].tolerance;
    wanted(index(i)) = std::log(task.targets[i].value);
  }
  const MatrixXd slopes = weight.asDiagonal() * mean.bottomRows(index(parameters)).transpose();
  const MatrixXd inverse = pseudo_inverse_of(slopes).matrix;
  const MatrixXd covariance = product_of(inverse, inverse.transpose());
  found.correlation.assign(parameters, std::vector<double>(parameters, 0.0));
  for (std::size_t i = 0; i < parameters; ++i)
    for (std::size_t j = 0; j < parameters; ++j) {
      const double both = std::sqrt(covariance(index(i), index(i)) * covariance(index(j), index(j)));
      if (both > 0.0) found.correlation[i][j] = covariance(index(i), index(j)) / both;
    }

  // The parameters that meet the targets differ from seed to seed. The confidence interval of an estimate
  // follows from their scatter. The change of ln parameter is this times that of ln target.
  const MatrixXd steps = inverse * weight.asDiagonal();
  for (std::size_t j = 0; j < parameters; ++j) {
    std::vector<double> of_seeds;
    double squares = 0.0;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      const VectorXd step_of = steps.row(index(j));
      of_seeds.push_back(step_of.dot(wanted - seeds[i].row(0).transpose()));
      squares += product_of(fit.residuals[i], step_of).squaredNorm();
    }
    const MeanError step = mean_error(of_seeds);
    const double half_width = task.target_beds > 0
                                  ? half_width_with_beds(task, step, squares, fit.leverage, near.size())
                                  : mean_interval(of_seeds).half_width;
    ParameterEstimate estimate;
    estimate.value = best.point[j] * std::exp(step.mean);
    estimate.low = estimate.value * std::exp(-half_width);
    estimate.high = estimate.value * std::exp(half_width);
    found.parameters.push_back(estimate);
  }
  judge(task, found);
  return found;
}

} // namespace drumlin::post
