// The run of a scene for one seed, and the bed that it starts from.
#pragma once

#include "engine/deck_run.h"
#include "experiment/scene.h"

#include <filesystem>
#include <memory>
#include <string>

namespace drumlin::post {

/// Whether the settled soil of a scene stays when its roller has been placed, for other scenes on the same
/// soil.
enum class Soil { kept, used_up };

/// The restart file of a scene's soil at rest, in the folder `beds` of `out`; made if an earlier call did not
/// finish it. Its name has the fingerprint of all that the soil is made of.
std::filesystem::path settled_soil(const Scene &scene, int seed, const std::filesystem::path &out);

/// Name of a scene's bed with its roller, of one seed, with the fingerprint of all that both are made of.
std::string placed_name(const Scene &scene, int seed);

/// The restart file of a scene's bed with its roller at rest, in the same folder. Scenes on the same soil are
/// not placed at the same time.
std::filesystem::path placed_roller(const Scene &scene, int seed, const std::filesystem::path &out,
                                    Soil soil);

/// The file that run_scene() adds to those of a run: seconds in the engine's loop, processor time, memory of
/// the rank with the largest.
constexpr const char *cost_name = "cost.csv";

/// Runs the scene's deck for a seed, on its bed if it has one. Throws as DeckRun::must_succeed().
std::unique_ptr<DeckRun> run_scene(const Scene &scene, int seed, const std::filesystem::path &out, Soil soil);

} // namespace drumlin::post
