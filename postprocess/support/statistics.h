// Statistics of samples: median, quantiles, confidence intervals, straight lines, order of convergence,
// harmonics.
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <optional>
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

/// The error at a number of steps (per cycle, or per contact).
struct ErrorPoint {
  double steps = 0.0;
  double error = 0.0; ///< relative, >= 0; not finite: the run gave none
};

/// error ~ steps^-order, by least squares of the logarithms.
struct FittedOrder {
  double order = 0.0;
  double scatter = 0.0; ///< root mean square distance of the points from the line, decades
  double from = 0.0;    ///< fewest steps among the points
  double to = 0.0;      ///< most
};

/// Fit over the points from a number of steps on: coarser steps need not be in the asymptotic range. Nothing
/// if fewer than three points with errors that are finite and above 0 remain.
std::optional<FittedOrder> fitted_order(const std::vector<ErrorPoint> &points, double from);

/// Where the finer half of the points begins, on a logarithmic scale. Points in order of steps, not empty.
double finer_half(const std::vector<ErrorPoint> &points);

/// The smallest measured number of steps from which on every larger one keeps to the error. Nothing if the
/// largest does not. Points in order of steps.
std::optional<double> steps_needed(const std::vector<ErrorPoint> &points, double error);

/// Largest error at each number of steps and beyond it: a bound that never grows with the number of steps.
/// Points that have no error count as infinite.
std::vector<ErrorPoint> envelope(std::vector<ErrorPoint> points);

/// Steps at which the envelope reaches an error, between its points and beyond its ends by power laws; beyond
/// the ends with the given order. error > 0. Nothing without points of finite error.
std::optional<double> steps_for(const std::vector<ErrorPoint> &points, double error, double order);

/// Multiples of the excitation frequency whose amplitudes meter values are made of.
constexpr std::array<double, 6> meter_orders = {0.5, 1.0, 1.5, 2.0, 2.5, 3.0};
constexpr std::size_t half_order = 0;
constexpr std::size_t basic_order = 1;
constexpr std::size_t double_order = 3;
/// Amplitudes of the drum's acceleration by meter_orders [m/s2].
using MeterAmplitudes = std::array<double, meter_orders.size()>;

/// A meter value: a constant times one sum of amplitudes over another. 1 for the orders that count.
struct MeterFormula {
  double constant = 0.0;
  MeterAmplitudes above{};
  MeterAmplitudes below{};
  double operator()(const MeterAmplitudes &amplitudes) const;
};

/// The constant of RMV; sources differ, some have 300.
constexpr double usual_rmv_constant = 100.0;

/// CMV = 300 A_2 / A_1 (-): Advances in Civil Engineering 2011, 783836, a review of such meters.
constexpr MeterFormula compaction_meter = {300.0, {0, 0, 0, 1, 0, 0}, {0, 1, 0, 0, 0, 0}};
/// RMV = `constant` A_0.5 / A_1 (-), of an even number of cycles.
constexpr MeterFormula resonance_meter(double constant = usual_rmv_constant) {
  return {constant, {1, 0, 0, 0, 0, 0}, {0, 1, 0, 0, 0, 0}};
}
/// CCV = 100 (A_0.5 + A_1.5 + A_2 + A_2.5 + A_3) / (A_0.5 + A_1) (-), of an even number of cycles: as NCHRP
/// Report 676 (Transportation Research Board 2010) is quoted; its own text could not be read.
constexpr MeterFormula compaction_control = {100.0, {1, 0, 1, 1, 1, 1}, {1, 1, 0, 0, 0, 0}};

/// Amplitudes of drum acceleration (m/s2) at 1, 2 and 1/2 times the excitation frequency.
struct HarmonicAmplitudes {
  double fundamental = 0.0;
  double second = 0.0;
  double half = 0.0;
};

/// CMV and RMV of these.
double compaction_meter_value(const HarmonicAmplitudes &amplitudes);
double resonance_meter_value(const HarmonicAmplitudes &amplitudes);

/// Amplitude over `count` cycles from `first` on of a signal whose harmonics over each single cycle are
/// given. Of a harmonic of half order `count` must be even.
double amplitude_over(const std::vector<std::complex<double>> &cycles, std::size_t first, std::size_t count);

} // namespace drumlin::post
