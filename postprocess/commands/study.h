// `drumlin study NAME`: measures of the trade between speed and accuracy.
#pragma once

#include "support/usage_error.h"

namespace drumlin::post {

void add_study_command(CLI::App &app, Session &session);

} // namespace drumlin::post
