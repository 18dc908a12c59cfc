// Runs of the benchmarks study: the rows of its file runs.csv.
#pragma once

#include "engine/engine_run.h"
#include "support/csv_schema.h"

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// The parameters of a run of inputs/benchmarks/in.spheres, as its parameters.csv has them. SI units.
struct SphereSetup {
  double k = 0.0, kt = 0.0;        ///< of the linear law; k = 0: the Hertz law
  double E_eff = 0.0, G_eff = 0.0; ///< of the Hertz law
  double ct = -1.0;                ///< negative: half of the normal dashpot
  double e = 1.0, mu = 0.0, mu_r = 0.0;
  double spheres = 1.0;
  double r1 = 0.0, r2 = 0.0, m1 = 0.0, m2 = 0.0;
  double vn = 0.0, vt = 0.0, spin = 0.0;         ///< of sphere 1: down, along x, about y
  double velocity_ratio = 0.0, spin_ratio = 0.0; ///< of sphere 2 over sphere 1
  double g = 0.0, slope = 0.0;                   ///< slope in degrees
  double ceiling = 0.0;
  double steps = 0.0, timestep = 0.0;

  double time() const { return steps * timestep; }
};

/// What a run ends with, and its peaks. SI units; without a second sphere its values are 0.
struct SphereEnd {
  double x = 0.0, z = 0.0, vx = 0.0, vz = 0.0, spin = 0.0;
  double x2 = 0.0, z2 = 0.0, vx2 = 0.0, vz2 = 0.0, spin2 = 0.0;
  double z_start = 0.0, z2_start = 0.0; ///< the spheres start at x = 0
  double peak_force = 0.0;              ///< along the normal, on sphere 1
  double peak_overlap = 0.0;
};

/// A row of runs.csv. The first four name the run.
struct BenchmarkRun {
  std::string test;     ///< the case of the deck
  std::string material; ///< empty: the case has none
  double at = 0.0;      ///< the value of the variable that is varied
  std::string engine;
  SphereSetup setup;
  SphereEnd end;
};

const CsvSchema<BenchmarkRun> &benchmark_runs();

/// A point of a test: the case, and the deck variable that is varied.
struct BenchmarkPoint {
  std::string test, material, variable;
  double at;
  Variables more = {}; ///< of the deck
};

/// The points of all tests. \param quick a few of each
std::vector<BenchmarkPoint> benchmark_points(bool quick);

/// Runs the deck. \param engine liggghts or lammps
BenchmarkRun run_benchmark(const BenchmarkPoint &point, const std::string &engine);

/// The row of a run from its parameters.csv and balls.txt in a folder.
BenchmarkRun read_benchmark(const BenchmarkPoint &point, const std::string &engine,
                            const std::filesystem::path &folder);

} // namespace drumlin::post
