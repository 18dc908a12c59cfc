#include "engine/engine_command.h"

#include "engine/places.h"
#include "support/files.h"
#include "support/process.h"
#include "support/text.h"
#include "support/usage_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <set>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <thread>

#include <unistd.h>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// Variables of the project's decks whose values are names of files, and `out`, the name of a folder.
constexpr std::array<const char *, 3> file_variables = {"balls", "bed", "start"};
constexpr const char *folder_variable = "out";

bool has_blanks(const fs::path &path) {
  return path.native().find_first_of(" \t\r\n\v\f") != std::string::npos;
}

const fs::path &library_of(Engine engine) {
  return engine == Engine::lammps ? places().lammps_plugin : places().liggghts_plugin;
}

const std::string &program_of(Engine engine) {
  return engine == Engine::lammps ? places().lammps : places().liggghts;
}

/// The value of a variable that names a file or folder, without blanks.
std::string plain_value(const std::string &variable, const std::string &value) {
  const bool is_folder = variable == folder_variable;
  const fs::path path = value;
  const fs::path folder = is_folder ? path : path.parent_path();
  if (!is_folder && has_blanks(path.filename()))
    throw UsageError(fmt::format(
        "-var {} is '{}'; allowed: a file whose own name has no blanks, at which engines split it", variable,
        value));
  std::error_code code;
  fs::create_directories(folder, code);
  if (!fs::is_directory(folder, code))
    throw UsageError(fmt::format("-var {} is '{}'; allowed: a folder that can be made", variable, value));
  const fs::path plain = plain_folder(folder);
  return (is_folder ? plain : plain / path.filename()).string();
}

/// The name of the deck for the engine. A deck finds files of its folder by the variable `here`, which the
/// plugin defines; if its value had blanks, the engine would split the names of these files.
fs::path plain_deck(const fs::path &deck) {
  const fs::path file = fs::is_symlink(deck) ? fs::canonical(deck) : deck;
  if (!has_blanks(file.parent_path()) || read_text(file).find("${here}") == std::string::npos) return deck;
  return plain_file(file);
}

/// For a short run on one rank: without these Open MPI 4 starts a daemon and looks for networks, and a start
/// takes 0.35 s instead of 0.07. Other versions ignore what they do not know.
constexpr std::array<const char *, 4> single_rank_environment = {"OMPI_MCA_ess_singleton_isolated=1",
                                                                 "OMPI_MCA_orte_create_session_dirs=0",
                                                                 "OMPI_MCA_pml=ob1", "OMPI_MCA_btl=self"};

/// mpirun with its options. Ranks that share the cores of this machine need no network: without the search
/// for one a start takes half as long.
std::vector<std::string> mpirun_words(int ranks, Cores cores) {
  std::vector<std::string> words = {"mpirun"};
  if (cores == Cores::shared)
    words.insert(words.end(), {"--bind-to", "none", "--mca", "mpi_yield_when_idle", "1", "--mca", "pml",
                               "ob1", "--mca", "btl", "self,vader"});
  if (::geteuid() == 0) words.emplace_back("--allow-run-as-root");
  if (cores == Cores::shared || static_cast<unsigned>(ranks) > std::thread::hardware_concurrency())
    words.emplace_back("--oversubscribe");
  words.insert(words.end(), {"-np", std::to_string(ranks)});
  return words;
}

} // namespace

Engine engine_of(const fs::path &deck) {
  return deck.extension() == ".lammps" ? Engine::lammps : Engine::liggghts;
}

std::string engine_fault(Engine engine) {
  const bool lammps = engine == Engine::lammps;
  const fs::path &library = library_of(engine);
  if (library.empty() && places().installed)
    return fmt::format("the plugin for {} is not installed; allowed: a build with -DDRUMLIN_{}=ON",
                       lammps ? "LAMMPS" : "LIGGGHTS", lammps ? "LAMMPS" : "LIGGGHTS");
  if (!fs::is_regular_file(library))
    return lammps ? "LAMMPS is not set up; run ./drumlin setup lammps first"
                  : "the plugin for LIGGGHTS is not built; run ./drumlin setup first";
  if (program_file(program_of(engine)).empty())
    return fmt::format("the engine '{}' cannot be run; allowed: {}", program_of(engine),
                       lammps ? "a build with -DLAMMPS_PROGRAM=LMP"
                              : "Debian's package liggghts, or a build with -DLIGGGHTS_PROGRAM=PROGRAM");
  return {};
}

