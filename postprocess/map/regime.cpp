#include "map/regime.h"

#include "support/statistics.h"
#include "support/units.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <utility>
#include <vector>

namespace drumlin::post {

const std::array<const char *, regime_count> regime_names = {
    "continuous contact", "partial uplift", "period 2", "higher period", "aperiodic", "undecided"};

Regime regime_from_name(const std::string &name) {
  const auto *const found = std::find(regime_names.begin(), regime_names.end(), name);
  if (found == regime_names.end())
    throw std::invalid_argument(fmt::format("{}", fmt::join(regime_names, ", ")));
  return static_cast<Regime>(found - regime_names.begin());
}

namespace {

// Gauss's rule of 12 points on [-1, 1], the positive half: Abramowitz and Stegun, Handbook of Mathematical
// Functions, table 25.4.
struct Node {
  double place, weight;
};
constexpr std::array<Node, 6> gauss = {{{0.125233408511468915, 0.249147045813402785},
                                        {0.367831498998180194, 0.233492536538354809},
                                        {0.587317954286617447, 0.203167426723065922},
                                        {0.769902674194304687, 0.160078328543346226},
                                        {0.904117256370474857, 0.106939325995318431},
                                        {0.981560634246719251, 0.047175336386511827}}};

using Complex = std::complex<double>;

class Meter : public MotionObserver {
public:
  explicit Meter(const ChainSolver &solver) : solver_(solver) {}

  void begin_cycle(int cycle) {
    turn_ = (cycle % 2 == 0 ? 0.0 : pi);
    end_cycle();
  }

  void piece(const MotionPiece &piece, const PhaseDynamics & /*dynamics*/, std::uint32_t acting) override {
    const double half = 0.5 * piece.end;
    for (const Node &node : gauss)
      for (const double side : {-1.0, 1.0})
        add(piece, acting != 0, half * (1.0 + side * node.place), node.weight * half * piece.length);
    if (acting == 0) return;
    contact_ += piece.end * piece.length;
    extremes(piece);
  }
  void change(const ContactChange & /*change*/) override {}

  MeterValues values(int cycles) {
    end_cycle();
    const ChainParameters &p = solver_.parameters();
    MeterValues values;
    MeterAmplitudes amplitudes{};
    for (std::size_t j = 0; j < amplitudes.size(); ++j)
      amplitudes[j] = std::abs(drum_[j]);
    if (amplitudes[basic_order] > 0.0) {
      values.cmv = compaction_meter(amplitudes);
      values.rmv = resonance_meter()(amplitudes);
      values.ccv = compaction_control(amplitudes);
      // Sums of a exp(i omega t) are over half the time of the cycles as large as amplitudes.
      const Complex drum = drum_[basic_order] * (2.0 / (cycles * p.period()));
      const Complex frame = frame_ * (2.0 / (cycles * p.period()));
      const Complex displacement = -drum / (p.omega * p.omega);
      const Complex from_drum = p.m2 * drum + Complex(0.0, p.Fw); // Fw sin(omega t)
      const Complex stiffness = -(from_drum + p.m3 * frame) / displacement;
      values.k_B = -(from_drum / displacement).real();
      values.k_1 = stiffness.real();
      values.c_1 = -stiffness.imag() / p.omega;
    }
    values.energy = 2.0 * energy_ / cycles;
    values.peak_force = peak_;
    values.contact_share = std::min(1.0, contact_ / (cycles * p.period()));
    values.deflections = std::move(deflections_);
    return values;
  }

private:
  void end_cycle() {
    if (lowest_ < 0.0) deflections_.push_back(-lowest_);
    lowest_ = 0.0;
  }

  void add(const MotionPiece &piece, bool acts, double s, double weight) {
    const ChainParameters &p = solver_.parameters();
    const ChainState state = piece.state(s);
    const double a = weight * piece.drum_acceleration(s);
    const double half_angle = 0.5 * (p.omega * (piece.begin + s * piece.length)) + turn_;
    const Complex half(std::cos(half_angle), std::sin(half_angle));
    Complex turned = a;
    for (Complex &sum : drum_) // the orders are multiples of one half
      sum += turned *= half;
    const double from_bond = p.c23 * (state[3] - state[1]) + p.k23 * (state[2] - state[0]);
    frame_ += weight * (-p.g - from_bond / p.m3) * half * half;
    if (acts) energy_ -= weight * solver_.system().law(state) * state[1];
  }

