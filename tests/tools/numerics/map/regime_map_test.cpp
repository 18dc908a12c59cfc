// Maps of regimes, of one contact and of two ends.
#include "tests/support/chain_by_cvode.h"
#include "tests/support/ode.h"
#include "tests/support/tool.h"
#include "tests/support/two_ends_oracle.h"
#include "chain/one_contact.h"
#include "files/roller.h"
#include "map/ends.h"
#include "map/orbits.h"
#include "map/regime_map.h"
#include "support/process.h"

#include <Eigen/Dense>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

namespace regime_map {

// Regimes and meter values against known values and CVODE; the map as a user runs it.
namespace maps {

using namespace drumlin::post;

// From the phase integrals of two independent solutions.
TEST(Regime, MeterValuesOfTheCasesThatLoseContact) {
  const auto cmv = [](const char *name) {
    return judge_regime(table1_case(name, Transition::B), 300).meter.cmv;
  };
  EXPECT_NEAR(cmv("II"), 155.948, 1e-5 * 155.948);
  EXPECT_NEAR(cmv("III"), 105.730, 1e-5 * 105.730);
  EXPECT_NEAR(cmv("IV"), 247.175, 1e-5 * 247.175);
}

TEST(Regime, CasesAreInTheRegimesOfTheirSteadyStates) {
  for (const Transition transition : {Transition::A, Transition::B}) {
    const auto regime = [&](const char *name) {
      return judge_regime(table1_case(name, transition), 300).regime;
    };
    EXPECT_EQ(regime("I"), Regime::continuous_contact);
    EXPECT_EQ(regime("II"), Regime::partial_uplift);
    EXPECT_EQ(regime("III"), Regime::partial_uplift);
    EXPECT_EQ(regime("IV"),
              transition == Transition::A ? Regime::continuous_contact : Regime::partial_uplift);
  }
  const RegimePoint two = judge_regime(table1_case("II", Transition::B), 300);
  EXPECT_NEAR(two.meter.contact_share, 0.202, 5e-4);
  EXPECT_NEAR(two.meter.peak_force, 247.27e3, 10.0);
}

// Period and loss of contact as CVODE's history has them after many cycles; points near a change
// are left out, since a history of finite length does not determine the regime there.
TEST(Regime, AgreesWithTheCvodeAtRandomPoints) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  int judged = 0;
  for (int trial = 0; trial < 12; ++trial) {
    ChainParameters p = table1_case("II", trial % 3 == 0 ? Transition::A : Transition::B);
    p.k = 2e6 * std::pow(100.0, share(random));
    p.D = 0.05 * std::pow(20.0, share(random));
    p.omega *= 0.8 + share(random);
    const RegimePoint point = judge_regime(p, 300);
    if (point.regime == Regime::undecided || point.period > 4 || point.multiplier > 0.95) continue;
    ++judged;
    ExactOptions options;
    options.cycles = 400;
    options.samples_per_cycle = 1;
    const ExactSolution direct = drumlin::test::solve_by_cvode(p, options, 1e-11);
    const ChainHistory &h = direct.history;
    int period = 0;
    for (int candidate = 1; candidate <= 16 && period == 0; ++candidate) {
      const auto n = static_cast<std::size_t>(candidate);
      if (std::fabs(h.v_drum[400] - h.v_drum[400 - n]) < 1e-5 &&
          std::fabs(h.v_drum[399] - h.v_drum[399 - n]) < 1e-5)
        period = candidate;
    }
    EXPECT_EQ(period, point.period) << "k " << p.k << " D " << p.D << " omega " << p.omega;
    EXPECT_EQ(direct.cycles.back().contact_share > 1.0 - 1e-9 && direct.cycles.back().breaks == 0,
              point.regime == Regime::continuous_contact);
    if (point.period == 1) {
      EXPECT_NEAR(direct.cycles.back().F_contact_max, point.meter.peak_force, 1e-5 * point.meter.peak_force);
      EXPECT_NEAR(direct.cycles.back().contact_share, point.meter.contact_share, 1e-4);
    }
  }
  EXPECT_GT(judged, 7);
}

TEST(Regime, MeterValuesOfPeriodTwoAgreeWithAFineRecord) {
  ChainParameters p = table1_case("II", Transition::A);
  p.D = 0.1;
  p.k = 30e6;
  const RegimePoint point = judge_regime(p, 400);
  ASSERT_EQ(point.period, 2);
  ExactOptions options;
  options.cycles = 300;
  options.samples_per_cycle = 4000;
  const ChainHistory h = drumlin::test::solve_by_cvode(p, options, 1e-11).history;
  const std::array<double, 3> multiple = {0.5, 1.0, 2.0};
  std::array<std::complex<double>, 3> sum{};
  for (std::size_t i = h.size() - 1 - 8000; i < h.size() - 1; ++i)
    for (std::size_t n = 0; n < 3; ++n)
      sum[n] += h.a_drum[i] * std::exp(std::complex<double>(0.0, multiple[n] * p.omega * h.time[i]));
  // A jump of the force lies between two samples: its time is known to half of their distance only.
  EXPECT_NEAR(point.meter.cmv, 300.0 * std::abs(sum[2] / sum[1]), 0.5);
  EXPECT_NEAR(point.meter.rmv, 100.0 * std::abs(sum[0] / sum[1]), 0.2);
  EXPECT_GT(point.meter.rmv, 5.0);
}

// Near a period doubling the motion leaves the unstable orbit of period 1 so slowly that 300 cycles do not
// show its period.
TEST(Regime, ASlowDepartureFromAnUnstableOrbitIsNotAperiodic) {
  ChainParameters p = table1_case("II", Transition::B);
  p.k = 48e6;
  p.D = 0.02 + 0.58 * 19 / 49;
  const RegimePoint point = judge_regime(p, 300);
  EXPECT_EQ(point.regime, Regime::period_2);
  EXPECT_LT(point.multiplier, 1.0);
}

// Each cycle a small difference from the periodic motion changes its sign and shrinks by 0.3 % (multiplier
// -0.997). States two cycles apart are then nearly equal, which looks like period 2; CVODE finds period 1
// after 5000 cycles.
TEST(Regime, ASlowlyShrinkingAlternationHasPeriodOne) {
  ChainParameters p = table1_case("II", Transition::B);
  p.k = 166221021.0;
  p.D = 0.383008;
  p.omega = 170.7256;
  const RegimePoint point = judge_regime(p, 300);
  EXPECT_EQ(point.regime, Regime::partial_uplift);
  EXPECT_EQ(point.period, 1);
  EXPECT_NEAR(point.multiplier, 0.99703, 1e-4);
}

TEST(RegimeMap, BoundariesLieWhereTheEventsOfTheMotionSay) {
  MapGrid grid;
  grid.chain.base = table1_case("II", Transition::B);
  grid.x = axis_from_text("--x", "k:5e6:40e6:8", 100);
  grid.y = axis_from_text("--y", "D:0.08:0.3:4", 100);
  std::vector<RegimePoint> points;
  std::vector<std::size_t> all(grid.size());
  std::iota(all.begin(), all.end(), 0U);
  judge_points<RegimePoint>(
      all, 2, 5, [&](std::size_t point) { return grid.judged(point); },
      [&](std::size_t, const std::vector<RegimePoint> &more) {
        points.insert(points.end(), more.begin(), more.end());
      });
  ASSERT_EQ(points.size(), grid.size());
  int losses = 0;
  int doublings = 0;
  for (const BoundaryPoint &point : find_boundaries(grid, points, 2)) {
    const auto lasts = [&](double factor) {
      const ChainSolver solver(grid.at(point.x * factor, point.y));
      return pass(solver, steady_contact_state(solver.parameters()), 1).always_contact();
    };
    if (point.kind == "loss of contact") {
      ++losses;
      EXPECT_TRUE(lasts(1.0 - 1e-8)) << point.x;
      EXPECT_FALSE(lasts(1.0 + 1e-8)) << point.x;
    } else if (point.kind == "period doubling") {
      ++doublings;
    }
  }
  EXPECT_GE(losses, 4);
  EXPECT_GE(doublings, 2);
}

TEST(RegimeMap, AnEccentricMomentMakesTheForceGrowWithTheFrequency) {
  MapChain chain;
  chain.me_re = 3.0;
  EXPECT_DOUBLE_EQ(chain.with({{"omega", 200.0}}).Fw, 3.0 * 200.0 * 200.0);
  EXPECT_DOUBLE_EQ(chain.with({{"me_re", 2.0}, {"omega", 100.0}}).Fw, 2.0 * 100.0 * 100.0);
}

TEST(RegimeMap, ASweepUpAndDownSeesCoexistingMotions) {
  MapChain chain;
  chain.base = table1_case("II", Transition::B);
  chain.base.D = 0.1;
  const Sweep found = sweep(chain, axis_from_text("--sweep", "k:8e6:30e6:23", 100), 200, 4);
  EXPECT_EQ(found.samples.size(), 2U * 23U * 4U);
  ASSERT_EQ(found.boundaries.size(), 2U);
  EXPECT_EQ(found.boundaries[0].kind, "loss of contact");
  EXPECT_NEAR(contact_margin(chain.with({{"k", found.boundaries[0].x}})), 0.0, 1e-3);
  EXPECT_EQ(found.boundaries[1].kind, "period doubling");
}

// ---- the command ----

class MapCommand : public drumlin::test::Tool {
protected:
  Outcome map(const std::vector<std::string> &words) const { return drumlin("map", words); }
  static const std::vector<std::string> &few() {
    static const std::vector<std::string> words = words_of("--x k:5e6:40e6:7 --y D:0.1:0.5:5 --out m");
    return words;
  }
};

TEST_F(MapCommand, WritesPointsBoundariesAndPictures) {
  draw();
  well(map(few()));
  const Table table = read_table(folder_ / "m/regimes.csv");
  EXPECT_EQ(table.rows(), 35U);
  EXPECT_TRUE(table.has("k [N/m]"));
  EXPECT_TRUE(table.has("peak_force [N]"));
  EXPECT_GT(read_table(folder_ / "m/boundaries.csv").rows(), 3U);
  for (const char *name : {"regimes", "cmv", "rmv", "peak_force", "contact_share"})
    EXPECT_TRUE(fs::is_regular_file(folder_ / "m" / (std::string(name) + ".png"))) << name;
}

TEST_F(MapCommand, ContinuesWhereItWasInterrupted) {
  well(map(few()));
  const fs::path file = folder_ / "m/regimes.csv";
  const std::string whole = read_text(file);
  std::size_t end = 0;
  for (int line = 0; line < 11; ++line)
    end = whole.find('\n', end) + 1;
  write_files({{file, whole.substr(0, end + 17)}}); // ten points and a part of the next
  EXPECT_TRUE(printed(well(map(few())), "10 of 35 points are there already"));
  EXPECT_EQ(read_text(file), whole);
}

TEST_F(MapCommand, FillsGapsAndRefusesRowsOfNoMap) {
  well(map(few()));
  const fs::path file = folder_ / "m/regimes.csv";
  const std::string whole = read_text(file);
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < whole.size(); begin = whole.find('\n', begin) + 1)
    lines.push_back(whole.substr(begin, whole.find('\n', begin) + 1 - begin));
  const auto text = [](const std::vector<std::string> &rows) {
    std::string all;
    for (const std::string &row : rows)
      all += row;
    return all;
  };
  const auto changed = [&](const std::function<void(std::vector<std::string> &)> &change) {
    std::vector<std::string> rows = lines;
    change(rows);
    write_files({{file, text(rows)}});
    return text(rows);
  };
  using Rows = std::vector<std::string>;
  for (const std::function<void(Rows &)> &change : std::vector<std::function<void(Rows &)>>{
           [](Rows &rows) { rows.erase(rows.begin() + 10, rows.begin() + 20); }, // in the middle
           [](Rows &rows) { std::reverse(rows.begin() + 1, rows.end()); },
           [](Rows &rows) { rows = {rows[0].substr(0, 20)}; }}) {
    changed(change);
    well(map(few()));
    EXPECT_EQ(read_text(file), whole);
  }
  for (const auto &[change, message] : std::vector<std::pair<std::function<void(Rows &)>, std::string>>{
           {[](Rows &rows) { rows.insert(rows.begin() + 3, rows[7]); }, "allowed: each once, or --fresh"},
           {[](Rows &rows) { rows[5] = "1" + rows[5]; }, "allowed: a row of this call, or --fresh"},
           {[](Rows &rows) { rows[5] = "1,2\n"; }, "the number of cells is '2'; allowed: 12"},
           {[](Rows &rows) { rows[0].replace(rows[0].find("CMV"), 3, "CMX"); },
            "the header of m/regimes.csv is"}}) {
    const std::string before = changed(change);
    const Outcome refused = map(few());
    EXPECT_NE(refused.status, 0);
    drumlin::test::expect_one_error(refused.output, "drumlin map: ");
    EXPECT_TRUE(printed(refused, message));
    EXPECT_EQ(read_text(file), before);
  }
}

