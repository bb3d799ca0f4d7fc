// Brings the edges of a surface as given back into a mesh of the planarized surface, where they are
// diagonals of planar facets: each becomes a chain of edges. A surface that is kept comes back in
// the same way, from facets of coplanar triangles to a facet for each triangle.
//
// A facet's edge in the way of a diagonal is removed, where what replaces the tetrahedra around it
// is positive; or one of its ends, a Steiner point of the facet, is moved onto the diagonal; or the
// two cross in a new point, which replaces the tetrahedra at the edge and, where some are too flat
// for it, those beyond them, with the faces of the facet among theirs. Each of these leaves a
// crossing less than before, so that it ends. Where there is no room for any of them, vertices at
// the edges across are moved first; and an edge that finds no place is tried again after the
// others.
#pragma once

#include <cstdint>
#include <span>

#include "mesher/improve/improve.h"

namespace delmesher::improve {

struct DiagonalsResult {
  ConformingMesh mesh;  // faces have the facets of the surface as given
  // Edges of the surface as given within a facet of the planarized one.
  std::uint64_t diagonals = 0;
  // How many of them find no place; all if a point finds none in its facet. Unless it is 0, the
  // mesh is empty or of no use.
  std::uint64_t missing = 0;
};

// `planarized` and `as_given` have the same triangles; `given`: the vertices as given. On success
// every vertex on a diagonal is a point on that segment, and every other one inside a facet is
// given by a triangle of that facet, so that moving the vertices of the surface to where they were
// given puts the faces onto the surface as given. Quality is not asked for. New points are appended
// to the store. Deterministic; throws Stopped when the control says so.
DiagonalsResult enter_diagonals(ConformingMesh mesh, const SurfaceTopology& planarized,
                                const SurfaceTopology& as_given, std::span<const Vec3> given,
                                const ImproveOptions& options, PointStore& points,
                                Predicates& predicates, Control& control);

}  // namespace delmesher::improve
