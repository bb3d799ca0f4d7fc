// Triangulates a polygon without new vertices.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesher/io/polling.h"

namespace delmesher::io {

using Point3 = std::array<double, 3>;
using Triangle = std::array<std::uint32_t, 3>;

// Longer polygons are refused: at worst ear clipping takes quadratic time.
inline constexpr std::size_t kMaxPolygonCorners = 20000;

struct FaceTriangulation {
  std::vector<Triangle> triangles;  // oriented as the outer loop
  // The projection is a simple polygon, so that the triangles tile it. If not, the triangles still
  // have the polygon as their boundary, but some overlap.
  bool simple = true;
  bool planar = true;    // exactly
  double deviation = 0;  // largest distance of a corner from the plane of the first triangle
};

// loops[0] is the outer boundary, the others are holes in either direction; at most
// kMaxPolygonCorners corners in all. Ear clipping, shortest diagonal first, with exact signs in the
// projection along the polygon's dominating normal component (then along the others, should that
// one not be simple). Always n - 2 + 2 h triangles for n corners and h holes, except that holes
// that cannot be connected are left out and make it not simple. Throws ReadingStopped.
FaceTriangulation triangulate_face(const std::vector<Point3>& vertices,
                                   std::span<const std::vector<std::uint32_t>> loops,
                                   Polling& polling);

// The coordinate axis along which the polygon's area vector, in doubles, has its largest component.
// formats.md promises this axis: which solid a face that is not planar means depends on it.
int dominating_axis(const std::vector<Point3>& vertices, std::span<const std::uint32_t> loop);

// The point without its coordinate along `axis`, the other two in cyclic order.
std::array<double, 2> project(const Point3& p, int axis);

// Whether q is strictly inside the projected loop; exact (points on the boundary count as outside).
bool strictly_inside(const std::vector<Point3>& vertices, std::span<const std::uint32_t> loop,
                     int axis, const std::array<double, 2>& q);

}  // namespace delmesher::io
