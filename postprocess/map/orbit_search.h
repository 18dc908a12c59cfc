// Periodic motions of a system that is excited in cycles, and whether a motion settles to one: for the chain
// (map/orbits.h) and for a drum with two ends (map/ends.h), whose states have other sizes.
//
// A System has the types State, Matrix and Passage (with `end` and `jacobian`), a Motion with `state` at the
// start of a cycle and the number `cycle` of those completed, and
//     Passage pass(state, cycles, with_jacobian)    from the start of a cycle
//     State scale()                                 by which differences of states are divided
//     Motion start_at(state)
//     void advance(motion, tangent)                 over a cycle, with a small difference unless nullptr
#pragma once

#include "chain/linear_algebra.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <optional>
#include <vector>

namespace drumlin::post {

/// The longest period that is looked for [cycles].
constexpr int longest_period = 64;

/// A motion without an orbit is followed for at most this many times the given number of cycles.
constexpr int longest_transient = 40;

/// An exponential rate with its 95 % confidence interval, per cycle.
struct Exponent {
  double mean = 0.0, low = 0.0, high = 0.0;
};

/// A motion that repeats itself after `period` cycles.
template <class System>
struct OrbitOf {
  static constexpr int size = System::State::RowsAtCompileTime;
  int period = 1;
  typename System::State state = System::State::Zero(); ///< at the start of a cycle
  typename System::Passage passage;                     ///< over the period, with Jacobian
  std::array<std::complex<double>, static_cast<std::size_t>(size)>
      multipliers{};     ///< Floquet multipliers, largest modulus first
  double residual = 0.0; ///< |end - state| in units of the scale
  bool stable() const { return std::abs(multipliers[0]) < 1.0; }
};

/// Eigenvalues of a monodromy matrix, largest modulus first.
template <int size>
std::array<std::complex<double>, static_cast<std::size_t>(size)>
floquet_multipliers(const Eigen::Matrix<double, size, size> &monodromy) {
  const Eigen::VectorXcd found = eigenvalues_of(monodromy);
  std::array<std::complex<double>, static_cast<std::size_t>(size)> values{};
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = found[static_cast<Eigen::Index>(i)];
  std::sort(values.begin(), values.end(),
            [](const auto &a, const auto &b) { return std::abs(a) > std::abs(b); });
  return values;
}

template <class State>
double scaled_distance(const State &a, const State &b, const State &scale) {
  return (a - b).cwiseQuotient(scale).norm();
}

/// Solves for an orbit by Newton's method, from a guess. No value if the residual does not become less than
/// 1e-11, or if the state exceeds 1e3 times the scale.
template <class System>
std::optional<OrbitOf<System>> newton_orbit(const System &system, const typename System::State &guess,
                                            int period) {
  using State = typename System::State;
  using Matrix = typename System::Matrix;
  constexpr int most_iterations = 40;
  constexpr double converged = 1e-11;
  constexpr double lost = 1e3;
  const State scale = system.scale();
  OrbitOf<System> orbit;
  orbit.period = period;
  orbit.state = guess;
  double best = lost;
  int idle = 0;
  for (int i = 0; i < most_iterations; ++i) {
    const typename System::Passage passage = system.pass(orbit.state, period, true);
    const State miss = passage.end - orbit.state;
    const double residual = scaled_distance(passage.end, orbit.state, scale);
    if (!(residual < lost)) return std::nullopt;
    // Iterates beyond `converged` until rounding errors stop the improvement.
    if (residual < converged && (residual >= 0.5 * best || residual == 0.0)) {
      orbit.passage = passage;
      orbit.residual = residual;
      orbit.multipliers = floquet_multipliers<OrbitOf<System>::size>(passage.jacobian);
      return orbit;
    }
    idle = residual < 0.5 * best ? 0 : idle + 1;
    if (idle > 12) return std::nullopt;
    best = std::min(best, residual);
    const Matrix equation =
        scale.cwiseInverse().asDiagonal() * (Matrix::Identity() - passage.jacobian) * scale.asDiagonal();
    const State step = solution_of(equation, miss.cwiseQuotient(scale));
    if (!step.allFinite()) return std::nullopt;
    orbit.state += step.cwiseProduct(scale);
  }
  return std::nullopt;
}

/// Largest Lyapunov exponent over `cycles` from a motion at the start of a cycle, after `lead` cycles in
/// which the small difference of two motions turns to the direction of fastest growth. The confidence
/// interval is that of the mean of 20 blocks of cycles (Student's t, 19 degrees of freedom). `state` is
/// replaced by the state at the end.
template <class System>
Exponent exponent_of(const System &system, typename System::State &state, int lead, int cycles) {
  using State = typename System::State;
  constexpr int blocks = 20;
  constexpr double student_t = 2.093; // 97.5 % quantile with 19 degrees of freedom
  const State scale = system.scale();
  const int per_block = std::max(1, cycles / blocks);
  typename System::Motion motion = system.start_at(state);
  State tangent = scale;
  std::array<double, blocks> rate{};
  for (int cycle = -lead; cycle < blocks * per_block; ++cycle) {
    system.advance(motion, &tangent);
    const double growth = tangent.cwiseQuotient(scale).norm();
    if (growth > 0.0)
      tangent /= growth;
    else
      tangent = scale; // the two motions have become equal: restart from a new difference
    if (cycle >= 0)
      rate[static_cast<std::size_t>(cycle / per_block)] += std::log(std::max(growth, 1e-300)) / per_block;
  }
  state = motion.state;
  Exponent exponent;
  for (const double r : rate)
    exponent.mean += r / blocks;
  double square = 0.0;
  for (const double r : rate)
    square += (r - exponent.mean) * (r - exponent.mean);
  const double half = student_t * std::sqrt(square / (blocks - 1) / blocks);
  exponent.low = exponent.mean - half;
  exponent.high = exponent.mean + half;
  return exponent;
}

/// The orbit with its shortest period: Newton's method for a period also finds the orbits whose period is a
/// fraction of it.
template <class System>
OrbitOf<System> with_shortest_period(const System &system, const OrbitOf<System> &orbit) {
  constexpr double same = 1e-8;
  const typename System::State scale = system.scale();
  for (int period = 1; 2 * period <= orbit.period; ++period) {
    if (orbit.period % period != 0) continue;
    if (scaled_distance(system.pass(orbit.state, period, false).end, orbit.state, scale) > same) continue;
    if (const auto shorter = newton_orbit(system, orbit.state, period)) return *shorter;
  }
  return orbit;
}

/// The stable orbit that the states at the starts of the last cycles approach; the shortest period is tried
/// first.
template <class System>
std::optional<OrbitOf<System>> reached_orbit(const System &system,
                                             const std::vector<typename System::State> &states) {
  constexpr double near = 0.02; // of the scale, after which Newton is tried
  constexpr double met = 1e-6;
  const typename System::State scale = system.scale();
  const std::size_t last = states.size() - 1;
  const std::size_t longest = std::min<std::size_t>(longest_period, last / 2);
  const auto returns =
      [&](std::size_t period) { // as long as the period: an aperiodic motion does so by chance
        for (std::size_t i = last; i > last - period; --i)
          if (scaled_distance(states[i], states[i - period], scale) > near) return false;
        return true;
      };
  for (std::size_t period = 1; period <= longest; ++period) {
    if (!returns(period)) continue;
    std::optional<OrbitOf<System>> orbit = newton_orbit(system, states[last], static_cast<int>(period));
    if (!orbit || !orbit->stable()) continue;
    const typename System::State &long_ago = states[last - longest / period * period];
    const double now = scaled_distance(states[last], orbit->state, scale);
    if (now < met || (now < near && now < scaled_distance(long_ago, orbit->state, scale)))
      return with_shortest_period(system, *orbit);
  }
  return std::nullopt;
}

/// Continues the motion for some cycles. Returns the states at the ends of the last of them.
template <class System>
std::vector<typename System::State> last_states(const System &system, typename System::Motion &motion,
                                                int cycles) {
  std::vector<typename System::State> states;
  for (int cycle = 0; cycle < cycles; ++cycle) {
    system.advance(motion, nullptr);
    if (cycle + 2 * longest_period + 1 >= cycles) states.push_back(motion.state);
  }
  return states;
}

/// What a motion has come to.
template <class System>
struct Settled {
  std::optional<OrbitOf<System>> orbit; ///< stable
  bool aperiodic = false;               ///< without an orbit: the exponent is above zero
  Exponent exponent;                    ///< of a motion without an orbit
  typename System::State state;         ///< at the start of a cycle
  long followed = 0;                    ///< cycles
};

/// Follows a motion for `cycles` cycles, 100 or more, or up to longest_transient times as many, until it has
/// reached an orbit: one that Newton finds near the last state, that is stable, and that the motion has come
/// nearer to. If it does not reach one, the exponent is taken over `cycles` cycles, and over twice and three
/// times as many while its interval contains 0 or its mean is below 0.02 per cycle.
template <class System>
Settled<System> settle(const System &system, typename System::Motion motion, int cycles) {
  Settled<System> settled;
  const auto reached = [&](const std::vector<typename System::State> &states) {
    settled.state = motion.state;
    settled.orbit = reached_orbit(system, states);
    return settled.orbit.has_value();
  };
  for (int stretch = 0; stretch < longest_transient; ++stretch) {
    const std::vector<typename System::State> states = last_states(system, motion, cycles);
    settled.followed = motion.cycle;
    if (reached(states)) return settled;
  }

  // The motion is aperiodic, or approaches its orbit very slowly.
  constexpr int lead = 20;
  constexpr int rounds = 3;
  constexpr double clearly =
      0.02; // per cycle: slower growth is also that of a motion which leaves an unstable orbit
  for (int round = 0; round < rounds && !settled.aperiodic; ++round) {
    settled.exponent = exponent_of(system, settled.state, lead, (round + 1) * cycles);
    motion = system.start_at(settled.state);
    const std::vector<typename System::State> states = last_states(system, motion, 2 * longest_period + 1);
    settled.followed += lead + (round + 1) * cycles + motion.cycle;
    if (reached(states)) return settled;
    settled.aperiodic =
        settled.exponent.low > 0.0 && (settled.exponent.mean > clearly || round + 1 == rounds);
  }
  return settled;
}

/// An orbit at a value of the parameter that is varied.
template <class System>
struct BranchPointOf {
  double value = 0.0;
  OrbitOf<System> orbit;
};

/// Follows the orbit `start`, stable or not, while the varied parameter goes from one value to another in
/// `steps` steps, or more where Newton's method needs shorter ones. Ends early where no orbit is found even
/// with a step of 1e-7 of the range, for instance where a stable and an unstable orbit meet and vanish
/// (fold). \param solver_at the solver of the System at a value
template <class System, class SolverAt>
std::vector<BranchPointOf<System>> continued_orbit(const SolverAt &solver_at, double from, double to,
                                                   int steps, const OrbitOf<System> &start) {
  std::vector<BranchPointOf<System>> branch;
  const auto first = solver_at(from);
  std::optional<OrbitOf<System>> orbit = newton_orbit(System{first}, start.state, start.period);
  if (!orbit) return branch;
  branch.push_back({from, *orbit});
  const double whole = (to - from) / steps;
  double step = whole;
  while (branch.back().value != to) {
    const BranchPointOf<System> &last = branch.back();
    double value = last.value + step;
    if (std::fabs(to - value) < 1e-9 * std::fabs(whole) || (value > to) == (to > from)) value = to;
    typename System::State guess = last.orbit.state;
    if (branch.size() > 1) { // along the line through the last two
      const BranchPointOf<System> &before = branch[branch.size() - 2];
      guess += (guess - before.orbit.state) * ((value - last.value) / (last.value - before.value));
    }
    const auto solver = solver_at(value);
    const System system{solver};
    orbit = newton_orbit(system, guess, start.period);
    if (!orbit) orbit = newton_orbit(system, last.orbit.state, start.period);
    // If a step ends far from its start, Newton's method has found another orbit.
    constexpr double far = 0.5;
    if (orbit && scaled_distance(orbit->state, last.orbit.state, system.scale()) < far) {
      branch.push_back({value, *orbit});
      step = std::fabs(2.0 * step) > std::fabs(whole) ? whole : 2.0 * step;
      continue;
    }
    step *= 0.5;
    if (std::fabs(step) < 1e-7 * std::fabs(to - from)) break;
  }
  return branch;
}

/// Narrows from and to, at which `same` is true and false, to neighbours within 1e-11.
template <class Same>
double bisected(double from, double to, const Same &same) {
  constexpr double enough = 1e-12;
  while (std::fabs(to - from) > enough * std::max(std::fabs(from), std::fabs(to))) {
    const double middle = 0.5 * (from + to);
    if (middle == from || middle == to) break;
    (same(middle) ? from : to) = middle;
  }
  return 0.5 * (from + to);
}

/// Where an orbit changes its kind while a parameter is varied.
struct OrbitChange {
  double value = 0.0; ///< of the parameter, with a relative error of 1e-11
  bool smooth = true; ///< doubling: a multiplier passes -1; false: it jumps over -1, since the orbit meets a
                      ///< boundary of the contact
};

/// Where a multiplier of the orbit that begins as `start` at `from` passes -1. No value if the sign of det(J
/// + I) is the same at both ends or the orbit cannot be followed.
template <class System, class SolverAt>
std::optional<OrbitChange> located_doubling(const SolverAt &solver_at, double from, double to,
                                            const OrbitOf<System> &start) {
  const auto determinant = [](const OrbitOf<System> &orbit) {
    return (orbit.passage.jacobian + System::Matrix::Identity()).determinant();
  };
  const std::vector<BranchPointOf<System>> branch = continued_orbit<System>(solver_at, from, to, 4, start);
  if (branch.size() < 2) return std::nullopt;
  const bool positive = determinant(branch.front().orbit) > 0.0;
  std::size_t i = 1;
  while (i < branch.size() && (determinant(branch[i].orbit) > 0.0) == positive)
    ++i;
  if (i == branch.size()) return std::nullopt;
  OrbitOf<System> near = branch[i - 1].orbit;
  bool lost = false;
  double before = determinant(near);
  double after = determinant(branch[i].orbit);
  const double value = bisected(branch[i - 1].value, branch[i].value, [&](double middle) {
    const auto solver = solver_at(middle);
    const std::optional<OrbitOf<System>> orbit = newton_orbit(System{solver}, near.state, start.period);
    if (!orbit) {
      lost = true;
      return true;
    }
    const double now = determinant(*orbit);
    const bool same = (now > 0.0) == positive;
    if (same) near = *orbit;
    (same ? before : after) = now;
    return same;
  });
  if (lost) return std::nullopt;
  constexpr double jump = 1e-6;
  return OrbitChange{value, std::fabs(before - after) < jump};
}

} // namespace drumlin::post
