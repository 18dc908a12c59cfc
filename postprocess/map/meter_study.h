// `drumlin study meter`: what a roller's meter shows over the stiffness of the soil, and what identification
// finds in the same records, for all rollers of the chain. Needs no engine.
#pragma once

#include "chain/parameters.h"

#include <filesystem>
#include <optional>
#include <string>

namespace drumlin::post {

/// The chain of a roller of the study, with D of case II, and what its file has of the drum's size [m].
struct SoilMachine {
  ChainParameters chain;
  std::optional<double> width, diameter;
};
/// \param roller case of Table 1, or MACHINE-SETTING of a file in inputs/rollers
SoilMachine soil_machine(const std::string &roller);

/// Makes the records that the folder does not have yet, and writes there
///   records.csv  meter values, regime and identified stiffness of each point
///   index.html   tables and figures
/// \param quick few points, to see that it works
void run_meter_study(const std::filesystem::path &out, bool quick);

} // namespace drumlin::post
