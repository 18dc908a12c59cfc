// Periodic motions of the roller: how they are found, their stability, and how they change along a parameter.
#include "tests/support/chain_by_cvode.h"
#include "tests/support/eigenvalues.h"
#include "tests/support/page.h"
#include "tests/support/piecewise_oracle.h"
#include "tests/support/tool.h"
#include "chain/one_contact.h"
#include "map/course.h"
#include "map/orbits.h"
#include "map/regime.h"
#include "support/process.h"

#include <Eigen/LU>
#include <Eigen/Core>

namespace drumlin::test {
namespace {

// Monodromy against finite differences, multipliers of unbroken contact against the roots of its matrix,
// onsets against closed forms and against CVODE.
namespace orbits {

using namespace drumlin::post;

ChainState settled(const ChainSolver &solver, int cycles) {
  ChainMotion motion = solver.start();
  for (int cycle = 0; cycle < cycles; ++cycle)
    solver.finish_cycle(motion);
  return motion.state;
}

Eigen::Matrix4d scaled(const Eigen::Matrix4d &jacobian, const ChainState &scale) {
  return scale.cwiseInverse().asDiagonal() * jacobian * scale.asDiagonal();
}

// A chain whose motion of period 1 doubles between k = 10 and 20 MN/m.
ChainParameters doubling_chain(double k) {
  ChainParameters p = table1_case("II", Transition::B);
  p.D = 0.1;
  p.k = k;
  return p;
}

void expect_jacobian_of_differences(const ChainParameters &p, int period) {
  const ChainSolver solver(p);
  const ChainState scale = state_scale(p);
  const auto orbit = find_orbit(solver, settled(solver, 200), period);
  ASSERT_TRUE(orbit);
  EXPECT_LT(orbit->residual, 1e-11);
  Eigen::Matrix4d differences;
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double h = 1e-6 * scale[i];
    ChainState up = orbit->state;
    ChainState down = orbit->state;
    up[i] += h;
    down[i] -= h;
    differences.col(i) = (pass(solver, up, period).end - pass(solver, down, period).end) / (2.0 * h);
  }
  EXPECT_LT((scaled(differences - orbit->passage.jacobian, scale)).norm(),
            1e-7 * scaled(differences, scale).norm());
}

TEST(Orbits, MonodromyAgreesWithFiniteDifferences) {
  for (const char *name : {"I", "II", "III", "IV"})
    for (const Transition transition : {Transition::A, Transition::B}) {
      SCOPED_TRACE(std::string(name) + transition_name(transition));
      expect_jacobian_of_differences(table1_case(name, transition), 1);
    }
  SCOPED_TRACE("period 2");
  expect_jacobian_of_differences(doubling_chain(40e6), 2);
}

TEST(Orbits, MonodromyOfStiffDampingAgreesWithFiniteDifferences) {
  for (const double D : {10.0, 1e3}) {
    SCOPED_TRACE(D);
    ChainParameters p = table1_case("II", Transition::B);
    p.D = D;
    expect_jacobian_of_differences(p, 1);
  }
}

TEST(Orbits, MultipliersOfUnbrokenContactAreExponentialsOfItsRoots) {
  for (const char *name : {"I", "IV"}) {
    const ChainParameters p = table1_case(name, Transition::A);
    const ChainSolver solver(p);
    const auto orbit = find_orbit(solver, settled(solver, 100), 1);
    ASSERT_TRUE(orbit);
    ASSERT_TRUE(orbit->always_contact());
    EXPECT_LT((orbit->state - steady_contact_state(p)).norm(), 1e-13);
    Eigen::Matrix4d a;
    a << 0, 1, 0, 0, -(p.k + p.k23) / p.m2, -(p.damping() + p.c23) / p.m2, p.k23 / p.m2, p.c23 / p.m2, 0, 0,
        0, 1, p.k23 / p.m3, p.c23 / p.m3, -p.k23 / p.m3, -p.c23 / p.m3;
    const Eigen::VectorXcd roots = oracle::eigenvalues_of(a);
    for (const std::complex<double> multiplier : orbit->multipliers) {
      double nearest = 1.0;
      for (Eigen::Index i = 0; i < 4; ++i)
        nearest = std::min(nearest, std::abs(multiplier - std::exp(roots[i] * p.period())));
      EXPECT_LT(nearest, 1e-12) << name << multiplier;
    }
  }
}

// Least contact force of the steady state with unbroken contact, by the amplitude of the frequency response;
// no code of the project.
double least_force(const ChainParameters &p) {
  const std::complex<double> i(0.0, 1.0);
  Eigen::Matrix2cd dynamic;
  const std::complex<double> bond = p.k23 + i * p.omega * p.c23;
  dynamic << p.k + i * p.omega * p.damping() + bond - p.m2 * p.omega * p.omega, -bond, -bond,
      bond - p.m3 * p.omega * p.omega;
  const Eigen::Vector2cd x = dynamic.inverse() * Eigen::Vector2cd(p.Fw, 0.0);
  const std::complex<double> contact =
      p.transition == Transition::B ? p.k + i * p.omega * p.damping() : std::complex<double>(p.k);
  return (p.m2 + p.m3) * p.g - std::abs(contact * x[0]);
}

TEST(Orbits, OnsetOfLossOfContactIsWhereTheLeastForceIsZero) {
  for (const Transition transition : {Transition::A, Transition::B})
    for (double ChainParameters::*number : {&ChainParameters::k, &ChainParameters::Fw}) {
      const ChainFamily family = [&](double value) {
        ChainParameters p = table1_case("I", transition);
        p.*number = value;
        return p;
      };
      double from = family(0.0).*number == 0.0 ? table1_case("I", transition).*number : 0.0;
      double to = 4.0 * from;
      ASSERT_GT(least_force(family(from)), 0.0);
      ASSERT_LT(least_force(family(to)), 0.0);
      const auto onset = locate_contact_loss(family, from, to);
      ASSERT_TRUE(onset);
      for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (from + to);
        (least_force(family(middle)) > 0.0 ? from : to) = middle;
      }
      EXPECT_NEAR(onset->value, from, 1e-8 * from);
      EXPECT_NEAR(contact_margin(family(onset->value)), 0.0, 1e-4);
    }
  EXPECT_FALSE(locate_contact_loss([](double) { return table1_case("I", Transition::A); }, 1.0, 2.0));
}

TEST(Orbits, PeriodDoublingIsWhereAMultiplierIsMinusOne) {
  const ChainFamily family = doubling_chain;
  const ChainSolver before(family(15e6));
  const auto start = find_orbit(before, settled(before, 400), 1);
  ASSERT_TRUE(start);
  ASSERT_TRUE(start->stable());
  const auto doubling = locate_doubling(family, 15e6, 25e6, *start);
  ASSERT_TRUE(doubling);
  EXPECT_TRUE(doubling->smooth);
  // To 1e-8: within that the multiplier passes -1.
  const std::vector<BranchPoint> branch = continue_orbit(family, 15e6, doubling->value, 8, *start);
  ASSERT_EQ(branch.back().value, doubling->value);
  const auto least = [&](double value) {
    const auto orbit = find_orbit(ChainSolver(family(value)), branch.back().orbit.state, 1);
    EXPECT_TRUE(orbit);
    double real = 0.0;
    for (const auto &multiplier : orbit->multipliers)
      real = std::min(real, multiplier.real());
    return real;
  };
  EXPECT_GT(least(doubling->value * (1.0 - 1e-8)), -1.0);
  EXPECT_LT(least(doubling->value * (1.0 + 1e-8)), -1.0);
  // What CVODE does on both sides.
  for (const double side : {-0.02, 0.02}) {
    ExactOptions options;
    options.cycles = 300;
    options.samples_per_cycle = 1;
    const ChainHistory h =
        drumlin::test::solve_by_cvode(family(doubling->value * (1.0 + side)), options).history;
    const std::size_t last = h.size() - 1;
    const double alternates = std::fabs(h.v_drum[last] - h.v_drum[last - 1]);
    const double repeats = std::fabs(h.v_drum[last] - h.v_drum[last - 2]);
    EXPECT_EQ(alternates > 1e-3, side > 0.0) << side;
    EXPECT_LT(repeats, 1e-4) << side;
  }
}

TEST(Orbits, AnUnstableOrbitIsFollowedBeyondTheDoubling) {
  const ChainSolver before(doubling_chain(15e6));
  const auto start = find_orbit(before, settled(before, 400), 1);
  ASSERT_TRUE(start);
  const std::vector<BranchPoint> branch = continue_orbit(doubling_chain, 15e6, 40e6, 10, *start);
  EXPECT_EQ(branch.back().value, 40e6);
  EXPECT_FALSE(branch.back().orbit.stable());
}

TEST(Orbits, TheExponentOfAStableOrbitIsTheLogarithmOfItsMultiplier) {
  for (const int period : {1, 2}) {
    const ChainSolver solver(period == 1 ? table1_case("II", Transition::A) : doubling_chain(30e6));
    ChainState state = settled(solver, 400);
    const auto orbit = find_orbit(solver, state, period);
    ASSERT_TRUE(orbit);
    ASSERT_TRUE(orbit->stable());
    const Exponent exponent = largest_exponent(solver, state, 100, 2000);
    EXPECT_NEAR(exponent.mean, std::log(std::abs(orbit->multipliers[0])) / period, 2e-3);
    EXPECT_LE(exponent.low, exponent.mean);
    EXPECT_GE(exponent.high, exponent.mean);
  }
}

TEST(Orbits, NeighboursOfAnAperiodicMotionPartAsItsExponentSays) {
  const ChainSolver solver(doubling_chain(100e6));
  ChainState state = settled(solver, 300);
  const ChainState start = state;
  const Exponent exponent = largest_exponent(solver, state, 20, 4000);
  EXPECT_GT(exponent.low, 0.0);
  // Growth of a finite distance, brought back to 1e-8 after every cycle.
  const ChainState scale = state_scale(solver.parameters());
  ChainState near = start + 1e-8 * scale;
  ChainState on = start;
  double sum = 0.0;
  const int cycles = 4000;
  for (int cycle = 0; cycle < cycles; ++cycle) {
    on = pass(solver, on, 1).end;
    const ChainState apart = pass(solver, near, 1).end - on;
    const double growth = apart.cwiseQuotient(scale).norm() / 1e-8;
    sum += std::log(growth / (cycle == 0 ? 2.0 : 1.0));
    near = on + apart / growth;
  }
  EXPECT_NEAR(sum / cycles, exponent.mean, 2.0 * (exponent.high - exponent.low));
}

} // namespace orbits

