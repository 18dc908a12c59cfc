// The exact solution with one contact, standing and driving.
#include "tests/support/chain_by_cvode.h"
#include "tests/support/chain_record.h"
#include "tests/support/ode.h"
#include "tests/support/piecewise_oracle.h"
#include "chain/driven_way.h"
#include "chain/exact_solution.h"
#include "chain/one_contact.h"
#include "files/roller.h"

namespace drumlin::test {
namespace {

using namespace drumlin::post;

// The exact solution of the chain against CVODE, against exact pieces in extended precision, and
// against closed forms where the matrix has repeated roots. The search for events against polynomials whose
// roots are known.

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

// A chain that drives over soil that changes along the way, in steps and linearly, against an integration
// that shares no code with it, and against the chain that stands.

using drumlin::Way;
using drumlin::test::relative;

ExactOptions driven(const ChainParameters &p, const Way &way, double speed, int passes = 1) {
  ExactOptions options;
  options.way = drive(way, speed, passes);
  options.cycles = options.way.back().end / p.period();
  return options;
}

// k and D at a place, found from the rows.
std::pair<double, double> soil_at(const Way &way, double s, bool forth) {
  for (std::size_t i = 0; i + 1 < way.size(); ++i) {
    const std::size_t n = forth ? i : way.size() - 2 - i;
    const drumlin::WayRow &a = way[n], &b = way[n + 1];
    if (b.s == a.s || (forth ? s >= b.s : s <= a.s)) continue;
    const double share = (s - a.s) / (b.s - a.s);
    return {a.k + share * (b.k - a.k), a.D + share * (b.D - a.D)};
  }
  return forth ? std::pair{way.back().k, way.back().D} : std::pair{way.front().k, way.front().D};
}

struct Integrated {
  std::vector<double> time, v_drum, F_contact;
  std::size_t makes = 0;
};

// The equations of motion by CVODE, started again at each make and break and at each row of the way.
Integrated integrated(const ChainParameters &p, const Way &way, double speed, int passes, int samples) {
  const double length = way.back().s - way.front().s;
  const bool by_force = p.transition == Transition::B;
  int pass = 0;
  enum class Mode { contact, flight, clamped } mode = Mode::contact;
  const auto law = [&](double t, const oracle::State &y) {
    const bool forth = pass % 2 == 0;
    const double gone = speed * t - pass * length;
    const auto [k, D] = soil_at(way, forth ? way.front().s + gone : way.back().s - gone, forth);
    return -k * y[0] - 2.0 * D * std::sqrt(p.m2 * k) * y[1];
  };
  const oracle::Rates rates = [&](double t, const oracle::State &y, oracle::State &rate) {
    const double force = mode == Mode::contact ? law(t, y) : 0.0;
    const double bond = p.c23 * (y[3] - y[1]) + p.k23 * (y[2] - y[0]);
    rate = {y[1], (force + bond - p.Fw * std::sin(p.omega * t)) / p.m2 - p.g, y[3], -bond / p.m3 - p.g};
  };
  const double x2 = -(p.m2 + p.m3) * p.g / way.front().k;
  oracle::Ode ode(rates, 0.0, {x2, 0.0, x2 - p.m3 * p.g / p.k23, 0.0}, {1e-3, 0.1, 1e-3, 0.1});
  const oracle::Event touch = [](double, const oracle::State &y) { return y[0]; };

  std::vector<double> rows; // times at which the soil's course has a corner
  for (int i = 0; i < passes; ++i)
    for (std::size_t n = 0; n < way.size(); ++n)
      rows.push_back(
          (i * length + (i % 2 == 0 ? way[n].s - way.front().s : way.back().s - way[way.size() - 1 - n].s)) /
          speed);
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  const double end = passes * length / speed;
  Integrated result;
  std::size_t next_row = 1; // that is met next
  for (int sample = 0;; ++sample) {
    const double until = sample * p.period() / samples;
    if (until > end * (1.0 + 1e-13)) return result;
    while (ode.time() < until) {
      const double row = rows.at(std::min(next_row, rows.size() - 1));
      const double goal = next_row < rows.size() ? std::min(until, row) : until;
      std::vector<oracle::Event> events;
      if (mode != Mode::contact || !by_force) events.push_back(touch);
      if (mode != Mode::flight && by_force) events.emplace_back(law);
      const int event = ode.advance(goal, events);
      oracle::State y = ode.state();
      const bool touching = mode == Mode::flight || !by_force || (mode == Mode::clamped && event == 0);
      if (event >= 0 && touching) y[0] = 0.0;
      if (event >= 0 && (!touching || (y[1] > 0.0) == (mode != Mode::flight))) {
        result.makes += mode == Mode::flight || (mode == Mode::clamped && !touching);
        if (mode == Mode::contact)
          mode = by_force ? Mode::clamped : Mode::flight;
        else
          mode = touching && mode == Mode::clamped ? Mode::flight : Mode::contact;
        ode.restart(y);
      }
      // The next section; a new pass at the end of one. An event may fall together with it.
      if (next_row >= rows.size() || ode.time() < row * (1.0 - 1e-14)) continue;
      ++next_row;
      if (row >= end) continue;
      pass = static_cast<int>(std::floor(speed * row / length + 1e-9));
      if (by_force && mode != Mode::flight && y[0] < 0.0) {
        const Mode next = law(row + 1e-12, y) > 0.0 ? Mode::contact : Mode::clamped;
        result.makes += next == Mode::contact && mode != Mode::contact;
        mode = next;
      }
      ode.restart(y);
    }
    result.time.push_back(until);
    result.v_drum.push_back(ode.state()[1]);
    result.F_contact.push_back(mode == Mode::contact ? law(until, ode.state()) : 0.0);
  }
}

std::size_t makes(const ExactSolution &result) {
  return static_cast<std::size_t>(std::count_if(result.events.begin(), result.events.end(),
                                                [](const auto &event) { return event.make; }));
}

// A roller of Table 1 that loses contact in each cycle on the stiff soil of a way.
ChainParameters roller(Transition transition) { return table1_case("III", transition); }

TEST(DrivenWay, IsMetForthAndBack) {
  const Way way = {{2.0, 1e7, 0.1}, {3.0, 2e7, 0.1}, {3.0, 5e7, 0.3}, {6.0, 5e7, 0.3}};
  const std::vector<WaySection> sections = drive(way, 2.0, 3);
  ASSERT_EQ(sections.size(), 6U);
  const double begins[] = {0.0, 0.5, 2.0, 3.5, 4.0, 4.5};
  const double places[] = {2.0, 3.0, 6.0, 3.0, 2.0, 3.0};
  const double stiffnesses[] = {1e7, 5e7, 5e7, 2e7, 1e7, 5e7};
  const int passes[] = {1, 1, 2, 2, 3, 3};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_DOUBLE_EQ(sections[i].begin, begins[i]);
    EXPECT_DOUBLE_EQ(sections[i].s, places[i]);
    EXPECT_DOUBLE_EQ(sections[i].k, stiffnesses[i]);
    EXPECT_EQ(sections[i].pass, passes[i]);
    EXPECT_EQ(sections[i].begin, i > 0 ? sections[i - 1].end : 0.0);
  }
  EXPECT_DOUBLE_EQ(sections[0].k_rate, 2e7); // 1e7 N/m over a metre, at 2 m/s
  EXPECT_DOUBLE_EQ(sections[3].k_rate, -2e7);
  EXPECT_DOUBLE_EQ(sections[3].place(4.0), 2.0);
}

// At any place and any speed.
TEST(DrivenWay, UniformSoilIsThatOfTheRollerThatStands) {
  for (const char *name : {"I", "II", "III", "IV"})
    for (const Transition transition : {Transition::A, Transition::B}) {
      const ChainParameters p = table1_case(name, transition);
      const Way way = {{1e4, p.k, p.D}, {1e4 + 0.37, p.k, p.D}, {1e4 + 1.0, p.k, p.D}};
      const ExactOptions moving = driven(p, way, 1.0 / (9.7 * p.period()), 2);
      ExactOptions standing = moving;
      standing.way.clear();
      const auto expect_same = [&](const ExactSolution &a, const ExactSolution &b) {
        EXPECT_LT(relative(a.history.v_drum, b.history.v_drum), 1e-9) << name << transition_name(transition);
        EXPECT_EQ(a.events.size(), b.events.size());
        EXPECT_EQ(a.cycles.size(), b.cycles.size());
        for (std::size_t i = 0; i < std::min(a.cycles.size(), b.cycles.size()); ++i)
          EXPECT_NEAR(a.cycles[i].F_contact_max, b.cycles[i].F_contact_max, 1e-9 * b.cycles[i].F_contact_max);
      };
      expect_same(solve_chain(p, moving), solve_chain(p, standing));
      expect_same(drumlin::test::solve_by_cvode(p, moving), solve_chain(p, standing));
    }
}

// Soft, stiff and medium soil with steps between them, forth and back.
TEST(DrivenWay, StepsFollowTheIntegration) {
  for (const Transition transition : {Transition::A, Transition::B}) {
    const ChainParameters p = roller(transition);
    const Way way = {{0.0, 3e7, 0.4},  {0.31, 3e7, 0.4}, {0.31, 2e8, 0.15}, {0.61, 2e8, 0.15},
                     {0.61, 1e7, 0.2}, {0.83, 1e7, 0.2}, {0.83, 6e7, 0.6},  {1.2, 6e7, 0.6}};
    const ExactOptions options = driven(p, way, 1.93, 2);
    const ExactSolution closed = solve_chain(p, options), direct = drumlin::test::solve_by_cvode(p, options);
    const Integrated found = integrated(p, way, 1.93, 2, options.samples_per_cycle);
    EXPECT_GT(makes(closed), 10U);
    for (const ExactSolution *one : {&closed, &direct}) {
      ASSERT_EQ(one->history.size(), found.time.size());
      EXPECT_LT(relative(one->history.v_drum, found.v_drum), 1e-8) << transition_name(transition);
      EXPECT_LT(relative(one->history.F_contact, found.F_contact), 1e-7) << transition_name(transition);
      EXPECT_EQ(makes(*one), found.makes);
    }
  }
}

TEST(DrivenWay, RampsAndRandomSoilFollowTheIntegration) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform;
  for (const Transition transition : {Transition::A, Transition::B})
    for (int trial = 0; trial < 6; ++trial) {
      const ChainParameters p = roller(transition);
      Way way;
      for (double s = 0.0; s < 1.0; s += 0.02 + 0.3 * uniform(random)) {
        if (!way.empty() && uniform(random) < 0.3)
          way.push_back({s, 1e7 * std::pow(10.0, uniform(random)), 0.1});
        way.push_back({s, 1e7 * std::pow(10.0, uniform(random)), 0.5 * uniform(random)});
      }
      way.push_back({1.1, 4e7, 0.2});
      const ExactOptions options = driven(p, way, 1.7, 2);
      const Integrated found = integrated(p, way, 1.7, 2, options.samples_per_cycle);
      for (const ExactSolution &one : {solve_chain(p, options), drumlin::test::solve_by_cvode(p, options)}) {
        ASSERT_EQ(one.history.size(), found.time.size());
        EXPECT_LT(relative(one.history.v_drum, found.v_drum), 1e-8) << trial;
        EXPECT_EQ(one.history.s.size(), one.history.size());
        EXPECT_FALSE(one.history.has(ColumnGroup::ends));
        EXPECT_EQ(makes(one), found.makes);
      }
    }
}

