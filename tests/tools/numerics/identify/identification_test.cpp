#include "tests/support/chain_by_cvode.h"
#include "tests/support/chain_record.h"
#include "tests/support/checks.h"
#include "chain/exact_solution.h"
#include "identify/identified_record.h"
#include "identify/lumped_comparison.h"
#include "identify/page.h"
#include "record/chain_record.h"
#include "support/statistics.h"

namespace drumlin::test {
namespace {

// Stiffness and damping from records whose true values are known: of the closed-form solver and of CVODE,
// exact and with noise. The contact's law is in these solvers, not in the identification's own functions.
namespace law {

using namespace post;

constexpr double pi = 3.14159265358979323846;
constexpr int cycles = 30;
constexpr int samples_per_cycle = 200;

Record exact_record(const ChainParameters &parameters) {
  return record_of(parameters, solve_chain(parameters, cycles, samples_per_cycle).history);
}

std::vector<ChainParameters> eight_cases() {
  std::vector<ChainParameters> all;
  for (const char *name : table1_cases)
    for (const Transition transition : {Transition::A, Transition::B})
      all.push_back(table1_case(name, transition));
  return all;
}

std::string name_of(const ChainParameters &p) {
  return "k " + std::to_string(p.k) + ", D " + std::to_string(p.D) + ", omega " + std::to_string(p.omega) +
         ", " + transition_name(p.transition);
}

// White noise on every measured signal, of a share of its standard deviation.
Record with_noise(Record record, double share, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (std::vector<double> *signal : {&record.x_drum, &record.v_drum, &record.a_drum, &record.a_frame}) {
    const auto n = static_cast<double>(signal->size());
    double mean = 0.0;
    for (const double value : *signal)
      mean += value / n;
    double variance = 0.0;
    for (const double value : *signal)
      variance += (value - mean) * (value - mean) / n;
    for (double &value : *signal)
      value += share * std::sqrt(variance) * normal(random);
  }
  return record;
}

// The excitation as assumed with a wrong phase.
Record with_phase(Record record, double error) {
  for (std::size_t i = 0; i < record.size(); ++i)
    record.F_excitation[i] = *record.Fw * std::sin(*record.omega * record.time[i] + error);
  return record;
}

bool holds(const MeanInterval &interval, double truth) {
  return std::fabs(interval.mean - truth) <= interval.half_width;
}

void expect_law(const ChainParameters &p, const LawEstimate &law, double of_k, double of_c) {
  EXPECT_NEAR(law.k.mean, p.k, of_k * p.k);
  EXPECT_NEAR(law.c.mean, p.damping(), of_c * p.damping());
  EXPECT_NEAR(law.D.mean, p.D, (of_k + of_c) * p.D);
}

TEST(Identification, FindsTheLawOfTheEightCases) {
  for (const ChainParameters &p : eight_cases()) {
    SCOPED_TRACE(name_of(p));
    for (const bool accelerations_only : {false, true}) {
      RecordSetting setting;
      setting.accelerations_only = accelerations_only;
      const IdentifiedRecord found = identify_record(exact_record(p), setting);
      expect_law(p, found.whole.law, 1e-5, 1e-5);
      EXPECT_GT(found.whole.law.r2, 1.0 - 1e-9);
      ASSERT_EQ(found.windows.size(), 3U);
      for (const LawWindow &window : found.windows) {
        ASSERT_TRUE(window.law.has_value()) << window.why_not;
        expect_law(p, *window.law, 3e-5, 3e-5);
      }
    }
  }
}

TEST(Identification, TellsWhetherTheContactPulls) {
  for (const ChainParameters &p : eight_cases()) {
    SCOPED_TRACE(name_of(p));
    const bool soft = p.k < 1e7; // case I: contact is not lost, and there is no tension under A either
    const Pull expected = soft                            ? Pull::unknown
                          : p.transition == Transition::A ? Pull::pulls
                                                          : Pull::does_not_pull;
    for (const double noise : {0.0, 0.01})
      for (const bool accelerations_only : {false, true}) {
        RecordSetting setting;
        setting.accelerations_only = accelerations_only;
        EXPECT_EQ(identify_record(with_noise(exact_record(p), noise, 3), setting).whole.pull, expected);
      }
  }
  // So little damping that the tension lasts for less than a sample.
  ChainParameters p = table1_case("II", Transition::B);
  p.D = 0.005;
  EXPECT_EQ(identify_record(exact_record(p), {}).whole.pull, Pull::unknown);
}

// Motions that repeat themselves every two cycles, and that never do, computed by CVODE.
TEST(Identification, FindsTheLawOfPeriodTwoAndAperiodicMotion) {
  for (const double D : {0.05, 0.1, 0.15, 0.2}) {
    ChainParameters p = table1_case("II", Transition::B);
    p.D = D;
    SCOPED_TRACE(name_of(p));
    ExactOptions options;
    options.cycles = 40;
    const Record record = record_of(p, drumlin::test::solve_by_cvode(p, options).history);
    for (const bool accelerations_only : {false, true}) {
      RecordSetting setting;
      setting.accelerations_only = accelerations_only;
      expect_law(p, identify_record(record, setting).whole.law, 1e-4, 1e-3);
      setting.phase_within = pi / 180.0;
      const LawEstimate noisy =
          identify_record(with_phase(with_noise(record, 0.01, 5), 0.01), setting).whole.law;
      EXPECT_NEAR(noisy.k.mean, p.k, 0.03 * p.k);
      EXPECT_NEAR(noisy.phase.mean, -0.01, 2e-3); // contact is lost: the flights tell the phase
    }
  }
}

// 1 % noise and a phase known within 1 degree: the true values lie in the 95 % intervals as often as they
// should (fewer than 90 of 100 has a probability of 1 % for a true 95 %), and the intervals are narrow.
TEST(Identification, IntervalsHoldTheTruth) {
  constexpr int seeds = 100;
  for (const ChainParameters &p : eight_cases()) {
    SCOPED_TRACE(name_of(p));
    const Record exact = exact_record(p);
    RecordSetting setting;
    setting.phase_within = pi / 180.0;
    setting.window = cycles;
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> phase(-setting.phase_within, setting.phase_within);
    int k_inside = 0;
    int c_inside = 0;
    int D_inside = 0;
    for (int seed = 0; seed < seeds; ++seed) {
      const Record record =
          with_phase(with_noise(exact, 0.01, 100 + static_cast<std::uint64_t>(seed)), phase(random));
      const LawEstimate law = identify_record(record, setting).whole.law;
      k_inside += holds(law.k, p.k) ? 1 : 0;
      c_inside += holds(law.c, p.damping()) ? 1 : 0;
      D_inside += holds(law.D, p.D) ? 1 : 0;
      EXPECT_LT(law.k.half_width, 0.05 * p.k);
      EXPECT_LT(law.c.half_width, 0.10 * p.damping());
    }
    EXPECT_GE(k_inside, 90);
    EXPECT_GE(c_inside, 90);
    EXPECT_GE(D_inside, 90);
  }
}

// Accelerations alone with 1 % noise: k within 3 % where contact is lost, also with a phase within 1 degree,
// and with an exact phase everywhere. In unbroken contact an error of the phase acts on the force as k and c
// do: the interval contains the truth, but is wide.
TEST(Identification, AccelerationsAlone) {
  for (const ChainParameters &p : eight_cases()) {
    SCOPED_TRACE(name_of(p));
    const bool unbroken = p.k < 1e7 || (p.D > 1.0 && p.transition == Transition::A);
    const Record exact = exact_record(p);
    for (const double within : {0.0, pi / 180.0})
      for (int seed = 0; seed < 5; ++seed) {
        RecordSetting setting;
        setting.accelerations_only = true;
        setting.phase_within = within;
        const double error = within * (seed - 2) / 2.0;
        const LawEstimate law =
            identify_record(with_phase(with_noise(exact, 0.01, 40 + static_cast<std::uint64_t>(seed)), error),
                            setting)
                .whole.law;
        if (unbroken && within > 0.0) {
          EXPECT_TRUE(holds(law.k, p.k));
          EXPECT_LT(law.k.half_width, 0.12 * p.k);
        } else {
          EXPECT_NEAR(law.k.mean, p.k, 0.03 * p.k);
        }
      }
  }
}

// In unbroken contact without known positions an error delta of the phase changes the force at the excitation
// frequency by i delta Fw, and k by delta Im(Fw / X), with the drum's complex amplitude X. The interval has
// that width with noise, and must keep it if there is none.
TEST(Identification, ThePhaseIsAsUncertainWithoutNoise) {
  ChainParameters p = table1_case("I", Transition::B);
  const std::complex<double> i(0.0, 1.0);
  const std::complex<double> bond = p.k23 + i * p.omega * p.c23;
  const std::complex<double> frame = bond - p.m3 * p.omega * p.omega;
  const std::complex<double> drum = p.k + i * p.omega * p.damping() + bond - p.m2 * p.omega * p.omega;
  const double change_of_k = std::imag((drum * frame - bond * bond) / frame); // per radian
  RecordSetting setting;
  setting.accelerations_only = true;
  setting.phase_within = pi / 180.0;
  constexpr int settled = 40; // cycles before the record
  const Record exact = record_of(p, solve_chain(p, cycles, samples_per_cycle, settled).history);
  for (const double noise : {0.0, 1e-6, 1e-3}) {
    SCOPED_TRACE(noise);
    const IdentifiedRecord found = identify_record(with_noise(exact, noise, 9), setting);
    const LawEstimate &law = found.whole.law;
    const std::vector<std::string> lines = identification_answer(found);
    EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [](const std::string &line) {
      return line.rfind("Contact is not lost and no position", 0) == 0;
    }));
    const double phase =
        t_factor(static_cast<double>(law.blocks) - 2.0) * setting.phase_within / std::sqrt(3.0);
    EXPECT_NEAR(law.phase.half_width, phase, 1e-6 * phase);
    EXPECT_NEAR(law.k.half_width, phase * std::fabs(change_of_k), 0.02 * phase * std::fabs(change_of_k));
    EXPECT_TRUE(holds(law.k, p.k));
  }
}

// Ordinary least squares of the force over noisy position and velocity is biased; the constrained motion is
// not. 10 % noise, case II B.
TEST(Identification, NoiseOfPositionAndVelocityDoesNotBias) {
  const ChainParameters p = table1_case("II", Transition::B);
  const Record exact = exact_record(p);
  double ordinary = 0.0;
  double found = 0.0;
  constexpr int seeds = 10;
  for (int seed = 0; seed < seeds; ++seed) {
    const Record record = with_noise(exact, 0.1, static_cast<std::uint64_t>(seed));
    const DrumSignals signals = signals_of(record, false);
    double xx = 0.0;
    double xv = 0.0;
    double vv = 0.0;
    double xf = 0.0;
    double vf = 0.0;
    const Identification law = identify_record(record, {}).whole;
    for (std::size_t i = 0; i < record.size(); ++i) {
      if (law.states[i] != SampleState::contact) continue;
      const double x = -record.x_drum[i];
      const double v = -record.v_drum[i];
      xx += x * x;
      xv += x * v;
      vv += v * v;
      xf += x * signals.force[i];
      vf += v * signals.force[i];
    }
    ordinary += ((xf * vv - vf * xv) / (xx * vv - xv * xv) / p.k - 1.0) / seeds;
    found += (law.law.k.mean / p.k - 1.0) / seeds;
  }
  EXPECT_LT(ordinary, -0.02);
  EXPECT_NEAR(found, 0.0, 0.25 * std::fabs(ordinary));
}

// If the position at first contact is a parameter of the fit, adding a constant to all positions leaves k and
// c as they were.
TEST(Identification, FreeOriginIgnoresShifts) {
  const ChainParameters p = table1_case("II", Transition::B);
  Record record = exact_record(p);
  for (double &x : record.x_drum)
    x += 0.3;
  RecordSetting setting;
  setting.known_origin = false;
  const IdentifiedRecord found = identify_record(record, setting);
  expect_law(p, found.whole.law, 1e-5, 1e-5);
  EXPECT_NEAR(found.whole.x[found.whole.pieces.back().run.first],
              record.x_drum[found.whole.pieces.back().run.first], 1e-6);
}

TEST(Identification, RefusesRecordsThatTellNothing) {
  const ChainParameters p = table1_case("II", Transition::B);
  const auto message = [](const Record &record) {
    return error_of([&record] { identify_record(record, {}); });
  };
  Record flight = exact_record(p);
  for (std::size_t i = 0; i < flight.size(); ++i) {
    flight.a_frame[i] = -p.g;
    flight.a_drum[i] = -p.g - flight.F_excitation[i] / p.m2;
  }
  EXPECT_TRUE(contains(message(flight), "has no contact"));
  Record rest = exact_record(p);
  for (std::vector<double> *signal :
       {&rest.x_drum, &rest.v_drum, &rest.a_drum, &rest.a_frame, &rest.F_excitation})
    std::fill(signal->begin(), signal->end(), 0.0);
  EXPECT_TRUE(contains(message(rest), "does not determine k and c"));
  Record bare = exact_record(p);
  bare.a_drum.clear();
  EXPECT_TRUE(contains(message(bare), "a_drum"));
  bare = exact_record(p);
  bare.m3.reset();
  EXPECT_TRUE(contains(message(bare), "m3 is ''; allowed:"));
  bare = exact_record(p);
  bare.F_excitation.clear();
  EXPECT_TRUE(contains(message(bare), "--phase"));
}

TEST(ContactPhases, IntegralsOfACubicAreExact) {
  constexpr double dt = 0.01;
  std::vector<double> a;
  a.reserve(9);
  for (int i = 0; i < 9; ++i)
    a.push_back(std::pow(dt * i, 3) - 2.0 * dt * i + 1.0);
  const Integrals found = integrals(a, {2, 9}, dt);
  ASSERT_EQ(found.once.size(), 7U);
  const auto first = [](double t) { return std::pow(t, 4) / 4.0 - t * t + t; };
  for (std::size_t j = 0; j < 7; ++j)
    EXPECT_NEAR(found.once[j], first(dt * static_cast<double>(j + 2)) - first(2.0 * dt), 1e-15);
}

TEST(ContactPhases, NoiseLevelOfWhiteNoiseOnASlowWave) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0.0, 2.5);
  std::vector<double> signal;
  signal.reserve(20000);
  for (int i = 0; i < 20000; ++i)
    signal.push_back(100.0 * std::sin(0.03 * i) + normal(random));
  EXPECT_NEAR(noise_level(signal), 2.5, 0.1);
  EXPECT_EQ(noise_level({1.0, 2.0}), 0.0);
}

} // namespace law

