// Errors of chains and impacts beside their exact solutions: of runs that are the exact solution with a known
// error.
#include "chain/analysis.h"
#include "chain/exact_solution.h"
#include "experiment/quantity.h"
#include "runs/chain_files.h"
#include "runs/parameter_file.h"
#include "support/files.h"
#include "tests/support/engine_runs.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace drumlin::test {
namespace {

using post::Transition;

class ExactQuantities : public ::testing::Test {
protected:
  double value(const std::string &name) const {
    return post::measured({*post::named_quantity(name)}, scratch_.path(), 1.0).front();
  }
  void write(const std::string &file, const std::string &text) const {
    post::write_files({{scratch_ / file, text}});
  }
  Scratch scratch_;
};

TEST_F(ExactQuantities, OfAChainAreTheErrorsThatItWasGiven) {
  post::ChainParameters chain = post::table1_case("II", Transition::B);
  post::ExactOptions options;
  options.cycles = 6;
  options.samples_per_cycle = 40;
  const post::ExactSolution exact = post::solve_chain(chain, options);
  Variables parameters = post::parameter_values(chain);
  parameters.insert(parameters.end(), {{"cycles", "6"}, {"samples_per_cycle", "40"}});
  write("parameters.csv", post::parameters_text(parameters));
  post::ChainHistory run = exact.history;
  std::vector<post::ContactEvent> events = exact.events;
  ASSERT_GT(events.size(), 4U);
  const double rest = (chain.m2 + chain.m3) * chain.g / chain.k;
  for (double &v : run.v_drum)
    v *= 1.01;
  for (double &x : run.x_drum)
    x = 0.98 * (x + rest) - rest;
  events[3].time += 0.002 * chain.period();
  write("chain.csv", post::chain_text(run));
  write("events.csv", post::events_text(events));
  EXPECT_NEAR(value("velocity_error"), 0.01, 1e-9);
  EXPECT_NEAR(value("way_error"), 0.02, 1e-9);
  EXPECT_NEAR(value("event_time_error"), 0.002, 1e-9);
  events.pop_back();
  write("events.csv", post::events_text(events));
  EXPECT_TRUE(std::isnan(value("event_time_error")));
  write("parameters.csv", "name,value\ncycles,6\n");
  EXPECT_THROW(value("velocity_error"), std::runtime_error);
}

// Under A with D = 0 the speed comes back; at D = 2 the drum creeps back and does not leave the soil.
TEST_F(ExactQuantities, OfAnImpactAreTheErrorOfTheReboundOverItsSpeed) {
  const double w0 = std::sqrt(1e8 / 2000), dt = 1e-6, last = 4 * pi / w0;
  const auto run = [&](double D, double v_end) {
    write("parameters.csv",
          fmt::format("name,value\ntransition,A\nm2,2000\nk,1e8\nD,{}\nspeed,0.5\ntimestep,{}\n", D, dt));
    write(
        "chain.csv",
        fmt::format("time,x_drum,v_drum,a_drum,F_contact,F_excitation\n0,0,-0.5,0,0,0\n{},0,{:.17g},0,0,0\n",
                    last, v_end));
    return value("rebound_error");
  };
  EXPECT_NEAR(run(0.0, 0.5), 0.0, 1e-12);
  EXPECT_NEAR(run(0.0, 0.49), 0.02, 1e-12);
  // x'' + 4 w0 x' + w0^2 x = 0 from x = 0, x' = -0.5: the sum of two decays.
  const double a = (2 - std::sqrt(3.0)) * w0, b = (2 + std::sqrt(3.0)) * w0, t = last - 0.5 * dt;
  const double creeps = -0.5 * (b * std::exp(-b * t) - a * std::exp(-a * t)) / (b - a);
  EXPECT_NEAR(run(2.0, creeps), 0.0, 1e-9);
  EXPECT_NEAR(run(2.0, creeps + 0.005), 0.01, 1e-9);
}

TEST_F(ExactQuantities, OfManyImpactsAreTheLargestError) {
  const auto run = [&](int phases) {
    write("parameters.csv", fmt::format("name,value\ntransition,B\nD,0\nspeed,0.5\nphases,{}\n", phases));
    write("rebound.txt",
          "ITEM: TIMESTEP\n9\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 "
          "1\nITEM: ATOMS id vz\n1 0.495\n2 0.5025\n");
    return value("largest_rebound_error");
  };
  EXPECT_NEAR(run(2), 0.01, 1e-12);
  EXPECT_TRUE(std::isnan(run(3))); // one is lost
}

} // namespace
} // namespace drumlin::test
