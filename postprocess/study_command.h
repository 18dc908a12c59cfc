// `drumlin study NAME`: measures of the trade between speed and accuracy.
#pragma once

#include "command.h"

namespace drumlin::post {

void add_study_command(CLI::App &app, Session &session);

} // namespace drumlin::post
