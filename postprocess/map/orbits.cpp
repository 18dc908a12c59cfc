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
  Linearised(Passage &passage, bool with_jacobian, double m2)
      : passage_(passage), with_jacobian_(with_jacobian), m2_(m2) {}

  void piece(const MotionPiece &piece, const PhaseDynamics &dynamics, std::uint32_t acting) override {
    const double time = piece.length * piece.end;
    if (acting != 0) passage_.contact_time += time;
    if (with_jacobian_)
      for (Eigen::Index i = 0; i < 4; ++i)
        passage_.jacobian.col(i) = dynamics.carry(passage_.jacobian.col(i), time);
  }
  void change(const ContactChange &change) override {
    passage_.makes += change.make() ? 1 : 0;
    passage_.breaks += change.broken() ? 1 : 0;
    if (with_jacobian_ && change.jump != 0.0)
      passage_.jacobian.row(1) -= change.jump / m2_ * passage_.jacobian.row(0);
  }

private:
  Passage &passage_;
  bool with_jacobian_;
  double m2_;
};

} // namespace

Passage pass(const ChainSolver &solver, const ChainState &state, int cycles, bool with_jacobian) {
  Passage passage;
  Linearised observer(passage, with_jacobian, solver.parameters().m2);
  ChainMotion motion = solver.start_at(state);
  for (int i = 0; i < cycles; ++i)
    solver.finish_cycle(motion, &observer);
  passage.end = motion.state;
  passage.last_phase = motion.contacts[0].phase;
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
  Tangent(const ChainState &start, double m2) : vector(start), m2_(m2) {}
  void piece(const MotionPiece &piece, const PhaseDynamics &dynamics, std::uint32_t /*acting*/) override {
    vector = dynamics.carry(vector, piece.length * piece.end);
  }
  void change(const ContactChange &change) override { vector[1] -= change.jump / m2_ * vector[0]; }
  ChainState vector;

private:
  double m2_;
};

} // namespace

void ChainCycles::advance(ChainMotion &motion, ChainState *tangent) const {
  if (tangent == nullptr) {
    solver.finish_cycle(motion);
    return;
  }
  Tangent observer(*tangent, solver.parameters().m2);
  solver.finish_cycle(motion, &observer);
  *tangent = observer.vector;
}

Exponent largest_exponent(const ChainSolver &solver, ChainState &state, int lead, int cycles) {
  return exponent_of(ChainCycles{solver}, state, lead, cycles);
}

std::vector<BranchPoint> continue_orbit(const ChainFamily &family, double from, double to, int steps,
                                        const PeriodicOrbit &start) {
  std::vector<BranchPoint> branch;
  for (const auto &[value, orbit] : continued_orbit<ChainCycles>(
           [&family](double at) { return ChainSolver(family(at)); }, from, to, steps, start))
    branch.push_back({value, {orbit}});
  return branch;
}

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
  return located_doubling<ChainCycles>([&family](double at) { return ChainSolver(family(at)); }, from, to,
                                       start);
}

} // namespace drumlin::post
