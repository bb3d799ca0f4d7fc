#include "mesher/geometry/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace delmesher::geometry {
namespace {

// Small boxes with integer corners, so that ties and touching boxes are frequent.
std::vector<Box> random_boxes(std::size_t count, std::mt19937_64& random) {
  std::vector<Box> boxes(count);
  for (Box& box : boxes) {
    for (std::size_t i = 0; i < 3; ++i) {
      box.lo[i] = static_cast<double>(random() % 40);
      box.hi[i] = box.lo[i] + static_cast<double>(random() % 4);
    }
  }
  return boxes;
}

using Items = std::set<std::uint32_t>;
using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

class BoxTrees : public testing::TestWithParam<std::size_t> {
 protected:
  std::mt19937_64 random_{GetParam()};
  std::vector<Box> boxes_ = random_boxes(GetParam(), random_);
  std::uint32_t count_ = static_cast<std::uint32_t>(boxes_.size());
};

TEST_P(BoxTrees, QueryVisitsWhatMeetsTheBox) {
  const BoxTree tree(boxes_);
  EXPECT_EQ(tree.empty(), boxes_.empty());
  for (const Box& box : random_boxes(50, random_)) {
    Items expected, found;
    for (std::uint32_t i = 0; i < count_; ++i) {
      if (boxes_[i].overlaps(box)) expected.insert(i);
    }
    std::size_t visits = 0;
    EXPECT_TRUE(tree.query(box, [&](std::uint32_t i) {
      ++visits;
      return found.insert(i).second;
    }));
    EXPECT_EQ(found, expected);
    if (expected.empty()) continue;
    visits = 0;
    EXPECT_FALSE(tree.query(box, [&](std::uint32_t) { return ++visits < 1; }));
    EXPECT_EQ(visits, 1U);
  }
}

TEST_P(BoxTrees, PairsMeetOnceAlsoByTasks) {
  const BoxTree tree(boxes_);
  Pairs expected, found, by_tasks;
  for (std::uint32_t i = 0; i < count_; ++i) {
    for (std::uint32_t j = i + 1; j < count_; ++j) {
      if (boxes_[i].overlaps(boxes_[j])) expected.insert({i, j});
    }
  }
  const auto into = [](Pairs& pairs) {
    return [&](std::uint32_t i, std::uint32_t j) { return pairs.insert(std::minmax(i, j)).second; };
  };
  EXPECT_TRUE(tree.pairs(into(found)));
  for (const BoxTree::PairTask& task : tree.pair_tasks()) {
    EXPECT_TRUE(tree.pairs(task, into(by_tasks)));
  }
  EXPECT_EQ(found, expected);
  EXPECT_EQ(by_tasks, expected);
}

TEST_P(BoxTrees, ShrinkingTreeKnowsWhatIsLeft) {
  ShrinkingBoxTree tree(boxes_);
  std::vector<std::uint8_t> left(count_, 1);
  for (std::uint32_t round = 0; round < 60; ++round) {
    const Box query = random_boxes(1, random_)[0];
    const double bound = static_cast<double>(random_() % 200);
    Items within, found;
    double nearest = bound;
    for (std::uint32_t i = 0; i < count_; ++i) {
      const double d = squared_distance(boxes_[i], query);
      if (left[i] != 0 && d <= bound) within.insert(i);
      if (left[i] != 0) nearest = std::min(nearest, d);
    }
    tree.for_each_within(query, bound, [&](std::uint32_t i) { found.insert(i); });
    EXPECT_EQ(found, within);
    EXPECT_EQ(tree.nearest(query, bound,
                           [&](std::uint32_t i) {
                             EXPECT_EQ(left[i], 1);
                             return squared_distance(boxes_[i], query);
                           }),
              nearest);
    for (std::uint32_t n = 0; n < count_ / 50; ++n) {
      const auto gone = static_cast<std::uint32_t>(random_() % count_);
      left[gone] = 0;
      tree.remove(gone);
      tree.remove(gone);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, BoxTrees, testing::Values(0U, 1U, 4U, 5U, 60U, 700U));

TEST(BoxTrees, HugeBoxesAreSplit) {
  std::vector<Box> boxes;
  for (int i = 0; i < 32; ++i) {
    const double x = (i - 16) * 0x1p1019;
    boxes.push_back({{x, -0x1p1023, 0}, {x, 0x1p1023, 0}});
  }
  const BoxTree tree(boxes);
  std::size_t visits = 0;
  tree.query({{-0x1p1023, 0, 0}, {-0x1p1022, 0, 0}}, [&](std::uint32_t) { return ++visits > 0; });
  EXPECT_EQ(visits, 9U);
}

}  // namespace
}  // namespace delmesher::geometry
