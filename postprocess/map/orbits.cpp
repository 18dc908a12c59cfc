#include "map/orbits.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace drumlin::post {

namespace {

// Computes the Jacobian of the motion and counts events and pieces.
class Linearised : public MotionObserver {
public:
  Linearised(Passage &passage, bool with_jacobian) : passage_(passage), with_jacobian_(with_jacobian) {}

  void piece(const MotionPiece &piece, const PhaseDynamics &dynamics) override {
    const double time = piece.length * piece.end;
    if (piece.phase == ContactPhase::contact) passage_.contact_time += time;
    if (with_jacobian_)
      for (Eigen::Index i = 0; i < 4; ++i)
        passage_.jacobian.col(i) = dynamics.carry(passage_.jacobian.col(i), time);
  }
  void change(const PhaseChange &change) override {
    passage_.makes += change.make() ? 1 : 0;
    passage_.breaks += change.broken() ? 1 : 0;
    if (with_jacobian_ && change.saltation != 0.0)
      passage_.jacobian.row(1) += change.saltation * passage_.jacobian.row(0);
  }

private:
  Passage &passage_;
  bool with_jacobian_;
};

double scaled_norm(const ChainState &difference, const ChainState &scale) {
  return difference.cwiseQuotient(scale).norm();
}

} // namespace

Passage pass(const ChainSolver &solver, const ChainState &state, int cycles, bool with_jacobian) {
  Passage passage;
  Linearised observer(passage, with_jacobian);
  ChainMotion motion = solver.start_at(state);
  for (int i = 0; i < cycles; ++i)
    solver.finish_cycle(motion, &observer);
  passage.end = motion.state;
  passage.last_phase = motion.phase;
  return passage;
}

ChainState state_scale(const ChainParameters &p) {
  double speed = std::max(p.Fw / p.m2, p.g) / p.omega;
  if (speed <= 0.0) speed = 1.0;
  ChainState scale;
  scale << speed / p.omega, speed, speed / p.omega, speed;
  return scale;
}

std::optional<PeriodicOrbit> find_orbit(const ChainSolver &solver, const ChainState &guess, int period) {
  const auto orbit = newton_orbit(ChainCycles{solver}, guess, period);
  return orbit ? std::optional(PeriodicOrbit{*orbit}) : std::nullopt;
}

namespace {

struct SteadyContact {
  std::complex<double> drum, frame; // x = Im(amplitude exp(i omega t)) + mean
  double drum_mean = 0.0, frame_mean = 0.0;
};

SteadyContact steady_contact(const ChainParameters &p) {
  using Complex = std::complex<double>;
  const Complex i(0.0, 1.0);
  const double w2 = p.omega * p.omega;
  const Complex bond = p.k23 + i * p.omega * p.c23;
  const Complex drum = p.k + i * p.omega * p.damping() + bond - p.m2 * w2;
  const Complex frame = bond - p.m3 * w2;
  const Complex det = drum * frame - bond * bond;
  if (det == Complex(0.0)) throw std::runtime_error("the chain is excited at an undamped resonance");
  SteadyContact steady;
  steady.drum = -p.Fw * frame / det;
  steady.frame = -p.Fw * bond / det;
  steady.drum_mean = p.g > 0.0 ? -(p.m2 + p.m3) * p.g / p.k : 0.0;
  steady.frame_mean = p.g > 0.0 ? steady.drum_mean - p.m3 * p.g / p.k23 : 0.0;
  return steady;
}

} // namespace

ChainState steady_contact_state(const ChainParameters &p) {
  const SteadyContact steady = steady_contact(p);
  ChainState state;
  state << steady.drum_mean + steady.drum.imag(), p.omega * steady.drum.real(),
      steady.frame_mean + steady.frame.imag(), p.omega * steady.frame.real();
  return state;
}

double contact_margin(const ChainParameters &p) {
  const double weight = (p.m2 + p.m3) * p.g;
  const double amplitude = std::abs(steady_contact(p).drum);
  const double c = p.transition == Transition::B ? p.damping() : 0.0;
  return weight - amplitude * std::abs(std::complex<double>(p.k, p.omega * c));
}

