// Work on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace drumlin::post {

/// Calls work(i) for i from 0 to count - 1, in this order, on up to `threads` threads. The first exception is
/// thrown when all have ended; after it no further work begins.
void in_parallel(std::size_t count, int threads, const std::function<void(std::size_t)> &work);

} // namespace drumlin::post
