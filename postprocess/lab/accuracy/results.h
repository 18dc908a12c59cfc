// Results of the accuracy study that it alone has: the rows of impacts.csv, errors absolute, and the
// comparison with known errors.
#pragma once

#include "lab/accuracy/runs.h"

#include <string>
#include <vector>

namespace drumlin::post {

/// One row of impacts.csv. The first four name the point.
struct ImpactPoint {
  Transition transition = Transition::B;
  double damping_ratio = 0.0;
  std::string stepping;
  double steps_per_contact = 0.0; ///< pi / (w0 dt)
  ReboundErrors errors{};
};

/// Its columns, of which the first name the point.
const CsvSchema<ImpactPoint> &impact_points();

/// A measured error of the chain may be at most this many times the known error, that of the committed table.
constexpr double allowed_growth = 1.05;

/// Compares measured errors of the chain with known ones, row by row. Returns a sentence for each error that
/// is larger than allowed_growth times the known one or is not a number, for each measured row without a
/// known one and, if `complete`, for each known row that was not measured.
std::vector<std::string> larger_errors(const std::vector<ChainPoint> &points,
                                       const std::vector<ChainPoint> &known, bool complete);

/// The errors of one kind over the steps per contact.
std::vector<ErrorPoint> impact_curve(const std::vector<ImpactPoint> &points, Transition transition,
                                     double damping_ratio, const std::string &stepping,
                                     double ReboundErrors::*error);

} // namespace drumlin::post
