#include "mesher/chamfer/boundary_distance.h"

#include <algorithm>

#include "mesher/chamfer/closest.h"

namespace delmesher::chamfer {

BoundaryDistance::BoundaryDistance(const KeptSurface& surface)
    : surface_(surface), tree_(surface.topology().facet_triangles.size()) {}

template <class Measure>
double BoundaryDistance::smallest(FacetId f, const Box& query, Measure measure) {
  const std::uint32_t begin = surface_.first_corner(f), end = surface_.first_corner(f + 1);
  double best = std::numeric_limits<double>::infinity();
  const auto offer = [&](std::uint32_t item) {
    const std::uint32_t h = surface_.corners()[begin + item].outgoing;
    best = std::min(best, measure(h, surface_.topology().from(h), surface_.topology().to(h)));
    return best;
  };
  if (end - begin < kSearchSize) {
    for (std::uint32_t item = 0; item < end - begin; ++item) offer(item);
    return std::sqrt(best);
  }
  if (!tree_[f]) {
    std::vector<Box> boxes;
    boxes.reserve(end - begin);
    for (std::uint32_t c = begin; c < end; ++c) {
      const std::uint32_t h = surface_.corners()[c].outgoing;
      const std::array<Vec3, 2> ends = {surface_.position(surface_.topology().from(h)),
                                        surface_.position(surface_.topology().to(h))};
      boxes.push_back(Box::around(ends));
    }
    tree_[f] = std::make_unique<ShrinkingBoxTree>(boxes);
  }
  tree_[f]->nearest(query, best, offer);
  return std::sqrt(best);
}

double BoundaryDistance::from_vertex(FacetId f, VertexId v) {
  const Vec3& p = surface_.position(v);
  const std::array<Vec3, 1> query = {p};
  return smallest(f, Box::around(query), [&](std::uint32_t, VertexId a, VertexId b) {
    // At edges that contain v, the other end still counts.
    if (a == v) return squared_norm(subtract(surface_.position(b), p));
    if (b == v) return squared_norm(subtract(surface_.position(a), p));
    return closest_on_segment(p, surface_.position(a), surface_.position(b)).squared_distance;
  });
}

double BoundaryDistance::from_edge_part(FacetId f, std::uint32_t edge,
                                        const std::array<Vec3, 2>& part) {
  const auto ends = surface_.topology().edge_vertices(edge);
  const VertexId v = ends[0], w = ends[1];
  return smallest(f, Box::around(part), [&](std::uint32_t h, VertexId a, VertexId b) {
    if (surface_.topology().edge_of[h] == edge) return std::numeric_limits<double>::infinity();
    const Vec3 &p = surface_.position(a), &q = surface_.position(b);
    if (a == v || a == w) return closest_on_segment(q, part[0], part[1]).squared_distance;
    if (b == v || b == w) return closest_on_segment(p, part[0], part[1]).squared_distance;
    return closest_of_segments(part[0], part[1], p, q).squared_distance;
  });
}

double BoundaryDistance::from_point(FacetId f, const Vec3& point) {
  const std::array<Vec3, 1> query = {point};
  return smallest(f, Box::around(query), [&](std::uint32_t, VertexId a, VertexId b) {
    return closest_on_segment(point, surface_.position(a), surface_.position(b)).squared_distance;
  });
}

}  // namespace delmesher::chamfer
