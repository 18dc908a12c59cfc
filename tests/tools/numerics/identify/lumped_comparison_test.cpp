// A record beside its lumped chain: nothing differs if the record is a chain's, solved by CVODE; a soil that
// stiffens shows.
#include "chain/exact_solution.h"
#include "identify/lumped_comparison.h"
#include "record/chain_record.h"
#include "tests/support/chain_by_cvode.h"
#include "tests/support/checks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

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

} // namespace
} // namespace drumlin::test
