// `drumlin advise`: the steps per cycle that a chain needs for an error.
#pragma once

#include "support/usage_error.h"

namespace drumlin::post {

void add_advise_command(CLI::App &app, Session &session);

} // namespace drumlin::post
