// Tests of scenes in both engines, under either stepping.
#pragma once

#include "tests/support/engine_runs.h"

#include <gtest/gtest.h>

#include <string>
#include <tuple>

namespace drumlin::test {

/// Engine and stepping.
class BothEngines : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {
protected:
  void SetUp() override {
    if (std::get<0>(GetParam()) == "lammps" && !post::has_lammps())
      GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  }

  /// Runs the scene into the folder.
  static Outcome run(const std::string &scene, const Scratch &folder, Variables variables = {}) {
    const auto &[engine, stepping] = GetParam();
    variables.emplace_back("stepping", stepping);
    return run_scene(engine, scene, variables, folder.path());
  }
};

inline auto engines_and_steppings() {
  return ::testing::Combine(::testing::Values("liggghts", "lammps"), ::testing::Values("second", "stock"));
}

inline std::string engine_and_stepping(const ::testing::TestParamInfo<BothEngines::ParamType> &test) {
  return std::get<0>(test.param) + "_" + std::get<1>(test.param);
}

} // namespace drumlin::test