TEST_F(MapCommand, AnotherMapDoesNotReplaceOne) {
  well(map(few()));
  const std::string whole = read_text(folder_ / "m/regimes.csv");
  std::vector<std::string> other = few();
  other.insert(other.end(), {"--cycles", "200"});
  const Outcome refused = map(other);
  EXPECT_EQ(refused.status, 2);
  EXPECT_TRUE(printed(refused, "ERROR: drumlin map: --out is 'm'; allowed: "));
  EXPECT_EQ(read_text(folder_ / "m/regimes.csv"), whole);
  other.emplace_back("--fresh");
  well(map(other));
}

TEST(MapAxis, MayHaveAUnit) {
  const MapAxis plain = axis_from_text("--x", "k:10e6:150e6:40:log", 100),
                mega = axis_from_text("--x", "k:10:150:40:MN/m:log", 100);
  EXPECT_EQ(mega.from, plain.from);
  EXPECT_EQ(mega.to, plain.to);
  EXPECT_TRUE(mega.log);
  EXPECT_EQ(axis_from_text("--x", "m2:2:4:3:t", 100).to, 4000.0);
  EXPECT_EQ(axis_from_text("--x", "Fw:0:256:3:kN", 100).to, 256e3);
}

TEST_F(MapCommand, ASweepIsWritten) {
  draw();
  well(map({"--sweep", "k:8e6:25e6:9", "--D", "0.1", "--out", "s"}));
  EXPECT_EQ(read_table(folder_ / "s/sweep.csv").rows(), 2U * 9U * 32U);
  EXPECT_TRUE(fs::is_regular_file(folder_ / "s/sweep.png"));
}

} // namespace maps

