// VTK's files of a bed: the dumps of the engine in (some are text), what ParaView shows out. All of VTK is behind this.
//
// Readers throw CutShort, or another std::runtime_error, with the file and what is wrong with it; what VTK itself has to say of a file is kept off
// the screen and goes into what(). Writers throw it if a file cannot be written.
#pragma once

#include "bed/coarse_graining.h"
#include "bed/text_dump.h" // CutShort

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

/// The files of a dumped step.
struct StepDump {
  std::filesystem::path balls;
  std::filesystem::path contacts; ///< empty if there is none
};
/// The dumped steps of a run's dump folder: balls in VTK's files (*.vtp) of LIGGGHTS or text (*.dump) of LAMMPS, contacts in text. None
/// without such a folder.
std::map<long, StepDump> dumped_steps(const std::filesystem::path &dumps);
/// Balls from a dump of the engine (inputs/bed/dumps), in order of their ids. Positions of LIGGGHTS have the 7 digits of the file's
/// floats.
std::vector<Ball> read_ball_dump(const std::filesystem::path &file);
/// Contacts of these balls from a dump of fix contact/local, the lower id first, in order of the ids; those with walls in order of the
/// balls.
BedContacts read_contact_dump(const std::filesystem::path &file, const std::vector<Ball> &balls);

/// What its contacts make of each ball; empty where they are not known.
struct ContactSums {
  std::vector<int> coordination;
  std::vector<double> pressure; ///< see ball_pressures()
};
/// Numbers by name that belong to a step as a whole, as its phase of the cycle.
using StepValues = std::vector<std::pair<std::string, double>>;

/// Points with radius, diameter, velocity, angular_velocity, force, mass, type, id; and coordination and pressure, if given. The values of the step
/// are field data.
void write_ball_points(const std::filesystem::path &file, const std::vector<Ball> &balls,
                       const ContactSums &sums, const StepValues &values);
/// Lines between the centres of two balls, or the image of one beyond a periodic side, or from a ball to a wall, with force, normal_force, tangential_force, overlap, id1, id2
/// (0: a wall) as cell data.
void write_contact_lines(const std::filesystem::path &file, const std::vector<Ball> &balls,
                         const BedContacts &contacts);
/// An image with the fields as cell data, each by its name in BedFields.
void write_field_image(const std::filesystem::path &file, const FieldGrid &grid, const BedFields &fields);

/// The text of a .pvd file: ParaView's list of the files of a time series.
/// \param files time, s, and name from the folder of the .pvd file
std::string collection_text(const std::vector<std::pair<double, std::string>> &files);

} // namespace drumlin::post
