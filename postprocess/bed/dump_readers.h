// Reads the dumps of the engines: text of LAMMPS and LIGGGHTS (dump custom, dump local), and VTK files of
// LIGGGHTS.
//
// Readers throw CutShort, or another std::runtime_error, with the file and what is wrong with it. VTK's own
// messages are not printed but become part of what().
#pragma once

#include "bed/coarse_graining.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace drumlin::post {

/// A file has fewer rows than its header announces: its writer was stopped, or is still writing.
class CutShort : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// One step of a text dump.
struct TextDump {
  std::filesystem::path file;
  long step = 0;
  std::vector<std::string> names;        ///< of the columns, as the file has them
  std::vector<std::vector<double>> rows; ///< as long as `names`; the numbers need not be finite

  /// The index of a column in every row; std::runtime_error if the dump does not have it.
  std::size_t column(const std::string &name) const;
};

/// Reads all steps of a text dump.
std::vector<TextDump> read_text_dumps(const std::filesystem::path &file);

/// Reads a text dump that must hold a single step.
TextDump read_text_dump(const std::filesystem::path &file);

/// The files of a dumped step.
struct StepDump {
  std::filesystem::path balls;
  std::filesystem::path contacts; ///< empty if there is none
};
/// The dumped steps of a run's dump folder: balls in VTK's files (*.vtp) of LIGGGHTS or text (*.dump) of
/// LAMMPS, contacts in text. None without such a folder.
std::map<long, StepDump> dumped_steps(const std::filesystem::path &dumps);
/// Balls from a dump of the engine (inputs/bed/dumps.on), in order of their ids. Positions of LIGGGHTS have
/// the 7 digits of the file's floats.
std::vector<Ball> read_ball_dump(const std::filesystem::path &file);
/// Contacts of these balls from a dump of fix contact/local, the lower id first, in order of the ids; those
/// with walls in order of the balls.
BedContacts read_contact_dump(const std::filesystem::path &file, const std::vector<Ball> &balls);

} // namespace drumlin::post
