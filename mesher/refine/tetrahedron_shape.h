// Lengths, circumcentre and volume of a tetrahedron, in doubles: they tell whether it is bad and
// where to split it, and decide nothing exact. Where a circumcentre must be the circumcentre, it
// is computed in pairs of doubles and its error is known.
#pragma once

#include <array>
#include <optional>

#include "mesher/delaunay/tetrahedrization.h"
#include "mesher/geometry/vector.h"

namespace delmesher::refine {

struct TetrahedronShape {
  std::array<Vec3, 4> p;          // relative to vertex 0
  std::array<double, 6> length2;  // squared, by kEdge
  int shortest = 0;
  Vec3 center;     // circumcentre relative to vertex 0
  double radius2;  // squared circumradius; infinite or NaN if flat
  double volume6;  // six times the volume

  double shortest2() const { return length2[shortest]; }
};

// Without center, radius2 and volume6.
inline TetrahedronShape shape_of(const PointStore& points, const VertexId* v) {
  TetrahedronShape s;
  const Vec3 origin = points.nearest(v[0]);
  for (int i = 0; i < 4; ++i) s.p[i] = subtract(points.nearest(v[i]), origin);
  for (int e = 0; e < 6; ++e) {
    const Vec3 d = subtract(s.p[kEdge[e][1]], s.p[kEdge[e][0]]);
    s.length2[e] = dot(d, d);
    if (s.length2[e] < s.length2[s.shortest]) s.shortest = e;
  }
  return s;
}

// Fills in center, radius2 and volume6.
inline void add_circumsphere(TetrahedronShape& s) {
  const Vec3 bc = cross(s.p[2], s.p[3]);
  const Vec3 ca = cross(s.p[3], s.p[1]);
  const Vec3 ab = cross(s.p[1], s.p[2]);
  s.volume6 = dot(s.p[1], bc);
  const double scale = 0.5 / s.volume6;
  for (int k = 0; k < 3; ++k) {
    s.center[k] = scale * (s.length2[0] * bc[k] + s.length2[1] * ca[k] + s.length2[2] * ab[k]);
  }
  s.radius2 = dot(s.center, s.center);
}

// The circumcentre of the four vertices, snapped to a multiple of `grid` (section 5.6): within
// `fraction` of the shortest edge of the exact one. None where pairs of doubles are too few digits
// to be certain of that, as for a tetrahedron that is all but flat, or where no double is that
// near.
std::optional<Vec3> certain_circumcentre(const PointStore& points, const VertexId* v, double grid,
                                         double fraction);

}  // namespace delmesher::refine
