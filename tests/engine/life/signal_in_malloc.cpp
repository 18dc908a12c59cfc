// Sends SIGTERM within the first malloc() after a handler for it was set, and ends the process with status 99
// if the handler allocates memory: it would wait for malloc's lock for ever.
#include <csignal>
#include <cstddef>
#include <unistd.h>

extern "C" void *__libc_malloc(std::size_t size);

extern "C" __attribute__((visibility("default"))) void *malloc(std::size_t size) {
  static volatile std::sig_atomic_t sent = 0, inside = 0;
  if (inside != 0) ::_exit(99);
  struct sigaction now {};
  if (sent == 0 && ::sigaction(SIGTERM, nullptr, &now) == 0 && now.sa_handler != SIG_DFL) {
    sent = inside = 1;
    ::raise(SIGTERM);
    inside = 0;
  }
  return __libc_malloc(size);
}