// A record beside its lumped chain: nothing differs if the record is a chain's, solved by CVODE; a soil that
// stiffens shows.
namespace lumped {

using post::ChainHistory;
using post::ChainParameters;
using post::CycleQuantity;

constexpr int cycles = 16, samples = 250;

// The record as reading the files of a bed's run gives it.
post::Record bed_record(const ChainParameters &p, const ChainHistory &history) {
  post::Record record = post::chain_record(p, history);
  record.file = "bed.csv";
  record.known_origin = false; // where the drum touches the soil is not known
  record.parameters = {{"k23", "1e6"}, {"c23", "1e4"}, {"Fw", std::to_string(p.Fw)}, {"transition", "B"}};
  return record;
}

post::LumpedComparison compared(const post::Record &record) {
  return post::compare_lumped(record, post::identify_record(record, {}));
}

// Drum and frame on a soil of any force law, by the classical Runge-Kutta method with small steps.
ChainHistory on_soil(const ChainParameters &p, const std::function<double(double, double)> &law) {
  using State = std::array<double, 4>; // x2, v2, x3, v3
  const auto contact = [&](const State &y) { return y[0] < 0.0 ? std::max(0.0, law(-y[0], -y[1])) : 0.0; };
  const auto rate = [&](double t, const State &y) -> State {
    const double bond = p.c23 * (y[3] - y[1]) + p.k23 * (y[2] - y[0]), push = p.Fw * std::sin(p.omega * t);
    return {y[1], (contact(y) + bond - push) / p.m2 - p.g, y[3], -bond / p.m3 - p.g};
  };
  const auto plus = [](State y, double h, const State &r) {
    for (std::size_t i = 0; i < y.size(); ++i)
      y[i] += h * r[i];
    return y;
  };
  constexpr int steps = 40; // per sample
  const double h = p.period() / samples / steps;
  State y = {-1e-3, 0.0, -1e-3 - p.m3 * p.g / p.k23, 0.0};
  ChainHistory history;
  double t = 0.0;
  for (int i = 0; i <= cycles * samples; ++i) {
    const State r = rate(t, y);
    history.time.push_back(t);
    history.x_drum.push_back(y[0]);
    history.v_drum.push_back(y[1]);
    history.a_drum.push_back(r[1]);
    history.x_frame.push_back(y[2]);
    history.v_frame.push_back(y[3]);
    history.a_frame.push_back(r[3]);
    history.F_contact.push_back(contact(y));
    history.F_excitation.push_back(p.Fw * std::sin(p.omega * t));
    for (int step = 0; step < steps; ++step, t += h) {
      const State k1 = rate(t, y), k2 = rate(t + h / 2, plus(y, h / 2, k1)),
                  k3 = rate(t + h / 2, plus(y, h / 2, k2)), k4 = rate(t + h, plus(y, h, k3));
      for (std::size_t j = 0; j < y.size(); ++j)
        y[j] += h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]);
    }
  }
  return history;
}

