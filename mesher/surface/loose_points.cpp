#include "mesher/surface/loose_points.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "mesher/geometry/box_tree.h"

namespace delmesher::surface {
namespace {

bool is_on(VertexId p, const std::array<VertexId, 3>& triangle, Predicates& predicates) {
  const auto& [a, b, c] = triangle;
  if (predicates.orient3d(a, b, c, p) != 0) return false;
  int axis = 0;
  while (predicates.orient2d(axis, a, b, c) == 0) ++axis;
  const int turn = predicates.orient2d(axis, a, b, c);
  return predicates.orient2d(axis, p, b, c) != -turn &&
         predicates.orient2d(axis, a, p, c) != -turn && predicates.orient2d(axis, a, b, p) != -turn;
}

}  // namespace

std::vector<VertexId> loose_points(const SurfaceTopology& topology, const PointStore& points,
                                   Predicates& predicates) {
  std::vector<VertexId> loose;
  Box box;
  for (VertexId v = 0; v < topology.vertex_half_edge.size(); ++v) {
    if (topology.vertex_half_edge[v] == kNone) {
      loose.push_back(v);
    } else {
      box.extend({points.nearest(v), points.nearest(v)});
    }
  }
  if (loose.empty()) return loose;
  const geometry::BoxTree tree(triangle_boxes(topology, points));
  std::erase_if(loose, [&](VertexId v) {
    const Vec3 p = points.nearest(v);
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(p[k] > box.lo[k] && p[k] < box.hi[k])) return true;
    }
    return !tree.query(
        {p, p}, [&](std::uint32_t t) { return !is_on(v, topology.triangles[t], predicates); });
  });
  std::ranges::stable_sort(loose, {}, [&](VertexId v) { return points.nearest(v); });
  const auto same = [&](VertexId v, VertexId w) { return points.nearest(v) == points.nearest(w); };
  loose.erase(std::unique(loose.begin(), loose.end(), same), loose.end());
  std::ranges::sort(loose);
  return loose;
}

void add_loose_points(const Surface& from, Surface& to) {
  std::vector<std::uint8_t> used(from.vertices.size(), 0);
  for (const auto& triangle : from.triangles) {
    for (const std::uint32_t v : triangle) used[v] = 1;
  }
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v] == 0) to.vertices.push_back(from.vertices[v]);
  }
}

}  // namespace delmesher::surface
