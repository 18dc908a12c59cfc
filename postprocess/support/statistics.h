// Statistics of samples: median, quantiles, confidence intervals, straight lines.
#pragma once

#include <vector>

namespace drumlin::post {

/// Middle value; of an even number the mean of the two in the middle. values not empty.
double median(std::vector<double> values);

/// Root of the mean square; 0 of none.
double rms(const std::vector<double> &values);

/// Value below which a share (0 to 1) of the values lies, linear between neighbours: 0.25 gives the lower
/// quartile. values not empty.
double quantile(std::vector<double> values, double share);

/// Median and quartiles.
struct Spread {
  double median, lower, upper;
};
/// values not empty.
Spread spread(const std::vector<double> &values);

/// A mean and half the width of its 95 % confidence interval.
struct MeanInterval {
  double mean, half_width;
  /// Whether zero lies outside of the interval. By scatter alone this happens in 5 % of all samples.
  bool significant() const;
  /// Whether the whole interval lies within +-bound.
  bool within(double bound) const;
};
/// The factor from a standard error to half the width of its 95 % confidence interval, by Student's t
/// distribution with so many degrees of freedom (above 0).
double t_factor(double freedom);
/// The 95 % confidence interval of the standard deviation of normally distributed values.
struct ScatterInterval {
  double estimate, least, most;
};
/// Of a sample; infinitely wide upwards of a single value. std::invalid_argument without values.
ScatterInterval scatter_interval(const std::vector<double> &values);

/// An estimated variance and its degrees of freedom. With zero degrees of freedom the variance is not known.
struct Variance {
  double value, freedom;
};
/// Half the width of the 95 % confidence interval of a value whose error is the sum of two independent errors
/// with these variances. The degrees of freedom are those of Welch (1947) and Satterthwaite (1946). Infinite
/// if a variance is not known.
double half_width_of_sum(const Variance &one, const Variance &other);
/// A mean, and the square of its standard error: the variance of the values over their number.
struct MeanError {
  double mean;
  Variance variance;
};
/// The degrees of freedom are one fewer than values. std::invalid_argument without values.
MeanError mean_error(const std::vector<double> &values);
/// The interval by Student's t distribution; its half width is infinite for a single value.
/// std::invalid_argument without values.
MeanInterval mean_interval(const std::vector<double> &values);
/// The mean of some values minus that of others, independent of them and of another scatter (Welch 1947); its
/// half width is infinite if either are fewer than two. std::invalid_argument without values.
MeanInterval mean_difference(const std::vector<double> &values, const std::vector<double> &others);

/// A straight line y = intercept + slope x.
struct LineFit {
  MeanInterval slope, intercept;
};
/// Least squares with intervals by Student's t distribution for errors of y alone, equal for all points.
/// std::invalid_argument unless there are as many y as x, three or more, and two different x.
LineFit fit_line(const std::vector<double> &x, const std::vector<double> &y);

} // namespace drumlin::post
