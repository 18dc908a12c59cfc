// The exact solution of the chain against CVODE, against exact pieces in extended precision, and
// against closed forms where the matrix has repeated roots. The search for events against polynomials whose
// roots are known.
#include "chain/one_contact.h"
#include "files/roller.h"
#include "tests/support/chain_by_cvode.h"
#include "tests/support/chain_record.h"
#include "tests/support/piecewise_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace drumlin::post;
using drumlin::test::largest, drumlin::test::relative;

ExactOptions cycles(double count) {
  ExactOptions options;
  options.cycles = count;
  return options;
}

void expect_same_events(const std::vector<ContactEvent> &a, const std::vector<ContactEvent> &b, double period,
                        double force, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].make, b[i].make) << i;
    EXPECT_NEAR(a[i].time, b[i].time, tolerance * period) << i;
    EXPECT_NEAR(a[i].force, b[i].force, 30 * tolerance * force) << i;
  }
}

// Both extremes of a column of cycles.csv, over the largest of CVODE's.
void expect_same_extremes(const std::vector<CycleSummary> &exact, const std::vector<CycleSummary> &direct,
                          double CycleSummary::*min, double CycleSummary::*max, double tolerance) {
  double scale = 0.0;
  for (const CycleSummary &cycle : direct)
    scale = std::max({scale, std::fabs(cycle.*min), std::fabs(cycle.*max)});
  for (std::size_t i = 0; i < direct.size(); ++i) {
    EXPECT_NEAR(exact[i].*min, direct[i].*min, tolerance * scale) << i;
    EXPECT_NEAR(exact[i].*max, direct[i].*max, tolerance * scale) << i;
  }
}

void expect_same_cycles(const std::vector<CycleSummary> &exact, const std::vector<CycleSummary> &direct,
                        double tolerance) {
  ASSERT_EQ(exact.size(), direct.size());
  expect_same_extremes(exact, direct, &CycleSummary::a_drum_min, &CycleSummary::a_drum_max, tolerance);
  expect_same_extremes(exact, direct, &CycleSummary::F_contact_min, &CycleSummary::F_contact_max, tolerance);
  for (std::size_t i = 0; i < direct.size(); ++i) {
    EXPECT_EQ(exact[i].cycle, direct[i].cycle);
    EXPECT_NEAR(exact[i].time, direct[i].time, 1e-15 * direct.back().time) << i;
    EXPECT_NEAR(exact[i].contact_share, direct[i].contact_share, tolerance) << i;
    EXPECT_EQ(exact[i].makes, direct[i].makes) << i;
    EXPECT_EQ(exact[i].breaks, direct[i].breaks) << i;
  }
}

void expect_same_as_direct(const ChainParameters &p, const ExactOptions &options, double tolerance) {
  const ExactSolution direct = drumlin::test::solve_by_cvode(p, options, 1e-14);
  const ExactSolution exact = solve_chain(p, options);
  EXPECT_LT(relative(exact.history.time, direct.history.time), 1e-15);
  EXPECT_LT(relative(exact.history.x_drum, direct.history.x_drum), tolerance);
  EXPECT_LT(relative(exact.history.v_drum, direct.history.v_drum), tolerance);
  EXPECT_LT(relative(exact.history.x_frame, direct.history.x_frame), tolerance);
  // If the frame hardly moves, rounding errors of its position, which is counted from the ground, limit the
  // digits of its velocity.
  const double rounding = 3e-15 * p.omega * largest(direct.history.x_frame);
  EXPECT_LT(relative(exact.history.v_frame, direct.history.v_frame),
            tolerance + rounding / largest(direct.history.v_frame));
  expect_same_events(exact.events, direct.events, p.period(), largest(direct.history.F_contact), tolerance);
  expect_same_cycles(exact.cycles, direct.cycles, 30 * tolerance);
}

void expect_same_as_direct(const ChainParameters &p, int cycles, double tolerance) {
  ExactOptions options;
  options.cycles = cycles;
  expect_same_as_direct(p, options, tolerance);
}

