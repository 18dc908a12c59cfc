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

/// Whether an engine, or the loader of libraries, would split a path: it has blanks or colons.
bool is_split(const std::filesystem::path &path);

/// A name of a folder that engines do not split. The engines split their input at blanks, and the loader its
/// list of libraries at colons, too. For a folder with such characters in its path this is a symbolic link to
/// it, in the folder drumlin/links of the user's cache or, if that has such characters or cannot be written,
/// in a folder of the user's own in /tmp; any other folder is returned as it is. The folder must exist.
/// Throws UsageError if no link can be made.
std::filesystem::path plain_folder(const std::filesystem::path &folder);

/// The same for a file by its folder; its own name is kept.
std::filesystem::path plain_file(const std::filesystem::path &file);

} // namespace drumlin::post
