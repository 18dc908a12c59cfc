#include "support/process.h"

#include "support/files.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <initializer_list>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <unistd.h>

namespace drumlin::post {

namespace {

constexpr unsigned patience = 3;   ///< s
constexpr unsigned unwinding = 10; ///< s, more than run_program() gives a program that is to stop
volatile std::sig_atomic_t received = 0;

void take_default(int number) {
  std::signal(number, SIG_DFL);
  std::raise(number);
}

extern "C" void note(int number) {
  if (received != 0) take_default(number);
  received = number;
  ::alarm(patience);
}

extern "C" void give_up(int) { take_default(received); }

} // namespace

void stop_where_told() {
  struct sigaction noting {};
  noting.sa_handler = note;
  noting.sa_flags = SA_RESTART;
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    ::sigaction(number, nullptr, &before);
    // Ignored: nohup. Another: UCX, of MPI, takes SIGHUP for itself when it is loaded.
    if (before.sa_handler != SIG_IGN) ::sigaction(number, &noting, nullptr);
  }
  std::signal(SIGALRM, give_up);
}

void end_if_told() {
  if (received == 0) return;
  ::alarm(unwinding);
  throw StoppedBySignal{received};
}

void end_by(const StoppedBySignal &signal) {
  take_default(signal.number);
  std::_Exit(EXIT_FAILURE); // the signal is blocked
}

namespace fs = std::filesystem;
using std::chrono::steady_clock;

