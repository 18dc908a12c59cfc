// The regimes of judge_regime(), which come from orbits, their Floquet multipliers and Lyapunov exponents,
// against motions that are only followed in time and counted: at 500 random points by the closed-form solver,
// at some of them by CVODE.
#include "chain/direct_solver.h"
#include "roller/regime.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace drumlin::post;

constexpr int judged_cycles = 300;

// A roller between the light ones and the heavy ones of inputs/chain, on soil between soft and stiff.
ChainParameters random_chain(std::mt19937_64 &random) {
  std::uniform_real_distribution<double> unit;
  const auto between = [&](double low, double high) { return low * std::pow(high / low, unit(random)); };
  ChainParameters p;
  p.k = between(5e6, 200e6);
  p.D = between(0.02, 1.0);
  p.omega = 2.0 * 3.14159265358979323846 * between(12.0, 40.0);
  p.Fw = (p.m2 + p.m3) * p.g * between(1.5, 4.0);
  p.transition = unit(random) < 0.5 ? Transition::A : Transition::B;
  return p;
}

class ContactCount : public MotionObserver {
public:
  void piece(const MotionPiece & /*piece*/, const PhaseDynamics & /*dynamics*/) override {}
  void change(const PhaseChange &change) override { breaks += change.broken() ? 1 : 0; }
  int breaks = 0;
};

constexpr std::size_t longest_counted = 64;
constexpr std::size_t compared = 64;

// The period after which all of the last states return to within a share of the scale; 0: none.
int period_of(const std::vector<ChainState> &states, const ChainState &scale) {
  constexpr double same = 1e-5;
  for (std::size_t period = 1; period <= longest_counted; ++period) {
    double most = 0.0;
    for (std::size_t i = states.size() - compared; i < states.size(); ++i)
      most = std::max(most, (states[i] - states[i - period]).cwiseQuotient(scale).norm());
    if (most < same) return static_cast<int>(period);
  }
  return 0;
}

Regime regime_of(int period, int breaks) {
  if (breaks == 0) return Regime::continuous_contact;
  return period == 0                ? Regime::aperiodic
         : period == 1              ? Regime::partial_uplift
         : period == 2              ? Regime::period_2
         : period <= longest_period ? Regime::higher_period
                                    : Regime::undecided; // no longer orbits are looked for
}

// How many cycles at the end of a motion are looked at.
constexpr int counted_cycles = longest_counted + compared;

// The regime after a number of cycles from rest, by counting.
Regime followed(const ChainParameters &p, int cycles) {
  const ChainSolver solver(p);
  ChainMotion motion = solver.start();
  std::vector<ChainState> states;
  ContactCount count;
  for (int cycle = 0; cycle < cycles; ++cycle) {
    const bool last = cycle + counted_cycles >= cycles;
    solver.finish_cycle(motion, last ? &count : nullptr);
    if (last) states.push_back(motion.state);
  }
  return regime_of(period_of(states, state_scale(p)), count.breaks);
}

// The same by CVODE.
Regime followed_by_cvode(const ChainParameters &p, int cycles) {
  DirectOptions options;
  options.cycles = cycles;
  options.samples_per_cycle = 1;
  const DirectResult result = solve_direct(p, options);
  const ChainHistory &h = result.history;
  std::vector<ChainState> states;
  int breaks = 0;
  for (std::size_t i = h.size() - counted_cycles; i < h.size(); ++i) {
    states.emplace_back(h.x_drum[i], h.v_drum[i], h.x_frame[i], h.v_frame[i]);
    breaks += result.cycles[i - 1].breaks;
  }
  return regime_of(period_of(states, state_scale(p)), breaks);
}

bool excepted(const RegimePoint &point) {
  if (point.period > 0) return std::fabs(point.multiplier - 1.0) < 1e-3;
  return point.exponent.low <= 0.0 && point.exponent.high >= 0.0;
}

TEST(Modes, OrbitsAndExponentsAgreeWithMotionsThatAreFollowed) {
  std::mt19937_64 random(20);
  int exceptions = 0;
  int by_cvode = 0;
  std::array<int, regime_count> seen{};
  for (int i = 0; i < 500; ++i) {
    const ChainParameters p = random_chain(random);
    const RegimePoint point = judge_regime(p, judged_cycles);
    ++seen[static_cast<std::size_t>(point.regime)];
    if (excepted(point)) {
      ++exceptions;
      continue;
    }
    // As long as judge_regime() may follow the motion, and until a disturbance of an orbit has decayed. An
    // aperiodic motion is compared over the same cycles: it may end later, in an orbit.
    const int cycles =
        point.regime == Regime::aperiodic ? 2 * judged_cycles + 40
        : point.period > 0
            ? std::max(8 * judged_cycles, static_cast<int>(std::lround(-20.0 / point.exponent.mean)))
            : 8 * judged_cycles;
    const std::string what = fmt::format(
        "point {}: {}, period {}, multiplier {}, exponent {} to {}; k {}, D {}, omega {}, Fw {}, {}", i,
        regime_names[static_cast<std::size_t>(point.regime)], point.period, point.multiplier,
        point.exponent.low, point.exponent.high, p.k, p.D, p.omega, p.Fw, transition_name(p.transition));
    EXPECT_EQ(followed(p, cycles), point.regime) << what;
    if (i % 125 == 0 && followed(p, judged_cycles) == point.regime) {
      EXPECT_EQ(followed_by_cvode(p, judged_cycles), point.regime) << what << ", CVODE";
      ++by_cvode;
    }
  }
  EXPECT_LT(exceptions, 15);
  EXPECT_GE(by_cvode, 3);
  for (const Regime regime : {Regime::continuous_contact, Regime::partial_uplift, Regime::period_2,
                              Regime::higher_period, Regime::aperiodic})
    EXPECT_GT(seen[static_cast<std::size_t>(regime)], 25) << regime_names[static_cast<std::size_t>(regime)];
}

} // namespace
