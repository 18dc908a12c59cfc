// Rows of the stability study that run a small bed: properties that need many balls, several ranks and
// friction.
#pragma once

#include "lab/stability/extremes.h"

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace drumlin::post {

/// One step of balance.csv, which inputs/study/in.small_bed writes. SI units.
struct BedState {
  double time = 0.0;
  double balls = 0.0; ///< that are free to move
  double weight = 0.0;
  double floor_force = 0.0; ///< up, on the balls
  double momentum = 0.0;    ///< up
  double kinetic_energy = 0.0;
};

std::vector<BedState> read_balance(const std::filesystem::path &file);

/// The largest of three relative errors, which must be small in a bed that has come to rest: the floor's mean
/// force less the weight, over the weight; the change of momentum less the impulse of floor and weight, over
/// the weight's impulse; the largest kinetic energy over the weight times `length`, m. Infinite if a ball was
/// lost or a number is not finite. At least two states.
double balance_error(const std::vector<BedState> &states, double length);

/// Where the balls of a dump are, x and z in m by ball; its last picture.
using BedPicture = std::map<long, std::array<double, 2>>;
BedPicture read_picture(const std::filesystem::path &file);

/// Largest distance of a ball from itself in the other picture, m; infinite if one is in one picture only.
double picture_distance(const BedPicture &a, const BedPicture &b);

void add_bed_rows(std::vector<Extreme> &rows, bool quick);

} // namespace drumlin::post
