#pragma once
/// A boundary that absorbs waves: the viscous boundary of Lysmer and Kuhlemeyer (1969), a dashpot of the
/// impedance rho c per area, and beside it the spring of an elastic layer of depth H on rigid ground.
///
/// Elastic ground of density rho and wave speeds c_p, c_s continues beyond the boundary. Per area the
/// boundary exerts
///   -(rho c_p v_n + M/H u_n)  along its normal and  -(rho c_s v_t + G/H u_t)  in its plane,
/// M = rho c_p^2, G = rho c_s^2, on a displacement u with the velocity v. The dashpots alone absorb a plane
/// wave that arrives along the normal. With the springs, which carry a static load q with the displacement q
/// H/M, the share 1 / (1 + (2 w H/c_p)^2) of the energy of a wave of angular frequency w is reflected.

#include "physics/parameter_checks.h"
#include "physics/laws/linear_contact.h"
#include "physics/scheme/implicit_dashpot.h"
#include "physics/scheme/stability_limit.h"
#include "physics/vec3.h"

#include <array>
#include <limits>
#include <string>

namespace drumlin::physics {

/// Spring and dashpot from a ball to the ground, in one direction.
struct GroundLink {
  double stiffness; ///< N/m, >= 0
  double damping;   ///< N s/m, >= 0
};

/// The ground beyond a boundary, and the area of the boundary.
struct Ground {
  double density = 0.0;                                   ///< rho, kg/m3, finite and > 0
  double p_speed = 0.0;                                   ///< c_p, m/s, of compression waves, finite and > 0
  double s_speed = 0.0;                                   ///< c_s, m/s, of shear waves, from 0 to c_p
  double depth = std::numeric_limits<double>::infinity(); ///< H, m, > 0; infinite: no springs
  double area = 0.0;                                      ///< of the whole boundary, m2, finite and > 0

  /// Empty if every value is allowed, else what is wrong: name, value, what is allowed.
  [[nodiscard]] std::string invalid() const {
    using detail::Allowed;
    using detail::violation;
    std::string text = violation("density", density, "kg/m3", Allowed::positive);
    if (text.empty()) text = violation("speed of compression waves", p_speed, "m/s", Allowed::positive);
    if (text.empty()) text = violation("speed of shear waves", s_speed, "m/s", Allowed::not_negative);
    if (text.empty() && s_speed > p_speed)
      text = "speed of shear waves is '" + detail::number_text(s_speed) +
             " m/s'; allowed: at most that of compression waves, " + detail::number_text(p_speed) + " m/s";
    if (text.empty()) text = violation("depth", depth, "m", Allowed::positive_or_infinite);
    if (text.empty()) text = violation("area", area, "m2", Allowed::positive);
    return text;
  }

  /// What the ground exerts on one of the balls that share the boundary equally. \param balls > 0
  [[nodiscard]] GroundLink along_normal(double balls) const { return link(p_speed, balls); }
  [[nodiscard]] GroundLink in_plane(double balls) const { return link(s_speed, balls); }

private:
  [[nodiscard]] GroundLink link(double speed, double balls) const {
    const double damping = density * speed * area / balls;
    return {damping * speed / depth, damping};
  }
};

/// A vector as its component along a normal (first) and its part in the plane (the other three). The law of
/// the boundary applies to each of the four numbers as in one dimension.
using Resolved = std::array<double, 4>;

[[nodiscard]] inline Resolved resolve(const Vec3 &normal, const Vec3 &vector) {
  const double along = dot(normal, vector);
  const Vec3 rest = sum(vector, -along, normal);
  return {along, rest[0], rest[1], rest[2]};
}
[[nodiscard]] inline Vec3 composed(const Vec3 &normal, const Resolved &parts) {
  return sum({parts[1], parts[2], parts[3]}, parts[0], normal);
}

/// The links of one ball to the ground.
struct GroundedBall {
  Vec3 normal{};       ///< unit vector
  GroundLink along{};  ///< along the normal
  GroundLink across{}; ///< in the plane of the boundary

  [[nodiscard]] const GroundLink &link(std::size_t part) const { return part == 0 ? along : across; }

  /// Force on the ball, N, at a displacement u, m, and a velocity v, m/s.
  [[nodiscard]] Vec3 force(const Vec3 &u, const Vec3 &v) const {
    const Resolved at = resolve(normal, u), rate = resolve(normal, v);
    Resolved f{};
    for (std::size_t p = 0; p < f.size(); ++p)
      f[p] = -link(p).stiffness * at[p] - link(p).damping * rate[p];
    return composed(normal, f);
  }

