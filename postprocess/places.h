// Where the decks, the plugin and the engines are. A file says it that lies beside the program: in a build folder, under a prefix or in
// either when it has been moved. No path is compiled in.
#pragma once

#include <filesystem>
#include <string>

namespace drumlin::post {

/// Lines `NAME=VALUE` of the file `places`; cmake/places.cmake writes it. Paths count from its folder.
struct Places {
  std::filesystem::path inputs;          ///< folder of the decks
  std::filesystem::path liggghts_plugin; ///< the preloaded library; empty if it is not built
  std::filesystem::path lammps_plugin;   ///< what LAMMPS's `plugin load` takes; empty if it is not built
  std::string liggghts;                  ///< the engine's program, by its path or by the name that PATH finds
  std::string lammps;                    ///< the same; empty without LAMMPS
};

/// Those of this program: of the file that the environment variable DRUMLIN_PLACES names, else of the one in the program's folder.
/// std::runtime_error if it cannot be read.
const Places &places();

} // namespace drumlin::post
