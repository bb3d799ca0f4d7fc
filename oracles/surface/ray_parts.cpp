#include "oracles/surface/ray_parts.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "oracles/base/edge_key.h"
#include "oracles/base/union_find.h"
#include "oracles/surface/input_surface.h"

namespace tetproof::oracles {
namespace {

// Infinite boxes have no centre.
constexpr double kFar = std::numeric_limits<double>::max();
constexpr BoxTree::Box kEverywhere = {{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}};

struct EdgeOf {
  std::uint64_t key;
  Index triangle;
  bool forward;
};

// Numbers the parts, and calls for an edge of each that is not closed, by its triangle.
template <class Open>
std::vector<Index> parts_of(const std::vector<std::array<Index, 3>>& triangles, const Open& open) {
  std::vector<EdgeOf> edges;
  edges.reserve(3 * triangles.size());
  for (Index t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      edges.push_back({edge_key(a, b), t, a < b});
    }
  }
  std::ranges::sort(edges, {}, &EdgeOf::key);
  UnionFind sets(triangles.size());
  std::vector<Index> unbalanced;
  for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
    std::int64_t forward = 0;
    for (; last < edges.size() && edges[last].key == edges[first].key; ++last) {
      sets.unite(edges[first].triangle, edges[last].triangle);
      forward += edges[last].forward ? 1 : -1;
    }
    if (forward != 0) unbalanced.push_back(edges[first].triangle);
  }
  std::vector<Index> part(triangles.size());
  Index count = 0;
  for (Index t = 0; t < triangles.size(); ++t) {
    const Index first = sets.find(t);
    part[t] = first == t ? count++ : part[first];
  }
  for (const Index t : unbalanced) open(part[t]);
  return part;
}

}  // namespace

RayParts::RayParts(const ExactPoints& points, const std::vector<std::array<Index, 3>>& triangles)
    : tree_({}) {
  std::vector<Index> open;
  part_ = parts_of(triangles, [&](Index part) { open.push_back(part); });
  for (Index t = 0; t < triangles.size(); ++t) {
    const BoxTree::Box box = box_around(points, triangles[t]);
    if (part_[t] == boxes_.size()) boxes_.push_back(box);
    boxes_[part_[t]].add(box);
  }
  for (const Index part : open) boxes_[part] = kEverywhere;
  tree_ = BoxTree(boxes_);
}

double RayParts::top_around(const BoxTree::Box& point) const {
  thread_local std::vector<Index> found;
  found.clear();
  tree_.query(point, found);
  double top = -kFar;
  for (const Index part : found) top = std::max(top, boxes_[part].high[2]);
  return top;
}

}  // namespace tetproof::oracles
