#include "coast/parallel.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <thread>

namespace coast {
namespace {

void await(const std::function<bool()>& what) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!what() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
}

// One of two tasks fails while the other, which knows nothing of it, is about to begin a loop.
TEST(Parallel, ALoopInsideATaskIsDoneWholeWhereTheTaskBesideItFails) {
  constexpr int kSteps = 100;
  const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
  std::atomic<bool> both = false;
  std::atomic<int> done = 0;
  const auto task = [&](int i) {
    if (i == 0) {
      await([&] { return both.load(); });
      throw std::runtime_error("failed");
    }
    both = true;
    await([] { return tbb::is_current_task_group_canceling(); });
    parallel_for(0, kSteps, [&](int) { ++done; });
  };
  EXPECT_THROW(parallel_for(0, 2, task), std::runtime_error);
  EXPECT_EQ(done, kSteps);
}

}  // namespace
}  // namespace coast