/// Counts the pieces of a motion. The solver divides time into pieces and describes the motion in each of
/// them by a polynomial.
class PieceCount : public MotionObserver {
public:
  void piece(const MotionPiece &, const PhaseDynamics &, std::uint32_t) override { ++count_; }
  void change(const ContactChange &) override {}
  int count() const { return count_; }

private:
  int count_ = 0;
};

/// The number of pieces that the solver needs for 200 cycles of the excitation. Its computing time is
/// proportional to this number.
int pieces_of_200_cycles(const ChainParameters &p) {
  const ChainSolver solver(p);
  ChainMotion motion = solver.start();
  PieceCount pieces;
  for (int cycle = 0; cycle < 200; ++cycle)
    solver.finish_cycle(motion, &pieces);
  return pieces.count();
}

class EveryCase : public testing::TestWithParam<std::tuple<const char *, Transition>> {
protected:
  ChainParameters chain() const { return table1_case(std::get<0>(GetParam()), std::get<1>(GetParam())); }
};

TEST_P(EveryCase, AgreesWithCvode) { expect_same_as_direct(chain(), 60, 1e-11); }

// The last part of a cycle has rows and events up to its end, and no row of cycles.csv.
TEST_P(EveryCase, AnImpactThatEndsWithinACycleAgreesWithCvode) {
  ExactOptions options;
  options.impact_speed = 0.3;
  options.samples_per_cycle = 7;
  for (const double cycles : {0.31, 7.29, 8.0}) {
    SCOPED_TRACE(cycles);
    options.cycles = cycles;
    expect_same_as_direct(chain(), options, 1e-11);
  }
  options.cycles = 1e-5; // its end is the start
  const ExactSolution exact = solve_chain(chain(), options);
  EXPECT_EQ(exact.history.size(), 1U);
  EXPECT_EQ(events_text(exact.events), events_text(drumlin::test::solve_by_cvode(chain(), options).events));
  EXPECT_TRUE(exact.cycles.empty());
}

TEST_P(EveryCase, AgreesWithExactPiecesInExtendedPrecision) {
  const int cycles = 20;
  const drumlin::test::OracleResult oracle = drumlin::test::exact_pieces(chain(), cycles, 50);
  const ExactSolution exact = solve_chain(chain(), cycles, 50);
  EXPECT_LT(relative(exact.history.x_drum, oracle.x_drum), 1e-11);
  EXPECT_LT(relative(exact.history.v_drum, oracle.v_drum), 1e-11);
  EXPECT_LT(relative(exact.history.v_frame, oracle.v_frame), 1e-11);
  EXPECT_LT(relative(exact.history.a_drum, oracle.a_drum), 1e-10);
  EXPECT_LT(relative(exact.history.F_contact, oracle.F_contact), 1e-10);
  expect_same_events(exact.events, oracle.events, chain().period(), largest(oracle.F_contact), 1e-11);
}

INSTANTIATE_TEST_SUITE_P(ChainSolver, EveryCase,
                         testing::Combine(testing::Values("I", "II", "III", "IV"),
                                          testing::Values(Transition::A, Transition::B)));

class EveryDamping : public testing::TestWithParam<double> {};

TEST_P(EveryDamping, AgreesWithCvode) {
  for (const Transition transition : {Transition::A, Transition::B}) {
    SCOPED_TRACE(transition_name(transition));
    ChainParameters p = table1_case("II", transition);
    p.D = GetParam();
    // The undamped contact multiplies CVODE's own error from cycle to cycle.
    expect_same_as_direct(p, p.D == 0.0 ? 4 : 10, 1e-10);
  }
}

INSTANTIATE_TEST_SUITE_P(ChainSolver, EveryDamping,
                         testing::Values(0.0, 0.1, 0.99999999, 1.0, 1.00000001, 2.0, 10.0, 100.0, 1e3, 1e4));

