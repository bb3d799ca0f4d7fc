#include "mesher/refine/work_queue.h"

#include <gtest/gtest.h>

#include <array>

#include "mesher/refine/test_parts.h"

namespace delmesher::refine {
namespace {

std::vector<std::uint32_t> emptied(WorkQueue& queue) {
  std::vector<std::uint32_t> taken;
  for (std::uint32_t n = queue.take(); n != kNone; n = queue.take()) taken.push_back(n);
  return taken;
}

TEST(WorkQueue, KeepsTheOrderAndTakesNoneTwice) {
  WorkQueue queue;
  EXPECT_EQ(queue.take(), kNone);
  for (const std::uint32_t n : {7U, 2U, 7U, 9U, 2U}) queue.add(n);
  EXPECT_TRUE(queue.waits(9));
  EXPECT_FALSE(queue.waits(3));
  EXPECT_FALSE(queue.waits(1000));
  EXPECT_EQ(queue.take(), 7U);
  EXPECT_FALSE(queue.waits(7));
  queue.add(7);  // once more, behind the others
  EXPECT_EQ(emptied(queue), (std::vector<std::uint32_t>{2, 9, 7}));
  EXPECT_TRUE(queue.empty());
}

TEST(WorkQueue, RenumberingKeepsTheOrderAndForgetsWhatIsGone) {
  WorkQueue queue;
  for (const std::uint32_t n : {3U, 0U, 4U, 1U}) queue.add(n);
  queue.renumber(std::array{2U, kNone, kNone, 0U, 1U});
  EXPECT_NO_THROW(queue.validate(3));
  EXPECT_EQ(emptied(queue), (std::vector<std::uint32_t>{0, 2, 1}));
}

TEST(WorkQueue, ValidateReportsEveryBrokenInvariant) {
  const auto said_after = [](auto damage, std::size_t size) {
    WorkQueue queue;
    for (const std::uint32_t n : {0U, 2U}) queue.add(n);
    damage(WorkQueueBreaker{queue});
    return complaint_of(queue, size);
  };
  const auto expect = [&](const char* reason, auto damage, std::size_t size = 3) {
    expect_complaint(said_after(damage, size), reason);
  };
  expect("nothing", [](WorkQueueBreaker) {});
  expect("waits in no queue", [](WorkQueueBreaker b) { b.claim_to_wait(1); });
  expect("or twice", [](WorkQueueBreaker b) { b.put_in(2); });
  expect("not marked as waiting", [](WorkQueueBreaker b) { b.wait_instead(0, 1); });
  expect(
      "not marked as waiting", [](WorkQueueBreaker) {}, 2);
}

}  // namespace
}  // namespace delmesher::refine
