// One step of a text dump of LAMMPS (dump custom, dump local).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// A dump's table: the columns as the file names them, and its rows.
struct TextDump {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
};

/// Reads a file of a single step.
/// \throws std::runtime_error with the file and what is wrong with it: no dump, more than one step, rows that are missing or longer or
/// shorter than the names, words
TextDump read_text_dump(const std::filesystem::path &file);

} // namespace drumlin::post
