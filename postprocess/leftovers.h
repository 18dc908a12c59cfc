// Temporary folders of results under way, which carry the number of the process that makes them.
#pragma once

#include <filesystem>
#include <string>

namespace drumlin::post {

/// PREFIX followed by the number of this process.
std::string own_name(const std::string &prefix);

/// Folders PREFIX and a process number in `parent` whose process is no more, as a kill leaves them: removed. Those of running
/// processes and all else stay. Faults are ignored: what cannot be removed harms nobody.
void remove_leftovers(const std::filesystem::path &parent, const std::string &prefix);

/// The first of the folders that remove_leftovers() would remove; empty if there is none.
std::filesystem::path leftover(const std::filesystem::path &parent, const std::string &prefix);

} // namespace drumlin::post
