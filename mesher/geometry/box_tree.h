// A tree of closed axis-parallel boxes around items of any kind: overlaps, pairs, nearest items.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "mesher/predicates/points.h"

namespace delmesher::geometry {

// A closed axis-parallel box. By default it contains nothing, which is neutral in extend().
struct Box {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  Vec3 lo{kInfinity, kInfinity, kInfinity};
  Vec3 hi{-kInfinity, -kInfinity, -kInfinity};

  static Box around(std::span<const Vec3> points) {
    Box box;
    for (const Vec3& p : points) box.extend({p, p});
    return box;
  }
  void extend(const Box& other) {
    for (std::size_t i = 0; i < 3; ++i) {
      lo[i] = std::min(lo[i], other.lo[i]);
      hi[i] = std::max(hi[i], other.hi[i]);
    }
  }
  bool overlaps(const Box& other) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (lo[i] > other.hi[i] || other.lo[i] > hi[i]) return false;
    }
    return true;
  }
};

// Contains the exact points.
inline Box enclosing_box(const PointStore& points, std::span<const VertexId> vertices) {
  Box box;
  for (const VertexId v : vertices) {
    const Approximation& a = points.approximation(v);
    const Vec3 p{a.x, a.y, a.z};
    Box own{p, p};
    for (std::size_t i = 0; i < 3 && a.error != 0; ++i) {
      own.lo[i] = std::nextafter(p[i] - a.error, -Box::kInfinity);
      own.hi[i] = std::nextafter(p[i] + a.error, Box::kInfinity);
    }
    box.extend(own);
  }
  return box;
}

// In doubles, so an estimate: it may be off by a few roundings.
inline double squared_distance(const Box& a, const Box& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double gap = std::max({0.0, a.lo[i] - b.hi[i], b.lo[i] - a.hi[i]});
    sum += gap * gap;
  }
  return sum;
}

// Items are numbered as their boxes. Every traversal is deterministic. Where a visitor returns a
// bool, false ends the traversal, which then returns false as well.
class BoxTree {
 public:
  struct Node {
    Box box;
    std::uint32_t begin, end;  // range of positions
    std::uint32_t right;       // second child (the first one follows its parent), 0 for a leaf
    bool is_leaf() const { return right == 0; }
    std::uint32_t size() const { return end - begin; }
  };

  BoxTree() = default;
  explicit BoxTree(std::span<const Box> boxes);

  bool empty() const { return nodes_.empty(); }
  std::uint32_t node_count() const { return static_cast<std::uint32_t>(nodes_.size()); }
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
  void build(std::span<const Box> boxes, std::uint32_t begin, std::uint32_t end);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
  std::vector<Box> boxes_;  // by position
};

// A tree from which items can be removed. It finds the items nearest to a box.
class ShrinkingBoxTree {
 public:
  ShrinkingBoxTree() = default;
  explicit ShrinkingBoxTree(std::span<const Box> boxes);

  // The item is no longer found. Nothing happens if it has been removed before.
  void remove(std::uint32_t item);

  // Calls measure(item) for items in about ascending distance of their boxes from `query`, as long
  // as that squared distance is below `bound`; measure returns the new bound.
  template <class Measure>
  double nearest(const Box& query, double bound, Measure measure) const {
    if (!tree_.empty()) descend(0, query, bound, measure);
    return bound;
  }
  // Calls visit(item) for every item whose box is at a squared distance <= bound.
  template <class Visit>
  void for_each_within(const Box& query, double bound, Visit visit) const {
    if (!tree_.empty()) visit_within(0, query, bound, visit);
  }

 private:
  template <class Measure>
  void descend(std::uint32_t n, const Box& query, double& bound, Measure& measure) const;
  template <class Visit>
  void visit_within(std::uint32_t n, const Box& query, double bound, Visit& visit) const;

  BoxTree tree_;
  std::vector<std::uint32_t> position_;  // of each item
  std::vector<std::uint8_t> removed_;    // by position
  std::vector<std::uint32_t> alive_;     // by node: items not removed
};

template <class Visit>
bool BoxTree::query(std::uint32_t n, const Box& box, Visit& visit) const {
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
bool BoxTree::pairs_within(std::uint32_t n, Visit& visit) const {
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
bool BoxTree::pairs_between(std::uint32_t m, std::uint32_t n, Visit& visit) const {
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

template <class Measure>
void ShrinkingBoxTree::descend(std::uint32_t n, const Box& query, double& bound,
                               Measure& measure) const {
  const BoxTree::Node& node = tree_.node(n);
  if (node.is_leaf()) {
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      if (removed_[i] == 0 && squared_distance(tree_.item_box(i), query) < bound) {
        bound = measure(tree_.item(i));
      }
    }
    return;
  }
  std::array<std::pair<double, std::uint32_t>, 2> child;
  for (std::size_t k = 0; k < 2; ++k) {
    child[k].second = k == 0 ? n + 1 : node.right;
    child[k].first = squared_distance(tree_.node(child[k].second).box, query);
  }
  if (child[1].first < child[0].first) std::swap(child[0], child[1]);
  for (const auto& [gap, m] : child) {
    if (alive_[m] > 0 && gap < bound) descend(m, query, bound, measure);
  }
}

template <class Visit>
void ShrinkingBoxTree::visit_within(std::uint32_t n, const Box& query, double bound,
                                    Visit& visit) const {
  const BoxTree::Node& node = tree_.node(n);
  if (alive_[n] == 0 || !(squared_distance(node.box, query) <= bound)) return;
  if (!node.is_leaf()) {
    visit_within(n + 1, query, bound, visit);
    visit_within(node.right, query, bound, visit);
    return;
  }
  for (std::uint32_t i = node.begin; i < node.end; ++i) {
    if (removed_[i] == 0 && squared_distance(tree_.item_box(i), query) <= bound) {
      visit(tree_.item(i));
    }
  }
}

}  // namespace delmesher::geometry