// The solver is fast enough for maps of many rollers and soils: 6500 pieces take 2 ms, 0.3 microseconds each.
// This holds for the cases of the paper and for rollers of manufacturers. It also holds for case II with
// other soils: with a stiffness of up to 500 MN/m (maps and reports go up to 200 MN/m) and any damping,
// whether the drum loses contact with the soil or not.
TEST(ChainSolver, TwoHundredCyclesTakeAtMost6500Pieces) {
  constexpr int most = 6500;
  for (const Transition transition : {Transition::A, Transition::B}) {
    for (const char *name : table1_cases)
      EXPECT_LE(pieces_of_200_cycles(table1_case(name, transition)), most)
          << name << ", " << transition_name(transition);
    for (const char *name : {"Axas2020", "BW120", "CA3500", "CA6500"}) {
      ChainParameters p = table1_case("II", transition);
      const drumlin::Roller roller =
          drumlin::read_roller(std::string(DRUMLIN_SOURCE_DIR "/inputs/rollers/") + name);
      for (const drumlin::RollerSetting &setting : roller.settings) {
        set_machine(p, roller, setting);
        EXPECT_LE(pieces_of_200_cycles(p), most) << name << ", " << transition_name(transition);
      }
    }
    ChainParameters p = table1_case("II", transition);
    const double weight = (p.m2 + p.m3) * p.g;
    int largest = 0;
    for (const double D : {0.0, 0.1, 0.2, 0.99999999, 1.0, 1.00000001, 2.0, 10.0, 100.0, 1e3, 1e4})
      for (const double k : {1e6, 1e7, 1e8, 5e8})
        for (const double force : {0.5, 3.0}) {
          p.D = D;
          p.k = k;
          p.Fw = force * weight;
          const int pieces = pieces_of_200_cycles(p);
          largest = std::max(largest, pieces);
          EXPECT_LE(pieces, most) << "D = " << D << ", k = " << k << ", Fw = " << p.Fw << ", "
                                  << transition_name(transition);
        }
    RecordProperty(std::string("largest_") + transition_name(transition), largest);
    EXPECT_GT(largest, most / 10);
  }
}

TEST(ChainSolver, ABondThatIsHeavilyDampedAgreesWithCvode) {
  for (const double c23 : {1e5, 1e6, 1e7}) {
    SCOPED_TRACE(c23);
    ChainParameters p = table1_case("II", Transition::B);
    p.c23 = c23;
    expect_same_as_direct(p, 6, 1e-10);
    p.D = 1e3;
    expect_same_as_direct(p, 3, 1e-10);
  }
}

// With k23 = c23 = 0 the drum is alone: x'' + 2 D w0 x' + w0^2 x = -(Fw / m2) sin(w t), and D = 1 has a
// double root.
TEST(ChainSolver, ADoubleRootFollowsItsClosedForm) {
  ChainParameters p;
  p.k23 = p.c23 = p.g = 0.0;
  p.D = 1.0;
  const double w0 = std::sqrt(p.k / p.m2);
  const double w = p.omega;
  const double f = -p.Fw / p.m2;
  // Steady part S sin + C cos.
  const double a = w0 * w0 - w * w;
  const double b = 2.0 * w0 * w;
  const double S = f * a / (a * a + b * b);
  const double C = -f * b / (a * a + b * b);
  const double x0 = -1e-4;
  const double v0 = 0.05;
  const PhaseDynamics dynamics(p, p.k, p.damping());
  MotionPiece piece;
  const double h = dynamics.longest_piece(0.0);
  dynamics.expand(piece, ChainState(x0, v0, 0.0, 0.0), h, 0.0, 1.0);
  for (const double s : {0.1, 0.5, 1.0}) {
    const double t = s * h;
    const double A = x0 - C;
    const double B = v0 - w * S + w0 * A;
    const double decay = std::exp(-w0 * t);
    const double x = S * std::sin(w * t) + C * std::cos(w * t) + (A + B * t) * decay;
    const double v = w * (S * std::cos(w * t) - C * std::sin(w * t)) + (B - w0 * (A + B * t)) * decay;
    EXPECT_NEAR(piece.state(s)[0], x, 1e-14 * std::fabs(x0)) << s;
    EXPECT_NEAR(piece.state(s)[1], v, 1e-14 * v0) << s;
  }
}