  /// Energy in the springs, J. The power of force() is minus the rate of this energy minus heat().
  [[nodiscard]] double stored(const Vec3 &u) const {
    return 0.5 * weighted_square(along.stiffness, across.stiffness, u);
  }
  /// Power that the dashpots turn into heat, W, never negative.
  [[nodiscard]] double heat(const Vec3 &v) const { return weighted_square(along.damping, across.damping, v); }

  /// What the links contribute to the critical time step of a ball of this mass, kg. \param implicit whether
  /// the dashpots are solved for implicitly, so that they do not limit the step (second-order scheme)
  [[nodiscard]] LinkModes modes(double mass, bool implicit) const {
    LinkModes modes;
    modes.normal = normal;
    modes.normal_spring = along.stiffness / mass;
    modes.tangential_spring = across.stiffness / mass;
    modes.normal_dashpot = implicit ? 0.0 : along.damping / mass;
    modes.tangential_dashpot = implicit ? 0.0 : across.damping / mass;
    return modes;
  }

private:
  [[nodiscard]] double weighted_square(double on_normal, double on_plane, const Vec3 &a) const {
    const Resolved parts = resolve(normal, a);
    return on_normal * parts[0] * parts[0] +
           on_plane * (parts[1] * parts[1] + parts[2] * parts[2] + parts[3] * parts[3]);
  }
};

/// The motion of a grounded ball in a step of the second-order scheme, see stepping.h.
struct GroundedStep {
  Vec3 displacement;    ///< u(t+dt), m
  Vec3 velocity_half;   ///< m/s, of the middle of the step
  Vec3 velocity_before; ///< m/s, at t
  Vec3 force_before;    ///< N, on the ball at t
  double dt;            ///< s
};

namespace detail {

/// Calls formula(law, motion, force at t) for each part of the vectors: the formulas of a contact, whose
/// overlap grows with a displacement against the direction of the force.
template <class Formula>
void for_each_part(const GroundedBall &ball, const GroundedStep &step, Formula &&formula) {
  const Resolved at = resolve(ball.normal, step.displacement);
  const Resolved half = resolve(ball.normal, step.velocity_half);
  const Resolved before = resolve(ball.normal, step.velocity_before);
  const Resolved force = resolve(ball.normal, step.force_before);
  for (std::size_t p = 0; p < at.size(); ++p)
    formula(p, LinearLaw(ball.link(p).stiffness, ball.link(p).damping, Transition::A),
            StepMotion{-at[p], -half[p], -before[p], step.dt}, force[p]);
}

} // namespace detail

/// Force on the ball at t+dt, N, of links that are solved for alone: implicit_force() in each part.
[[nodiscard]] inline Vec3 implicit_force(const GroundedBall &ball, const GroundedStep &step, double mass) {
  Resolved f{};
  detail::for_each_part(ball, step,
                        [&](std::size_t p, const LinearLaw &law, const StepMotion &motion, double F) {
                          f[p] = implicit_force(law, motion, F, ball.link(p).damping / mass);
                        });
  return composed(ball.normal, f);
}

/// The links of a ball that are solved for together with heavily damped contacts: coupled_dashpot() in each
/// part.
struct CoupledGround {
  std::array<CoupledDashpot, 4> parts;

  /// Force of the first pass, N.
  [[nodiscard]] Vec3 first(const Vec3 &normal) const {
    return composed(normal, {parts[0].first, parts[1].first, parts[2].first, parts[3].first});
  }
  /// Force of the second pass, N, with the velocity v*, m/s.
  [[nodiscard]] Vec3 second(const Vec3 &normal, const Vec3 &velocity) const {
    const Resolved rate = resolve(normal, velocity);
    Resolved f{};
    for (std::size_t p = 0; p < f.size(); ++p)
      f[p] = coupled_force(parts[p], -rate[p]);
    return composed(normal, f);
  }
};

/// \param all sum of sqrt(C)/m over all links of the ball and of its partners: see CoupledDashpot
[[nodiscard]] inline CoupledGround coupled_ground(const GroundedBall &ball, const GroundedStep &step,
                                                  double all) {
  CoupledGround coupled{};
  detail::for_each_part(ball, step,
                        [&](std::size_t p, const LinearLaw &law, const StepMotion &motion, double F) {
                          coupled.parts[p] = coupled_dashpot(law, motion, F, all);
                        });
  return coupled;
}

} // namespace drumlin::physics
