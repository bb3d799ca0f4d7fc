#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "corpus/plane/bench.h"

namespace {

using namespace tetproof::plane_bench;
using tetproof::thread_seconds;

volatile double sink;

Mesher worker(int size) {
  return {"worker", [size](const PlanarGraph&, Measurement&) {
            double sum = 0;
            for (long i = 1; i < 1000L * size; ++i) sum += 1.0 / static_cast<double>(i);
            sink = sum;
          }};
}

// Claims that its runs took these times, one after the other, and the last of them from then on.
Mesher claims(std::vector<double> seconds) {
  return {"claims", [seconds, run = std::size_t{0}](const PlanarGraph&, Measurement& m) mutable {
            m.seconds = seconds[std::min(run++, seconds.size() - 1)];
          }};
}

TEST(Measure, IsTheMeanOfSeveralShortRunsWithoutTheFirst) {
  constexpr double kTick = 0x1p-7;  // sums are exact
  EXPECT_EQ(measure(claims({8 * kTick, kTick}), {}, {}).seconds, kTick);
  EXPECT_EQ(measure(claims({8 * kTick, kTick, 3 * kTick, 9 * kTick}), {}, {}).seconds,
            13 * kTick / 3);
  // Long ones run once.
  EXPECT_EQ(measure(claims({32 * kTick, kTick}), {}, {}).seconds, 32 * kTick);
}

// A limit of processor time must not make the clock coarse: ticks are 1 to 10 ms.
TEST(Measure, HasAFineClockUnderLimits) {
  const Mesher steps = {"steps", [](const PlanarGraph&, Measurement& m) {
                          m.seconds = 1e9;
                          for (int k = 0; k < 20; ++k) {
                            const double start = thread_seconds();
                            double now = start;
                            while (now == start) now = thread_seconds();
                            m.seconds = std::min(m.seconds, now - start);
                          }
                        }};
  const Measurement m = measure(steps, {}, {.seconds = 60, .megabytes = 4000});
  ASSERT_TRUE(m.ok) << m.reason;
  EXPECT_GT(m.seconds, 0);
  EXPECT_LT(m.seconds, 5e-4) << "the smallest step of the clock, seen often";
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
