#pragma once
// The forces of several contacts at once. Each quantity of a contact has an array of its own, so that the
// compiler computes two or four contacts with one instruction. The formulas are those of plugin/physics, and
// the results have the same bits as those of one contact after the other.

#include "physics/scheme/advance.h"
#include "physics/laws/friction_law.h"
#include "physics/laws/rolling_law.h"

#include <cmath>
#include <cstdint>

// Functions compiled twice, for processors with and without AVX2; the first call chooses. AVX2 has no fused
// multiply-add, which would round differently. Clang 14 cannot do this for templates.
#if defined(__x86_64__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define DRUMLIN_FOR_THIS_PROCESSOR [[gnu::flatten, gnu::target_clones("avx2", "default")]]
#else
#define DRUMLIN_FOR_THIS_PROCESSOR
#endif

// Tells the compiler that no contact of the loop that follows depends on another.
#ifdef __clang__
#define DRUMLIN_INDEPENDENT_CONTACTS
#else
#define DRUMLIN_INDEPENDENT_CONTACTS _Pragma("GCC ivdep")
#endif

namespace drumlin::physics {

/// Contacts of a block: few enough for all their values to stay in the processor's first cache.
constexpr int block_size = 32;

/// Some contacts of a block: bit n is set if contact n is one of them.
using ContactSet = std::uint64_t;

namespace detail {

/// The bit of each contact, from memory: not every processor can shift several numbers by different amounts
/// at once.
struct Bits {
  ContactSet of[block_size];
};
constexpr Bits bits_of_contacts() {
  Bits all{};
  for (int n = 0; n < block_size; ++n)
    all.of[n] = ContactSet{1} << n;
  return all;
}
inline constexpr Bits bits = bits_of_contacts();

} // namespace detail

/// A number for each contact of a block.
struct alignas(64) Numbers {
  double at[block_size];
  double &operator[](int n) { return at[n]; }
  double operator[](int n) const { return at[n]; }
};

/// A vector for each contact of a block.
struct Vectors {
  Numbers x, y, z;
  Vec3 operator[](int n) const { return {x[n], y[n], z[n]}; }
  void set(int n, const Vec3 &v) {
    x[n] = v[0];
    y[n] = v[1];
    z[n] = v[2];
  }
};

/// Contacts of balls of the same two types, or of balls with a wall. The caller sets what describes them;
/// compute_normal_forces(), compute_tangential_stiffness(), then compute_friction() and compute_rolling(),
/// add the rest. Values that neither the settings nor the law need stay unset.
struct ContactBlock {
  // Set by the caller:
  Vectors separation;        ///< x_i - x_j, m, of two balls
  Numbers squared;           ///< its square, m2
  Numbers ri, rj;            ///< radii, m
  Numbers m_eff;             ///< kg
  Vectors normal_in_middle;  ///< of a wall, where the normal at the ball was in the middle of the step
  Vectors velocity;          ///< v_i - v_j with the half-step velocities, m/s
  Vectors velocity_before;   ///< the same at the beginning of the step; second-order scheme only
  Vectors wi, wj;            ///< angular velocities, rad/s
  Numbers damping_over_mass; ///< see StepContext
  Numbers force_before;      ///< N, normal force of the step before; second-order scheme only
  Vectors spring;            ///< m, of friction, before and then after the step
  Vectors rolling_spring;    ///< N m, the same of the torque of rolling resistance
  Numbers stored_stiffness;  ///< N/m, the same of the tangential stiffness, where that varies
  Numbers memory_before;     ///< what the contact remembers for its law at the beginning of the step
  // Computed:
  Numbers overlap;            ///< m; at a wall it and `normal` are set by the caller
  Numbers rate_half;          ///< m/s, rate of change of the overlap from the velocities half a step earlier
  Vectors normal;             ///< from j to i
  Vectors slip;               ///< m/s, of ball i's surface relative to j's
  Numbers arm_i, arm_j;       ///< m, from the centre of each ball to the point where friction acts
  Numbers r_eff;              ///< m; 0 for a law that does not depend on it
  Numbers force;              ///< N, normal force at the end of the step without suction, for friction
  Numbers push;               ///< N, normal force of the closing half kick, with suction
  Numbers dashpot;            ///< N s/m, of the normal dashpot
  Numbers memory;             ///< what the contact remembers for its law at the end of the step
  Numbers kt;                 ///< N/m, tangential stiffness
  Vectors tangential_force;   ///< N, on ball i
  Vectors total_force;        ///< N, on ball i
  Vectors torque_i, torque_j; ///< N m, of friction on each ball
  Vectors rolling;            ///< N m, torque of rolling resistance on ball i
};

/// When the slip of a contact is computed: see slip_velocity_of_step().
enum class Slip { none, at_end, in_middle };

/// What the balls i of a block touch. A wall has the velocity that is contained in the relative velocities of
/// the block, does not turn, and its curvature does not count: the effective radius is that of the ball.
enum class Partner { ball, wall };

/// Effective radius, m, of contacts of balls with the radii ri and rj, or with walls.
template <Partner partner>
[[nodiscard]] inline double radius_of_contact(double ri, double rj) {
  return partner == Partner::wall ? ri : effective_radius(ri, rj);
}

/// Motion and normal force of all contacts of a block. Where the second-order scheme is used, `push` and
/// `force` are those of contacts that go on and are not coupled (goes_on()). \returns those that are coupled
/// or have lost their force
template <bool stepped, Slip slip, Partner partner = Partner::ball, class Parameters>
DRUMLIN_FOR_THIS_PROCESSOR ContactSet compute_normal_forces(ContactBlock &b, int first, int end,
                                                            const Parameters &of_types, double dt) {
  const Parameters parameters = of_types; // a copy, which the arrays of the block cannot overlap
  ContactSet rare = 0;                    // as wide as the numbers beside it
  DRUMLIN_INDEPENDENT_CONTACTS
  for (int n = first; n < end; ++n) {
    constexpr bool of_balls = partner == Partner::ball;
    const double distance = of_balls ? std::sqrt(b.squared[n]) : 0.0;
    const double ri = b.ri[n], rj = of_balls ? b.rj[n] : 0.0;
    const Vec3 separation = of_balls ? b.separation[n] : Vec3{}, velocity = b.velocity[n];
    const Vec3 normal = of_balls ? scaled(1.0 / distance, separation) : b.normal[n];
    const double overlap = of_balls ? ri + rj - distance : b.overlap[n];
    const double rate_half = -dot(velocity, normal);
    const double arm_i = ri - 0.5 * overlap, arm_j = of_balls ? rj - 0.5 * overlap : 0.0;
    const double m_eff = b.m_eff[n];
    const double r_eff = Parameters::depends_on_radius ? radius_of_contact<partner>(ri, rj) : 0.0;
    if constexpr (slip != Slip::none) {
      const Vec3 turning = of_balls ? sum(scaled(arm_i, b.wi[n]), arm_j, b.wj[n]) : scaled(arm_i, b.wi[n]);
      const Vec3 middle = slip != Slip::in_middle ? normal
                          : of_balls              ? normal_in_middle(separation, velocity, dt)
                                                  : b.normal_in_middle[n];
      b.slip.set(n, slip == Slip::in_middle ? slip_velocity_of_step(velocity, middle, normal, turning)
                                            : slip_velocity(velocity, normal, turning));
    }
    auto law = parameters.law(m_eff, r_eff, Parameters::remembers ? b.memory_before[n] : 0.0);
    const double dashpot = law.dashpot(overlap);
    if constexpr (stepped) {
      const double rate_before = -dot(b.velocity_before[n], normal);
      const StepMotion motion{overlap, rate_half, rate_before, dt};
      const bool needs = needs_coupling(dt, law.stiffest(overlap), dashpot, b.damping_over_mass[n]);
      rare |= needs ? detail::bits.of[n] : 0;
      b.push[n] = b.force[n] = going_on(law, motion, b.force_before[n], m_eff);
    } else {
      ContactState state;
      const StepMotion motion{overlap, rate_half, rate_half, dt};
      b.push[n] = advance_stock(law, motion, state).kick;
      b.force[n] = state.force;
    }
    if constexpr (Parameters::remembers) {
      law.remember(overlap);
      b.memory[n] = law.memory();
    }
    b.normal.set(n, normal);
    b.overlap[n] = overlap;
    b.dashpot[n] = dashpot;
    b.rate_half[n] = rate_half;
    b.r_eff[n] = r_eff;
    b.arm_i[n] = arm_i;
    b.arm_j[n] = arm_j;
  }
  if constexpr (stepped) // in a loop of its own, since the compiler finds no instruction for both
    for (int n = first; n < end; ++n)
      rare |= lost_its_force(b.force_before[n], b.force[n]) ? detail::bits.of[n] : 0;
  return rare;
}

/// Adds suction F_a, N, to the closing half kick of contacts: see with_suction().
inline void attract(ContactBlock &b, int first, int end, double suction) {
  for (int n = first; n < end; ++n)
    b.push[n] -= suction;
}

/// Tangential stiffness of all contacts of a block. Where it varies, the springs of friction and of rolling
/// resistance follow its change. \tparam springs whether friction has a spring \tparam rolling whether there
/// is rolling resistance \tparam moves whether springs are advanced by a step: false in the set-up of a run
template <bool springs, bool rolling, bool moves, class Parameters>
DRUMLIN_FOR_THIS_PROCESSOR void compute_tangential_stiffness(ContactBlock &b, int first, int end,
                                                             const Parameters &of_types, double dt) {
  constexpr bool varies = Parameters::tangential_varies;
  const Parameters parameters = of_types;
  DRUMLIN_INDEPENDENT_CONTACTS
  for (int n = first; n < end; ++n) {
    const double overlap = b.overlap[n];
    const double at = varies ? overlap_of_spring(overlap, b.rate_half[n], dt) : overlap;
    double kt = parameters.tangential(at, b.r_eff[n]);
    if constexpr (varies && (springs || rolling)) {
      const double stored = b.stored_stiffness[n];
      if constexpr (moves) {
        if constexpr (springs) b.spring.set(n, scaled(kept_spring(stored, kt), b.spring[n]));
        if constexpr (rolling) b.rolling_spring.set(n, scaled(kept_torque(stored, kt), b.rolling_spring[n]));
        b.stored_stiffness[n] = kt;
      } else
        kt = stored > 0.0 ? stored : kt;
    }
    b.kt[n] = kt;
  }
}

/// Friction of all contacts of a block, and their total force, from the normal force and the tangential
/// stiffness. \tparam springs whether there is a tangential spring, else a dashpot alone
/// \param dt s; 0 in the set-up of a run, in which springs stay as they are
template <bool springs, Cap cap, class Coefficients>
DRUMLIN_FOR_THIS_PROCESSOR void compute_friction(ContactBlock &b, int first, int end,
                                                 const Coefficients &of_types, double dt) {
  const Coefficients coefficients = of_types;
  DRUMLIN_INDEPENDENT_CONTACTS
  for (int n = first; n < end; ++n) {
    const Vec3 normal = b.normal[n], slip = b.slip[n];
    const Friction friction = coefficients.tangential(b.kt[n], b.dashpot[n], cap);
    FrictionStep result;
    if constexpr (springs) {
      result = friction_step(friction, b.force[n], normal, slip, b.spring[n], dt);
      b.spring.set(n, result.spring);
    } else
      result = friction_step_without_history(friction, b.force[n], slip, 0.0);
    b.tangential_force.set(n, result.force);
    const Vec3 moment = cross(normal, result.force);
    b.torque_i.set(n, scaled(-b.arm_i[n], moment));
    b.torque_j.set(n, scaled(-b.arm_j[n], moment));
    b.total_force.set(n, sum(result.force, b.push[n], normal));
  }
}

/// Total force of all contacts of a block without friction.
DRUMLIN_FOR_THIS_PROCESSOR inline void compute_total_force(ContactBlock &b, int first, int end) {
  DRUMLIN_INDEPENDENT_CONTACTS
  for (int n = first; n < end; ++n)
    b.total_force.set(n, scaled(b.push[n], b.normal[n]));
}

/// Rolling resistance of all contacts of a block, from the normal force and the tangential stiffness.
/// \param dt s; 0 in the set-up of a run
template <Partner partner = Partner::ball, Resisted resisted = Resisted::rolling, class Coefficients>
DRUMLIN_FOR_THIS_PROCESSOR void compute_rolling(ContactBlock &b, int first, int end,
                                                const Coefficients &of_types, double dt) {
  const Coefficients coefficients = of_types;
  DRUMLIN_INDEPENDENT_CONTACTS
  for (int n = first; n < end; ++n) {
    const double radius = radius_of_contact<partner>(b.ri[n], b.rj[n]);
    const Vec3 spin = partner == Partner::ball ? sum(b.wi[n], -1.0, b.wj[n]) : b.wi[n];
    const RollingStep result = rolling_step(coefficients.rolling_resistance(b.kt[n], radius, resisted),
                                            b.force[n], b.normal[n], spin, b.rolling_spring[n], dt);
    b.rolling_spring.set(n, result.spring);
    b.rolling.set(n, result.torque);
  }
}

} // namespace drumlin::physics
