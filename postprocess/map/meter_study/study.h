// `drumlin study meter`: what a roller's meter shows over the stiffness of the soil, and what identification
// finds in the same records, for all rollers of the chain. Needs no engine.
#pragma once

#include <filesystem>

namespace drumlin::post {

/// Makes the records that the folder does not have yet, and writes there
///   records.csv  meter values, operating mode and identified stiffness of each record
///   index.html   tables and figures
/// \param quick few points, to see that it works
void run_meter_study(const std::filesystem::path &out, bool quick);

} // namespace drumlin::post