TEST(LumpedComparison, OfAChainsRecordDiffersInNothing) {
  for (const char *name : {"I", "III"}) { // contact is kept, and lost
    const ChainParameters p = post::table1_case(name, post::Transition::B);
    post::ExactOptions options;
    options.cycles = cycles;
    options.samples_per_cycle = samples;
    post::Record record = bed_record(p, drumlin::test::solve_by_cvode(p, options).history);
    // Where contact is lost the drum sinks a little in each cycle, and the soil with it.
    const double sinking = std::string(name) == "III" ? 5e-5 : 0.0;
    for (std::size_t i = 0; i < record.size(); ++i) {
      record.x_drum[i] -= sinking * record.time[i] / p.period();
      record.v_drum[i] -= sinking / p.period();
    }
    const post::LumpedComparison found = compared(record);
    EXPECT_NEAR(found.chain.k / p.k, 1.0, 0.03) << name;
    EXPECT_GT(found.r2, 0.99) << name;
    EXPECT_NEAR(found.settlement, sinking, 2e-5) << name;
    for (const CycleQuantity quantity :
         {CycleQuantity::acceleration, CycleQuantity::force, CycleQuantity::contact, CycleQuantity::cmv}) {
      const post::ComparedQuantity &one = found.of(quantity);
      EXPECT_NEAR(one.record.mean, one.lumped, 0.05 * one.lumped + 1.0) << name;
      EXPECT_FALSE(found.differs(quantity)) << name << ", " << static_cast<int>(quantity);
    }
    // Both lie on one line of force over position.
    const double peak = found.of(CycleQuantity::force).lumped;
    for (std::size_t i = found.record.size() - samples; i < found.record.size(); ++i) {
      const double force = found.record.F_contact[i];
      if (force < 0.3 * peak) continue;
      const double of_law = -found.chain.k * found.position[i] -
                            found.chain.damping() * (found.record.v_drum[i] + sinking / p.period());
      EXPECT_NEAR(force, of_law, 0.05 * peak) << name;
    }
  }
}