std::string lammps_package_fault() {
  const std::string &lmp = program_of(Engine::lammps);
  std::string help;
  try {
    const TemporaryFolder folder(fs::temp_directory_path(), "drumlin-lmp.");
    help = run_program({lmp, "-h"}, {single_rank_environment.begin(), single_rank_environment.end()},
                       folder.path())
               .output;
  } catch (const std::exception &) {
    return {}; // the run itself will say more
  }
  const std::string title = "Installed packages:";
  const std::size_t list = help.find(title);
  if (list == std::string::npos) return {};
  // The names, divided by blanks and line ends, end where the next title begins.
  std::istringstream words(help.substr(list + title.size(), help.find(':', list + title.size()) - list));
  const std::set<std::string> installed{std::istream_iterator<std::string>(words), {}};
  std::string missing, options;
  for (const char *package : {"GRANULAR", "PLUGIN"})
    if (installed.count(package) == 0) {
      missing += fmt::format("{}{}", missing.empty() ? "" : ", ", package);
      options += fmt::format(" -DPKG_{}=ON", package);
    }
  if (missing.empty()) return {};
  return fmt::format("the engine '{}' has been built without {}; allowed: an lmp built with{}, such as "
                     "./drumlin setup lammps builds in a checkout",
                     lmp, missing, options);
}

fs::path find_deck(const std::string &name) {
  std::error_code code;
  fs::path deck = name;
  if (!deck.is_absolute() && !fs::exists(deck, code)) {
    const std::string prefix = "inputs/";
    const std::string inside = name.rfind(prefix, 0) == 0 ? name.substr(prefix.size()) : name;
    if (!inside.empty() && fs::is_regular_file(places().inputs / inside, code))
      deck = places().inputs / inside;
  }
  if (!fs::is_regular_file(deck, code) || ::access(deck.c_str(), R_OK) != 0)
    throw UsageError(fmt::format("deck '{}' cannot be read; allowed: a deck such as chain/in.chain", name));
  return deck;
}

std::vector<std::string> plain_words(std::vector<std::string> words) {
  for (std::size_t n = 0; n + 2 < words.size(); ++n) {
    const std::string &variable = words[n + 1];
    const bool names_a_file =
        std::find(file_variables.begin(), file_variables.end(), variable) != file_variables.end();
    if ((words[n] == "-v" || words[n] == "-var") && (names_a_file || variable == folder_variable) &&
        has_blanks(words[n + 2]))
      words[n + 2] = plain_value(variable, words[n + 2]);
  }
  return words;
}

EngineCommand engine_command(const fs::path &deck, const std::vector<std::string> &words, int ranks,
                             Cores cores) {
  const Engine engine = engine_of(deck);
  if (const std::string fault = engine_fault(engine); !fault.empty()) throw UsageError(fault);
  const std::string library = plain_file(library_of(engine)).string();
  EngineCommand command;
  if (engine == Engine::liggghts) command.environment = {"LD_PRELOAD=" + library};
  if (ranks == 1 && cores == Cores::shared)
    command.environment.insert(command.environment.end(), single_rank_environment.begin(),
                               single_rank_environment.end());
  if (ranks > 1) {
    command.words = mpirun_words(ranks, cores);
    for (const std::string &entry : command.environment)
      command.words.insert(command.words.end(), {"-x", entry});
    command.environment.clear(); // it is for the ranks, not for mpirun
  }
  command.words.insert(command.words.end(), {program_of(engine), "-in", plain_deck(deck).string()});
  // If a variable is given twice, the engine uses the first value: a plugin that the words name takes
  // precedence.
  const bool named = std::find(words.begin(), words.end(), "plugin") != words.end();
  if (engine == Engine::lammps && !named)
    command.words.insert(command.words.end(), {"-var", "plugin", library});
  command.words.insert(command.words.end(), words.begin(), words.end());
  return command;
}

std::string shell_line(const EngineCommand &command) {
  std::string line;
  const auto add = [&line](const std::string &text) { line += (line.empty() ? "" : " ") + text; };
  for (const std::string &entry : command.environment) { // in a shell the name must not be in quotes
    const std::size_t value = entry.find('=') + 1;
    add(entry.substr(0, value) + shell_word(entry.substr(value)));
  }
  for (const std::string &word : command.words)
    add(shell_word(word));
  return line;
}

void execute(EngineCommand command) {
  for (std::string &entry : command.environment)
    ::putenv(entry.data());
  std::vector<char *> words;
  words.reserve(command.words.size() + 1);
  for (std::string &word : command.words)
    words.push_back(word.data());
  words.push_back(nullptr);
  ::execvp(words.front(), words.data());
  throw std::runtime_error(fmt::format("cannot start {}: {}", command.words.front(), std::strerror(errno)));
}

} // namespace drumlin::post
