// VTK's files of a bed, for ParaView. Writers throw std::runtime_error with the file and why it cannot be
// written.
#pragma once

#include "bed/coarse_graining.h"
#include "bed/relative_density.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

/// Sums over the contacts of each ball; empty if the contacts are not known.
struct ContactSums {
  std::vector<int> coordination;
  std::vector<double> pressure; ///< see ball_pressures()
};
/// Named numbers that belong to a step as a whole, such as its phase of the cycle.
using StepValues = std::vector<std::pair<std::string, double>>;

/// Points with radius, diameter, velocity, angular_velocity, force, mass, type, id; and coordination and
/// pressure, if given. The values of the step are field data.
void write_ball_points(const std::filesystem::path &file, const std::vector<Ball> &balls,
                       const ContactSums &sums, const StepValues &values);
/// Lines between the centres of two balls, or the image of one beyond a periodic side, or from a ball to a
/// wall, with force, normal_force, tangential_force, overlap, id1, id2 (0: a wall) as cell data.
void write_contact_lines(const std::filesystem::path &file, const std::vector<Ball> &balls,
                         const BedContacts &contacts);
/// An image with the fields as cell data, each by its name in BedFields. Where `packings`, those of the
/// layers, are known, there are relative_density and compaction, too; in a cell without soil they are not
/// numbers.
void write_field_image(const std::filesystem::path &file, const FieldGrid &grid, const BedFields &fields,
                       const std::vector<LayerPackings> &packings = {});

/// The text of a .pvd file: ParaView's list of the files of a time series.
/// \param files time, s, and name from the folder of the .pvd file
std::string collection_text(const std::vector<std::pair<double, std::string>> &files);

} // namespace drumlin::post
