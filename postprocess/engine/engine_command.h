// The command that starts an engine with the plugin. Every command line for an engine is composed here.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

enum class Engine { liggghts, lammps };

/// The engine that runs a deck: LAMMPS if the deck's name ends in .lammps, else LIGGGHTS.
Engine engine_of(const std::filesystem::path &deck);

/// Why an engine cannot be started with the plugin, as "WHY; allowed: WHAT" or with the command that must be
/// called before; empty if it can.
std::string engine_fault(Engine engine);

/// Which packages the configured lmp lacks that the plugin needs, as "WHY; allowed: WHAT". Empty if it has
/// them, or if `lmp -h`, which is run once for this (0.05 s), does not say.
std::string lammps_package_fault();

/// The file of a deck: as it is named from the working folder, else one of inputs by its name there, with or
/// without "inputs/" in front. Throws UsageError if there is no such file that can be read.
std::filesystem::path find_deck(const std::string &name);

/// Words for an engine, in which variables that name files and folders (-var out, balls, bed, start) have
/// values without blanks: see plain_folder(). Folders that such a variable names are made, since a link needs
/// its target. Other words stay as they are. Throws UsageError if that cannot be done.
std::vector<std::string> plain_words(std::vector<std::string> words);

/// Whether a run on several ranks has the processor cores for itself.
enum class Cores {
  own,   ///< this run's alone: ranks as mpirun places them
  shared ///< other runs use them at the same time: ranks are not bound to cores, give way while they wait,
         ///< and start without what only runs on several machines need
};

/// A command, complete but not started.
struct EngineCommand {
  std::vector<std::string> environment; ///< entries "NAME=value" for the environment of the program
  std::vector<std::string> words;       ///< the program and its arguments
};

/// The command that runs a deck with the plugin. Nothing is started, and a deck whose path the engine would
/// split (see plain_path.h), and which includes files of its folder, is named by a symbolic link.
/// \param deck a file; the working folder of the run must be the one from which it is named
/// \param words further arguments for the engine, behind those that are always there; of a variable given
/// twice the first counts
/// \param ranks number of MPI processes, >= 1 Throws UsageError if the engine cannot be started: see
/// engine_fault().
EngineCommand engine_command(const std::filesystem::path &deck, const std::vector<std::string> &words,
                             int ranks, Cores cores = Cores::own);

/// The command as one line for a shell.
std::string shell_line(const EngineCommand &command);

/// Replaces this process by the command. Returns only by throwing std::runtime_error, if the program cannot
/// be started.
[[noreturn]] void execute(EngineCommand command);

} // namespace drumlin::post
