#pragma once

#include <cstddef>
#include <thread>
#include <vector>

namespace coast::simulate {

/// Calls work(first, last) for `threads` contiguous parts of [0, count), the first on this thread. `work` must not throw.
template <typename Work>
void in_parts(std::size_t count, int threads, const Work& work) {
  const auto parts = static_cast<std::size_t>(threads);
  std::vector<std::thread> workers;
  for (std::size_t p = 1; p < parts; ++p) workers.emplace_back(work, count * p / parts, count * (p + 1) / parts);
  work(0, count / parts);
  for (std::thread& worker : workers) worker.join();
}

}  // namespace coast::simulate
