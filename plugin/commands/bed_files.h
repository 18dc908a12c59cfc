#pragma once
// Restart and data files of a bed, which one deck writes and the next reads. They are checked before the
// engine reads them: with an incomplete file the engine hangs, and with the file of another scene it
// continues with the wrong contact law.

#include "engine.h"

#include <string>
#include <utility>
#include <vector>

namespace drumlin {

class Arguments;

/// Notes in a restart or data file: names and values of the settings with which it was made.
using RestartNotes = std::vector<std::pair<std::string, std::string>>;

/// Reads notes from the arguments of a command: pairs NAME VALUE, then `groups` and groups of variables of
/// drumlin/variable, `chosen` and groups of which only those count whose value is not the deck's own, or
/// `values_of` and names of deck variables, each a note with its value. Ends the run if a name has no value.
RestartNotes read_notes(LAMMPS_NS::LAMMPS *lmp, Arguments &in);

/// What the name of a restart file may be, for an error text.
constexpr const char *restart_name_allowed = "a file in a folder that exists, without * and % in its name "
                                             "(no device, no link, and not in /, /dev, /proc or /sys)";

/// Whether a restart file of this name can be written. Changes nothing; not collective.
bool is_restart_name(const std::string &file);

/// Ends the run if write_noted_restart() would refuse the name. Changes nothing; collective.
/// \param what command and keyword that gave the name, for the error
void check_restart_name(LAMMPS_NS::LAMMPS *lmp, const std::string &file, const std::string &what);

/// Writes the engine's restart file with notes. An earlier file of this name is replaced when the new one is
/// complete. Ends the run if the file cannot be written. Collective.
/// \param what command and keyword that gave the name, for the error
void write_noted_restart(LAMMPS_NS::LAMMPS *lmp, const std::string &file, const RestartNotes &notes,
                         const std::string &what);

/// The same for a data file, with the notes as comments in its header.
void write_noted_data(LAMMPS_NS::LAMMPS *lmp, const std::string &file, const RestartNotes &notes,
                      const std::string &what);

/// Whether there is a regular file of this name that can be read. Not collective.
bool can_be_read(const std::string &file);

/// Notes of a complete restart file or of a data file; none of any other file. Not collective.
RestartNotes notes_of(const std::string &file);

/// The file that drumlin/read reads for a name: in LAMMPS FILE.data, if there is one, since the engines do
/// not read each other's restart files. Not collective.
std::string scene_file(const std::string &file);

/// Whether a file is text, as data files are; restart files are not. Not collective.
bool is_text(const std::string &file);

/// Empty if a restart file is complete and has these notes; else the text that follows "variable NAME is
/// 'FILE'" in an error. Not collective.
std::string restart_fault(const std::string &file, const RestartNotes &notes);

/// Empty if the sections Atoms and, if there is one, Velocities of a data file have a valid row for each atom
/// of its header: finite numbers, each ID once, positions in or near the box; and if nothing follows. Else
/// the text that follows "variable NAME is 'FILE'". Not collective.
std::string data_file_fault(const std::string &file);

} // namespace drumlin
