// The one reader of the command line's options: options stay text until its functions check them, with one
// form of error message.
//
// Every function throws UsageError "OPTION is 'TEXT'; allowed: WHAT" for a text that is empty or not allowed.
#pragma once

#include "support/units.h"

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

namespace drumlin::post {

/// The number that an option's text holds.
double number_option(const char *option, const std::string &text, const Range &range);

/// The whole number from `least` to `most`.
int count_option(const char *option, const std::string &text, int least, int most);

/// The seed of random numbers: any whole number of 64 bits.
std::uint64_t seed_option(const char *option, const std::string &text);

/// The text itself, which must be one of the words.
const std::string &choice_option(const char *option, const std::string &text,
                                 std::initializer_list<const char *> words);

/// The name of a file or folder that exists or will be made: not empty, no part of it longer than file
/// systems allow.
std::filesystem::path path_option(const char *option, const std::string &text);

/// A folder for results (see check_output_folder in files.h).
std::filesystem::path output_folder_option(const char *option, const std::string &text);

/// A file for a result (see check_output_file in files.h).
std::filesystem::path output_file_option(const char *option, const std::string &text);

/// What a command reads or writes, and the option that names it.
struct GivenPath {
  std::string option;
  std::filesystem::path path; ///< need not exist
  bool folder = false;        ///< a folder, all of whose content is read, or may be replaced
};

/// Refuses a result that would replace what the command reads, or another of its results: the same file under
/// two names, through links, too, a file in a folder that is replaced, or two files of such a folder that are
/// one. For paths, too, that are not made yet. To be called before anything is written.
void keep_apart(const std::vector<GivenPath> &inputs, const std::vector<GivenPath> &outputs);

/// The files of these names in a folder.
std::vector<GivenPath> files_in(const char *option, const std::filesystem::path &folder,
                                const std::vector<std::string> &names);

} // namespace drumlin::post
