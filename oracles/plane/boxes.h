// Boxes of segments, triangles and points, so that the checks of a large input need not try all
// against all. Boxes alone are compared; the caller decides what is near.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
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
    visit_but_in(box, {}, meet);
  }

  // The same, but for most that are farther than `margin` from the line through two points, unless
  // their coordinates are so large that squares overflow.
  template <class Meet>
  void visit_near_line(const Box& box, const Corner& a, const Corner& b, double margin,
                       Meet&& meet) const {
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    if (!(std::fabs(a[0]) + std::fabs(a[1]) + length < 1e150)) return visit(box, meet);
    const oracles::Position normal = {(a[1] - b[1]) / length, (b[0] - a[0]) / length, 0};
    const double offset = normal[0] * a[0] + normal[1] * a[1];
    const std::array<oracles::BoxTree::HalfSpace, 4> beside = {
        {{normal, offset + margin},
         {{-normal[0], -normal[1], 0}, margin - offset},
         {{0, 0, 0}, 1},
         {{0, 0, 0}, 1}}};
    visit_but_in(
        box, [&] { return beside; }, meet);
  }

 private:
  template <class Meet>
  void visit_but_in(const Box& box,
                    const std::function<std::array<oracles::BoxTree::HalfSpace, 4>()>& but_in,
                    Meet&& meet) const {
    std::vector<oracles::Index> found;
    tree_.query(in_space(box), found, but_in);
    std::sort(found.begin(), found.end());
    for (const oracles::Index item : found) meet(item);
  }

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