// The boundaries of regimes that are found from orbits, against CVODE: the loss of contact against the direct
// solver, the period doubling against a Poincare map that is integrated here. Both to a relative 1e-6.
namespace boundaries {

using namespace drumlin::post;

// The map from the start of a cycle to that of the next, by CVODE with the equations of motion and the
// transition condition B written down again.
class CvodeMap {
public:
  explicit CvodeMap(const ChainParameters &p) : p_(p), scale_(state_scale(p)) {}

  Eigen::Vector4d operator()(const Eigen::Vector4d &start) const {
    phase_ = start[0] > 0.0                    ? Phase::flight
             : force(start[0], start[1]) > 0.0 ? Phase::contact
                                               : Phase::clamped;
    const auto rates = [this](double t, const oracle::State &y, oracle::State &rate) {
      const double bond = p_.c23 * (y[3] - y[1]) + p_.k23 * (y[2] - y[0]);
      const double contact = phase_ == Phase::contact ? force(y[0], y[1]) : 0.0;
      rate = {y[1], (contact + bond - p_.Fw * std::sin(p_.omega * t)) / p_.m2 - p_.g, y[3],
              -bond / p_.m3 - p_.g};
    };
    oracle::Ode ode(rates, 0.0, {start.data(), start.data() + 4}, {scale_.data(), scale_.data() + 4});
    const oracle::Event gap = [](double, const oracle::State &y) { return y[0]; };
    const oracle::Event load = [this](double, const oracle::State &y) { return force(y[0], y[1]); };
    while (true) {
      const std::vector<oracle::Event> events = phase_ == Phase::contact  ? std::vector{load}
                                                : phase_ == Phase::flight ? std::vector{gap}
                                                                          : std::vector{gap, load};
      const int event = ode.advance(p_.period(), events);
      if (event < 0) break;
      phase_ = phase_ == Phase::contact  ? Phase::clamped
               : phase_ == Phase::flight ? Phase::contact
               : event == 0              ? Phase::flight
                                         : Phase::contact;
      ode.restart(ode.state());
    }
    return Eigen::Map<const Eigen::Vector4d>(ode.state().data());
  }

