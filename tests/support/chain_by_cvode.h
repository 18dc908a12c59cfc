// The chain by CVODE, for comparison with the exact solution and with engines: it shares no code with the
// solver of the tools, but their description of chain, options and results. CVODE integrates from one make or
// break of contact (event) to the next; its root finding locates the events; it is started again at each
// event, because the contact force changes its law there.
#pragma once

#include "tests/support/prelude.h"
#include "chain/exact_solution.h"
#include "chain/parameters.h"

namespace drumlin::test {

/// Solves the chain as post::solve_chain() does. Throws std::invalid_argument for parameters or options that
/// cannot be used, std::runtime_error if the integrator fails. Its `pieces` are steps of the integrator.
/// \param rtol relative tolerance of the integrator, 1e-14 to 1e-3; absolute ones follow it
post::ExactSolution solve_by_cvode(const post::ChainParameters &parameters, const post::ExactOptions &options,
                                   double rtol = 1e-12);

} // namespace drumlin::test
