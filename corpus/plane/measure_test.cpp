#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "corpus/plane/bench.h"

namespace {

using namespace tetproof::plane_bench;
using tetproof::thread_seconds;

volatile double sink;

void work(int size) {
  double sum = 0;
  for (long i = 1; i < 1000L * size; ++i) sum += 1.0 / static_cast<double>(i);
  sink = sum;
}

// The shortest of some times: a clock of ticks says 0.
Mesher worker(int size) {
  return {"worker", [size](const PlanarGraph&, Measurement& m) {
            m.seconds = 1e9;
            for (int k = 0; k < 5; ++k) {
              const double start = thread_seconds();
              work(size);
              m.seconds = std::min(m.seconds, thread_seconds() - start);
            }
          }};
}

// Processor seconds of work(1), from a run so long that the ticks of no clock matter, by another
// clock than that of the meshers.
double unit() {
  const auto now = [] {
    struct rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * double(usage.ru_utime.tv_usec);
  };
  const double start = now();
  work(200000);
  return (now() - start) / 200000;
}

// A limit of processor time must not make the clock coarse: ticks are 1 to 10 ms.
TEST(Measure, KnowsTheTimeOfShortRunsUnderLimits) {
  const double known = unit();
  ASSERT_GT(known, 0);
  for (const double milliseconds : {0.2, 1.0, 5.0}) {
    const int size = std::max(1, static_cast<int>(1e-3 * milliseconds / known));
    const auto start = std::chrono::steady_clock::now();
    const Measurement m = measure(worker(size), {}, {.seconds = 60, .megabytes = 4000});
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    ASSERT_TRUE(m.ok) << m.reason;
    // The machine may be slower in between, but not by much.
    EXPECT_GT(m.seconds, size * known / 3) << milliseconds;
    EXPECT_LT(m.seconds, size * known * 3) << milliseconds;
    EXPECT_LT(10 * m.seconds, wall.count()) << "it is the mean of several runs";
  }
}

TEST(Measure, SaysWhyARunFailed) {
  const Mesher thrower = {"thrower", [](const PlanarGraph&, Measurement&) {
                            throw std::runtime_error("it is Tuesday");
                          }};
  const Measurement m = measure(thrower, {}, {});
  EXPECT_FALSE(m.ok);
  EXPECT_STREQ(m.reason, "it is Tuesday");
  const Measurement late = measure(worker(100000000), {}, {.seconds = 1, .megabytes = 4000});
  EXPECT_FALSE(late.ok);
  EXPECT_STREQ(late.reason, "timeout");
}

TEST(Measure, DoesNotCountAResultThatFailsTheOracles) {
  Mesher wrong = worker(1);
  wrong.verify = [](const PlanarGraph&, Measurement&) { throw std::runtime_error("overlap"); };
  const Measurement m = measure(wrong, {}, {});
  EXPECT_FALSE(m.ok);
  EXPECT_STREQ(m.reason, "overlap");
}

}  // namespace
