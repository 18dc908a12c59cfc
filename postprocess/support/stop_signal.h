// Signals that tell a command to stop: Ctrl-C (SIGINT), SIGTERM and SIGHUP.
#pragma once

namespace drumlin::post {

/// Thrown by end_if_told(). No std::exception, so that nobody takes it for a fault of a single run.
struct StoppedBySignal {
  int number = 0;
};

/// From now on these signals, unless they are ignored, end the process at the next call of end_if_told(), so
/// that destructors remove temporary folders, for which they have ten seconds. After three seconds without
/// such a call, or at a second signal, they end it at once. Nobody can tell which call a signal is meant for:
/// this state is that of the process.
void stop_where_told();

/// Throws StoppedBySignal if such a signal has arrived. Called where work can be left: before a file is
/// written, between pieces of work, while another program runs. Thread-safe.
void end_if_told();

/// Ends the process as the signal does by default.
[[noreturn]] void end_by(const StoppedBySignal &signal);

} // namespace drumlin::post