namespace {

class Tangent : public MotionObserver {
public:
  explicit Tangent(const ChainState &start) : vector(start) {}
  void piece(const MotionPiece &piece, const PhaseDynamics &dynamics) override {
    vector = dynamics.carry(vector, piece.length * piece.end);
  }
  void change(const PhaseChange &change) override { vector[1] += change.saltation * vector[0]; }
  ChainState vector;
};

} // namespace

void ChainCycles::advance(ChainMotion &motion, ChainState *tangent) const {
  if (tangent == nullptr) {
    solver.finish_cycle(motion);
    return;
  }
  Tangent observer(*tangent);
  solver.finish_cycle(motion, &observer);
  *tangent = observer.vector;
}

Exponent largest_exponent(const ChainSolver &solver, ChainState &state, int lead, int cycles) {
  return exponent_of(ChainCycles{solver}, state, lead, cycles);
}

std::vector<BranchPoint> continue_orbit(const ChainFamily &family, double from, double to, int steps,
                                        const PeriodicOrbit &start) {
  std::vector<BranchPoint> branch;
  std::optional<PeriodicOrbit> orbit = find_orbit(ChainSolver(family(from)), start.state, start.period);
  if (!orbit) return branch;
  branch.push_back({from, *orbit});
  const double whole = (to - from) / steps;
  double step = whole;
  while (branch.back().value != to) {
    const BranchPoint &last = branch.back();
    double value = last.value + step;
    if (std::fabs(to - value) < 1e-9 * std::fabs(whole) || (value > to) == (to > from)) value = to;
    ChainState guess = last.orbit.state;
    if (branch.size() > 1) { // along the line through the last two
      const BranchPoint &before = branch[branch.size() - 2];
      guess += (guess - before.orbit.state) * ((value - last.value) / (last.value - before.value));
    }
    const ChainParameters parameters = family(value);
    const ChainSolver solver(parameters);
    orbit = find_orbit(solver, guess, start.period);
    if (!orbit) orbit = find_orbit(solver, last.orbit.state, start.period);
    // If a step ends far from its start, Newton's method has found another orbit.
    constexpr double far = 0.5;
    if (orbit && scaled_norm(orbit->state - last.orbit.state, state_scale(parameters)) < far) {
      branch.push_back({value, *orbit});
      step = std::fabs(2.0 * step) > std::fabs(whole) ? whole : 2.0 * step;
      continue;
    }
    step *= 0.5;
    if (std::fabs(step) < 1e-7 * std::fabs(to - from)) break;
  }
  return branch;
}

namespace {

// Narrows from and to, at which `same` is true and false, to neighbours within 1e-11.
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

} // namespace

std::optional<OrbitChange> locate_contact_loss(const ChainFamily &family, double from, double to) {
  const auto lasts = [&family](double value) {
    const ChainSolver solver(family(value));
    return pass(solver, steady_contact_state(solver.parameters()), 1).always_contact();
  };
  const bool at_from = lasts(from);
  if (at_from == lasts(to)) return std::nullopt;
  return OrbitChange{bisected(from, to, [&](double value) { return lasts(value) == at_from; }), true};
}

std::optional<OrbitChange> locate_doubling(const ChainFamily &family, double from, double to,
                                           const PeriodicOrbit &start) {
  const auto determinant = [](const PeriodicOrbit &orbit) {
    return (orbit.passage.jacobian + Eigen::Matrix4d::Identity()).determinant();
  };
  const std::vector<BranchPoint> branch = continue_orbit(family, from, to, 4, start);
  if (branch.size() < 2) return std::nullopt;
  const bool positive = determinant(branch.front().orbit) > 0.0;
  std::size_t i = 1;
  while (i < branch.size() && (determinant(branch[i].orbit) > 0.0) == positive)
    ++i;
  if (i == branch.size()) return std::nullopt;
  PeriodicOrbit near = branch[i - 1].orbit;
  bool lost = false;
  double before = determinant(near);
  double after = determinant(branch[i].orbit);
  const double value = bisected(branch[i - 1].value, branch[i].value, [&](double middle) {
    const std::optional<PeriodicOrbit> orbit =
        find_orbit(ChainSolver(family(middle)), near.state, start.period);
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