  // Largest force and lowest position in a piece: where their rates change sign between points so close that
  // they do so once.
  void extremes(const MotionPiece &piece) {
    constexpr int parts = 8;
    const ChainParameters &p = solver_.parameters();
    const auto rate = [&](double s) {
      return -(p.k * piece.state(s)[1] + p.damping() * piece.drum_acceleration(s));
    };
    const auto sinking = [&](double s) { return -piece.state(s)[1]; };
    const auto take = [&](double s) {
      const ChainState state = piece.state(s);
      peak_ = std::max(peak_, solver_.system().force(state));
      lowest_ = std::min(lowest_, state[0]);
    };
    take(0.0);
    take(piece.end);
    double before = 0.0;
    double rise = rate(before), sink = sinking(before);
    for (int part = 1; part <= parts; ++part) {
      const double after = piece.end * part / parts;
      const double next_rise = rate(after), next_sink = sinking(after);
      if (rise > 0.0 && next_rise < 0.0) take(turn_between(before, after, rate));
      if (sink > 0.0 && next_sink < 0.0) take(turn_between(before, after, sinking));
      before = after;
      rise = next_rise;
      sink = next_sink;
    }
  }
  template <class Rate>
  static double turn_between(double low, double high, const Rate &rate) {
    while (high - low > 1e-9) { // the value is flat here: its own error is the square
      const double middle = 0.5 * (low + high);
      (rate(middle) > 0.0 ? low : high) = middle;
    }
    return low;
  }

  const ChainSolver &solver_;
  double turn_ = 0.0;
  std::array<Complex, meter_orders.size()> drum_{}; // integrals of the acceleration times exp(i n omega t)
  Complex frame_;                                   // the same of the frame, once the excitation
  double energy_ = 0.0;
  double peak_ = 0.0;
  double contact_ = 0.0;
  double lowest_ = 0.0; // position of the drum in this cycle
  std::vector<double> deflections_;
};

} // namespace

MeterValues meter_values(const ChainSolver &solver, const ChainState &state, int cycles) {
  Meter meter(solver);
  ChainMotion motion = solver.start_at(state);
  for (int cycle = 0; cycle < cycles; ++cycle) {
    meter.begin_cycle(cycle);
    solver.finish_cycle(motion, &meter);
  }
  return meter.values(cycles);
}

namespace {

RegimePoint of_orbit(const ChainSolver &solver, const PeriodicOrbit &orbit, long followed) {
  RegimePoint point;
  point.followed = static_cast<int>(followed);
  point.period = orbit.period;
  point.multiplier = std::abs(orbit.multipliers[0]);
  constexpr double forgotten = -1e3; // a multiplier of zero has no logarithm
  const double rate = point.multiplier > 0.0 ? std::log(point.multiplier) / point.period : forgotten;
  point.exponent = {rate, rate, rate};
  point.regime = orbit.always_contact() ? Regime::continuous_contact
                 : orbit.period == 1    ? Regime::partial_uplift
                 : orbit.period == 2    ? Regime::period_2
                                        : Regime::higher_period;
  point.meter = meter_values(solver, orbit.state, orbit.period % 2 == 0 ? orbit.period : 2 * orbit.period);
  return point;
}

} // namespace

RegimePoint judge_regime(const ChainParameters &parameters, int cycles) {
  const ChainSolver solver(parameters);
  const auto settled = settle(ChainCycles{solver}, solver.start(), cycles);
  if (settled.orbit) return of_orbit(solver, {*settled.orbit}, settled.followed);
  RegimePoint point;
  point.exponent = settled.exponent;
  if (settled.aperiodic) point.regime = Regime::aperiodic;
  point.followed = static_cast<int>(settled.followed);
  constexpr int window = 64;
  point.meter = meter_values(solver, settled.state, window);
  return point;
}

} // namespace drumlin::post
