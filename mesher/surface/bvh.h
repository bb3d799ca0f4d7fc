// Bounding-volume hierarchy over axis-parallel boxes, for any kind of item.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesher/predicates/points.h"

namespace delmesher::surface {

// A closed axis-parallel box.
struct Box {
  Vec3 lo, hi;

  // Contains nothing; the neutral element of extend().
  static Box empty();
  static Box around(std::span<const Vec3> points);
  void extend(const Box& other);
  bool overlaps(const Box& other) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (lo[i] > other.hi[i] || other.lo[i] > hi[i]) return false;
    }
    return true;
  }
};

struct SurfaceTopology;

// Of the input triangles, in their order.
std::vector<Box> triangle_boxes(const SurfaceTopology& topology, const PointStore& points);

// Immutable; every traversal is deterministic. Visitors return false to end a traversal, which
// then returns false as well.
class Bvh {
 public:
  struct Node {
    Box box;
    std::uint32_t begin, end;  // range of items
    std::uint32_t right;       // second child (the first one follows its parent), 0 for a leaf
    bool is_leaf() const { return right == 0; }
    std::uint32_t size() const { return end - begin; }
  };

  explicit Bvh(std::span<const Box> boxes);

  bool empty() const { return nodes_.empty(); }
  const Node& node(std::uint32_t n) const { return nodes_[n]; }
  // The item at a position of the order that nodes refer to, and its box.
  std::uint32_t item(std::uint32_t position) const { return items_[position]; }
  const Box& item_box(std::uint32_t position) const { return boxes_[position]; }

  // visit(item) for every item whose box meets `box`.
  template <class Visit>
  bool query(const Box& box, Visit&& visit) const {
    return nodes_.empty() || query(0, box, visit);
  }

  // visit(item, item) once for every unordered pair of different items whose boxes meet.
  template <class Visit>
  bool pairs(Visit&& visit) const {
    return nodes_.empty() || pairs_within(0, visit);
  }

  // The pairs within one node (second is the same), or between two that have no item in common.
  struct PairTask {
    std::uint32_t first, second;
  };
  // Tasks that make up pairs(), in its order, each of a few hundred items.
  std::vector<PairTask> pair_tasks() const;
  template <class Visit>
  bool pairs(const PairTask& task, Visit&& visit) const {
    return task.first == task.second ? pairs_within(task.first, visit)
                                     : pairs_between(task.first, task.second, visit);
  }

 private:
  template <class Visit>
  bool query(std::uint32_t n, const Box& box, Visit& visit) const;
  template <class Visit>
  bool pairs_within(std::uint32_t n, Visit& visit) const;
  template <class Visit>
  bool pairs_between(std::uint32_t m, std::uint32_t n, Visit& visit) const;
  void add_tasks(const PairTask& task, std::vector<PairTask>& tasks) const;
  std::uint32_t build(std::span<const Box> boxes, std::uint32_t begin, std::uint32_t end);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
  std::vector<Box> boxes_;  // by position
};

template <class Visit>
bool Bvh::query(std::uint32_t n, const Box& box, Visit& visit) const {
  // Depth is logarithmic because every split halves the number of items.
  std::array<std::uint32_t, 64> stack;
  std::size_t height = 0;
  stack[height++] = n;
  while (height > 0) {
    const std::uint32_t m = stack[--height];
    const Node& node = nodes_[m];
    if (!node.box.overlaps(box)) continue;
    if (!node.is_leaf()) {
      stack[height++] = node.right;
      stack[height++] = m + 1;
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      if (boxes_[i].overlaps(box) && !visit(items_[i])) return false;
    }
  }
  return true;
}

template <class Visit>
bool Bvh::pairs_within(std::uint32_t n, Visit& visit) const {
  const Node& node = nodes_[n];
  if (!node.is_leaf()) {
    return pairs_within(n + 1, visit) && pairs_within(node.right, visit) &&
           pairs_between(n + 1, node.right, visit);
  }
  for (std::uint32_t i = node.begin; i < node.end; ++i) {
    for (std::uint32_t j = i + 1; j < node.end; ++j) {
      if (boxes_[i].overlaps(boxes_[j]) && !visit(items_[i], items_[j])) return false;
    }
  }
  return true;
}

template <class Visit>
bool Bvh::pairs_between(std::uint32_t m, std::uint32_t n, Visit& visit) const {
  const Node &a = nodes_[m], &b = nodes_[n];
  if (!a.box.overlaps(b.box)) return true;
  if (a.is_leaf() && b.is_leaf()) {
    for (std::uint32_t i = a.begin; i < a.end; ++i) {
      for (std::uint32_t j = b.begin; j < b.end; ++j) {
        if (boxes_[i].overlaps(boxes_[j]) && !visit(items_[i], items_[j])) return false;
      }
    }
    return true;
  }
  if (b.is_leaf() || (!a.is_leaf() && a.size() >= b.size())) {
    return pairs_between(m + 1, n, visit) && pairs_between(a.right, n, visit);
  }
  return pairs_between(m, n + 1, visit) && pairs_between(m, b.right, visit);
}

}  // namespace delmesher::surface
