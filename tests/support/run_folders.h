// Run folders with the files that the decks write, made without an engine.
#pragma once

#include "chain/parameters.h"

#include <filesystem>
#include <string>

namespace drumlin::test {

/// A run folder whose files are the direct solution of a case of Table 1.
void write_chain_run(const std::filesystem::path &folder, const std::string &case_name,
                     post::Transition transition, int cycles,
                     const std::string &command = "drumlin run in.chain");

/// An impact, from the closed form.
void write_impact_run(const std::filesystem::path &folder, post::Transition transition, double damping_ratio);

constexpr int rows_per_cycle = 8; ///< of write_bed_run()
constexpr double period = 0.05;   ///< of its excitation, s

/// A run of a bed, with numbers that are easy to check by hand. Of six cycles the last four are steady.
void write_bed_run(const std::filesystem::path &folder, post::Transition transition, int cycles = 6,
                   const std::string &friction = "0.5");

/// Its dumps, of steps 0, 200 (row 2, 2 kN), 700 (row 7, 7 kN) and 800 (row 8, 0 kN).
void write_bed_dumps(const std::filesystem::path &folder);

} // namespace drumlin::test