TEST(LumpedComparison, ShowsThatASoilStiffens) {
  // A soil that stiffens: its force grows with the third power of the drum's depth.
  const ChainParameters p = post::table1_case("II", post::Transition::B);
  const auto stiffening = [](double depth, double rate) { return 4e11 * depth * depth * depth + 5e4 * rate; };
  const ChainHistory history = on_soil(p, stiffening);
  const post::LumpedComparison found = compared(bed_record(p, history));
  std::size_t differences = 0;
  for (const CycleQuantity quantity : post::cycle_quantities)
    if (found.differs(quantity)) ++differences;
  EXPECT_GE(differences, 2u);
  EXPECT_LT(found.r2, 0.995);
  EXPECT_TRUE(contains(post::lumped_answer({found}).front(), "Against the chain"));
  const int counted = cycles - cycles / 2;
  double peaks = 0.0; // mean of the second half of the cycles
  for (int cycle = cycles / 2; cycle < cycles; ++cycle) {
    const auto begin = history.F_contact.begin() + cycle * samples;
    peaks += *std::max_element(begin, begin + samples + 1) / counted;
  }
  EXPECT_NEAR(found.of(CycleQuantity::force).record.mean, peaks, 1e-6 * peaks);

  // The same integration of a linear soil differs in nothing: the differences above are not those of the two
  // solvers.
  const ChainParameters linear = post::table1_case("III", post::Transition::B);
  const auto spring = [&linear](double depth, double rate) {
    return linear.k * depth + linear.damping() * rate;
  };
  const post::LumpedComparison same = compared(bed_record(linear, on_soil(linear, spring)));
  for (const CycleQuantity quantity : post::cycle_quantities)
    EXPECT_FALSE(same.differs(quantity)) << static_cast<int>(quantity);
}

