#pragma once
// The files that a bed is kept in between decks: found whole and fitting, or refused before the engine, which would hang or go
// on with the wrong laws, reads them.

#include "engine.h"

#include <string>
#include <utility>
#include <vector>

namespace drumlin {

class Arguments;

/// What a restart file was made with, by name.
using RestartNotes = std::vector<std::pair<std::string, std::string>>;

/// Pairs of words up to the end, or up to `values_of` and names of variables, whose values they are. Ends the run if a name has no
/// value.
RestartNotes read_notes(LAMMPS_NS::LAMMPS *lmp, Arguments &in);

/// What a restart file may be named, for an error text.
constexpr const char *restart_name_allowed = "a file in a folder that exists, without * and % in its name "
                                             "(no device, no link, and not in /, /dev, /proc or /sys)";

/// Whether a restart file of this name can be written; touches nothing. Not collective.
bool is_restart_name(const std::string &file);

/// Ends the run if write_noted_restart() is going to fail; touches nothing. Collective.
void check_restart_name(LAMMPS_NS::LAMMPS *lmp, const std::string &file, const std::string &command);

/// Writes the engine's restart file with the notes behind what the engine reads. An earlier file of this name is replaced once the
/// new one is whole. Collective; ends the run if the file cannot be written.
void write_noted_restart(LAMMPS_NS::LAMMPS *lmp, const std::string &file, const RestartNotes &notes,
                         const std::string &command);

/// The same for a data file, with the notes as comments in its header.
void write_noted_data(LAMMPS_NS::LAMMPS *lmp, const std::string &file, const RestartNotes &notes,
                      const std::string &command);

/// Notes of a restart file that is whole, or of a data file; none of another file. Not collective.
RestartNotes notes_of(const std::string &file);

/// Empty if a file is whole and holds these notes; else what is wrong with it, and what is allowed. Not collective.
std::string restart_fault(const std::string &file, const RestartNotes &notes);

/// Empty if a data file has a good row for each atom of its header under Atoms and, if it is there, Velocities: finite numbers, each ID
/// once, positions in or near the box, and nothing behind them. Else what is wrong with it, and what is allowed. Not collective.
std::string data_file_fault(const std::string &file);

} // namespace drumlin