namespace {

/// Null-terminated pointers into the words, for exec.
std::vector<char *> pointers(std::vector<std::string> &words) {
  std::vector<char *> result;
  result.reserve(words.size() + 1);
  for (std::string &word : words)
    result.push_back(word.data());
  result.push_back(nullptr);
  return result;
}

/// How a process ended, and what it used.
struct End {
  int status = 0;
  rusage used = {};
};

/// Passes on the lines of a file while another process writes it.
class LineFollower {
public:
  LineFollower(const fs::path &file, const std::function<void(const std::string &)> &line) : line_(line) {
    if (line_) in_.open(file, std::ios::binary);
  }
  /// The lines that are complete by now.
  void follow() {
    if (!line_) return;
    std::array<char, 4096> piece{};
    for (;;) {
      in_.clear(); // the end of the file is no longer where it was
      in_.read(piece.data(), piece.size());
      if (in_.gcount() == 0) return;
      rest_.append(piece.data(), static_cast<std::size_t>(in_.gcount()));
      for (std::size_t end = rest_.find('\n'); end != std::string::npos; end = rest_.find('\n')) {
        line_(rest_.substr(0, end));
        rest_.erase(0, end + 1);
      }
    }
  }

private:
  const std::function<void(const std::string &)> &line_;
  std::ifstream in_;
  std::string rest_;
};

/// Waits until the process has ended, or the time has come or the condition holds; whether it has ended.
bool wait_until(pid_t child, End &how, steady_clock::time_point end, bool ends_if_told = false,
                LineFollower *follower = nullptr, const StopCondition &stop_when = {}) {
  for (;;) {
    if (follower != nullptr) follower->follow();
    const pid_t ended = wait4(child, &how.status, WNOHANG, &how.used);
    if (ended == child) return true;
    if (ended < 0 && errno != EINTR) throw std::runtime_error(std::string("wait4: ") + std::strerror(errno));
    if (ends_if_told) end_if_told();
    if (steady_clock::now() >= end || (stop_when && stop_when(child))) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

/// Sends stop_signal to the program, so that mpirun can stop its ranks, and SIGKILL if it still runs after 5
/// s. If the program was started with a process group of its own, all processes of the group get the signals.
void stop(pid_t child, const Program &program, End &how) {
  const pid_t whom = program.own_group ? -child : child;
  kill(whom, program.stop_signal);
  if (wait_until(child, how, steady_clock::now() + std::chrono::seconds(5))) return;
  kill(whom, SIGKILL);
  wait4(child, &how.status, 0, &how.used);
}

double seconds(const timeval &time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// What a child process does to become the program. Between fork() and exec() only functions that are safe
/// there may be called. Returns the number of the error.
int become(const Program &program, char **argv, char **envp, pid_t parent) {
  if (program.own_group) ::setpgid(0, 0);
  // It ends with this process, even if that is killed: nobody would read its results, and a later call might
  // write the same files. SIGKILL, for nobody would be left to send it after a SIGTERM that has no effect.
  // Files are whole: engines rename them when they are written. Ranks end with their mpirun.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(EXIT_FAILURE);
  ::signal(SIGPIPE, SIG_DFL); // which this process may ignore
  const int input = ::open("/dev/null", O_RDONLY);
  const int output = ::open(program.output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (input < 0 || output < 0 || ::dup2(input, STDIN_FILENO) < 0 || ::dup2(output, STDOUT_FILENO) < 0 ||
      ::dup2(output, STDERR_FILENO) < 0 || ::chdir(program.folder.c_str()) != 0)
    return errno;
  for (const int file : {input, output})
    if (file > STDERR_FILENO) ::close(file);
  ::execvpe(argv[0], argv, envp);
  return errno;
}

/// Starts the program; the number of its process.
pid_t start(const Program &program) {
  std::vector<std::string> arguments = program.words;
  std::vector<std::string> entries = program.environment;
  for (char **entry = environ; *entry != nullptr; ++entry)
    entries.emplace_back(*entry);
  const std::vector<char *> argv = pointers(arguments);
  const std::vector<char *> envp = pointers(entries);
  std::array<int, 2> fault{}; // a pipe, which gets the number of an error
  int failed = ::pipe2(fault.data(), O_CLOEXEC) == 0 ? 0 : errno;
  pid_t child = 0;
  if (failed == 0) {
    const pid_t parent = ::getpid();
    child = ::fork();
    if (child == 0) {
      failed = become(program, const_cast<char **>(argv.data()), const_cast<char **>(envp.data()), parent);
      static_cast<void>(::write(fault[1], &failed, sizeof failed) > 0);
      ::_exit(EXIT_FAILURE);
    }
    if (child < 0) failed = errno;
    ::close(fault[1]);
    ssize_t got = 0;
    while (child > 0 && (got = ::read(fault[0], &failed, sizeof failed)) < 0 && errno == EINTR) {
    }
    ::close(fault[0]);
    if (got > 0) ::waitpid(child, nullptr, 0);
  }
  if (failed != 0)
    throw std::runtime_error("cannot start " + program.words.front() + ": " + std::strerror(failed));
  return child;
}

} // namespace

Outcome run_program(const Program &program) {
  const pid_t child = start(program);
  Outcome outcome;
  End how;
  const auto end = steady_clock::now() + std::chrono::duration_cast<steady_clock::duration>(
                                             std::chrono::duration<double>(program.limit));
  LineFollower follower(program.output, program.line);
  try {
    if (!wait_until(child, how, end, true, &follower, program.stop_when)) {
      outcome.timed_out = true;
      stop(child, program, how);
    }
  } catch (...) {
    stop(child, program, how);
    throw;
  }
  follower.follow(); // lines printed since the last call
  outcome.status = WIFEXITED(how.status) ? WEXITSTATUS(how.status) : 128 + WTERMSIG(how.status);
  outcome.cpu_seconds = seconds(how.used.ru_utime) + seconds(how.used.ru_stime);
  outcome.peak_bytes = 1024.0 * static_cast<double>(how.used.ru_maxrss); // Linux counts it in KiB
  // A program that is killed before it opens its output has printed nothing.
  if (fs::exists(program.output)) outcome.output = read_text(program.output);
  return outcome;
}

Outcome run_program(const std::vector<std::string> &words, const std::vector<std::string> &environment,
                    const fs::path &folder, double limit, const StopCondition &stop_when) {
  Program program;
  program.words = words;
  program.environment = environment;
  program.folder = folder;
  program.output = folder / program_output_file;
  program.limit = limit;
  program.stop_when = stop_when;
  return run_program(program);
}

fs::path program_file(const std::string &name) {
  const auto runs = [](const fs::path &file) {
    std::error_code hidden; // in a folder that this user may not enter
    return fs::is_regular_file(file, hidden) && ::access(file.c_str(), X_OK) == 0;
  };
  if (name.find('/') != std::string::npos) return runs(name) ? fs::path(name) : fs::path();
  const char *path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (fs::path file = fs::path(folder) / name; runs(file)) return file;
  return {};
}

} // namespace drumlin::post