TEST(ChainSolver, AFallReachesTheGroundWhenAndHowTheParabolaSays) {
  ChainParameters p;
  p.Fw = 0.0;
  p.c23 = 0.0;
  p.g = 9.81;
  p.k23 = 1e-6; // a bond that pulls with less than rounding
  p.omega = 2.0;
  const ChainSolver solver(p);
  const double height = 0.3;
  struct First : MotionObserver {
    ContactChange first;
    bool done = false;
    void piece(const MotionPiece & /*piece*/, const PhaseDynamics & /*dynamics*/,
               std::uint32_t /*acting*/) override {}
    void change(const ContactChange &change) override {
      if (!done) first = change;
      done = true;
    }
  } observer;
  ChainMotion motion = solver.start_at(ChainState(height, 0.0, height, 0.0));
  solver.finish_cycle(motion, &observer);
  ASSERT_TRUE(observer.done);
  EXPECT_NEAR(observer.first.time, std::sqrt(2.0 * height / p.g), 1e-13);
  EXPECT_NEAR(-observer.first.overlap_rate, -std::sqrt(2.0 * height * p.g), 1e-13);
  EXPECT_NEAR(observer.first.force, p.damping() * std::sqrt(2.0 * height * p.g), 1e-6);
  EXPECT_NEAR(observer.first.jump, p.damping(), 1e-9);
}

// Without gravity and excitation the drum touches the soil and nothing moves; with excitation the contact is
// made at t = 0.
TEST(ChainSolver, AChainWithoutGravityStartsAsCvodeSays) {
  for (const Transition transition : {Transition::A, Transition::B})
    for (const double D : {0.0, 0.5})
      for (const double Fw : {0.0, 1e4}) {
        SCOPED_TRACE(transition_name(transition));
        ChainParameters p = table1_case("II", transition);
        p.g = 0.0;
        p.D = D;
        p.Fw = Fw;
        const ExactSolution exact = solve_chain(p, 1, 20);
        EXPECT_EQ(exact.events.empty(), Fw == 0.0);
        if (Fw > 0.0)
          expect_same_as_direct(p, 3, 1e-10);
        else
          EXPECT_EQ(largest(exact.history.x_drum), 0.0);
      }
}

// Contact and bond both decay within a millionth of a cycle: only one of the two is split off.
TEST(ChainSolver, KnowsWhichChainsItCannotSolveInTime) {
  ChainParameters p = table1_case("II", Transition::B);
  EXPECT_EQ(too_much_work(p, cycles(25000)), "");
  p.D = 1e6;
  EXPECT_EQ(too_much_work(p, cycles(30)), "");
  p.c23 = 1e14;
  EXPECT_EQ(too_much_work(p, cycles(30)).rfind("cycles is '30'; allowed: at most ", 0), 0U);
}

// ---- the search for events ----

std::vector<double> product_of(const std::vector<double> &roots, double factor) {
  std::vector<double> p = {factor};
  for (const double root : roots) {
    p.push_back(0.0);
    for (std::size_t i = p.size(); i-- > 0;)
      p[i] = (i > 0 ? p[i - 1] : 0.0) - root * p[i];
  }
  return p;
}

TEST(FirstUpcrossing, TwoRootsCloseTogetherAreSeen) {
  for (const double half_width : {1e-1, 1e-3, 1e-5, 1e-6}) {
    const std::vector<double> hill = product_of({0.4 - half_width, 0.4 + half_width}, -1.0);
    EXPECT_NEAR(first_upcrossing(hill.data(), hill.size()), 0.4 - half_width, 1e-9) << half_width;
  }
}

TEST(FirstUpcrossing, AHillThatStaysBelowZeroIsPassed) {
  for (const double depth : {1e-1, 1e-6, 1e-12}) {
    const std::vector<double> hill = {-0.16 - depth, 0.8, -1.0}; // -(s - 0.4)^2 - depth
    EXPECT_EQ(first_upcrossing(hill.data(), hill.size()), 2.0) << depth;
  }
}

