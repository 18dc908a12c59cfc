#include "tests/refused/engine_copy.h"
#include "tests/support/engine_runs.h"

#include <lammps.h>
#include <input.h>
#include <mpi.h>
#include <sys/wait.h>
#include <unistd.h>
#include <dlfcn.h>

namespace {

/// In a copy of the process MPI is not ended: it belongs to the process that has begun it.
bool is_copy = false;

template <class Function>
Function next(const char *name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

} // namespace

// The engine finds these functions of the program before those of the library.
extern "C" {
int MPI_Finalize() { return is_copy ? MPI_SUCCESS : next<int (*)()>("MPI_Finalize")(); }
int MPI_Abort(MPI_Comm world, int status) {
  if (is_copy) std::exit(status);
  return next<int (*)(MPI_Comm, int)>("MPI_Abort")(world, status);
}
}

namespace drumlin::test {

namespace fs = std::filesystem;

namespace {

/// Reads a deck in a folder, as the program `liggghts` would.
[[noreturn]] void run(const fs::path &folder, const std::string &deck) {
  is_copy = true;
  fs::current_path(folder);
  if (std::freopen("printed", "w", stdout) == nullptr) std::exit(2);
  std::array<std::string, 5> words = {"liggghts", "-log", "none", "-in", deck};
  std::array<char *, 5> pointers{};
  for (std::size_t n = 0; n < words.size(); ++n)
    pointers.at(n) = words.at(n).data();
  auto *engine = new LAMMPS_NS::LAMMPS(static_cast<int>(words.size()), pointers.data(), MPI_COMM_WORLD);
  engine->input->file(); // of the preloaded library, which this program is linked with
  delete engine;
  std::exit(0);
}

/// Begins MPI and reads the plugin; then, for each folder and deck that it reads, a copy of it runs the deck,
/// and it writes how the copy has ended.
[[noreturn]] void serve(int requests, int answers) {
  std::list<std::string> settings;
  for (const std::string &setting : mpi_environment(fs::temp_directory_path()))
    ::putenv(settings.emplace_back(setting).data());
  MPI_Init(nullptr, nullptr);
  dlopen(DRUMLIN_LIGGGHTS_PLUGIN, RTLD_NOW | RTLD_LOCAL); // once for all copies
  std::FILE *in = fdopen(requests, "r");
  const auto line = [in](std::string &text) {
    text.clear();
    for (int letter = std::fgetc(in); letter != '\n'; letter = std::fgetc(in)) {
      if (letter == EOF) return false;
      text += static_cast<char>(letter);
    }
    return true;
  };
  for (std::string folder, deck; line(folder) && line(deck);) {
    const pid_t copy = fork();
    if (copy == 0) run(folder, deck);
    int status = -1;
    waitpid(copy, &status, 0);
    if (write(answers, &status, sizeof status) != sizeof status) break;
  }
  MPI_Finalize();
  _exit(0);
}

/// The process that serve() runs in: MPI in the process of the test would disturb the programs that it
/// starts.
class Server {
public:
  Server() {
    std::array<int, 2> requests{}, answers{};
    if (pipe(requests.data()) != 0 || pipe(answers.data()) != 0) throw std::runtime_error("no pipe");
    std::fflush(nullptr);
    if (fork() == 0) {
      close(requests[1]);
      close(answers[0]);
      serve(requests[0], answers[1]);
    }
    close(requests[0]);
    close(answers[1]);
    requests_ = requests[1];
    answers_ = answers[0];
  }
  /// The status with which waitpid() describes the end of a copy.
  int run(const fs::path &deck, const fs::path &folder) const {
    const std::string request = folder.string() + "\n" + deck.string() + "\n";
    int status = -1;
    if (write(requests_, request.data(), request.size()) != static_cast<ssize_t>(request.size()) ||
        read(answers_, &status, sizeof status) != sizeof status)
      throw std::runtime_error("the process that copies itself has ended");
    return status;
  }

private:
  int requests_ = -1, answers_ = -1; // closed by the end of this process, at which the server ends
};

} // namespace

post::Outcome run_in_copy(const fs::path &deck, const fs::path &folder) {
  static const Server server;
  const int status = server.run(deck, folder);
  post::Outcome outcome;
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.output = post::read_text(folder / "printed");
  return outcome;
}

} // namespace drumlin::test
