// The laws that bind the facets of a planarized surface to the surface as given
// (planarized_surface.h). They are decided exactly, on the facets that it really has, whatever
// groups were meant.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesher/delmesher/surface.h"
#include "mesher/predicates/predicates.h"

namespace delmesher::planar {

// A surface with some edges flipped and some vertices moved: vertex v is point v. Half-edge 3 t + k
// goes from corner k of triangle t to the next, and has an opposite one in the neighbour.
struct ChangedSurface {
  const Surface& given;
  std::span<const std::uint32_t> given_opposite;
  std::span<const std::array<std::uint32_t, 3>> triangles;
  std::span<const std::uint32_t> opposite;
};

// Its facets, edge-connected sets of exactly coplanar triangles of one label: lists of triangles,
// ascending, in the order of their smallest ones. No triangle may be degenerate.
std::vector<std::vector<std::uint32_t>> facets_of(const ChangedSurface& surface,
                                                  Predicates& predicates);

// Has the facet the corners and the outline that its triangles have as given?
bool keeps_outline(const ChangedSurface& surface, const std::vector<std::uint32_t>& facet);

// The triangles of the facet that have a corner, as given, farther than `bound` from the plane of
// the facet. `points` holds the vertices of the surface, and is as before afterwards.
std::vector<std::uint32_t> far_from_plane(const ChangedSurface& surface,
                                          const std::vector<std::uint32_t>& facet, double bound,
                                          PointStore& points);

}  // namespace delmesher::planar
