// The CSV files of the accuracy study: chain.csv, impacts.csv and scaling.csv, row by row. Errors are
// relative (chain) or absolute (restitution), without unit. A number that was not measured is an empty cell,
// NaN here.
#pragma once

#include "studies/accuracy/runs.h"
#include "support/convergence.h"
#include "support/csv_schema.h"

#include <string>
#include <vector>

namespace drumlin::post {

/// One row of chain.csv. The first four name the point.
struct ChainPoint {
  std::string chain_case; ///< I to IV
  Transition transition = Transition::B;
  std::string stepping; ///< second, stock or reference (the engine's own law)
  int steps_per_cycle = 0;
  ChainErrors errors{};
};

/// One row of impacts.csv. The first four name the point.
struct ImpactPoint {
  Transition transition = Transition::B;
  double damping_ratio = 0.0;
  std::string stepping;
  double steps_per_contact = 0.0; ///< pi / (w0 dt)
  ImpactErrors errors{};
};

/// One row of scaling.csv: a chain with random parameters, run with the number of steps that `drumlin advise`
/// gives for it. The first three name the point.
struct ScalingPoint {
  int set = 0;          ///< number of the parameter set, from 1
  std::string stepping; ///< second or stock
  double target = 0.0;  ///< error that was asked for
  ChainParameters parameters;
  int steps_per_cycle = 0; ///< advised
  double error = 0.0;      ///< found: relative RMS of the drum's velocity
};

/// The columns of the files, of which the first name the point.
const CsvSchema<ChainPoint> &chain_points();
const CsvSchema<ImpactPoint> &impact_points();
const CsvSchema<ScalingPoint> &scaling_points();

/// A measured error of the chain may be at most this many times the known error, that of the committed table.
constexpr double allowed_growth = 1.05;

/// Compares measured errors of the chain with known ones, row by row. Returns a sentence for each error that is larger than
/// allowed_growth times the known one or is not a number, for each measured row without a known one and, if
/// `complete`, for each known row that was not measured.
std::vector<std::string> larger_errors(const std::vector<ChainPoint> &points,
                                       const std::vector<ChainPoint> &known, bool complete);

/// The errors of one kind over the steps per cycle, in order of steps.
std::vector<ErrorPoint> chain_curve(const std::vector<ChainPoint> &points, const std::string &chain_case,
                                    Transition transition, const std::string &stepping,
                                    double ChainErrors::*error);
/// The same over the steps per contact.
std::vector<ErrorPoint> impact_curve(const std::vector<ImpactPoint> &points, Transition transition,
                                     double damping_ratio, const std::string &stepping,
                                     double ImpactErrors::*error);

} // namespace drumlin::post
