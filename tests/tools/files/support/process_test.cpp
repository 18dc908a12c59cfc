// Programs that are run as child processes, and their lines while they run.
#include "support/process.h"
#include "support/stop_signal.h"

#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;
using post::Program;

/// A program that runs a shell line in a scratch folder and writes its output to the file `text` there.
Program shell(const Scratch &scratch, const std::string &line) {
  Program program;
  program.words = {"sh", "-c", line};
  program.folder = scratch.path();
  program.output = scratch / "text";
  program.limit = 600.0;
  return program;
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

TEST(Process, HandsOnLinesWhileItRuns) {
  const Scratch scratch;
  // The program continues only when its first line has been read.
  Program program =
      shell(scratch, "echo one; while [ ! -e seen ]; do sleep 0.01; done; printf 'two\\n\\nhalf'");
  std::vector<std::string> lines;
  program.line = [&](const std::string &line) {
    if (lines.empty()) fs::create_directory(scratch / "seen");
    lines.push_back(line);
  };
  const Outcome outcome = well(run_program(program));
  EXPECT_EQ(outcome.output, "one\ntwo\n\nhalf");
  EXPECT_EQ(lines, (std::vector<std::string>{"one", "two", ""})); // the last line has no line end
}

TEST(Process, IsStoppedWhenAReaderOfItsLinesFails) {
  for (const bool own_group : {true, false}) {
    const Scratch scratch;
    Program program = shell(scratch, "echo $$ >number; echo one; exec sleep 50");
    program.own_group = own_group;
    program.line = [](const std::string &line) { throw std::runtime_error("not " + line); };
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_THROW(run_program(program), std::runtime_error);
    EXPECT_LT(seconds_since(begin), 30.0);
    EXPECT_NE(::kill(std::stoi(read_text(scratch / "number")), 0), 0);
  }
}

TEST(Process, EndsWithTheProcessThatStartedIt) {
  for (const auto &[own_group, deaf] : {std::pair{true, ""}, {false, ""}, {true, "trap '' TERM; "}}) {
    const Scratch scratch;
    Program program =
        shell(scratch,
              std::string(deaf) + "echo $$ >number.unfinished; mv number.unfinished number; exec sleep 50");
    program.own_group = own_group;
    const pid_t parent = ::fork();
    if (parent == 0) {
      run_program(program);
      ::_exit(0);
    }
    const auto begin = std::chrono::steady_clock::now();
    while (!fs::exists(scratch / "number") && seconds_since(begin) < 30.0)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const pid_t child = std::stoi(read_text(scratch / "number"));
    ::kill(parent, SIGKILL);
    ::waitpid(parent, nullptr, 0);
    // A zombie, if nobody waits for it here, has ended, too.
    const auto runs = [child] {
      std::ifstream stat("/proc/" + std::to_string(child) + "/stat");
      std::string number, name, state;
      return stat >> number >> name >> state && state != "Z";
    };
    while (runs() && seconds_since(begin) < 30.0)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_FALSE(runs());
  }
}

// A program that does not stop is killed after 5 s; what the caller has to clear away is cleared then.
TEST(Process, ThatDoesNotStopIsKilledBeforeASignalEndsItsCaller) {
  const Scratch scratch;
  const Program program = shell(scratch, "trap '' TERM; echo >ready; exec sleep 50");
  const pid_t caller = ::fork();
  if (caller == 0) {
    post::stop_where_told();
    try {
      run_program(program);
    } catch (const post::StoppedBySignal &) {
      fs::create_directory(scratch / "cleared away");
    }
    ::_exit(0);
  }
  const auto begin = std::chrono::steady_clock::now();
  while (!fs::exists(scratch / "ready") && seconds_since(begin) < 30.0)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ::kill(caller, SIGTERM);
  int status = 0;
  ::waitpid(caller, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(fs::exists(scratch / "cleared away"));
}

TEST(Process, WithoutItsProgramIsAnError) {
  const Scratch scratch;
  Program program = shell(scratch, "");
  program.words = {"no-such-program"};
  EXPECT_EQ(error_of([&] { run_program(program); }),
            "cannot start no-such-program: No such file or directory");
}

TEST(Process, IsFoundByPath) {
  EXPECT_EQ(post::program_file("sh").filename(), "sh");
  EXPECT_EQ(post::program_file("/bin/sh"), "/bin/sh");
  for (const char *name : {"", "/", "/bin", "/etc/passwd", "no-such-program"})
    EXPECT_TRUE(post::program_file(name).empty()) << name;
}

} // namespace
} // namespace drumlin::test
