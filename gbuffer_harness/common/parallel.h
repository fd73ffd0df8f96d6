// Rows of an image shared out among threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace pellucid::harness {

// Calls row(y) once for every y in [0, height), in any order, on `jobs` threads; 0: as many as the
// machine has. The first exception is rethrown here.
template <typename Row>
void parallelRows(int height, int jobs, const Row& row) {
  std::atomic<int> next = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    try {
      for (int y = next++; y < height; y = next++) row(y);
    } catch (...) {
      const std::scoped_lock lock(mutex);
      if (!failure) failure = std::current_exception();
      next = height;
    }
  };
  {
    const int wanted = jobs > 0 ? jobs : static_cast<int>(std::thread::hardware_concurrency());
    std::vector<std::jthread> helpers;
    for (int i = std::clamp(wanted, 1, std::max(height, 1)); i > 1; --i) helpers.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace pellucid::harness
