// Runs of balls.in, and the recorded motion of its balls.
#pragma once

#include "tests/support/engine_runs.h"

namespace drumlin::test {

/// A run of balls.in that has ended well.
struct BallsRun {
  std::vector<Frame> frames;
  std::vector<post::ContactEvent> events;
  std::vector<double> reaction; ///< what the fixed ball's fix reads along z, N, from the second frame on
  std::string output;

  /// A component of one ball over the frames.
  std::vector<double> series(long id, std::array<double, 3> Ball::*part, std::size_t axis) const;
};

/// Runs balls.in in a folder of its own, with a triangle of z = 0 as floor.stl. Throws with the output if
/// that fails.
BallsRun run_balls(const Variables &variables, int ranks = 1);

/// Writes triangles that cover x and y from -half_width to half_width in z = 0; one if `single`, which covers
/// the middle.
void write_floor(const std::filesystem::path &file, double half_width, bool single);

/// "x y z" for a variable.
std::string vector_text(double x, double y, double z);

} // namespace drumlin::test
