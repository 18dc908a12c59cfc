#pragma once
// How a fix stores its state in the engine's restart file: the number of bytes, then the values as doubles.

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