// The regimes of judge_regime(), which come from orbits, their Floquet multipliers and Lyapunov exponents,
// against motions that are only followed in time and counted, at 500 random points: by the closed-form
// solver, and by CVODE, which shares no code with it (16 of the points here, all of them in .ci/nightly).
namespace modes {

using namespace drumlin::post;

constexpr int judged_cycles = 300;

// A roller between the light ones and the heavy ones of inputs/chain, on soil between soft and stiff. The
// ranges are chosen so that contact is lost at four of five points: unbroken contact is easy to judge.
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

struct JudgedPoint {
  int number = 0;
  ChainParameters chain;
  RegimePoint judged;

  // A multiplier is so near 1, or the exponent so near 0, that no motion of finite length tells the regime.
  bool excepted() const {
    if (judged.period > 0) return std::fabs(judged.multiplier - 1.0) < 1e-3;
    return judged.exponent.low <= 0.0 && judged.exponent.high >= 0.0;
  }
  // In how many cycles a small disturbance of the orbit decays by the factor exp(-20).
  int decay() const {
    return judged.period > 0 ? static_cast<int>(std::lround(-20.0 / judged.exponent.mean)) : 0;
  }
  std::string words() const {
    const ChainParameters &p = chain;
    return fmt::format(
        "point {}: {}, period {}, multiplier {}, exponent {} to {}; k {}, D {}, omega {}, Fw {}, {}", number,
        regime_names[static_cast<std::size_t>(judged.regime)], judged.period, judged.multiplier,
        judged.exponent.low, judged.exponent.high, p.k, p.D, p.omega, p.Fw, transition_name(p.transition));
  }
};

// The points, judged when they are asked for.
class Points {
public:
  static constexpr int count = 500;
  JudgedPoint next() {
    JudgedPoint point;
    point.number = drawn_++;
    point.chain = random_chain(random_);
    point.judged = judge_regime(point.chain, judged_cycles);
    return point;
  }

private:
  std::mt19937_64 random_ = std::mt19937_64(20);
  int drawn_ = 0;
};

constexpr auto longest_counted = static_cast<std::size_t>(longest_period);
constexpr std::size_t compared = 64;
// How many cycles at the end of a motion are looked at.
constexpr int counted_cycles = longest_counted + compared;

// The period after which all of the last states return to within a share of the scale; 0: none.
int period_of(const std::vector<Eigen::Vector4d> &states, const ChainParameters &p) {
  constexpr double same = 1e-5;
  const double speed = std::max(p.Fw / p.m2, p.g) / p.omega;
  const Eigen::Vector4d scale(speed / p.omega, speed, speed / p.omega, speed);
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
  return period == 0   ? Regime::aperiodic
         : period == 1 ? Regime::partial_uplift
         : period == 2 ? Regime::period_2
                       : Regime::higher_period;
}

class ContactCount : public MotionObserver {
public:
  void piece(const MotionPiece & /*piece*/, const PhaseDynamics & /*dynamics*/,
             std::uint32_t /*acting*/) override {}
  void change(const ContactChange &change) override { breaks += change.broken() ? 1 : 0; }
  int breaks = 0;
};

// The regime after a number of cycles, by counting. The motion starts with a velocity slightly above zero: in
// aperiodic motion this difference grows, so that the motion is not that of judge_regime().
Regime followed(const ChainParameters &p, int cycles) {
  const ChainSolver solver(p);
  ChainMotion motion = solver.start();
  motion.state[1] += 1e-9 * state_scale(p)[1];
  std::vector<Eigen::Vector4d> states;
  ContactCount count;
  for (int cycle = 0; cycle < cycles; ++cycle) {
    const bool last = cycle + counted_cycles >= cycles;
    solver.finish_cycle(motion, last ? &count : nullptr);
    if (last) states.push_back(motion.state);
  }
  return regime_of(period_of(states, p), count.breaks);
}

// The same by CVODE, after a start from rest or a fall onto the soil.
Regime solved_by_cvode(const ChainParameters &p, int cycles, double impact_speed) {
  ExactOptions options;
  options.cycles = cycles;
  options.samples_per_cycle = 1;
  options.impact_speed = impact_speed;
  const ExactSolution result = drumlin::test::solve_by_cvode(p, options, 1e-10);
  const ChainHistory &h = result.history;
  std::vector<Eigen::Vector4d> states;
  int breaks = 0;
  for (std::size_t i = h.size() - counted_cycles; i < h.size(); ++i) {
    states.emplace_back(h.x_drum[i], h.v_drum[i], h.x_frame[i], h.v_frame[i]);
    breaks += result.cycles[i - 1].breaks;
  }
  return regime_of(period_of(states, p), breaks);
}

// The number of cycles of a solution is limited. If more are asked for, further solutions start with other
// velocities of the drum, until one of them becomes periodic.
Regime followed_by_cvode(const ChainParameters &p, int cycles) {
  const auto most = static_cast<int>(ExactOptions::cycles_range.most);
  Regime regime = solved_by_cvode(p, std::min(cycles, most), 0.0);
  for (int start = 1; regime == Regime::aperiodic && start * most < cycles; ++start)
    regime = solved_by_cvode(p, most, 0.05 * start);
  return regime;
}

// A motion that is aperiodic at first can fall into a stable orbit after thousands of cycles. Errors of
// rounding decide when, so that the two motions do so at different times: at two of the points after 40,000
// cycles on average. Where judge_regime() found an orbit, the other motion is therefore followed until it
// settles, too.
template <class Follow>
Regime settled(const JudgedPoint &point, const Follow &follow) {
  Regime regime = Regime::undecided;
  for (const int times : {2, 40, 600}) {
    regime = follow(point.chain, std::max(times * judged_cycles, point.decay()));
    if (regime != Regime::aperiodic || point.judged.period == 0) break;
  }
  return regime;
}

TEST(Modes, OrbitsAndExponentsAgreeWithMotionsThatAreFollowed) {
  int exceptions = 0;
  int late = 0;
  std::array<int, regime_count> seen{};
  Points points;
  for (int i = 0; i < Points::count; ++i) {
    const JudgedPoint point = points.next();
    ++seen[static_cast<std::size_t>(point.judged.regime)];
    if (point.judged.period > 0 && point.judged.followed > judged_cycles) ++late;
    if (point.excepted())
      ++exceptions;
    else
      EXPECT_EQ(settled(point, followed), point.judged.regime) << point.words();
  }
  EXPECT_LT(exceptions, 15);
  EXPECT_GT(late, 10); // motions that are not at their orbit after the cycles that were asked for
  for (const Regime regime : {Regime::continuous_contact, Regime::partial_uplift, Regime::period_2,
                              Regime::higher_period, Regime::aperiodic})
    EXPECT_GT(seen[static_cast<std::size_t>(regime)], 25) << regime_names[static_cast<std::size_t>(regime)];
}

// Points whose regime is reached soon, since CVODE takes a millisecond for a cycle.
TEST(Modes, AgreeWithCvode) {
  constexpr int most = 16;
  Points points;
  int count = 0;
  for (int i = 0; i < Points::count && count < most; ++i) {
    const JudgedPoint point = points.next();
    if (point.excepted() || point.decay() > judged_cycles - counted_cycles) continue;
    EXPECT_EQ(followed_by_cvode(point.chain, judged_cycles), point.judged.regime) << point.words();
    ++count;
  }
  EXPECT_EQ(count, most);
}

// All points by CVODE, by two threads, which takes some ten minutes: run by .ci/nightly.
TEST(Modes, DISABLED_AllAgreeWithCvode) {
  std::mutex guard;
  Points points;
  int asked = 0;
  int exceptions = 0;
  int differences = 0;
  const auto work = [&] {
    for (;;) {
      JudgedPoint point;
      {
        const std::lock_guard<std::mutex> lock(guard);
        if (asked++ >= Points::count) return;
        point = points.next();
        if (point.excepted()) {
          ++exceptions;
          continue;
        }
      }
      const Regime regime = settled(point, followed_by_cvode);
      const std::lock_guard<std::mutex> lock(guard);
      differences += regime == point.judged.regime ? 0 : 1;
      EXPECT_EQ(regime, point.judged.regime) << point.words();
    }
  };
  std::thread other(work);
  work();
  other.join();
  fmt::print("{} points, {} excepted, {} differ\n", static_cast<int>(Points::count), exceptions, differences);
  EXPECT_LT(exceptions, 15);
}

} // namespace modes

