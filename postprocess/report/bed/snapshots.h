// Pictures of the bed with its force chains at three instants, and the profile of its solid fraction: from a
// run's dumps.
#pragma once

#include <string>

#include "report/bed/measures.h"
#include "report/chain/figures.h"

namespace drumlin::post {

/// Adds the pictures of a group to a plan, without labels, which the caller gives. Throws std::runtime_error
/// for a dump that cannot be read.
/// \param stem   beginning of the names of its files
/// \param section id of the section that shows them
void plan_bed_pictures(const BedGroup &group, const std::string &stem, const std::string &section,
                       FigurePlan &plan);

} // namespace drumlin::post