// Under B a step can turn the force into a tension, which ends the contact there and then, or an overlap
// without force into a contact that begins with the force of the law.
TEST(DrivenWay, AStepCanEndAContactOrBeginOne) {
  ChainParameters p = roller(Transition::B);
  p.k = 3e7;
  for (const bool ends : {true, false}) {
    p.D = ends ? 0.05 : 0.9;
    const double behind = ends ? 0.9 : 0.05;
    const auto law = [&p](double D, double x, double v) {
      return -p.k * x - 2.0 * D * std::sqrt(p.m2 * p.k) * v;
    };
    const ChainHistory standing = solve_chain(p, 10, 1000).history;
    // The first row, after five cycles, at which the other damping turns compression into tension (or back).
    std::size_t row = 5000;
    while (row < standing.size() &&
           !(standing.x_drum[row] < 0.0 &&
             (law(p.D, standing.x_drum[row], standing.v_drum[row]) > 0.0) == ends &&
             (law(behind, standing.x_drum[row], standing.v_drum[row]) < 0.0) == ends))
      ++row;
    ASSERT_LT(row, standing.size());
    const double place = standing.time[row]; // at 1 m/s
    const ExactOptions options = driven(
        p, {{0.0, p.k, p.D}, {place, p.k, p.D}, {place, p.k, behind}, {place + 0.1, p.k, behind}}, 1.0);
    for (const ExactSolution &result : {solve_chain(p, options), drumlin::test::solve_by_cvode(p, options)}) {
      const auto event =
          std::find_if(result.events.begin(), result.events.end(),
                       [&](const ContactEvent &one) { return std::fabs(one.time - place) < 1e-9; });
      ASSERT_NE(event, result.events.end());
      EXPECT_EQ(event->make, !ends);
      EXPECT_NEAR(event->force, law(0.05, standing.x_drum[row], standing.v_drum[row]), 1e-4);
    }
  }
}

