// The CSV files of the accuracy study: chain.csv, impacts.csv and scaling.csv, row by row. Errors are relative (chain) or
// absolute (restitution), without unit. A number that was not measured is an empty cell, NaN here.
#pragma once

#include "studies/accuracy/runs.h"
#include "support/convergence.h"

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// One row of chain.csv. The first four name the point.
struct ChainPoint {
  std::string chain_case; ///< I to IV
  Transition transition;
  std::string stepping; ///< second, stock or reference (the engine's own law)
  int steps_per_cycle;
  ChainErrors errors;
};

/// One row of impacts.csv. The first four name the point.
struct ImpactPoint {
  Transition transition;
  double damping_ratio;
  std::string stepping;
  double steps_per_contact; ///< pi / (w0 dt)
  ImpactErrors errors;
};

/// One row of scaling.csv: a chain that is in no table, run at the steps that advice gave for it. The first three name
/// the point.
struct ScalingPoint {
  int set;              ///< number of the parameter set, from 1
  std::string stepping; ///< second or stock
  double target;        ///< error that was asked for
  ChainParameters parameters;
  int steps_per_cycle; ///< advised
  double error;        ///< found: relative RMS of the drum's velocity
};

/// Header lines, and how many columns name a point.
extern const std::vector<std::string> chain_point_columns;
extern const std::vector<std::string> impact_point_columns;
extern const std::vector<std::string> scaling_point_columns;
constexpr std::size_t chain_point_keys = 4;
constexpr std::size_t impact_point_keys = 4;
constexpr std::size_t scaling_point_keys = 3;

/// The cells of a row.
std::vector<std::string> cells(const ChainPoint &point);
std::vector<std::string> cells(const ImpactPoint &point);
std::vector<std::string> cells(const ScalingPoint &point);

/// The rows of a file in order; none if there is no such file. std::runtime_error for one that cannot be understood.
std::vector<ChainPoint> read_chain_points(const std::filesystem::path &file);
std::vector<ImpactPoint> read_impact_points(const std::filesystem::path &file);
std::vector<ScalingPoint> read_scaling_points(const std::filesystem::path &file);

/// The errors of one kind over the steps per cycle, in order of steps.
std::vector<ErrorPoint> chain_curve(const std::vector<ChainPoint> &points, const std::string &chain_case,
                                    Transition transition, const std::string &stepping,
                                    double ChainErrors::*error);
/// The same over the steps per contact.
std::vector<ErrorPoint> impact_curve(const std::vector<ImpactPoint> &points, Transition transition,
                                     double damping_ratio, const std::string &stepping,
                                     double ImpactErrors::*error);

} // namespace drumlin::post
