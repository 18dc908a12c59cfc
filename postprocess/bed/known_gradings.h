// Gradings of base courses of roads, by name: the mean of the lower and the upper limit that a specification
// sets for each sieve.
#pragma once

#include "bed/sieve_curve.h"

#include <string>
#include <vector>

namespace drumlin::post {

/// Limits for the share of the mass that passes a sieve.
struct SieveLimits {
  double size;         ///< mm
  double lower, upper; ///< %
};

/// A grading that a specification describes.
struct KnownGrading {
  const char *name;
  const char *what;   ///< material and range of sizes
  const char *source; ///< specification, and where its numbers were read
  std::vector<SieveLimits> limits;

  /// The mean of the limits at each sieve.
  SieveCurve curve() const;
};

/// All of them.
const std::vector<KnownGrading> &known_gradings();
/// The one of this name; nullptr if there is none.
const KnownGrading *find_grading(const std::string &name);
/// Their names, separated by commas.
std::string grading_names();

} // namespace drumlin::post
