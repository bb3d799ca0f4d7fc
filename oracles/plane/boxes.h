// Boxes of segments, triangles and points, so that the checks of a large input need not try all
// against all. Boxes alone are compared; the caller decides what is near.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "oracles/base/box_tree.h"

namespace tetproof {

class PlaneBoxes {
 public:
  using Corner = std::array<double, 2>;
  struct Box {
    Corner low, high;
  };

  PlaneBoxes() = default;
  // Items are numbered in this order.
  explicit PlaneBoxes(const std::vector<Box>& items) : tree_(in_space(items)) {}

  // Calls meet(item) for every item whose box meets the given one, in their order.
  template <class Meet>
  void visit(const Box& box, Meet&& meet) const {
    std::vector<oracles::Index> found;
    tree_.query(in_space(box), found);
    std::sort(found.begin(), found.end());
    for (const oracles::Index item : found) meet(item);
  }

 private:
  static oracles::Box in_space(const Box& box) {
    return {{box.low[0], box.low[1], 0}, {box.high[0], box.high[1], 0}};
  }
  static std::vector<oracles::Box> in_space(const std::vector<Box>& items) {
    std::vector<oracles::Box> boxes;
    for (const Box& box : items) boxes.push_back(in_space(box));
    return boxes;
  }

  oracles::BoxTree tree_{std::vector<oracles::Box>{}};
};

}  // namespace tetproof