// A ramp of many small steps: the closed form then has the ramp but for an error of second order in them.
TEST(DrivenWay, AStaircaseConvergesToTheRamp) {
  const ChainParameters p = roller(Transition::B);
  const ExactSolution ramp = solve_chain(p, driven(p, {{0.0, 4e7, 0.3}, {1.0, 1e8, 0.3}}, 2.0));
  std::vector<double> errors;
  for (const int steps : {20, 40, 80}) {
    Way way;
    for (int i = 0; i < steps; ++i) {
      const double k = 4e7 + 6e7 * (i + 0.5) / steps;
      way.push_back({static_cast<double>(i) / steps, k, 0.3});
      way.push_back({static_cast<double>(i + 1) / steps, k, 0.3});
    }
    const ExactSolution stairs = solve_chain(p, driven(p, way, 2.0));
    errors.push_back(relative(stairs.history.v_drum, ramp.history.v_drum));
  }
  EXPECT_LT(errors[1], 0.7 * errors[0]);
  EXPECT_LT(errors[2], 0.7 * errors[1]);
  EXPECT_LT(errors[2], 5e-3);
}

// Before and behind a step of the soil the motion reaches the steady state of that soil once transients have
// decayed: 60 cycles here.
TEST(DrivenWay, TheSteadyStateIsReachedBehindAStep) {
  for (const Transition transition : {Transition::A, Transition::B}) {
    const ChainParameters p = roller(transition);
    const Way way = {{0.0, 3e7, 0.4}, {3.0, 3e7, 0.4}, {3.0, 6e7, 0.3}, {6.0, 6e7, 0.3}};
    const double speed = 3.0 / (60.0 * p.period());
    const ChainHistory h = solve_chain(p, driven(p, way, speed)).history;
    const auto expect_steady = [&](double k, double D, std::size_t cycle) {
      ChainParameters there = p;
      there.k = k;
      there.D = D;
      const ChainHistory steady = solve_chain(there, 1, 200, 400).history;
      const std::size_t first = 200 * cycle;
      const std::vector<double> met(h.F_contact.begin() + static_cast<long>(first),
                                    h.F_contact.begin() + static_cast<long>(first) + 200);
      EXPECT_LT(relative(met, steady.F_contact, 200), 1e-3) << k << transition_name(transition);
    };
    expect_steady(3e7, 0.4, 59);
    expect_steady(6e7, 0.3, 119);
  }
}

