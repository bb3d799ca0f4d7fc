// The triangles that have to tile a facet: the planar Delaunay triangulation of its vertices,
// restricted to its polygon.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesher/cdt/chains.h"
#include "mesher/delaunay/planar.h"

namespace delmesher::cdt {

class FacetTriangulator {
 public:
  FacetTriangulator(const CdtInput& input, const Chains& chains, Predicates& predicates);

  // Counter-clockwise seen from outside the solid; no neighbours across the facet's boundary. All
  // subsegments of the boundary must be edges of the Delaunay tetrahedrization.
  PlanarTriangulation triangulate(FacetId facet);

 private:
  void collect_vertices(FacetId facet);
  void collect_boundary(FacetId facet);
  FacetPlane plane_of(FacetId facet, bool& flipped);
  bool is_boundary(VertexId from, VertexId to) const;
  PlanarTriangulation restrict_to_polygon(PlanarTriangulation&& all) const;

  const CdtInput& input_;
  const SurfaceTopology& topology_;
  const Chains& chains_;
  Predicates& predicates_;
  std::array<VertexId, 4> tetrahedron_{};  // four input vertices that are not coplanar
  std::vector<VertexId> vertices_;         // scratch
  std::vector<std::uint64_t> boundary_;    // sorted (from << 32 | to), interior on the left
};

}  // namespace delmesher::cdt
