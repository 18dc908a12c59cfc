#pragma once
// Files that are whole or not there: where they may be written, and how.

#include <string>

namespace drumlin {

/// What the name of an output file allows, for an error text.
constexpr const char *output_name_allowed =
    "a file in a folder that exists (no device, no link, and not in /, /dev, /proc or /sys)";

/// Whether files may be written into a folder, or into one that is to be made there: the root of the file system and what lies in /dev,
/// /proc and /sys belong to the system. The folder need not exist; touches nothing.
bool is_output_folder(const std::string &folder);

/// Whether a file of this name can be written, as a new one or in place of a regular file; touches nothing. An existing device, pipe,
/// link, folder or read-only file is none.
bool is_output_file(const std::string &name);

/// Writes a file under a temporary name beside it and renames it when all of it is on the disk: an earlier file of this name stays as it
/// was until then.
/// \returns false if the file could not be written whole (a full disk, or another process that is writing it now)
bool write_whole_file(const std::string &name, const std::string &contents);

} // namespace drumlin
