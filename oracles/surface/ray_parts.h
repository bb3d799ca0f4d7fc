// Parts of a surface that a ray need not cross.
#pragma once

#include <array>
#include <vector>

#include "oracles/base/box_tree.h"
#include "oracles/base/exact_points.h"

namespace tetproof::oracles {

// Triangles that edges connect are a part. It is closed if at each edge as many run one way as the
// other. Around a point beyond its box a closed part winds 0 times, and every ray from there
// crosses it an even number of times: only the other parts need be looked at.
class RayParts {
 public:
  RayParts(const ExactPoints& points, const std::vector<std::array<Index, 3>>& triangles);

  // The greatest height of those around a point in this box; that of nothing if there are none.
  double top_around(const BoxTree::Box& point) const;
  // Is a triangle of one of them?
  bool is_around(Index triangle, const BoxTree::Box& point) const {
    return meet(boxes_[part_[triangle]], point);
  }

 private:
  std::vector<Index> part_;  // of each triangle
  std::vector<BoxTree::Box> boxes_;
  BoxTree tree_;
};

}  // namespace tetproof::oracles
