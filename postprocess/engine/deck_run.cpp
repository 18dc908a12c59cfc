#include "engine/deck_run.h"

#include "engine/places.h"

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

namespace drumlin::post {

namespace fs = std::filesystem;

DeckRun::DeckRun(const std::string &deck, const Variables &variables, int ranks, double limit) : deck_(deck) {
  std::string name = (fs::temp_directory_path() / "drumlin-study-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder: " + name);
  folder_ = name;
  const auto begin = std::chrono::steady_clock::now();
  outcome_ = run_deck(input_file(deck), variables, folder_, ranks, limit);
  wall_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

DeckRun::~DeckRun() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

const DeckRun &DeckRun::must_succeed() const {
  if (outcome_.ok()) return *this;
  std::string why = outcome_.timed_out ? "was stopped at its time limit" : engine_error(outcome_.output);
  if (why.empty()) why = fmt::format("exit status {}", outcome_.status);
  throw std::runtime_error(fmt::format("{}: {}", deck_, why));
}

double DeckRun::printed(const std::string &text) const {
  const std::size_t found = outcome_.output.rfind(text);
  if (found == std::string::npos)
    throw std::runtime_error(fmt::format("{}: the engine did not print '{}'", deck_, text));
  return std::strtod(outcome_.output.c_str() + found + text.size(), nullptr);
}

fs::path input_file(const std::string &name) { return places().inputs / name; }

} // namespace drumlin::post
