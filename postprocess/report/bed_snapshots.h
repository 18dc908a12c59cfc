// Pictures of the bed at three instants, with the force chains, and how dense it lies over the depth: from a run's dumps.
#pragma once

#include <string>

#include "report/bed_measures.h"
#include "report/chain_figures.h"

namespace drumlin::post {

/// Adds the pictures of a group to a plan. Labels are left to the caller.
/// \param stem   what the names of its files begin with
/// \param section id of the page's section
void plan_bed_pictures(const BedGroup &group, const std::string &stem, const std::string &section,
                       FigurePlan &plan);

} // namespace drumlin::post
