// A tree of axis-aligned boxes whose items can be removed: nearest-item and closeness queries.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mesher/predicates/points.h"

namespace delmesher::chamfer {

struct ItemBox {
  Vec3 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
           std::numeric_limits<double>::infinity()};
  Vec3 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
            -std::numeric_limits<double>::infinity()};

  static ItemBox around(std::span<const Vec3> points) {
    ItemBox box;
    for (const Vec3& p : points) box.extend(p, p);
    return box;
  }
  void extend(const Vec3& other_low, const Vec3& other_high) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], other_low[i]);
      high[i] = std::max(high[i], other_high[i]);
    }
  }
};

inline double squared_distance(const ItemBox& a, const ItemBox& b) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double gap = std::max({0.0, a.low[i] - b.high[i], b.low[i] - a.high[i]});
    sum += gap * gap;
  }
  return sum;
}

class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(std::vector<ItemBox> boxes);

  bool empty() const { return nodes_.empty(); }
  // The item is no longer found.
  void remove(std::uint32_t item);

  // Calls measure(item) for items in about ascending distance of their boxes from `query`, as long
  // as that squared distance is below `bound`; measure returns the new bound.
  template <class Measure>
  double nearest(const ItemBox& query, double bound, Measure measure) const {
    if (!nodes_.empty()) descend(0, query, bound, measure);
    return bound;
  }
  // Calls visit(item) for every item whose box is at a squared distance <= bound.
  template <class Visit>
  void for_each_within(const ItemBox& query, double bound, Visit visit) const {
    if (!nodes_.empty()) visit_within(0, query, bound, visit);
  }

 private:
  struct Node {
    ItemBox box;
    std::uint32_t begin, end;  // range of items_
    std::uint32_t left;        // children left, left + 1; 0: leaf
    std::uint32_t parent;
    std::uint32_t alive;  // items not removed
  };
  static constexpr std::uint32_t kLeafSize = 4;

  void split(std::uint32_t node);

  template <class Measure>
  void descend(std::uint32_t index, const ItemBox& query, double& bound, Measure& measure) const {
    const Node& node = nodes_[index];
    if (node.left == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        if (removed_[items_[i]]) continue;
        if (squared_distance(boxes_[items_[i]], query) < bound) bound = measure(items_[i]);
      }
      return;
    }
    std::uint32_t child[2] = {node.left, node.left + 1};
    double gap[2];
    for (int k = 0; k < 2; ++k) gap[k] = squared_distance(nodes_[child[k]].box, query);
    if (gap[1] < gap[0]) {
      std::swap(child[0], child[1]);
      std::swap(gap[0], gap[1]);
    }
    for (int k = 0; k < 2; ++k) {
      if (nodes_[child[k]].alive > 0 && gap[k] < bound) descend(child[k], query, bound, measure);
    }
  }

  template <class Visit>
  void visit_within(std::uint32_t index, const ItemBox& query, double bound, Visit& visit) const {
    const Node& node = nodes_[index];
    if (node.alive == 0 || !(squared_distance(node.box, query) <= bound)) return;
    if (node.left != 0) {
      visit_within(node.left, query, bound, visit);
      visit_within(node.left + 1, query, bound, visit);
      return;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      if (!removed_[items_[i]] && squared_distance(boxes_[items_[i]], query) <= bound) {
        visit(items_[i]);
      }
    }
  }

  std::vector<ItemBox> boxes_;
  std::vector<std::uint32_t> items_;
  std::vector<std::uint32_t> leaf_of_;
  std::vector<std::uint8_t> removed_;
  std::vector<Node> nodes_;
};

}  // namespace delmesher::chamfer
