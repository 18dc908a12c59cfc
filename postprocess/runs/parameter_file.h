// Files parameters.csv of names and values, header name,value: what a run was made with.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

/// Reads parameters.csv. Errors as in support/csv.h; a name that stands there twice is one, too.
std::map<std::string, std::string> read_parameters(const std::filesystem::path &file);

/// The text of the file.
std::string parameters_text(const std::vector<std::pair<std::string, std::string>> &parameters);

/// Whether runs of one scene may differ in a parameter: the seed, what follows from the balls that it gives,
/// and what says how and where a run was made.
bool varies_with_seed(const std::string &name);

/// What keeps runs from being samples of one scene, each on a bed of its own: the first parameter, other than
/// those that vary with the seed, in which two differ, or the seed that they share. Empty: nothing.
std::string no_samples(const std::map<std::string, std::string> &run,
                       const std::map<std::string, std::string> &other);

/// The roller that parameters.csv names, its setting and what followed from its file, as a sentence; empty
/// without one.
std::string roller_words(const std::map<std::string, std::string> &parameters);

} // namespace drumlin::post
