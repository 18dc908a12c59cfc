#include "engine/places.h"

#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

Places read_places() {
  const char *given = std::getenv("DRUMLIN_PLACES");
  const fs::path file =
      given != nullptr ? fs::path(given) : fs::read_symlink("/proc/self/exe").parent_path() / "places";
  std::ifstream in(file);
  if (!in)
    throw std::runtime_error(
        fmt::format("'{}', which says where decks and plugin are, cannot be read; allowed: to build again",
                    file.string()));
  // By names only, so that a link without blanks above the folder stays in the result.
  const fs::path folder = file.parent_path();
  const auto path = [&folder](const std::string &text) {
    return text.empty() ? fs::path() : (folder / text).lexically_normal();
  };
  Places found;
  for (std::string line; std::getline(in, line);) {
    const std::size_t sign = line.find('=');
    if (sign == std::string::npos) continue;
    const std::string name = line.substr(0, sign);
    std::string value = line.substr(sign + 1);
    if (name == "inputs") found.inputs = path(value);
    if (name == "liggghts_plugin") found.liggghts_plugin = path(value);
    if (name == "lammps_plugin") found.lammps_plugin = path(value);
    if (name == "installed") found.installed = value == "yes";
    if (name == "liggghts")
      found.liggghts = std::move(value);
    else if (name == "lammps")
      found.lammps = std::move(value);
  }
  return found;
}

} // namespace

const Places &places() {
  static const Places found = read_places();
  return found;
}

fs::path inputs_here() {
  std::error_code code;
  return fs::equivalent(places().inputs, "inputs", code) ? fs::path("inputs") : places().inputs;
}

std::string front_command() { return places().installed ? "drumlin" : "./drumlin"; }

} // namespace drumlin::post
