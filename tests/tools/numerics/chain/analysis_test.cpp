// The analysis functions against closed forms.
#include "chain/analysis.h"
#include "tests/support/checks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

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

} // namespace
