// Where the decks, the plugin and the engines are. No path is compiled in: the file `places`, in the folder
// of the program, lists them relative to this folder, so that a build folder or an installation can be moved.
#pragma once

#include <filesystem>
#include <string>

namespace drumlin::post {

/// The entries of the file `places`, which cmake/places.cmake writes. Relative paths in it are taken from the
/// folder of the file.
struct Places {
  std::filesystem::path inputs; ///< folder of the decks
  std::filesystem::path
      liggghts_plugin; ///< library for LD_PRELOAD with LIGGGHTS; empty if built without LIGGGHTS
  std::filesystem::path lammps_plugin; ///< library for `plugin load` of LAMMPS; empty if built without LAMMPS
  std::string liggghts;                ///< the program liggghts: its path, or its name if it is found by PATH
  std::string lammps;                  ///< the program lmp, in the same form; empty if built without LAMMPS
  bool installed = false;              ///< an installation, not a checkout that was built
};

/// Reads the file that the environment variable DRUMLIN_PLACES names or, without that variable, the one in
/// the folder of this program. Throws std::runtime_error if the file cannot be read.
const Places &places();

/// The folder of the decks, named from the working folder where it is below it: a name without blanks,
/// whatever the path of the checkout.
std::filesystem::path inputs_here();

/// What a user types to call this project: "drumlin" where it is installed, "./drumlin" in a checkout. For
/// messages.
std::string front_command();

} // namespace drumlin::post
