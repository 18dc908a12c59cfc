// Meter values: each formula against its closed form and against an independent computation, records
// by CVODE against reference values, and the files that other programs read.
#include "tests/support/chain_by_cvode.h"
#include "tests/support/chain_record.h"
#include "tests/support/piecewise_oracle.h"
#include "map/regime.h"
#include "meter/page.h"
#include "meter/sampling.h"
#include "meter/values.h"
#include "chain/exact_solution.h"
#include "chain/parameters.h"

namespace drumlin::test {

namespace {

using namespace drumlin::post;

constexpr double pi = 3.14159265358979323846;

/// The record of a solution by CVODE.
Record record_of(const ChainParameters &parameters, int cycles, int samples) {
  ExactOptions options;
  options.cycles = cycles;
  options.samples_per_cycle = samples;
  const ChainHistory history = drumlin::test::solve_by_cvode(parameters, options).history;
  Record record = test::record_of(parameters, history);
  record.interval = parameters.period() / samples;
  record.F_contact = history.F_contact;
  return record;
}

MeterWindow last_window(const Record &record, const MeterOptions &options = {}) {
  return meter_windows(meter_cycles(record), options).back();
}

/// A record of accelerations alone, sum of cosines at multiples of 20 Hz.
Record synthetic(double samples_per_cycle, int cycles, const std::vector<std::pair<double, double>> &parts) {
  Record record;
  record.file = "measured.csv";
  record.omega = 40.0 * pi;
  record.interval = 0.05 / samples_per_cycle;
  const int count = static_cast<int>(cycles * samples_per_cycle) + 1;
  for (int i = 0; i <= count; ++i) {
    record.time.push_back(0.3 + i * record.interval);
    double a = 0.0;
    for (const auto &[order, amplitude] : parts)
      a += amplitude * std::cos(order * *record.omega * record.time.back() + order);
    record.a_drum.push_back(a);
  }
  return record;
}

TEST(Meter, AmplitudesOfAKnownSignal) {
  const std::vector<std::pair<double, double>> parts = {{0.5, 1.0},  {1.0, 40.0}, {1.5, 2.0},
                                                        {2.0, 16.0}, {2.5, 3.0},  {3.0, 4.0}};
  const MeterWindow whole = last_window(synthetic(64.0, 20, parts));
  for (std::size_t j = 0; j < parts.size(); ++j)
    EXPECT_NEAR(whole.amplitude[j], parts[j].second, 1e-11) << meter_orders[j];
  EXPECT_NEAR(*whole.cmv, 300.0 * 16.0 / 40.0, 1e-9);
  EXPECT_NEAR(*whole.rmv, 100.0 * 1.0 / 40.0, 1e-9);
  EXPECT_NEAR(*whole.ccv, 100.0 * (1.0 + 2.0 + 16.0 + 3.0 + 4.0) / (1.0 + 40.0), 1e-9);
  MeterOptions other;
  other.rmv_constant = 300.0;
  EXPECT_NEAR(*last_window(synthetic(64.0, 20, parts), other).rmv, 7.5, 1e-9);
  // A cycle that is no whole number of samples: of second order in the interval.
  const MeterWindow broken = last_window(synthetic(333.3, 20, parts));
  EXPECT_NEAR(*broken.cmv, 120.0, 0.02);
  EXPECT_LT(std::abs(*broken.cmv - 120.0), broken.cmv_bound);
}

TEST(Meter, ModesOfKnownSignals) {
  EXPECT_EQ(last_window(synthetic(50.0, 20, {{1.0, 40.0}, {2.0, 9.0}})).mode, OperatingMode::same_each_cycle);
  EXPECT_EQ(last_window(synthetic(50.0, 20, {{0.5, 30.0}, {1.0, 40.0}, {1.5, 20.0}})).mode,
            OperatingMode::double_jump);
  EXPECT_EQ(last_window(synthetic(50.0, 20, {{1.0, 40.0}, {1.31, 30.0}})).mode, OperatingMode::irregular);
}

struct Known {
  const char *name;
  double cmv; // reference value, from Fourier integrals over each phase of the exact solution
};
constexpr Known known_cmv[] = {{"II", 155.948}, {"III", 105.730}, {"IV", 247.175}};

TEST(Meter, CmvOfTheDirectSolution) {
  for (const Known &known : known_cmv) {
    Record record = record_of(table1_case(known.name, Transition::B), 120, 2000);
    const MeterWindow exact = last_window(record);
    EXPECT_NEAR(*exact.cmv / known.cmv, 1.0, 1e-5) << known.name;
    EXPECT_EQ(exact.mode, OperatingMode::partial_uplift);
    // A jump of the acceleration lies anywhere between two samples.
    record.v_drum.clear();
    const MeterWindow sampled = last_window(record);
    EXPECT_NEAR(*sampled.cmv / known.cmv, 1.0, 4e-3) << known.name;
    EXPECT_LT(std::abs(*sampled.cmv - known.cmv), sampled.cmv_bound) << known.name;
  }
}

TEST(Meter, BoundsHoldForCoarseRecords) {
  for (const Known &known : known_cmv)
    for (const int samples : {50, 130, 400}) {
      Record record = record_of(table1_case(known.name, Transition::B), 120, samples);
      const MeterWindow velocity = last_window(record);
      EXPECT_LT(std::abs(*velocity.cmv - known.cmv), velocity.cmv_bound) << known.name << samples;
      record.v_drum.clear();
      const MeterWindow acceleration = last_window(record);
      EXPECT_LT(std::abs(*acceleration.cmv - known.cmv), acceleration.cmv_bound) << known.name << samples;
      EXPECT_LT(velocity.cmv_bound, acceleration.cmv_bound) << known.name << samples;
    }
}

/// Amplitudes of the acceleration from changes of velocity over the last two cycles of an exact solution.
MeterAmplitudes amplitudes_of(const OracleResult &exact, int samples_per_cycle, double omega) {
  MeterAmplitudes amplitudes{};
  const std::size_t last = exact.time.size() - 1;
  for (std::size_t j = 0; j < amplitudes.size(); ++j) {
    std::complex<double> sum;
    for (std::size_t i = last - 2 * static_cast<std::size_t>(samples_per_cycle); i < last; ++i)
      sum += (exact.v_drum[i + 1] - exact.v_drum[i]) *
             std::polar(1.0, -meter_orders[j] * omega * 0.5 * (exact.time[i] + exact.time[i + 1]));
    amplitudes[j] = std::abs(sum) * omega / (2.0 * pi);
  }
  return amplitudes;
}

/// Samples of the exact solution from its 301st cycle on, one of `every`.
Record thinned(const OracleResult &exact, const ChainParameters &p, int samples_per_cycle, int every,
               int first, bool velocity) {
  Record record;
  record.file = "measured.csv";
  record.omega = p.omega;
  record.interval = p.period() / samples_per_cycle * every;
  for (auto i =
           std::size_t{300} * static_cast<std::size_t>(samples_per_cycle) + static_cast<std::size_t>(first);
       i < exact.time.size(); i += static_cast<std::size_t>(every)) {
    record.time.push_back(exact.time[i]);
    (velocity ? record.v_drum : record.a_drum).push_back(velocity ? exact.v_drum[i] : exact.a_drum[i]);
  }
  return record;
}

// Over regimes, rates and phases of the samples: no value is off by more than its bound, and most bounds are
// not much larger. Exact solutions share no code with the meter.
TEST(Meter, BoundsAreTight) {
  constexpr int samples = 3000;
  std::array<std::vector<double>, 2>
      ratios; // the bound divided by the error: records with accelerations, with velocities
  const auto take = [&ratios](bool velocity, double value, double truth, double bound) {
    EXPECT_LE(std::abs(value - truth), bound + 1e-5 * (1.0 + truth)) << "but for the error of the truth";
    if (truth > 1.0) ratios[velocity ? 1 : 0].push_back(bound / std::max(std::abs(value - truth), 1e-9));
  };
  for (const auto &[k, D, transition] : {std::tuple{20e6, 0.5, Transition::B},
                                         {100e6, 0.5, Transition::B},
                                         {60e6, 0.2, Transition::B},
                                         {60e6, 0.3, Transition::A}}) {
    ChainParameters p = table1_case("II", transition);
    p.k = k;
    p.D = D;
    const OracleResult exact = exact_pieces(p, 313, samples);
    const MeterAmplitudes truth = amplitudes_of(exact, samples, p.omega);
    for (const int every : {120, 97, 60, 31, 15, 7, 3}) // 25 to 1000 samples per cycle
      for (const int first : {0, 1, 2, 5, 11, 23, 47})
        for (const bool velocity : {false, true}) {
          SCOPED_TRACE(std::to_string(k) + " " + std::to_string(every) + " " + std::to_string(first));
          const MeterWindow window = last_window(thinned(exact, p, samples, every, first % every, velocity));
          take(velocity, *window.cmv, compaction_meter(truth), window.cmv_bound);
          take(velocity, *window.rmv, resonance_meter()(truth), window.rmv_bound);
          take(velocity, *window.ccv, compaction_control(truth), window.ccv_bound);
        }
  }
  for (std::vector<double> &all : ratios) {
    std::sort(all.begin(), all.end());
    RecordProperty(&all == &ratios[0] ? "accelerations" : "velocities",
                   std::to_string(all.size()) + " values, median " + std::to_string(all[all.size() / 2]));
    EXPECT_LT(all[all.size() / 2], 8.0);
    EXPECT_LT(all[all.size() * 3 / 4], 30.0);
  }
}

// A motion in unbroken contact is smooth: its CMV is zero, and is told to be so.
TEST(Meter, BoundsOfUnbrokenContactAreSmall) {
  constexpr int samples = 3000;
  ChainParameters p = table1_case("II", Transition::B);
  p.k = 5e6;
  const OracleResult exact = exact_pieces(p, 313, samples);
  for (const int every : {83, 60, 31, 15, 7}) // 36 samples per cycle and more
    for (const bool velocity : {false, true}) {
      const MeterWindow window = last_window(thinned(exact, p, samples, every, 1, velocity));
      EXPECT_LE(*window.cmv, window.cmv_bound + 1e-6) << every << velocity;
      EXPECT_LT(window.cmv_bound, 0.05) << every << velocity;
      EXPECT_LT(window.rmv_bound, 0.05) << every << velocity;
    }
}

// Noise counts, too: of a motion in unbroken contact, which has no second harmonic, nearly all is noise. It
// is not taken for jumps: five standard deviations are exceeded once in two million samples, here of 256,000.
TEST(Meter, BoundsContainNoise) {
  int within = 0;
  std::size_t jumps = 0;
  constexpr int seeds = 200;
  for (int seed = 0; seed < seeds; ++seed) {
    Record record = synthetic(64.0, 20, {{1.0, 40.0}});
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::normal_distribution<double> noise(0.0, 0.4);
    for (double &a : record.a_drum)
      a += noise(random);
    jumps += faults_of(record, HarmonicSource::acceleration).jumps.size();
    const MeterWindow window = last_window(record);
    if (*window.cmv < window.cmv_bound) ++within;
    EXPECT_LT(window.cmv_bound, 2.0); // 300 times 0.4 root(2/640) / 40 is 0.17
  }
  EXPECT_GE(within, 190);
  EXPECT_LE(jumps, 2U);
}

TEST(Meter, DoubleJumpAgainstTheClosedFormSolver) {
  ChainParameters p = table1_case("II", Transition::B);
  p.k = 60e6;
  p.D = 0.2;
  const RegimePoint known = judge_regime(p, 300);
  ASSERT_EQ(known.regime, Regime::period_2);
  const MeterWindow window = last_window(record_of(p, 150, 500));
  EXPECT_EQ(window.mode, OperatingMode::double_jump);
  EXPECT_NEAR(*window.cmv / known.meter.cmv, 1.0, 1e-3);
  EXPECT_NEAR(*window.rmv / known.meter.rmv, 1.0, 1e-3);
}

TEST(Meter, StiffnessAndEnergyInContinuousContact) {
  const ChainParameters p = table1_case("I", Transition::B);
  const MeterWindow window = last_window(record_of(p, 100, 400));
  EXPECT_EQ(window.mode, OperatingMode::continuous_contact);
  EXPECT_NEAR(*window.k_1 / p.k, 1.0, 1e-6);
  EXPECT_NEAR(*window.c_1 / p.damping(), 1.0, 1e-6);
  // k_B counts the frame as part of the soil: its dynamic stiffness in closed form.
  const std::complex<double> bond(p.k23, p.omega * p.c23);
  const double inertia = p.m3 * p.omega * p.omega;
  const std::complex<double> frame = -bond * inertia / (bond - inertia);
  EXPECT_NEAR(*window.k_B / (p.k + frame.real()), 1.0, 1e-6);
  // The dashpot of the soil takes pi c omega X^2 per cycle.
  EXPECT_NEAR(*window.energy /
                  (2.0 * pi * p.damping() * p.omega * *window.displacement * *window.displacement),
              1.0, 1e-5);
  EXPECT_LT(*window.cmv, 1e-3);
}

// With the exciter off the drum does not shake, so that no meter value tells anything about the soil.
TEST(Meter, OfARollerThatDoesNotVibrateHasNoValues) {
  Record record = record_of(table1_case("I", Transition::B), 100, 400);
  record.Fw = 0.0;
  const MeterWindow window = last_window(record);
  EXPECT_FALSE(window.cmv || window.rmv || window.ccv || window.k_B || window.k_1 || window.E_vib);
  EXPECT_TRUE(window.contact_share && window.peak_force);
}

TEST(Meter, ForceFromAccelerationsGivesTheSame) {
  Record record = record_of(table1_case("II", Transition::B), 60, 500);
  const MeterWindow recorded = last_window(record);
  const std::vector<double> force = record.F_contact;
  record.F_contact.clear();
  const std::vector<double> computed = soil_force(record);
  for (std::size_t i = 0; i < force.size(); ++i)
    ASSERT_NEAR(computed[i], force[i], 1e-4);
  const MeterWindow window = last_window(record);
  EXPECT_NEAR(*window.energy, *recorded.energy, 1e-6 * *recorded.energy);
  EXPECT_NEAR(*window.contact_share, *recorded.contact_share, 0.03);
}

// The drum first loses contact at 28.8593 MN/m. From accelerations alone this cannot be told beside it.
TEST(Meter, TellsThatTheDrumJustTouches) {
  ChainParameters p;
  p.transition = Transition::B;
  p.m2 = 6000.0;
  p.m3 = 3500.0;
  p.k23 = 3.1e6;
  p.c23 = 31e3;
  p.omega = 60.0 * pi;
  p.Fw = 11.4 * p.omega * p.omega;
  p.D = 0.2;
  for (const auto &[k, measured, recorded] :
       {std::tuple{25e6, OperatingMode::continuous_contact, OperatingMode::continuous_contact},
        std::tuple{28.5e6, OperatingMode::same_each_cycle, OperatingMode::continuous_contact},
        std::tuple{28.9e6, OperatingMode::same_each_cycle, OperatingMode::partial_uplift},
        std::tuple{33e6, OperatingMode::partial_uplift, OperatingMode::partial_uplift}}) {
    p.k = k;
    Record record = record_of(p, 100, 200);
    EXPECT_EQ(last_window(record).mode, recorded) << k;
    record.F_contact.clear();
    MeterResult result;
    result.record = record;
    result.cycles = meter_cycles(record);
    result.windows = meter_windows(result.cycles, result.options);
    const MeterWindow &window = result.windows.back();
    EXPECT_EQ(window.mode, measured) << k << " " << window.contact_share.value_or(-1.0);
    const bool touches = measured == OperatingMode::same_each_cycle;
    EXPECT_EQ(window.contact_share.has_value(), !touches) << k;
    EXPECT_EQ(answer_line(result).find("just lost or just kept") != std::string::npos, touches) << k;
  }
}

/// Deflection in the middle of the contact by integration of Boussinesq's solution over Hertz's pressure,
/// constant along the width of the drum: 2 asinh(L/2x) is the integral of 1/r along it.
double integrated_deflection(double force, double modulus, const LineContact &contact) {
  const double plane = (1.0 - contact.poisson * contact.poisson) / modulus;
  const double half = 0.5 * std::sqrt(16.0 / pi * contact.radius * plane * force / contact.length);
  double sum = 0.0;
  constexpr int steps = 200000;
  for (int i = 0; i < steps; ++i) {
    const double angle = (i + 0.5) * 0.5 * pi / steps; // x = half sin(angle) takes the square root away
    sum += std::cos(angle) * std::cos(angle) * std::asinh(contact.length / (2.0 * half * std::sin(angle)));
  }
  const double pressure = 2.0 * force / (pi * half * contact.length);
  return plane / pi * pressure * 4.0 * half * sum * 0.5 * pi / steps;
}

TEST(Lundberg, DeflectionsAndModulus) {
  const LineContact drum = {0.759, 2.13, 0.35};
  const double moduli[] = {20e6, 40e6, 80e6, 160e6};
  const double at_72[] = {4.932e-3, 2.629e-3, 1.397e-3, 0.739e-3};
  const double at_200[] = {12.359e-3, 6.634e-3, 3.544e-3, 1.886e-3};
  for (int i = 0; i < 4; ++i)
    for (const auto &[force, expected] : {std::pair{72e3, at_72[i]}, std::pair{200e3, at_200[i]}}) {
      const double z = lundberg_deflection(force, moduli[i], drum);
      EXPECT_NEAR(z, expected, 0.5e-6);
      EXPECT_NEAR(*lundberg_modulus(force, z, drum) / moduli[i], 1.0, 1e-6);
      EXPECT_NEAR(z / integrated_deflection(force, moduli[i], drum), 1.0, 5e-3);
    }
  // For a narrow contact the integral has the same logarithm and the constant 2 ln 2 + 1/2, of which 1.8864
  // is rounded.
  EXPECT_NEAR(lundberg_deflection(1e3, 1e9, drum) / integrated_deflection(1e3, 1e9, drum), 1.0, 2e-5);
  EXPECT_FALSE(lundberg_modulus(0.0, 1e-3, drum));
  EXPECT_FALSE(lundberg_modulus(72e3, 0.0, drum));
  EXPECT_FALSE(lundberg_modulus(72e3, 2.0, drum)); // wider than long
}

TEST(Meter, ModulusFromTheLowestPosition) {
  // The dashpot gives no force where the drum turns round: there F = k z.
  const ChainParameters p = table1_case("II", Transition::B);
  MeterOptions options;
  options.drum_radius = 0.759;
  options.drum_width = 2.13;
  const Record record = record_of(p, 120, 2000);
  const MeterRecord cycles = meter_cycles(record);
  const MeterCycle &last = cycles.cycles.back();
  EXPECT_NEAR(*last.low_force / (p.k * *last.deflection), 1.0, 0.02);
  const auto expected = lundberg_modulus(p.k * *last.deflection, *last.deflection, {0.759, 2.13, 0.35});
  EXPECT_NEAR(*meter_windows(cycles, options).back().E_vib / *expected, 1.0, 0.02);
  EXPECT_FALSE(meter_windows(cycles, {}).back().E_vib);
}

/// E in Lundberg's formula for a deflection, by bisection of its own words.
double modulus_by_bisection(double force, double deflection, double radius, double width, double poisson) {
  double low = 1e3, high = 1e12;
  for (int i = 0; i < 200; ++i) {
    const double E = std::sqrt(low * high);
    const double u = (1.0 - poisson * poisson) / E * force / width;
    const double B = std::sqrt(16.0 / pi * radius * u);
    (u * 2.0 / pi * (1.8864 + std::log(width / B)) > deflection ? low : high) = E;
  }
  return std::sqrt(low * high);
}

// A bed in two dimensions has the forces of 1 m of the drum, one in three those of its thickness; E_vib is
// that of the whole drum in each. As if the bed were the soil of the chain: the same motion, the forces of a
// slice.
TEST(Meter, ModulusOfASliceIsThatOfTheDrum) {
  constexpr double radius = 0.759, width = 2.13;
  ChainParameters p = table1_case("II", Transition::B);
  p.m2 = 4000.0;
  p.m3 = 3400.0;
  p.Fw = 150e3;
  p.k = 60e6;
  const OracleResult exact = exact_pieces(p, 120, 2000);
  const auto slice = [&](double thickness, const std::string &dimension, const std::string &noted) {
    Record record;
    record.file = dimension.empty() ? "chain.csv" : "bed.csv";
    record.known_origin = dimension.empty();
    record.omega = p.omega;
    record.interval = p.period() / 2000;
    record.time = exact.time;
    record.x_drum = exact.x_drum;
    record.v_drum = exact.v_drum;
    for (const double force : exact.F_contact)
      record.F_contact.push_back(force * thickness / width);
    if (!dimension.empty()) record.parameters["dimension"] = dimension;
    if (!noted.empty()) record.parameters["thickness"] = noted;
    return record;
  };
  MeterOptions options;
  options.drum_radius = radius;
  options.drum_width = width;
  const std::size_t last = exact.x_drum.size() - 1;
  const double z =
      -*std::min_element(exact.x_drum.begin() + static_cast<std::ptrdiff_t>(last - 2000), exact.x_drum.end());
  const double expected = modulus_by_bisection(p.k * z, z, radius, width, 0.35);
  EXPECT_NEAR(*last_window(slice(width, "", ""), options).E_vib / expected, 1.0, 1e-3);
  EXPECT_NEAR(*last_window(slice(1.0, "2", ""), options).E_vib / expected, 1.0, 0.01);
  EXPECT_NEAR(*last_window(slice(1.0, "2", "1"), options).E_vib / expected, 1.0, 0.01);
  EXPECT_NEAR(*last_window(slice(0.2, "3", "0.2"), options).E_vib / expected, 1.0, 0.01);
  EXPECT_FALSE(last_window(slice(0.2, "3", ""), options).E_vib) << "the thickness is not known";
  MeterResult result;
  result.record = slice(1.0, "2", "");
  result.cycles = meter_cycles(result.record);
  result.options = options;
  EXPECT_EQ(width_words(result), "Forces, energy and stiffnesses are those of 1 m of the drum; for E_vib the "
                                 "force is that of the whole drum, 2.13 m wide.");
}

// Three times the exciter's force would belong to a soil of negative stiffness, a turned one to one that
// drives the drum.
TEST(Meter, AStiffnessThatContradictsItselfIsNone) {
  const Record record = record_of(table1_case("I", Transition::B), 60, 200);
  const MeterWindow right = last_window(record);
  ASSERT_TRUE(right.k_B && right.k_1 && right.c_1);
  for (const double factor : {3.0, -1.0}) {
    Record wrong = record;
    for (double &force : wrong.F_excitation)
      force *= factor;
    const MeterWindow window = last_window(wrong);
    EXPECT_FALSE(window.k_1 || window.c_1);
    EXPECT_EQ(window.k_B.has_value(), factor < 0.0);
    EXPECT_TRUE(window.cmv);
  }
}

TEST(Meter, WindowsEndWithTheRecord) {
  const MeterRecord record = meter_cycles(synthetic(50.0, 47, {{1.0, 40.0}}));
  const std::vector<MeterWindow> windows = meter_windows(record, {});
  ASSERT_EQ(windows.size(), 4U);
  EXPECT_EQ(windows.front().first, 7U);
  EXPECT_NEAR(windows.back().end, 0.3 + 47 * 0.05, 1e-9);
  MeterOptions longer;
  longer.window = 48;
  EXPECT_THROW(meter_windows(record, longer), std::runtime_error);
}

} // namespace

} // namespace drumlin::test
