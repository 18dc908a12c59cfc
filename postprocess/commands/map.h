// `drumlin map`: which motion a roller will have over two numbers of the chain.
#pragma once

#include "support/usage_error.h"

namespace drumlin::post {

void add_map_command(CLI::App &app, Session &session);

} // namespace drumlin::post
