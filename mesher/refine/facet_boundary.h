// The boundary of a facet, as its subsegments are now, and the part of a triangulation inside it.
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/delaunay/planar.h"

namespace delmesher::refine {

// A subsegment on the boundary of a facet, with the facet on its left seen from outside.
struct DirectedSide {
  VertexId from, to;
  std::uint32_t subsegment;
};

// Never changes. Law: no two sides lead from the same vertex to the same vertex.
class FacetBoundary {
 public:
  explicit FacetBoundary(std::vector<DirectedSide> sides);

  bool empty() const { return sides_.empty(); }
  // The subsegment that is side from-to or to-from; kNone if neither is a side. `inward`: is it
  // from-to, so that the facet is on its left?
  std::uint32_t find(VertexId from, VertexId to, bool* inward) const;

  // Per triangle of a triangulation of the facet's vertices: 1 if it is in the facet. Throws
  // InternalError if a side is not an edge, or if the sides do not separate inside and outside.
  std::vector<std::uint8_t> inside(const PlanarTriangulation& planar) const;

 private:
  const DirectedSide* find(VertexId from, VertexId to) const;

  std::vector<DirectedSide> sides_;  // sorted by their ends
};

}  // namespace delmesher::refine