TEST(LumpedComparison, OfSeveralRecordsHasTheScatterOverThem) {
  std::vector<post::LumpedComparison> records(3);
  const auto force = static_cast<std::size_t>(CycleQuantity::force);
  for (std::size_t i = 0; i < records.size(); ++i)
    for (std::size_t q = 0; q < post::cycle_quantities.size(); ++q) {
      const double difference = q == force ? 10.0 + static_cast<double>(i) : static_cast<double>(i) - 1.0;
      records[i].quantities[q] = {{100.0 + difference, 90.0}, 100.0, {difference, 90.0}};
    }
  // In contact that is never lost the chain's CMV is a rounding error, of which no difference is told in per
  // cent.
  const auto cmv = static_cast<std::size_t>(CycleQuantity::cmv);
  for (std::size_t i = 0; i < records.size(); ++i)
    records[i].quantities[cmv] = {
        {20.0 + static_cast<double>(i), 90.0}, 1e-12, {20.0 + static_cast<double>(i), 90.0}};
  const std::vector<std::string> lines = post::lumped_answer(records);
  // The three differences have the mean 11 and the standard deviation 1. Half of the 95 % confidence interval
  // of their mean is t/sqrt(3), with Student's t = 4.303 for two degrees of freedom.
  EXPECT_TRUE(contains(lines.front(), "the peak contact force of the record is larger by 11 ± 2.5 %"));
  EXPECT_TRUE(contains(lines[1], "CMV of the record is larger by 21 ± 2.5, probably"));
  EXPECT_TRUE(contains(lines[2], "No difference beyond scatter: the drum's peak acceleration"));
}

