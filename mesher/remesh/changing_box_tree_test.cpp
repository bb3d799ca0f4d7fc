#include "mesher/remesh/changing_box_tree.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

namespace delmesher::remesh {
namespace {

Box random_box(std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(0, 1), size(0, 0.2);
  Box box;
  for (std::size_t i = 0; i < 3; ++i) {
    box.lo[i] = place(random);
    box.hi[i] = box.lo[i] + size(random);
  }
  return box;
}

std::set<std::uint32_t> found(const ChangingBoxTree& tree, const Box& box) {
  std::set<std::uint32_t> items;
  tree.query(box, [&](std::uint32_t item) {
    EXPECT_TRUE(items.insert(item).second) << item << " is visited twice";
    return true;
  });
  return items;
}

// After any number of changes a query finds what a look at every box finds.
TEST(ChangingBoxTree, FindsWhatIsThere) {
  std::mt19937_64 random(1);
  std::vector<Box> boxes;
  for (int i = 0; i < 100; ++i) boxes.push_back(random_box(random));
  ChangingBoxTree tree(boxes);
  std::map<std::uint32_t, Box> all;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) all[i] = boxes[i];
  for (std::uint32_t step = 0; step < 3000; ++step) {
    if (step % 3 != 0 || all.empty()) {
      const std::uint32_t item = 100 + step;
      all[item] = random_box(random);
      tree.add(item, all[item]);
    }
    if (step % 3 != 1) {
      auto gone = all.lower_bound(static_cast<std::uint32_t>(random() % (100 + step)));
      if (gone == all.end()) gone = all.begin();
      tree.remove(gone->first);
      all.erase(gone);
    }
    const Box box = random_box(random);
    std::set<std::uint32_t> expected;
    for (const auto& [item, b] : all) {
      if (b.overlaps(box)) expected.insert(item);
    }
    ASSERT_EQ(found(tree, box), expected) << "step " << step;
  }
}

TEST(ChangingBoxTree, MayBecomeEmpty) {
  ChangingBoxTree tree;
  const Box box{{0, 0, 0}, {1, 1, 1}};
  EXPECT_TRUE(found(tree, box).empty());
  tree.add(5, box);
  EXPECT_EQ(found(tree, box), std::set<std::uint32_t>{5});
  tree.remove(5);
  EXPECT_TRUE(found(tree, box).empty());
}

}  // namespace
}  // namespace delmesher::remesh
