// Analysis, parameters and steady states of the chain.
#include "tests/support/checks.h"
#include "tests/support/piecewise_oracle.h"
#include "chain/analysis.h"
#include "chain/exact_solution.h"
#include "chain/parameters.h"
#include "files/roller.h"
#include "report/chain/measures.h"
#include "support/files.h"

namespace drumlin::test {
namespace {

// The analysis functions against closed forms.
namespace analysis {

using namespace drumlin::post;
using namespace drumlin::test;

const double pi = std::acos(-1.0);

ContactEvent event(double time, bool make, double force = 0.0, double overlap = 0.0, double rate = 0.0) {
  ContactEvent e;
  e.time = time;
  e.make = make;
  e.force = force;
  e.overlap = overlap;
  e.overlap_rate = rate;
  return e;
}

TEST(Cycles, CountsAWholeCycleWhoseEndIsRounded) {
  EXPECT_EQ(complete_cycles(1.0, 0.1), 10);
  EXPECT_EQ(complete_cycles(1.0 - 1e-9, 0.1), 10);
  EXPECT_EQ(complete_cycles(0.99, 0.1), 9);
  EXPECT_EQ(complete_cycles(0.0, 0.1), 0);
}

TEST(Cycles, LastWindowIsCutToWhatThereIs) {
  const TimeWindow window = last_cycles_window(20, 5, 0.5);
  EXPECT_DOUBLE_EQ(window.begin, 7.5);
  EXPECT_DOUBLE_EQ(window.end, 10.0);
  EXPECT_DOUBLE_EQ(last_cycles_window(3, 5, 0.5).begin, 0.0);
}

TEST(RelativeRms, OfAScaledSineIsTheScale) {
  std::vector<double> reference;
  std::vector<double> values;
  for (int i = 0; i < 100; ++i) {
    reference.push_back(std::sin(0.1 * i));
    values.push_back(1.003 * reference.back());
  }
  EXPECT_NEAR(relative_rms(values, reference, 0, 100), 0.003, 1e-12);
  EXPECT_TRUE(std::isnan(relative_rms(values, reference, 5, 5)));
}

TEST(RelativeRms, OfAPhaseShiftIsTwoSinHalf) {
  // sin(x + e) - sin(x) has the RMS 2 sin(e / 2) relative to the sine's, over whole periods.
  std::vector<double> reference;
  std::vector<double> values;
  for (int i = 0; i < 1000; ++i) {
    reference.push_back(std::sin(2 * pi * i / 200.0));
    values.push_back(std::sin(2 * pi * i / 200.0 + 0.01));
  }
  EXPECT_NEAR(relative_rms(values, reference, 0, 1000), 2 * std::sin(0.005), 1e-12);
}

TEST(ContactShare, OfWholeContacts) {
  const std::vector<ContactEvent> events{event(1.1, true), event(1.4, false), event(2.1, true),
                                         event(2.4, false)};
  EXPECT_NEAR(contact_share(events, {1.0, 3.0}, false), 0.3, 1e-14);
}

TEST(ContactShare, OfWindowsThatCutThroughAContact) {
  const std::vector<ContactEvent> events{event(0.5, false), event(0.9, true), event(1.4, false),
                                         event(1.9, true), event(2.4, false)};
  // Both ends cut a contact: [1.0, 1.4] and [1.9, 2.0] of 1.0.
  EXPECT_NEAR(contact_share(events, {1.0, 2.0}, false), 0.5, 1e-14);
  // Inside of a contact throughout, and inside of a flight.
  EXPECT_NEAR(contact_share(events, {1.0, 1.3}, false), 1.0, 1e-14);
  EXPECT_NEAR(contact_share(events, {1.5, 1.8}, true), 0.0, 1e-14);
  // Before the first event: a break says that there was contact, whatever the caller assumes.
  EXPECT_NEAR(contact_share(events, {0.0, 1.0}, false), 0.6, 1e-14);
}

TEST(ContactShare, WithoutEventsIsTheInitialState) {
  EXPECT_EQ(contact_share({}, {0.0, 1.0}, true), 1.0);
  EXPECT_EQ(contact_share({}, {0.0, 1.0}, false), 0.0);
}

/// a(t) = 3 + 10 sin(w t) + 4 cos(2 w t + 0.3) + 0.5 sin(w t / 2 + 1).
double signal(double w, double t) {
  return 3.0 + 10.0 * std::sin(w * t) + 4.0 * std::cos(2 * w * t + 0.3) + 0.5 * std::sin(0.5 * w * t + 1.0);
}

TEST(Harmonics, OfASumOfSinesAreItsAmplitudes) {
  const double w = 40 * pi;
  const double period = 2 * pi / w;
  std::vector<double> time;
  std::vector<double> value;
  for (int i = 0; i <= 4 * 4000; ++i) {
    time.push_back(period * i / 4000.0);
    value.push_back(signal(w, time.back()));
  }
  const HarmonicAmplitudes a = harmonic_amplitudes(time, value, w, {0.0, 4 * period});
  EXPECT_NEAR(a.fundamental, 10.0, 1e-4);
  EXPECT_NEAR(a.second, 4.0, 1e-4);
  EXPECT_NEAR(a.half, 0.5, 1e-4);
  EXPECT_NEAR(compaction_meter_value(a), 120.0, 1e-2);
  EXPECT_NEAR(resonance_meter_value(a), 5.0, 1e-3);
}

TEST(Harmonics, OfASquareWaveWithUprightJumpsAreExact) {
  // One half period +1, the other -1, four rows a period: A1 = 4 / pi, A2 = 0, however coarse the record.
  const double w = 2 * pi;
  std::vector<double> time;
  std::vector<double> value;
  for (int cycle = 0; cycle < 2; ++cycle) {
    for (const auto &[t, v] :
         {std::pair{0.0, 1.0}, std::pair{0.5, 1.0}, std::pair{0.5, -1.0}, std::pair{1.0, -1.0}}) {
      time.push_back(cycle + t);
      value.push_back(v);
    }
  }
  const HarmonicAmplitudes a = harmonic_amplitudes(time, value, w, {0.0, 2.0});
  EXPECT_NEAR(a.fundamental, 4.0 / pi, 1e-12);
  EXPECT_NEAR(a.second, 0.0, 1e-12);
  EXPECT_NEAR(a.half, 0.0, 1e-12);
}

CycleColumns harmonic_cycles(const std::vector<std::array<double, 6>> &rows) {
  CycleColumns cycles;
  cycles.rows = rows.size();
  const char *names[] = {"a1_cos", "a1_sin", "a2_cos", "a2_sin", "ah_cos", "ah_sin"};
  for (const auto &row : rows)
    for (std::size_t i = 0; i < 6; ++i)
      cycles.columns[names[i]].push_back(row[i]);
  return cycles;
}

TEST(Harmonics, OfCyclesAverageTheIntegralsBeforeTheirAmplitude) {
  // Over a single cycle the mean contributes to the integral at half the frequency. This contribution
  // alternates in sign from cycle to cycle and must cancel.
  const CycleColumns cycles = harmonic_cycles({{9, 9, 9, 9, 9, 9}, {3, 4, 0, 2, 7, 1}, {3, 4, 0, 2, -7, 1}});
  const std::optional<HarmonicAmplitudes> a = harmonic_amplitudes(cycles, 3); // reduced to the last two
  ASSERT_TRUE(a);
  EXPECT_DOUBLE_EQ(a->fundamental, 5.0);
  EXPECT_DOUBLE_EQ(a->second, 2.0);
  EXPECT_DOUBLE_EQ(a->half, 1.0);
}

TEST(Harmonics, OfCyclesWithoutColumnsAreNothing) {
  CycleColumns cycles = harmonic_cycles({{1, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1}});
  cycles.columns.erase("ah_sin");
  EXPECT_FALSE(harmonic_amplitudes(cycles, 2));
  EXPECT_FALSE(harmonic_amplitudes(harmonic_cycles({{1, 1, 1, 1, 1, 1}}), 10)); // one row is no even number
}

/// A drum alone whose rest force is a straight line, with a contact force that begins at t = 0.35.
struct JumpingDrum {
  ChainParameters parameters;
  ChainHistory history;
  std::vector<ContactEvent> events;
  JumpingDrum() {
    for (int i = 0; i <= 10; ++i) {
      const double t = 0.1 * i;
      const double force = t > 0.35 ? 8.0e3 - 1.0e4 * (t - 0.35) : 0.0;
      const double rest = -4.0e3 + 2.0e3 * t;
      history.time.push_back(t);
      history.x_drum.push_back(0.35 - t);
      history.v_drum.push_back(-1.0);
      history.F_contact.push_back(force);
      history.a_drum.push_back((rest + force) / parameters.m2);
      history.F_excitation.push_back(0.0);
    }
    events = {event(0.35, true, 8.0e3, 0.0, 1.0)};
  }
};

TEST(Events, JumpOfAccelerationIsTheForceOverTheMass) {
  const JumpingDrum drum;
  const EventAcceleration a = acceleration_at(drum.events[0], drum.history, drum.parameters);
  EXPECT_NEAR(a.before, (-4.0e3 + 700.0) / 2000.0, 1e-12);
  EXPECT_NEAR(a.after, (-4.0e3 + 700.0 + 8.0e3) / 2000.0, 1e-12);
}

TEST(Events, StandInTheSeriesWithBothSides) {
  const JumpingDrum drum;
  const EventSeries series = with_events(drum.history, drum.events, drum.parameters, {0.0, 1.0});
  ASSERT_EQ(series.time.size(), 13u);
  EXPECT_EQ(series.event[4], 1);
  EXPECT_EQ(series.event[5], 1);
  EXPECT_EQ(series.time[4], series.time[5]);
  EXPECT_EQ(series.force[4], 0.0);
  EXPECT_EQ(series.force[5], 8.0e3);
}

TEST(Events, AtTheTimeOfARowStandOnItsRightSide) {
  JumpingDrum drum;
  // A make at the first row, which was written before the force acted; a break at a row written before it.
  drum.history.F_contact = {0, 7, 6, 5, 4, 3, 2, 1, 0, 0, 0};
  drum.events = {event(0.0, true, 8.0, 0.0, 1.0), event(drum.history.time[7], false, 1.0)};
  const EventSeries series = with_events(drum.history, drum.events, drum.parameters, {0.0, 1.0});
  const std::vector<double> expected{0, 0, 8, 7, 6, 5, 4, 3, 2, 1, 1, 0, 0, 0, 0};
  EXPECT_EQ(series.force, expected);
}

TEST(Extremes, AreMergedWithTheLocatedMakes) {
  const JumpingDrum drum;
  CycleColumns cycles;
  cycles.rows = 3;
  cycles.columns = {{"a_drum_min", {-99, -2.0, -2.1}},
                    {"a_drum_max", {99, 1.0, 1.1}},
                    {"F_contact_min", {-99, 0.0, 0.0}},
                    {"F_contact_max", {1e9, 7.0e3, 7.1e3}}};
  // The first row lies before the last two cycles and must not count.
  const SteadyExtremes e = steady_extremes(drum.history, drum.events, cycles, drum.parameters, {0.0, 1.0}, 2);
  EXPECT_TRUE(e.every_step);
  EXPECT_DOUBLE_EQ(e.force.max, 8.0e3); // the make, which no step met
  EXPECT_DOUBLE_EQ(e.force.min, 0.0);
  EXPECT_NEAR(e.acceleration.max, (-4.0e3 + 700.0 + 8.0e3) / 2000.0, 1e-12);
  EXPECT_DOUBLE_EQ(e.acceleration.min, -2.1);
}

TEST(Extremes, WithoutCyclesComeFromSamplesAndEvents) {
  const JumpingDrum drum;
  const SteadyExtremes e =
      steady_extremes(drum.history, drum.events, std::nullopt, drum.parameters, {0.0, 1.0}, 2);
  EXPECT_FALSE(e.every_step);
  EXPECT_DOUBLE_EQ(e.force.max, 8.0e3);
  EXPECT_DOUBLE_EQ(e.acceleration.min, -2.0);
}

TEST(Matching, GivesTheLargestDifferenceAndIgnoresTheSetUp) {
  const std::vector<ContactEvent> reference{event(1.0, false), event(2.0, true), event(3.0, false)};
  const std::vector<ContactEvent> run{event(0.0, true), event(1.1, false), event(1.7, true),
                                      event(3.0, false)};
  const EventMatch match = match_events(run, reference);
  EXPECT_EQ(match.run_count, 3u);
  EXPECT_EQ(match.reference_count, 3u);
  EXPECT_EQ(match.matched, 3u);
  EXPECT_NEAR(match.largest_difference, 0.3, 1e-12);
  EXPECT_DOUBLE_EQ(match.at_time, 2.0);
}

TEST(Matching, StopsWhereTheKindsDiffer) {
  const EventMatch match = match_events({event(1.0, false), event(1.5, false)},
                                        {event(1.0, false), event(2.0, true), event(3.0, false)});
  EXPECT_EQ(match.matched, 1u);
  EXPECT_EQ(match.run_count, 2u);
  EXPECT_EQ(match.reference_count, 3u);
}

TEST(EnergyBalance, HasTheErrorThatTheColumnsHave) {
  CycleColumns cycles;
  cycles.rows = 3;
  cycles.columns = {{"cycle", {1, 2, 3}},
                    {"work_excitation", {100, 200, 300}},
                    {"dissipated_contact", {70, 150, 230}},
                    {"dissipated_bond", {10, 20, 30}},
                    {"kinetic", {5, 5, 9}},
                    {"potential", {-3, -3, -4}},
                    {"stored_contact", {1, 1, 4}},
                    {"stored_bond", {2, 2, 8}}};
  std::string missing;
  std::optional<EnergyBalance> balance = energy_balance(cycles, missing);
  ASSERT_TRUE(balance);
  // 200 = 160 + 20 + 4 - 1 + 3 + 6 + 8
  EXPECT_NEAR(balance->energy_error(), 8.0, 1e-12);
  EXPECT_NEAR(balance->energy_error_percent(), 4.0, 1e-12);
  EXPECT_EQ(balance->first_cycle, 1);
  EXPECT_EQ(balance->last_cycle, 3);
  cycles.columns["dissipated_contact"][2] += 8.0;
  EXPECT_NEAR(energy_balance(cycles, missing)->energy_error(), 0.0, 1e-12);
  cycles.columns.erase("potential");
  EXPECT_FALSE(energy_balance(cycles, missing));
  EXPECT_TRUE(contains(missing, "potential"));
}

/// Drum and frame on known paths, sampled every ms, with the force that follows from the equations of motion;
/// the recorded accelerations are wrong on purpose.
ChainHistory known_motion(const ChainParameters &p) {
  ChainHistory h;
  for (int i = 0; i <= 100; ++i) {
    const double t = 1e-3 * i;
    h.time.push_back(t);
    h.x_drum.push_back(1e-3 * std::sin(100.0 * t));
    h.x_frame.push_back(2e-3 * std::cos(50.0 * t));
    h.F_excitation.push_back(5e4 * std::sin(125.0 * t));
    h.F_contact.push_back(-p.m2 * 10.0 * std::sin(100.0 * t) - p.m3 * 5.0 * std::cos(50.0 * t) +
                          (p.m2 + p.m3) * p.g + h.F_excitation.back());
  }
  h.v_drum = h.v_frame = h.F_bond = std::vector<double>(h.time.size(), 0.0);
  h.a_drum = h.a_frame = std::vector<double>(h.time.size(), 77.0);
  return h;
}

TEST(Roller, MeasuresTheForceFromPositionsAlone) {
  const ChainParameters p;
  ChainHistory h = known_motion(p);
  // The differences leave out a term of fourth order: (w h)^4 / 90 of the acceleration.
  const double bound = 2.0 * std::pow(0.1, 4) / 90.0 * p.m2 * 10.0;
  std::optional<RollerForce> force = roller_force(h, {}, p);
  ASSERT_TRUE(force);
  EXPECT_EQ(force->rows, 97u);
  EXPECT_TRUE(std::isnan(force->force[1]));
  EXPECT_LT(force->largest_difference, bound);
  h.F_contact[40] += 7.0;
  force = roller_force(h, {}, p);
  EXPECT_NEAR(force->largest_difference, 7.0, bound);
  EXPECT_DOUBLE_EQ(force->at_time, h.time[40]);
}

TEST(Roller, LeavesOutRowsNextToAJump) {
  const ChainParameters p;
  ChainHistory h = known_motion(p);
  const std::vector<ContactEvent> events = {{0.0405, false, 0.0, 0.0, 1e3, 1, 2}};
  EXPECT_EQ(roller_force(h, events, p)->rows, 93u); // 39 to 42 have the event among their five
  // Without a record of events a contact loss is found by its force, which is zero in row 60.
  h.F_contact[60] = 0.0;
  EXPECT_EQ(roller_force(h, {}, p)->rows, 92u);
}

TEST(Roller, NeedsAFrameAndRowsEquallyFarApart) {
  const ChainParameters p;
  ChainHistory h = known_motion(p);
  h.time[50] += 1e-4;
  EXPECT_FALSE(roller_force(h, {}, p));
  h = known_motion(p);
  h.x_frame.clear();
  EXPECT_FALSE(roller_force(h, {}, p));
}

class Impact : public ::testing::TestWithParam<double> {};

TEST_P(Impact, StateSolvesTheEquationOfMotion) {
  ImpactParameters p;
  p.damping_ratio = GetParam();
  const double w0 = std::sqrt(p.stiffness / p.mass);
  const double h = 1e-5 / w0;
  for (const double phase : {0.0, 0.3, 1.0, 2.5}) {
    const double t = phase / w0 + h;
    const double acceleration = (impact_state(p, t + h).rate - impact_state(p, t - h).rate) / (2 * h);
    const double slope = (impact_state(p, t + h).overlap - impact_state(p, t - h).overlap) / (2 * h);
    EXPECT_NEAR(slope, impact_state(p, t).rate, 1e-6 * p.speed);
    EXPECT_NEAR(p.mass * acceleration, -impact_state(p, t).force, 1e-5 * p.mass * p.speed * w0);
  }
  EXPECT_DOUBLE_EQ(impact_state(p, 0.0).overlap, 0.0);
  EXPECT_DOUBLE_EQ(impact_state(p, 0.0).rate, p.speed);
}

TEST_P(Impact, EndsWhereItsConditionSays) {
  ImpactParameters p;
  p.damping_ratio = GetParam();
  const double w0 = std::sqrt(p.stiffness / p.mass);
  const double scale = p.speed * std::sqrt(p.mass * p.stiffness) * std::max(1.0, 2 * p.damping_ratio);
  p.transition = Transition::B;
  EXPECT_NEAR(impact_state(p, impact_duration(p)).force, 0.0, 1e-8 * scale);
  EXPECT_GT(impact_state(p, 0.99 * impact_duration(p)).force, 0.0);
  p.transition = Transition::A;
  if (p.damping_ratio < 1.0)
    EXPECT_NEAR(impact_state(p, impact_duration(p)).overlap, 0.0, 1e-12 * p.speed / w0 * 1e3);
  else
    EXPECT_TRUE(std::isinf(impact_duration(p)));
}

INSTANTIATE_TEST_SUITE_P(DampingRatios, Impact,
                         ::testing::Values(0.0, 0.2, 0.5, 0.75, 0.8, 1.0, 1.2, 2.0, 10.0));

TEST(ImpactMeasure, TakesSpeedsBeforeAndAfter) {
  ChainHistory h;
  h.time = {0.0, 1.0, 2.0};
  h.x_drum = {0.5, -0.1, 0.2};
  h.v_drum = {-2.0, 0.1, 0.6};
  h.a_drum = {0.0, 0.0, 0.0};
  h.F_contact = {0.0, 5.0, 0.0};
  h.F_excitation = {0.0, 0.0, 0.0};
  const std::optional<ImpactMeasure> m = measure_impact(h, {});
  ASSERT_TRUE(m);
  EXPECT_DOUBLE_EQ(m->restitution(), 0.3);
  EXPECT_DOUBLE_EQ(m->make_time, 0.25); // flight of 0.5 m at 2 m/s
  EXPECT_TRUE(m->ended);
  h.F_contact.back() = 1.0;
  EXPECT_FALSE(measure_impact(h, {})->ended);
  h.v_drum.front() = 1.0;
  EXPECT_FALSE(measure_impact(h, {}));
}

} // namespace analysis

// Parameters of the chain and the published values of its cases.
namespace of_parameters {

using namespace drumlin::post;

// The cases and the defaults are those of the decks in inputs/chain, whose text is read here; those of
// rollers agree with the data sheets of the machines.
namespace parameters {

/// The value of an index variable of a deck, or the default of a declared one: a number, or the number of
/// $(NUMBER*PI) times pi.
double deck_value(const std::string &deck, const std::string &name) {
  const std::string text = read_text(std::filesystem::path(DRUMLIN_SOURCE_DIR) / "inputs/chain" / deck);
  std::smatch match;
  const std::regex line("(?:^|\n)(?:variable +)?" + name +
                        R"( +(?:index +)?(?:\$\(([0-9.]+)\*PI\)|([0-9.e]+)))");
  if (!std::regex_search(text, match, line)) throw std::runtime_error(deck + " has no variable " + name);
  return match[1].matched ? std::stod(match[1]) * std::acos(-1.0) : std::stod(match[2]);
}

TEST(Table1, IsWhatTheDecksHave) {
  for (const std::string name : table1_cases) {
    const ChainParameters p = table1_case(name, Transition::A);
    EXPECT_EQ(p.k, deck_value("case." + name, "k")) << name;
    EXPECT_EQ(p.D, deck_value("case." + name, "D")) << name;
    EXPECT_DOUBLE_EQ(p.omega, deck_value("case." + name, "omega")) << name;
    EXPECT_EQ(p.transition, Transition::A);
  }
  EXPECT_THROW(table1_case("V", Transition::B), std::invalid_argument);
}

TEST(Table1, DefaultsAreThoseOfTheDeck) {
  const ChainParameters p;
  EXPECT_EQ(p.Fw, deck_value("variables", "Fw"));
  EXPECT_EQ(p.m2, deck_value("variables", "m2"));
  EXPECT_EQ(p.m3, deck_value("variables", "m3"));
  EXPECT_EQ(p.k23, deck_value("variables", "k23"));
  EXPECT_EQ(p.c23, deck_value("variables", "c23"));
  EXPECT_EQ(p.g, deck_value("variables", "g"));
  const ChainParameters second = table1_case("II", Transition::B);
  for (const ChainNumber &number : chain_numbers)
    EXPECT_EQ(p.*number.value, second.*number.value) << number.name;
  EXPECT_EQ(p.transition, second.transition);
}

// What the data sheets of the machines say, besides what is in their files.
struct Sheet {
  const char *machine, *setting;
  double frequency;   // Hz
  double force;       // centrifugal force, kN
  double force_digit; // half a unit of its last digit, kN
  double amplitude;   // nominal, mm
  double amplitude_digit;
  double load; // on the drum: static linear load times width, kg
};
constexpr std::array<Sheet, 7> sheets = {
    {{"BW120", "63Hz", 63.0, 36.0, 0.5, 0.50, 0.005, 11.3 * 120.0},
     {"BW120", "67Hz", 67.0, 41.0, 0.5, 0.50, 0.005, 11.3 * 120.0},
     {"CA3500", "high", 31.0, 280.0, 0.5, 1.9, 0.05, 36.0 * 213.0},
     {"CA3500", "low", 34.0, 170.0, 0.5, 0.9, 0.05, 36.0 * 213.0},
     {"CA6500", "high", 29.0, 360.0, 0.5, 2.1, 0.05, 65.0 * 213.0},
     {"CA6500", "low", 30.0, 150.0, 0.5, 0.8, 0.05, 65.0 * 213.0},
     {"Axas2020", "29Hz", 29.0, 242.7, 0.05, 7.31 / 3.96207, 1e-3, 72.02e3 / 9.81}}};

TEST(Rollers, AgreeWithTheirDataSheets) {
  for (const Sheet &sheet : sheets) {
    SCOPED_TRACE(std::string(sheet.machine) + " " + sheet.setting);
    const std::string file =
        (std::filesystem::path(DRUMLIN_SOURCE_DIR) / "inputs/rollers" / sheet.machine).string();
    const drumlin::Roller roller = drumlin::read_roller(file);
    const drumlin::RollerSetting &setting = drumlin::setting_of(roller, sheet.setting, file);
    ChainParameters p = table1_case("II", Transition::B);
    set_machine(p, roller, setting);
    EXPECT_NEAR(1.0 / p.period(), sheet.frequency, 1e-9);
    EXPECT_NEAR(p.Fw / 1e3, sheet.force, sheet.force_digit);
    EXPECT_NEAR(1e3 * setting.me_re / p.m2, sheet.amplitude, sheet.amplitude_digit);
    EXPECT_NEAR(p.m2 + p.m3, sheet.load, 1.0);
    EXPECT_EQ(p.k23, roller.k23);
    EXPECT_EQ(p.c23, roller.c23);
    EXPECT_EQ(p.k, 1e8); // the soil stays
    EXPECT_EQ(p.invalid(), "");
  }
}

} // namespace parameters

// The reference values are complete, and the closed form gives the restitutions that the reference gives as
// numbers.
namespace reference {

TEST(ReferenceValues, HaveSevenForEveryCaseAndTransitionAndThreeMeterValues) {
  for (const char *name : {"I", "II", "III", "IV"})
    for (const char *transition : {"A", "B"}) {
      const auto count = std::count_if(
          reference_values().begin(), reference_values().end(), [&](const ReferenceValue &value) {
            return value.case_name == name && value.transition == transition &&
                   value.quantity != "meter value CMV" && !std::isnan(value.tolerance);
          });
      EXPECT_EQ(count, 7) << name << transition;
    }
  EXPECT_EQ(reference_values().size(), 8u * 7u + 3u + 7u + 30u); // restitutions, velocity errors
}

TEST(ReferenceValues, HaveUnitToleranceAndSource) {
  for (const ReferenceValue &value : reference_values()) {
    EXPECT_LE(value.low, value.high);
    EXPECT_FALSE(value.tolerance < 0.0);
    EXPECT_FALSE(value.source.empty());
  }
}

TEST(Restitution, ClosedFormGivesTheNumbersGiven) {
  std::size_t given = 0;
  for (const ReferenceValue &reference : reference_values()) {
    if (reference.quantity != "restitution") continue;
    ++given;
    const double D = std::stod(reference.case_name.substr(2)); // "D=0.2"
    EXPECT_NEAR(closed_form_restitution(reference.transition, D), reference.low, 0.5e-6)
        << reference.transition << " " << reference.case_name;
  }
  EXPECT_EQ(given, 7U);
}

TEST(Restitution, OfBIsContinuousAtItsBranches) {
  for (const double D : {1.0 / std::sqrt(2.0), 1.0}) {
    const double step = 1e-6;
    EXPECT_NEAR(closed_form_restitution("B", D - step), closed_form_restitution("B", D), 2 * step);
    EXPECT_NEAR(closed_form_restitution("B", D + step), closed_form_restitution("B", D), 2 * step);
  }
  EXPECT_DOUBLE_EQ(closed_form_restitution("A", 0.0), 1.0);
  EXPECT_DOUBLE_EQ(closed_form_restitution("B", 0.0), 1.0);
  EXPECT_DOUBLE_EQ(closed_form_restitution("A", 1.0), 0.0);
}

TEST(VelocityErrors, AreFoundForTheTablesStepsOnly) {
  const auto known = [](const char *name, int steps, const char *stepping) {
    return reference_value(
        name, "B", "velocity error at " + std::to_string(steps) + " steps, " + stepping + " stepping");
  };
  ASSERT_NE(known("II", 1600, "second"), nullptr);
  EXPECT_EQ(known("II", 1600, "second")->low, 6.5e-6);
  ASSERT_NE(known("II", 200, "stock"), nullptr);
  EXPECT_EQ(known("II", 200, "stock")->low, 1.8e-2);
  EXPECT_EQ(known("II", 2000, "second"), nullptr);
  EXPECT_EQ(known("III", 200, "stock"), nullptr);
}

} // namespace reference

} // namespace of_parameters

// The steady states of the paper's four cases: on what two solvers without common code agree, and what
// REFERENCE.md has recorded of them.
namespace steady_state {

using post::ContactEvent;
using post::CycleSummary;
using post::Transition;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

// One row of the table: accelerations in m/s2, forces in kN, overlap in mm.
struct Row {
  double a_min, a_max, F_min, F_max, share, F_break, d_break, F_make;
};

struct SteadyCase {
  const char *name;
  Transition transition;
  Row steady;   // after 160 cycles, half a unit of the last digit
  Row recorded; // REFERENCE.md's table
};

void PrintTo(const SteadyCase &value, std::ostream *out) {
  *out << value.name << post::transition_name(value.transition);
}

class SteadyState : public ::testing::TestWithParam<SteadyCase> {};

double last(const std::vector<ContactEvent> &events, bool make, double ContactEvent::*value) {
  const auto found =
      std::find_if(events.rbegin(), events.rend(), [make](const auto &event) { return event.make == make; });
  return found == events.rend() ? none : (*found).*value;
}

Row last_row(const std::vector<CycleSummary> &cycles, const std::vector<ContactEvent> &events) {
  const CycleSummary &cycle = cycles.back();
  return {cycle.a_drum_min,
          cycle.a_drum_max,
          cycle.F_contact_min * 1e-3,
          cycle.F_contact_max * 1e-3,
          cycle.contact_share,
          last(events, false, &ContactEvent::force) * 1e-3,
          last(events, false, &ContactEvent::overlap) * 1e3,
          last(events, true, &ContactEvent::force) * 1e-3};
}

void expect_near(const Row &found, const Row &expected, const Row &tolerance) {
  const auto check = [&](double Row::*value, const char *what) {
    if (std::isnan(expected.*value))
      EXPECT_TRUE(std::isnan(found.*value)) << what << ": found an event, expected none";
    else
      EXPECT_NEAR(found.*value, expected.*value, tolerance.*value) << what;
  };
  check(&Row::a_min, "a_min");
  check(&Row::a_max, "a_max");
  check(&Row::F_min, "F_min");
  check(&Row::F_max, "F_max");
  check(&Row::share, "share");
  check(&Row::F_break, "F at break");
  check(&Row::d_break, "d at break");
  check(&Row::F_make, "F at make");
}

constexpr int long_run = 160;

post::ExactSolution solve(const SteadyCase &steady, int cycles) {
  post::ExactOptions options;
  options.cycles = cycles;
  return post::solve_chain(post::table1_case(steady.name, steady.transition), options);
}

TEST_P(SteadyState, SolversAgreeAndRecordedDigitsHold) {
  const SteadyCase &steady = GetParam();
  const post::ExactSolution solved = solve(steady, long_run);
  const OracleResult exact = exact_pieces(post::table1_case(steady.name, steady.transition), long_run, 200);
  const Row row = last_row(solved.cycles, solved.events);
  expect_near(row, steady.steady, {0.5e-4, 0.5e-4, 0.5e-4, 0.5e-3, 0.5e-5, 0.5e-4, 0.5e-5, 0.5e-3});
  // The oracle's extremes are the largest of 2000 points per cycle, its shares and events exact.
  expect_near(row, last_row(exact.cycles, exact.events), {1e-3, 1e-3, 1e-3, 1e-3, 1e-8, 1e-6, 1e-8, 1e-6});
  ASSERT_EQ(solved.cycles.size(), exact.cycles.size());
  for (std::size_t i = 0; i < solved.cycles.size(); ++i) {
    EXPECT_EQ(solved.cycles[i].makes, exact.cycles[i].makes) << "cycle " << i + 1;
    EXPECT_EQ(solved.cycles[i].breaks, exact.cycles[i].breaks) << "cycle " << i + 1;
    EXPECT_NEAR(solved.cycles[i].contact_share, exact.cycles[i].contact_share, 1e-8);
    EXPECT_GE(solved.cycles[i].a_drum_max, exact.cycles[i].a_drum_max - 1e-6);
    EXPECT_LE(solved.cycles[i].a_drum_min, exact.cycles[i].a_drum_min + 1e-6);
  }
}

// REFERENCE.md's figures were read near cycle 30, where the frame still swings: they differ from the steady
// state in their last digits, by no more than cycles 16 to 30 differ among themselves. Shares were counted in
// samples.
TEST_P(SteadyState, ReferenceTableHoldsWithinTheScatterOfItsCycles) {
  const SteadyCase &steady = GetParam();
  const post::ExactSolution solved = solve(steady, 30);
  const auto covers = [](std::vector<double> values, double recorded, double half_digit, const char *what) {
    ASSERT_FALSE(values.empty()) << what;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    EXPECT_GE(recorded, *low - half_digit) << what;
    EXPECT_LE(recorded, *high + half_digit) << what;
  };
  const auto of_cycles = [&](double CycleSummary::*value, double scale) {
    std::vector<double> values;
    std::transform(solved.cycles.begin() + 15, solved.cycles.end(), std::back_inserter(values),
                   [=](const CycleSummary &cycle) { return cycle.*value * scale; });
    return values;
  };
  const auto of_events = [&](bool make, double ContactEvent::*value, double scale) {
    std::vector<double> values;
    for (const ContactEvent &event : solved.events)
      if (event.make == make && event.time >= solved.cycles[15].time) values.push_back(event.*value * scale);
    return values;
  };
  const Row &recorded = steady.recorded;
  covers(of_cycles(&CycleSummary::a_drum_min, 1), recorded.a_min, 0.5e-3, "a_min");
  covers(of_cycles(&CycleSummary::a_drum_max, 1), recorded.a_max, 0.5e-2, "a_max");
  covers(of_cycles(&CycleSummary::F_contact_min, 1e-3), recorded.F_min, 0.5e-2, "F_min");
  covers(of_cycles(&CycleSummary::F_contact_max, 1e-3), recorded.F_max, 0.5e-2, "F_max");
  covers(of_cycles(&CycleSummary::contact_share, 1), recorded.share, 1e-3, "share");
  if (std::isnan(recorded.F_break)) {
    EXPECT_TRUE(solved.events.empty());
    return;
  }
  covers(of_events(false, &ContactEvent::force, 1e-3), recorded.F_break, 0.5e-2, "F at break");
  covers(of_events(false, &ContactEvent::overlap, 1e3), recorded.d_break, 0.5e-3, "d at break");
  covers(of_events(true, &ContactEvent::force, 1e-3), recorded.F_make, 0.5e-2, "F at make");
}

const SteadyCase steady_cases[] = {
    {"I",
     Transition::A,
     {-31.7946, 31.7946, 2.1994, 56.6606, 1, none, none, none},
     {-31.795, 31.795, 2.20, 56.66, 1, none, none, none}},
    {"I",
     Transition::B,
     {-31.7946, 31.7946, 2.1994, 56.6606, 1, none, none, none},
     {-31.795, 31.795, 2.20, 56.66, 1, none, none, none}},
    {"II",
     Transition::A,
     {-43.7581, 96.6937, -66.2468, 241.3936, 0.32184, -66.2468, 0, 235.0780},
     {-43.759, 96.698, -66.25, 241.39, 0.322, -66.25, 0, 235.08}},
    {"II",
     Transition::B,
     {-44.4693, 111.6814, 0, 247.2691, 0.20210, 0, 0.86012, 245.6944},
     {-44.471, 111.681, 0, 247.29, 0.202, 0, 0.860, 245.67}},
    {"III",
     Transition::A,
     {-43.6333, 37.7312, -43.2188, 110.7227, 0.61674, -43.2188, 0, 77.6183},
     {-43.634, 37.732, -43.22, 110.72, 0.616, -43.22, 0, 77.62}},
    {"III",
     Transition::B,
     {-43.9444, 44.4258, 0, 113.0707, 0.38506, 0, 0.48836, 97.3872},
     {-43.947, 44.427, 0, 113.08, 0.385, 0, 0.488, 97.39}},
    {"IV",
     Transition::A,
     {-8.2009, 8.2009, -30.3674, 89.2274, 1, none, none, none},
     {-8.201, 8.201, -30.37, 89.23, 1, none, none, none}},
    {"IV",
     Transition::B,
     {-43.5485, 128.9645, 0, 341.0656, 0.32536, 0, 0.29624, 341.0656},
     {-43.551, 128.96, 0, 341.1, 0.326, 0, 0.296, 341.1}},
};

std::string steady_name(const ::testing::TestParamInfo<SteadyCase> &info) {
  return info.param.name + post::transition_name(info.param.transition);
}

INSTANTIATE_TEST_SUITE_P(Table1, SteadyState, ::testing::ValuesIn(steady_cases), steady_name);

} // namespace steady_state

} // namespace
} // namespace drumlin::test
