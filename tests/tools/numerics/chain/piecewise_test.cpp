// The exact solution of the chain against piecewise solutions (piecewise_oracle.h) and the closed forms of an
// impact.
#include "tests/support/piecewise_oracle.h"
#include "tests/support/checks.h"
#include "chain/exact_solution.h"

namespace drumlin::test {

namespace {

using post::ChainParameters;
using post::ExactOptions;
using post::ExactSolution;
using post::Transition;

// Relative RMS difference of two series.
double difference(const std::vector<double> &found, const std::vector<double> &expected) {
  EXPECT_EQ(found.size(), expected.size());
  double square = 0.0;
  double norm = 0.0;
  for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i) {
    square += (found[i] - expected[i]) * (found[i] - expected[i]);
    norm += expected[i] * expected[i];
  }
  return std::sqrt(square / std::max(norm, 1e-12)); // where nothing moves, both leave rounding
}

void expect_finite(const ExactSolution &result) {
  const post::ChainHistory &h = result.history;
  for (const auto *column : {&h.time, &h.x_drum, &h.v_drum, &h.a_drum, &h.x_frame, &h.v_frame, &h.a_frame,
                             &h.F_contact, &h.F_excitation, &h.F_bond}) {
    ASSERT_EQ(column->size(), h.size());
    ASSERT_TRUE(
        std::all_of(column->begin(), column->end(), [](double value) { return std::isfinite(value); }));
  }
  for (const post::CycleSummary &cycle : result.cycles) {
    ASSERT_TRUE(std::isfinite(cycle.a_drum_min) && std::isfinite(cycle.a_drum_max));
    ASSERT_TRUE(std::isfinite(cycle.F_contact_min) && std::isfinite(cycle.F_contact_max));
    ASSERT_GE(cycle.contact_share, 0.0);
    ASSERT_LE(cycle.contact_share, 1.0);
  }
}

// How closely solver and oracle agree.
struct Agreement {
  double velocity = 0.0;   // relative RMS of the drum's velocity
  double event_time = 0.0; // largest difference, in periods
};

Agreement compare(const ChainParameters &parameters, int cycles, double impact_speed = 0.0) {
  ExactOptions options;
  options.cycles = cycles;
  options.impact_speed = impact_speed;
  const ExactSolution solved = post::solve_chain(parameters, options);
  const OracleResult exact = exact_pieces(parameters, cycles, options.samples_per_cycle, impact_speed);
  expect_finite(solved);
  Agreement agreement;
  agreement.velocity = difference(solved.history.v_drum, exact.v_drum);
  EXPECT_EQ(solved.events.size(), exact.events.size());
  for (std::size_t i = 0; i < std::min(solved.events.size(), exact.events.size()); ++i) {
    EXPECT_EQ(solved.events[i].make, exact.events[i].make) << "event " << i;
    agreement.event_time = std::max(
        agreement.event_time, std::fabs(solved.events[i].time - exact.events[i].time) / parameters.period());
  }
  ::testing::Test::RecordProperty("velocity", std::to_string(agreement.velocity * 1e12) + "e-12");
  std::printf("    velocity %.2e, event times %.2e periods, %zu events, %ld pieces\n", agreement.velocity,
              agreement.event_time, solved.events.size(), solved.pieces);
  return agreement;
}

// ---- the paper's cases
// ---------------------------------------------------------------------------------------

struct CaseName {
  const char *name;
  Transition transition;
};

void PrintTo(const CaseName &value, std::ostream *out) {
  *out << value.name << post::transition_name(value.transition);
}

class PaperCase : public ::testing::TestWithParam<CaseName> {};

TEST_P(PaperCase, ThirtyCyclesEqualTheExactPieces) {
  const ChainParameters parameters = post::table1_case(GetParam().name, GetParam().transition);
  const Agreement agreement = compare(parameters, 30);
  EXPECT_LT(agreement.velocity, 1e-9);
  EXPECT_LT(agreement.event_time, 1e-9);
}

TEST_P(PaperCase, EveryColumnObeysTheEquationsOfMotion) {
  const ChainParameters p = post::table1_case(GetParam().name, GetParam().transition);
  ExactOptions options;
  options.cycles = 5;
  const post::ChainHistory h = post::solve_chain(p, options).history;
  ASSERT_EQ(h.size(), 1001U);
  EXPECT_EQ(h.time.front(), 0.0);
  EXPECT_NEAR(h.time.back(), 5 * p.period(), 1e-15);
  const double weight = (p.m2 + p.m3) * p.g;
  for (std::size_t i = 0; i < h.size(); ++i) {
    EXPECT_NEAR(p.m2 * h.a_drum[i], -p.m2 * p.g + h.F_contact[i] + h.F_bond[i] - h.F_excitation[i],
                1e-9 * weight);
    EXPECT_NEAR(p.m3 * h.a_frame[i], -p.m3 * p.g - h.F_bond[i], 1e-9 * weight);
    EXPECT_NEAR(h.F_bond[i], p.c23 * (h.v_frame[i] - h.v_drum[i]) + p.k23 * (h.x_frame[i] - h.x_drum[i]),
                1e-9 * weight);
    EXPECT_NEAR(h.F_excitation[i], p.Fw * std::sin(p.omega * h.time[i]), 1e-9 * p.Fw);
    const double law = -p.k * h.x_drum[i] - p.damping() * h.v_drum[i];
    const double overlapping = h.x_drum[i] < 0.0 ? law : 0.0;
    EXPECT_NEAR(h.F_contact[i], p.transition == Transition::A ? overlapping : std::max(0.0, overlapping),
                1e-6 * weight);
  }
}

std::string case_name(const ::testing::TestParamInfo<CaseName> &info) {
  return info.param.name + post::transition_name(info.param.transition);
}

INSTANTIATE_TEST_SUITE_P(Table1, PaperCase,
                         ::testing::Values(CaseName{"I", Transition::A}, CaseName{"I", Transition::B},
                                           CaseName{"II", Transition::A}, CaseName{"II", Transition::B},
                                           CaseName{"III", Transition::A}, CaseName{"III", Transition::B},
                                           CaseName{"IV", Transition::A}, CaseName{"IV", Transition::B}),
                         case_name);

// ---- parameters at the ends of what is allowed
// ---------------------------------------------------------------

struct Extreme {
  const char *name;
  std::function<void(ChainParameters &)> change;
  int cycles;
  double tolerance; // relative RMS of the drum's velocity; 0 where disturbances decay too slowly to
                    // compare
  double impact_speed = 0.0;
};

void PrintTo(const Extreme &value, std::ostream *out) { *out << value.name; }

class ExtremeChain : public ::testing::TestWithParam<std::tuple<Extreme, Transition>> {};

TEST_P(ExtremeChain, EqualsTheExactPieces) {
  const auto &[extreme, transition] = GetParam();
  ChainParameters parameters;
  parameters.transition = transition;
  extreme.change(parameters);
  const Agreement agreement = compare(parameters, extreme.cycles, extreme.impact_speed);
  EXPECT_LT(agreement.velocity, extreme.tolerance);
  EXPECT_LT(agreement.event_time, extreme.tolerance);
}

const Extreme extremes[] = {
    {"NoDamping", [](ChainParameters &p) { p.D = 0; }, 10, 1e-7},
    {"NoDampingAtAll", [](ChainParameters &p) { p.D = p.c23 = 0; }, 10, 1e-7},
    {"FaintDamping", [](ChainParameters &p) { p.D = 1e-9; }, 10, 1e-7},
    {"CriticalDamping", [](ChainParameters &p) { p.D = 1; }, 30, 1e-9},
    {"HugeDamping", [](ChainParameters &p) { p.D = 1e4; }, 10, 1e-7},
    {"SoftSoil", [](ChainParameters &p) { p.k = 1e5; }, 30, 1e-9},
    {"HardSoil", [](ChainParameters &p) { p.k = 1e12; }, 10, 1e-7},
    {"HardDampedSoil", [](ChainParameters &p) { p.k = 1e12, p.D = 10; }, 3, 1e-7},
    {"SlowExcitation", [](ChainParameters &p) { p.omega = 0.1; }, 2, 1e-7},
    {"FastExcitation", [](ChainParameters &p) { p.omega = 1e4; }, 200, 1e-7},
    {"LightFrame", [](ChainParameters &p) { p.m3 = 2e-3; }, 3, 1e-7},
    {"HeavyFrame", [](ChainParameters &p) { p.m3 = 2e9; }, 10, 1e-7},
    {"LightDrum", [](ChainParameters &p) { p.m2 = 1e-3; }, 2, 1e-6},
    {"NoGravity", [](ChainParameters &p) { p.g = 0; }, 10, 1e-7},
    {"NoGravitySlow", [](ChainParameters &p) { p.g = 0, p.omega = 1; }, 2, 1e-7},
    {"NoBondNoGravity", [](ChainParameters &p) { p.g = p.k23 = p.c23 = 0; }, 10, 1e-7},
    {"NoForce", [](ChainParameters &p) { p.Fw = 0; }, 5, 1e-7},
    {"NothingMoves", [](ChainParameters &p) { p.Fw = p.g = 0; }, 5, 1e-7},
    {"HugeForce", [](ChainParameters &p) { p.Fw = 1e9; }, 10, 1e-7},
    {"JustLifting", [](ChainParameters &p) { p.k = 6.3e6; }, 60, 1e-8},
    {"ReMade", [](ChainParameters &p) { p.k = 1e7; }, 30, 1e-9},
    {"ReMadeStrongly", [](ChainParameters &p) { p.k = 1e7, p.D = 3; }, 30, 1e-9},
    {"Impact", [](ChainParameters &) {}, 10, 1e-8, 1.0},
    {"ImpactOfAFreeDrum", [](ChainParameters &p) { p.g = p.k23 = p.c23 = p.Fw = 0; }, 2, 1e-9, 0.5},
};

std::string extreme_name(const ::testing::TestParamInfo<std::tuple<Extreme, Transition>> &info) {
  return std::get<0>(info.param).name + post::transition_name(std::get<1>(info.param));
}

INSTANTIATE_TEST_SUITE_P(Ends, ExtremeChain,
                         ::testing::Combine(::testing::ValuesIn(extremes),
                                            ::testing::Values(Transition::A, Transition::B)),
                         extreme_name);

// Parameters drawn between the ends, spread evenly over the decades; the draw is the same in every run.
TEST(ExactSolution, DrawnChainsEqualTheExactPieces) {
  std::mt19937_64 generator(20);
  const auto between = [&generator](double low, double high) {
    const double share = static_cast<double>(generator() >> 11) * 0x1p-53;
    return low * std::pow(high / low, share);
  };
  for (int i = 0; i < 60; ++i) {
    ChainParameters p;
    p.transition = i % 2 == 0 ? Transition::A : Transition::B;
    p.D = between(0.02, 20);
    p.k = between(1e6, 1e9);
    p.omega = between(10, 1000);
    p.Fw = between(1e4, 3e5);
    p.m3 = between(100, 1e4);
    p.k23 = between(1e5, 1e7);
    p.c23 = between(1e3, 1e5);
    SCOPED_TRACE(::testing::Message()
                 << "chain " << i << " D " << p.D << " k " << p.k << " omega " << p.omega << " Fw " << p.Fw
                 << " m3 " << p.m3 << " k23 " << p.k23 << " c23 " << p.c23);
    const Agreement agreement = compare(p, 6);
    EXPECT_LT(agreement.velocity, 1e-7);
    EXPECT_LT(agreement.event_time, 1e-7);
  }
}

TEST(ExactSolution, ContactOfBIsReMadeWithoutForceWhileOverlapping) {
  ChainParameters p;
  p.k = 1e7; // D = 0.5, 20 Hz: the drum turns round before the gap opens
  const ExactSolution solved = post::solve_chain(p, ExactOptions{});
  const OracleResult exact = exact_pieces(p, 30, 200);
  const auto re_made = [](const std::vector<post::ContactEvent> &events) {
    return std::count_if(events.begin(), events.end(), [](const post::ContactEvent &event) {
      return event.make && event.overlap > 1e-9 && event.force == 0.0;
    });
  };
  EXPECT_GT(re_made(solved.events), 0);
  EXPECT_EQ(re_made(solved.events), re_made(exact.events));
  // The contact carries the drum: otherwise its overlap would be metres at this time.
  EXPECT_GT(*std::min_element(solved.history.x_drum.begin(), solved.history.x_drum.end()), -0.1);
}

// ---- single impact
// -------------------------------------------------------------------------------------------

// Restitution -d'/v at the end of the contact: b = D w0, w = sqrt(|w0^2 - b^2|), d = v/w exp(-b t) sin(w t),
// or sinh.
double restitution(Transition transition, double D) {
  const double pi = std::acos(-1.0);
  const double w = std::sqrt(std::fabs(1.0 - D * D)); // w0 = 1
  if (transition == Transition::A) return D < 1.0 ? std::exp(-pi * D / w) : 0.0;
  if (D < 1.0) {
    const double angle = std::atan2(2.0 * D * w, 2.0 * D * D - 1.0); // both branches below w0 in one
    return -std::exp(-D * angle / w) * (std::cos(angle) - D / w * std::sin(angle));
  }
  const double argument = std::atanh(2.0 * D * w / (2.0 * D * D - 1.0));
  return -std::exp(-D * argument / w) * (std::cosh(argument) - D / w * std::sinh(argument));
}

struct ImpactCase {
  Transition transition;
  double D;
  double recorded; // REFERENCE.md, 6 digits
};

void PrintTo(const ImpactCase &value, std::ostream *out) {
  *out << post::transition_name(value.transition) << ", D = " << value.D;
}

class ExactImpact : public ::testing::TestWithParam<ImpactCase> {};

TEST_P(ExactImpact, ReboundsByTheClosedForm) {
  const ImpactCase &impact = GetParam();
  ChainParameters p;
  p.transition = impact.transition;
  p.D = impact.D;
  p.k23 = p.c23 = p.Fw = p.g = 0.0;
  ExactOptions options;
  options.cycles = 2;
  options.impact_speed = 0.7;
  const ExactSolution result = post::solve_chain(p, options);
  const double expected = restitution(impact.transition, impact.D);
  EXPECT_NEAR(expected, impact.recorded, 0.5e-6);

  ASSERT_GE(result.events.size(), 1U);
  EXPECT_TRUE(result.events[0].make);
  EXPECT_EQ(result.events[0].time, 0.0);
  EXPECT_EQ(result.events[0].overlap, 0.0);
  EXPECT_NEAR(result.events[0].force, p.damping() * 0.7, 1e-9 * p.damping());
  if (impact.transition == Transition::A && impact.D >= 1.0) {
    EXPECT_EQ(result.events.size(), 1U);
    EXPECT_NEAR(result.history.v_drum.back(), 0.0, 1e-2);
    return;
  }
  ASSERT_EQ(result.events.size(), 2U);
  EXPECT_FALSE(result.events[1].make);
  EXPECT_NEAR(-result.events[1].overlap_rate / 0.7, expected, 1e-10);
  EXPECT_NEAR(result.history.v_drum.back() / 0.7, expected, 1e-10);
  if (impact.transition == Transition::A) {
    EXPECT_EQ(result.events[1].overlap, 0.0);
    EXPECT_NEAR(result.events[1].force, -p.damping() * 0.7 * expected, 1e-9 * p.damping());
  } else {
    EXPECT_EQ(result.events[1].force, 0.0);
    EXPECT_NEAR(result.events[1].overlap * p.k, p.damping() * 0.7 * expected, 1e-9 * p.damping());
  }
}

INSTANTIATE_TEST_SUITE_P(
    Restitution, ExactImpact,
    ::testing::Values(ImpactCase{Transition::A, 0.2, 0.526621}, ImpactCase{Transition::A, 0.5, 0.163034},
                      ImpactCase{Transition::A, 0.8, 0.015165}, ImpactCase{Transition::A, 2.0, 0.0},
                      ImpactCase{Transition::B, 0.2, 0.571740}, ImpactCase{Transition::B, 0.5, 0.298436},
                      ImpactCase{Transition::B, 0.8, 0.179783}, ImpactCase{Transition::B, 2.0, 0.047769}));

// ---- what is refused
// -----------------------------------------------------------------------------------------

std::string refusal(const std::function<void(ChainParameters &, ExactOptions &)> &change) {
  ChainParameters parameters;
  ExactOptions options;
  change(parameters, options);
  return error_of<std::invalid_argument>([&] { post::solve_chain(parameters, options); });
}

TEST(ExactSolution, RefusesWhatCannotBeComputed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto starts = [](const std::string &text, const std::string &with) {
    return text.rfind(with, 0) == 0;
  };
  EXPECT_PRED2(starts, refusal([](auto &p, auto &) { p.k = 0; }), "k is '0'; allowed: ");
  EXPECT_PRED2(starts, refusal([nan](auto &p, auto &) { p.D = nan; }), "D is 'nan'; allowed: ");
  EXPECT_PRED2(starts, refusal([](auto &p, auto &) { p.m3 = -1; }), "m3 is '-1'; allowed: ");
  EXPECT_PRED2(starts, refusal([](auto &p, auto &) { p.k23 = 0; }),
               "k23 is '0'; allowed: numbers above 0 [N/m], or 0 with g = 0: with g = 9.81");
  EXPECT_PRED2(starts, refusal([](auto &, auto &o) { o.cycles = 0; }), "cycles is '0'; allowed: ");
  EXPECT_PRED2(starts, refusal([](auto &, auto &o) { o.cycles = 1e12; }),
               "cycles is '1000000000000'; allowed: ");
  EXPECT_PRED2(starts, refusal([](auto &, auto &o) { o.samples_per_cycle = 0; }),
               "samples-per-cycle is '0'; allowed: ");
  EXPECT_PRED2(starts, refusal([](auto &, auto &o) { o.samples_per_cycle = 1000000; }),
               "cycles is '30'; allowed: with 1000000 samples per cycle at most 5");
  EXPECT_THROW(post::table1_case("V", Transition::B), std::invalid_argument);
  EXPECT_THROW(post::transition_from_name("C"), std::invalid_argument);
}

} // namespace

} // namespace drumlin::test
