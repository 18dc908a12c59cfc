// Runs a program as a child process in a folder of its own. No shell is involved. The program ends with this
// process, however that ends.
#pragma once

#include <csignal>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace drumlin::post {

/// How a child process ended.
struct Outcome {
  int status = -1;          ///< exit status; 128 + signal if a signal ended it
  bool timed_out = false;   ///< it was stopped, at its time limit or by Program::stop_when
  double cpu_seconds = 0.0; ///< processor time used by the child and its own children, s
  double peak_bytes = 0.0;  ///< peak resident memory of the largest single process, bytes
  std::string output;       ///< standard output and standard error
  bool ok() const { return status == 0 && !timed_out; }
  bool says(const std::string &text) const { return output.find(text) != std::string::npos; }
};

/// The file in its folder that run_program() leaves a program's output in.
constexpr const char *program_output_file = "screen.txt";

/// Asked every few milliseconds with the number of a running process: whether it is to be stopped.
using StopCondition = std::function<bool(pid_t)>;

/// A program with its arguments, folder, environment and limits.
struct Program {
  std::vector<std::string> words;       ///< the program, a path or a name that PATH finds, and its arguments
  std::vector<std::string> environment; ///< entries "NAME=value" in front of those of this process
  std::filesystem::path folder = ".";   ///< its working folder
  std::filesystem::path output =
      program_output_file;   ///< gets its standard output and errors; from this process's working folder
  double limit = 1e8;        ///< wall time after which it is stopped, s
  int stop_signal = SIGTERM; ///< the signal that stops it; SIGKILL follows if it still runs 5 s later
  StopCondition stop_when;   ///< stops it before its limit; may be empty
  bool own_group =
      true; ///< a process group of its own: it can be stopped with its children, but Ctrl-C does not reach it
  std::function<void(const std::string &)>
      line; ///< gets each line of the output while the program runs; may be empty
};

/// Runs a program until it ends or its time is over. Throws std::runtime_error if it cannot be started. If
/// `line` throws, the program is stopped and the exception is passed on.
Outcome run_program(const Program &program);

/// The file of a program: the name itself if it has a slash, else the first file of that name in the folders
/// of PATH that may be run. Empty if there is none.
std::filesystem::path program_file(const std::string &name);

/// The same with extra environment entries ("NAME=value") in a folder, which gets the output, for at most
/// `limit` seconds or until `stop_when`.
Outcome run_program(const std::vector<std::string> &words, const std::vector<std::string> &environment,
                    const std::filesystem::path &folder, double limit = 600.0,
                    const StopCondition &stop_when = {});

/// Thrown by end_if_told(). No std::exception, so that nobody takes it for a fault of a single run.
struct StoppedBySignal {
  int number = 0;
};

/// From now on these signals, unless they are ignored, end the process at the next call of end_if_told(), so
/// that destructors remove temporary folders, for which they have ten seconds. After three seconds without
/// such a call, or at a second signal, they end it at once. Nobody can tell which call a signal is meant for:
/// this state is that of the process.
void stop_where_told();

/// Throws StoppedBySignal if such a signal has arrived. Called where work can be left: before a file is
/// written, between pieces of work, while another program runs. Thread-safe.
void end_if_told();

/// Ends the process as the signal does by default.
[[noreturn]] void end_by(const StoppedBySignal &signal);

} // namespace drumlin::post
