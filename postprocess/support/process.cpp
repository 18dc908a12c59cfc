#include "support/process.h"

#include "support/files.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace drumlin::post {

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

/// Waits until the process has ended or the time has come; whether it has ended.
bool wait_until(pid_t child, End &how, steady_clock::time_point end) {
  for (;;) {
    const pid_t ended = wait4(child, &how.status, WNOHANG, &how.used);
    if (ended == child) return true;
    if (ended < 0 && errno != EINTR) throw std::runtime_error(std::string("wait4: ") + std::strerror(errno));
    if (steady_clock::now() >= end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

/// Stops the child's process group: politely, so that mpirun takes its ranks along, then at once.
void stop(pid_t child, End &how) {
  kill(-child, SIGTERM);
  if (wait_until(child, how, steady_clock::now() + std::chrono::seconds(5))) return;
  kill(-child, SIGKILL);
  wait4(child, &how.status, 0, &how.used);
}

double seconds(const timeval &time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

} // namespace

Outcome run_program(const std::vector<std::string> &words, const std::vector<std::string> &environment,
                    const fs::path &folder, double limit) {
  const fs::path text = folder / program_output_file;
  std::vector<std::string> arguments = words;
  std::vector<std::string> entries = environment;
  for (char **entry = environ; *entry != nullptr; ++entry)
    entries.emplace_back(*entry);
  const std::vector<char *> argv = pointers(arguments);
  const std::vector<char *> envp = pointers(entries);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, text.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  posix_spawn_file_actions_addchdir_np(&files, folder.c_str());
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, argv[0], &files, &attributes, argv.data(), envp.data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  if (failed != 0) throw std::runtime_error("cannot start " + words.front() + ": " + std::strerror(failed));

  Outcome outcome;
  End how;
  const auto end = steady_clock::now() +
                   std::chrono::duration_cast<steady_clock::duration>(std::chrono::duration<double>(limit));
  if (!wait_until(child, how, end)) {
    outcome.timed_out = true;
    stop(child, how);
  }
  outcome.status = WIFEXITED(how.status) ? WEXITSTATUS(how.status) : 128 + WTERMSIG(how.status);
  outcome.cpu_seconds = seconds(how.used.ru_utime) + seconds(how.used.ru_stime);
  outcome.peak_bytes = 1024.0 * static_cast<double>(how.used.ru_maxrss); // Linux counts it in KiB
  outcome.output = read_text(text);
  return outcome;
}

} // namespace drumlin::post
