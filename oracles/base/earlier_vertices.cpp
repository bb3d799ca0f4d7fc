#include "oracles/base/earlier_vertices.h"

#include <algorithm>
#include <cmath>

namespace tetproof::oracles {
namespace {

constexpr Index kVerticesPerLeaf = 8;

// Encloses a quotient; everything if the divisor may be zero, or something overflows.
Interval quotient(const Interval& a, const Interval& b) {
  const Interval everything(-HUGE_VAL, HUGE_VAL);
  if (b.sign() != 1 && b.sign() != -1) return everything;
  const double p = a.low / b.low, q = a.low / b.high, r = a.high / b.low, s = a.high / b.high;
  if (!std::isfinite(p + q + r + s)) return everything;
  return Interval::around(std::min({p, q, r, s}), std::max({p, q, r, s}));
}

}  // namespace

EarlierVertices::EarlierVertices(const ExactPoints& points, std::vector<Index> vertices)
    : points_(points), vertices_(std::move(vertices)) {
  if (vertices_.empty()) return;
  nodes_.resize(1);
  build(0, 0, static_cast<Index>(vertices_.size()));
}

void EarlierVertices::build(std::size_t node, Index begin, Index end) {
  Box box;
  Index first = vertices_[begin];
  for (Index i = begin; i < end; ++i) {
    first = std::min(first, vertices_[i]);
    const IntervalVector place = points_.enclosure(vertices_[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], place[axis].low);
      box.high[axis] = std::max(box.high[axis], place[axis].high);
    }
  }
  const bool leaf = end - begin <= kVerticesPerLeaf;
  if (nodes_.size() <= node) nodes_.resize(node + 1);
  nodes_[node] = {box, first, begin, end, leaf};
  if (leaf) return;
  std::size_t axis = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (box.high[i] - box.low[i] > box.high[axis] - box.low[axis]) axis = i;
  }
  const Index middle = begin + (end - begin) / 2;
  std::nth_element(
      vertices_.begin() + begin, vertices_.begin() + middle, vertices_.begin() + end,
      [&](Index a, Index b) { return points_.nearest(a)[axis] < points_.nearest(b)[axis]; });
  build(2 * node + 1, begin, middle);
  build(2 * node + 2, middle, end);
}

// With b, c, d relative to a, the centre is (|b|^2 c x d + |c|^2 d x b + |d|^2 b x c) / 2 det(b, c,
// d) away from a, and the radius is as long as that.
Box EarlierVertices::box_of_ball(const std::array<Index, 4>& tetrahedron) const {
  const Index a = tetrahedron[0];
  const IntervalVector b = points_.rough_difference(a, tetrahedron[1]),
                       c = points_.rough_difference(a, tetrahedron[2]),
                       d = points_.rough_difference(a, tetrahedron[3]);
  const IntervalVector cd = exact::cross(c, d), db = exact::cross(d, b), bc = exact::cross(b, c);
  const Interval twice = Interval(2) * exact::dot(b, cd);
  const Interval bb = exact::dot(b, b), cc = exact::dot(c, c), dd = exact::dot(d, d);
  IntervalVector centre;
  for (std::size_t i = 0; i < 3; ++i) {
    centre[i] = quotient(bb * cd[i] + cc * db[i] + dd * bc[i], twice);
  }
  const double radius = std::sqrt(exact::dot(centre, centre).high) * (1 + 0x1p-50);
  const IntervalVector from = points_.enclosure(a);
  Box box;
  for (std::size_t i = 0; i < 3; ++i) {
    const Interval place = from[i] + centre[i], reach = place + Interval(-radius, radius);
    const bool known = std::isfinite(reach.low) && std::isfinite(reach.high);
    box.low[i] = known ? reach.low : -HUGE_VAL;
    box.high[i] = known ? reach.high : HUGE_VAL;
  }
  return box;
}

void EarlierVertices::near_ball(const std::array<Index, 4>& tetrahedron, Index before,
                                const std::function<bool(Index)>& enough) const {
  if (nodes_.empty()) return;
  const Box ball = box_of_ball(tetrahedron);
  const auto meets = [&ball](const Box& box) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (box.low[i] > ball.high[i] || box.high[i] < ball.low[i]) return false;
    }
    return true;
  };
  std::array<std::size_t, 128> stack;
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::size_t n = stack[--top];
    const Node& node = nodes_[n];
    if (node.first_vertex >= before || !meets(node.box)) continue;
    if (!node.leaf) {
      stack[top++] = 2 * n + 1;
      stack[top++] = 2 * n + 2;
      continue;
    }
    for (Index i = node.begin; i < node.end; ++i) {
      if (vertices_[i] < before && enough(vertices_[i])) return;
    }
  }
}

}  // namespace tetproof::oracles
