#include "engine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <limits>
#include <spawn.h>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace drumlin::test {

namespace fs = std::filesystem;
using std::chrono::steady_clock;

Scratch::Scratch() {
  std::string name = (fs::temp_directory_path() / "drumlin-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder: " + name);
  path_ = name;
}

Scratch::~Scratch() {
  if (::testing::Test::HasFailure()) {
    std::fprintf(stderr, "kept for inspection: %s\n", path_.c_str());
    return;
  }
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

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

/// Waits until the process has ended or the time has come; whether it has ended.
bool wait_until(pid_t child, int &status, steady_clock::time_point end) {
  for (;;) {
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child) return true;
    if (ended < 0 && errno != EINTR)
      throw std::runtime_error(std::string("waitpid: ") + std::strerror(errno));
    if (steady_clock::now() >= end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

/// Stops the child's process group: politely, so that mpirun takes its ranks along, then at once.
void stop(pid_t child, int &status) {
  kill(-child, SIGTERM);
  if (wait_until(child, status, steady_clock::now() + std::chrono::seconds(5))) return;
  kill(-child, SIGKILL);
  waitpid(child, &status, 0);
}

} // namespace

Outcome run_program(const std::vector<std::string> &words, const std::vector<std::string> &environment,
                    const fs::path &folder, double limit) {
  const fs::path text = folder / "screen.txt";
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
  int status = 0;
  const auto end = steady_clock::now() +
                   std::chrono::duration_cast<steady_clock::duration>(std::chrono::duration<double>(limit));
  if (!wait_until(child, status, end)) {
    outcome.timed_out = true;
    stop(child, status);
  }
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.output = read_text(text);
  return outcome;
}

std::string number(double value) { return post::number_text(value); }

Outcome run_deck(const fs::path &deck, const Variables &variables, const fs::path &folder, int ranks,
                 double limit) {
  const std::string preload = "LD_PRELOAD=" + plugin_library();
  std::vector<std::string> words;
  std::vector<std::string> environment;
  if (ranks == 1) {
    environment = {preload};
  } else {
    words = {DRUMLIN_MPIEXEC, "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1"};
    if (geteuid() == 0) words.emplace_back("--allow-run-as-root");
    words.insert(words.end(), {"--oversubscribe", "-np", std::to_string(ranks), "-x", preload});
  }
  words.insert(words.end(), {DRUMLIN_LIGGGHTS_PROGRAM, "-in", deck.string(), "-log", "none", "-var", "out",
                             folder.string()});
  for (const auto &[name, value] : variables)
    words.insert(words.end(), {"-var", name, value});
  return run_program(words, environment, folder, limit);
}

fs::path chain_deck(const std::string &name) { return fs::path(DRUMLIN_SOURCE_DIR) / "inputs/chain" / name; }
fs::path test_deck(const std::string &name) { return fs::path(DRUMLIN_SOURCE_DIR) / "tests/decks" / name; }
std::string plugin_library() { return DRUMLIN_PLUGIN; }

std::string read_text(const fs::path &file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<Frame> read_dump(const fs::path &file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  constexpr const char *columns = "ITEM: ATOMS id x y z vx vy vz fx fy fz omegax omegay omegaz tqx tqy tqz ";
  std::vector<Frame> frames;
  long balls = 0;
  for (std::string line; std::getline(in, line);) {
    if (line == "ITEM: TIMESTEP") {
      frames.emplace_back();
      in >> frames.back().step;
    } else if (line == "ITEM: NUMBER OF ATOMS") {
      in >> balls;
    } else if (line.rfind("ITEM: ATOMS", 0) == 0) {
      if (line != columns) throw std::runtime_error(file.string() + ": unexpected columns: " + line);
      for (long n = 0; n < balls; ++n) {
        long id = 0;
        Ball ball;
        in >> id;
        for (auto *part : {&ball.x, &ball.v, &ball.f, &ball.omega, &ball.torque})
          for (double &component : *part)
            in >> component;
        if (!in) throw std::runtime_error(file.string() + ": a ball is cut short");
        frames.back().balls[id] = ball;
      }
    }
  }
  return frames;
}

ChainRun read_run(const fs::path &folder) {
  return {post::read_chain(folder / "chain.csv"), post::read_events(folder / "events.csv")};
}

ChainRun run_chain(const std::string &name, post::Transition transition, int steps_per_cycle,
                   int samples_per_cycle, const Variables &more) {
  const Scratch scratch;
  Variables variables = {{"case", name},
                         {"transition", post::transition_name(transition)},
                         {"steps_per_cycle", std::to_string(steps_per_cycle)},
                         {"samples_per_cycle", std::to_string(samples_per_cycle)}};
  variables.insert(variables.end(), more.begin(), more.end());
  variables.emplace_back("stepping",
                         "stock"); // the engine takes the first value of a variable: `more` goes before
  const Outcome outcome = run_deck(chain_deck("in.chain"), variables, scratch.path());
  if (!outcome.ok()) throw std::runtime_error("in.chain failed:\n" + outcome.output);
  return read_run(scratch.path());
}

fs::path chain_with_bottom(const fs::path &folder, double bottom) {
  fs::path copy = folder / "chain";
  fs::copy(chain_deck(""), copy);
  std::string text = read_text(copy / "two_balls");
  const std::string own = "block -1 1 -1 1 -1.5 4";
  const std::size_t found = text.find(own);
  if (found == std::string::npos) throw std::runtime_error("two_balls has another box than '" + own + "'");
  text.replace(found, own.size(), "block -1 1 -1 1 " + number(bottom) + " 4");
  std::ofstream(copy / "two_balls") << text;
  return copy;
}

double fitted_order(const std::vector<double> &steps, const std::vector<double> &errors) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double x = std::log(steps[i]);
    const double y = std::log(errors[i]);
    n += 1.0, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

double relative_difference(const std::vector<double> &a, const std::vector<double> &b) {
  if (a.size() != b.size() || b.empty()) return std::numeric_limits<double>::infinity();
  double largest = 0.0;
  double scale = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!std::isfinite(a[i] - b[i])) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, std::fabs(a[i] - b[i]));
    scale = std::max(scale, std::fabs(b[i]));
  }
  return largest == 0.0 ? 0.0 : largest / scale;
}

} // namespace drumlin::test
