// Triangulates a face of several corners without new vertices: projected along an axis
// (projected_face.h), holes joined to the outer loop (hole_links.h), ears clipped (ear_clipper.h).
#pragma once

#include <span>
#include <vector>

#include "mesher/geometry/ear_clipper.h"

namespace delmesher::geometry {

// Longer polygons are rejected: at worst ear clipping takes quadratic time.
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
FaceTriangulation triangulate_face(const std::vector<Point3>& vertices, std::span<const Loop> loops,
                                   Polling& polling);

}  // namespace delmesher::geometry
