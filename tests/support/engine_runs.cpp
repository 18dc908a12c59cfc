#include "tests/support/engine_runs.h"
#include "bed/dump_readers.h"
#include "engine/engine_command.h"

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
  const std::vector<std::string> columns =
      words_of("id x y z vx vy vz fx fy fz omegax omegay omegaz tqx tqy tqz");
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
  const Variables variables = with(
      with(given("case {}, transition {}, steps_per_cycle {}, samples_per_cycle {}", name,
                 post::transition_name(transition), steps_per_cycle, samples_per_cycle),
           more),
      given(
          "cycles 30, stepping stock")); // the engine takes the first value of a variable: `more` goes before
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

std::vector<double> BallsRun::series(long id, std::array<double, 3> Ball::*part, std::size_t axis) const {
  std::vector<double> values;
  for (const Frame &frame : frames)
    values.push_back((frame.balls.at(id).*part)[axis]);
  return values;
}

BallsRun run_balls(const Variables &variables, int ranks) {
  const Scratch scratch;
  write_floor(scratch / "floor.stl", 1.5, true);
  const Outcome outcome = well(run_deck(test_deck("balls.in"), variables, scratch.path(), ranks));
  std::ifstream in(scratch / "reaction.txt");
  return {read_dump(scratch / "state.dump"),
          post::read_events(scratch / "events.csv"),
          {std::istream_iterator<double>(in), {}},
          outcome.output};
}

void write_floor(const std::filesystem::path &file, double half_width, bool single) {
  std::ofstream out(file);
  const double w = half_width;
  const auto facet = [&](std::initializer_list<std::array<double, 2>> corners) {
    out << "facet normal 0 0 1\nouter loop\n";
    for (const auto &corner : corners)
      out << "vertex " << corner[0] << ' ' << corner[1] << " 0\n";
    out << "endloop\nendfacet\n";
  };
  out << "solid floor\n";
  if (single) {
    facet({{-w, -w}, {w, -w}, {0, w}});
  } else {
    facet({{-w, -w}, {w, -w}, {w, w}});
    facet({{-w, -w}, {w, w}, {-w, w}});
  }
  out << "endsolid floor\n";
}

std::string vector_text(double x, double y, double z) {
  return number(x) + ' ' + number(y) + ' ' + number(z);
}

std::string host_pair_style() { return "pair_style gran model hooke/transition\npair_coeff * *\n"; }

std::string property(const std::string &name, const std::string &value) {
  std::string line = "fix " + name + " all property/global " + name + " peratomtypepair 3";
  for (int n = 0; n < 9; ++n)
    line += " " + value;
  return line + "\n";
}

std::string host_properties(const std::string &text) {
  std::string lines;
  for (const auto &[name, value] :
       given("kn 1e7, dampingRatio 0.5, gamman_abs 1e5, coefficientRollingFriction 0.1"))
    if (text.find("property/global " + name) == std::string::npos) lines += property(name, value);
  return lines;
}

std::string with_other_ids(const std::string &lines) {
  return "create_atoms 1 single 1.5 1.5 -1 units box\nset type 1 diameter 1.0\nset type 1 mass 2000\n" +
         lines + "\nrun 5\ngroup gone id 1\ndelete_atoms group gone";
}

std::vector<std::string> mpi_environment(const fs::path &folder) {
  return {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1",
          "OMPI_MCA_rmaps_base_oversubscribe=1", "OMPI_MCA_hwloc_base_binding_policy=none",
          "OMPI_MCA_mpi_yield_when_idle=1",
          "OMPI_MCA_odls_base_sigkill_timeout=0", // after a rank has failed mpirun waits 1 to 2 s by default
          // Without a daemon for one rank and without a search for networks a start takes 0.04 s instead of
          // 0.33. Single ranks without a daemon would share one session folder, and race for it.
          "OMPI_MCA_orte_tmpdir_base=" + folder.string(), "OMPI_MCA_ess_singleton_isolated=1",
          "OMPI_MCA_pml=ob1", "OMPI_MCA_btl=self,vader"};
}

Outcome run_engine(const fs::path &deck, const std::vector<std::string> &words, const fs::path &folder,
                   int ranks) {
  std::vector<std::string> arguments = {"-log", "none"};
  arguments.insert(arguments.end(), words.begin(), words.end());
  const post::EngineCommand command = post::engine_command(deck, arguments, ranks, post::Cores::shared);
  std::vector<std::string> environment = mpi_environment(folder);
  environment.insert(environment.end(), command.environment.begin(), command.environment.end());
  return run_program(command.words, environment, folder, 600.0);
}

const fs::path host_deck = fs::path(DRUMLIN_SOURCE_DIR) / "tests/support/in.host";

void write_host(const std::string &pair, const std::string &lines, const fs::path &folder) {
  write_text(folder / "pair", pair + "\n"); // the engine ignores a last line without its end
  write_text(folder / "lines", lines + "\n");
}

Outcome run_host(const std::string &pair, const std::string &lines, const fs::path &folder, int ranks) {
  write_host(pair, lines, folder);
  return run_engine(host_deck, {}, folder, ranks);
}

Outcome run_lammps_host(const std::string &lines, const fs::path &folder, int ranks) {
  write_text(folder / "lines", lines + "\nrun 20\n");
  const WaitForRanks at_once(0);
  return run_deck(fs::path(DRUMLIN_SOURCE_DIR) / "tests/support/host.lammps",
                  {{"lines", (folder / "lines").string()}}, folder, ranks);
}

void write_text(const fs::path &file, const std::string &text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file.string());
}

} // namespace drumlin::test
