#pragma once
// The state of a fix in the engine's restart file: a record of the number of bytes, then the numbers.

#include "engine.h"

namespace drumlin {

/// Writes `values` as a fix's restart record; to be called by the fix's write_restart(). Only rank 0 writes.
inline void write_restart_record(FILE *file, int rank, const std::vector<double> &values) {
  if (rank != 0) return;
  const int bytes = static_cast<int>(values.size() * sizeof(double));
  std::fwrite(&bytes, sizeof(int), 1, file);
  std::fwrite(values.data(), sizeof(double), values.size(), file);
}

} // namespace drumlin
