// Tables of packings that `drumlin bed` makes itself, of a grading and contacts of which none is stored.
#pragma once

#include "bed/packing.h"
#include "bed/relative_density.h"

#include <filesystem>
#include <string>

namespace drumlin::post {

/// Pours samples of a layer's balls, as thick as the layer and periodic sideways, by inputs/bed/in.settle:
/// with the soil's own friction and rolling friction, which gives the loosest packing, without any, and with
/// shares between, three of each. How dense shaking would make it is estimated from case gravel. Writes the
/// table, share,friction,rolling,void_ratio,..., and tells before how many runs of which engine this takes,
/// and then when each is done. A table that is there and is of the same balls and contacts is read instead.
/// \param density of a ball, kg/m3 \param title of the layer, for what is printed Throws std::runtime_error
/// for a run that fails.
MeasuredPackings made_packings(const BedLayer &layer, const SoilFriction &soil, double density,
                               const std::filesystem::path &table, const std::string &title);

} // namespace drumlin::post