TEST(FirstUpcrossing, AZeroAtTheStartCountsOnlyIfTheWayLeadsUp) {
  const std::vector<double> down = {0.0, -1.0, 0.5};
  EXPECT_EQ(first_upcrossing(down.data(), down.size()), 2.0);
  const std::vector<double> down_and_back = {0.0, -1.0, 2.0};
  EXPECT_NEAR(first_upcrossing(down_and_back.data(), 3), 0.5, 1e-15);
  const std::vector<double> up = {0.0, 1.0};
  EXPECT_EQ(first_upcrossing(up.data(), up.size()), 0.0);
}

TEST(FirstUpcrossing, FindsTheFirstOfRandomRoots) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> anywhere(-1.0, 2.0);
  for (std::size_t trial = 0; trial < 3000; ++trial) {
    std::vector<double> roots(1 + trial % 7);
    for (double &root : roots)
      root = anywhere(random);
    std::vector<double> p = product_of(roots, 1.0);
    if (p[0] > 0.0)
      for (double &a : p)
        a = -a;
    double first = 2.0;
    for (const double root : roots)
      if (root > 0.0 && root < 1.0) first = std::min(first, root);
    EXPECT_NEAR(first_upcrossing(p.data(), p.size()), first, 1e-7)
        << trial; // close roots are ill-conditioned
  }
}

// Largest values of random polynomials: against a fine grid, which they exceed by no more than its error.
TEST(LargestValue, IsThatOfAFineGrid) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  constexpr int grid = 4000;
  for (std::size_t trial = 0; trial < 300; ++trial) {
    std::vector<double> p(1 + trial % 12);
    for (double &a : p)
      a = anywhere(random);
    double most = p[0];
    for (int i = 0; i <= grid; ++i) {
      double value = 0.0;
      for (std::size_t n = p.size(); n-- > 0;)
        value = value * i / grid + p[n];
      most = std::max(most, value);
    }
    const double found = largest_value(p.data(), p.size(), -1e9);
    EXPECT_GE(found, most - 1e-14) << trial;
    EXPECT_LE(found, most + 1e-4) << trial; // a curvature of at most 12^3, over half a grid distance
    EXPECT_EQ(largest_value(p.data(), p.size(), 100.0), 100.0);
  }
  EXPECT_NEAR(largest_value(std::vector<double>{-0.16, 0.8, -1.0}.data(), 3, -1.0), 0.0, 1e-15);
}

// A drum that only just leaves the ground, and one that only just does not: condition A at the parameter
// where the largest height of the steady motion is zero.
TEST(ChainSolver, AGrazingLossOfContactIsSeen) {
  ChainParameters p;
  p.transition = Transition::A;
  p.k23 = p.c23 = 0.0;
  p.g = 9.81;
  p.k23 = 1e-6;
  const double w0 = std::sqrt(p.k / p.m2);
  const double mean = (p.m2 + p.m3) * p.g / p.k;
  const double gain = std::hypot(w0 * w0 - p.omega * p.omega, 2.0 * p.D * w0 * p.omega);
  const double grazing = mean * gain * p.m2; // Fw whose amplitude is the static overlap
  const double phase = std::atan2(2.0 * p.D * w0 * p.omega, w0 * w0 - p.omega * p.omega);
  for (const double beyond : {-1e-9, 1e-9}) {
    p.Fw = grazing * (1.0 + beyond);
    const double amplitude = -p.Fw / p.m2 / gain;
    const ChainSolver solver(p);
    struct Count : MotionObserver {
      int breaks = 0;
      void piece(const MotionPiece & /*piece*/, const PhaseDynamics & /*dynamics*/,
                 std::uint32_t /*acting*/) override {}
      void change(const ContactChange &change) override { breaks += change.broken(); }
    } count;
    // The bond is so soft that its force stays m3 g, the weight of the frame, as in static equilibrium.
    ChainMotion motion =
        solver.start_at(ChainState(-mean + amplitude * std::sin(-phase),
                                   amplitude * p.omega * std::cos(-phase), -mean - p.m3 * p.g / p.k23, 0.0));
    solver.finish_cycle(motion, &count);
    EXPECT_EQ(count.breaks > 0, beyond > 0.0) << beyond;
  }
}

} // namespace