// The meter along one number of the chain: its values against exact piecewise solutions, where values return,
// and the command as a user runs it.
namespace course {

namespace fs = std::filesystem;
using namespace post;

constexpr double pi = 3.14159265358979323846;

/// A roller of the 12 t class.
ChainParameters roller(double k, double D = 0.2) {
  ChainParameters p;
  p.m2 = 6000.0;
  p.m3 = 3500.0;
  p.omega = 60.0 * pi;
  p.Fw = 11.4 * p.omega * p.omega;
  p.k23 = 3.1e6;
  p.c23 = 31e3;
  p.k = k;
  p.D = D;
  return p;
}

TEST(Course, TurningPointsAreThoseOfASequence) {
  using Turns = std::vector<std::size_t>;
  EXPECT_EQ(turning_points({0, 1, 2, 3}, 0.5), Turns{});
  EXPECT_EQ(turning_points({0, 1, 5, 3, 2, 4, 9}, 0.5), (Turns{2, 4}));
  EXPECT_EQ(turning_points({5, 3, 1, 2, 0, 4}, 2.5), Turns{4}) << "an up of 1 does not count";
  EXPECT_EQ(turning_points({0, 0.1, 0, 0.1}, 0.5), Turns{});
  EXPECT_EQ(turning_points({}, 0.5), Turns{});
}

TEST(Course, CountsTheValuesOfTheAxisThatHaveAValue) {
  std::vector<CoursePoint> points;
  for (const double cmv : {0.0, 0.0, 0.0, 10.0, 20.0, 30.0, 20.0, 10.0, 15.0, 40.0}) {
    CoursePoint point;
    point.value = static_cast<double>(points.size() + 1);
    point.motion.meter.cmv = cmv;
    points.push_back(point);
  }
  const Course course = course_of(points, course_values[0]);
  EXPECT_EQ(course.turns, (std::vector<std::size_t>{5, 7}));
  EXPECT_EQ(course.same, (std::vector<std::size_t>{3, 3, 3, 1, 3, 2, 3, 2, 3, 1}));
  const std::vector<double> met = course.met_at(18.0);
  ASSERT_EQ(met.size(), 3U);
  EXPECT_NEAR(met[0], 4.8, 1e-12);
  EXPECT_NEAR(met[1], 7.2, 1e-12);
  EXPECT_NEAR(met[2], 9.12, 1e-12);
  EXPECT_EQ(course.met_at(35.0).size(), 1U);
  EXPECT_TRUE(course.met_at(50.0).empty());
}

/// Values of the last two cycles of an exact solution, from its samples.
struct Sampled {
  std::array<double, 6> amplitude{};
  double k_B = 0.0, k_1 = 0.0, c_1 = 0.0, energy = 0.0, low = 0.0;
};

Sampled sampled(const ChainParameters &p, int cycles, int samples) {
  const OracleResult exact = exact_pieces(p, cycles, samples);
  const std::size_t last = exact.time.size() - 1;
  const std::size_t first = last - 2 * static_cast<std::size_t>(samples);
  const auto harmonic = [&](const std::vector<double> &v, double order) {
    std::complex<double> sum;
    for (std::size_t i = first; i < last; ++i)
      sum +=
          (v[i + 1] - v[i]) * std::polar(1.0, -order * p.omega * 0.5 * (exact.time[i] + exact.time[i + 1]));
    return sum * p.omega / (2.0 * pi);
  };
  Sampled result;
  for (std::size_t j = 0; j < result.amplitude.size(); ++j)
    result.amplitude[j] = std::abs(harmonic(exact.v_drum, 0.5 * static_cast<double>(j + 1)));
  const std::complex<double> drum = harmonic(exact.v_drum, 1.0), frame = harmonic(exact.v_frame, 1.0);
  const std::complex<double> x = -drum / (p.omega * p.omega);
  const std::complex<double> from_drum = p.m2 * drum + std::complex<double>(0.0, -p.Fw);
  result.k_B = -(from_drum / x).real();
  result.k_1 = -((from_drum + p.m3 * frame) / x).real();
  result.c_1 = -((from_drum + p.m3 * frame) / x).imag() / p.omega;
  for (std::size_t i = first; i < last; ++i)
    result.energy -=
        0.5 * (exact.F_contact[i] + exact.F_contact[i + 1]) * (exact.x_drum[i + 1] - exact.x_drum[i]);
  for (std::size_t i = first; i < last; ++i)
    result.low = std::min(result.low, exact.x_drum[i]);
  return result;
}

// In contact, in partial uplift and in double jump, under both conditions.
TEST(Course, ValuesAreThoseOfAnExactSolution) {
  for (const Transition transition : {Transition::A, Transition::B})
    for (const double k : {15e6, 45e6, 80e6}) {
      SCOPED_TRACE(transition_name(transition) + " " + std::to_string(k));
      ChainParameters p = roller(k, k > 50e6 ? 0.3 : 0.2);
      p.transition = transition;
      CourseSetting setting;
      setting.drum = LineContact{0.76, 2.1, 0.35};
      const CoursePoint point = course_point(p, setting);
      ASSERT_LE(point.motion.period, 2);
      const Sampled exact = sampled(p, 400, 4000);
      const std::array<double, 6> &a = exact.amplitude;
      const MeterValues &meter = point.motion.meter;
      EXPECT_NEAR(meter.cmv, 300.0 * a[3] / a[1], 1e-2);
      EXPECT_NEAR(meter.rmv, 100.0 * a[0] / a[1], 1e-2);
      EXPECT_NEAR(meter.ccv, 100.0 * (a[0] + a[2] + a[3] + a[4] + a[5]) / (a[0] + a[1]), 1e-2);
      EXPECT_NEAR(meter.k_B, exact.k_B, 1e-4 * k);
      EXPECT_NEAR(meter.k_1, exact.k_1, 1e-4 * k);
      EXPECT_NEAR(meter.c_1, exact.c_1, 1e-4 * p.damping());
      EXPECT_NEAR(meter.energy, exact.energy, 1e-2 * exact.energy);
      EXPECT_NEAR(*std::max_element(meter.deflections.begin(), meter.deflections.end()), -exact.low,
                  1e-5 * -exact.low);
      EXPECT_GT(point.E_vib, 0.0);
      if (meter.contact_share == 1.0) {
        EXPECT_NEAR(meter.k_1, k, 1e-9 * k);
        EXPECT_NEAR(meter.c_1, p.damping(), 1e-9 * p.damping());
        // k_B contains the frame: its dynamic stiffness in closed form.
        const std::complex<double> bond(p.k23, p.omega * p.c23);
        const double inertia = p.m3 * p.omega * p.omega;
        EXPECT_NEAR(meter.k_B - k, (-bond * inertia / (bond - inertia)).real(), 1e-9 * k);
      }
    }
}

TEST(Course, IdentificationFindsTheSoil) {
  CourseSetting setting;
  setting.identify = true;
  const CoursePoint point = course_point(roller(50e6), setting);
  EXPECT_NEAR(point.exact.k, 50e6, 50.0);
  EXPECT_NEAR(point.exact.D, 0.2, 1e-6);
  EXPECT_NEAR(point.measured.k, 50e6, 1e6);
  EXPECT_TRUE(std::isnan(point.E_vib)) << "the drum's size is not known";
}

class CourseCommand : public Tool {
protected:
  Outcome map(const std::vector<std::string> &words) const { return drumlin("map", words); }
  std::vector<std::string> few() const {
    return words_of("--x k:20e6:70e6:11 --m2 6000 --m3 3500 --me-re 11.4 --omega 188.49556 --k23 3.1e6 --c23 "
                    "31e3 --D 0.2 --identify 5 --drum-radius 0.76 --drum-width 2.1 --out m");
  }
};

TEST_F(CourseCommand, WritesValuesMarksAndAPage) {
  draw();
  const Outcome outcome = well(map(few()));
  const Table table = read_table(folder_ / "m/meter.csv");
  ASSERT_EQ(table.rows(), 11U);
  for (const char *column :
       {"CMV [-]", "RMV [-]", "CCV [-]", "k_B [N/m]", "k_1 [N/m]", "c_1 [N s/m]", "E_vib [Pa]",
        "energy_two_cycles [J]", "peak_force [N]", "contact_share [-]", "period [cycles]", "same_cmv [-]"})
    EXPECT_EQ(table.numbers(column).size(), 11U) << column;
  const std::vector<double> k = table.numbers("k [N/m]"), k_1 = table.numbers("k_1 [N/m]");
  EXPECT_EQ(table.text("regime")[0], "continuous contact");
  EXPECT_EQ(table.text("regime")[10], "period 2");
  EXPECT_NEAR(k_1[0], k[0], 1e-6 * k[0]);
  std::size_t identified = 0;
  for (const std::string &cell : table.text("k_identified [N/m]"))
    identified += cell.empty() ? 0 : 1;
  EXPECT_EQ(identified, 3U);
  // Where contact is lost and where the period doubles, from an independent solution.
  const Table changes = read_table(folder_ / "m/boundaries.csv");
  ASSERT_GE(changes.rows(), 2U);
  EXPECT_NEAR(changes.numbers("k [N/m]")[0], 28.8593e6, 100.0);
  EXPECT_NEAR(changes.numbers("k [N/m]")[1], 64.2151e6, 100.0);
  expect_sound_page(folder_ / "m", 3);
  EXPECT_TRUE(printed(outcome, "points have a CMV that belongs to several k"));

  // A call that was interrupted gives the same.
  const std::string rows = read_text(folder_ / "m/regimes.csv"), meter = read_text(folder_ / "m/meter.csv");
  std::size_t end = 0;
  for (int line = 0; line < 5; ++line)
    end = rows.find('\n', end) + 1;
  write_files({{folder_ / "m/regimes.csv", rows.substr(0, end + 9)}});
  EXPECT_TRUE(printed(well(map(few())), "4 of 11 points are there already"));
  EXPECT_EQ(read_text(folder_ / "m/regimes.csv"), rows);
  EXPECT_EQ(read_text(folder_ / "m/meter.csv"), meter);
}

// Any parameter of roller or soil may be the axis. E_vib needs the drum's size, which is not given here.
TEST_F(CourseCommand, AlongOtherNumbers) {
  draw();
  well(map({"--x", "frequency:18:30:4", "--me-re", "4", "--identify", "0", "--out", "f"}));
  const Table table = read_table(folder_ / "f/meter.csv");
  EXPECT_EQ(table.numbers("frequency [Hz]").back(), 30.0);
  EXPECT_EQ(table.numbers("k [N/m]").back(), 1e8);
  EXPECT_TRUE(table.text("E_vib [Pa]").front().empty());
  EXPECT_TRUE(table.text("k_identified [N/m]").front().empty());
  expect_sound_page(folder_ / "f", 2);
  well(map({"--x", "me_re:1:4:4", "--k", "2e7", "--identify", "0", "--out", "e"}));
  EXPECT_GT(read_table(folder_ / "e/meter.csv").numbers("peak_force [N]").back(),
            read_table(folder_ / "e/meter.csv").numbers("peak_force [N]").front());
}

} // namespace course

} // namespace
} // namespace drumlin::test
