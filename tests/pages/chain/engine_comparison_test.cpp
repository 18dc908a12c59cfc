// The report's comparison of two engines, from invented runs.
#include "report/chain/engine_comparison.h"

#include <gtest/gtest.h>

#include <string>

namespace drumlin::test {
namespace {

using post::ReportResults;

post::Run chain(const std::string &name, const std::string &engine, const std::string &k = "1e8") {
  post::Run run;
  run.name = name;
  run.kind = post::RunKind::chain;
  run.parameters = {{"k", k}, {"engine", engine}, {"ranks", engine == "LAMMPS 1" ? "2" : "1"}};
  post::ChainHistory &h = run.history;
  h.time = {0.0, 1.0, 2.0};
  for (auto *column :
       {&h.x_drum, &h.v_drum, &h.a_drum, &h.x_frame, &h.v_frame, &h.a_frame, &h.F_contact, &h.F_bond})
    *column = {1.0, -4.0, 2.0};
  run.events = {{1.0, true, 0.0, 0.0, 0.0}};
  return run;
}

ReportResults results(const std::vector<post::Run> &runs) {
  ReportResults all;
  for (const post::Run &run : runs) {
    all.runs.emplace_back();
    all.runs.back().run = run;
  }
  return all;
}

TEST(EngineTable, PairsRunsOfOneChainInTwoEngines) {
  post::Run direct = chain("direct", "CVODE 5");
  direct.direct = true;
  const ReportResults all = results({chain("here", "LIGGGHTS 3"), chain("softer", "LIGGGHTS 3", "1e6"),
                                     direct, chain("there", "LAMMPS 1"), chain("again", "LIGGGHTS 3")});
  const auto pairs = post::engine_pairs(all);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0], (std::pair<std::size_t, std::size_t>{3, 0}));
  EXPECT_EQ(pairs[1], (std::pair<std::size_t, std::size_t>{3, 4}));
  const post::PageTable table = post::engine_table(all);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.states[0], post::RowState::agrees);
  EXPECT_TRUE(post::engine_table(results({chain("here", "LIGGGHTS 3")})).rows.empty());
}

TEST(EngineTable, HasTheLargestDifferenceOverTheLargestValue) {
  const post::Run here = chain("here", "LIGGGHTS 3");
  post::Run there = chain("there", "LAMMPS 1");
  there.history.F_contact[0] += 4e-8;
  const post::PageTable apart = post::engine_table(results({here, there}));
  ASSERT_EQ(apart.rows.size(), 1u);
  EXPECT_EQ(apart.states[0], post::RowState::differs);
  EXPECT_EQ(apart.header[12], "F_contact (-)");
  EXPECT_EQ(apart.rows[0][12], "1.0e-08");
  EXPECT_EQ(apart.rows[0][6], "0.0e+00");

  for (const bool missing : {true, false}) {
    post::Run other = chain("there", "LAMMPS 1");
    if (missing)
      other.events.clear();
    else
      other.events[0].time += 1e-6;
    EXPECT_EQ(post::engine_table(results({here, other})).states.at(0), post::RowState::differs) << missing;
  }
}

} // namespace
} // namespace drumlin::test
