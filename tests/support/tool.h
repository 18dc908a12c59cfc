// For tests that call commands of drumlin: each test has a folder of its own, in which they run.
#pragma once

#include "tests/support/engine_runs.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::test {

class Tool : public ::testing::Test {
protected:
  /// Calls drumlin with words of which the first is the command.
  Outcome drumlin(std::vector<std::string> words) const {
    words.insert(words.begin(), DRUMLIN_TOOLS);
    return run_program(words, {}, folder_, 120.0);
  }
  /// Calls one command.
  Outcome drumlin(const std::string &command, std::vector<std::string> words) const {
    words.insert(words.begin(), command);
    return drumlin(std::move(words));
  }

  const Scratch scratch_;
  const std::filesystem::path folder_ = scratch_.path();
};

} // namespace drumlin::test
