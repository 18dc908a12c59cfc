// Runs of the element tests of soil in both engines.
#pragma once

#include "support/csv.h"
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace drumlin::test {

/// Runs a deck of inputs/soil in an engine and returns a table, by default that of the test: "biaxial" has
/// in.biaxial(.lammps) and biaxial.csv. Throws std::runtime_error with the output of a run that fails.
inline post::Table run_element_test(const std::string &engine, const std::string &name,
                                    const Variables &variables, int ranks = 1, const std::string &file = "") {
  const Scratch scratch;
  const std::string deck = "../soil/in." + name + (engine == "lammps" ? ".lammps" : "");
  well(run_deck(chain_deck(deck), variables, scratch.path(), ranks));
  return post::read_table(scratch / (file.empty() ? name + ".csv" : file));
}

/// Tests in an engine, "liggghts" or "lammps"; skipped if LAMMPS is not set up.
class InEngine : public ::testing::TestWithParam<std::string> {
protected:
  void SetUp() override {
    if (GetParam() == "lammps" && !post::has_lammps())
      GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  }
};

} // namespace drumlin::test
