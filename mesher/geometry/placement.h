// Choosing the parameters of implicit points: dyadic, short, anchored at the nearest corner.
#pragma once

#include "mesher/predicates/points.h"

namespace delmesher::geometry {

// The number with the fewest significant bits in the closed interval [lo, hi] (the one nearest to
// zero among several). Requires lo <= hi, both finite.
double shortest_dyadic(double lo, double hi);

// A point of the line through the corners p and q within about `tolerance` of the
// projection of `target` + `rest` onto it, with the shortest parameter, anchored at the end nearest
// to the target (so the corners of the result may be q, p). If `inside` is true, the result is
// strictly between p and q. `rest` is the remainder of the target beyond its doubles: far from the
// origin they are coarser than a tolerance that small distances ask for.
PointDefinition place_on_segment(const PointStore& points, VertexId p, VertexId q,
                                 const Vec3& target, double tolerance, bool inside = true,
                                 const Vec3& rest = {0, 0, 0});

// A point of the plane of the corners p, q, r within about `tolerance` of the projection of
// `target` + `rest` onto it, anchored at the nearest corner. Not confined to the triangle.
PointDefinition place_on_triangle(const PointStore& points, VertexId p, VertexId q, VertexId r,
                                  const Vec3& target, double tolerance,
                                  const Vec3& rest = {0, 0, 0});

// Rounds each coordinate to the power-of-two grid with spacing at most `tolerance`, so that points
// in the volume have short coordinates. Scales with the input: snapping commutes with 2^k.
Vec3 snap_to_grid(const Vec3& point, double tolerance);

}  // namespace delmesher::geometry
