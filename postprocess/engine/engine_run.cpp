#include "engine/engine_run.h"

#include "engine/engine_command.h"
#include "engine/places.h"
#include "engine/plain_path.h"

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// Whether a deck writes into a folder `out`: those that make a bed do not, and refuse variables that they do
/// not know.
bool has_out(const fs::path &deck) {
  const std::string name = (deck.extension() == ".lammps" ? deck.stem() : deck.filename()).string();
  return name != "in.settle" && name != "in.place" && name != "in.tile";
}

} // namespace

Outcome run_deck(const fs::path &deck, const Variables &variables, const fs::path &folder, int ranks,
                 double limit, const StopCondition &stop_when) {
  std::vector<std::string> words = {"-log", "none"};
  for (const auto &[name, value] : variables)
    words.insert(words.end(), {"-var", name, value}); // the first value of a name counts
  if (has_out(deck)) words.insert(words.end(), {"-var", "out", plain_folder(folder).string()});
  const EngineCommand command = engine_command(deck, words, ranks, Cores::shared);
  return run_program(command.words, command.environment, folder, limit, stop_when);
}

bool has_lammps() { return !places().lammps.empty(); }

std::string engine_error(const std::string &output) {
  const std::size_t begin = output.find("ERROR");
  return begin == std::string::npos ? "" : output.substr(begin, output.find('\n', begin) - begin);
}

std::string plugin_library() { return places().liggghts_plugin.string(); }

} // namespace drumlin::post
