#include "engine/deck_run.h"

#include "engine/places.h"

#include <chrono>
#include <cstdlib>
#include <regex>
#include <stdexcept>

#include <fmt/format.h>

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
  const auto begin = std::chrono::steady_clock::now();
  outcome_ = run_deck(input_file(deck), variables, folder_, ranks, limit);
  wall_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
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

} // namespace drumlin::post
