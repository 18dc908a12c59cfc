#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"

#include "bed/dump_readers.h"
#include "support/files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace drumlin::test {

namespace fs = std::filesystem;

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

post::StopCondition after_processor_time(double seconds) {
  return [seconds](pid_t process) {
    clockid_t clock{};
    timespec used{};
    if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &used) != 0) return false;
    return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec) >= seconds;
  };
}

namespace {
constexpr const char *wait_name = "OMPI_MCA_odls_base_sigkill_timeout"; // s from SIGTERM to SIGKILL
}

WaitForRanks::WaitForRanks(int seconds) {
  if (const char *before = std::getenv(wait_name)) before_ = before;
  ::setenv(wait_name, std::to_string(seconds).c_str(), 1);
}

WaitForRanks::~WaitForRanks() {
  before_.empty() ? ::unsetenv(wait_name) : ::setenv(wait_name, before_.c_str(), 1);
}

std::string number(double value) { return post::number_text(value); }

fs::path chain_deck(const std::string &name) { return fs::path(DRUMLIN_SOURCE_DIR) / "inputs/chain" / name; }
fs::path test_deck(const std::string &name) { return fs::path(DRUMLIN_SOURCE_DIR) / "tests/decks" / name; }

Outcome run_scene(const std::string &engine, const std::string &name, const Variables &variables,
                  const fs::path &folder, int ranks) {
  return run_deck(test_deck(engine == "lammps" ? "scene.lammps" : "scene.in"),
                  with({{"scene", name}}, variables), folder, ranks);
}

std::vector<Frame> read_dump(const fs::path &file) {
  const std::vector<std::string> columns = {"id", "x",  "y",      "z",      "vx",     "vy",  "vz",  "fx",
                                            "fy", "fz", "omegax", "omegay", "omegaz", "tqx", "tqy", "tqz"};
  std::vector<Frame> frames;
  for (const post::TextDump &dump : post::read_text_dumps(file)) {
    if (dump.names != columns) throw std::runtime_error(file.string() + ": unexpected columns");
    Frame frame;
    frame.step = dump.step;
    for (const std::vector<double> &row : dump.rows) {
      Ball &ball = frame.balls[std::lround(row[0])];
      auto number = row.begin() + 1;
      for (auto *part : {&ball.x, &ball.v, &ball.f, &ball.omega, &ball.torque})
        for (double &component : *part)
          component = *number++;
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

int most_ranks() {
  const char *const said = std::getenv("DRUMLIN_RANKS");
  return said == nullptr ? 2 : std::atoi(said);
}

ChainRun read_run(const fs::path &folder) {
  return {post::read_chain(folder / "chain.csv"), post::read_events(folder / "events.csv")};
}

ChainRun run_chain(const std::string &name, post::Transition transition, int steps_per_cycle,
                   int samples_per_cycle, const Variables &more) {
  const Scratch scratch;
  const Variables variables =
      with(with({{"case", name},
                 {"transition", post::transition_name(transition)},
                 {"steps_per_cycle", std::to_string(steps_per_cycle)},
                 {"samples_per_cycle", std::to_string(samples_per_cycle)}},
                more),
           {{"cycles", "30"},
            {"stepping", "stock"}}); // the engine takes the first value of a variable: `more` goes before
  well(run_deck(chain_deck("in.chain"), variables, scratch.path()));
  return read_run(scratch.path());
}

fs::path chain_with_bottom(const fs::path &folder, double bottom) {
  fs::path copy = folder / "chain";
  fs::copy(chain_deck(""), copy);
  std::string text = read_text(copy / "in.chain");
  const std::string own = "block -1 1 -1 1 -1.5 4";
  const std::size_t found = text.find(own);
  if (found == std::string::npos) throw std::runtime_error("in.chain has another box than '" + own + "'");
  text.replace(found, own.size(), "block -1 1 -1 1 " + number(bottom) + " 4");
  std::ofstream(copy / "in.chain") << text;
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

Outcome on_small_disk(const fs::path &folder, const std::string &script) {
  fs::create_directory(folder / "small");
  return run_program(
      {"unshare", "-m", "sh", "-c", "mount -t tmpfs -o size=600k tmpfs small || exit 77\n" + script},
      {"DRUMLIN_PRELOAD=" + plugin_library(), "DECKS=" + chain_deck("").string()}, folder, 600.0);
}

bool can_mount_small_disk() {
  const Scratch folder;
  return on_small_disk(folder.path(), "true").ok();
}

} // namespace drumlin::test
