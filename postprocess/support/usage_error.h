// The interface between the subcommands of the tool and main.cpp.
#pragma once

#include <stdexcept>
#include <string>

namespace CLI {
class App;
}

namespace drumlin::post {

/// One call of the tool.
struct Session {
  std::string command; ///< the command line as given, for the record
  int status = 0;      ///< exit status, set by the subcommand that ran
};

/// A call that cannot be carried out as asked: main.cpp prints "ERROR: drumlin SUBCOMMAND: what()" as one
/// line to standard error and exits with status 2. what() names the option, the value and what is allowed.
class UsageError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// Adds a subcommand to `app`. Its CLI11 callback does the work and may throw UsageError (status 2) or any
/// other std::exception (status 1).
using AddCommand = void (*)(CLI::App &app, Session &session);

} // namespace drumlin::post
