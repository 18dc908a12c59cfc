// The chain in the engine, its energy balance, and fix drum/excite.
#include "tests/support/chain_by_cvode.h"
#include "tests/support/engine_runs.h"
#include "chain/analysis.h"
#include "chain/exact_solution.h"

namespace drumlin::test {
namespace {

// The chain of in.chain in the engine against CVODE: the four cases under A and B, the order of
// the stepping, the equilibrium that it starts from, and Eq. (1) in every recorded row.
namespace chain {

namespace fs = std::filesystem;

using post::ChainHistory;
using post::ChainParameters;
using post::Transition;

constexpr int cycles = 30; // of run_chain()

struct Case {
  const char *name;
  Transition transition;
  ChainParameters parameters() const { return post::table1_case(name, transition); }
};

void PrintTo(const Case &value, std::ostream *out) {
  *out << value.name << post::transition_name(value.transition);
}

std::string case_name(const ::testing::TestParamInfo<Case> &info) {
  return info.param.name + post::transition_name(info.param.transition);
}

post::ExactSolution reference_of(const ChainParameters &parameters, int samples_per_cycle,
                                 int number_of_cycles = cycles) {
  post::ExactOptions options;
  options.cycles = number_of_cycles;
  options.samples_per_cycle = samples_per_cycle;
  return drumlin::test::solve_by_cvode(parameters, options);
}

/// Relative RMS error of the drum's velocity over the last five cycles.
double velocity_error(const ChainHistory &run, const ChainHistory &reference) {
  if (run.size() != reference.size()) return std::numeric_limits<double>::infinity();
  const std::size_t rows = reference.size() - 1;
  return post::relative_rms(run.v_drum, reference.v_drum, rows * (cycles - 5) / cycles, rows + 1);
}

class Chain : public ::testing::TestWithParam<Case> {};

TEST_P(Chain, FollowsTheDirectSolver) {
  const ChainParameters p = GetParam().parameters();
  constexpr int steps = 2000;
  constexpr int samples = 200;
  const ChainRun run = run_chain(GetParam().name, p.transition, steps, samples);
  const post::ExactSolution reference = reference_of(p, samples);
  const double error = velocity_error(run.history, reference.history);
  RecordProperty("error", number(error));
  EXPECT_LT(error, 5e-3);

  const double step = p.period() / steps;
  ASSERT_EQ(run.events.size(), reference.events.size());
  for (std::size_t i = 0; i < reference.events.size(); ++i) {
    EXPECT_EQ(run.events[i].make, reference.events[i].make) << "event " << i;
    EXPECT_NEAR(run.events[i].time, reference.events[i].time, 2 * step) << "event " << i;
    EXPECT_EQ(run.events[i].id_i, 1);
    EXPECT_EQ(run.events[i].id_j, 2);
  }
  // The events alternate, and a contact ends under B with zero force, under A in tension at d = 0.
  for (std::size_t i = 0; i < run.events.size(); ++i) {
    const post::ContactEvent &event = run.events[i];
    EXPECT_EQ(event.make, i % 2 == 1) << "the chain starts in contact";
    if (event.make) continue;
    if (p.transition == Transition::B)
      EXPECT_NEAR(p.k * event.overlap + p.damping() * event.overlap_rate, 0, 1e-6 * (p.m2 + p.m3) * p.g);
    else
      EXPECT_LT(event.force, 0);
  }
}

// The bond's dashpot is up to 1e5 times that of the soil, and its time constant 1/40 of the time step.
TEST(ChainWithAnOverdampedBond, FollowsTheDirectSolver) {
  ChainParameters p = post::table1_case("II", Transition::B);
  for (const double c23 : {1e8, 1e9, 1e10}) {
    p.c23 = c23;
    const ChainRun run = run_chain("II", Transition::B, 2000, 200, given("c23 {}, stepping second", c23));
    EXPECT_LT(velocity_error(run.history, reference_of(p, 200).history), 1e-3) << c23;
  }
}

TEST_P(Chain, StartsFromStaticEquilibrium) {
  const ChainParameters p = GetParam().parameters();
  const ChainHistory h = run_chain(GetParam().name, p.transition, 200, 200, {{"cycles", "1"}}).history;
  const double sinking = (p.m2 + p.m3) * p.g / p.k;
  const double weight = (p.m2 + p.m3) * p.g;
  EXPECT_EQ(h.time.front(), 0);
  EXPECT_NEAR(h.x_drum.front(), -sinking, 1e-9 * sinking);
  EXPECT_NEAR(h.x_frame.front() - h.x_drum.front(), -p.m3 * p.g / p.k23, 1e-9 * p.m3 * p.g / p.k23);
  EXPECT_NEAR(h.F_contact.front(), weight, 1e-9 * weight);
  EXPECT_NEAR(h.F_bond.front(), -p.m3 * p.g, 1e-9 * weight);
  EXPECT_EQ(h.F_excitation.front(), 0);
  EXPECT_NEAR(h.a_drum.front(), 0, 1e-9 * p.g);
  EXPECT_NEAR(h.a_frame.front(), 0, 1e-9 * p.g);
  EXPECT_NEAR(h.v_drum.front(), 0, 1e-8 * p.g / p.omega);
  EXPECT_NEAR(h.v_frame.front(), 0, 1e-8 * p.g / p.omega);
}

// Every row has the right-hand sides of Eq. (1) at its own time, position and velocity, and the acceleration
// that the engine's velocities show. The engine steps with the dashpots at the half-step velocity, v - a
// dt/2: its velocities follow an acceleration that is off by about C/m dt/2 a, C the sum of the dashpots.
TEST_P(Chain, RecordsEquationOneInEveryRow) {
  const ChainParameters p = GetParam().parameters();
  constexpr int steps = 2000;
  const ChainRun run = run_chain(GetParam().name, p.transition, steps, steps, {{"cycles", "6"}});
  const ChainHistory &h = run.history;
  ASSERT_EQ(h.size(), 6u * steps + 1);
  const double dt = p.period() / steps;
  const auto largest = [](const std::vector<double> &values) {
    double result = 0;
    for (const double value : values)
      result = std::max(result, std::fabs(value));
    return result;
  };
  const double F_scale = largest(h.F_contact);
  const double a_scale = largest(h.a_drum);
  const double frame_scale = p.g + largest(h.a_frame);
  std::vector<bool> near_event(h.size(), false);
  for (const post::ContactEvent &event : run.events)
    for (long n = std::lround(event.time / dt) - 2; n <= std::lround(event.time / dt) + 2; ++n)
      if (n >= 0 && n < static_cast<long>(h.size())) near_event[static_cast<std::size_t>(n)] = true;

  double worst_row = 0, worst_drum = 0, worst_frame = 0;
  for (std::size_t n = 0; n < h.size(); ++n) {
    const double d = -h.x_drum[n];
    double contact = d > 0 ? p.k * d - p.damping() * h.v_drum[n] : 0;
    if (p.transition == Transition::B) contact = std::max(0.0, contact);
    const double bond = p.c23 * (h.v_frame[n] - h.v_drum[n]) + p.k23 * (h.x_frame[n] - h.x_drum[n]);
    const double excitation = p.Fw * std::sin(2 * pi * static_cast<double>(n) / steps);
    const double a_drum = -p.g + (contact + bond - excitation) / p.m2;
    worst_row = std::max(
        {worst_row, std::fabs(h.F_contact[n] - contact) / F_scale, std::fabs(h.F_bond[n] - bond) / F_scale,
         std::fabs(h.F_excitation[n] - excitation) / F_scale, std::fabs(h.a_drum[n] - a_drum) / a_scale,
         std::fabs(h.a_frame[n] - (-p.g - bond / p.m3)) / frame_scale,
         std::fabs(h.time[n] - static_cast<double>(n) * dt) / p.period()});
    if (n == 0 || n + 1 == h.size()) continue;
    // The row after the start sees the excitation begin; near an event the force jumps.
    const auto centred = [&](const std::vector<double> &v) { return (v[n + 1] - v[n - 1]) / (2 * dt); };
    if (!near_event[n]) worst_drum = std::max(worst_drum, std::fabs(centred(h.v_drum) - h.a_drum[n]));
    worst_frame = std::max(worst_frame, std::fabs(centred(h.v_frame) - h.a_frame[n]));
  }
  EXPECT_LT(worst_row, 1e-11);
  const double drum_lag = (p.damping() + p.c23) / p.m2 * dt / 2;
  const double frame_lag = 2 * p.c23 / p.m3 * dt / 2 * p.m3 / p.m2 * a_scale / frame_scale;
  EXPECT_LT(worst_drum / a_scale, 2 * drum_lag);
  EXPECT_LT(worst_frame / frame_scale, 2 * frame_lag + 1e-4);
  RecordProperty("worst_drum", number(worst_drum / a_scale) + " of " + number(drum_lag));
  RecordProperty("worst_frame", number(worst_frame / frame_scale) + " of " + number(frame_lag));
}

const Case all_cases[] = {{"I", Transition::A},  {"I", Transition::B},   {"II", Transition::A},
                          {"II", Transition::B}, {"III", Transition::A}, {"III", Transition::B},
                          {"IV", Transition::A}, {"IV", Transition::B}};
INSTANTIATE_TEST_SUITE_P(Table1, Chain, ::testing::ValuesIn(all_cases), case_name);

// Without loss of contact the error of the stock stepping is smooth and of first order.
class SmoothChain : public ::testing::TestWithParam<Case> {};

TEST_P(SmoothChain, ErrorIsOfFirstOrder) {
  const post::ExactSolution reference = reference_of(GetParam().parameters(), 100);
  std::vector<double> steps, errors;
  for (const int n : {500, 1000, 2000, 4000, 8000}) {
    const ChainRun run = run_chain(GetParam().name, GetParam().transition, n, 100);
    EXPECT_TRUE(run.events.empty());
    steps.push_back(n);
    errors.push_back(velocity_error(run.history, reference.history));
  }
  const double order = fitted_order(steps, errors);
  RecordProperty("order", number(order));
  RecordProperty("error_at_8000", number(errors.back()));
  EXPECT_NEAR(order, -1, 0.1);
}

const Case smooth_cases[] = {{"I", Transition::A}, {"I", Transition::B}, {"IV", Transition::A}};
INSTANTIATE_TEST_SUITE_P(Table1, SmoothChain, ::testing::ValuesIn(smooth_cases), case_name);

// A make falls anywhere within a step, so that its mis-timing, and with it the error, is anything from almost
// nothing to a bound that falls with the step. The bound is seen as the largest error over neighbouring
// numbers of steps, among which the make falls at different parts of a step. Of first order it falls to 1/9
// with nine times the steps, of order one half to 1/3; six neighbours see it to within a factor of about two,
// hence 1/4.
class ImpactingChain : public ::testing::TestWithParam<Case> {};

TEST_P(ImpactingChain, ErrorHasAnEnvelopeOfFirstOrder) {
  constexpr int samples = 20;
  const post::ExactSolution reference = reference_of(GetParam().parameters(), samples);
  const auto envelope = [&](int level) {
    double largest = 0;
    for (const int base : {480, 500, 520, 540, 560, 580}) {
      const ChainRun run = run_chain(GetParam().name, GetParam().transition, level * base, samples);
      largest = std::max(largest, velocity_error(run.history, reference.history));
    }
    return largest;
  };
  const double coarse = envelope(1), medium = envelope(3), fine = envelope(9);
  RecordProperty("envelope", number(coarse) + ", " + number(medium) + ", " + number(fine));
  EXPECT_LT(medium, coarse);
  EXPECT_LT(fine, 0.25 * coarse);
}

const Case impacting_cases[] = {{"II", Transition::A},
                                {"II", Transition::B},
                                {"III", Transition::A},
                                {"III", Transition::B},
                                {"IV", Transition::B}};
INSTANTIATE_TEST_SUITE_P(Table1, ImpactingChain, ::testing::ValuesIn(impacting_cases), case_name);

// Second-order stepping: the error bounds that are acceptance criteria, at 800 and at 6400 steps per cycle,
// the order between them, events within a twentieth of a step, and the peak force over steps and located
// makes.
struct Bound {
  Case chain;
  double at_800, at_6400;
};

void PrintTo(const Bound &value, std::ostream *out) { PrintTo(value.chain, out); }

class SecondOrderChain : public ::testing::TestWithParam<Bound> {};

TEST_P(SecondOrderChain, KeepsItsErrorBounds) {
  const Bound &bound = GetParam();
  const ChainParameters p = bound.chain.parameters();
  constexpr int samples = 200;
  const post::ExactSolution reference = reference_of(p, samples);
  std::vector<double> steps, errors;
  for (const int n : {200, 400, 800, 1600, 3200, 6400}) {
    const ChainRun run = run_chain(bound.chain.name, p.transition, n, samples, {{"stepping", "second"}});
    steps.push_back(n);
    errors.push_back(velocity_error(run.history, reference.history));
    const double step = p.period() / n;
    ASSERT_EQ(run.events.size(), reference.events.size());
    for (std::size_t i = 0; i < reference.events.size(); ++i) {
      EXPECT_EQ(run.events[i].make, reference.events[i].make) << "event " << i;
      EXPECT_NEAR(run.events[i].time, reference.events[i].time, 0.05 * step)
          << "event " << i << " of " << n << " steps";
    }
  }
  RecordProperty("errors", number(errors[2]) + ", " + number(errors.back()));
  RecordProperty("order", number(fitted_order(steps, errors)));
  EXPECT_LT(errors[2], bound.at_800);
  EXPECT_LT(errors.back(), bound.at_6400);
  EXPECT_LT(fitted_order(steps, errors), -1.8);
}

TEST_P(SecondOrderChain, FindsThePeakForce) {
  const ChainParameters p = GetParam().chain.parameters();
  constexpr int steps = 2000;
  const post::ExactSolution reference = reference_of(p, steps);
  const ChainRun run = run_chain(GetParam().chain.name, p.transition, steps, steps, {{"stepping", "second"}});
  const auto peak = [](const ChainHistory &history, const std::vector<post::ContactEvent> &events) {
    double largest = *std::max_element(history.F_contact.begin(), history.F_contact.end());
    for (const post::ContactEvent &event : events)
      largest = std::max(largest, event.force);
    return largest;
  };
  const double exact = peak(reference.history, reference.events);
  EXPECT_NEAR(peak(run.history, run.events), exact, 1e-3 * exact);
}

const Bound second_order_bounds[] = {
    {{"I", Transition::A}, 1e-5, 2e-7},    {{"I", Transition::B}, 1e-5, 2e-7},
    {{"II", Transition::A}, 1.2e-4, 2e-6}, {{"II", Transition::B}, 1.2e-4, 2e-6},
    {{"III", Transition::A}, 3e-5, 5e-7},  {{"III", Transition::B}, 3e-5, 5e-7},
    {{"IV", Transition::A}, 2e-4, 2e-6},   {{"IV", Transition::B}, 2e-4, 2e-6}};
INSTANTIATE_TEST_SUITE_P(Table1, SecondOrderChain, ::testing::ValuesIn(second_order_bounds),
                         [](const auto &row) {
                           return row.param.chain.name + post::transition_name(row.param.chain.transition);
                         });

/// A roller file of inputs/rollers with what its data sheet says, computed by hand.
struct RollerInFile {
  const char *file, *setting;
  double m2, m3, k23, c23, frequency, me_re;
};
constexpr std::array<RollerInFile, 7> rollers = {
    {{"Axas2020", "29Hz", 3962.07, 3379.4, 3.1e6, 31e3, 29, 7.31},
     {"BW120", "63Hz", 461, 895, 8.21e5, 8.21e3, 63, 0.2305},
     {"BW120", "67Hz", 461, 895, 8.21e5, 8.21e3, 67, 0.2305},
     {"CA3500", "high", 3955, 3713, 3.1e6, 31e3, 31, 7.38},
     {"CA3500", "low", 3955, 3713, 3.1e6, 31e3, 34, 3.725},
     {"CA6500", "high", 5166, 8679, 7.96e6, 7.96e4, 29, 10.84},
     {"CA6500", "low", 5166, 8679, 7.96e6, 7.96e4, 30, 4.222}}};

Variables of_file(const RollerInFile &roller) {
  return given("roller {}, setting {}",
               (fs::path(DRUMLIN_SOURCE_DIR) / "inputs/rollers" / roller.file).string(), roller.setting);
}

TEST(Rollers, OfFilesFollowTheDirectSolver) {
  constexpr int samples = 50;
  for (const RollerInFile &roller : rollers) {
    SCOPED_TRACE(std::string(roller.file) + " " + roller.setting);
    ChainParameters p = post::table1_case("II", Transition::B);
    p.m2 = roller.m2;
    p.m3 = roller.m3;
    p.k23 = roller.k23;
    p.c23 = roller.c23;
    p.omega = 2.0 * pi * roller.frequency;
    p.Fw = roller.me_re * p.omega * p.omega;
    for (const Transition transition : {Transition::A, Transition::B}) {
      p.transition = transition;
      const Variables variables = with(given("stepping second, cycles 3"), of_file(roller));
      const ChainRun run = run_chain("II", transition, 2000, samples, variables);
      const post::ExactSolution reference = reference_of(p, samples, 3);
      ASSERT_EQ(run.history.size(), reference.history.size());
      EXPECT_LT(post::relative_rms(run.history.v_drum, reference.history.v_drum, 0, reference.history.size()),
                1e-4);
      EXPECT_EQ(run.events.size(), reference.events.size());
    }
  }
}

TEST(Rollers, TheForceFollowsFromTheFrequencyUnlessItIsGiven) {
  const auto largest_force = [](const Variables &given) {
    const Variables variables = with(with({{"cycles", "1"}}, given), of_file(rollers[3]));
    const std::vector<double> force =
        run_chain("II", Transition::B, 2000, 200, variables).history.F_excitation;
    return *std::max_element(force.begin(), force.end());
  };
  EXPECT_NEAR(largest_force({{"omega", "200"}}), 7.38 * 200 * 200, 1e-3);
  EXPECT_NEAR(largest_force(given("omega 200, Fw 1e5")), 1e5, 1e-6);
}

TEST(Rollers, AreNotedWithWhatFollowsFromThem) {
  for (const bool lammps : {false, true}) {
    if (lammps && !post::has_lammps()) continue;
    const Scratch folder;
    const Outcome outcome = run_deck(chain_deck(lammps ? "in.chain.lammps" : "in.chain"),
                                     with(given("cycles 1, out ."), of_file(rollers[4])), folder.path());
    EXPECT_TRUE(printed(well(outcome), "exciter_force_per_metre  79811.3 N/m"));
    const std::map<std::string, std::string> noted = post::read_parameters(folder / "parameters.csv");
    EXPECT_EQ(noted.at("setting"), "low");
    for (const auto &[name, value] : {std::pair("frequency", 34.0),
                                      {"static_load", 36.0 * 213.0 * 9.81},
                                      {"static_load_per_metre", 3600.0 * 9.81},
                                      {"exciter_force", 3.725 * std::pow(68.0 * pi, 2)},
                                      {"nominal_amplitude", 3.725 / 3955.0},
                                      {"frame_frequency", std::sqrt(3.1e6 / 3713.0) / (2.0 * pi)}})
      EXPECT_NEAR(std::stod(noted.at(std::string("roller_") + name)) / value, 1.0, 1e-8) << name;
  }
}

// The drum reverses its motion before the gap opens: the contact of B is made again at Fc = 0 while the balls
// still overlap. A law that waits for d = 0 would let the drum fall through the soil.
TEST(ChainUnderB, ContactIsMadeAgainWhileOverlapping) {
  ChainParameters p = post::table1_case("II", Transition::B);
  p.k = 1e7;
  p.D = 0.5;
  const ChainRun run = run_chain("II", Transition::B, 2000, 200, given("k 1e7, D 0.5"));
  const post::ExactSolution reference = reference_of(p, 200);
  const auto again = [&](const std::vector<post::ContactEvent> &events) {
    return std::count_if(events.begin(), events.end(), [&](const post::ContactEvent &event) {
      return event.make && event.overlap > 0 && std::fabs(event.force) < 1e-6 * (p.m2 + p.m3) * p.g;
    });
  };
  RecordProperty("re-made", std::to_string(again(run.events)));
  EXPECT_GT(again(run.events), 0);
  EXPECT_EQ(again(run.events), again(reference.events));
  EXPECT_EQ(run.events.size(), reference.events.size());
  EXPECT_LT(velocity_error(run.history, reference.history), 5e-3);
  const double deepest = *std::min_element(reference.history.x_drum.begin(), reference.history.x_drum.end());
  for (const double x : run.history.x_drum)
    ASSERT_GT(x, 1.01 * deepest);
}

TEST(Settle, FindsAChainWithoutDampingAtRest) {
  const Scratch scratch;
  EXPECT_TRUE(printed(well(run_deck(chain_deck("in.chain"), given("D 0, c23 0, cycles 1"), scratch.path())),
                      "after 0 steps"));
}

// Two exciters of other frequencies: the record has the sum of their forces, with which the motion obeys
// Newton's law between rows, and their work.
TEST(TwoExciters, GiveTheSumOfTheirForcesAndTheirWork) {
  std::string deck = read_text(chain_deck("in.chain"));
  const auto put = [&deck](const std::string &before, const std::string &text) {
    deck.insert(deck.find(before), text);
  };
  put("fix             events all", "fix second drum drum/excite amplitude 2e4 omega 200 direction 0 0 -1\n");
  put("bond bond axis 0 0", "excite second ");
  const Scratch scratch;
  std::ofstream(scratch / "two.in") << deck;
  well(run_deck(scratch / "two.in", given("here {}, cycles 20, out .", chain_deck("").parent_path().string()),
                scratch.path()));
  const ChainHistory run = post::read_chain(scratch / "chain.csv");
  const double omega = post::table1_case("II", Transition::B).omega;
  for (std::size_t i = 0; i < run.size(); ++i)
    EXPECT_NEAR(run.F_excitation[i],
                58.8e3 * std::sin(omega * run.time[i]) + 2e4 * std::sin(200.0 * run.time[i]), 1e-6);
  // The mean of the recorded accelerations over two intervals is the change of velocity over them; of 200
  // rows a cycle those with a landing between them differ.
  double left = 0.0, all = 0.0;
  for (std::size_t i = 1; i + 1 < run.size(); ++i) {
    const double rate = (run.v_drum[i + 1] - run.v_drum[i - 1]) / (run.time[i + 1] - run.time[i - 1]);
    const double mean = (run.a_drum[i - 1] + 4.0 * run.a_drum[i] + run.a_drum[i + 1]) / 6.0;
    left += std::fabs(rate - mean);
    all += std::fabs(rate);
  }
  EXPECT_LT(left, 0.01 * all);
  const post::Table sums = post::read_table(scratch / "cycles.csv");
  const auto change = [&](const char *column) {
    return sums.numbers(column).back() - sums.numbers(column).front();
  };
  const double work = change("work_excitation");
  double balance = -work;
  for (const char *column :
       {"dissipated_contact", "dissipated_bond", "kinetic", "potential", "stored_contact", "stored_bond"})
    balance += change(column);
  EXPECT_NEAR(balance, 0.0, 1e-4 * work);
}

// The dashpot alone stops the drum within a small part of a step.
TEST(HeavyDamping, SecondOrderSteppingFollowsTheDirectSolver) {
  ChainParameters p = post::table1_case("II", Transition::B);
  p.D = 1e4;
  const ChainHistory reference = reference_of(p, 50, 3).history;
  for (const int steps : {400, 4000}) {
    const ChainHistory run =
        run_chain("II", Transition::B, steps, 50, given("D 1e4, cycles 3, stepping second")).history;
    EXPECT_LT(post::relative_rms(run.v_drum, reference.v_drum, 0, reference.size()),
              steps == 400 ? 0.1 : 5e-3);
  }
}

TEST(HeavyDamping, OfTheBondFollowsTheDirectSolverToo) {
  ChainParameters p = post::table1_case("IV", Transition::B);
  p.c23 = 1e7;
  const ChainHistory reference = reference_of(p, 50, 3).history;
  std::vector<double> all_steps, errors;
  for (const int steps : {200, 800, 1600, 3200}) {
    const ChainHistory run =
        run_chain("IV", Transition::B, steps, 50, given("c23 1e7, cycles 3, stepping second")).history;
    const double error = post::relative_rms(run.v_drum, reference.v_drum, 0, reference.size());
    EXPECT_LT(error, 1e-3) << steps;
    if (steps == 200)
      continue; // dt c23 / m_eff = 1.9: solved for together; from 800 steps on, 0.47, the bond alone
    all_steps.push_back(steps);
    errors.push_back(error);
  }
  EXPECT_LT(fitted_order(all_steps, errors), -1.8);
}

// Contact and bond share the drum and are heavily damped: if their dashpots were solved for one by one, they
// would excite each other.
TEST(HeavyDamping, LongStepsLeaveAChainAtRestAtRest) {
  const ChainParameters p = post::table1_case("II", Transition::B);
  const double static_overlap = (p.m2 + p.m3) * p.g / p.k;
  for (const char *D : {"0", "2", "100", "1e4"})
    for (const char *c23 : {"0", "1e4", "1e8"}) {
      const ChainHistory h =
          run_chain("II", Transition::A, 725, 5,
                    given("D {}, c23 {}, Fw 0, omega 1, cycles 20, stepping second", D, c23))
              .history;
      for (const double x : h.x_drum)
        ASSERT_NEAR(x, -static_overlap, 1e-9 * static_overlap) << "D = " << D << ", c23 = " << c23;
    }
}

/// Eight balls, w0 dt from 0.7 to `highest`, each pushed by 1e-6 m between walls.
void expect_rest_between_walls(const std::filesystem::path &deck, const Scratch &scratch, const char *D,
                               const char *scene = "two", const char *highest = "1.4") {
  well(run_deck(deck, given("scene {}, D {}, balls 8, lowest 0.7, highest {}, half 2000", scene, D, highest),
                scratch.path()));
  const std::string looks = read_text(scratch / "looks.dump");
  std::istringstream last(looks.substr(looks.rfind("ITEM: ATOMS id x z \n")));
  std::string header;
  std::getline(last, header);
  int balls = 0;
  for (double id = 0, x = 0, z = 0; last >> id >> x >> z; ++balls)
    EXPECT_LT(std::fabs(z), 1e-6) << "ball " << id << ", D = " << D;
  EXPECT_EQ(balls, 8);
}

// Heavily damped contacts that share a particle, all with walls: no contact between balls shows that they are
// heavily damped.
TEST(HeavyDamping, BetweenWallsIsStableUpToTheLimitOfTheSprings) {
  const std::filesystem::path study = std::filesystem::path(DRUMLIN_SOURCE_DIR) / "inputs/study";
  for (const char *D : {"2", "100"}) {
    const Scratch planes, meshes;
    expect_rest_between_walls(study / "in.stability", planes, D);
    std::filesystem::copy(study, meshes / "study");
    std::ofstream(meshes / "strip.stl") // within the box
        << "solid strip\n"
           "facet normal 0 0 1\nouter loop\nvertex -1.9 -0.9 0\nvertex 1.9 -0.9 0\nvertex 1.9 15.9 "
           "0\nendloop\nendfacet\n"
           "facet normal 0 0 1\nouter loop\nvertex -1.9 -0.9 0\nvertex 1.9 15.9 0\nvertex -1.9 15.9 "
           "0\nendloop\nendfacet\n"
           "endsolid strip\n";
    std::ofstream walls(meshes / "study/confined.two");
    walls << "fix below all mesh/surface file ${out}/strip.stl type 1 move 0 0 -0.4\n"
             "fix above all mesh/surface file ${out}/strip.stl type 1 move 0 0 0.4\n"
             "fix walls all wall/gran model hooke/transition mesh n_meshes 2 meshes below above transition A "
             "damping ratio stepping ${stepping}\n";
    walls.close();
    expect_rest_between_walls(meshes / "study/in.stability", meshes, D);
  }
}

// Four dashpots along one line, light and heavy: solved for one by one they would drive each other.
TEST(HeavyDamping, BetweenFourWallsIsStableUpToTheLimitOfTheSprings) {
  for (const char *D : {"0.1", "0.3", "2"}) {
    const Scratch folder;
    expect_rest_between_walls(std::filesystem::path(DRUMLIN_SOURCE_DIR) / "inputs/study/in.stability", folder,
                              D, "four", "0.98");
  }
}

TEST(Settle, NamesASceneThatNeverSettles) {
  const Scratch scratch;
  // So soft that the drum starts from a first touch, not from its equilibrium.
  const Outcome outcome = run_deck(
      chain_deck("in.chain"), given("D 0, c23 0, k 5.8e4, guard off, settle_limit 50000"), scratch.path());
  EXPECT_EQ(outcome.status, 1);
  EXPECT_FALSE(outcome.timed_out);
  EXPECT_TRUE(printed(outcome, {"ERROR: drumlin/settle: unbalanced ratio is '", "after 50000 steps"}));
}

} // namespace chain

// The energy balance of the chain: the work of the exciter is the energy dissipated in contact and bond plus
// the change of the mechanical energy. The energy error is that of the integration scheme, which falls with
// the step.
namespace energy_balance {

using post::ChainHistory;
using post::ChainParameters;
using post::Transition;

/// Sums over the run, J.
struct EnergyBalance {
  double work = 0, contact = 0, bond = 0, stored = 0;
  double error() const { return (work - contact - bond - stored) / work; }
};

EnergyBalance balance_of(const post::Table &table) {
  const auto last = [&](const char *column) { return table.numbers(column).back(); };
  EnergyBalance balance{last("work_excitation"), last("dissipated_contact"), last("dissipated_bond"), 0};
  for (const char *column : {"kinetic", "potential", "stored_contact", "stored_bond"})
    balance.stored += last(column) - table.numbers(column).front();
  return balance;
}

/// The same from the rows of chain.csv by the trapezoid rule, from Eq. (1) alone.
EnergyBalance balance_of(const ChainHistory &h, const ChainParameters &p) {
  EnergyBalance balance;
  const auto energy = [&](std::size_t n) {
    const double stretch = h.x_frame[n] - h.x_drum[n];
    const double overlap = std::max(0.0, -h.x_drum[n]);
    return 0.5 * (p.m2 * h.v_drum[n] * h.v_drum[n] + p.m3 * h.v_frame[n] * h.v_frame[n] +
                  p.k * overlap * overlap + p.k23 * stretch * stretch) +
           p.g * (p.m2 * h.x_drum[n] + p.m3 * h.x_frame[n]);
  };
  for (std::size_t n = 0; n + 1 < h.size(); ++n) {
    const double half = 0.5 * (h.time[n + 1] - h.time[n]);
    for (const std::size_t end : {n, n + 1}) {
      const double overlap = std::max(0.0, -h.x_drum[end]);
      const double rate = h.v_frame[end] - h.v_drum[end];
      balance.work -= half * h.F_excitation[end] * h.v_drum[end];
      // The contact takes Fc d', its spring k d d' of it.
      balance.contact += half * (p.k * overlap - h.F_contact[end]) * h.v_drum[end];
      balance.bond += half * p.c23 * rate * rate;
    }
  }
  balance.stored = energy(h.size() - 1) - energy(0);
  return balance;
}

struct Recorded {
  EnergyBalance balance;
  ChainHistory history;
};

Recorded run(const std::string &name, Transition transition, int steps, int samples, int cycles) {
  const Scratch scratch;
  well(run_deck(
      chain_deck("in.chain"),
      given("case {}, transition {}, stepping stock, steps_per_cycle {}, samples_per_cycle {}, cycles {}",
            name, post::transition_name(transition), steps, samples, cycles),
      scratch.path()));
  return {balance_of(post::read_table(scratch / "cycles.csv")), post::read_chain(scratch / "chain.csv")};
}

class Energy : public ::testing::TestWithParam<std::string> {};

// The file's sums are those of its rows: by their own trapezoids, and to rounding.
TEST_P(Energy, SumsAreThoseOfTheRows) {
  for (const Transition transition : {Transition::A, Transition::B}) {
    const ChainParameters p = post::table1_case(GetParam(), transition);
    const Recorded recorded = run(GetParam(), transition, 1000, 1000, 8);
    const EnergyBalance expected = balance_of(recorded.history, p);
    const EnergyBalance &found = recorded.balance;
    EXPECT_NEAR(found.work, expected.work, 1e-9 * expected.work);
    EXPECT_NEAR(found.contact, expected.contact, 1e-9 * expected.work);
    EXPECT_NEAR(found.bond, expected.bond, 1e-9 * expected.work);
    EXPECT_NEAR(found.stored, expected.stored, 1e-9 * expected.work);
    EXPECT_GT(found.contact, 0.1 * found.work);
    EXPECT_GT(found.bond, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Table1, Energy, ::testing::Values("I", "II", "III", "IV"),
                         [](const auto &test) { return test.param; });

TEST(EnergyOfASmoothChain, ErrorIsOfFirstOrder) {
  for (const auto &[name, transition] : {std::pair{"I", Transition::A}, std::pair{"IV", Transition::A}}) {
    std::vector<double> steps, errors;
    for (const int n : {500, 1000, 2000, 4000}) {
      steps.push_back(n);
      errors.push_back(std::fabs(run(name, transition, n, 10, 20).balance.error()));
    }
    RecordProperty(std::string("order_") + name, number(fitted_order(steps, errors)));
    RecordProperty(std::string("error_at_4000_") + name, number(errors.back()));
    EXPECT_NEAR(fitted_order(steps, errors), -1, 0.1) << name;
    EXPECT_LT(errors.back(), 2e-3) << name;
  }
}

// The energy of a spring that breaks is heat from then on.
TEST(EnergyOfAChain, WhoseBondBreaksIsKept) {
  const Scratch scratch;
  std::string deck = post::read_text(chain_deck("in.chain"));
  const std::string length = "length $(v_r2+v_r3)";
  deck.replace(deck.find(length), length.size(), length + " strength 1.5e4");
  post::write_files({{scratch / "deck", deck}});
  const Outcome outcome =
      run_deck(scratch / "deck", given("here {}, case II, transition B, cycles 6", chain_deck("").string()),
               scratch.path());
  well(outcome);
  EXPECT_TRUE(contains(outcome.output, "the bond of balls 2 and 3 broke at step "));
  const EnergyBalance balance = balance_of(post::read_table(scratch / "cycles.csv"));
  EXPECT_GT(balance.bond, 200.0); // of them 51 J in the spring
  EXPECT_NEAR(balance.error(), 0.0, 1e-4);
}

// A make falls anywhere within a step, and the energy error depends on where. The measure is its largest
// value over neighbouring numbers of steps.
TEST(EnergyOfAnImpactingChain, ErrorHasAnEnvelopeOfFirstOrder) {
  for (const auto &[name, transition] : {std::pair{"II", Transition::A}, std::pair{"II", Transition::B},
                                         std::pair{"III", Transition::B}, std::pair{"IV", Transition::B}}) {
    const auto envelope = [&, n = name, t = transition](int level) {
      double largest = 0;
      for (const int base : {480, 510, 540, 570})
        largest = std::max(largest, std::fabs(run(n, t, level * base, 10, 20).balance.error()));
      return largest;
    };
    const double coarse = envelope(1), fine = envelope(4);
    RecordProperty(std::string("envelope_") + name + post::transition_name(transition),
                   number(coarse) + ", " + number(fine));
    EXPECT_LT(fine, 0.4 * coarse) << name << post::transition_name(transition);
    EXPECT_LT(fine, 1e-2) << name << post::transition_name(transition);
  }
}

} // namespace energy_balance

// Free balls under fix drum/excite: velocity and position against fine quadrature of the force that the
// documentation gives, computed here independently.
namespace excite {

using Vector = std::array<double, 3>;

struct Drive {
  const char *name;
  std::string words;
  std::function<Vector(double)> force; // N, at time t in s
};

void PrintTo(const Drive &value, std::ostream *out) { *out << value.words; }

constexpr double Fw = 5e4, w = 150.0;

Vector along(const Vector &n, double F) { return {n[0] * F, n[1] * F, n[2] * F}; }
constexpr Vector up{0, 0, 1};

/// Linear growth from w to w2 within T: angle, frequency.
double swept_angle(double w2, double T, double s) {
  return s < T ? w * s + (w2 - w) * s * s / (2 * T) : (w + w2) / 2 * T + w2 * (s - T);
}
double swept_frequency(double w2, double T, double s) { return s < T ? w + (w2 - w) * s / T : w2; }

const Drive drives[] = {
    {"directed", "amplitude 5e4 omega 150 direction 0 0 1",
     [](double t) { return along(up, Fw * std::sin(w * t)); }},
    {"gravity", "amplitude 5e4 omega 150", [](double t) { return along(up, -Fw * std::sin(w * t)); }},
    {"oblique", "amplitude 5e4 omega 150 direction 3 0 -4",
     [](double t) {
       return along({0.6, 0, -0.8}, Fw * std::sin(w * t));
     }},
    {"frequency", "amplitude 5e4 frequency 23.873241463784300 direction 0 0 1",
     [](double t) { return along(up, Fw * std::sin(w * t)); }},
    {"phase", "phase 0.7 amplitude 5e4 omega 150 direction 0 0 1",
     [](double t) { return along(up, Fw * std::sin(w * t + 0.7)); }},
    {"start", "amplitude 5e4 omega 150 start 0.02 direction 0 0 1",
     [](double t) { return along(up, t < 0.02 ? 0 : Fw * std::sin(w * (t - 0.02))); }},
    {"ramp", "amplitude 5e4 omega 150 ramp 0.05 phase 1 direction 0 0 1",
     [](double t) { return along(up, std::min(1.0, t / 0.05) * Fw * std::sin(w * t + 1)); }},
    {"sweep", "amplitude 5e4 omega 150 sweep 400 0.08 direction 0 0 1",
     [](double t) { return along(up, Fw * std::sin(swept_angle(400, 0.08, t))); }},
    {"eccentric", "eccentric 2.5 0.04 omega 150 direction 0 0 1",
     [](double t) { return along(up, 2.5 * 0.04 * w * w * std::sin(w * t)); }},
    {"eccentric_sweep", "eccentric 2.5 0.04 omega 150 sweep 50 0.06 start 0.01 ramp 0.02 direction 0 0 1",
     [](double t) {
       const double s = std::max(0.0, t - 0.01);
       const double v = swept_frequency(50, 0.06, s);
       return along(up, std::min(1.0, s / 0.02) * 2.5 * 0.04 * v * v * std::sin(swept_angle(50, 0.06, s)));
     }},
    {"rotating", "amplitude 5e4 omega 150 direction 0 0 -1 mode rotating axis 0 1 0",
     // Axis x direction is (0,1,0) x (0,0,-1) = (-1,0,0).
     [](double t) {
       return Vector{-Fw * std::cos(w * t), 0, -Fw * std::sin(w * t)};
     }},
};

class Excitation : public ::testing::TestWithParam<Drive> {};

TEST_P(Excitation, MovesAFreeBallByItsIntegral) {
  constexpr double dt = 2e-5, mass = 2000, g = 9.81;
  constexpr int steps = 6000; // nearly three cycles
  const bool falls = std::string(GetParam().name) == "gravity";
  const BallsRun run =
      run_balls(given("obstacle plane, gap 0.5, fixed 3, g {}, excitation {}, dt {}, steps {}, every 10",
                      falls ? "9.81" : "0", GetParam().words, dt, steps));
  ASSERT_EQ(run.frames.size(), steps / 10 + 1u);
  // v by Simpson's rule over fine panels, x by the same of v: x(t + h) = x + h v + integral of (h - s) a(s).
  constexpr int panels = 20; // within ten steps
  const double h = 10 * dt / panels;
  Vector v{}, x{}, largest_v{}, largest_x{}, error_v{}, error_x{}, error_f{};
  const Ball start = run.frames.front().balls.at(1);
  for (std::size_t n = 0; n < run.frames.size(); ++n) {
    const double t = 10 * dt * static_cast<double>(n);
    const Ball &ball = run.frames[n].balls.at(1);
    const Vector exact_force = GetParam().force(t);
    for (std::size_t a = 0; a < 3; ++a) {
      error_v[a] = std::max(error_v[a], std::fabs(ball.v[a] - v[a]));
      error_x[a] = std::max(error_x[a], std::fabs(ball.x[a] - start.x[a] - x[a]));
      const double weight = falls && a == 2 ? -mass * g : 0;
      error_f[a] = std::max(error_f[a], std::fabs(ball.f[a] - exact_force[a] - weight));
      largest_v[a] = std::max(largest_v[a], std::fabs(v[a]));
      largest_x[a] = std::max(largest_x[a], std::fabs(x[a]));
    }
    for (int panel = 0; panel < panels; ++panel) {
      const double begin = t + panel * h;
      const Vector f0 = GetParam().force(begin), f1 = GetParam().force(begin + h / 2),
                   f2 = GetParam().force(begin + h);
      for (std::size_t a = 0; a < 3; ++a) {
        const double weight = falls && a == 2 ? -mass * g : 0;
        x[a] += h * v[a] + h * h / 6 * (f0[a] + 2 * f1[a] + 3 * weight) / mass;
        v[a] += h / 6 * (f0[a] + 4 * f1[a] + f2[a] + 6 * weight) / mass;
      }
    }
  }
  // The engine's own quadrature is the trapezoid rule: (w dt)^2 / 12 of the force, less where the force has a
  // kink.
  const double scale_v = std::max({largest_v[0], largest_v[1], largest_v[2]});
  const double scale_x = std::max({largest_x[0], largest_x[1], largest_x[2]});
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_LT(error_f[a], 1e-9 * Fw) << "axis " << a;
    EXPECT_LT(error_v[a], 2e-5 * scale_v) << "axis " << a;
    EXPECT_LT(error_x[a], 2e-5 * scale_x) << "axis " << a;
  }
}

INSTANTIATE_TEST_SUITE_P(Words, Excitation, ::testing::ValuesIn(drives),
                         [](const auto &test) { return std::string(test.param.name); });

TEST(ExcitationOfAGroup, IsSharedByMass) {
  constexpr double m1 = 300, m2 = 4700;
  const BallsRun run =
      run_balls(given("gap 0.5, fixed 3, driven 1 2, m1 {}, m2 {}, excitation amplitude 5e4 omega 150 "
                      "direction 1 0 1 mode rotating axis 0 1 0, dt 1e-4, steps 500",
                      m1, m2));
  double largest = 0;
  for (const Frame &frame : run.frames) {
    const Ball &one = frame.balls.at(1), &two = frame.balls.at(2);
    double size = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      ASSERT_NEAR(one.f[a] / m1, two.f[a] / m2, 1e-12 * Fw / (m1 + m2));
      ASSERT_NEAR(one.v[a], two.v[a], 1e-12);
      size += (one.f[a] + two.f[a]) * (one.f[a] + two.f[a]);
      largest = std::max(largest, std::fabs(one.v[a]));
    }
    ASSERT_NEAR(std::sqrt(size), Fw, 1e-9 * Fw) << "a rotating force has one size";
  }
  EXPECT_GT(largest, Fw / (m1 + m2) / w);
}

} // namespace excite

} // namespace
} // namespace drumlin::test
