#pragma once
/// Vectors of three components. The functions are written out component by component: with loops over an
/// index the compiler keeps the vectors in memory instead of in registers.

#include <array>

namespace drumlin::physics {

using Vec3 = std::array<double, 3>;

[[nodiscard]] inline double dot(const Vec3 &a, const Vec3 &b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] inline Vec3 cross(const Vec3 &a, const Vec3 &b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// s a
[[nodiscard]] inline Vec3 scaled(double s, const Vec3 &a) { return {s * a[0], s * a[1], s * a[2]}; }
/// a + s b
[[nodiscard]] inline Vec3 sum(const Vec3 &a, double s, const Vec3 &b) {
  return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}

} // namespace drumlin::physics
