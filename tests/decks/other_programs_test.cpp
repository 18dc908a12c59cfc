// The preloaded library prints in the engine's process and in no other.
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace drumlin::test {
namespace {

TEST(Preload, LeavesOtherProgramsAlone) {
  const Scratch scratch;
  const std::string preload = "LD_PRELOAD=" + plugin_library();
  const Outcome echo = run_program({"/bin/echo", "untouched"}, {preload}, scratch.path());
  EXPECT_EQ(echo.status, 0);
  EXPECT_EQ(echo.output, "untouched\n");
  const std::vector<std::string> failing = {"/bin/ls",
                                            "no-such-file"}; // its text is not the same in every release
  const Outcome alone = run_program(failing, {"LC_ALL=C"}, scratch.path());
  const Outcome fails = run_program(failing, {preload, "LC_ALL=C"}, scratch.path());
  EXPECT_EQ(alone.status, 2);
  EXPECT_EQ(fails.status, 2);
  EXPECT_EQ(fails.output, alone.output);
  const Outcome child =
      run_program({"/bin/sh", "-c", "/bin/sh -c '/bin/echo grandchild; exit 3'"}, {preload}, scratch.path());
  EXPECT_EQ(child.status, 3);
  EXPECT_EQ(child.output, "grandchild\n");
}

TEST(Preload, StartLineNamesBothVersions) {
  const Scratch scratch;
  std::ofstream(scratch / "in.empty") << "print \"here is ${here}\"\n";
  const Outcome outcome = well(run_deck(scratch / "in.empty", {}, scratch.path()));
  EXPECT_TRUE(printed(outcome, {std::string("drumlin ") + DRUMLIN_VERSION +
                                    ", plugin for LIGGGHTS 3.8.0, loaded in LIGGGHTS 3.8.0\n",
                                "here is " + scratch.path().string() + "\n"}));
}

} // namespace
} // namespace drumlin::test
