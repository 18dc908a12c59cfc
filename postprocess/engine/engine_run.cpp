#include "engine/engine_run.h"

#include "engine/places.h"

#include <stdexcept>

#include <unistd.h>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// Whether a deck writes into a folder `out`: those that make a bed do not, and refuse variables that they do not know.
bool has_out(const fs::path &deck) {
  const std::string name = deck.filename().string();
  return name != "in.settle" && name != "in.place" && name != "in.tile";
}

} // namespace

Outcome run_deck(const fs::path &deck, const Variables &variables, const fs::path &folder, int ranks,
                 double limit) {
  const bool lammps = deck.extension() == ".lammps";
  if (lammps && !has_lammps()) throw std::runtime_error("LAMMPS is not set up: ./drumlin setup lammps");
  const std::string library = lammps ? places().lammps_plugin.string() : plugin_library();
  if (library.find_first_of(" \t\r\n\v\f:") != std::string::npos)
    throw std::runtime_error("the plugin is '" + library +
                             "'; allowed: a path without blanks and colons, at which it would be split");
  std::vector<std::string> words;
  std::vector<std::string> environment;
  if (!lammps) environment = {"LD_PRELOAD=" + library};
  if (ranks > 1) {
    words = {"mpirun", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1"};
    if (geteuid() == 0) words.emplace_back("--allow-run-as-root");
    words.insert(words.end(), {"--oversubscribe", "-np", std::to_string(ranks)});
    for (const std::string &entry : environment)
      words.insert(words.end(), {"-x", entry});
    environment.clear(); // for the ranks, not for mpirun
  }
  words.insert(words.end(),
               {lammps ? places().lammps : places().liggghts, "-in", deck.string(), "-log", "none"});
  for (const auto &[name, value] : variables)
    words.insert(words.end(), {"-var", name, value}); // of a name twice the first counts
  if (has_out(deck)) words.insert(words.end(), {"-var", "out", folder.string()});
  if (lammps) words.insert(words.end(), {"-var", "plugin", library});
  return run_program(words, environment, folder, limit);
}

bool has_lammps() { return !places().lammps.empty(); }

std::string engine_error(const std::string &output) {
  const std::size_t begin = output.find("ERROR");
  return begin == std::string::npos ? "" : output.substr(begin, output.find('\n', begin) - begin);
}

std::string plugin_library() { return places().liggghts_plugin.string(); }

} // namespace drumlin::post