  Eigen::Matrix4d jacobian(const Eigen::Vector4d &at) const {
    constexpr double share = 1e-4;
    Eigen::Matrix4d result;
    for (Eigen::Index i = 0; i < 4; ++i) {
      Eigen::Vector4d up = at;
      Eigen::Vector4d down = at;
      up[i] += share * scale_[i];
      down[i] -= share * scale_[i];
      result.col(i) = ((*this)(up) - (*this)(down)) / (2.0 * share * scale_[i]);
    }
    return result;
  }

  // The periodic motion next to a guess, by Newton's method.
  Eigen::Vector4d orbit(Eigen::Vector4d state) const {
    for (int i = 0; i < 3; ++i) {
      const Eigen::Matrix4d equation = Eigen::Matrix4d::Identity() - jacobian(state);
      state += equation.fullPivLu().solve((*this)(state)-state);
    }
    EXPECT_LT(((*this)(state)-state).cwiseQuotient(scale_).norm(), 1e-8);
    return state;
  }

private:
  enum class Phase { contact, flight, clamped };
  double force(double x, double v) const { return -(p_.k * x + p_.damping() * v); }

  ChainParameters p_;
  Eigen::Vector4d scale_;
  mutable Phase phase_ = Phase::contact;
};

TEST(Boundaries, ContactIsLostWhereTheDirectSolverLosesIt) {
  for (const Transition transition : {Transition::A, Transition::B}) {
    SCOPED_TRACE(transition_name(transition));
    const ChainFamily family = [&](double k) {
      ChainParameters p = table1_case("I", transition);
      p.k = k;
      return p;
    };
    const auto onset = locate_contact_loss(family, 5e6, 20e6);
    ASSERT_TRUE(onset);
    for (const double side : {-1e-6, 1e-6}) {
      ExactOptions options;
      options.cycles = 200;
      options.samples_per_cycle = 1;
      const CycleSummary last =
          drumlin::test::solve_by_cvode(family(onset->value * (1.0 + side)), options).cycles.back();
      EXPECT_EQ(last.breaks > 0, side > 0.0) << side;
    }
  }
}

TEST(Boundaries, AMultiplierPassesMinusOneWhereThatOfCvodesMapDoes) {
  const ChainFamily family = [](double k) {
    ChainParameters p = table1_case("II", Transition::B);
    p.D = 0.1;
    p.k = k;
    return p;
  };
  const ChainSolver before(family(15e6));
  ChainMotion motion = before.start();
  for (int cycle = 0; cycle < 400; ++cycle)
    before.finish_cycle(motion);
  const auto start = find_orbit(before, motion.state, 1);
  ASSERT_TRUE(start);
  const auto doubling = locate_doubling(family, 15e6, 25e6, *start);
  ASSERT_TRUE(doubling);
  const std::vector<BranchPoint> branch = continue_orbit(family, 15e6, doubling->value, 8, *start);
  for (const double side : {-1e-6, 1e-6}) {
    const CvodeMap map(family(doubling->value * (1.0 + side)));
    const Eigen::Vector4d orbit = map.orbit(branch.back().orbit.state);
    const double determinant = (map.jacobian(orbit) + Eigen::Matrix4d::Identity()).determinant();
    EXPECT_EQ(determinant > 0.0, side < 0.0) << side << " " << determinant;
  }
}

} // namespace boundaries

} // namespace regime_map

