// What the benchmarks study compares: quantities of a run with closed forms, or with a reference solution.
#pragma once

#include "lab/benchmarks/runs.h"

#include <string>
#include <vector>

namespace drumlin::post {

/// State after an impact of sphere 1 on the floor or on sphere 2. SI units.
struct AfterImpact {
  double vx = 0.0, vz = 0.0, spin = 0.0;    ///< of sphere 1; up, along x, about y
  double vx2 = 0.0, vz2 = 0.0, spin2 = 0.0; ///< of sphere 2
};

/// Closed form of an impact in which the surfaces slide on each other all the time, so that friction is mu
/// times the normal force. The impulses are exact; of the lever arm of friction, r - d/2, the mean over an
/// elastic impact counts.
AfterImpact sliding_impact(const SphereSetup &setup);

/// Whether the surfaces slide during the whole impact, with a margin.
bool slides_throughout(const SphereSetup &setup);

/// Reference solution of any impact: the equations of motion with the law of normal.hooke or normal.hertz and
/// with friction (spring and dashpot in parallel, in series with a slider) integrated in steps of 5e-6 of an
/// undamped impact. The rotation of the normal during the impact is left out.
AfterImpact integrated_impact(const SphereSetup &setup);

/// A quantity of a run and what it should be.
struct BenchmarkCheck {
  std::string quantity; ///< with unit
  std::string oracle;   ///< "closed form" or "reference solution"
  double computed, expected;
  double scale;     ///< that errors are relative to
  double tolerance; ///< of the relative error

  double error() const;
};

std::vector<BenchmarkCheck> benchmark_checks(const BenchmarkRun &run);

} // namespace drumlin::post
