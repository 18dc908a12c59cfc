// The stiffness study: the law of a record whose true law is known, and the changes that the study computes,
// against numbers worked out by hand.
#include "studies/stiffness/results.h"

#include "chain/direct_solver.h"
#include "runs/chain_files.h"
#include "support/files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

using post::BedLaw;

BedLaw law(const std::string &run, int seed, double load, double frequency, double k, double D) {
  BedLaw made;
  made.run = run;
  made.seed = seed;
  made.load = load;
  made.Fw = 5e4;
  made.frequency = frequency;
  made.k = k;
  made.D = D;
  made.r2 = 0.9;
  return made;
}

TEST(LevelsOf, ComparesWithTheDefaultSeedBySeed) {
  const double none = BedLaw::none;
  const std::vector<BedLaw> laws = {
      law("default", 1, 3e4, 20.0, 50e6, 0.1),       law("default", 2, 3e4, 20.0, 70e6, 0.2),
      law("default", 3, 3e4, 20.0, 90e6, 0.3),       law("m3 500", 1, 2e4, 20.0, 47e6, 0.1),
      law("m3 500", 2, 2e4, 20.0, 65e6, none),       law("m3 500", 3, 2e4, 20.0, none, none),
      law("30 Hz", 1, 3e4, 30.0000000001, 60e6, 0.1)};
  const std::vector<post::LawLevel> loads = post::levels_of(laws, post::law_variables[0]);
  ASSERT_EQ(loads.size(), 2u);
  EXPECT_EQ(loads[0].value, 2e4);
  EXPECT_EQ(loads[0].runs.size(), 3u);
  EXPECT_EQ(loads[0].k, (std::vector<double>{47e6, 65e6}));
  EXPECT_EQ(loads[1].D, (std::vector<double>{0.1, 0.2, 0.3}));
  EXPECT_FALSE(loads[1].k_change.has_value()); // the default itself
  ASSERT_TRUE(loads[0].k_change.has_value());
  EXPECT_DOUBLE_EQ(loads[0].k_change->mean, -4e6); // of -3 and -5; t for 1 degree of freedom
  EXPECT_NEAR(loads[0].k_change->half_width, 12.7062 * 1e6, 1e2);
  EXPECT_FALSE(loads[0].D_change.has_value()); // one seed

  const std::vector<post::LawLevel> amplitudes = post::levels_of(laws, post::law_variables[1]);
  ASSERT_EQ(amplitudes.size(), 1u);
  EXPECT_EQ(amplitudes[0].runs.size(), 3u);
  EXPECT_EQ(post::levels_of(laws, post::law_variables[2]).size(), 2u);
}

// The record of CVODE under the name that a bed's has: the origin of each contact then counts as unknown.
TEST(IdentifiedLaw, IsThatOfARecordWithKnownLaw) {
  post::DirectOptions options;
  options.cycles = 10.0;
  options.samples_per_cycle = 250;
  for (const char *name : {"II", "III"}) {
    post::ChainParameters p = post::table1_case(name, post::Transition::B);
    p.k *= 1.7;
    p.D = 0.3;
    const post::ChainHistory history = post::solve_direct(p, options).history;
    const post::TemporaryFolder temporary(testing::TempDir(), "identified_law");
    const std::filesystem::path &folder = temporary.path();
    post::write_files(
        {{folder / "bed.csv", post::chain_text(history)},
         {folder / "parameters.csv", post::parameters_text({{"omega", post::number_text(p.omega)},
                                                            {"Fw", post::number_text(p.Fw)},
                                                            {"m2", post::number_text(p.m2)},
                                                            {"m3", post::number_text(p.m3)},
                                                            {"g", post::number_text(p.g)}})}});
    const BedLaw found = post::identified_law(folder);
    EXPECT_NEAR(found.k, p.k, 1e-3 * p.k) << name;
    EXPECT_NEAR(found.D, p.D, 1e-3 * p.D) << name;
    EXPECT_GT(found.r2, 0.999) << name;
    EXPECT_EQ(found.pulls, "no") << name;
    EXPECT_DOUBLE_EQ(found.load, (p.m2 + p.m3) * p.g);
    EXPECT_DOUBLE_EQ(found.Fw, p.Fw);
    EXPECT_NEAR(found.frequency, 1.0 / p.period(), 1e-9);
  }
}

} // namespace
} // namespace drumlin::test