// Motions of a drum with two ends: their orbits against those of the chain and CVODE, their modes, and the
// map of the command.
namespace ends {

using namespace post;

TwoEnds equal_halves(double k, double D, int contacts, double hertz = 29.0) {
  const Roller roller = read_roller(DRUMLIN_SOURCE_DIR "/inputs/rollers/Axas2020");
  ChainParameters chain;
  set_machine(chain, roller, roller.settings.front());
  chain.transition = Transition::B;
  chain.Fw *= std::pow(hertz / 29.0, 2);
  chain.omega *= hertz / 29.0;
  chain.k = k;
  chain.D = D;
  TwoEnds machine = two_ends(chain, Roller()); // equal bonds
  machine.contacts = equal_contacts(contacts, 2.13, chain.k, chain.damping());
  return machine;
}

std::optional<OrbitOf<EndsCycles>> orbit_of(const TwoEndsSolver &solver) {
  TwoEndsMotion motion = solver.start();
  for (int cycle = 0; cycle < 300; ++cycle)
    solver.finish_cycle(motion);
  return newton_orbit(EndsCycles{solver}, motion.state, 1);
}

// Four of the eight multipliers are those of bouncing, which the chain has.
TEST(EndsOrbit, EqualHalvesHaveTheMultipliersOfTheChain) {
  for (const double k : {15e6, 40e6}) {
    const TwoEnds machine = equal_halves(k, 0.2, 2);
    const TwoEndsSolver solver(machine);
    const auto orbit = orbit_of(solver);
    ASSERT_TRUE(orbit);
    const ChainSolver chain(machine.chain);
    ChainMotion motion = chain.start();
    for (int cycle = 0; cycle < 300; ++cycle)
      chain.finish_cycle(motion);
    const auto single = find_orbit(chain, motion.state, 1);
    ASSERT_TRUE(single);
    for (const std::complex<double> &of_chain : single->multipliers) {
      double nearest = 1.0;
      for (const std::complex<double> &one : orbit->multipliers)
        nearest = std::min(nearest, std::abs(one - of_chain));
      EXPECT_LT(nearest, 1e-8);
    }
  }
}

// Two contacts at L/sqrt(12) and any number of equal ones along the width are the same in unbroken contact.
TEST(EndsOrbit, TwoContactsAreALineOfSpringsInUnbrokenContactOnly) {
  const auto multipliers = [](double k, int contacts, double ratio) {
    TwoEnds machine = equal_halves(k, 0.2, contacts);
    for (AxleLink &contact : machine.contacts) {
      const double share = 1.0 + ratio * contact.y; // a linear slope of the stiffness
      contact.k *= share;
      contact.c *= share;
    }
    const auto orbit = orbit_of(TwoEndsSolver(machine));
    EXPECT_TRUE(orbit);
    return orbit ? std::abs(orbit->multipliers[0]) : 0.0;
  };
  for (const int contacts : {4, 8, 16})
    EXPECT_NEAR(multipliers(12e6, contacts, 0.0), multipliers(12e6, 2, 0.0), 1e-9) << contacts;
  EXPECT_GT(std::fabs(multipliers(35e6, 16, 0.6) - multipliers(35e6, 2, 0.6)), 1e-4);
}

TEST(EndsOrbit, EqualHalvesLoseContactWhereTheChainDoes) {
  for (const Transition transition : {Transition::A, Transition::B})
    for (const double k : {10e6, 25e6, 60e6}) {
      TwoEnds machine = equal_halves(k, 0.25, 2);
      machine.chain.transition = transition;
      const double weight = (machine.chain.m2 + machine.chain.m3) * machine.chain.g;
      EXPECT_NEAR(2.0 * ends_margin(machine), contact_margin(machine.chain), 1e-9 * weight);
    }
}

// Partial uplift that is not stable against tilting ends in rocking: the drum is low on one side in one cycle
// and on the other side in the next. CVODE returns to the same state after two cycles, and to its mirror
// image after one.
TEST(EndsModes, ADrumRocks) {
  TwoEnds machine = equal_halves(74e6, 0.23, 2, 22.0);
  machine.drum_inertia = 2900.0;
  machine.tilt = 1e-5;
  const TwoEndsSolver solver(machine);
  TwoEndsMotion motion = solver.start();
  const EndsPoint point = judge_ends_from(solver, motion, 300);
  EXPECT_EQ(point.mode, EndsMode::rocking) << ends_mode_names[static_cast<std::size_t>(point.mode)];
  EXPECT_EQ(point.period, 2);
  EXPECT_LT(point.multiplier, 1.0);
  EXPECT_GT(point.tilt, 1e-4);
  EXPECT_NEAR(point.contact_share[0], point.contact_share[1], 1e-6);
  const TwoEndsState scale = EndsCycles{solver}.scale();
  const TwoEndsState start = motion.state;
  TwoEndsOracle oracle(machine, start);
  const auto apart = [&](int cycles, bool mirrored) {
    const oracle::State &y = oracle.at(cycles * machine.chain.period());
    double most = 0.0;
    for (int i = 0; i < 8; ++i) {
      const bool tilt = i % 4 >= 2;
      const double expected = tilt && mirrored ? -start[i] : start[i];
      most = std::max(most, std::fabs(y[static_cast<std::size_t>(i)] - expected) / scale[i]);
    }
    return most;
  };
  EXPECT_LT(apart(1, true), 1e-6);
  EXPECT_LT(apart(2, false), 1e-6);
}

// CVODE goes on from the state that the machine settles to, and tells which ends leave the soil within two
// cycles and whether the state is the same after one. The halves are never quite equal, since CVODE would
// find one of two contacts that break at the same time.
TEST(EndsModes, AreTold) {
  struct Scene {
    TwoEnds machine;
    double ratio;
    EndsMode mode;
    int ends_lost, period;
  };
  for (Scene scene : {Scene{equal_halves(12e6, 0.2, 2), 1.5, EndsMode::continuous_contact, 0, 1},
                      Scene{equal_halves(25e6, 0.2, 2), 2.5, EndsMode::uplift_of_one_end, 1, 1},
                      Scene{equal_halves(38e6, 0.2, 4), 1.02, EndsMode::uplift_of_both_ends, 2, 1},
                      Scene{equal_halves(55e6, 0.2, 2), 1.02, EndsMode::double_jump, 2, 2},
                      Scene{equal_halves(50e6, 0.2, 2), 3.0, EndsMode::combined, 2, 2}}) {
    SCOPED_TRACE(ends_mode_names[static_cast<std::size_t>(scene.mode)]);
    for (AxleLink &contact : scene.machine.contacts) {
      const double share = 2.0 / (1.0 + scene.ratio) * (contact.y < 0.0 ? scene.ratio : 1.0);
      contact.k *= share;
      contact.c *= share;
    }
    scene.machine.tilt = 1e-5;
    const TwoEndsSolver solver(scene.machine);
    TwoEndsMotion motion = solver.start();
    EXPECT_EQ(judge_ends_from(solver, motion, 300).mode, scene.mode);
    const TwoEndsState scale = EndsCycles{solver}.scale();
    TwoEndsOracle oracle(scene.machine, motion.state);
    const auto apart = [&](int cycles) {
      const oracle::State &y = oracle.at(cycles * scene.machine.chain.period());
      double most = 0.0;
      for (int i = 0; i < 8; ++i)
        most = std::max(most, std::fabs(y[static_cast<std::size_t>(i)] - motion.state[i]) / scale[i]);
      return most;
    };
    const double after_one = apart(1), after_two = apart(2);
    EXPECT_LT(after_two, 1e-5);
    EXPECT_EQ(after_one < 1e-5 ? 1 : 2, scene.period) << after_one;
    EXPECT_EQ(int(oracle.left_lost()) + int(oracle.right_lost()), scene.ends_lost);
  }
}

/// What a cycle makes of small differences of the state, by CVODE.
TwoEndsMatrix growth_in_a_cycle(const TwoEnds &machine, const TwoEndsState &state) {
  TwoEndsMatrix growth;
  const TwoEndsState scale = EndsCycles{TwoEndsSolver(machine)}.scale();
  for (int i = 0; i < 8; ++i) {
    TwoEndsState ends[2];
    constexpr double small = 1e-5;
    for (int side = 0; side < 2; ++side) {
      TwoEndsState start = state;
      start[i] += (side == 0 ? -small : small) * scale[i];
      TwoEndsOracle oracle(machine, start);
      const oracle::State &end = oracle.at(machine.chain.period());
      ends[side] = Eigen::Map<const TwoEndsState>(end.data());
    }
    growth.col(i) = (ends[1] - ends[0]) / (2.0 * small * scale[i]);
  }
  return growth;
}

// Where the map has a boundary to motions of two cycles, a difference turns its sign in a cycle and keeps its
// size: the multiplier is -1, here by CVODE. Between the points of these rows rocking begins, or double jump.
TEST(EndsBoundaries, HaveAMultiplierOfMinusOne) {
  EndsFamily family;
  const Roller roller = read_roller(DRUMLIN_SOURCE_DIR "/inputs/rollers/Axas2020");
  set_machine(family.chain.base, roller, roller.settings.front());
  family.chain.base.transition = Transition::B;
  family.chain.base.D = 0.2;
  family.roller = roller;
  MapGrid grid;
  grid.chain = family.chain;
  grid.x = {"k", 35e6, 55e6, 5, false};
  grid.y = {"ratio", 1.02, 2.0, 2, false};
  std::vector<EndsPoint> points;
  for (std::size_t i = 0; i < grid.size(); ++i)
    points.push_back(judged(family, grid, i));
  const std::vector<BoundaryPoint> found = ends_boundaries(family, grid, points, 2);
  int doublings = 0;
  for (const BoundaryPoint &point : found) {
    if (point.kind != "period doubling") continue;
    SCOPED_TRACE(std::to_string(point.x) + " N/m, ratio " + std::to_string(point.y));
    ++doublings;
    const TwoEnds machine = family.at({{"k", point.x}, {"ratio", point.y}});
    // The orbit is followed from soil on which it is stable.
    const TwoEndsSolver below(family.at({{"k", 0.98 * point.x}, {"ratio", point.y}}));
    TwoEndsMotion motion = below.start();
    for (int cycle = 0; cycle < 600; ++cycle)
      below.finish_cycle(motion);
    const TwoEndsSolver solver(machine);
    const auto orbit = newton_orbit(EndsCycles{solver}, motion.state, 1);
    ASSERT_TRUE(orbit);
    const auto multipliers = floquet_multipliers<8>(growth_in_a_cycle(machine, orbit->state));
    double nearest = 1.0;
    for (const std::complex<double> &one : multipliers)
      nearest = std::min(nearest, std::abs(one + 1.0));
    EXPECT_LT(nearest, 1e-3);
  }
  EXPECT_EQ(doublings, 3);
}

class EndsMapCommand : public Tool {
protected:
  Outcome map(const std::vector<std::string> &words) const { return drumlin("map", words); }
  const std::string axas_ = DRUMLIN_SOURCE_DIR "/inputs/rollers/Axas2020";
};

TEST_F(EndsMapCommand, WritesModesOverStiffnessAndRatio) {
  draw();
  const Outcome outcome = well(map({"--contacts", "2", "--roller", axas_, "--D", "0.2", "--x",
                                    "k:10e6:60e6:4", "--y", "ratio:1:3:3:log", "--out", "m"}));
  EXPECT_TRUE(printed(outcome, "m: 12 points on 2 contacts: continuous contact at "));
  const Table table = read_table(scratch_ / "m/regimes.csv");
  EXPECT_EQ(table.rows(), 12U);
  for (const char *column : {"k [N/m]", "ratio [-]", "regime", "period [cycles]", "multiplier [-]",
                             "exponent [1/cycle]", "tilt [rad]", "contact_left [-]", "contact_right [-]"})
    EXPECT_TRUE(table.has(column)) << column;
  EXPECT_EQ(table.text("regime").front(), "continuous contact");
  // The side of the stiffer soil is the one that lifts off.
  EXPECT_LT(table.numbers("contact_left [-]").back(), table.numbers("contact_right [-]").back());
  for (const char *name :
       {"modes.png", "tilt.png", "contact_left.png", "contact_right.png", "index.html", "parameters.csv"})
    EXPECT_TRUE(fs::is_regular_file(scratch_ / "m" / name)) << name;
  EXPECT_GT(read_table(scratch_ / "m/boundaries.csv").rows(), 1U);

  // A map that was interrupted and continued equals one that was made in a single call.
  const std::string whole = read_text(scratch_ / "m/regimes.csv");
  const std::vector<std::string> lines = lines_of(whole);
  std::string part;
  for (std::size_t i = 0; i < 6; ++i)
    part += lines[i] + "\n";
  write_files({{scratch_ / "m/regimes.csv", part}});
  const Outcome more = well(map({"--contacts", "2", "--roller", axas_, "--D", "0.2", "--x", "k:10e6:60e6:4",
                                 "--y", "ratio:1:3:3:log", "--out", "m"}));
  EXPECT_TRUE(printed(more, "5 of 12 points are there already"));
  EXPECT_EQ(read_text(scratch_ / "m/regimes.csv"), whole);

  well(map({"--contacts", "3", "--roller", axas_, "--D", "0.2", "--sweep", "k:20e6:60e6:5", "--out", "s"}));
  const Table sweep = read_table(scratch_ / "s/sweep.csv");
  EXPECT_EQ(sweep.rows(), 10U);
  EXPECT_EQ(sweep.text("direction").back(), "down");
  EXPECT_TRUE(fs::is_regular_file(scratch_ / "s/sweep.png"));
}

} // namespace ends

} // namespace
} // namespace drumlin::test
