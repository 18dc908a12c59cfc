#include "engine/deck_run.h"

#include "engine/engine_command.h"
#include "engine/places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <stdexcept>
#include <system_error>
#include <vector>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// Whether an engine's ERROR line tells of the machine or of a signal instead of the scene.
bool may_pass(const std::string &line) {
  static const std::regex words(
      "signal|disk|[Ff]ile|folder|[Cc]ould not|[Cc]annot|[Mm]emory|alloc|MPI|interrupt",
      std::regex::optimize);
  return std::regex_search(line, words);
}

} // namespace

DeckRun::DeckRun(const std::string &deck, const Variables &variables, int ranks, double limit)
    : deck_(deck), temporary_(fs::temp_directory_path(), "drumlin-study-"),
      folder_(temporary_.path() / "run") {
  fs::create_directory(folder_);
  outcome_ = run_deck(input_file(deck), variables, folder_, ranks, limit);
}

const DeckRun &DeckRun::must_succeed() const {
  if (outcome_.ok()) return *this;
  const std::string why =
      outcome_.timed_out ? "was stopped at its time limit" : engine_error(outcome_.output);
  const std::string text =
      fmt::format("{}: {}", deck_, why.empty() ? fmt::format("exit status {}", outcome_.status) : why);
  constexpr int least_of_signals = 128;
  // A line without its end has been cut by a full disk.
  if (!outcome_.timed_out && outcome_.status < least_of_signals && outcome_.says(why + "\n") &&
      why.rfind("ERROR", 0) == 0 && !may_pass(why))
    throw SceneFault(text);
  throw std::runtime_error(text);
}

double DeckRun::printed(const std::string &text) const {
  const std::size_t found = outcome_.output.rfind(text);
  if (found == std::string::npos)
    throw std::runtime_error(fmt::format("{}: the engine did not print '{}'", deck_, text));
  return std::strtod(outcome_.output.c_str() + found + text.size(), nullptr);
}

fs::path input_file(const std::string &name) { return places().inputs / name; }

std::set<fs::path> deck_files(const fs::path &deck) {
  const std::string here = "${here}/", ends = " \t\r\n\"'";
  static const std::set<std::string> commands = {"include", "jump", "read_data", "read_restart"};
  const fs::path folder = (fs::is_symlink(deck) ? fs::canonical(deck) : deck).parent_path();
  std::set<fs::path> found;
  std::vector<fs::path> open = {deck};
  while (!open.empty()) {
    const fs::path file = open.back();
    open.pop_back();
    if (!found.insert(file).second) continue;
    const std::string text = read_text(file);
    for (std::size_t at = text.find(here); at != std::string::npos; at = text.find(here, at)) {
      // The word before it; a deck may write what other commands name.
      const std::size_t last = text.find_last_not_of(ends, at - (at > 0 ? 1 : 0));
      const std::size_t before = last == std::string::npos ? 0 : text.find_last_of(ends, last) + 1;
      const bool is_read =
          last != std::string::npos && commands.count(text.substr(before, last + 1 - before)) > 0;
      at += here.size();
      if (!is_read) continue;
      const std::size_t end = std::min(text.find_first_of(ends + "$", at), text.size());
      const fs::path named = folder / text.substr(at, end - at);
      const bool whole = end == text.size() || text[end] != '$';
      std::error_code ignored; // of a folder or a file that is not there
      for (const fs::directory_entry &entry : fs::directory_iterator(named.parent_path(), ignored)) {
        const std::string name = entry.path().filename().string(), begin = named.filename().string();
        if (entry.is_regular_file(ignored) && (whole ? name == begin : name.rfind(begin, 0) == 0))
          open.push_back(entry.path());
      }
    }
  }
  return found;
}

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
