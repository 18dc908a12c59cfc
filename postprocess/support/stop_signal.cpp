#include "support/stop_signal.h"

#include <csignal>
#include <cstdlib>
#include <initializer_list>

#include <unistd.h>

namespace drumlin::post {

namespace {

constexpr unsigned patience = 3;   ///< s
constexpr unsigned unwinding = 10; ///< s, more than run_program() gives a program that is to stop
volatile std::sig_atomic_t received = 0;

void take_default(int number) {
  std::signal(number, SIG_DFL);
  std::raise(number);
}

extern "C" void note(int number) {
  if (received != 0) take_default(number);
  received = number;
  ::alarm(patience);
}

extern "C" void give_up(int) { take_default(received); }

} // namespace

void stop_where_told() {
  struct sigaction noting {};
  noting.sa_handler = note;
  noting.sa_flags = SA_RESTART;
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    ::sigaction(number, nullptr, &before);
    // Ignored: nohup. Another: UCX, of MPI, takes SIGHUP for itself when it is loaded.
    if (before.sa_handler != SIG_IGN) ::sigaction(number, &noting, nullptr);
  }
  std::signal(SIGALRM, give_up);
}

void end_if_told() {
  if (received == 0) return;
  ::alarm(unwinding);
  throw StoppedBySignal{received};
}

void end_by(const StoppedBySignal &signal) {
  take_default(signal.number);
  std::_Exit(EXIT_FAILURE); // the signal is blocked
}

} // namespace drumlin::post
