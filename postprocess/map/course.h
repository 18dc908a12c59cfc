// What the meter of a roller shows over one number of the chain, of the exact motion, and what identification
// finds in records of it: points, and where a value returns.
#pragma once

#include "map/regime_map.h"
#include "meter/values.h"
#include "support/csv_schema.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// What identification finds in a record. NaN: no identification, or none was asked for.
struct FoundLaw {
  double k = std::numeric_limits<double>::quiet_NaN();            ///< [N/m]
  double k_half_width = std::numeric_limits<double>::quiet_NaN(); ///< of its 95 % confidence interval [N/m]
  double D = std::numeric_limits<double>::quiet_NaN();            ///< [-]
  double D_half_width = std::numeric_limits<double>::quiet_NaN(); ///< [-]
};

/// A roller on soil at one value of the axis. The first two name it.
struct CoursePoint {
  std::string roller;
  double value = 0.0; ///< of the axis
  double k = 0.0;     ///< stiffness of the soil [N/m]
  RegimePoint motion;
  double E_vib = std::numeric_limits<double>::quiet_NaN(); ///< [Pa]; NaN: radius or width is not known
  bool identified = false;                                 ///< whether identification was tried
  FoundLaw exact;                                          ///< from an exact record
  FoundLaw measured;                                       ///< from noisy accelerations alone
};

/// The columns of a file of points. \param rollers whether it has a column for the roller
CsvSchema<CoursePoint> course_columns(const MapAxis &axis, bool rollers);

/// How a point is computed.
struct CourseSetting {
  std::optional<LineContact> drum; ///< for E_vib
  int cycles = 300;                ///< in which the motion settles, as of judge_regime()
  bool identify = false;
  std::uint64_t seed = 1; ///< of the noise
};

/// Judges the motion of a chain and takes its values. Identification has 40 cycles of 250 samples: exact; and
/// as a real roller has it, accelerations alone with white noise of 1 % of their standard deviation, and the
/// exciter's phase off by half a degree and known within one.
CoursePoint course_point(const ChainParameters &chain, const CourseSetting &setting);

/// A roller whose points are asked for.
struct CourseChain {
  std::string roller;     ///< without a name the file has no column for it
  ChainFamily chain;      ///< over the axis
  CourseSetting setting;  ///< but for identify and seed
  int identify_every = 1; ///< every so many-th point is identified, the first and the last, too; 0: none
};

/// The points of rollers along an axis, roller by roller. Those that `file` has already are not computed
/// again; others are added to it, by several threads.
std::vector<CoursePoint> course_points(const std::filesystem::path &file, const MapAxis &axis,
                                       const std::vector<CourseChain> &rollers, int threads);

/// A value of the meter along the axis.
struct CourseValue {
  const char *name;
  const char *title;
  const char *label;  ///< with unit, as gnuplot writes it
  const char *column; ///< of the file, with unit
  double (*value)(const CoursePoint &);
  double scale; ///< from SI to the label's unit
  double least; ///< smaller changes do not count [unit of the label]
  bool stiffness = false;
};
extern const std::array<CourseValue, 10> course_values;

/// Where a sequence turns: the indices of its maxima and minima, in turn, between its ends. Ups and downs
/// smaller than `least` do not count.
std::vector<std::size_t> turning_points(const std::vector<double> &values, double least);

/// How a value goes as the axis grows.
struct Course {
  std::vector<CoursePoint> points; ///< that have the value
  std::vector<double> values;      ///< in the unit of the label
  std::vector<std::size_t> turns;  ///< indices of maxima and minima
  int first = 0;                   ///< 1: begins by rising, -1: by falling, 0: constant
  std::vector<std::size_t> same;   ///< of each point: at how many values of the axis the value is met
  /// Values of the axis at which the value is met, one in each stretch between turns.
  std::vector<double> met_at(double value) const;
};

/// The course of one roller's points. Changes of less than 2 % of the value's range do not count as turns.
Course course_of(const std::vector<CoursePoint> &points, const CourseValue &value);

/// meter.csv: the points, and for each value at how many values of the axis it is met.
std::string course_csv(const MapAxis &axis, const std::vector<CoursePoint> &points);

/// A roller of a page.
struct CourseRoller {
  std::string name; ///< as in CoursePoint
  std::string title;
};

/// Writes a page of several rollers over k, a figure for each value: the study `meter`. \param points k
/// growing
void write_soil_page(const std::filesystem::path &out, const std::vector<CourseRoller> &rollers,
                     const MapAxis &axis, const std::vector<CoursePoint> &points);

/// Writes a page of one roller over any axis: values, what a CMV may mean, what identification finds.
/// \param conditions what holds at all points, as words
void write_course_page(const std::filesystem::path &out, const std::string &conditions, const MapAxis &axis,
                       const std::vector<CoursePoint> &points, const std::vector<BoundaryPoint> &boundaries);

} // namespace drumlin::post
