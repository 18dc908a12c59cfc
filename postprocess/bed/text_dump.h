// One step of a text dump of LAMMPS (dump custom, dump local).
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace drumlin::post {

/// A file that ends before what it announces does: its writer was stopped, or is still at work.
class CutShort : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// A dump's table: the columns as the file names them, and its rows.
struct TextDump {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
};

/// Reads a file of a single step.
/// \throws CutShort if the file ends too early, else std::runtime_error, with the file and what is wrong with it: no dump, more than one step, rows that are missing or longer or
/// shorter than the names, words
TextDump read_text_dump(const std::filesystem::path &file);

} // namespace drumlin::post
