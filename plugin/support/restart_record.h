#pragma once
// Global state of a fix as a record in the engine's restart file: a count of bytes, then numbers.

#include "engine.h"

namespace drumlin {

/// Writes `values` as a fix's restart record. Rank 0 of the engine calls a fix's write_restart().
inline void write_restart_record(FILE *file, int rank, const std::vector<double> &values) {
  if (rank != 0) return;
  const int bytes = static_cast<int>(values.size() * sizeof(double));
  std::fwrite(&bytes, sizeof(int), 1, file);
  std::fwrite(values.data(), sizeof(double), values.size(), file);
}

} // namespace drumlin
