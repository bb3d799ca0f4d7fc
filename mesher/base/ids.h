// Identifiers shared by all stages.
#pragma once

#include <cstdint>

#include "mesher/base/namespaces.h"

namespace delmesher::base {

// Index of a point in a PointStore; also the rank used by symbolic perturbation.
using VertexId = std::uint32_t;
// Index of a tetrahedron in a Tetrahedrization.
using TetId = std::uint32_t;
// Index of a facet (edge-connected group of exactly coplanar input triangles of one label).
using FacetId = std::uint32_t;
// Index of a class of facets lying in exactly the same plane.
using PlaneId = std::uint32_t;

// "No such element" for every identifier type.
inline constexpr std::uint32_t kNone = 0xffffffffU;

}  // namespace delmesher::base
