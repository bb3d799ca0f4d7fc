// The triangles that have to tile a facet: the planar Delaunay triangulation of its vertices,
// restricted to its polygon.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesher/cdt/chains.h"
#include "mesher/delaunay/planar.h"

namespace delmesher::cdt {

struct FacetTriangles {
  std::vector<std::array<VertexId, 3>> triangles;  // counter-clockwise seen from outside the solid
  // Across the edge opposite vertex i: triangle, or kNone at the facet's boundary.
  std::vector<std::array<std::uint32_t, 3>> neighbors;
};

class FacetTriangulator {
 public:
  FacetTriangulator(const CdtInput& input, const Chains& chains, Predicates& predicates);

  // All subsegments of the facet's boundary must be edges of the Delaunay tetrahedrization.
  FacetTriangles triangulate(FacetId facet);

 private:
  void collect_vertices(FacetId facet);
  void collect_boundary(FacetId facet);
  FacetPlane plane_of(FacetId facet, bool& flipped);
  bool is_boundary(VertexId from, VertexId to) const;
  FacetTriangles restrict_to_polygon(PlanarTriangulation&& all) const;

  const CdtInput& input_;
  const SurfaceTopology& topology_;
  const Chains& chains_;
  Predicates& predicates_;
  std::array<VertexId, 4> tetrahedron_{};  // four input vertices that are not coplanar
  std::vector<VertexId> vertices_;         // scratch
  std::vector<std::uint64_t> boundary_;    // sorted (from << 32 | to), interior on the left
};

}  // namespace delmesher::cdt
