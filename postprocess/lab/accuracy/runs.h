// The runs of the accuracy study: the chain and single impacts at many step sizes, each compared with its
// reference solution.
#pragma once

#include "advice/step_errors.h"
#include "experiment/exact_quantities.h"

#include <string>

namespace drumlin::post {

/// Runs in.chain. \param stepping "second" or "stock"
ChainErrors measure_chain(const ChainParameters &parameters, const std::string &stepping, int steps_per_cycle,
                          const ExactSolution &reference);

/// Runs a case of Table 1 by the engine's own contact law: velocity error and times only.
ChainErrors measure_engine_law(const std::string &case_name, int steps_per_cycle,
                               const ExactSolution &reference);

/// Runs single impacts that begin at different places within a time step, and compares the speed of rebound
/// with the exact solution. \param phases number of such places
ReboundErrors measure_impacts(Transition transition, double damping_ratio, const std::string &stepping,
                              double steps_per_contact, int phases);

} // namespace drumlin::post
