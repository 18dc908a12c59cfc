#include "support/parallel.h"

#include "support/process.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace drumlin::post {

void in_parallel(std::size_t count, int threads, const std::function<void(std::size_t)> &work) {
  std::atomic<std::size_t> next = 0;
  std::exception_ptr fault;
  std::mutex guard;
  const auto worker = [&] {
    try {
      for (std::size_t i = next++; i < count; i = next++) {
        end_if_told();
        work(i);
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(guard);
      if (!fault) fault = std::current_exception();
      next = count;
    }
  };
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < std::min(static_cast<std::size_t>(threads), count); ++i)
    others.emplace_back(worker);
  worker();
  for (std::thread &other : others)
    other.join();
  if (fault) std::rethrow_exception(fault);
}

} // namespace drumlin::post