TEST(LumpedComparison, RefusesARecordThatItCannotCompare) {
  const ChainParameters p = post::table1_case("I", post::Transition::B);
  post::ExactOptions options;
  options.cycles = 10;
  const post::Record record = bed_record(p, drumlin::test::solve_by_cvode(p, options).history);
  const post::IdentifiedRecord found = post::identify_record(record, {});
  EXPECT_EQ(post::compare_lumped(record, found).first,
            4u); // an even number of cycles counts, half of them or more
  const auto expect_refused = [](const post::Record &bad, const post::IdentifiedRecord &law,
                                 const std::string &message) {
    const std::string error = error_of([&] { post::compare_lumped(bad, law); });
    EXPECT_TRUE(contains(error, message));
    EXPECT_FALSE(contains(error, "\n"));
  };
  post::Record bad = record;
  bad.parameters.erase("k23");
  expect_refused(bad, found, "k23 is ''; allowed: a number in parameters.csv");
  bad = record;
  bad.parameters["c23"] = "soft";
  expect_refused(bad, found, "c23 is 'soft'; allowed: a number");
  bad = record;
  bad.a_drum.clear();
  expect_refused(bad, found, "allowed: one with a_drum, F_contact and F_excitation");
  post::IdentifiedRecord none = found;
  none.whole.law.D.mean = -0.1;
  expect_refused(record, none, "allowed: a record in which identification finds both above zero");
}

} // namespace lumped

} // namespace
} // namespace drumlin::test
