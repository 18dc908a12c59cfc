#pragma once
/// Coulomb friction with a tangential spring and dashpot (Cundall and Strack 1979, Geotechnique 29, 47-65),
/// with the two limits by mu |Fn| that the engines use, with a strict limit on the whole force, and without
/// the spring.
///
/// Sign convention: vt is the velocity of ball i's surface relative to ball j's at the contact, its
/// tangential part; the spring xi is the tangential displacement that vt has built up; the force is the one
/// on ball i (ball j takes the opposite). It opposes xi and vt. SI units.

#include "physics/vec3.h"

#include <algorithm>
#include <cmath>

namespace drumlin::physics {

/// Which part of the friction force is limited, and to what. spring: only the spring's force kt xi. Where it
/// slides the dashpot is dropped; just before that the force
///         may exceed mu |Fn| by the dashpot's share. (LIGGGHTS, tangential history.)
/// total:  spring and dashpot together. Where it slides the spring is reset so that kt xi + ct vt has the
///         length mu |Fn|. (LAMMPS, gran/hooke/history.)
/// coulomb: spring and dashpot in parallel, in series with a slider that slips at mu max(Fn, 0). The force
/// never
///         exceeds that, and no step creates energy, at any damping; in tension there is no friction. (The
///         plugin's `tangential coulomb`.)
enum class Cap { spring, total, coulomb };

/// Parameters of friction.
struct Friction {
  double stiffness = 0.0;   ///< kt, N/m, finite and >= 0
  double damping = 0.0;     ///< ct, N s/m, finite and >= 0
  double coefficient = 0.0; ///< mu, finite and >= 0
  Cap cap = Cap::spring;    ///< which reading of the limit
};

/// Limit of friction, N, with a normal force, N: see Cap.
[[nodiscard]] inline double friction_limit(const Friction &friction, double normal_force) {
  return friction.coefficient *
         (friction.cap == Cap::coulomb ? std::max(0.0, normal_force) : std::fabs(normal_force));
}

/// Result of one step of friction.
struct FrictionStep {
  Vec3 force;        ///< N, on ball i, at the end of the step
  Vec3 spring;       ///< xi after the step, m, in the tangent plane
  double dissipated; ///< energy turned into heat during the step, J; see friction_step() for its sign
  double stored;     ///< energy in the spring after the step, J, kt |xi|^2 / 2
  bool sliding;      ///< the limit was reached
};

/// vt, m/s: tangential part of the velocity of ball i's surface relative to ball j's at the contact,
///   vt = v - (v . n) n - (a_i w_i + a_j w_j) x n
/// relative v = v_i - v_j in m/s; normal n the unit vector from j to i; turning a_i w_i + a_j w_j in m/s, of
/// each ball its distance from the contact point, r - d/2, times its angular velocity.
[[nodiscard]] inline Vec3 slip_velocity(const Vec3 &relative, const Vec3 &normal, const Vec3 &turning) {
  return sum(sum(relative, -dot(relative, normal), normal), -1.0, cross(turning, normal));
}

/// Unit normal in the middle of a step of two balls. \param separation x_i - x_j at its end, m \param
/// relative v_i - v_j of its middle, m/s \param dt s
[[nodiscard]] inline Vec3 normal_in_middle(const Vec3 &separation, const Vec3 &relative, double dt) {
  const Vec3 middle = sum(separation, -0.5 * dt, relative);
  return scaled(1.0 / std::sqrt(dot(middle, middle)), middle);
}

/// vt, m/s, of a step of velocity Verlet, at the end of which the forces are computed: velocities and normal
/// are those of the middle of the step, and the result is projected on the tangent plane of its end.
/// slip_velocity() with the normal of the end counts the rotation of the normal in half a step as slip: the
/// spring of a ball that rolls around another without slipping is then stretched by dt/2 times the angle
/// between the normals in each step. Where the spring is stiff and the ball is light, as between balls of
/// very different sizes, this keeps the ball from rolling (Vyas, Ottino, Lueptow and Umbanhowar 2025, Comput.
/// Phys. Commun. 310, 109524).
/// \param relative v_i - v_j of the middle of the step, m/s \param middle normal of its middle \param normal
/// of its end \param turning as for slip_velocity(), m/s
[[nodiscard]] inline Vec3 slip_velocity_of_step(const Vec3 &relative, const Vec3 &middle, const Vec3 &normal,
                                                const Vec3 &turning) {
  const Vec3 slip = slip_velocity(relative, middle, turning);
  return sum(slip, -dot(slip, normal), normal);
}

/// The overlap, m, at which a law whose tangential stiffness depends on it gives the stiffness of a step:
/// that at the end of the step while the overlap shrinks, that of its middle while it grows. With
/// kept_spring() this makes the force of second order in dt. \param rate of the overlap, m/s
[[nodiscard]] inline double overlap_of_spring(double overlap, double rate, double dt) {
  return rate > 0.0 ? std::max(0.5 * overlap, overlap - 0.5 * dt * rate) : overlap;
}

/// The share of a tangential spring's length that is kept when its stiffness changes, N/m, between two steps.
/// While the stiffness grows the force is kept, and the spring becomes shorter; while it shrinks the length
/// is kept, and the force becomes smaller. Either way the energy in the spring does not grow. (With the
/// length kept throughout, a contact that is loaded along one path and unloaded along another would create
/// energy.)
/// \param before stiffness of the step before; 0: there was none
[[nodiscard]] inline double kept_spring(double before, double now) {
  return before > 0.0 && before < now ? before / now : 1.0;
}

/// friction_step() of Cap::coulomb. With e the direction of the pull, L the limit, xi0 the spring before,
/// projected on the tangent plane (and not stretched again to its former length: the energy that it loses is
/// heat), xi the spring after:
///   trial    xi* = xi0 + vt dt,  T = kt xi* + ct vt
///   stick    if |T| <= L:  xi = xi*, pull T
///   slide    else: pull p = L e, e = T/|T|, and kt xi + ct (xi - xi0)/dt = p
/// T - p = (kt + ct/dt) (xi* - xi), so the slider's displacement xi* - xi is along the pull, and the work in
/// the step is
///   p . vt dt = p . (xi* - xi) + ct |xi - xi0|^2/dt + kt xi . (xi - xi0)
/// where the first two, heat of slider and dashpot, are >= 0 and the last is the change of kt |xi|^2/2 plus
/// kt |xi - xi0|^2/2: whatever kt, ct, L and vt, a step stores at most the work that is done in it. For pulls
/// of 1e-150 to 1e150 N, or none.
[[nodiscard]] inline FrictionStep coulomb_step(const Friction &friction, double normal_force,
                                               const Vec3 &normal, const Vec3 &tangential_velocity,
                                               const Vec3 &spring_before, double dt) {
  const double kt = friction.stiffness;
  const double ct = friction.damping;
  const double limit = friction_limit(friction, normal_force);
  const Vec3 &vt = tangential_velocity;

  const double off_plane = dot(spring_before, normal);
  const Vec3 before = sum(spring_before, -off_plane, normal);
  Vec3 spring = sum(before, dt, vt);
  Vec3 pull = sum(scaled(kt, spring), ct, vt);
  const double length = std::sqrt(dot(pull, pull));
  const bool sliding =
      length > limit || limit == 0.0; // without a normal force there is no friction, not even of a zero pull
  double slip_heat = 0.0;
  if (sliding) {
    pull = limit == 0.0 ? Vec3{} : scaled(limit / length, pull);
    const double resistance = kt * dt + ct;
    const bool moves = dt > 0.0 && resistance > 0.0;
    spring = moves ? scaled(1.0 / resistance, sum(scaled(ct, before), dt, pull)) : before;
    slip_heat = moves ? limit * (length - limit) * dt / resistance : 0.0;
  }
  const Vec3 stretched = sum(spring, -1.0, before);
  const double dashpot_heat = dt > 0.0 ? ct * dot(stretched, stretched) / dt : 0.0;
  const double dissipated = dashpot_heat + slip_heat + 0.5 * kt * off_plane * off_plane;
  return {scaled(-1.0, pull), spring, dissipated, 0.5 * kt * dot(spring, spring), sliding};
}

/// Force on ball i and spring of coulomb_step().
struct PulledSpring {
  Vec3 force;  ///< N
  Vec3 spring; ///< m
};

/// coulomb_step() with a smaller normal force than it was computed with, from its result: the pull is
/// shortened to the new limit, and the spring gives way by what the pull loses over kt + ct/dt. A pull within
/// the limit stays as it is. Both are then what coulomb_step() gives with that normal force, so that no
/// energy is made. For a normal force that is known only when all forces of a step are.
/// \param before force and spring that coulomb_step() has given \param dt s; 0: the spring stays as it is
[[nodiscard]] inline PulledSpring limited_to(const Friction &friction, double normal_force,
                                             const PulledSpring &before, double dt) {
  const double limit = friction_limit(friction, normal_force);
  const double length = std::sqrt(dot(before.force, before.force));
  if (length <= limit) return before;
  const double lost = 1.0 - limit / length;
  const double resistance = friction.stiffness * dt + friction.damping;
  const bool moves = dt > 0.0 && resistance > 0.0;
  return {scaled(limit / length, before.force),
          moves ? sum(before.spring, lost * dt / resistance, before.force) : before.spring};
}

/// Friction in the closing half kick of the step in which a contact begins, N, on ball i: the limit is that
/// of the normal force of this half kick, and the dashpot's force has the weight of the normal dashpot's. So
/// the impulse of a ball that slides is mu times the normal impulse. The spring's force has no weight, as
/// that of the normal spring.
/// \param normal_force at the end of the step, N, with which `after` was computed \param kick N, of the
/// closing half kick; \param weight of the dashpot: see StepResult \param after force and spring of the step,
/// which act in the next opening half kick
[[nodiscard]] inline Vec3 closing_friction(const Friction &friction, double normal_force, double kick,
                                           double weight, const PulledSpring &after) {
  const double limit = friction_limit(friction, kick), of_step = friction_limit(friction, normal_force);
  if (of_step == 0.0) return {};
  const double length = std::sqrt(dot(after.force, after.force));
  constexpr double rounding = 1e-12;
  if (length >= (1.0 - rounding) * of_step) return scaled(limit / of_step, after.force); // it slides
  const Vec3 elastic = scaled(-friction.stiffness, after.spring);
  const Vec3 closing = sum(scaled(1.0 - weight, elastic), weight, after.force);
  const double squared = dot(closing, closing);
  return squared > limit * limit ? scaled(limit / std::sqrt(squared), closing) : closing;
}

/// One step of friction with history: the spring takes vt dt up, is projected on the present tangent plane
/// and, where it slides, is reset to the limit.
///   trial    xi* = P (xi + vt dt)
///   stick    F = -(kt xi* + ct vt)
///   slide    Cap::spring  if kt |xi*| > mu |Fn|:         F = -mu |Fn| xi* / |xi*|,       xi = -F / kt
///            Cap::total   if |kt xi* + ct vt| > mu |Fn|: F = -mu |Fn| (kt xi* + ct vt) / |kt xi* + ct vt|,
///                                                        xi = (-F - ct vt) / kt
///            Cap::coulomb if |kt xi* + ct vt| > mu max(Fn, 0): see coulomb_step()
/// normal_force Fn in N, of either sign (its magnitude counts but for Cap::coulomb: under transition A a
/// contact also rubs in tension); normal a unit vector of either sense; tangential_velocity vt in m/s, in the
/// tangent plane; spring_before xi in m, zero for a new contact; dt in s, >= 0 (0: evaluates the force
/// without moving the spring). (One difference to LAMMPS: where the trial spring is exactly zero and the
/// dashpot alone is beyond the limit, as in the first force of a run, LAMMPS drops the force altogether; here
/// it is mu |Fn| as in every step.)
///
/// Energy: the work that the balls do on the contact, the integral of -F . vt over the step, is the change of
/// `stored` plus `dissipated`, which is the dashpot's heat ct vt^2 dt where it acts, plus kt xi . (xi* - xi)
/// of the slip, plus the energy that the spring loses by the projection. In steady sliding this is exactly mu
/// |Fn| |vt| dt, in sticking exactly the dashpot's heat; the step in which one turns into the other is right
/// to second order in dt. dissipated >= 0 for Cap::coulomb and Cap::spring always, and for Cap::total as long
/// as ct |vt| <= mu |Fn|. Beyond that Cap::total winds the spring up against the motion, and stores more
/// energy than the work done on it: the law is not passive there, and `dissipated` is negative.
[[nodiscard]] inline FrictionStep friction_step(const Friction &friction, double normal_force,
                                                const Vec3 &normal, const Vec3 &tangential_velocity,
                                                const Vec3 &spring_before, double dt) {
  if (friction.cap == Cap::coulomb)
    return coulomb_step(friction, normal_force, normal, tangential_velocity, spring_before, dt);
  const double kt = friction.stiffness;
  const double ct = friction.damping;
  const double limit = friction_limit(friction, normal_force);
  const Vec3 &vt = tangential_velocity;

  const Vec3 moved = sum(spring_before, dt, vt);
  const double off_plane = dot(moved, normal);
  const Vec3 trial = sum(moved, -off_plane, normal);

  Vec3 spring = trial;
  Vec3 pull{}; // force of spring and dashpot, -F
  bool sliding = false;
  double dashpot_heat = ct * dot(vt, vt) * dt;
  if (friction.cap == Cap::spring) {
    const double squared = kt * kt * dot(trial, trial);
    // The spring of a contact that slid in the step before a set-up is at the limit within rounding errors.
    const double rounding = dt > 0.0 || dot(trial, vt) <= 0.0 ? 0.0 : 1e-12;
    sliding = squared > (1.0 - rounding) * limit * limit;
    if (sliding) {
      spring = scaled(limit / std::sqrt(squared), trial);
      pull = scaled(kt, spring);
      dashpot_heat = 0.0;
    } else {
      pull = sum(scaled(kt, trial), ct, vt);
    }
  } else {
    const Vec3 trial_pull = sum(scaled(kt, trial), ct, vt);
    const double squared = dot(trial_pull, trial_pull);
    sliding = squared > limit * limit;
    if (sliding) {
      pull = scaled(limit / std::sqrt(squared), trial_pull);
      spring = scaled(kt > 0.0 ? 1.0 / kt : 0.0, sum(pull, -ct, vt));
    } else {
      pull = trial_pull;
    }
  }

  const Vec3 slip = sum(trial, -1.0, spring);
  const double dissipated = dashpot_heat + kt * dot(spring, slip) + 0.5 * kt * off_plane * off_plane;
  return {scaled(-1.0, pull), spring, dissipated, 0.5 * kt * dot(spring, spring), sliding};
}

/// Force on ball i, N, of friction with a spring at the end of a step, from the spring then and another slip
/// velocity, for output. After a step in which the contact slid, its spring is at the limit within rounding
/// errors, which must not decide whether it counts as sliding. This is therefore decided with the spring
/// advanced by a further step dt, s.
[[nodiscard]] inline Vec3 friction_after_step(const Friction &friction, double normal_force,
                                              const Vec3 &normal, const Vec3 &tangential_velocity,
                                              const Vec3 &spring, double dt) {
  const FrictionStep next = friction_step(friction, normal_force, normal, tangential_velocity, spring, dt);
  return next.sliding ? next.force
                      : friction_step(friction, normal_force, normal, tangential_velocity, spring, 0.0).force;
}

/// One step of friction without history: F = -ct vt, at most mu |Fn| long. It cannot hold a ball at rest: on
/// a slope the ball creeps. stiffness and cap of `friction` are not used; the spring is zero, nothing is
/// stored, and dissipated is -F . vt dt >= 0. Other arguments as in friction_step().
[[nodiscard]] inline FrictionStep friction_step_without_history(const Friction &friction, double normal_force,
                                                                const Vec3 &tangential_velocity, double dt) {
  const double limit = friction.coefficient * std::fabs(normal_force);
  const double speed = std::sqrt(dot(tangential_velocity, tangential_velocity));
  const bool sliding = friction.damping * speed > limit;
  const double factor = sliding ? limit / speed : friction.damping;
  return {scaled(-factor, tangential_velocity), Vec3{}, factor * speed * speed * dt, 0.0, sliding};
}

} // namespace drumlin::physics
