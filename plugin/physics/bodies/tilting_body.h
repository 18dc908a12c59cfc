#pragma once
/// A rigid body of balls that translates and tilts about one axis by small angles, such as a drum on its axle
/// about the way of travel.
///
/// Its equations are linear in the tilt: with s the place of a ball along the axle and s_c that of the centre
/// of mass, the ball moves at v + rise omega (s - s_c), and its acceleration is
///   a = F / M + rise (s - s_c) T / I,   T = sum of (s - s_c) f . rise,   I = sum of m (s - s_c)^2.
/// Places along the axle stay as they are, and the work of the forces is the change of the kinetic energy of
/// the balls, exactly. Distances of balls along the tilted axle are too long by theta^2 / 2 of themselves,
/// which the model neglects.

#include "physics/vec3.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace drumlin::physics {

/// Unit vectors at right angles to each other: rise = axis x axle. The tilt is positive if balls with a
/// larger place along the axle rise.
struct TiltAxes {
  Vec3 axis{}, axle{}, rise{};

  TiltAxes() = default;
  TiltAxes(const Vec3 &about, const Vec3 &along) : axis(about), axle(along), rise(cross(about, along)) {}
};

constexpr double largest_tilt = 0.1; ///< rad

/// Sums over the balls of a body, or over a part of them.
class AxleSums {
public:
  /// \param mass kg \param x m \param v m/s \param f N
  void add(const TiltAxes &axes, double mass, const Vec3 &x, const Vec3 &v, const Vec3 &f) {
    const double s = dot(x, axes.axle), height = dot(x, axes.rise), speed = dot(v, axes.rise);
    numbers_[mass_] += mass;
    numbers_[place_] += mass * s;
    numbers_[square_] += mass * s * s;
    numbers_[height_] += mass * height;
    numbers_[slope_] += mass * s * height;
    numbers_[speed_] += mass * speed;
    numbers_[spin_] += mass * s * speed;
    for (std::size_t a = 0; a < 3; ++a)
      numbers_[force_ + a] += f[a];
    numbers_[upward_] += dot(f, axes.rise);
    numbers_[moment_] += s * dot(f, axes.rise);
  }

  /// The sums, to be added over all ranks.
  double *data() { return numbers_.data(); }
  static constexpr int size() { return count; }

  double mass() const { return numbers_[mass_]; }                  ///< M, kg
  double centre() const { return numbers_[place_] / mass(); }      ///< s_c, m
  double height() const { return numbers_[height_] / mass(); }     ///< of the centre of mass along rise, m
  double inertia() const { return about_centre(square_, place_); } ///< I, kg m2
  double tilt() const { return about_centre(slope_, height_) / inertia(); } ///< rad
  double rate() const { return about_centre(spin_, speed_) / inertia(); }   ///< omega, rad/s
  Vec3 force() const { return {numbers_[force_], numbers_[force_ + 1], numbers_[force_ + 2]}; } ///< N
  double moment() const { return about_centre(moment_, upward_); } ///< T about the centre of mass, N m

  /// What a ball gets of a force on the body, N: m a. \param s place of the ball \param moment of the force
  Vec3 share(const TiltAxes &axes, double mass, double s, const Vec3 &force, double moment) const {
    return sum(scaled(mass / this->mass(), force), mass * (s - centre()) * moment / inertia(), axes.rise);
  }

private:
  enum Number : std::size_t {
    mass_,
    place_,
    square_,
    height_,
    slope_,
    speed_,
    spin_,
    upward_,
    moment_,
    force_,
    count = force_ + 3
  };
  /// A sum of products with s, with s - s_c instead.
  double about_centre(Number with_place, Number without) const {
    return numbers_[with_place] - centre() * numbers_[without];
  }

  std::array<double, count> numbers_{};
};

} // namespace drumlin::physics
