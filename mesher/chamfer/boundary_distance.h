// Distances, within a facet, to the parts of its boundary that an element does not touch (the
// local feature size of section 4.1, with facets in place of triangles).
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "mesher/chamfer/kept_surface.h"
#include "mesher/geometry/box_tree.h"

namespace delmesher::chamfer {

class BoundaryDistance {
 public:
  explicit BoundaryDistance(const KeptSurface& surface);

  // From a boundary vertex of the facet to the boundary edges and vertices not incident to it.
  double from_vertex(FacetId f, VertexId v);
  // From a part of a boundary edge, given by its ends, to the boundary edges and vertices that do
  // not touch the whole edge.
  double from_edge_part(FacetId f, std::uint32_t edge, const std::array<Vec3, 2>& part);
  // From any point in the facet to its boundary.
  double from_point(FacetId f, const Vec3& point);

 private:
  // In a facet with fewer corners all boundary edges are looked at, without a tree.
  static constexpr std::uint32_t kSearchSize = 32;

  // measure(half-edge, from, to) returns a squared distance; gives the root of the smallest one.
  template <class Measure>
  double smallest(FacetId f, const Box& query, Measure measure);

  const KeptSurface& surface_;
  std::vector<std::unique_ptr<ShrinkingBoxTree>> tree_;  // per facet, when first needed
};

}  // namespace delmesher::chamfer
