// The energy balance of the chain: the work of the exciter is the energy dissipated in contact and bond plus
// the change of the mechanical energy. The energy error is that of the integration scheme, which falls with
// the step.
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

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
  well(run_deck(chain_deck("in.chain"),
                {{"case", name},
                 {"transition", post::transition_name(transition)},
                 {"stepping", "stock"},
                 {"steps_per_cycle", std::to_string(steps)},
                 {"samples_per_cycle", std::to_string(samples)},
                 {"cycles", std::to_string(cycles)}},
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
      run_deck(scratch / "deck",
               {{"here", chain_deck("").string()}, {"case", "II"}, {"transition", "B"}, {"cycles", "6"}},
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

} // namespace
} // namespace drumlin::test
