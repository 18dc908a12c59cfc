#pragma once
// Velocities across the periodic sides of a box that fix deform deforms with `remap v`. The images of a ball
// then move relative to it. Each engine's engine.h includes this header behind the engine's domain.h, before
// it defines GhostFix.

#include <array>
#include <cmath>

namespace drumlin::engine {

/// Velocity, m/s, of a periodic image of a ball relative to the ball; zero unless the box deforms with `remap
/// v`.
/// \param shift the engine's six numbers of the image: box lengths along x, y and z, then those by which the
/// tilts yz, xz and xy displace it; nullptr: it is no image
inline std::array<double, 3> velocity_of_image(const LAMMPS_NS::Domain &box, const int *shift) {
  if (shift == nullptr || !box.deform_vremap) return {};
  const double *const rate = box.h_rate;
  return {shift[0] * rate[0] + shift[5] * rate[5] + shift[4] * rate[4],
          shift[1] * rate[1] + shift[3] * rate[3], shift[2] * rate[2]};
}

/// The same of the image at `offset`, m, from the ball.
inline std::array<double, 3> velocity_of_image(const LAMMPS_NS::Domain &box,
                                               const std::array<double, 3> &offset) {
  if (!box.deform_vremap) return {};
  const bool tilts = box.triclinic != 0;
  const double z = std::round(offset[2] / box.zprd);
  const double y = std::round((offset[1] - (tilts ? z * box.yz : 0.0)) / box.yprd);
  const double x = std::round((offset[0] - (tilts ? y * box.xy + z * box.xz : 0.0)) / box.xprd);
  const int shift[6] = {static_cast<int>(x),
                        static_cast<int>(y),
                        static_cast<int>(z),
                        tilts ? static_cast<int>(z) : 0,
                        tilts ? static_cast<int>(z) : 0,
                        tilts ? static_cast<int>(y) : 0};
  return velocity_of_image(box, shift);
}

} // namespace drumlin::engine
