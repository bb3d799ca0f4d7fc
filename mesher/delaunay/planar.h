// Planar Delaunay triangulation of points of one facet, agreeing with the perturbed 3D predicates.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesher/base/ids.h"
#include "mesher/predicates/predicates.h"

namespace delmesher::delaunay {

// The plane of a facet, for planar predicates on its points.
struct FacetPlane {
  int axis;       // projection axis for orient2d
  int axis_sign;  // so that orient = axis_sign * orient2d(axis, ...) is positive counter-clockwise
  // An explicit point off the plane, on its positive side: in-circle(a, b, c, d) for
  // counter-clockwise abc is insphere_perturbed(a, b, c, off_plane, d), whose perturbation does not
  // involve this point because a, b, c, d are coplanar.
  VertexId off_plane;
};

struct PlanarTriangulation {
  std::vector<std::array<VertexId, 3>> triangles;  // counter-clockwise
  // Neighbour across the edge opposite vertex i as 3 * triangle + its index there, or kNone on the
  // hull.
  std::vector<std::array<std::uint32_t, 3>> neighbors;
};

// Delaunay triangulation of distinct coplanar points (at least three not collinear), covering their
// convex hull. Unique for given points and ids.
PlanarTriangulation triangulate_planar(Predicates& predicates, const FacetPlane& plane,
                                       std::span<const VertexId> vertices);

}  // namespace delmesher::delaunay
