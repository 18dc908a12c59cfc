// The subcommand "vtk": the dumps of a bed run as time series for ParaView.
#pragma once

#include "support/usage_error.h"

namespace drumlin::post {

void add_vtk_command(CLI::App &app, Session &session);

} // namespace drumlin::post
