#pragma once
// Allowed names of output files, and a function that writes a file completely or not at all.

#include <string>

namespace drumlin {

/// What the name of an output file may be, for an error text.
constexpr const char *output_name_allowed =
    "a file in a folder that exists (no device, no link, and not in /, /dev, /proc or /sys)";

/// Whether output files may be in a folder, which need not exist: not in the root of the file system, nor
/// below /dev, /proc and /sys, which belong to the system. Changes nothing.
bool is_output_folder(const std::string &folder);

/// Whether a file of this name can be written, as a new file or instead of an existing regular one. Not if a
/// device, pipe, link, folder or read-only file has the name. Changes nothing.
bool is_output_file(const std::string &name);

/// Writes a file under the temporary name NAME.unfinished and renames it when all of it is on the disk. Until
/// then an earlier file of this name stays as it was.
/// \returns false if not all of it could be written (a full disk, or another process that is writing the same
/// file)
bool write_whole_file(const std::string &name, const std::string &contents);

} // namespace drumlin
