// Paths without the characters at which engines split their input.
#pragma once

#include <filesystem>

namespace drumlin::post {

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
