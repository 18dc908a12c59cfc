// The chain's motion as a sequence of exact solutions: between events it is linear with a sinusoidal force,
// so the state, joined with sin, cos and 1, moves by the exponential of a constant matrix. It uses no time
// integration.
#pragma once

#include "tests/support/prelude.h"
#include "chain/parameters.h"
#include "runs/chain_files.h"

namespace drumlin::test {

struct OracleResult {
  std::vector<double> time, x_drum, v_drum, a_drum, x_frame, v_frame, F_contact; // at the samples
  std::vector<post::ContactEvent> events;
  std::vector<post::CycleSummary> cycles; // extremes at 2000 points or more per cycle and at the events
};

OracleResult exact_pieces(const post::ChainParameters &parameters, int cycles, int samples_per_cycle,
                          double impact_speed = 0.0);

} // namespace drumlin::test
