#include "mesher/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <thread>

namespace delmesher::base {
namespace {

Limits with_threads(unsigned threads) {
  Limits options;
  options.threads = threads;
  return options;
}

TEST(Threads, EveryItemIsVisitedOnceInChunksThatDoNotDependOnTheirNumber) {
  for (const unsigned threads : {1U, 2U, 3U, 8U}) {
    for (const std::size_t count : {0, 1, 9, 10, 11, 1000}) {
      const Limits options = with_threads(threads);
      Control control(options);
      std::vector<int> visits(count, 0);
      for_chunks(control, count, 10, [&](Worker& worker, const Chunk& chunk) {
        EXPECT_LT(worker.number(), threads);
        EXPECT_EQ(chunk.begin, 10 * chunk.index);
        EXPECT_EQ(chunk.end, std::min(count, chunk.begin + 10));
        for (std::size_t i = chunk.begin; i < chunk.end; ++i) ++visits[i];
        return true;
      });
      EXPECT_EQ(visits, std::vector<int>(count, 1));
    }
  }
}

TEST(Threads, GatheredListsAreInTheOrderOfTheItems) {
  for (const unsigned threads : {1U, 2U, 8U}) {
    const Limits options = with_threads(threads);
    Control control(options);
    const auto list = gather<std::size_t>(
        control, 5000, 7, [](Worker&, std::size_t i, std::vector<std::size_t>& out) {
          for (std::size_t n = 0; n < i % 3; ++n) out.push_back(i);
        });
    std::vector<std::size_t> expected;
    for (std::size_t i = 0; i < 5000; ++i) expected.insert(expected.end(), i % 3, i);
    EXPECT_EQ(list, expected);
  }
}

TEST(Threads, OneThreadIsTheCallers) {
  const Limits options = with_threads(1);
  Control control(options);
  const auto caller = std::this_thread::get_id();
  for_items(control, 100, 1,
            [&](Worker&, std::size_t) { EXPECT_EQ(std::this_thread::get_id(), caller); });
}

TEST(Threads, ChunksBeforeTheOneThatEndsTheLoopAreCompleted) {
  for (const unsigned threads : {1U, 3U, 8U}) {
    const Limits options = with_threads(threads);
    Control control(options);
    std::vector<std::uint8_t> done(1000, 0);
    for_chunks(control, done.size(), 1, [&](Worker& worker, const Chunk& chunk) {
      if (chunk.index == 400 || chunk.index == 402) return false;
      for (int i = 0; i < 100; ++i) worker.poll();
      done[chunk.index] = 1;
      return true;
    });
    EXPECT_EQ(std::accumulate(done.begin(), done.begin() + 400, 0), 400);
    EXPECT_EQ(done[999], 0);
  }
}

TEST(Threads, TheErrorOfTheFirstChunkThatFailsReachesTheCaller) {
  for (const unsigned threads : {1U, 2U, 8U}) {
    const Limits options = with_threads(threads);
    Control control(options);
    std::string caught;
    try {
      for_items(control, 1000, 1, [&](Worker&, std::size_t i) {
        if (i >= 100) throw std::runtime_error(std::to_string(i));
      });
    } catch (const std::runtime_error& error) {
      caught = error.what();
    }
    EXPECT_EQ(caught, "100") << threads;
  }
}

// Workers that are not the caller would go on for an hour.
TEST(Threads, CancellingEndsTheChunksOfAllThreads) {
  for (const unsigned threads : {1U, 2U, 8U}) {
    Limits options = with_threads(threads);
    const auto caller = std::this_thread::get_id();
    options.progress = [&](const Progress&) {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      return false;
    };
    Control control(options);
    const auto begin = std::chrono::steady_clock::now();
    const auto hour = begin + std::chrono::hours(1);
    EXPECT_THROW(for_items(control, 100, 10,
                           [&](Worker& worker, std::size_t) {
                             while (std::chrono::steady_clock::now() < hour) worker.poll();
                           }),
                 Stopped);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::minutes(1));
  }
}

TEST(Threads, CancellingHoldsWhileTheCallerWaitsForOthers) {
  Limits options = with_threads(2);
  std::atomic<bool> other_has_begun = false;
  options.progress = [&](const Progress&) { return !other_has_begun; };
  Control control(options);
  EXPECT_THROW(for_items(control, 2, 1,
                         [&](Worker& worker, std::size_t) {
                           if (worker.number() == 0) {
                             while (!other_has_begun) std::this_thread::yield();
                             return;
                           }
                           other_has_begun = true;
                           for (;;) worker.poll();
                         }),
               Stopped);
}

TEST(Threads, TimeLimitsHold) {
  Limits options = with_threads(2);
  options.time_limit_seconds = 0.01;
  Control control(options);
  try {
    for_items(control, 2, 1, [&](Worker& worker, std::size_t) {
      for (;;) worker.poll();
    });
    FAIL() << "no end";
  } catch (const Stopped& stopped) {
    EXPECT_EQ(stopped.status.code, StatusCode::limit_reached);
    EXPECT_EQ(stopped.status.limit, Limit::time);
  }
}

TEST(Threads, EveryWorkerHasItsOwnObject) {
  struct Counter {
    explicit Counter(const int& start) : value(start) {}
    int value;
  };
  const Limits options = with_threads(4);
  Control control(options);
  const int start = 5;
  PerWorker<Counter> counters(control, start);
  for_items(control, 1000, 3, [&](Worker& worker, std::size_t) { ++counters[worker].value; });
  int sum = 0;
  counters.for_each([&](const Counter& counter) { sum += counter.value; });
  EXPECT_EQ(sum, 1000 + 4 * start);
}

}  // namespace
}  // namespace delmesher::base