// Over a symmetric way a pass back has the same motion as a pass forth that starts in the same state and
// phase of the exciter.
TEST(DrivenWay, BackIsForthOverASymmetricWay) {
  const ChainParameters p = roller(Transition::B);
  const Way way = {{0.0, 3e7, 0.4}, {2.0, 3e7, 0.4}, {2.0, 9e7, 0.3},
                   {4.0, 9e7, 0.3}, {4.0, 3e7, 0.4}, {6.0, 3e7, 0.4}};
  const double speed = 6.0 / (150.0 * p.period());
  const ChainHistory h = solve_chain(p, driven(p, way, speed, 3)).history;
  const auto pass = [&](std::size_t n) {
    return std::vector<double>(h.v_drum.begin() + static_cast<long>(30000 * n),
                               h.v_drum.begin() + static_cast<long>(30000 * (n + 1)));
  };
  EXPECT_LT(relative(pass(1), pass(2)), 1e-9);
  for (const std::size_t row : {1000UL, 15000UL, 29000UL}) {
    EXPECT_EQ(h.pass[30000 + row], 2.0);
    EXPECT_NEAR(h.s[30000 + row], 6.0 - h.s[60000 + row], 1e-12);
  }
}

// Mean and coefficient of variation of k, and autocorrelation of ln k, of a long field.
TEST(DrivenWay, ARandomFieldHasTheMomentsAskedFor) {
  RandomSoil soil;
  soil.mean = 5e7;
  soil.variation = 0.4;
  soil.correlation = 2.0;
  soil.D = 0.2;
  soil.from = -3.0;
  soil.to = 39997.0;
  soil.step = 0.5;
  const Way way = random_way(soil);
  ASSERT_EQ(way.size(), 80001U);
  EXPECT_EQ(way.front().s, -3.0);
  EXPECT_EQ(way.back().s, 39997.0);
  const double variance = std::log(1.0 + 0.16), middle = std::log(5e7) - 0.5 * variance;
  double sum = 0.0, square = 0.0;
  double products[5] = {};
  for (std::size_t i = 0; i < way.size(); ++i) {
    EXPECT_EQ(way[i].D, 0.2);
    sum += way[i].k;
    square += way[i].k * way[i].k;
    for (std::size_t n = 0; n < 5 && i >= 4 * n; ++n) // distances of 0, 2, 4, 6, 8 m
      products[n] += (std::log(way[i].k) - middle) * (std::log(way[i - 4 * n].k) - middle);
  }
  const double count = static_cast<double>(way.size()), mean = sum / count;
  // 40,000 m have some 10,000 independent values: their means scatter by one per cent.
  EXPECT_NEAR(mean, 5e7, 0.02 * 5e7);
  EXPECT_NEAR(std::sqrt(square / count - mean * mean) / mean, 0.4, 0.02);
  for (int n = 0; n < 5; ++n)
    EXPECT_NEAR(products[n] / count / variance, std::exp(-n), 0.05) << n;

  soil.to = -1.8; // the last distance is shorter
  const Way shorter = random_way(soil);
  ASSERT_EQ(shorter.size(), 4U);
  EXPECT_EQ(shorter[2].s, -2.0);
  EXPECT_EQ(shorter[3].s, -1.8);
  EXPECT_EQ(shorter[1].k, way[1].k);
  soil.seed = 2;
  EXPECT_NE(random_way(soil)[1].k, way[1].k);
}

} // namespace
} // namespace drumlin::test
