// Tasks that run side by side.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <new>
#include <stdexcept>

#include "oracles/base/parallel.h"
#include "property_tests/little_memory.h"

namespace tetproof {
namespace {

using namespace oracles;  // NOLINT

TEST(Parallel, TasksRunOnceEachAndTheFirstErrorIsThrown) {
  for (const unsigned threads : {0U, 1U, 3U}) {
    std::array<std::atomic<int>, 20> runs{};
    run_tasks(threads, runs.size(), [&](std::size_t i) { ++runs[i]; });
    for (const auto& count : runs) EXPECT_EQ(count, 1);
    run_tasks(threads, 0, [](std::size_t) { FAIL(); });
    EXPECT_THROW(run_tasks(threads, 5,
                           [](std::size_t i) {
                             if (i >= 2) throw std::runtime_error(std::to_string(i));
                           }),
                 std::runtime_error);
  }
}

// Three tasks that wait for each other would not end with fewer than three threads.
TEST(Parallel, AsManyTasksRunAtOnceAsThereAreThreads) {
  std::mutex mutex;
  std::condition_variable all_here;
  int here = 0, met = 0;
  run_tasks(3, 3, [&](std::size_t) {
    std::unique_lock lock(mutex);
    ++here;
    all_here.notify_all();
    met += all_here.wait_for(lock, std::chrono::seconds(20), [&] { return here == 3; }) ? 1 : 0;
  });
  EXPECT_EQ(met, 3);
}

TEST(Once, IsDoneOnceForAllThatAsk) {
  Once once;
  int done = 0;
  run_tasks(3, 6, [&](std::size_t) { once([&] { ++done; }); });
  EXPECT_EQ(done, 1);
}

TEST(Once, WhatItThrowsIsThrownToAllThatAsk) {
  Once once;
  int tried = 0;
  const auto work = [&] {
    ++tried;
    throw std::runtime_error("once");
  };
  EXPECT_THROW(once(work), std::runtime_error);
  EXPECT_THROW(once(work), std::runtime_error);
  EXPECT_EQ(tried, 1);
}

// Not a byte is left where the exception is on its way.
TEST(Once, LackOfMemoryIsThrownLikeAnythingElse) {
  if (!can_be_limited("/dev/null")) GTEST_SKIP() << "address space cannot be limited here";
  const int code = with_more_memory(16 << 20, "/dev/null", [] {
    Once once;
    try {
      once([] {
        for (std::size_t size = 1 << 20; size >= 16; size /= 2) {
          while (::operator new(size, std::nothrow) != nullptr) {
          }
        }
        throw std::bad_alloc();
      });
    } catch (const std::bad_alloc&) {
      return 5;
    }
    return 0;
  });
  EXPECT_EQ(code, 5);
}

}  // namespace
}  // namespace tetproof
